/*
 * lexer.c: from bytes to tokens.
 *
 * Keywords and signs come from token.def.  Authors who know other languages write `&&`, 'text' or a
 * curly quote.  These are reported with a replacement, and become the token that was meant, so that
 * one mistake is one error.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/base/srgb.h"
#include "compiler/front/synonyms.h"
#include "compiler/front/token.h"

typedef struct Lexer {
    const char *text;
    uint32_t    length, at; /* bytes of the text; offset of the next byte */
    uint32_t    source;
    uint32_t    line_end; /* result of the last find_line_end, or 0 */
    Names      *names;
    Diags      *diags;
    Arena      *arena;
    Tokens      tokens;
    Text        doc;     /* the `///` lines since the last token */
    Text        scratch; /* the string being read */
    /* The properties of a token by its first byte, as find_beginnings fills them. */
    bool    begins[256];    /* whether something can begin with it */
    bool    lookalike[256]; /* whether a lookalike can */
    uint8_t sign[256];      /* the first kind of token that is a sign and begins with it */
} Lexer;

/* ---- characters ---- */

/* Tells whether a character is a digit of ASCII, whatever the locale. */
static bool is_digit(char c) { return c >= '0' && c <= '9'; }
static bool is_letter(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
static bool is_word(char c) { return is_letter(c) || is_digit(c); }
static bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

/* Returns the byte that is `ahead` bytes behind the next one; NUL beyond the end. */
static char peek(const Lexer *lexer, uint32_t ahead)
{
    return ahead < lexer->length - lexer->at ? lexer->text[lexer->at + ahead] : '\0';
}

static Span span_from(const Lexer *lexer, uint32_t start)
{
    return (Span){lexer->source, start, lexer->at};
}

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

bool token_opens(TokenKind kind)
{
    return kind == TOKEN_LEFT_PAREN || kind == TOKEN_LEFT_BRACKET || kind == TOKEN_LEFT_BRACE;
}

bool token_closes(TokenKind kind)
{
    return kind == TOKEN_RIGHT_PAREN || kind == TOKEN_RIGHT_BRACKET || kind == TOKEN_RIGHT_BRACE;
}

size_t token_statements(const char **words)
{
    size_t count = 0;
    for (TokenKind kind = 0; kind < TOKEN_KIND_COUNT; kind++)
        if ((token_is_statement_word(kind) && kind != TOKEN_KRS) || kind == TOKEN_FOR ||
            kind == TOKEN_IF)
            words[count++] = rows[kind].spelling;
    return count;
}

static bool is_next(const Lexer *lexer, const char *spelling)
{
    if (lexer->at == lexer->length || lexer->text[lexer->at] != spelling[0])
        return false; /* the usual case, decided by one comparison */
    size_t length = strlen(spelling);
    return length <= lexer->length - lexer->at &&
           memcmp(lexer->text + lexer->at, spelling, length) == 0;
}

/* ---- tokens ---- */

/* Adds the token from `start` up to here, with the documentation before it. */
static Token *add_token(Lexer *lexer, TokenKind kind, uint32_t start)
{
    Token token = {.kind = kind, .span = span_from(lexer, start)};
    if (lexer->doc.length > 0)
        token.doc = arena_copy_text(lexer->arena, lexer->doc.bytes, lexer->doc.length);
    lexer->doc.length = 0;
    array_push_large(lexer->arena, &lexer->tokens, token);
    return &lexer->tokens.items[lexer->tokens.count - 1];
}

/* Reports a mistake in the bytes from `start` up to here; `help` may be NULL. */
static Diag *report_from(Lexer *lexer, DiagCode code, uint32_t start, const char *message,
                         const char *help)
{
    Diag *diag = diag_add(lexer->diags, code, span_from(lexer, start), "%s", message);
    diag->help = help;
    return diag;
}

/* ---- comments ---- */

/* Skips the inside of a comment or string, up to `end`.  Bytes that are not UTF-8 are reported. */
static void skip_text(Lexer *lexer, uint32_t end)
{
    bool reported = false;
    while (lexer->at < end) {
        uint32_t character, start = lexer->at;
        size_t   length = text_character(lexer->text + start, end - start, &character);
        lexer->at += length ? (uint32_t)length : 1;
        if ((length == 0 || character == 0) && !reported) {
            report_from(lexer, DIAG_STRAY_BYTES, start,
                        length == 0 ? "bytes that are not UTF-8" : "a zero byte, which no text has",
                        "save the file as UTF-8");
            reported = true;
        }
    }
}

/* Returns the offset of the end of the line that is being read.  It is stored, so that a line with
   many strings is searched once. */
static uint32_t find_line_end(Lexer *lexer)
{
    if (lexer->line_end > lexer->at)
        return lexer->line_end;
    const char *start   = lexer->text + lexer->at;
    const char *newline = memchr(start, '\n', lexer->length - lexer->at);
    lexer->line_end     = newline ? (uint32_t)(newline - lexer->text) : lexer->length;
    return lexer->line_end;
}

/* Skips a comment of a line; `///` begins documentation, `//` and `////` do not. */
static void skip_line_comment(Lexer *lexer)
{
    uint32_t end = find_line_end(lexer);
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
    Diag *diag  = report_from(lexer, DIAG_UNCLOSED, start, "a comment is not closed",
                              "close it with `*/`");
    diag->label = "begins here";
    skip_text(lexer, lexer->length);
}

/* Skips spaces and comments. */
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

/* A sign of other languages or of typography, and what is written instead in this language. */
typedef struct Lookalike {
    const char *sign, *instead;
    TokenKind   kind; /* the token it becomes; TOKEN_ERROR: not one token; TOKEN_END: a space */
    const char *help; /* where it may mean something else, too; or NULL */
} Lookalike;

static const Lookalike lookalikes[] = {
    {"&&", "and", TOKEN_AND, NULL},
    {"||", "or", TOKEN_OR, NULL},
    {"**", "^", TOKEN_CARET, NULL},
    {"===", "==", TOKEN_EQUAL_EQUAL, NULL},
    {"!==", "!=", TOKEN_NOT_EQUAL, NULL},
    {"<>", "!=", TOKEN_NOT_EQUAL, NULL},
    {"=>", NULL, TOKEN_GREATER_EQUAL, "a function is `def f(a) = a + 1;`, and at least is `>=`"},
    {"=<", "<=", TOKEN_LESS_EQUAL, NULL},
    {"\xE2\x88\x92", "-", TOKEN_MINUS, NULL}, /* minus */
    {"\xE2\x80\x93", "-", TOKEN_MINUS, NULL}, /* dash */
    {"\xC3\x97", "*", TOKEN_STAR, NULL},      /* multiplication cross */
    {"\xC2\xB7", "*", TOKEN_STAR, NULL},      /* multiplication point */
    {"\xC3\xB7", "/", TOKEN_SLASH, NULL},     /* division */
    {"\xE2\x89\xA4", "<=", TOKEN_LESS_EQUAL, NULL},
    {"\xE2\x89\xA5", ">=", TOKEN_GREATER_EQUAL, NULL},
    {"\xE2\x89\xA0", "!=", TOKEN_NOT_EQUAL, NULL},
    {"\xC2\xB2", "^2", TOKEN_ERROR, NULL},
    {"\xC2\xB3", "^3", TOKEN_ERROR, NULL},
    {"\xC2\xB0", "deg", TOKEN_ERROR, NULL},
    {"\xCF\x80", "pi", TOKEN_ERROR, NULL},
    {"\xE2\x80\x9C", "\"", TOKEN_ERROR, NULL}, /* quotes */
    {"\xE2\x80\x9D", "\"", TOKEN_ERROR, NULL},
    {"\xE2\x80\x98", "\"", TOKEN_ERROR, NULL},
    {"\xE2\x80\x99", "\"", TOKEN_ERROR, NULL},
    {"\xC2\xA0", " ", TOKEN_END, NULL}, /* no-break space */
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
        Diag *diag = report_from(lexer, ascii ? DIAG_UNEXPECTED_TOKEN : DIAG_STRAY_BYTES, start, "",
                                 NULL);
        diag->replacement = found->instead;
        diag->help        = found->help;
        diag->message = diag_text(lexer->diags, "`%s` is not part of the language", found->sign);
        if (found->kind == TOKEN_END)
            diag->message = "a no-break space, which looks like a space and is none";
        else
            add_token(lexer, found->kind, start);
        return true;
    }
    return false;
}

