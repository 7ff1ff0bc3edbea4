/*
 * flat_circles.c: makes sides of polygons of the lengths of pairs and triples.
 */
#include "mesh/flat/flat_circles.h"

#include "compiler/base/elementary.h"
#include "compiler/base/vec.h"

/* The polygon that approximates a circle, and those of its sides that a rectangle sees. */
typedef struct Sides {
    double   angle; /* of a side */
    double   wide;  /* radius of corners off the axes, of a circle of radius 1 */
    uint32_t count, used;
    int64_t  first;
} Sides;

static void find_sides(Range a, Range b, uint32_t count, double wide, Sides *sides)
{
    static const double SLACK = 1e-2; /* in sides: moved ones meet a little beside where they did */
    const double        around = 2 * M_PI;
    sides->count               = count;
    sides->angle               = around / count;
    sides->wide                = wide;
    sides->first               = 0;
    sides->used                = count;
    if (a.low <= 0 && a.high >= 0 && b.low <= 0 && b.high >= 0)
        return;
    double middle = real_atan2(b.low + b.high, a.low + a.high), low = 0, high = 0;
    for (int i = 0; i < 4; i++) {
        double offset = real_atan2(i / 2 ? b.high : b.low, i % 2 ? a.high : a.low) - middle;
        offset -= around * round(offset / around);
        low  = min2(low, offset);
        high = max2(high, offset);
    }
    sides->first = (int64_t)floor((middle + low) / sides->angle - SLACK);
    double last  = floor((middle + high) / sides->angle + SLACK);
    sides->used  = (uint32_t)min2(last - (double)sides->first + 1, count);
}

static void find_corner(const Sides *sides, int64_t number, double corner[2])
{
    double angle  = (double)number * sides->angle;
    double radius = 4 * number % sides->count == 0 ? 1 : sides->wide;
    corner[0]     = radius * real_cos(angle);
    corner[1]     = radius * real_sin(angle);
}

/* Finds the factors of the linear form of two numbers that is 1 on a side. */
static void find_factors(const Sides *sides, uint32_t i, double factors[2])
{
    double from[2], to[2];
    find_corner(sides, sides->first + i, from);
    find_corner(sides, sides->first + i + 1, to);
    double cross = from[0] * to[1] - from[1] * to[0];
    factors[0]   = (to[1] - from[1]) / cross;
    factors[1]   = (from[0] - to[0]) / cross;
}

static bool is_behind(const Sides *sides, uint32_t i)
{
    double factors[2];
    find_factors(sides, i, factors);
    return factors[0] < 0;
}

/* Drops sides on the left: the first number is a length, so it is not below 0. */
static void drop_sides_behind(Sides *sides)
{
    while (sides->used > 0 && is_behind(sides, 0)) {
        sides->first++;
        sides->used--;
    }
    while (sides->used > 0 && is_behind(sides, sides->used - 1))
        sides->used--;
}

static bool has_round_within(const Finding *f, const Form *form, int depth)
{
    enum { DEEPEST = 6 };
    for (int i = 0; i < form->kink_count; i++) {
        const LaneStep *step = lane_step_of(f->tape, form->kinks[i]);
        if (!step || depth == DEEPEST || step->op == OP_length)
            return true;
        for (uint32_t k = 0; k < step->operand_count && step->op != LANE_CALL; k++) {
            Form operand = form_of_operand(f, step->operands[k]);
            if (has_round_within(f, &operand, depth + 1))
                return true;
        }
    }
    return false;
}

bool form_has_round(const Finding *f, const Form *form) { return has_round_within(f, form, 0); }

static double steepness_within(const Finding *f, const Form *form, int depth)
{
    enum { DEEPEST = 6 };
    double slope = form_slope(f, form);
    for (int i = 0; i < form->kink_count && depth < DEEPEST; i++) {
        const LaneStep *step = lane_step_of(f->tape, form->kinks[i]);
        for (uint32_t k = 0; step && step->op != LANE_CALL && k < step->operand_count; k++) {
            Form operand = form_of_operand(f, step->operands[k]);
            slope = max2(slope, fabs(form->factors[i]) * steepness_within(f, &operand, depth + 1));
        }
    }
    return slope;
}

double form_steepness(const Finding *f, const Form *form) { return steepness_within(f, form, 0); }

typedef struct Rounded {
    Form     forms[3];
    uint32_t count;
} Rounded;

/* Returns the operands of a length that are not 0, the vertical one last, so that balls have their
   poles there. */
static Rounded rounded_of(const Finding *f, const LaneStep *step)
{
    static const uint32_t ORDER[3] = {0, 2, 1};
    Rounded               rounded  = {.count = 0};
    for (uint32_t i = 0; i < 3; i++) {
        if (ORDER[i] >= step->operand_count)
            continue;
        Form form = form_of_operand(f, step->operands[ORDER[i]]);
        if (!form_is_constant(&form) || form.at != 0)
            rounded.forms[rounded.count++] = form;
    }
    return rounded;
}

