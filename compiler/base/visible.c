/*
 * visible.c: characters that a terminal may get.
 */
#include "compiler/base/visible.h"

#include <stdbool.h>
#include <string.h>

#include "compiler/base/text.h"

enum { TAB_COLUMNS = 4 };

typedef struct CharacterRange {
    uint32_t first, last;
} CharacterRange;

static bool is_among(uint32_t c, const CharacterRange *ranges, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (c >= ranges[i].first && c <= ranges[i].last)
            return true;
    return false;
}

/* Tells whether a character is a control character, or an invisible one that reorders or hides its
   neighbours. */
static bool is_deceptive(uint32_t c)
{
    static const CharacterRange ranges[] = {{0x80, 0x9F},     {0x61C, 0x61C},   {0x200B, 0x200F},
                                            {0x2028, 0x202E}, {0x2060, 0x206F}, {0xFEFF, 0xFEFF}};
    return is_among(c, ranges, sizeof ranges / sizeof *ranges);
}

static bool is_combining(uint32_t c)
{
    static const CharacterRange ranges[] = {
        {0x300, 0x36F}, {0x1AB0, 0x1AFF}, {0x20D0, 0x20FF}, {0xFE00, 0xFE0F}, {0xFE20, 0xFE2F}};
    return is_among(c, ranges, sizeof ranges / sizeof *ranges);
}

static bool is_wide(uint32_t c)
{
    static const CharacterRange ranges[] = {{0x1100, 0x115F},  {0x2E80, 0x303E}, {0x3041, 0xA4CF},
                                            {0xAC00, 0xD7A3},  {0xF900, 0xFAFF}, {0xFE30, 0xFE6F},
                                            {0xFF00, 0xFF60},  {0xFFE0, 0xFFE6}, {0x1F300, 0x1FAFF},
                                            {0x20000, 0x3FFFD}};
    return is_among(c, ranges, sizeof ranges / sizeof *ranges);
}

/* Returns `length` bytes of `text`, which is a constant. */
static Visible show(const char *text, size_t length, uint32_t columns, size_t used)
{
    Visible visible = {.length = length, .columns = columns, .used = used ? used : 1};
    memcpy(visible.text, text, length);
    return visible;
}

Visible visible_next(const char *bytes, size_t length)
{
    uint32_t   c;
    size_t     used  = text_character(bytes, length, &c);
    const bool ascii = c < 0x80;
    if (c == '\t')
        return show("    ", TAB_COLUMNS, TAB_COLUMNS, used);
    if (c < 0x20 || c == 0x7F) {
        char picture[] = "\xE2\x90\x80"; /* U+2400, the first of the control pictures */
        picture[2]     = (char)(0x80 + (c == 0x7F ? 0x21 : c));
        return show(picture, 3, 1, used);
    }
    if (used == 0 || (!ascii && is_deceptive(c)))
        return show("\xEF\xBF\xBD", 3, 1, used);
    return show(bytes, used, ascii ? 1 : is_combining(c) ? 0 : is_wide(c) ? 2 : 1, used);
}

void visible_print(FILE *out, const char *text)
{
    for (size_t left = strlen(text); left > 0;) {
        const Visible visible = visible_next(text, left);
        fwrite(visible.text, 1, visible.length, out);
        text += visible.used;
        left -= visible.used;
    }
}
