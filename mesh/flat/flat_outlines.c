/*
 * flat_outlines.c: chords of an outline that come into a box, and what is within them.
 *
 * A chord is on the curve with both its ends.  The chords of a box make a chain, or a few of a thin part or of both sides of a gap,
 * or the box is halved.
 */
#include "mesh/flat/flat_outlines.h"

#include "compiler/base/vec.h"
#include "compiler/graph/instance_table.h"
#include "compiler/graph/lanes/lane_outlines.h"
#include "mesh/flat/flat_circles.h"

enum { MAX_CHORDS = 8 };

typedef struct Chord {
    double from[2], to[2];
    double bulge; /* how far the curve is to the right of it at most; below 0: to the left */
} Chord;

/* What is looked at: the plane's coordinates, and which of them the box has. */
typedef struct Place {
    Form   at[2];
    Range  range[2];
    double margin; /* of rounding */
    double
             around; /* where proofs are looked for curves count as well, as far as they may be from their chords */
    uint32_t table;
    size_t   count;
    Chord    chords[MAX_CHORDS]; /* that come into it */
    Chord    nearest;            /* of all, to its middle */
    double   distance, across;   /* how far that is, and how much of that is across it */
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

static double bend_of(const InstanceArc *arc) { return hypot(arc->bend[0], arc->bend[1]); }

/* Chords of parts of even lengths of the parameter are bend / (4 count^2) off at most. */
static double chords_needed(const InstanceArc *arc, double off)
{
    return max2(ceil(sqrt(bend_of(arc) / (4 * off))), 1);
}

static void point_on(const InstanceArc *arc, double t, double point[2])
{
    for (int k = 0; k < 2; k++)
        point[k] = arc->start[k] + t * (2 * arc->tangent[k] + t * arc->bend[k]);
}

static Chord find_chord(const InstanceArc *arc, double i, double count)
{
    Chord chord;
    point_on(arc, i / count, chord.from);
    point_on(arc, (i + 1) / count, chord.to);
    chord.bulge = copysign(bend_of(arc) / (4 * count * count), cross2(arc->tangent, arc->bend));
    return chord;
}

/* Tells whether a chord, or what is so far from it, does not come into the place. */
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

/* Tells whether the middle is on the left of the nearest. */
static bool is_left_of_nearest(const Place *place)
{
    double way[2], from[2];
    way_of(&place->nearest, way);
    for (int k = 0; k < 2; k++)
        from[k] = 0.5 * (place->range[k].low + place->range[k].high) - place->nearest.from[k];
    return cross2(way, from) > 0;
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

static void look_at_chord(Finding *f, Place *place, const Chord *chord)
{
    bool curve = chord->bulge != 0 && !lies_beyond(place, chord, fabs(chord->bulge));
    look_at_side(place, chord);
    if (curve)
        note_curves(f, place);
    if (lies_beyond(place, chord, place->around))
        return;
    if (place->count == MAX_CHORDS)
        f->failed = true;
    else
        place->chords[place->count++] = *chord;
}

/* `off`: how far chords may be from curves. */
static void look_at_arc(Finding *f, Place *place, const InstanceArc *arc, double off)
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

/* A chord, of those from one on, that meets another: behind it, or before it.  NULL: there is none. */
static Chord *find_neighbour(Place *place, const Chord *chord, bool behind, size_t begin)
{
    for (size_t i = begin; i < place->count; i++)
        if (behind ? meet(place, chord, &place->chords[i]) : meet(place, &place->chords[i], chord))
            return &place->chords[i];
    return NULL;
}

/* Brings those from one on in the order of a chain; returns where it ends.  0: it goes around. */
static size_t order_chain(Place *place, size_t begin)
{
    Chord *chords = place->chords, *next = NULL;
    size_t end = begin;
    for (size_t i = begin; i < place->count && !next; i++)
        next = find_neighbour(place, &chords[i], false, begin) ? NULL : &chords[i];
    for (; next; end++) {
        Chord chord = chords[end];
        chords[end] = *next;
        *next       = chord;
        next        = find_neighbour(place, &chords[end], true, end + 1);
    }
    return end > begin ? end : 0;
}

/* By how much the second of two chords turns to the left. */
static double turn_of(const Chord *before, const Chord *behind)
{
    double first[2], second[2];
    way_of(before, first);
    way_of(behind, second);
    return cross2(first, second);
}

static int solid_of_line(Finding *f, const Place *place, const Chord *chord)
{
    FlatSlack slack = f->slack;
    Form      line  = line_of(place, chord);
    f->slack        = flat_slack_with(slack, chord->bulge);
    int solid       = flat_solid(f, &line);
    f->slack        = slack;
    return solid;
}

/* The corner that is farthest where neither end of a chain goes, if both go on straight: it is on the convex hull. */
static size_t find_hull_corner(const Chord *chords, size_t count)
{
    double ways[2][2], out[2], most = -INFINITY;
    size_t corner = 1;
    way_of(&chords[0], ways[0]);
    way_of(&chords[count - 1], ways[1]);
    double lengths[2] = {hypot(ways[0][0], ways[0][1]), hypot(ways[1][0], ways[1][1])};
    for (int k = 0; k < 2; k++)
        out[k] = ways[0][k] / lengths[0] - ways[1][k] / lengths[1];
    if (hypot(out[0], out[1]) < 1e-9) {
        out[0] = -ways[0][1];
        out[1] = ways[0][0];
    }
    for (size_t i = 1; i < count; i++) {
        double far = out[0] * chords[i].from[0] + out[1] * chords[i].from[1];
        if (far > most) {
            most   = far;
            corner = i;
        }
    }
    return corner;
}

/* What is on the left of a chain.  Cut at a corner of its hull it is two chains, of which none meets what the other's end goes on
   to: each line counts once (Dobkin, Guibas, Hershberger and Snoeyink 1993). */
static int solid_of_chain(Finding *f, const Place *place, const Chord *chords, size_t count)
{
    if (count == 1)
        return solid_of_line(f, place, chords);
    size_t corner = find_hull_corner(chords, count);
    int    first  = solid_of_chain(f, place, chords, corner);
    int    second = solid_of_chain(f, place, chords + corner, count - corner);
    return turn_of(&chords[corner - 1], &chords[corner]) >= 0 ? flat_both(f, first, second)
                                                              : flat_either(f, first, second);
}

/* Tells whether a chord that goes on straight, behind its end or before its beginning, meets another. */
static bool goes_through(const Chord *chord, bool behind, const Chord *other)
{
    double way[2], across[2], from[2], to[2];
    way_of(chord, way);
    way_of(other, across);
    for (int k = 0; k < 2; k++) {
        from[k] = other->from[k] - (behind ? chord->to[k] : chord->from[k]);
        to[k]   = from[k] + across[k];
        way[k]  = behind ? way[k] : -way[k];
    }
    double first = cross2(way, from), second = cross2(way, to);
    if ((first > 0) == (second > 0))
        return false;
    double part = first / (first - second);
    return way[0] * (from[0] + part * across[0]) + way[1] * (from[1] + part * across[1]) > 0;
}

/* Tells whether both ends can go on straight. */
static bool has_free_ends(const Chord *chords, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if ((i > 1 && goes_through(&chords[0], false, &chords[i])) ||
            (i + 2 < count && goes_through(&chords[count - 1], true, &chords[i])))
            return false;
    return true;
}

/* Tells whether a point is on the left of a chain. */
static bool is_left(const Place *place, const Chord *chords, size_t count, const double point[2])
{
    Place near = {.distance = INFINITY, .margin = place->margin};
    for (int k = 0; k < 2; k++)
        near.range[k] = (Range){point[k], point[k]};
    for (size_t i = 0; i < count; i++)
        look_at_side(&near, &chords[i]);
    return is_left_of_nearest(&near);
}

typedef struct Chains {
    size_t count, begins[MAX_CHORDS + 1];
} Chains;

static bool find_chains(Place *place, Chains *chains)
{
    chains->count     = 0;
    chains->begins[0] = 0;
    for (size_t end = 0; end < place->count; chains->begins[++chains->count] = end) {
        size_t begin = end;
        end          = order_chain(place, begin);
        if (end == 0 || !has_free_ends(&place->chords[begin], end - begin))
            return false;
    }
    return true;
}

/* Tells whether chains are on the left of each other, as those of a thin part are, or none is, as on both sides of
   a gap. */
static bool lie_alike(const Place *place, const Chains *chains, bool left)
{
    for (size_t i = 0; i < chains->count; i++)
        for (size_t k = 0; k < chains->count; k++)
            if (i != k && is_left(place, &place->chords[chains->begins[i]],
                                  chains->begins[i + 1] - chains->begins[i],
                                  place->chords[chains->begins[k]].from) != left)
                return false;
    return true;
}

static int solid_of_chords(Finding *f, Place *place)
{
    Chains chains;
    bool   left = false;
    f->failed |= !find_chains(place, &chains);
    if (!f->failed) {
        left = lie_alike(place, &chains, true);
        f->failed |= !left && !lie_alike(place, &chains, false);
    }
    int solid = left ? FLAT_ALL : FLAT_NONE;
    for (size_t i = 0; i < chains.count && !f->failed; i++) {
        const Chord *chords = &place->chords[chains.begins[i]];
        int chain = solid_of_chain(f, place, chords, chains.begins[i + 1] - chains.begins[i]);
        solid     = left ? flat_both(f, solid, chain) : flat_either(f, solid, chain);
    }
    return solid;
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
    uint32_t        instances[MAX_LANE_INSTANCES], count;
    Place           place;
    if (!lane_outline_instances(f->tape, &f->field->ranges, value - LANE_INPUTS, instances,
                                &count)) {
        f->failed = true;
        return FLAT_NONE;
    }
    const InstanceTable *table = &f->tape->tape->graph->instances->tables.items[call->body->table];
    double               off   = flat_rounds_chord(f->rounds, call->body->table);
    find_place(f, call, &place);
    place.around = f->use == FLAT_PROVING && isfinite(off) ? off : 0;
    for (uint32_t i = 0; i < count && !f->failed; i++)
        look_at_arc(f, &place, &table->arcs[instances[i]], off);
    if (f->failed)
        return FLAT_NONE;
    if (place.count > 0)
        return solid_of_chords(f, &place);
    return is_left_of_nearest(&place) ? FLAT_ALL : FLAT_NONE;
}
