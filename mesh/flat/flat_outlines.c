/*
 * flat_outlines.c: finds the chords of an outline that come into a box, and what is within them.
 *
 * A chord has both its ends on the curve.  The chords of a box must be one chain, or the few chains
 * of a thin part or of both sides of a gap; else the box is halved.
 */
#include "mesh/flat/flat_outlines.h"

#include "compiler/base/elementary.h"
#include "compiler/base/vec.h"
#include "compiler/graph/instance_table.h"
#include "compiler/graph/lanes/lane_outlines.h"
#include "mesh/flat/flat_circles.h"

enum { MAX_CHORDS = 8 };

typedef struct Chord {
    double from[2], to[2];
    double bulge; /* how far the curve is to the right of it at most; below 0: to the left */
} Chord;

/* The part of the outline's plane that a box has, and the chords in it. */
typedef struct Window {
    Form     at[2];
    Range    range[2];
    double   margin; /* of rounding */
    double   around; /* in proofs the distance of curves to their chords, else 0 */
    uint32_t table;
    size_t   count;
    Chord    chords[MAX_CHORDS]; /* that come into it */
    Chord    nearest;            /* to the middle of the window, of all chords */
    double   distance, across;   /* how far that is, and how far its line is */
} Window;

static double cross2(const double a[2], const double b[2]) { return a[0] * b[1] - a[1] * b[0]; }

static void vector_of(const Chord *chord, double along[2])
{
    for (int k = 0; k < 2; k++)
        along[k] = chord->to[k] - chord->from[k];
}

/* Returns the form of a chord's line, below 0 on its left. */
static Form line_of(const Window *window, const Chord *chord)
{
    double along[2];
    vector_of(chord, along);
    double length = real_hypot(along[0], along[1]);
    Form   line   = form_constant((chord->from[1] * along[0] - chord->from[0] * along[1]) / length);
    line          = form_sum(line, along[1] / length, &window->at[0]);
    return form_sum(line, -along[0] / length, &window->at[1]);
}

/* ---- chords ---- */

static double bend_of(const InstanceArc *arc) { return real_hypot(arc->bend[0], arc->bend[1]); }

/* Returns how many chords an arc needs: with even steps of the parameter they are at most bend / (4
   count^2) off. */
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

/* Tells whether a chord, and what is so far from it, stays out of the window. */
static bool lies_beyond(const Window *window, const Chord *chord, double off)
{
    double middle[2], half[2], along[2], margin = window->margin + off;
    for (int k = 0; k < 2; k++) {
        middle[k] = 0.5 * (window->range[k].low + window->range[k].high) - chord->from[k];
        half[k]   = 0.5 * (window->range[k].high - window->range[k].low) + margin;
        along[k]  = chord->to[k] - chord->from[k];
        if (min2(0, along[k]) > middle[k] + half[k] || max2(0, along[k]) < middle[k] - half[k])
            return true;
    }
    return fabs(cross2(along, middle)) > fabs(along[1]) * half[0] + fabs(along[0]) * half[1];
}

/* Takes a chord if it is the nearest, or equally near and its line is farther: the nearest tells on
   which side a window without chords is. */
static void take_nearest(Window *window, const Chord *chord)
{
    static const double SAME = 1e-9;
    double              along[2], from[2];
    vector_of(chord, along);
    for (int k = 0; k < 2; k++)
        from[k] = 0.5 * (window->range[k].low + window->range[k].high) - chord->from[k];
    double square = along[0] * along[0] + along[1] * along[1];
    double t      = min2(max2((from[0] * along[0] + from[1] * along[1]) / square, 0), 1);
    double off    = real_hypot(from[0] - t * along[0], from[1] - t * along[1]),
           least  = window->distance;
    double across = fabs(cross2(along, from)) / sqrt(square);
    if (off < least * (1 - SAME) || (off <= least * (1 + SAME) && across > window->across)) {
        window->nearest  = *chord;
        window->distance = off;
        window->across   = across;
    }
}

/* Tells whether the middle of the window is on the left of the nearest chord. */
static bool is_left_of_nearest(const Window *window)
{
    double along[2], from[2];
    vector_of(&window->nearest, along);
    for (int k = 0; k < 2; k++)
        from[k] = 0.5 * (window->range[k].low + window->range[k].high) - window->nearest.from[k];
    return cross2(along, from) > 0;
}

/* Notes that chords approximate curves here. */
static void note_curves(Finding *f, const Window *window)
{
    double slope = max2(form_steepness(f, &window->at[0]), form_steepness(f, &window->at[1]));
    bool   round = form_has_round(f, &window->at[0]) || form_has_round(f, &window->at[1]);
    if (slope > 0)
        flat_rounds_note_curves(f->rounds, window->table, 1 / slope, round);
    f->pieces->round = true;
}

