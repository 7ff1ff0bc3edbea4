/*
 * flat_outlines.c: chords of an outline that come into a box, and what is within them.
 *
 * A chord is on the curve with both its ends.  Where the chords of a box make one chain that turns only one way, they are joined by
 * intersections, or by unions.
 */
#include "compiler/mesh/flat_outlines.h"

#include "compiler/base/vec.h"
#include "compiler/graph/crowd.h"
#include "compiler/graph/lane_outlines.h"
#include "compiler/mesh/flat_circles.h"

enum { MOST_CHORDS = 8 };

typedef struct Chord {
    double from[2], to[2];
    double bulge; /* how far the curve is to the right of it at most; below 0: to the left */
} Chord;

/* What is looked at: the plane's coordinates, and which of them the box has. */
typedef struct Place {
    Form     at[2];
    Range    range[2];
    double   margin; /* of rounding */
    uint32_t table;
    size_t   count;
    Chord    chords[MOST_CHORDS]; /* that come into it */
    Chord    nearest;             /* of all, to its middle */
    double   distance, across;    /* how far that is, and how much of that is across it */
} Place;

static double cross2(const double a[2], const double b[2]) { return a[0] * b[1] - a[1] * b[0]; }

static void way_of(const Chord *chord, double way[2])
{
    for (int k = 0; k < 2; k++)
        way[k] = chord->to[k] - chord->from[k];
}

/* The line of a chord, below 0 on its left. */
static Form line_of(const Place *place, const Chord *chord)
{
    double way[2];
    way_of(chord, way);
    double length = hypot(way[0], way[1]);
    Form   line   = form_constant((chord->from[1] * way[0] - chord->from[0] * way[1]) / length);
    line          = form_sum(line, way[1] / length, &place->at[0]);
    return form_sum(line, -way[0] / length, &place->at[1]);
}

/* ---- chords ---- */

static double bend_of(const CrowdArc *arc) { return hypot(arc->bend[0], arc->bend[1]); }

/* Chords of parts of even lengths of the parameter are bend / (4 count^2) off at most. */
static double chords_needed(const CrowdArc *arc, double off)
{
    return max2(ceil(sqrt(bend_of(arc) / (4 * off))), 1);
}

static void point_on(const CrowdArc *arc, double t, double point[2])
{
    for (int k = 0; k < 2; k++)
        point[k] = arc->start[k] + t * (2 * arc->way[k] + t * arc->bend[k]);
}

static Chord find_chord(const CrowdArc *arc, double i, double count)
{
    Chord chord;
    point_on(arc, i / count, chord.from);
    point_on(arc, (i + 1) / count, chord.to);
    chord.bulge = copysign(bend_of(arc) / (4 * count * count), cross2(arc->way, arc->bend));
    return chord;
}

/* Whether a chord, or what is so far from it, does not come into the place. */
static bool lies_beyond(const Place *place, const Chord *chord, double off)
{
    double middle[2], half[2], way[2], margin = place->margin + off;
    for (int k = 0; k < 2; k++) {
        middle[k] = 0.5 * (place->range[k].low + place->range[k].high) - chord->from[k];
        half[k]   = 0.5 * (place->range[k].high - place->range[k].low) + margin;
        way[k]    = chord->to[k] - chord->from[k];
        if (min2(0, way[k]) > middle[k] + half[k] || max2(0, way[k]) < middle[k] - half[k])
            return true;
    }
    return fabs(cross2(way, middle)) > fabs(way[1]) * half[0] + fabs(way[0]) * half[1];
}

/* The nearest tells the side of a place that none comes into; of two that meet there, the one that is more across. */
static void look_at_side(Place *place, const Chord *chord)
{
    static const double SAME = 1e-9;
    double              way[2], from[2];
    way_of(chord, way);
    for (int k = 0; k < 2; k++)
        from[k] = 0.5 * (place->range[k].low + place->range[k].high) - chord->from[k];
    double square = way[0] * way[0] + way[1] * way[1];
    double t      = min2(max2((from[0] * way[0] + from[1] * way[1]) / square, 0), 1);
    double off = hypot(from[0] - t * way[0], from[1] - t * way[1]), least = place->distance;
    double across = fabs(cross2(way, from)) / sqrt(square);
    if (off < least * (1 - SAME) || (off <= least * (1 + SAME) && across > place->across)) {
        place->nearest  = *chord;
        place->distance = off;
        place->across   = across;
    }
}

/* Says that there are curves, which chords stand for. */
static void note_curves(Finding *f, const Place *place)
{
    double slope = max2(form_steepness(f, &place->at[0]), form_steepness(f, &place->at[1]));
    bool   round = form_has_round(f, &place->at[0]) || form_has_round(f, &place->at[1]);
    if (slope > 0)
        flat_rounds_note_curves(f->rounds, place->table, 1 / slope, round);
    f->pieces->round = true;
}

