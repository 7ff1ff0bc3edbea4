/* bend.c: bends chords to the outline. */
#include "slice/section.h"

#include <string.h>

#include "compiler/base/elementary.h"
#include "compiler/base/vec.h"

/* The part of the error that chords may be from the outline; dropped points have the rest. */
static const double PART_OF_CHORDS = 0.25;
/* Chords as short as this part of the error stay as they are. */
static const double SHORTEST = 1.0 / 256;
/* The most that a corner is from the outline, in errors, and over the distance where tangents of an
   arc would meet; and the cosine of the angle by which normals differ at least. */
static const double NEAR_CORNER = 1e-3, PART_OF_ARC = 0.02, STRAIGHT_COSINE = 1 - 1e-5;
/* Cosine of the angle of normals beyond which a stretch has a corner, or is halved. */
static const double SMOOTH_COSINE = 0.996;
/* Least distance of a corner to the ends of a stretch, in its lengths: a nearer one is the corner
   at that end. */
static const double NEAREST = 0.02;
/* The lengths beside a chord at which the distance is evaluated: in its lengths, and in errors,
   where a sharp corner may be. */
static const double BESIDE_LENGTHS = 0.5, BESIDE_ERRORS = 4;

typedef struct Stretch {
    double from[2], to[2];
    bool   corners[2];                /* whether they are corners */
    double along[2], left[2], length; /* unit vectors; the solid is on the left */
} Stretch;

static Stretch stretch_between(const OutlinePoint *from, const OutlinePoint *to)
{
    Stretch stretch = {.from    = {from->at[0], from->at[1]},
                       .to      = {to->at[0], to->at[1]},
                       .corners = {from->corner, to->corner}};
    for (int k = 0; k < 2; k++)
        stretch.along[k] = to->at[k] - from->at[k];
    stretch.length = real_hypot(stretch.along[0], stretch.along[1]);
    for (int k = 0; k < 2 && stretch.length > 0; k++)
        stretch.along[k] /= stretch.length;
    stretch.left[0] = -stretch.along[1];
    stretch.left[1] = stretch.along[0];
    return stretch;
}

/* Finds the point at a part of the stretch, and so far to the left of it. */
static void beside(const Stretch *stretch, double part, double left, double at[2])
{
    for (int k = 0; k < 2; k++)
        at[k] = stretch->from[k] + part * stretch->length * stretch->along[k] +
                left * stretch->left[k];
}

/* Tells whether the outline is within reach at four points along the stretch. */
static bool is_near(const Section *s, const Stretch *stretch, double reach)
{
    static const double parts[4] = {0.17, 0.39, 0.61, 0.87};
    double              points[8][2], distances[8];
    for (int i = 0; i < 8; i++)
        beside(stretch, parts[i / 2], i % 2 ? reach : -reach, points[i]);
    slice_distances(s->field, &s->plane, (const double(*)[2])points, 8, distances);
    for (int i = 0; i < 8; i++)
        if (is_inside(distances[i]) != (i % 2 == 1))
            return false;
    return true;
}

/* A search for the outline between a point inside and one outside, by parts of the line between
   them. */
typedef struct Search {
    double inside[2], outside[2], low, high, at_low, at_high;
} Search;

static void point_between(const Search *search, double part, double at[2])
{
    for (int k = 0; k < 2; k++)
        at[k] = search->inside[k] + part * (search->outside[k] - search->inside[k]);
}

static double part_at_zero(const Search *search)
{
    bool finite = isfinite(search->at_low) && isfinite(search->at_high);
    return finite && search->at_low < search->at_high
               ? search->at_low / (search->at_low - search->at_high)
               : 0.5;
}

/* Evaluates eight points, which cost as much as one: around where the line through both ends is 0,
   or evenly. */
