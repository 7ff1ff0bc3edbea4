/*
 * json.c: `read_json`: JSON, RFC 8259: arrays are lists, objects are records, null is an empty list.
 */
#include "compiler/eval/data/data.h"

#include <string.h>

enum { MAX_LEVELS = 200, MAX_MEMBERS = 1000 };

static char here(const DataText *data) { return data->text[data->at]; }

static void skip_blanks(DataText *data)
{
    while (here(data) && strchr(" \t\r\n", here(data)))
        data->at++;
}

/* Reports what stands here instead of what is expected; false. */
static bool unexpected(DataText *data, const char *expected)
{
    bool        end     = data->at >= data->length;
    const char *found   = end ? ", found the end of the file" : "";
    const char *message = diag_text(data->e->diags, "expected %s%s", expected, found);
    data_error(data, data->at, data->at + !end, message);
    return false;
}

/* ---- strings ---- */

/* Returns the value of four hexadecimal digits; UINT32_MAX: there are none. */
static uint32_t hexadecimal(const char *digits)
{
    uint32_t number = 0;
    for (int i = 0; i < 4; i++) {
        static const char all[] = "0123456789abcdefABCDEF";
        const char       *digit = digits[i] ? strchr(all, digits[i]) : NULL;
        if (!digit)
            return UINT32_MAX;
        uint32_t value = (uint32_t)(digit - all);
        number         = 16 * number + (value < 16 ? value : value - 6);
    }
    return number;
}

static void add_character(Text *text, uint32_t c)
{
    char     bytes[4];
    uint32_t count = c < 0x80 ? 1 : c < 0x800 ? 2 : c < 0x10000 ? 3 : 4;
    for (uint32_t i = count; i-- > 1; c >>= 6)
        bytes[i] = (char)(0x80 | (c & 0x3F));
    static const uint32_t lead[] = {0, 0, 0xC0, 0xE0, 0xF0};
    bytes[0]                     = (char)(lead[count] | c);
    text_add_bytes(text, bytes, count);
}

/* Reads, behind `\u`, a character, or the two halves of one above U+FFFF. */
static bool read_code(DataText *data)
{
    uint32_t code = hexadecimal(data->text + data->at), low = UINT32_MAX;
    if (code == UINT32_MAX)
        return false;
    data->at += 4;
    if (code >= 0xD800 && code < 0xDC00 && strncmp(data->text + data->at, "\\u", 2) == 0)
        low = hexadecimal(data->text + data->at + 2);
    if (low >= 0xDC00 && low <= 0xDFFF) {
        code = 0x10000 + ((code - 0xD800) << 10) + (low - 0xDC00);
        data->at += 6;
    }
    if (code >= 0xD800 && code <= 0xDFFF) /* half of a character */
        return false;
    add_character(&data->scratch, code);
    return true;
}

/* Reads a backslash and what follows it. */
static bool read_escape(DataText *data)
{
    static const char written[] = "\"\\/bfnrt", meant[] = "\"\\/\b\f\n\r\t";
    char              c     = data->text[data->at + 1];
    const char       *found = c ? strchr(written, c) : NULL;
    uint32_t          start = data->at;
    data->at += 2;
    if (found)
        text_add_bytes(&data->scratch, meant + (found - written), 1);
    else if (c != 'u' || !read_code(data)) {
        data_error(data, start, start + 1, "a backslash that means nothing in JSON");
        return false;
    }
    return true;
}

static Value read_string(DataText *data)
{
    uint32_t start       = data->at++;
    data->scratch.length = 0;
    text_add(&data->scratch, "");
    while (here(data) != '"') {
        if ((unsigned char)here(data) < 0x20) {
            data_error(data, start, start + 1, "a string that is not closed on its line");
            return value_error();
        }
        if (here(data) != '\\')
            text_add_bytes(&data->scratch, data->text + data->at++, 1);
        else if (!read_escape(data))
            return value_error();
    }
    data->at++;
    return data_string(data, start, data->at);
}

/* ---- lists and records ---- */