static bool is_sign(TokenKind kind)
{
    return rows[kind].class == PUNCTUATION || rows[kind].class == OPERATOR;
}

static bool lex_sign(Lexer *lexer)
{
    TokenKind first = lexer->sign[(unsigned char)peek(lexer, 0)];
    for (TokenKind kind = first; kind < TOKEN_KIND_COUNT; kind++) {
        if (is_sign(kind) && is_next(lexer, rows[kind].spelling)) {
            uint32_t start = lexer->at;
            lexer->at += rows[kind].length;
            add_token(lexer, kind, start);
            return true;
        }
    }
    return false;
}

/* Finds the bytes with which a token, a space or a lookalike can begin.  A table is fast: a file
   that is not text may have millions of other bytes in a row. */
static void find_beginnings(Lexer *lexer)
{
    for (int c = 1; c < 128; c++)
        lexer->begins[c] = is_word((char)c) || is_space((char)c) ||
                           strchr("#\"'!()[]{},;:.=<>+-*/%^&|", c);
    for (size_t i = 0; i < sizeof lookalikes / sizeof *lookalikes; i++)
        lexer->lookalike[(unsigned char)lookalikes[i].sign[0]] = true;
    for (int c = 0; c < 256; c++)
        lexer->begins[c] = lexer->begins[c] || lexer->lookalike[c];
    memset(lexer->sign, TOKEN_KIND_COUNT, sizeof lexer->sign);
    for (TokenKind kind = TOKEN_KIND_COUNT; kind-- > 0;)
        if (is_sign(kind))
            lexer->sign[(unsigned char)rows[kind].spelling[0]] = (uint8_t)kind;
}

