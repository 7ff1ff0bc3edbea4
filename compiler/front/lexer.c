/*
 * lexer.c: from bytes to tokens.
 *
 * Words and signs come from token.def.  Whoever comes from another language types `&&`, 'text'
 * or a curly quote: these are reported with what to write instead, and become the token that
 * was meant, so that one slip is one error.
 */
#include "compiler/front/token.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct Lexer {
    const char *text;
    uint32_t    length, at;
    uint32_t    source;
    uint32_t    line_end; /* of the line that was last asked for; or 0 */
    Names      *names;
    Diags      *diags;
    Arena      *arena;
    Tokens      tokens;
    Text        doc;         /* the `///` lines since the last token */
    Text        scratch;     /* of the number or string being read */
    bool        begins[256]; /* find_beginnings */
} Lexer;

/* ---- rows of token.def ---- */

typedef enum TokenClass {
    SPECIAL,
    STATEMENT,
    CONTROL,
    OPERATOR_WORD,
    CONSTANT,
    PUNCTUATION,
    OPERATOR
} TokenClass;

typedef struct TokenRow {
    const char *spelling, *quoted;
    uint32_t    length;
    TokenClass class;
} TokenRow;

static const TokenRow rows[TOKEN_KIND_COUNT] = {
#define TOKEN(name, spelling, class) {spelling, "`" spelling "`", sizeof spelling - 1, class},
#include "compiler/front/token.def"
#undef TOKEN
};

const char *token_kind_text(TokenKind kind)
{
    switch (kind) {
    case TOKEN_END: return "the end of the file";
    case TOKEN_ERROR: return "text that cannot be read";
    case TOKEN_NUMBER: return "a number";
    case TOKEN_COLOUR: return "a colour";
    case TOKEN_STRING: return "a string";
    case TOKEN_NAME: return "a name";
    default: return rows[kind].quoted;
    }
}

bool token_is_statement_word(TokenKind kind) { return rows[kind].class == STATEMENT; }

/* ---- characters ---- */

