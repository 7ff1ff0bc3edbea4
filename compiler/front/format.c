/*
 * format.c: where the pieces of a text stand in its canonical layout.
 *
 * The layout of a line depends on that of its neighbours: a column on all its lines, a line on the
 * value below which it begins.  So columns and indentations are found again from what they were,
 * until nothing moves; a text that does not move has the canonical layout.
 */
#include "compiler/front/format.h"

#include <string.h>

#include "compiler/front/format_pieces.h"

enum {
    INDENT       = 4,
    MAX_ROUNDS   = 32,  /* in which a layout settles */
    MAX_STEPS    = 64,  /* of indentation that lines of one statement have */
    MAX_BRACKETS = 256, /* open at once; the parser permits fewer */
    MAX_COLUMN   = 1024 /* below which a line can be set below a value */
};

/* A column in which words of neighbouring lines begin. */
typedef struct Column {
    uint32_t to;
    bool     wide; /* some word is further to the right than one blank behind the word before it */
} Column;

/* The beginning of a line of a statement. */
typedef struct Step {
    uint32_t from, to;
} Step;

/* A statement that is being laid out; one for each open brace, and one for the whole text. */
typedef struct Statement {
    uint32_t steps_count;
    Step     steps[MAX_STEPS]; /* from left to right: lines that later ones may return to */
    size_t   first;            /* piece */
} Statement;

typedef struct Bracket {
    PieceKind    kind;
    const Piece *line; /* begins the line that holds it */
} Bracket;

typedef struct Layout {
    Pieces     pieces;
    Arena     *arena;
    size_t     value_at[MAX_COLUMN]; /* 1 + the last piece, of those that begin a value there */
    Statement *statements;           /* [MAX_BRACKETS + 1] */
    Bracket   *brackets;             /* [MAX_BRACKETS] */
    uint32_t   bracket_count, brace_count;
    struct {
        Column *items;
        size_t  count, capacity;
    } columns;
} Layout;

/* Returns the column behind a piece. */
static uint32_t end_from(const Piece *piece)
{
    return (piece->many_lines ? 0 : piece->from) + piece->width;
}

static uint32_t end_to(const Piece *piece)
{
    return (piece->many_lines ? 0 : piece->to) + piece->width;
}

/* ---- columns of pieces ---- */

static bool is_wide(const Pieces *pieces, size_t index)
{
    return pieces->items[index].from >
           end_from(&pieces->items[index - 1]) + natural_gap(pieces, index);
}

/* Tells whether two pieces may form a column: both the same, or values behind the same sign. */
static bool are_alike(const Pieces *pieces, size_t a, size_t b)
{
    PieceKind before = pieces->items[a - 1].kind;
    if (natural_gap(pieces, a) == 0 || natural_gap(pieces, b) == 0)
        return false;
    return pieces->items[a].kind == pieces->items[b].kind ||
           (before == pieces->items[b - 1].kind &&
            (before == TOKEN_COMMA || before == TOKEN_COLON || before == TOKEN_ASSIGN));
}

static void join_column(Layout *l, size_t above, size_t below)
{
    Piece *pieces = l->pieces.items;
    if (pieces[below].column != 0)
        return;
    if (pieces[above].column == 0) {
        Column column = {.wide = is_wide(&l->pieces, above)};
        array_push(l->arena, &l->columns, column);
        pieces[above].column = (uint32_t)l->columns.count;
    }
    pieces[below].column = pieces[above].column;
    l->columns.items[pieces[below].column - 1].wide |= is_wide(&l->pieces, below);
}

/* Returns the piece that begins the next line, or their number. */
static size_t next_line(const Pieces *pieces, size_t first)
{
    do
        first++;
    while (first < pieces->count && pieces->items[first].newlines == 0);
    return first;
}

/* Joins what two lines have in the same columns. */
static void join_lines(Layout *l, size_t above, size_t below)
{
    const Piece *pieces = l->pieces.items;
    size_t       a = above + 1, b = below + 1;
    size_t       above_end = next_line(&l->pieces, above), below_end = next_line(&l->pieces, below);
    while (a < above_end && b < below_end) {
        if (pieces[a].from == pieces[b].from && are_alike(&l->pieces, a, b))
            join_column(l, a, b);
        if (pieces[a].from <= pieces[b].from)
            a++;
        else
            b++;
    }
}

