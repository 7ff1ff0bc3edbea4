/*
 * edge_normals.glsl: the normal of one side, where a hit is next to an edge or where solids touch.
 *
 * Differences that reach across an edge give a mean of the normals of its sides, which may mirror
 * light where neither side does.  So where the distance bends over the wide taps, nearer taps are
 * evaluated, which mostly see one side alone.  Where an edge is nearer still, they are evaluated
 * around a point a little outside, or inside.  Next to the line itself all of these see both sides.
 * So they are evaluated across it at last: at a point beside the hit and a little outside, towards
 * the eye or else at a right angle to that.
 *
 * The nearer taps are believed if the wide ones confirm them: the surface is flat and ends at an
 * edge.  Then one of each two opposite wide taps sees the same plane: the minimum or maximum of
 * planes lies on one side of each.  Where solids touch, the distance inside is that
 * to the face between them, and confirms nothing.  So the plane is looked for beside the edge as
 * well.  All other surfaces are curved or finer than a pixel, and keep the mean normal of the wide
 * taps.
 *
 * The file that includes this has the octahedron's vec3 sum and level, float t, and vec3 start.
 */
const float NEARER = 0.02;         // reach of the nearer taps, relative to the wide ones
const float NOISE_NEARER = 4e-5;   // their least reach, relative to coordinates: less is rounding
const float OUTWARD_REACHES = 3.0; // how far outside or inside, in reaches of the nearer taps
const float FLAT_ENOUGH = 0.0175;  // largest bend of a flat surface
#ifdef PLAIN
const float SHARP = FLAT_ENOUGH;   // nearer taps are for bends above SHARP: all that is not flat,
const float THIN = 4.0;            // and below THIN
#else
const float SHARP = 0.5;           // nearer taps are for bends above SHARP: not by curvature alone,
const float THIN = 1.0;            // and below THIN: else taps on both sides are outside
#endif
const float FLATTER = 0.008;       // largest bend of one side, relative to the wide bend up to 1, as
                                   // curvature bends in proportion to the reach until the taps see
                                   // the other side of something thin
// How far beside and outside of a hit on the line of an edge, in reaches of the nearer taps.  There
// an edge of any angle from 30 to 150 degrees has one side nearer than the other.
const float BESIDE_REACHES = 8.0, ABOVE_REACHES = 4.0;
const float FACING_ALIKE = 0.3;    // the least cosine between a side and the mean
const float ON_PLANE = 0.06;       // largest deviation from a plane, in parts of the reach
const float FACING_SAME = 0.999;   // the least cosine between a plane and the taps beside the edge

const uint WIDE = 0u, AT_HIT = 1u, OUTSIDE = 2u, INSIDE = 3u, TO_EYE = 4u, ACROSS = 5u, BESIDE = 6u,
           ONE_SIDE = 7u, MEAN = 8u;
#ifdef PLAIN
const uint FIRST = AT_HIT, LAST = ACROSS;
#else // most other detail is finer than a pixel
const uint FIRST = OUTSIDE, LAST = OUTSIDE;
#endif
uint  tap_set;         // the current set of taps, one of the above
vec3  sum_wide, level_wide;
float middle;          // the distance in the middle of the taps; 0 for the wide ones
float reach;           // of the wide taps
float bend_wide;       // bend of the wide taps
float at_hit;          // the distance at the hit
vec3  plane_normal;    // of the plane that is looked for beside the edge

// Returns the bend: how far the distances are from those to a plane, in parts of the reach.
float find_bend() { return length(level - 2.0 * middle) / length(sum); }

// Returns the point of the nearer taps for a hit on the line of an edge, relative to the hit, in
// reaches.
vec3 find_place_across(bool turned)
{
    vec3 mean = normalize(sum_wide), backwards = find_backwards(), right, up;
    find_frame(mean, right, up);
    vec3  to_eye = backwards - dot(backwards, mean) * mean;
    float size = length(to_eye);
    to_eye = size > 1e-3 ? to_eye / size : right;
    return BESIDE_REACHES * (turned ? cross(mean, to_eye) : to_eye) + ABOVE_REACHES * mean;
}