/* Notes how large the circle is where the form is 0, in lengths of the scene, by the range of the
   rest. */
static void note_round(Finding *f, const Form *rest, double factor, const LaneStep *step,
                       const Rounded *rounded, double slope)
{
    Form   of_length = form_scaled(-1 / factor, rest);
    Range  needed    = form_range(f, &of_length);
    Range  known     = f->field->ranges.ranges[LANE_INPUTS + (size_t)(step - f->tape->steps)];
    double radius    = min2(needed.high, known.high);
    bool   shared    = rounded->count > 2 || form_has_round(f, rest);
    for (uint32_t i = 0; i < rounded->count; i++)
        shared |= form_has_round(f, &rounded->forms[i]);
    if (radius > 0 && slope > 0)
        flat_rounds_note(f->rounds, step, radius / slope, shared);
}

/* Returns the solid of one side of a polygon, or of a band with these factors. */
static int solid_of_side(Finding *f, const Form *rest, double factor, const Rounded *rounded,
                         const double band[2], const Sides *sides, uint32_t i)
{
    double across = factor * band[0], factors[2];
    find_factors(sides, i, factors);
    Form form = form_sum(*rest, across * factors[0], &rounded->forms[0]);
    form      = form_sum(form, across * factors[1], &rounded->forms[1]);
    if (rounded->count > 2)
        form = form_sum(form, factor * band[1], &rounded->forms[2]);
    return flat_solid(f, &form);
}

/* Returns the solid of the length of a pair, times the first factor of the band: the largest form
   of its sides. */
static int solid_of_pair_length(Finding *f, const Form *rest, double factor, const Rounded *rounded,
                                const double band[2], uint32_t count, double wide)
{
    Sides sides;
    find_sides(form_range(f, &rounded->forms[0]), form_range(f, &rounded->forms[1]), count, wide,
               &sides);
    bool around = sides.used == count;
    if (sides.used > (around ? f->max_around : f->max_used)) {
        f->failed = true;
        return FLAT_NONE;
    }
    int solid = factor > 0 ? FLAT_ALL : FLAT_NONE;
    for (uint32_t i = 0; i < sides.used; i++) {
        int side = solid_of_side(f, rest, factor, rounded, band, &sides, i);
        solid    = factor > 0 ? flat_both(f, solid, side) : flat_either(f, solid, side);
    }
    return solid;
}

/* Returns the sides of a band whose radius is this part of the largest: halved as often as is
   enough, since edges have more corners where neighbours' numbers differ. */
static uint32_t sides_of_band(uint32_t count, double part)
{
    uint32_t sides = count;
    for (uint32_t fewer = count; fewer >= 4 && fewer >= count * part;
         fewer          = 4 * ((fewer + 7) / 8)) {
        sides = fewer;
        if (fewer == 4)
            break;
    }
    return sides;
}

/* A band of a ball: its factors, its number of sides, and by what part lengths become longer and
   shorter. */
typedef struct Band {
    double   factors[2], longer, shorter;
    uint32_t sides;
} Band;

/* Finds the bands of a ball that the box sees.  Those near poles are shorter and have fewer sides;
   since numbers of sides differ, bands reach a bit farther. */
static Sides find_bands(const Finding *f, const Rounded *rounded, uint32_t count)
{
    Range pair = range_sqrt(range_add(range_square(form_range(f, &rounded->forms[0])),
                                      range_square(form_range(f, &rounded->forms[1]))));
    Sides bands;
    find_sides(pair, form_range(f, &rounded->forms[2]), count, flat_corner_radius(count), &bands);
    bands.first--;
    bands.used = (uint32_t)min2(bands.used + 2, count);
    drop_sides_behind(&bands);
    return bands;
}

static Band find_band(const Sides *bands, uint32_t i)
{
    Band band;
    find_factors(bands, i, band.factors);
    double nearest = flat_side_distance(bands->count, bands->wide);
    double part    = band.factors[0] * nearest;
    double share   = part * min2(part + 0.5 * bands->angle, 1);
    band.sides     = sides_of_band(bands->count, part);
    double wide    = flat_corner_radius(band.sides);
    double longer  = 1 / flat_side_distance(band.sides, wide) - 1;
    band.longer    = (1 + longer * share) / nearest - 1;
    band.shorter   = 1 - 1 / (bands->wide * (1 + (wide - 1) * share));
    return band;
}

FlatSlack flat_slack_with(FlatSlack slack, double excess)
{
    return (FlatSlack){slack.below + max2(excess, 0), slack.above - min2(excess, 0)};
}

static FlatSlack slack_of_length(FlatSlack slack, double by, double longer, double shorter)
{
    return flat_slack_with(flat_slack_with(slack, by * longer), -by * shorter);
}