static void narrow(const Section *s, Search *search, bool evenly)
{
    enum { POINTS = 8 };
    static const double around[POINTS] = {-0.2, -0.02, -1e-3, -1e-5, 1e-5, 1e-3, 0.02, 0.2};
    double points[POINTS][2], values[POINTS], parts[POINTS], width = search->high - search->low;
    double zero = part_at_zero(search);
    for (int i = 0; i < POINTS; i++) {
        double part = evenly ? (i + 1.0) / (POINTS + 1) : min2(max2(zero + around[i], 0), 1);
        parts[i]    = search->low + width * part;
        point_between(search, parts[i], points[i]);
    }
    slice_distances(s->field, &s->plane, (const double(*)[2])points, POINTS, values);
    for (int i = 0; i < POINTS; i++)
        if (is_inside(values[i])) {
            search->low    = parts[i];
            search->at_low = values[i];
        } else {
            search->high    = parts[i];
            search->at_high = values[i];
            return;
        }
}

/* Finds the outline to an accuracy of `enough`; evenly where the line through the ends does not
   lead to it. */
static void find_between(const Section *s, Search *search, double at[2])
{
    enum { MAX_ROUNDS = 30 };
    const double length = real_hypot(search->outside[0] - search->inside[0],
                                     search->outside[1] - search->inside[1]);
    bool         evenly = false;
    for (int i = 0; i < MAX_ROUNDS && (search->high - search->low) * length > s->enough; i++) {
        double width = search->high - search->low;
        narrow(s, search, evenly);
        evenly = search->high - search->low > 0.25 * width;
    }
    point_between(search, search->low + (search->high - search->low) * part_at_zero(search), at);
}

/* Finds the outline across the middle of a stretch, no farther off than its length: to the right if
   the middle is inside, or to the left.  Returns false if it is not there. */
static bool find_middle(const Section *s, const Stretch *stretch, double at[2])
{
    enum { STEPS = 7 };
    double points[STEPS + 1][2], distances[STEPS + 1], reach = stretch->length / (1 << (STEPS - 1));
    beside(stretch, 0.5, 0, points[0]);
    slice_distances(s->field, &s->plane, (const double(*)[2])points, 1, distances);
    bool inside = is_inside(distances[0]);
    for (int i = 1; i <= STEPS; i++, reach *= 2)
        beside(stretch, 0.5, inside ? -reach : reach, points[i]);
    slice_distances(s->field, &s->plane, (const double(*)[2])points, STEPS + 1, distances);
    for (int i = 1; i <= STEPS; i++) {
        int    in = inside ? i - 1 : i, out = inside ? i : i - 1;
        Search search = {.high = 1, .at_low = distances[in], .at_high = distances[out]};
        if (is_inside(distances[i]) == inside)
            continue;
        memcpy(search.outside, points[out], sizeof search.outside);
        memcpy(search.inside, points[in], sizeof search.inside);
        find_between(s, &search, at);
        return true;
    }
    return false;
}

/* The normal of the outline at both ends, and how steep the distance is. */
typedef struct Ends {
    double normals[2][2], steep[2];
} Ends;

/* Finds normals at both ends, or a little farther on at corners, where they jump. */
static bool find_ends(const Section *s, const Stretch *stretch, Ends *ends)
{
    static const double BESIDE_CORNER = 0.01;
    double              points[2][2];
    beside(stretch, stretch->corners[0] ? BESIDE_CORNER : 0, 0, points[0]);
    beside(stretch, stretch->corners[1] ? 1 - BESIDE_CORNER : 1, 0, points[1]);
    slice_gradients(s->field, &s->plane, (const double(*)[2])points, 1e-3 * stretch->length,
                    ends->normals);
    for (int i = 0; i < 2; i++) {
        ends->steep[i] = real_hypot(ends->normals[i][0], ends->normals[i][1]);
        if (!(ends->steep[i] > 0))
            return false;
        ends->normals[i][0] /= ends->steep[i];
        ends->normals[i][1] /= ends->steep[i];
    }
    return true;
}

static double width_beside(const Section *s, double length)
{
    return BESIDE_LENGTHS * length + BESIDE_ERRORS * s->error;
}

