/*
 * text.c: text that is built piece by piece, and names that are compared by address.
 *
 * Nothing here depends on the locale: a program that uses the library may have set one with a
 * decimal comma.
 */
#include "compiler/base/text.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/base/fnv.h"

/* ---- building ---- */

/* Makes room for `more` bytes.  A text that is added to once takes no more than that. */
static void text_reserve(Text *text, size_t more)
{
    size_t needed = text->length + more + 1, larger = 2 * text->capacity;
    if (needed <= text->capacity)
        return;
    text->capacity = needed > larger ? needed : larger;
    char *bytes    = arena_alloc(text->arena, text->capacity, 1);
    if (text->length > 0)
        memcpy(bytes, text->bytes, text->length);
    text->bytes = bytes;
}

void text_add_bytes(Text *text, const char *bytes, size_t length)
{
    text_reserve(text, length);
    if (length > 0)
        memcpy(text->bytes + text->length, bytes, length);
    text->length += length;
    text->bytes[text->length] = '\0';
}

void text_add(Text *text, const char *string) { text_add_bytes(text, string, strlen(string)); }

void text_format_list(Text *text, const char *format, va_list arguments)
{
    char    usual[128];
    va_list again;
    va_copy(again, arguments);
    int length = vsnprintf(usual, sizeof usual, format, arguments);
    if (length >= 0 && (size_t)length < sizeof usual)
        text_add_bytes(text, usual, (size_t)length);
    else if (length >= 0) {
        text_reserve(text, (size_t)length);
        vsnprintf(text->bytes + text->length, (size_t)length + 1, format, again);
        text->length += (size_t)length;
    }
    va_end(again);
}

void text_format(Text *text, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    text_format_list(text, format, arguments);
    va_end(arguments);
}

void text_printed_number(Text *text, const char *printed)
{
    bool inside = false;
    for (const char *c = printed; *c; c++) {
        bool plain = (*c >= '0' && *c <= '9') || (*c >= 'a' && *c <= 'z') || *c == '-' || *c == '+';
        if (plain)
            text_add_bytes(text, c, 1);
        else if (!inside)
            text_add(text, ".");
        inside = !plain;
    }
}

void text_number(Text *text, double number)
{
    char printed[64];
    if (isnan(number)) {
        text_add(text, "nan"); /* printf may give it a sign */
        return;
    }
    /* A decimal of up to 15 digits is unchanged by a conversion to double and back.  So %.15g,
       which drops zeros at the end, gives the shortest one.  Subnormal numbers hold fewer
       digits. */
    bool subnormal = number != 0 && fabs(number) < DBL_MIN;
    for (int digits = subnormal ? 1 : 15; digits <= 17; digits++) {
        snprintf(printed, sizeof printed, "%.*g", digits, number);
        if (strtod(printed, NULL) == number)
            break;
    }
    text_printed_number(text, printed);
}

/* Reads a decimal number by strtod, which gets the digits and an exponent, but no decimal point:
   which character that is depends on the locale.  Numbers halfway between two doubles have no more
   than 767 digits.  So of longer ones only counts whether anything but zeros is behind those. */
double text_decimal(const char *bytes, size_t length)
{
    enum { MAX_DIGITS = 800 };
    const long most     = 100000000; /* exceeds the number of digits in any file */
    long       exponent = 0;
    bool   fraction = false, more = false; /* behind the decimal point; some digits are left out */
    char   decimal[MAX_DIGITS + 32];
    size_t count = 0;
    for (size_t i = 0; i < length; i++) {
        char c = bytes[i];
        if (c == 'e' || c == 'E') {
            long written = strtol(bytes + i + 1, NULL, 10);
            exponent += written > most ? most : written < -most ? -most : written;
            break;
        }
        if (c >= '0' && c <= '9') {
            bool kept = count < MAX_DIGITS;
            more      = more || (!kept && c != '0');
            exponent += !kept - fraction;
            if (kept && (count > 0 || c != '0'))
                decimal[count++] = c;
        }
        fraction = fraction || c == '.';
    }
    exponent -= more;
    snprintf(decimal + count, sizeof decimal - count, "%se%ld",
             more    ? "1"
             : count ? ""
                     : "0",
             exponent);
    return strtod(decimal, NULL);
}

/* ---- JSON ---- */

/* Returns the length of a UTF-8 character by its first byte, or 0. */
static size_t length_by_first(unsigned char byte)
{
    if (byte < 0x80)
        return 1;
    return byte < 0xC2 ? 0 : byte < 0xE0 ? 2 : byte < 0xF0 ? 3 : byte < 0xF5 ? 4 : 0;
}

/* Returns the length of the well-formed UTF-8 character at s, or 0. */
static size_t utf8_length(const unsigned char *s)
{
    size_t        length = length_by_first(s[0]);
    unsigned char low = 0x80, high = 0xBF; /* range of the next byte, here of the second: it
                                              excludes surrogates and overlong forms */
    if (s[0] == 0xE0)
        low = 0xA0;
    else if (s[0] == 0xED)
        high = 0x9F;
    else if (s[0] == 0xF0)
        low = 0x90;
    else if (s[0] == 0xF4)
        high = 0x8F;
    for (size_t i = 1; i < length; i++) {
        if (s[i] < low || s[i] > high)
            return 0;
        low  = 0x80;
        high = 0xBF;
    }
    return length;
}