/* ASCII only, whatever the locale. */
static bool is_digit(char c) { return c >= '0' && c <= '9'; }
static bool is_letter(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
static bool is_word(char c) { return is_letter(c) || is_digit(c); }
static bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

/* The byte `ahead` of here; NUL behind the end. */
static char peek(const Lexer *lexer, uint32_t ahead)
{
    return ahead < lexer->length - lexer->at ? lexer->text[lexer->at + ahead] : '\0';
}

static bool is_next(const Lexer *lexer, const char *spelling)
{
    if (lexer->at == lexer->length || lexer->text[lexer->at] != spelling[0])
        return false; /* nearly always, and cheap */
    size_t length = strlen(spelling);
    return length <= lexer->length - lexer->at &&
           memcmp(lexer->text + lexer->at, spelling, length) == 0;
}

static Span span_from(const Lexer *lexer, uint32_t start)
{
    return (Span){lexer->source, start, lexer->at};
}

/* ---- tokens ---- */

static Token *add_token(Lexer *lexer, TokenKind kind, uint32_t start)
{
    Token token = {.kind = kind, .span = span_from(lexer, start)};
    if (lexer->doc.length > 0)
        token.doc = arena_copy_text(lexer->arena, lexer->doc.bytes, lexer->doc.length);
    lexer->doc.length = 0;
    array_push(lexer->arena, &lexer->tokens, token);
    return &lexer->tokens.items[lexer->tokens.count - 1];
}

static Diag *report(Lexer *lexer, DiagCode code, uint32_t start, const char *message,
                    const char *help)
{
    Diag *diag = diag_add(lexer->diags, code, span_from(lexer, start), "%s", message);
    diag->help = help;
    return diag;
}

/* ---- comments ---- */

/* Moves to `end`.  The bytes up to there, the inside of a comment or string, must be UTF-8. */
static void skip_text(Lexer *lexer, uint32_t end)
{
    bool reported = false;
    while (lexer->at < end) {
        uint32_t character, start = lexer->at;
        size_t   length = text_character(lexer->text + start, end - start, &character);
        lexer->at += length ? (uint32_t)length : 1;
        if (length == 0 && !reported) {
            report(lexer, DIAG_STRAY_BYTES, start, "bytes that are not UTF-8",
                   "save the file as UTF-8");
            reported = true;
        }
    }
}

/* Looked for once a line, however many strings there are in it. */
static uint32_t line_end(Lexer *lexer)
{
    if (lexer->line_end > lexer->at)
        return lexer->line_end;
    const char *start   = lexer->text + lexer->at;
    const char *newline = memchr(start, '\n', lexer->length - lexer->at);
    lexer->line_end     = newline ? (uint32_t)(newline - lexer->text) : lexer->length;
    return lexer->line_end;
}

/* `///` begins documentation, `//` and `////` do not. */
static void skip_line_comment(Lexer *lexer)
{
    uint32_t end = line_end(lexer);
    if (peek(lexer, 2) == '/' && peek(lexer, 3) != '/') {
        uint32_t first = lexer->at + (peek(lexer, 3) == ' ' ? 4 : 3), last = end;
        while (last > first && is_space(lexer->text[last - 1]))
            last--;
        if (lexer->doc.length > 0)
            text_add(&lexer->doc, "\n");
        if (last > first)
            text_add_bytes(&lexer->doc, lexer->text + first, last - first);
    }
    skip_text(lexer, end);
}

static void skip_block_comment(Lexer *lexer)
{
    uint32_t start = lexer->at, end = start + 2;
    while (end + 1 < lexer->length && (lexer->text[end] != '*' || lexer->text[end + 1] != '/'))
        end++;
    if (end + 1 < lexer->length) {
        skip_text(lexer, end + 2);
        return;
    }
    lexer->at   = start + 2;
    Diag *diag  = report(lexer, DIAG_UNCLOSED, start, "a comment is not closed",
                         "close it with `*/`");
    diag->label = "begins here";
    skip_text(lexer, lexer->length);
}

/* Skips what lies between tokens. */
static void skip_blank(Lexer *lexer)
{
    while (lexer->at < lexer->length) {
        if (is_space(peek(lexer, 0)))
            lexer->at++;
        else if (is_next(lexer, "//"))
            skip_line_comment(lexer);
        else if (is_next(lexer, "/*"))
            skip_block_comment(lexer);
        else
            return;
    }
}

/* ---- numbers and colours ---- */

static void skip_digits(Lexer *lexer)
{
    while (is_digit(peek(lexer, 0)))
        lexer->at++;
}

/* The value of a decimal number.  strtod is given its digits and an exponent, but no point: what
   it takes for one depends on the locale. */
static double read_decimal(Lexer *lexer, uint32_t start)
{
    Text      *digits   = &lexer->scratch;
    const long most     = 100000000; /* more than there can be digits */
    long       exponent = 0;
    bool       behind   = false; /* the point */
    digits->length      = 0;
    for (uint32_t i = start; i < lexer->at; i++) {
        char c = lexer->text[i];
        if (c == 'e') {
            long written = strtol(lexer->text + i + 1, NULL, 10);
            exponent += written > most ? most : written < -most ? -most : written;
            break;
        }
        if (is_digit(c)) {
            text_add_bytes(digits, &c, 1);
            exponent -= behind;
        }
        behind = behind || c == '.';
    }
    text_format(digits, "e%ld", exponent);
    return strtod(digits->bytes, NULL);
}

static void bad_number(Lexer *lexer, uint32_t start, const char *message, const char *help,
                       const char *instead)
{
    Diag *diag        = report(lexer, DIAG_BAD_NUMBER, start, message, help);
    diag->replacement = instead;
}

/* The fraction and the exponent; false when they are wrong and have been reported. */
static bool skip_fraction(Lexer *lexer, uint32_t start)
{
    bool exponent_follows = peek(lexer, 1) == 'e' && is_digit(peek(lexer, 2));
    if (peek(lexer, 0) == '.' && is_digit(peek(lexer, 1))) {
        lexer->at++;
        skip_digits(lexer);
    } else if (peek(lexer, 0) == '.' && peek(lexer, 1) != '.' &&
               (!is_letter(peek(lexer, 1)) || exponent_follows)) {
        int         length  = (int)(lexer->at - start);
        const char *instead = diag_text(lexer->diags, "%.*s.0", length, lexer->text + start);
        lexer->at++;
        bad_number(lexer, start, "a number needs digits behind its point", NULL, instead);
        return false;
    }
    if (peek(lexer, 0) != 'e')
        return true;
    uint32_t sign = peek(lexer, 1) == '-' || peek(lexer, 1) == '+';
    if (is_digit(peek(lexer, 1 + sign))) {
        lexer->at += 1 + sign;
        skip_digits(lexer);
    }
    return true;
}

/* What touches a number from behind: `deg`, or a mistake. */
static double read_unit(Lexer *lexer, uint32_t start, double number)
{
    uint32_t unit = lexer->at;
    while (is_word(peek(lexer, 0)))
        lexer->at++;
    uint32_t length = lexer->at - unit;
    if (isinf(number)) {
        bad_number(lexer, start, "a number that is too large", "the largest is about 1.8e308",
                   NULL);
        return 0;
    }
    if (length == 3 && memcmp(lexer->text + unit, "deg", 3) == 0)
        return number / 180 * M_PI;
    if (length > 0)
        bad_number(lexer, unit, "letters that do not belong to a number",
                   "the only unit is `deg`, as in `30deg`; a million is `1e6`", NULL);
    else if (peek(lexer, 0) == '.' && is_digit(peek(lexer, 1))) {
        lexer->at++;
        skip_digits(lexer);
        bad_number(lexer, start, "a number with two points", NULL, NULL);
    }
    return number;
}

static void lex_number(Lexer *lexer)
{
    uint32_t start  = lexer->at;
    double   number = 0;
    if (peek(lexer, 0) == '.') {
        lexer->at++;
        skip_digits(lexer);
        int length = (int)(lexer->at - start);
        bad_number(lexer, start, "a number needs digits before its point", NULL,
                   diag_text(lexer->diags, "0%.*s", length, lexer->text + start));
    } else {
        skip_digits(lexer);
        if (skip_fraction(lexer, start))
            number = read_unit(lexer, start, read_decimal(lexer, start));
    }
    while (is_word(peek(lexer, 0))) /* after a mistake */
        lexer->at++;
    add_token(lexer, TOKEN_NUMBER, start)->number[0] = number;
}

/* The sRGB curve of IEC 61966-2-1. */
void linear_from_srgb(uint32_t rgb, double linear[3])
{
    for (int i = 0; i < 3; i++) {
        double value = (rgb >> (16 - 8 * i) & 255) / 255.0;
        linear[i]    = value <= 0.04045 ? value / 12.92 : pow((value + 0.055) / 1.055, 2.4);
    }
}

static const char *six_digits(Lexer *lexer, uint32_t start)
{
    const char *d = lexer->text + start + 1;
    if (lexer->at - start != 4 || strspn(d, "0123456789abcdefABCDEF") < 3)
        return NULL;
    return diag_text(lexer->diags, "#%c%c%c%c%c%c", d[0], d[0], d[1], d[1], d[2], d[2]);
}

static void lex_colour(Lexer *lexer)
{
    uint32_t start = lexer->at++;
    while (is_word(peek(lexer, 0)))
        lexer->at++;
    const char *digits = lexer->text + start + 1;
    bool        good   = lexer->at - start == 7 && strspn(digits, "0123456789abcdefABCDEF") >= 6;
    if (!good)
        bad_number(lexer, start, "a colour has six hexadecimal digits", "for example `#c8553d`",
                   six_digits(lexer, start));
    Token        *token = add_token(lexer, TOKEN_COLOUR, start);
    unsigned long rgb   = good ? strtoul(digits, NULL, 16) : 0;
    linear_from_srgb((uint32_t)rgb, token->number);
}

/* ---- strings ---- */

/* Adds what a backslash and the byte after it mean. */
static void read_escape(Lexer *lexer)
{
    uint32_t start = lexer->at;
    char     c     = peek(lexer, 1);
    lexer->at += 2;
    if (c == 'n')
        text_add(&lexer->scratch, "\n");
    else if (c == 't')
        text_add(&lexer->scratch, "\t");
    else if (c == '"' || c == '\\' || c == '\'')
        text_add_bytes(&lexer->scratch, &c, 1);
    else {
        lexer->at = start + 1;
        report(lexer, DIAG_STRAY_BYTES, start, "a backslash that means nothing",
               "there are \\\\, \\\", \\n and \\t");
    }
}

/* Other bytes of a string, up to `end`; control bytes have no place in a name of a file. */
static void read_plain(Lexer *lexer, uint32_t end)
{
    uint32_t start = lexer->at;
    skip_text(lexer, end);
    for (uint32_t i = start; i < end; i++) {
        unsigned char c = (unsigned char)lexer->text[i];
        if (c >= 0x20 || c == '\t')
            continue;
        diag_add(lexer->diags, DIAG_STRAY_BYTES, (Span){lexer->source, i, i + 1},
                 "a control character in a string");
        return;
    }
    text_add_bytes(&lexer->scratch, lexer->text + start, end - start);
}

static void lex_string(Lexer *lexer, char quote)
{
    uint32_t start = lexer->at++, end = line_end(lexer);
    if (end > lexer->at && lexer->text[end - 1] == '\r')
        end--;
    lexer->scratch.length = 0;
    text_add(&lexer->scratch, "");
    while (lexer->at < end && peek(lexer, 0) != quote) {
        uint32_t next = lexer->at;
        while (next < end && lexer->text[next] != quote && lexer->text[next] != '\\')
            next++;
        if (next > lexer->at)
            read_plain(lexer, next);
        else if (next + 1 < end)
            read_escape(lexer);
        else
            lexer->at++;
    }
    if (lexer->at < end) {
        lexer->at++;
        if (quote == '\'') {
            Diag *diag = report(lexer, DIAG_UNEXPECTED_TOKEN, start, "a string in single quotes",
                                NULL);
            diag->help = "strings have double quotes";
            diag->replacement = diag_text(lexer->diags, "\"%s\"", lexer->scratch.bytes);
        }
    } else {
        Diag *diag  = report(lexer, DIAG_UNCLOSED, start, "a string is not closed",
                             "close it with a quote on the same line");
        diag->label = "begins here";
        add_token(lexer, TOKEN_ERROR, start); /* it has swallowed the rest of the statement */
        return;
    }
    const Text *read                            = &lexer->scratch;
    add_token(lexer, TOKEN_STRING, start)->name = name_intern(lexer->names, read->bytes,
                                                              read->length);
}

/* ---- words and signs ---- */

static void lex_word(Lexer *lexer)
{
    uint32_t start = lexer->at;
    while (is_word(peek(lexer, 0)))
        lexer->at++;
    uint32_t    length = lexer->at - start;
    const char *word   = lexer->text + start;
    TokenKind   kind   = 0;
    while (kind < TOKEN_KIND_COUNT &&
           (rows[kind].length != length || memcmp(rows[kind].spelling, word, length) != 0))
        kind++;
    const char *name = name_intern(lexer->names, word, length);
    add_token(lexer, kind < TOKEN_KIND_COUNT ? kind : TOKEN_NAME, start)->name = name;
}

/* Signs of other languages and of typographers, and what they are here. */
typedef struct Lookalike {
    const char *sign, *instead;
    TokenKind   kind; /* TOKEN_ERROR: of no use to the parser; TOKEN_END: a blank */
} Lookalike;

static const Lookalike lookalikes[] = {
    {"&&", "and", TOKEN_AND},
    {"||", "or", TOKEN_OR},
    {"**", "^", TOKEN_CARET},
    {"===", "==", TOKEN_EQUAL_EQUAL},
    {"!==", "!=", TOKEN_NOT_EQUAL},
    {"<>", "!=", TOKEN_NOT_EQUAL},
    {"=>", ">=", TOKEN_GREATER_EQUAL},
    {"=<", "<=", TOKEN_LESS_EQUAL},
    {"\xE2\x88\x92", "-", TOKEN_MINUS}, /* minus */
    {"\xE2\x80\x93", "-", TOKEN_MINUS}, /* dash */
    {"\xC3\x97", "*", TOKEN_STAR},      /* multiplication cross */
    {"\xC2\xB7", "*", TOKEN_STAR},      /* multiplication point */
    {"\xC3\xB7", "/", TOKEN_SLASH},     /* division */
    {"\xE2\x89\xA4", "<=", TOKEN_LESS_EQUAL},
    {"\xE2\x89\xA5", ">=", TOKEN_GREATER_EQUAL},
    {"\xE2\x89\xA0", "!=", TOKEN_NOT_EQUAL},
    {"\xC2\xB2", "^2", TOKEN_ERROR},
    {"\xC2\xB3", "^3", TOKEN_ERROR},
    {"\xC2\xB0", "deg", TOKEN_ERROR},
    {"\xCF\x80", "pi", TOKEN_ERROR},
    {"\xE2\x80\x9C", "\"", TOKEN_ERROR}, /* quotes */
    {"\xE2\x80\x9D", "\"", TOKEN_ERROR},
    {"\xE2\x80\x98", "\"", TOKEN_ERROR},
    {"\xE2\x80\x99", "\"", TOKEN_ERROR},
    {"\xC2\xA0", " ", TOKEN_END}, /* no-break space */
};

static bool lex_lookalike(Lexer *lexer)
{
    for (size_t i = 0; i < sizeof lookalikes / sizeof *lookalikes; i++) {
        const Lookalike *found = &lookalikes[i];
        if (!is_next(lexer, found->sign))
            continue;
        uint32_t start = lexer->at;
        lexer->at += (uint32_t)strlen(found->sign);
        bool  ascii = (found->sign[0] & 0x80) == 0;
        Diag *diag  = report(lexer, ascii ? DIAG_UNEXPECTED_TOKEN : DIAG_STRAY_BYTES, start, "",
                             NULL);
        diag->replacement = found->instead;
        diag->message = diag_text(lexer->diags, "`%s` is not part of the language", found->sign);
        if (found->kind == TOKEN_END)
            diag->message = "a no-break space, which looks like a space and is none";
        else
            add_token(lexer, found->kind, start);
        return true;
    }
    return false;
}

static bool lex_sign(Lexer *lexer)
{
    for (TokenKind kind = 0; kind < TOKEN_KIND_COUNT; kind++) {
        bool sign = rows[kind].class == PUNCTUATION || rows[kind].class == OPERATOR;
        if (sign && is_next(lexer, rows[kind].spelling)) {
            uint32_t start = lexer->at;
            lexer->at += rows[kind].length;
            add_token(lexer, kind, start);
            return true;
        }
    }
    return false;
}

/* The bytes that a token or a blank can begin with; those that lookalikes begin with may mean
   nothing as well.  A file that is no text has millions of others in a row. */
static void find_beginnings(bool begins[256])
{
    for (int c = 1; c < 128; c++)
        begins[c] = is_word((char)c) || is_space((char)c) ||
                    strchr("#\"'!()[]{},;:.=<>+-*/%^&|", c);
    for (size_t i = 0; i < sizeof lookalikes / sizeof *lookalikes; i++)
        begins[(unsigned char)lookalikes[i].sign[0]] = true;
}

/* Whether a token that means something, or a blank, can begin here. */
static bool is_known_byte(const Lexer *lexer)
{
    unsigned char c = (unsigned char)peek(lexer, 0);
    if (c < 128 || !lexer->begins[c])
        return lexer->begins[c];
    for (size_t i = 0; i < sizeof lookalikes / sizeof *lookalikes; i++)
        if (is_next(lexer, lookalikes[i].sign))
            return true;
    return false;
}

/* A `!` alone, or a run of bytes that no token begins with. */
static void lex_stray(Lexer *lexer)
{
    uint32_t start = lexer->at;
    if (peek(lexer, 0) == '!') {
        lexer->at++;
        report(lexer, DIAG_UNEXPECTED_TOKEN, start, "`!` is not part of the language", NULL)
            ->replacement = "not";
        add_token(lexer, TOKEN_NOT, start);
        return;
    }
    bool utf8 = true;
    do {
        uint32_t    character;
        const char *here   = lexer->text + lexer->at;
        size_t      length = text_character(here, lexer->length - lexer->at, &character);
        utf8               = utf8 && length > 0;
        lexer->at += length ? (uint32_t)length : 1;
    } while (lexer->at < lexer->length && !is_known_byte(lexer));

    const char *help = NULL;
    if (!utf8)
        help = "save the file as UTF-8";
    else if (lexer->text[start] == '?')
        help = "to choose between two values write `if a < b then a else b`";
    report(lexer, DIAG_STRAY_BYTES, start,
           utf8 ? "characters that mean nothing here" : "bytes that are not UTF-8", help);
    add_token(lexer, TOKEN_ERROR, start);
}

static void lex_token(Lexer *lexer)
{
    char c = peek(lexer, 0);
    if (is_letter(c))
        lex_word(lexer);
    else if (is_digit(c) || (c == '.' && is_digit(peek(lexer, 1))))
        lex_number(lexer);
    else if (c == '#')
        lex_colour(lexer);
    else if (c == '"' || c == '\'')
        lex_string(lexer, c);
    else if (!lex_lookalike(lexer) && !lex_sign(lexer))
        lex_stray(lexer);
}

Tokens lex(uint32_t source, const Sources *sources, Names *names, Diags *diags, Arena *arena)
{
    const Source *text  = &sources->items[source];
    Lexer         lexer = {.text    = text->text,
                           .length  = text->length,
                           .source  = source,
                           .names   = names,
                           .diags   = diags,
                           .arena   = arena,
                           .doc     = {.arena = arena},
                           .scratch = {.arena = arena}};
    if (is_next(&lexer, "\xEF\xBB\xBF")) /* a byte order mark */
        lexer.at = 3;
    find_beginnings(lexer.begins);
    skip_blank(&lexer);
    while (lexer.at < lexer.length && !diags_full(diags)) {
        lex_token(&lexer);
        skip_blank(&lexer);
    }
    lexer.at = lexer.length;
    add_token(&lexer, TOKEN_END, lexer.length);
    return lexer.tokens;
}

/* ---- dump ---- */

void tokens_print(const Tokens *tokens, const Sources *sources, Text *out)
{
    for (size_t i = 0; i < tokens->count; i++) {
        const Token  *token    = &tokens->items[i];
        const Source *source   = &sources->items[token->span.source];
        Position      position = source_position(source, token->span.start);
        text_format(out, "%u:%u %s", position.line, position.column, token_kind_text(token->kind));
        if (token->kind != TOKEN_END && rows[token->kind].length == 0) {
            text_add(out, " ");
            text_add_bytes(out, source->text + token->span.start,
                           token->span.end - token->span.start);
        }
        text_add(out, "\n");
    }
}
