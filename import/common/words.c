/*
 * words.c: the words of files that describe scenes as programs do.
 */
#include "import/common/words.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool skip_comment(WordReader *reader)
{
    unsigned start = reader->line, depth = 0;
    do {
        if (reader->at[0] == '\0')
            return import_refuse(reader->import, start, "this comment has no end");
        bool opens = strncmp(reader->at, "/*", 2) == 0 && (reader->nested || depth == 0);
        bool ends  = strncmp(reader->at, "*/", 2) == 0;
        depth += opens ? 1u : 0u;
        depth -= ends ? 1u : 0u;
        reader->line += *reader->at == '\n';
        reader->at += opens || ends ? 2 : 1;
    } while (depth > 0);
    return true;
}

static bool skip_blanks(WordReader *reader)
{
    for (;;) {
        if (isspace((unsigned char)*reader->at))
            reader->line += *reader->at++ == '\n';
        else if (strncmp(reader->at, "//", 2) == 0)
            reader->at += strcspn(reader->at, "\n");
        else if (strncmp(reader->at, "/*", 2) != 0)
            return true;
        else if (!skip_comment(reader))
            return false;
    }
}

static bool read_number(WordReader *reader)
{
    char *end;
    if (reader->at[0] == '0' && tolower((unsigned char)reader->at[1]) == 'x')
        return import_refuse(reader->import, reader->line, "`%.10s` is not a decimal number",
                             reader->at);
    reader->word.kind   = IMPORT_WORD_NUMBER;
    reader->word.number = strtod(reader->at, &end);
    reader->word.text   = arena_copy_text(reader->import->arena, reader->at,
                                          (size_t)(end - reader->at));
    reader->at          = end;
    return isfinite(reader->word.number) ||
           import_refuse(reader->import, reader->line, "`%.40s` is too large a number",
                         reader->word.text);
}

/* Tells whether an odd number of `\` stands before. */
static bool is_escaped(const char *text, size_t at)
{
    size_t count = 0;
    while (count < at && text[at - 1 - count] == '\\')
        count++;
    return count % 2 == 1;
}

static bool read_string(WordReader *reader)
{
    size_t length = strcspn(reader->at + 1, "\"\n");
    while (length > 0 && reader->at[1 + length] == '"' && is_escaped(reader->at + 1, length))
        length += 1 + strcspn(reader->at + 2 + length, "\"\n");
    if (reader->at[1 + length] != '"')
        return import_refuse(reader->import, reader->line, "this string has no end");
    reader->word.kind = IMPORT_WORD_STRING;
    reader->word.text = arena_copy_text(reader->import->arena, reader->at + 1, length);
    reader->at += length + 2;
    return true;
}

static bool read_word(WordReader *reader)
{
    unsigned char first  = (unsigned char)reader->at[0];
    size_t        length = 1;
    if (isdigit(first) || (first == '.' && isdigit((unsigned char)reader->at[1])))
        return read_number(reader);
    if (first == '"')
        return read_string(reader);
    if (first >= 0x7f || first < ' ')
        return import_refuse(reader->import, reader->line, "a byte of %u stands between words",
                             first);
    reader->word.kind = IMPORT_WORD_SIGN;
    if (isalpha(first) || first == '_' || first == '$') {
        reader->word.kind = IMPORT_WORD_NAME;
        while (isalnum((unsigned char)reader->at[length]) || reader->at[length] == '_')
            length++;
    }
    reader->word.text = arena_copy_text(reader->import->arena, reader->at, length);
    reader->at += length;
    return true;
}

void words_advance_plain(WordReader *reader)
{
    bool good    = reader->import->refusal.length == 0 && skip_blanks(reader);
    reader->word = (ImportWord){.kind = IMPORT_WORD_END, .text = "", .line = reader->line};
    if (good && *reader->at != '\0' && !read_word(reader))
        reader->word = (ImportWord){.kind = IMPORT_WORD_END, .text = "", .line = reader->line};
}

void words_advance(WordReader *reader)
{
    if (reader->next)
        reader->next(reader);
    else
        words_advance_plain(reader);
}

void words_start(WordReader *reader, Import *import, bool nested)
{
    *reader = (WordReader){.import = import, .at = import->bytes, .line = 1, .nested = nested};
    words_advance(reader);
}

bool word_is(const WordReader *reader, const char *text)
{
    return (reader->word.kind == IMPORT_WORD_NAME || reader->word.kind == IMPORT_WORD_SIGN) &&
           strcmp(reader->word.text, text) == 0;
}

int word_index(const WordReader *reader, const char *const *names, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (word_is(reader, names[i]))
            return (int)i;
    return -1;
}

bool word_accept(WordReader *reader, const char *text)
{
    if (!word_is(reader, text))
        return false;
    words_advance(reader);
    return true;
}

bool word_refuse(WordReader *reader, const char *what)
{
    if (reader->word.kind == IMPORT_WORD_END)
        return import_refuse(reader->import, reader->word.line,
                             "the file ends where there should be %s", what);
    return import_refuse(reader->import, reader->word.line, "there should be %s, not `%.40s`", what,
                         reader->word.text);
}

bool word_expect(WordReader *reader, const char *text)
{
    Text quoted = {.arena = reader->import->arena};
    if (word_accept(reader, text))
        return true;
    text_format(&quoted, "`%s`", text);
    return word_refuse(reader, quoted.bytes);
}