static void find_columns(Layout *l)
{
    l->columns.count = 0;
    for (size_t i = 0; i < l->pieces.count; i++)
        l->pieces.items[i].column = 0;
    for (size_t above = 0, below; above < l->pieces.count; above = below) {
        below = next_line(&l->pieces, above);
        if (below == l->pieces.count)
            break;
        if (l->pieces.items[below].above > 0)
            join_lines(l, l->pieces.items[below].above - 1, below);
        if (l->pieces.items[below].newlines == 1)
            join_lines(l, above, below);
    }
}

/* Sets the pieces of a line behind its first.  Returns whether a column must move to the right. */
static bool set_line(Layout *l, size_t first)
{
    bool   moved = false;
    Piece *items = l->pieces.items;
    for (size_t i = first + 1; i < l->pieces.count && items[i].newlines == 0; i++) {
        Column *column = items[i].column ? &l->columns.items[items[i].column - 1] : NULL;
        items[i].to    = end_to(&items[i - 1]) + natural_gap(&l->pieces, i);
        if (column && column->wide && column->to < items[i].to) {
            column->to = items[i].to;
            moved      = true;
        }
        if (column && column->wide)
            items[i].to = column->to;
    }
    return moved;
}

/* ---- indentations ---- */

static bool begins_statement(const Layout *l, size_t index)
{
    const Piece *before   = word_before(&l->pieces, index);
    bool         in_block = l->bracket_count == 0 ||
                    l->brackets[l->bracket_count - 1].kind == TOKEN_LEFT_BRACE;
    if (!in_block || !before)
        return in_block;
    return before->kind == TOKEN_LEFT_BRACE || before->kind == TOKEN_SEMICOLON ||
           (before->kind == TOKEN_COMMA && l->bracket_count > 0) ||
           (before->kind == TOKEN_RIGHT_BRACE && !goes_on(l->pieces.items[index].kind));
}

/* Returns the line of a comment that stands below another one behind words, and goes on with it. */
static const Piece *comment_above(const Layout *l, size_t index)
{
    const Piece *piece = &l->pieces.items[index];
    bool         below = piece->kind == PIECE_LINE_COMMENT && piece->newlines == 1 && index > 0 &&
                 piece[-1].kind == PIECE_LINE_COMMENT && piece[-1].from == piece->from;
    return below ? &piece[-1] : NULL;
}

/* Returns where a line begins that goes on with a statement. */
static uint32_t indent_inside(Layout *l, Statement *statement, uint32_t from)
{
    Step *steps = statement->steps;
    if (from <= steps[0].from)
        from = steps[0].from + 1;
    while (steps[statement->steps_count - 1].from > from)
        statement->steps_count--;
    Step *last = &steps[statement->steps_count - 1];
    if (last->from == from)
        return last->to;
    size_t value = from < MAX_COLUMN ? l->value_at[from] : 0;
    Step   next  = {from, last->to + INDENT};
    if (value > statement->first)
        next.to = l->pieces.items[value - 1].to;
    if (statement->steps_count < MAX_STEPS)
        steps[statement->steps_count++] = next;
    return next.to;
}

static uint32_t indent_line(Layout *l, size_t index)
{
    Piece     *piece     = &l->pieces.items[index];
    Statement *statement = &l->statements[l->brace_count];
    if (comment_above(l, index))
        return comment_above(l, index)->to;
    if (token_closes(piece->kind) && l->bracket_count > 0)
        return l->brackets[l->bracket_count - 1].line->to;
    if (!begins_statement(l, index))
        return indent_inside(l, statement, piece->from);
    uint32_t to = l->bracket_count > 0 ? l->brackets[l->bracket_count - 1].line->to + INDENT : 0;
    *statement  = (Statement){.steps_count = 1, .steps = {{piece->from, to}}, .first = index + 1};
    return to;
}

/* Counts a bracket in a line.  Behind one that closes, the line is that of the one that opened.  What
   stands behind a brace in its line is the first statement in it. */
static void count_bracket(Layout *l, size_t index, const Piece **line)
{
    const Piece *piece = &l->pieces.items[index];
    if (token_opens(piece->kind) && l->bracket_count < MAX_BRACKETS) {
        l->brackets[l->bracket_count++] = (Bracket){piece->kind, *line};
        if (piece->kind == TOKEN_LEFT_BRACE)
            l->statements[++l->brace_count] = (Statement){
                .steps_count = 1, .steps = {{(*line)->from, (*line)->to}}, .first = index + 1};
    } else if (token_closes(piece->kind) && l->bracket_count > 0) {
        *line = l->brackets[--l->bracket_count].line;
        l->brace_count -= piece->kind == TOKEN_RIGHT_BRACE && l->brace_count > 0;
    }
}