/* Where proofs are looked for, curves count as well. */
static void look_at_chord(Finding *f, Place *place, const Chord *chord)
{
    bool curve = chord->bulge != 0 && !lies_beyond(place, chord, fabs(chord->bulge));
    look_at_side(place, chord);
    if (curve)
        note_curves(f, place);
    if ((!curve || f->use == FLAT_MAKING) && lies_beyond(place, chord, 0))
        return;
    if (place->count == MOST_CHORDS)
        f->failed = true;
    else
        place->chords[place->count++] = *chord;
}

/* `off`: how far chords may be from curves. */
static void look_at_arc(Finding *f, Place *place, const CrowdArc *arc, double off)
{
    double count = chords_needed(arc, off);
    for (double i = 0; i < count && !f->failed; i++) {
        Chord chord = find_chord(arc, i, count);
        look_at_chord(f, place, &chord);
    }
}

/* ---- chains ---- */

static bool meet(const Place *place, const Chord *before, const Chord *behind)
{
    return hypot(before->to[0] - behind->from[0], before->to[1] - behind->from[1]) <= place->margin;
}

/* The chord that comes before the first of a chain; NULL: none. */
static Chord *find_before(Place *place, const Chord *first, size_t begin)
{
    for (size_t i = begin; i < place->count; i++)
        if (meet(place, &place->chords[i], first))
            return &place->chords[i];
    return NULL;
}

/* Brings chords in their order, from the last one back to the first.  False: they are more than one chain. */
static bool order_chain(Place *place)
{
    Chord *chords = place->chords;
    size_t last   = place->count - 1;
    for (size_t i = 0; i < place->count; i++) {
        size_t k = 0;
        while (k < place->count && !meet(place, &chords[i], &chords[k]))
            k++;
        if (k == place->count)
            last = i;
    }
    for (size_t i = 0; i < place->count; i++) {
        Chord *next = i == 0 ? &chords[last] : find_before(place, &chords[i - 1], i);
        if (!next)
            return false;
        Chord chord = chords[i];
        chords[i]   = *next;
        *next       = chord;
    }
    return true;
}

/* Whether each turns to the left of the one before, or goes on; and the same to the right. */
static void find_turns(const Place *place, bool *left, bool *right)
{
    static const double STRAIGHT = 1e-12;
    size_t              count    = place->count;
    bool closed = count > 2 && meet(place, &place->chords[0], &place->chords[count - 1]);
    *left = *right = true;
    for (size_t i = closed ? 0 : 1; i < count; i++) {
        double before[2], behind[2];
        way_of(&place->chords[i], before);
        way_of(&place->chords[(i + count - 1) % count], behind);
        double turn = cross2(before, behind),
               size = STRAIGHT * hypot(before[0], before[1]) * hypot(behind[0], behind[1]);
        *left &= turn >= -size;
        *right &= turn <= size;
    }
}

static int solid_of_chain(Finding *f, Place *place)
{
    bool left = false, right = false;
    f->failed |= !order_chain(place);
    find_turns(place, &left, &right);
    f->failed |= !left && !right;
    int solid = left ? FLAT_ALL : FLAT_NONE;
    for (size_t i = 0; i < place->count && !f->failed; i++) {
        FlatSlack slack = f->slack;
        Form      line  = line_of(place, &place->chords[i]);
        f->slack        = flat_slack_with(slack, place->chords[i].bulge);
        int side        = flat_solid(f, &line);
        f->slack        = slack;
        solid           = left ? flat_both(f, solid, side) : flat_either(f, solid, side);
    }
    return solid;
}

static int solid_beside(const Place *place)
{
    double way[2], from[2];
    way_of(&place->nearest, way);
    for (int k = 0; k < 2; k++)
        from[k] = 0.5 * (place->range[k].low + place->range[k].high) - place->nearest.from[k];
    return cross2(way, from) > 0 ? FLAT_ALL : FLAT_NONE;
}

/* ---- outlines ---- */

static void find_place(Finding *f, const LaneCall *call, Place *place)
{
    place->table    = call->body->table;
    place->margin   = FLAT_ROUNDING * f->size;
    place->count    = 0;
    place->distance = INFINITY;
    place->across   = 0;
    for (int k = 0; k < 2; k++) {
        place->at[k]    = form_of_operand(f, call->operands[1][k]);
        place->range[k] = form_range(f, &place->at[k]);
        f->failed |= !place->at[k].known || !isfinite(place->range[k].low + place->range[k].high);
    }
}

int flat_solid_of_outline(Finding *f, uint32_t value)
{
    const LaneCall *call = &f->tape->calls[f->tape->steps[value - LANE_INPUTS].operands[0]];
    uint32_t        members[MOST_LANE_MEMBERS], count;
    Place           place;
    if (!lane_outline_members(f->tape, &f->field->ranges, value - LANE_INPUTS, members, &count)) {
        f->failed = true;
        return FLAT_NONE;
    }
    const Crowd *table = &f->tape->tape->graph->crowds->tables.items[call->body->table];
    double       off   = flat_rounds_chord(f->rounds, call->body->table);
    find_place(f, call, &place);
    for (uint32_t i = 0; i < count && !f->failed; i++)
        look_at_arc(f, &place, &table->arcs[members[i]], off);
    if (f->failed)
        return FLAT_NONE;
    return place.count > 0 ? solid_of_chain(f, &place) : solid_beside(&place);
}