/* Tells whether a token, a space or a lookalike begins here. */
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

/* Reads a `!`, or a run of bytes with which no token begins. */
static void lex_stray(Lexer *lexer)
{
    uint32_t start = lexer->at;
    if (peek(lexer, 0) == '!') {
        lexer->at++;
        report_from(lexer, DIAG_UNEXPECTED_TOKEN, start, "`!` is not part of the language", NULL)
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
    else if (lexer->text[start] == '$')
        help = form_help(lexer->diags, FORM_DOLLAR);
    else if (lexer->text[start] == '~')
        help = form_help(lexer->diags, FORM_TILDE);
    report_from(lexer, DIAG_STRAY_BYTES, start,
                utf8 ? "characters that mean nothing here" : "bytes that are not UTF-8", help);
    add_token(lexer, TOKEN_ERROR, start);
}

/* ---- numbers and colours ---- */

static void skip_digits(Lexer *lexer)
{
    while (is_digit(peek(lexer, 0)))
        lexer->at++;
}

static void bad_number(Lexer *lexer, uint32_t start, const char *message, const char *help,
                       const char *instead)
{
    Diag *diag        = report_from(lexer, DIAG_BAD_NUMBER, start, message, help);
    diag->replacement = instead;
}

/* Skips the fraction and the exponent of a number; false after a mistake, which is reported. */
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

/* Reads letters directly behind a number: the unit `deg`, or a mistake.  Returns the number, an
   angle in radians. */
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
                   lexer->text[unit] == 'x' && number == 0
                       ? form_help(lexer->diags, FORM_HEXADECIMAL)
                       : "the only unit is `deg`, as in `30deg`; a million is `1e6`",
                   NULL);
    else if (peek(lexer, 0) == '.' && is_digit(peek(lexer, 1))) {
        lexer->at++;
        skip_digits(lexer);
        bad_number(lexer, start, "a number with two points", NULL, NULL);
    }
    return number;
}

static double decimal(const Lexer *lexer, uint32_t start)
{
    return text_decimal(lexer->text + start, lexer->at - start);
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
            number = read_unit(lexer, start, decimal(lexer, start));
    }
    while (is_word(peek(lexer, 0))) /* there are letters left after a mistake only */
        lexer->at++;
    add_token(lexer, TOKEN_NUMBER, start)->number = number;
}

void linear_from_srgb(uint32_t rgb, double linear[3])
{
    for (int i = 0; i < 3; i++)
        linear[i] = linear_of_srgb((rgb >> (16 - 8 * i) & 255) / 255.0);
}

static const char *six_digits(Lexer *lexer, uint32_t start)
{
    const char *d = lexer->text + start + 1;
    if (lexer->at - start != 4 || strspn(d, "0123456789abcdefABCDEF") < 3)
        return NULL;
    return diag_text(lexer->diags, "#%c%c%c%c%c%c", d[0], d[0], d[1], d[1], d[2], d[2]);
}

static void bad_colour(Lexer *lexer, uint32_t start)
{
    const char *instead = six_digits(lexer, start);
    if (instead)
        bad_number(lexer, start, "a colour has six digits, not three",
                   "each digit is written twice", instead);
    else
        bad_number(lexer, start, "a colour has six hexadecimal digits", "for example `#c8553d`",
                   NULL);
}

