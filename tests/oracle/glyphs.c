/*
 * glyphs.c: letters against their outlines in the font's file, which is read here without FreeType.
 *
 * TrueType does not write points of a curve that stand halfway between two of its control points.
 * Points of all curves must lie on the border of the letter, as exactly as its numbers tell.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/outline/letters.h"
#include "tests/oracle/product.h"

/* In ems: a unit is 1/2048 of it, and points that are cut to units are off by 1.7e-4. */
static const double TOLERANCE = 1e-6;

enum { MOST_BYTES = 4 << 20, MOST_POINTS = 1000, ON_CURVE = 1, REPEATED = 8, PIECES = 4 };

typedef struct Reader {
    unsigned char bytes[MOST_BYTES];
    size_t        cmap, loca, glyf, head; /* offsets of tables */
} Reader;

typedef struct Glyph {
    double x[MOST_POINTS], y[MOST_POINTS]; /* in ems */
    bool   on[MOST_POINTS];
    size_t ends[MOST_POINTS], contours, points;
} Glyph;

static Reader reader;

/* ---- the file ---- */

static unsigned u16(size_t at) { return reader.bytes[at] * 256u + reader.bytes[at + 1]; }
static int      s16(size_t at) { return (int16_t)u16(at); }
static size_t   u32(size_t at) { return ((size_t)u16(at) << 16) + u16(at + 2); }

static size_t table(const char *tag)
{
    for (size_t i = 0, at = 12; i < u16(4); i++, at += 16)
        if (memcmp(reader.bytes + at, tag, 4) == 0)
            return u32(at + 8);
    fail_msg("no table %s", tag);
    return 0;
}

static void open_font(const char *name)
{
    FoundFont found;
    assert_int_equal(font_find(name, &found), FONT_FOUND);
    FILE *file = fopen(found.path, "rb");
    assert_non_null(file);
    assert_true(fread(reader.bytes, 1, MOST_BYTES, file) > 0);
    fclose(file);
    free(found.path);
    reader.cmap = table("cmap");
    reader.loca = table("loca");
    reader.glyf = table("glyf");
    reader.head = table("head");
}

/* The glyph of a character, by a map of format 4; 0: none. */
static unsigned glyph_of(unsigned character)
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

/* ---- one glyph ---- */

/* The coordinates along one axis: each as the way from the one before. */
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

/* False: it has parts, or nothing. */
static bool read_glyph(unsigned number, Glyph *glyph)
{
    unsigned char flags[MOST_POINTS];
    size_t        at = place_of(number), count = 0;
    if (at == place_of(number + 1) || s16(at) <= 0)
        return false;
    glyph->contours = u16(at);
    at += 10;
    for (size_t i = 0; i < glyph->contours; i++, at += 2)
        glyph->ends[i] = u16(at) + 1;
    glyph->points = glyph->ends[glyph->contours - 1];
    assert_true(glyph->points <= MOST_POINTS);
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

/* ---- what is compared ---- */

/* Where a curve begins or ends that has the point i for control point, beside the point j. */
static void end_of(const Glyph *glyph, size_t i, size_t j, double end[2])
{
    double share = glyph->on[j] ? 1 : 0.5;
    end[0]       = glyph->x[i] + share * (glyph->x[j] - glyph->x[i]);
    end[1]       = glyph->y[i] + share * (glyph->y[j] - glyph->y[i]);
}

static double judge_curve(const Product *product, const Glyph *glyph, size_t before, size_t i,
                          size_t after)
{
    double from[2], to[2], worst = 0;
    end_of(glyph, i, before, from);
    end_of(glyph, i, after, to);
    for (int k = 0; k <= PIECES; k++) {
        double t = (double)k / PIECES, s = 1 - t;
        Vec    p = vec(s * s * from[0] + 2 * s * t * glyph->x[i] + t * t * to[0],
                       s * s * from[1] + 2 * s * t * glyph->y[i] + t * t * to[1], 0);
        worst    = fmax(worst, fabs(product_distance(product, p)));
    }
    return worst;
}

/* The number of curves. */
static size_t judge_letter(const char *font, char letter)
{
    static Glyph glyph;
    double       worst  = 0;
    size_t       curves = 0;
    if (!read_glyph(glyph_of((unsigned char)letter), &glyph))
        return 0;
    Product product = product_format("show text(\"%c\", font: \"%s\").extrude(2);", letter, font);
    for (size_t c = 0, first = 0; c < glyph.contours; first = glyph.ends[c++]) {
        size_t count = glyph.ends[c] - first;
        for (size_t i = 0; i < count; i++)
            if (!glyph.on[first + i]) {
                worst = fmax(worst, judge_curve(&product, &glyph, first + (i + count - 1) % count,
                                                first + i, first + (i + 1) % count));
                curves++;
            }
    }
    product_free(&product);
    if (!(worst < TOLERANCE))
        fail_msg("%c of %s is off by %g ems", letter, font, worst);
    return curves;
}

static void letters_are_those_of_their_font(void **state)
{
    static const char *const fonts[] = {"DejaVu Sans", "DejaVu Serif", "DejaVu Sans Mono"};
    (void)state;
    for (size_t i = 0; i < sizeof fonts / sizeof *fonts; i++) {
        size_t curves = 0;
        open_font(fonts[i]);
        for (const char *letter = "SaegoR&8Q3cdjyt@"; *letter; letter++)
            curves += judge_letter(fonts[i], *letter);
        assert_true(curves > 150);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(letters_are_those_of_their_font)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
