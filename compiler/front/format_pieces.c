/*
 * format_pieces.c: a text as pieces: its words and comments, and which of them stand together.
 */
#include "compiler/front/format_pieces.h"

#include <string.h>

enum { TAB_WIDTH = 4 };

/* The place where the text is read, and the column there. */
typedef struct Reader {
    const char *text;
    uint32_t    at, column, newlines; /* line ends since the last piece */
    Pieces     *pieces;
    Arena      *arena;
} Reader;

bool is_line_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

/* Returns the characters of bytes [start, end), which are UTF-8. */
static uint32_t count_characters(const char *text, uint32_t start, uint32_t end)
{
    uint32_t count = 0;
    for (uint32_t i = start; i < end; i++)
        count += text_begins_character(text[i]);
    return count;
}

static void add_piece(Reader *r, PieceKind kind, uint32_t end)
{
    Piece    piece = {.kind     = kind,
                      .start    = r->at,
                      .end      = end,
                      .newlines = r->pieces->count == 0 ? 1 : r->newlines,
                      .from     = r->column};
    uint32_t last  = end; /* behind the last line end in the piece */
    while (last > r->at && r->text[last - 1] != '\n')
        last--;
    piece.many_lines = last > r->at;
    piece.width      = count_characters(r->text, last, end);
    r->column        = (piece.many_lines ? 0 : r->column) + piece.width;
    r->at            = end;
    r->newlines      = 0;
    array_push_large(r->arena, r->pieces, piece);
}

static uint32_t line_comment_end(const Reader *r, uint32_t limit)
{
    const char *newline = memchr(r->text + r->at, '\n', limit - r->at);
    uint32_t    end     = newline ? (uint32_t)(newline - r->text) : limit;
    while (is_line_blank(r->text[end - 1]))
        end--;
    return end;
}

/* Reads blanks and comments up to `limit`. */
static void read_blank(Reader *r, uint32_t limit)
{
    while (r->at < limit) {
        char c = r->text[r->at];
        if (c == '/' && r->text[r->at + 1] == '/') {
            add_piece(r, PIECE_LINE_COMMENT, line_comment_end(r, limit));
        } else if (c == '/') {
            const char *inner  = r->text + r->at + 2;
            const char *closer = memmem(inner, limit - r->at - 2, "*/", 2);
            add_piece(r, PIECE_BLOCK_COMMENT, (uint32_t)(closer - r->text) + 2);
        } else {
            r->newlines += c == '\n';
            r->column = c == '\n'   ? 0
                        : c == '\t' ? r->column + TAB_WIDTH - r->column % TAB_WIDTH
                                    : r->column + (c != '\r');
            r->at++;
        }
    }
}

Pieces read_pieces(uint32_t source, const Sources *sources, Arena *arena)
{
    const Source *text   = &sources->items[source];
    Names         names  = {.arena = arena};
    Diags         diags  = {.arena = arena, .sources = sources};
    Tokens        tokens = lex(source, sources, &names, &diags, arena);
    Pieces        pieces = {.text = text->text};
    Reader        r = {.text = text->text, .pieces = &pieces, .arena = arena, .at = text->lines[0]};
    for (size_t i = 0; i < tokens.count; i++) {
        read_blank(&r, tokens.items[i].span.start);
        if (tokens.items[i].kind != TOKEN_END)
            add_piece(&r, (PieceKind)tokens.items[i].kind, tokens.items[i].span.end);
    }
    return pieces;
}

/* Skips blanks before the end of a line, which do not count in comments. */
static uint32_t skip_last_blanks(const char *text, uint32_t at, uint32_t end)
{
    uint32_t behind = at;
    while (behind < end && is_line_blank(text[behind]))
        behind++;
    return behind < end && text[behind] == '\n' ? behind : at;
}

static bool are_equal(const char *text_a, const Piece *a, const char *text_b, const Piece *b)
{
    uint32_t i = a->start, k = b->start;
    bool     comment = a->kind == PIECE_BLOCK_COMMENT;
    if (a->kind != b->kind)
        return false;
    while (i < a->end && k < b->end) {
        i = comment ? skip_last_blanks(text_a, i, a->end) : i;
        k = comment ? skip_last_blanks(text_b, k, b->end) : k;
        if (text_a[i++] != text_b[k++])
            return false;
    }
    return i == a->end && k == b->end;
}