size_t text_character(const char *bytes, size_t length, uint32_t *character)
{
    unsigned char s[5] = {0};
    memcpy(s, bytes, length < 4 ? length : 4);
    size_t used = utf8_length(s);
    if (used == 0) {
        *character = 0xFFFD;
        return 0;
    }
    static const unsigned char first_bits[5] = {0, 0x7F, 0x1F, 0x0F, 0x07};
    *character                               = s[0] & first_bits[used];
    for (size_t i = 1; i < used; i++)
        *character = *character << 6 | (s[i] & 0x3Fu);
    return used;
}

static void json_character(Text *text, const char *s, size_t length)
{
    unsigned char c = (unsigned char)*s;
    if (length == 0)
        text_add(text, "\\ufffd");
    else if (c == '"' || c == '\\')
        text_format(text, "\\%c", c);
    else if (c == '\n')
        text_add(text, "\\n");
    else if (c == '\t')
        text_add(text, "\\t");
    else if (c < 0x20 || c == 0x7F)
        text_format(text, "\\u%04x", c);
    else
        text_add_bytes(text, s, length);
}

void text_json(Text *text, const char *string)
{
    text_add(text, "\"");
    for (const char *s = string, *end = s + strlen(s); s < end;) {
        uint32_t character;
        size_t   length = text_character(s, (size_t)(end - s), &character);
        json_character(text, s, length);
        s += length ? length : 1;
    }
    text_add(text, "\"");
}

void text_json_number(Text *text, double number)
{
    if (isfinite(number))
        text_number(text, number);
    else
        text_add(text, "null");
}

void text_json_vector(Text *text, const double *values, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        text_add(text, i == 0 ? "[" : ", ");
        text_json_number(text, values[i]);
    }
    text_add(text, "]");
}

/* ---- names ---- */

/* Returns the slot where a name is, or where it would go; capacity is a power of two. */
static const char **find_slot(const char **slots, size_t capacity, const char *bytes, size_t length)
{
    size_t i = fnv_slot(bytes, length) & (capacity - 1);
    while (slots[i] && (strlen(slots[i]) != length || memcmp(slots[i], bytes, length) != 0))
        i = (i + 1) & (capacity - 1);
    return &slots[i];
}

static void names_grow(Names *names)
{
    size_t       capacity = names->capacity ? 2 * names->capacity : 256;
    const char **slots    = arena_new_array(names->arena, const char *, capacity);
    for (size_t i = 0; i < names->capacity; i++)
        if (names->slots[i])
            *find_slot(slots, capacity, names->slots[i], strlen(names->slots[i])) = names->slots[i];
    names->slots    = slots;
    names->capacity = capacity;
}

const char *name_intern(Names *names, const char *bytes, size_t length)
{
    if (2 * names->count >= names->capacity)
        names_grow(names);
    const char **slot = find_slot(names->slots, names->capacity, bytes, length);
    if (!*slot) {
        *slot = arena_copy_text(names->arena, bytes, length);
        names->count++;
    }
    return *slot;
}

/* ---- misspelt names ---- */

enum { LONGEST_GUESS = 64 }; /* letters; longer names are not compared */

static size_t least(size_t a, size_t b) { return a < b ? a : b; }

/* Returns the restricted Damerau-Levenshtein distance: the number of insertions, deletions,
   replacements and swaps of neighbours that make b of a, where no letter is changed twice. */
static size_t edit_distance(const char *a, size_t a_length, const char *b, size_t b_length)
{
    size_t  rows[3][LONGEST_GUESS + 1];
    size_t *before = rows[0], *above = rows[1], *row = rows[2];
    for (size_t j = 0; j <= b_length; j++)
        above[j] = j;
    for (size_t i = 1; i <= a_length; i++) {
        row[0] = i;
        for (size_t j = 1; j <= b_length; j++) {
            row[j] = least(least(above[j], row[j - 1]) + 1, above[j - 1] + (a[i - 1] != b[j - 1]));
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = least(row[j], before[j - 2] + 1);
        }
        size_t *oldest = before;
        before         = above;
        above          = row;
        row            = oldest;
    }
    return above[b_length];
}

/* Tells whether two words begin with the same letter, or with the same two swapped. */
static bool begin_alike(const char *word, const char *other)
{
    return word[0] == other[0] || (word[0] == other[1] && word[1] == other[0]);
}

const char *nearest_name(const char *word, const char *const *candidates, size_t count)
{
    size_t      length  = strlen(word);
    size_t      nearest = length < 4 ? 2 : 3; /* edits; at first one more than permitted */
    const char *name    = NULL;
    if (length > LONGEST_GUESS)
        return NULL;
    for (size_t i = 0; i < count && nearest > 0; i++) {
        size_t other = strlen(candidates[i]);
        if (other > LONGEST_GUESS || (other > length ? other - length : length - other) >= nearest)
            continue;
        if (length < 5 && !begin_alike(word, candidates[i]))
            continue;
        size_t distance = edit_distance(word, length, candidates[i], other);
        if (distance < nearest && distance < length && distance < other) {
            nearest = distance;
            name    = candidates[i];
        }
    }
    return name;
}