/* Finds where the tangents at both ends meet, if that is a corner of the outline. */
static bool meet_tangents(const Section *s, const Stretch *stretch, const Ends *ends, double at[2])
{
    const double *n = ends->normals[0], *m = ends->normals[1];
    double        cosine = n[0] * m[0] + n[1] * m[1], sine = n[0] * m[1] - n[1] * m[0];
    double        distance,
        across = stretch->length * (m[0] * stretch->along[0] + m[1] * stretch->along[1]);
    if (cosine > STRAIGHT_COSINE || sine == 0)
        return false;
    at[0]       = stretch->from[0] - n[1] * across / sine;
    at[1]       = stretch->from[1] + n[0] * across / sine;
    double from = across / sine / stretch->length;
    double to   = (m[0] * (stretch->to[1] - at[1]) - m[1] * (stretch->to[0] - at[0])) /
                stretch->length;
    if (from < NEAREST || to < NEAREST ||
        min2(from, to) * stretch->length > width_beside(s, stretch->length))
        return false;
    slice_distances(s->field, &s->plane, (const double(*)[2])at, 1, &distance);
    double near = min2(NEAR_CORNER * s->error, PART_OF_ARC * stretch->length * fabs(sine) / 8);
    return fabs(distance) <= near * min2(ends->steep[0], ends->steep[1]);
}

/* Finds a point of the outline towards the next, no farther than `reach`, by a step of Newton. */
static bool point_towards(const Section *s, const OutlinePoint *from, const OutlinePoint *to,
                          double reach, OutlinePoint *point)
{
    double length = real_hypot(to->at[0] - from->at[0], to->at[1] - from->at[1]), distance;
    double points[2][2], gradients[2][2];
    *point = *to;
    if (length <= reach)
        return true;
    point->corner = false;
    for (int k = 0; k < 2; k++)
        points[0][k] = points[1][k] = from->at[k] + reach / length * (to->at[k] - from->at[k]);
    slice_distances(s->field, &s->plane, (const double(*)[2])points, 1, &distance);
    slice_gradients(s->field, &s->plane, (const double(*)[2])points, 1e-3 * reach, gradients);
    double steep2 = gradients[0][0] * gradients[0][0] + gradients[0][1] * gradients[0][1];
    for (int k = 0; k < 2; k++)
        point->at[k] = points[0][k] - distance * gradients[0][k] / steep2;
    return steep2 > 0;
}

/* Finds a corner by tangents at points nearer and nearer to it: tangents of what is round meet
   beside it. */
static bool find_corner_of(const Section *s, const Stretch *stretch, const Ends *ends, double at[2])
{
    enum { TRIES = 2 };
    static const double CLOSER = 0.02, LEAST = 1e5;
    if (!meet_tangents(s, stretch, ends, at))
        return false;
    OutlinePoint corner = {{at[0], at[1]}, true}, outer[2] = {{.corner = false}}, from, to;
    memcpy(outer[0].at, stretch->from, sizeof outer[0].at);
    memcpy(outer[1].at, stretch->to, sizeof outer[1].at);
    double reach = CLOSER * min2(stretch_between(&outer[0], &corner).length,
                                 stretch_between(&corner, &outer[1]).length);
    for (int i = 0; i < TRIES && reach > LEAST * s->enough; i++, reach *= CLOSER) {
        Ends closer;
        if (!point_towards(s, &corner, &outer[0], reach, &from) ||
            !point_towards(s, &corner, &outer[1], reach, &to))
            break;
        Stretch around = stretch_between(&from, &to);
        if (around.length == 0 || !find_ends(s, &around, &closer) ||
            !meet_tangents(s, &around, &closer, corner.at))
            break;
        memcpy(at, corner.at, sizeof corner.at);
    }
    return true;
}

/* Tells whether an arc with these tangents, nearly parallel ones, is within reach of the
   stretch. */