bool pieces_equal(const Pieces *a, const Pieces *b)
{
    bool equal = a->count == b->count;
    for (size_t i = 0; equal && i < a->count; i++)
        equal = are_equal(a->text, &a->items[i], b->text, &b->items[i]);
    return equal;
}

/* ---- what stands together ---- */

static bool is_comment(PieceKind kind)
{
    return kind == PIECE_LINE_COMMENT || kind == PIECE_BLOCK_COMMENT;
}

const Piece *word_before(const Pieces *pieces, size_t index)
{
    while (index > 0)
        if (!is_comment(pieces->items[--index].kind))
            return &pieces->items[index];
    return NULL;
}

static bool is_operator(PieceKind kind)
{
    return kind >= TOKEN_DOT_DOT && kind <= TOKEN_BAR && kind != TOKEN_DOT;
}

bool goes_on(PieceKind kind)
{
    return is_operator(kind) || kind == TOKEN_DOT || kind == TOKEN_COMMA ||
           kind == TOKEN_SEMICOLON || (token_closes(kind) && kind != TOKEN_RIGHT_BRACE);
}

/* Tells whether a value ends with this word, so that a bracket behind it calls or indexes it. */
static bool ends_value(const Pieces *pieces, size_t index)
{
    const Piece *piece = &pieces->items[index], *before = word_before(pieces, index);
    if (before && before->kind == TOKEN_DOT) /* `.light`: any word is a name there */
        return true;
    switch (piece->kind) {
    case TOKEN_NUMBER:
    case TOKEN_COLOUR:
    case TOKEN_STRING:
    case TOKEN_TRUE:
    case TOKEN_FALSE:
    case TOKEN_RIGHT_PAREN:
    case TOKEN_RIGHT_BRACKET:
    case TOKEN_RIGHT_BRACE: return true;
    case TOKEN_NAME: break;
    default: return false;
    }
    /* The parser takes these names for statements there. */
    static const char *const words[] = {"kernel", "reflect", "mobius"};
    bool                     begins  = before && (before->kind == TOKEN_LEFT_BRACE ||
                             before->kind == TOKEN_RIGHT_BRACE || before->kind == TOKEN_SEMICOLON);
    for (size_t i = 0; begins && i < sizeof words / sizeof *words; i++)
        if (strlen(words[i]) == piece->end - piece->start &&
            memcmp(pieces->text + piece->start, words[i], piece->end - piece->start) == 0)
            return false;
    return true;
}

static bool is_sign_of_number(const Pieces *pieces, size_t index)
{
    return pieces->items[index].kind == TOKEN_MINUS &&
           (!word_before(pieces, index) ||
            !ends_value(pieces, (size_t)(word_before(pieces, index) - pieces->items)));
}

uint32_t natural_gap(const Pieces *pieces, size_t index)
{
    PieceKind left = pieces->items[index - 1].kind, right = pieces->items[index].kind;
    if (right == PIECE_LINE_COMMENT)
        return 1;
    if (left == TOKEN_LEFT_BRACE || right == TOKEN_RIGHT_BRACE)
        return left != TOKEN_LEFT_BRACE || right != TOKEN_RIGHT_BRACE;
    if (left == TOKEN_LEFT_PAREN || left == TOKEN_LEFT_BRACKET || left == TOKEN_DOT ||
        left == TOKEN_DOT_DOT || left == TOKEN_CARET)
        return 0;
    switch (right) {
    case TOKEN_COMMA:
    case TOKEN_SEMICOLON:
    case TOKEN_COLON:
    case TOKEN_DOT_DOT:
    case TOKEN_CARET:
    case TOKEN_RIGHT_PAREN:
    case TOKEN_RIGHT_BRACKET: return 0;
    case TOKEN_DOT: return left == TOKEN_NUMBER; /* `7.` would be read as a number */
    case TOKEN_LEFT_PAREN:
    case TOKEN_LEFT_BRACKET: return is_comment(left) || !ends_value(pieces, index - 1);
    default: return !is_sign_of_number(pieces, index - 1);
    }
}

bool begins_value(const Pieces *pieces, size_t index)
{
    switch (pieces->items[index - 1].kind) {
    case TOKEN_LEFT_PAREN:
    case TOKEN_LEFT_BRACKET:
    case TOKEN_ASSIGN:
    case TOKEN_COLON:
    case TOKEN_IN:
    case TOKEN_THEN:
    case TOKEN_ELSE: return true;
    default: return false;
    }
}