static void add_chord(Finding *f, Window *window, const Chord *chord)
{
    bool curve = chord->bulge != 0 && !lies_beyond(window, chord, fabs(chord->bulge));
    take_nearest(window, chord);
    if (curve)
        note_curves(f, window);
    if (lies_beyond(window, chord, window->around))
        return;
    if (window->count == MAX_CHORDS)
        f->failed = true;
    else
        window->chords[window->count++] = *chord;
}

/* Adds the chords of an arc that come into the window; they may be `off` from the curve. */
static void add_arc(Finding *f, Window *window, const InstanceArc *arc, double off)
{
    double count = chords_needed(arc, off);
    for (double i = 0; i < count && !f->failed; i++) {
        Chord chord = find_chord(arc, i, count);
        add_chord(f, window, &chord);
    }
}

/* ---- chains ---- */

static bool meet(const Window *window, const Chord *before, const Chord *behind)
{
    return real_hypot(before->to[0] - behind->from[0], before->to[1] - behind->from[1]) <=
           window->margin;
}

/* Returns a chord, from number `begin` on, that follows another or comes before it; NULL if there
   is none. */
static Chord *find_neighbour(Window *window, const Chord *chord, bool behind, size_t begin)
{
    for (size_t i = begin; i < window->count; i++)
        if (behind ? meet(window, chord, &window->chords[i])
                   : meet(window, &window->chords[i], chord))
            return &window->chords[i];
    return NULL;
}

/* Orders chords from number `begin` on as a chain; returns where it ends, or 0 if it is closed. */
static size_t order_chain(Window *window, size_t begin)
{
    Chord *chords = window->chords, *next = NULL;
    size_t end = begin;
    for (size_t i = begin; i < window->count && !next; i++)
        next = find_neighbour(window, &chords[i], false, begin) ? NULL : &chords[i];
    for (; next; end++) {
        Chord chord = chords[end];
        chords[end] = *next;
        *next       = chord;
        next        = find_neighbour(window, &chords[end], true, end + 1);
    }
    return end > begin ? end : 0;
}

/* Returns the cross product of two chords: above 0 the second turns left. */
static double turn_of(const Chord *before, const Chord *behind)
{
    double first[2], second[2];
    vector_of(before, first);
    vector_of(behind, second);
    return cross2(first, second);
}

static int solid_of_line(Finding *f, const Window *window, const Chord *chord)
{
    FlatSlack slack = f->slack;
    Form      line  = line_of(window, chord);
    f->slack        = flat_slack_with(slack, chord->bulge);
    int solid       = flat_solid(f, &line);
    f->slack        = slack;
    return solid;
}

/* Returns the corner of a chain that is farthest in a direction in which neither end would lead, if
   both continued straight: it is on the convex hull. */