static bool has_tangents(const Stretch *stretch, const Ends *ends, double reach)
{
    const double *n = ends->normals[0], *m = ends->normals[1];
    if (n[0] * m[0] + n[1] * m[1] < SMOOTH_COSINE)
        return false;
    for (int i = 0; i < 2; i++) {
        double sine = ends->normals[i][0] * stretch->along[0] +
                      ends->normals[i][1] * stretch->along[1];
        if (0.25 * stretch->length * fabs(sine) > 1.5 * reach)
            return false;
    }
    return true;
}

/* Tells whether the outline is within reach; beside what is thinner, on straight or short
   stretches, a shorter reach may be needed to miss the other side. */
static bool is_near_enough(const Section *s, const Stretch *stretch, const Ends *ends, double reach)
{
    static const double CLOSER = 1.0 / 8, SHORT = 0.5, SAME_COSINE = 1 - 1e-9;
    const double(*n)[2] = ends->normals;
    bool same           = n[0][0] * n[1][0] + n[0][1] * n[1][1] > SAME_COSINE;
    bool thin           = s->split_thin && (same || stretch->length < SHORT * reach);
    for (int i = 0; i < (thin ? 3 : 1); i++, reach *= CLOSER)
        if (is_near(s, stretch, reach))
            return true;
    return false;
}

/* Finds the box in which the distance is mostly evaluated between two points of the outline. */
static void box_between(const Section *s, const double from[2], const double to[2], double low[2],
                        double high[2])
{
    double wider = width_beside(s, real_hypot(to[0] - from[0], to[1] - from[1]));
    for (int k = 0; k < 2; k++) {
        low[k]  = min2(from[k], to[k]) - wider;
        high[k] = max2(from[k], to[k]) + wider;
    }
}

static void bend(Section *s, const OutlinePoint *from, const OutlinePoint *to, int depth);

/* Bends half of a stretch, with the field pruned to it. */
static void bend_half(Section *s, const OutlinePoint *from, const OutlinePoint *to, int depth)
{
    double low[2], high[2];
    box_between(s, from->at, to->at, low, high);
    bool entered = enter_square(s, low, high);
    bend(s, from, to, depth);
    if (entered)
        field_leave(s->field);
}

static void bend(Section *s, const OutlinePoint *from, const OutlinePoint *to, int depth)
{
    enum { MAX_HALVINGS = 30 };
    double       reach   = PART_OF_CHORDS * s->error;
    Stretch      stretch = stretch_between(from, to);
    OutlinePoint point;
    Ends         ends;
    bool         known = stretch.length > 0 && find_ends(s, &stretch, &ends);
    point.corner       = known && find_corner_of(s, &stretch, &ends, point.at);
    if ((!point.corner && stretch.length < SHORTEST * s->error) || depth > MAX_HALVINGS)
        return;
    if (!point.corner) {
        bool straight = !known || has_tangents(&stretch, &ends, reach);
        bool near     = straight && (known ? is_near_enough(s, &stretch, &ends, reach)
                                           : is_near(s, &stretch, reach));
        if (near || !find_middle(s, &stretch, point.at))
            return;
    }
    bend_half(s, from, &point, depth + 1);
    array_push_large(&s->arena, &s->bends, point);
    bend_half(s, &point, to, depth + 1);
}

static void box_of_chord(const Section *s, size_t item, double low[2], double high[2])
{
    const Chord *chord = &s->chords.items[item];
    box_between(s, s->crossings.items[chord->from].point, s->crossings.items[chord->to].point, low,
                high);
}

/* ---- corners at the ends of stretches ---- */

/* Searches a corner that was too near to an end of its stretch between both neighbours of that
   end. */