/* Reports a directive of another language, as in `#include`; false: it is none. */
static bool lex_directive(Lexer *lexer, uint32_t start)
{
    int         length = (int)(lexer->at - start);
    const char *text   = diag_text(lexer->diags, "%.*s", length, lexer->text + start);
    if (!is_synonym(SYNONYM_DIRECTIVE, text + 1))
        return false;
    Diag *diag    = report_from(lexer, DIAG_UNEXPECTED_TOKEN, start, "", NULL);
    diag->message = diag_text(lexer->diags, "`%s` is not part of the language", text);
    explain_word(lexer->diags, diag, SYNONYM_DIRECTIVE, text + 1, "");
    add_token(lexer, TOKEN_ERROR, start);
    return true;
}

/* Reports a comment of another language and skips it: a `#` with nothing behind it, or a blank. */
static void lex_foreign_comment(Lexer *lexer, uint32_t start)
{
    report_from(lexer, DIAG_UNEXPECTED_TOKEN, start, "`#` begins colours",
                "comments begin with `//`");
    while (peek(lexer, 0) != '\n' && peek(lexer, 0) != '\0')
        lexer->at++;
}

static void lex_colour(Lexer *lexer)
{
    uint32_t start = lexer->at++;
    if (strchr(" \t\r\n#", peek(lexer, 0))) { /* or the end of the text */
        lex_foreign_comment(lexer, start);
        return;
    }
    while (is_word(peek(lexer, 0)))
        lexer->at++;
    const char *digits = lexer->text + start + 1;
    bool        good   = lexer->at - start == 7 && strspn(digits, "0123456789abcdefABCDEF") >= 6;
    if (!good && lex_directive(lexer, start))
        return;
    if (!good)
        bad_colour(lexer, start);
    unsigned long rgb                          = good ? strtoul(digits, NULL, 16) : 0;
    add_token(lexer, TOKEN_COLOUR, start)->rgb = (uint32_t)rgb;
}

/* ---- strings ---- */

/* Reads a backslash and the byte after it, and adds the character that they stand for. */
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
        report_from(lexer, DIAG_STRAY_BYTES, start, "a backslash that means nothing",
                    "there are \\\\, \\\", \\n and \\t");
    }
}

/* Adds the bytes of a string up to `end`, which have no escapes.  Control characters are reported,
   since strings are mostly names of files. */
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
    uint32_t start = lexer->at++, end = find_line_end(lexer);
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
            Diag *diag        = report_from(lexer, DIAG_UNEXPECTED_TOKEN, start,
                                            "a string in single quotes", NULL);
            diag->help        = "strings have double quotes";
            diag->replacement = diag_text(lexer->diags, "\"%s\"", lexer->scratch.bytes);
        }
    } else {
        Diag *diag  = report_from(lexer, DIAG_UNCLOSED, start, "a string is not closed",
                                  "close it with a quote on the same line");
        diag->label = "begins here";
        add_token(lexer, TOKEN_ERROR, start); /* the rest of the statement is in the string */
        return;
    }
    const Text *read                            = &lexer->scratch;
    add_token(lexer, TOKEN_STRING, start)->name = name_intern(lexer->names, read->bytes,
                                                              read->length);
}

/* ---- texts ---- */

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
    else if (!(lexer->lookalike[(unsigned char)c] && lex_lookalike(lexer)) && !lex_sign(lexer))
        lex_stray(lexer);
}

/* Tells whether this is a picture or a program instead of a scene: near its beginning there are zero bytes
   as well as bytes that are not UTF-8. */
static bool is_binary(const Source *source)
{
    enum { BEGINNING = 4096 };
    uint32_t end  = source->length < BEGINNING ? source->length : BEGINNING;
    bool     zero = false, stray = false;
    for (uint32_t at = 0; at < end && !(zero && stray);) {
        uint32_t character;
        size_t   length = text_character(source->text + at, source->length - at, &character);
        zero            = zero || (length > 0 && character == 0);
        stray           = stray || length == 0;
        at += length ? (uint32_t)length : 1;
    }
    return zero && stray;
}

Tokens lex(uint32_t source, const Sources *sources, Names *names, Diags *diags, Arena *arena)
{
    const Source *text  = &sources->items[source];
    Lexer         lexer = {.text    = text->text,
                           .length  = text->length,
                           .at      = text->lines[0],
                           .source  = source,
                           .names   = names,
                           .diags   = diags,
                           .arena   = arena,
                           .doc     = {.arena = arena},
                           .scratch = {.arena = arena}};
    if (is_binary(text)) {
        report_from(&lexer, DIAG_STRAY_BYTES, lexer.at, "this file is not a text",
                    "a scene is a text, for example `show sphere(1);`");
        lexer.at = lexer.length;
    }
    find_beginnings(&lexer);
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