// Begins another set of taps.  Those beside an edge at which another solid stands are a reach away
// from that solid, along the plane that the last set has seen.
void begin_tap_set(uint which)
{
    float outward = which == OUTSIDE ? OUTWARD_REACHES : which == INSIDE ? -OUTWARD_REACHES : 0.0;
    vec3  wide = normalize(sum_wide), place = outward * (wide + find_backwards());
    tap_set = which;
    t = max(NEARER * reach, NOISE_NEARER * largest(hit.position) + hit.rounding);
#ifdef PLAIN
    if (which == TO_EYE || which == ACROSS)
        place = find_place_across(which == ACROSS);
#endif
    vec3 moved = t * place;
    if (which == BESIDE) {
        plane_normal = normalize(sum);
        vec3 lateral = wide - dot(wide, plane_normal) * plane_normal;
        t = reach;
        moved = reach * lateral / max(length(lateral), 1e-6);
    }
    start = hit.position + moved;
    begin_taps();
    tap_limit = TAPS + 1u; // the first one is in the middle
    direction = vec3(0.0);
}

void take_difference(float distance)
{
    bool wide = tap_set == WIDE;
    middle = taps == 1u ? wide ? 0.0 : distance : middle;
    sum += distance * direction;
    level += distance * abs(direction);
    direction = stencil(wide ? taps : taps - 1u);
}

// Tells whether the wide taps see the plane of the nearer ones, up to an edge.
bool is_confirmed()
{
    vec3 rise = reach / t * 0.5 * sum;
    vec3 ahead = 0.5 * (level_wide + sum_wide) - at_hit;
    vec3 behind = 0.5 * (level_wide - sum_wide) - at_hit;
    vec3 deviation = min(abs(ahead - rise), abs(behind + rise));
    return largest(deviation) < ON_PLANE * length(rise);
}

// Ends the wide taps.  Returns the set that follows; WIDE: none.
uint end_wide_taps()
{
    bend_wide = find_bend();
    sum_wide = sum;
    level_wide = level;
    reach = t;
    at_hit = 0.0;
    return bend_wide > SHARP && bend_wide < THIN ? FIRST : WIDE;
}

// Tells whether the nearer taps see one side of an edge.  If they are flat they may also see the seam
// inside of touching solids, but that has another normal.
bool is_one_side(float bend)
{
    bool alike = dot(sum, sum_wide) > FACING_ALIKE * length(sum) * length(sum_wide);
    bool visible = tap_set < TO_EYE || dot(sum, find_backwards()) > 0.0;
    return visible && (alike && tap_set != INSIDE && bend < FLATTER * min(bend_wide, 1.0) ||
                       bend < FLAT_ENOUGH && is_confirmed());
}

// Ends the taps beside an edge.  Returns what they have found: ONE_SIDE or MEAN.
uint end_beside()
{
    bool same = find_bend() < FLAT_ENOUGH && dot(sum, plane_normal) > FACING_SAME * length(sum) &&
                abs(middle) < ON_PLANE * t; // else another plane is there, such as the floor below
    sum = plane_normal;
    return same ? ONE_SIDE : MEAN;
}

// Ends other taps.  Returns the set that follows, or what has been found.
uint end_nearer_taps()
{
    float bend = find_bend();
    at_hit = tap_set == AT_HIT ? middle : at_hit;
    uint next = bend < FLAT_ENOUGH && tap_set < INSIDE ? BESIDE : MEAN;
    next = bend > FLAT_ENOUGH && tap_set < LAST ? tap_set + 1u : next; // an edge is between the taps
    return is_one_side(bend) ? ONE_SIDE : next;
}

// Ends a set of taps.  Returns whether another one has begun.
bool needs_more_taps()
{
    uint next = tap_set == WIDE     ? end_wide_taps()
                : tap_set == BESIDE ? end_beside()
                                    : end_nearer_taps();
    bool goes_on = next != WIDE && next < ONE_SIDE;
    if (goes_on)
        begin_tap_set(next);
    tap_set = next;
    if (next == MEAN) {
        sum = sum_wide;
        level = level_wide;
        t = reach;
    }
    return goes_on;
}