static size_t find_hull_corner(const Chord *chords, size_t count)
{
    double vectors[2][2], out[2], most = -INFINITY;
    size_t corner = 1;
    vector_of(&chords[0], vectors[0]);
    vector_of(&chords[count - 1], vectors[1]);
    double lengths[2] = {real_hypot(vectors[0][0], vectors[0][1]),
                         real_hypot(vectors[1][0], vectors[1][1])};
    for (int k = 0; k < 2; k++)
        out[k] = vectors[0][k] / lengths[0] - vectors[1][k] / lengths[1];
    if (real_hypot(out[0], out[1]) < 1e-9) {
        out[0] = -vectors[0][1];
        out[1] = vectors[0][0];
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

/* Returns the solid on the left of a chain.  Cut at a corner of its hull it is two chains, neither
   of which meets the extension of the other, so each line counts once (Dobkin, Guibas, Hershberger
   and Snoeyink 1993). */
static int solid_of_chain(Finding *f, const Window *window, const Chord *chords, size_t count)
{
    if (count == 1)
        return solid_of_line(f, window, chords);
    size_t corner = find_hull_corner(chords, count);
    int    first  = solid_of_chain(f, window, chords, corner);
    int    second = solid_of_chain(f, window, chords + corner, count - corner);
    return turn_of(&chords[corner - 1], &chords[corner]) >= 0 ? flat_both(f, first, second)
                                                              : flat_either(f, first, second);
}

/* Tells whether the straight extension of a chord, behind its end or before its beginning, meets
   another. */
static bool goes_through(const Chord *chord, bool behind, const Chord *other)
{
    double along[2], across[2], from[2], to[2];
    vector_of(chord, along);
    vector_of(other, across);
    for (int k = 0; k < 2; k++) {
        from[k]  = other->from[k] - (behind ? chord->to[k] : chord->from[k]);
        to[k]    = from[k] + across[k];
        along[k] = behind ? along[k] : -along[k];
    }
    double first = cross2(along, from), second = cross2(along, to);
    if ((first > 0) == (second > 0))
        return false;
    double part = first / (first - second);
    return along[0] * (from[0] + part * across[0]) + along[1] * (from[1] + part * across[1]) > 0;
}

/* Tells whether both ends can be extended straight. */
static bool has_free_ends(const Chord *chords, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if ((i > 1 && goes_through(&chords[0], false, &chords[i])) ||
            (i + 2 < count && goes_through(&chords[count - 1], true, &chords[i])))
            return false;
    return true;
}

/* Tells whether a point is on the left of a chain. */
static bool is_left(const Window *window, const Chord *chords, size_t count, const double point[2])
{
    Window near = {.distance = INFINITY, .margin = window->margin};
    for (int k = 0; k < 2; k++)
        near.range[k] = (Range){point[k], point[k]};
    for (size_t i = 0; i < count; i++)
        take_nearest(&near, &chords[i]);
    return is_left_of_nearest(&near);
}

typedef struct Chains {
    size_t count, begins[MAX_CHORDS + 1];
} Chains;

static bool find_chains(Window *window, Chains *chains)
{
    chains->count     = 0;
    chains->begins[0] = 0;
    for (size_t end = 0; end < window->count; chains->begins[++chains->count] = end) {
        size_t begin = end;
        end          = order_chain(window, begin);
        if (end == 0 || !has_free_ends(&window->chords[begin], end - begin))
            return false;
    }
    return true;
}

/* Tells whether all chains are on the left of each other, as those of a thin part, or none is, as
   on both sides of a gap. */
static bool chains_agree(const Window *window, const Chains *chains, bool left)
{
    for (size_t i = 0; i < chains->count; i++)
        for (size_t k = 0; k < chains->count; k++)
            if (i != k && is_left(window, &window->chords[chains->begins[i]],
                                  chains->begins[i + 1] - chains->begins[i],
                                  window->chords[chains->begins[k]].from) != left)
                return false;
    return true;
}

static int solid_of_chords(Finding *f, Window *window)
{
    Chains chains;
    bool   left = false;
    f->failed |= !find_chains(window, &chains);
    if (!f->failed) {
        left = chains_agree(window, &chains, true);
        f->failed |= !left && !chains_agree(window, &chains, false);
    }
    int solid = left ? FLAT_ALL : FLAT_NONE;
    for (size_t i = 0; i < chains.count && !f->failed; i++) {
        const Chord *chords = &window->chords[chains.begins[i]];
        int chain = solid_of_chain(f, window, chords, chains.begins[i + 1] - chains.begins[i]);
        solid     = left ? flat_both(f, solid, chain) : flat_either(f, solid, chain);
    }
    return solid;
}

/* ---- outlines ---- */

static void open_window(Finding *f, const LaneCall *call, Window *window)
{
    window->table    = call->body->table;
    window->margin   = FLAT_ROUNDING * f->size;
    window->count    = 0;
    window->distance = INFINITY;
    window->across   = 0;
    for (int k = 0; k < 2; k++) {
        window->at[k]    = form_of_operand(f, call->operands[1][k]);
        window->range[k] = form_range(f, &window->at[k]);
        f->failed |= !window->at[k].known ||
                     !isfinite(window->range[k].low + window->range[k].high);
    }
}

int flat_solid_of_outline(Finding *f, uint32_t value)
{
    const LaneCall *call = &f->tape->calls[f->tape->steps[value - LANE_INPUTS].operands[0]];
    uint32_t        instances[MAX_LANE_INSTANCES], count;
    Window          window;
    if (!lane_outline_instances(f->tape, &f->field->ranges, value - LANE_INPUTS, instances,
                                &count)) {
        f->failed = true;
        return FLAT_NONE;
    }
    const InstanceTable *table = &f->tape->tape->graph->instances->tables.items[call->body->table];
    double               off   = flat_rounds_chord(f->rounds, call->body->table);
    open_window(f, call, &window);
    window.around = f->use == FLAT_PROVING && isfinite(off) ? off : 0;
    for (uint32_t i = 0; i < count && !f->failed; i++)
        add_arc(f, &window, &table->arcs[instances[i]], off);
    if (f->failed)
        return FLAT_NONE;
    if (window.count > 0)
        return solid_of_chords(f, &window);
    return is_left_of_nearest(&window) ? FLAT_ALL : FLAT_NONE;
}
