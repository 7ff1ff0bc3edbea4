/*
 * lex_literals.c: tokens with a value: numbers, colours and strings.
 */
#include "compiler/front/lexer.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/base/srgb.h"
#include "compiler/front/synonyms.h"

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

static double decimal(Lexer *lexer, uint32_t start)
{
    return text_decimal(&lexer->scratch, lexer->text + start, lexer->at - start);
}

void lex_number(Lexer *lexer)
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

void lex_colour(Lexer *lexer)
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

void lex_string(Lexer *lexer, char quote)
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
