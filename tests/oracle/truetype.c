/*
 * truetype.c: tables of a TrueType font.
 */
#include "tests/oracle/truetype.h"

#include <stdint.h>
#include <stdio.h>
#include <string.h>

enum { MAX_BYTES = 4 << 20, ON_CURVE = 1, REPEATED = 8 };

typedef struct Reader {
    unsigned char bytes[MAX_BYTES];
    size_t        cmap, loca, glyf, head; /* offsets of tables */
} Reader;

static Reader reader;

static unsigned u16(size_t at) { return reader.bytes[at] * 256u + reader.bytes[at + 1]; }
static int      s16(size_t at) { return (int16_t)u16(at); }
static size_t   u32(size_t at) { return ((size_t)u16(at) << 16) + u16(at + 2); }

static size_t table(const char *tag)
{
    for (size_t i = 0, at = 12; i < u16(4); i++, at += 16)
        if (memcmp(reader.bytes + at, tag, 4) == 0)
            return u32(at + 8);
    return 0;
}

bool truetype_open(const char *path)
{
    static const char *const tags[] = {"cmap", "loca", "glyf", "head"};
    size_t *const            at[]   = {&reader.cmap, &reader.loca, &reader.glyf, &reader.head};
    FILE                    *file   = fopen(path, "rb");
    bool                     whole  = file && fread(reader.bytes, 1, MAX_BYTES, file) > 0;
    if (file)
        fclose(file);
    for (size_t i = 0; whole && i < 4; i++) {
        *at[i] = table(tags[i]);
        whole  = *at[i] != 0;
    }
    return whole;
}

unsigned truetype_glyph(unsigned character)
{
    for (size_t i = 0; i < u16(reader.cmap + 2); i++) {
        size_t map = reader.cmap + u32(reader.cmap + 8 + 8 * i);
        if (u16(map) != 4)
            continue;
        unsigned size = u16(map + 6); /* of each row of segments */
        for (size_t at = map + 14; at < map + 14 + size; at += 2) {
            size_t   first = at + size + 2, delta = first + size, offset = delta + size;
            unsigned low = u16(first);
            if (character > u16(at) || character < low)
                continue;
            if (u16(offset) == 0)
                return (character + u16(delta)) & 0xFFFF;
            return u16(offset + u16(offset) + 2 * (character - low));
        }
    }
    return 0;
}

static size_t place_of(unsigned glyph)
{
    bool wide = u16(reader.head + 50) != 0;
    return reader.glyf + (wide ? u32(reader.loca + 4 * glyph) : 2 * u16(reader.loca + 2 * glyph));
}

/* Returns the coordinates along one axis: each as the way from the one before. */
static size_t read_axis(size_t at, const unsigned char *flags, size_t count, unsigned is_short,
                        unsigned is_same, double *numbers)
{
    int number = 0;
    for (size_t i = 0; i < count; i++) {
        if (flags[i] & is_short) {
            number += flags[i] & is_same ? reader.bytes[at] : -reader.bytes[at];
            at++;
        } else if (!(flags[i] & is_same)) {
            number += s16(at);
            at += 2;
        }
        numbers[i] = (double)number / u16(reader.head + 18);
    }
    return at;
}

bool truetype_read(unsigned number, Glyph *glyph)
{
    unsigned char flags[MAX_GLYPH_POINTS];
    size_t        at = place_of(number), count = 0;
    if (at == place_of(number + 1) || s16(at) <= 0)
        return false;
    glyph->contours = u16(at);
    at += 10;
    for (size_t i = 0; i < glyph->contours; i++, at += 2)
        glyph->ends[i] = u16(at) + 1;
    glyph->points = glyph->ends[glyph->contours - 1];
    if (glyph->points > MAX_GLYPH_POINTS)
        return false;
    at += 2 + u16(at); /* without instructions */
    while (count < glyph->points) {
        unsigned char flag  = reader.bytes[at++];
        int           times = flag & REPEATED ? 1 + reader.bytes[at++] : 1;
        for (; times > 0 && count < glyph->points; times--)
            flags[count++] = flag;
    }
    for (size_t i = 0; i < glyph->points; i++)
        glyph->on[i] = flags[i] & ON_CURVE;
    at = read_axis(at, flags, count, 2, 16, glyph->x);
    read_axis(at, flags, count, 4, 32, glyph->y);
    return true;
}