static int solid_of_three(Finding *f, const Form *rest, double factor, const Rounded *rounded,
                          uint32_t count, double reach)
{
    FlatSlack slack = f->slack;
    Sides     bands = find_bands(f, rounded, count);
    int       solid = factor > 0 ? FLAT_ALL : FLAT_NONE;
    f->failed |= bands.used > f->max_used;
    for (uint32_t i = 0; i < bands.used && !f->failed; i++) {
        Band band = find_band(&bands, i);
        f->slack  = slack_of_length(slack, factor * reach, band.longer, band.shorter);
        int parts = solid_of_pair_length(f, rest, factor, rounded, band.factors, band.sides,
                                         flat_corner_radius(band.sides));
        solid     = factor > 0 ? flat_both(f, solid, parts) : flat_either(f, solid, parts);
    }
    f->slack = slack;
    return solid;
}

/* A polygon whose lengths are multiplied by `stretch`. */
typedef struct Polygon {
    uint32_t sides;
    double   wide, stretch;
} Polygon;

/* Returns the solid of the length of a pair by a polygon, with the slack that its sides add. */
static int solid_of_polygon(Finding *f, const Form *rest, double factor, const Rounded *rounded,
                            const Polygon *polygon, double reach)
{
    const double band[2] = {polygon->stretch, 0};
    FlatSlack    slack   = f->slack;
    double       longer  = polygon->stretch / flat_side_distance(polygon->sides, polygon->wide);
    double       shorter = max2(1 - polygon->stretch / polygon->wide, 0);
    f->slack  = slack_of_length(slack, factor * reach, (longer - 1) * longer, shorter * longer);
    int solid = solid_of_pair_length(f, rest, factor, rounded, band, polygon->sides, polygon->wide);
    f->slack  = slack;
    return solid;
}

/* Returns the intersection of a polygon's solid with another, and does not make it where that is
   empty. */
static int polygon_where(Finding *f, int where, const Form *rest, double factor,
                         const Rounded *rounded, const Polygon *polygon, double reach)
{
    return where == FLAT_NONE
               ? FLAT_NONE
               : flat_both(f, where, solid_of_polygon(f, rest, factor, rounded, polygon, reach));
}

/*
 * Returns the solid of the length of a pair, with fewer sides at tips.  Where the radius changes
 * along the axis, as that of a cone does, there may be a tip.  Where many sides meet in a point,
 * each pair of neighbours is near to parallel, and moved planes miss the point by far.  Circles
 * near the tip are small, so there a polygon of fewer sides is as near: it is off by the radius
 * over the square of their number.  It is a little smaller, so that all of it is within the other
 * polygon where they meet.
 */
static int solid_of_pair(Finding *f, const Form *rest, double factor, const Rounded *rounded,
                         uint32_t count, double largest, double reach)
{
    enum { MANY = 64, AT_TIP = 32 };
    Polygon polygon = {count, flat_corner_radius(count), 1};
    if (count <= MANY || rest->kink_count > 0 || !(largest3(rest->by) > 0))
        return solid_of_polygon(f, rest, factor, rounded, &polygon, reach);
    double  part   = (double)AT_TIP / count;
    Polygon at_tip = {AT_TIP, 1, 1.0001 / flat_side_distance(count, polygon.wide)};
    double  small  = part * part / (1 + part * part) * largest;
    Form    one = form_constant(1), at = form_sum(*rest, factor * small, &one);
    int     below = flat_solid(f, &at), above = flat_complement(f, below);
    int     wide = factor > 0 ? below : above, tip = factor > 0 ? above : below;
    wide = polygon_where(f, wide, rest, factor, rounded, &polygon, reach);
    tip  = polygon_where(f, tip, rest, factor, rounded, &at_tip, min2(reach, small));
    return flat_either(f, wide, tip);
}

int flat_solid_of_length(Finding *f, const Form *rest, double factor, const LaneStep *step)
{
    Rounded  rounded = rounded_of(f, step);
    uint32_t count   = flat_rounds_sides(f->rounds, step);
    double   slope   = 0;
    double   reach   = f->field->ranges.ranges[LANE_INPUTS + (size_t)(step - f->tape->steps)].high;
    if (rounded.count < 2 || count == 0 || step->kin == 0) {
        f->failed = true;
        return FLAT_NONE;
    }
    for (uint32_t i = 0; i < rounded.count; i++)
        slope = max2(slope, form_steepness(f, &rounded.forms[i]));
    note_round(f, rest, factor, step, &rounded, slope);
    f->pieces->round = true;
    if (rounded.count > 2)
        return solid_of_three(f, rest, factor, &rounded, count, reach);
    return solid_of_pair(f, rest, factor, &rounded, count,
                         slope * flat_rounds_radius(f->rounds, step->kin), reach);
}