static Value read_value(DataText *data, uint32_t level);

/* Tells, behind an element, whether another one follows.  *good becomes false after a mistake. */
static bool another(DataText *data, char closer, bool *good)
{
    skip_blanks(data);
    char found = here(data);
    if (found == ',' || found == closer) {
        data->at++;
        return found == ',';
    }
    *good = unexpected(data, closer == ']' ? "`,` or `]`" : "`,` or `}`");
    return false;
}

/* Tells whether nothing is between the brackets, which are skipped then. */
static bool is_empty(DataText *data, char closer)
{
    data->at++;
    skip_blanks(data);
    bool empty = here(data) == closer;
    data->at += empty;
    return empty;
}

static Value read_array(DataText *data, uint32_t level)
{
    Values values = {0};
    bool   good   = true;
    for (bool more = !is_empty(data, ']'); more; more = another(data, ']', &good)) {
        Value value = read_value(data, level + 1);
        if (value.type == VALUE_ERROR || !data_push(data, &values, value))
            return value_error();
    }
    return good ? value_list(data->e, values.items, values.count) : value_error();
}

/* Reads `"name": value`; false: reported. */
static bool read_member(DataText *data, Values *names, Values *values, uint32_t level)
{
    skip_blanks(data);
    uint32_t start = data->at;
    if (here(data) != '"')
        return unexpected(data, "a name in quotes");
    Value name = read_string(data);
    if (name.type == VALUE_ERROR)
        return false;
    for (size_t i = 0; i < names->count; i++)
        if (names->items[i].string == name.string) {
            data_error(data, start, data->at, "a name that the record has already");
            return false;
        }
    if (names->count >= MAX_MEMBERS) {
        data_error(data, start, data->at, "a record of more than 1,000 members");
        return false;
    }
    skip_blanks(data);
    if (here(data) != ':')
        return unexpected(data, "`:`");
    data->at++;
    Value value = read_value(data, level + 1);
    return value.type != VALUE_ERROR && data_push(data, names, name) &&
           data_push(data, values, value);
}

static Value read_object(DataText *data, uint32_t level)
{
    Values names = {0}, values = {0};
    bool   good = true;
    for (bool more = !is_empty(data, '}'); more; more = another(data, '}', &good))
        if (!read_member(data, &names, &values, level))
            return value_error();
    return good ? value_record(data->e, names.items, values.items, names.count) : value_error();
}

/* ---- values ---- */

/* Accepts true, false or null. */
static bool accept_word(DataText *data, const char *word)
{
    size_t length = strlen(word);
    bool   found  = strncmp(data->text + data->at, word, length) == 0;
    data->at += found ? (uint32_t)length : 0;
    return found;
}

static Value read_word(DataText *data)
{
    if (accept_word(data, "true"))
        return value_boolean(true);
    if (accept_word(data, "false"))
        return value_boolean(false);
    if (accept_word(data, "null"))
        return value_list(data->e, NULL, 0);
    unexpected(data, "a value");
    return value_error();
}

static Value read_value(DataText *data, uint32_t level)
{
    skip_blanks(data);
    if (level > MAX_LEVELS) {
        data_error(data, data->at, data->at + 1, "nested more than 200 levels deep");
        return value_error();
    }
    uint32_t length = data_number_length(data, data->at, true);
    if (length > 0) {
        data->at += length;
        return data_number(data, data->at - length, data->at);
    }
    switch (here(data)) {
    case '[': return read_array(data, level);
    case '{': return read_object(data, level);
    case '"': return read_string(data);
    default: return read_word(data);
    }
}

/* Reads the value of a whole text. */
static Value read_text(DataText *data)
{
    Value value = read_value(data, 0);
    if (value.type == VALUE_ERROR)
        return value;
    skip_blanks(data);
    bool good = data->at == data->length || unexpected(data, "nothing behind the value");
    return good ? value : value_error();
}

Value builtin_read_json(Elaboration *e, Call *call)
{
    DataText data;
    return data_open(e, call, &data) ? read_text(&data) : value_error();
}