/* Finds the line above of each line that begins a statement: the one that begins the statement before
   in the same block, unless an empty line stands between. */
static void find_statements(Layout *l)
{
    size_t      *last = arena_new_array(l->arena, size_t, MAX_BRACKETS + 1);
    const Piece *line = NULL;
    l->bracket_count = l->brace_count = 0;
    for (size_t i = 0; i < l->pieces.count; i++) {
        Piece *piece = &l->pieces.items[i];
        line         = piece->newlines > 0 ? piece : line;
        if (piece->newlines > 1)
            memset(last, 0, (MAX_BRACKETS + 1) * sizeof *last);
        if (piece->newlines > 0 && !token_closes(piece->kind) && begins_statement(l, i)) {
            piece->above         = last[l->brace_count];
            last[l->brace_count] = i + 1;
        }
        count_bracket(l, i, &line);
        if (piece->kind == TOKEN_LEFT_BRACE)
            last[l->brace_count] = 0;
    }
}

/* Sets every line.  Returns whether a column must move to the right. */
static bool set_lines(Layout *l)
{
    bool         moved = false;
    const Piece *line  = NULL;
    memset(l->value_at, 0, sizeof l->value_at);
    l->bracket_count = l->brace_count = 0;
    for (size_t i = 0; i < l->pieces.count; i++) {
        Piece *piece = &l->pieces.items[i];
        if (piece->newlines > 0) {
            line      = piece;
            piece->to = indent_line(l, i);
            moved |= set_line(l, i);
        } else if (piece->from < MAX_COLUMN && begins_value(&l->pieces, i)) {
            l->value_at[piece->from] = i + 1;
        }
        count_bracket(l, i, &line);
    }
    return moved;
}

/* Finds where all pieces stand, from where they stood.  Returns whether any moved. */
static bool settle(Layout *l)
{
    find_columns(l);
    for (int round = 0; set_lines(l) && round < MAX_ROUNDS; round++) {
    }
    bool moved = false;
    for (size_t i = 0; i < l->pieces.count; i++) {
        moved |= l->pieces.items[i].from != l->pieces.items[i].to;
        l->pieces.items[i].from = l->pieces.items[i].to;
    }
    return moved;
}

/* ---- the text ---- */

static void add_blanks(Text *out, uint32_t count)
{
    for (; count > 0; count--)
        text_add_bytes(out, " ", 1);
}

/* Writes a piece; a comment of many lines has no blanks at the ends of lines. */
static void write_piece(const Piece *piece, const char *text, Text *out)
{
    for (uint32_t at = piece->start, end; at < piece->end; at = end) {
        const char *newline = memchr(text + at, '\n', piece->end - at);
        end                 = newline ? (uint32_t)(newline - text) + 1 : piece->end;
        uint32_t last       = newline ? end - 1 : end;
        while (newline && last > at && is_line_blank(text[last - 1]))
            last--;
        text_add_bytes(out, text + at, last - at);
        text_add_bytes(out, "\n", newline ? 1 : 0);
    }
}

static void write(const Pieces *pieces, Text *out)
{
    for (size_t i = 0; i < pieces->count; i++) {
        const Piece *piece = &pieces->items[i];
        if (piece->newlines > 0 && i > 0)
            text_add(out, piece->newlines > 1 ? "\n\n" : "\n");
        add_blanks(out, piece->to - (piece->newlines > 0 ? 0 : end_to(piece - 1)));
        write_piece(piece, pieces->text, out);
    }
    text_add(out, pieces->count > 0 ? "\n" : "");
}

bool format_source(uint32_t source, Sources *sources, Arena *arena, Text *out)
{
    Layout layout = {.pieces     = read_pieces(source, sources, arena),
                     .arena      = arena,
                     .statements = arena_new_array(arena, Statement, MAX_BRACKETS + 1),
                     .brackets   = arena_new_array(arena, Bracket, MAX_BRACKETS)};
    find_statements(&layout);
    for (int round = 0; settle(&layout) && round < MAX_ROUNDS; round++) {
    }
    write(&layout.pieces, out);
    if (out->length > MAX_SOURCE_BYTES)
        return false;
    uint32_t written = source_add(sources, "", out->bytes ? out->bytes : "", out->length, false);
    Pieces   again   = read_pieces(written, sources, arena);
    return pieces_equal(&layout.pieces, &again);
}