static void find_corner_at(const Section *s, const OutlinePoint *before, OutlinePoint *point,
                           const OutlinePoint *behind)
{
    static const double MAX_TIMES = 20;
    Stretch             first     = stretch_between(before, point);
    Stretch             last      = stretch_between(point, behind);
    double       cosine = first.along[0] * last.along[0] + first.along[1] * last.along[1], at[2];
    double       reach  = MAX_TIMES * min2(first.length, last.length);
    OutlinePoint from, to;
    Ends         ends;
    if (point->corner || reach == 0 || cosine > STRAIGHT_COSINE ||
        !point_towards(s, point, before, reach, &from) ||
        !point_towards(s, point, behind, reach, &to))
        return;
    Stretch stretch = stretch_between(&from, &to);
    if (stretch.length > 0 && find_ends(s, &stretch, &ends) &&
        find_corner_of(s, &stretch, &ends, at)) {
        memcpy(point->at, at, sizeof at);
        point->corner = true;
    }
}

static OutlinePoint point_of_chord(const Section *s, const Chord *chord, size_t number)
{
    if (number < chord->count)
        return s->bends.items[chord->first + number];
    const Crossing *to = &s->crossings.items[chord->to];
    return (OutlinePoint){{to->point[0], to->point[1]}, to->corner};
}

static void box_of_loose(const Section *s, size_t item, double low[2], double high[2])
{
    uint32_t number = s->loose.items[item];
    uint32_t next   = s->crossings.items[s->chords.items[number].to].chord;
    double   from[2], to[2];
    box_of_chord(s, number, low, high);
    if (next == 0)
        return;
    box_of_chord(s, next - 1, from, to);
    for (int k = 0; k < 2; k++) {
        low[k]  = min2(low[k], from[k]);
        high[k] = max2(high[k], to[k]);
    }
}

/* Searches corners at the bends of a chord, and between it and the next; returns false if the next
   is not bent yet. */
static bool find_missed_corners(Section *s, const Chord *chord)
{
    const Crossing *start  = &s->crossings.items[chord->from];
    Crossing       *end    = &s->crossings.items[chord->to];
    OutlinePoint    before = {{start->point[0], start->point[1]}, start->corner};
    if (end->chord > 0 && !s->chords.items[end->chord - 1].bent)
        return false;
    for (size_t k = 0; k < chord->count; k++) {
        OutlinePoint behind = point_of_chord(s, chord, k + 1);
        find_corner_at(s, &before, &s->bends.items[chord->first + k], &behind);
        before = s->bends.items[chord->first + k];
    }
    if (end->chord == 0)
        return true;
    OutlinePoint point  = point_of_chord(s, chord, chord->count);
    OutlinePoint behind = point_of_chord(s, &s->chords.items[end->chord - 1], 0);
    find_corner_at(s, &before, &point, &behind);
    memcpy(end->point, point.at, sizeof end->point);
    end->corner = point.corner;
    return true;
}

static void find_loose_corners(Section *s, size_t first, size_t count)
{
    for (size_t i = first; i < first + count; i++)
        find_missed_corners(s, &s->chords.items[s->loose.items[i]]);
}

/* ---- all chords ---- */

static void bend_chord(Section *s, Chord *chord)
{
    OutlinePoint from = {.corner = false}, to = from;
    chord->first = (uint32_t)s->bends.count;
    memcpy(from.at, s->crossings.items[chord->from].point, sizeof from.at);
    memcpy(to.at, s->crossings.items[chord->to].point, sizeof to.at);
    bend(s, &from, &to, 0);
    chord->count = (uint32_t)s->bends.count - chord->first;
    chord->bent  = true;
}

/* Bends chords; most are followed by one of the same group, the others are loose. */
static void bend_some(Section *s, size_t first, size_t count)
{
    for (size_t i = first; i < first + count; i++)
        bend_chord(s, &s->chords.items[i]);
    for (size_t i = first; i < first + count; i++)
        if (!find_missed_corners(s, &s->chords.items[i]))
            array_push_large(&s->arena, &s->loose, (uint32_t)i);
}

void bend_chords(Section *s)
{
    in_groups(s, s->chords.count, box_of_chord, bend_some);
    in_groups(s, s->loose.count, box_of_loose, find_loose_corners);
}
