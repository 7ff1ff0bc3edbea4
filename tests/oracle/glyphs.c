/*
 * glyphs.c: letters against their outlines in the font's file, which is read here without FreeType.
 *
 * TrueType does not write points of a curve that stand halfway between two of its control points.
 * Points of all curves must lie on the border of the letter, as exactly as its numbers tell.
 */
#include <stdlib.h>

#include "compiler/base/fonts.h"
#include "compiler/outline/letters.h"
#include "tests/oracle/product.h"
#include "tests/oracle/truetype.h"

/* In ems: a unit is 1/2048 of it, and points that are cut to units are off by 1.7e-4. */
static const double TOLERANCE = 1e-6;

enum { PIECES = 4 };

static void open_font(const char *name)
{
    FoundFont found;
    assert_int_equal(font_find(name, &found), FONT_FOUND);
    assert_true(truetype_open(found.path));
    free(found.path);
}

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

/* Returns the number of curves. */
static size_t judge_letter(const char *font, char letter)
{
    static Glyph glyph;
    double       worst  = 0;
    size_t       curves = 0;
    if (!truetype_read(truetype_glyph((unsigned char)letter), &glyph))
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
