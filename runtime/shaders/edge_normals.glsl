/*
 * edge_normals.glsl: the normal of one side, where a hit is next to an edge or where solids touch.
 *
 * Differences that reach across an edge find what is between the normals of its sides, which shines
 * where neither does.  So where they bend all is looked at from nearer, where most hits have one
 * side alone; where an edge is nearer still, from a little outside, or inside.  What is found
 * counts if the wider differences bear it out: the surface is flat and ends at an edge.  Then of
 * each two opposite taps one sees the same plane, since the least or greatest of some planes lies
 * on one side of each of them.  Where solids touch, the distance inside is that to the face on
 * which they do, and bears nothing out; so the plane is looked for beside the edge as well.  All
 * else is curved or finer than a pixel, and keeps the mean that the wider differences are.
 *
 * Who includes this has the octahedron's vec3 sum and level, float t, and vec3 start.
 */
const float NEARER = 0.02;         // as far as the wider taps
const float NOISE_NEARER = 4e-5;   // of the coordinates: less would be rounding
const float OUTWARD_REACHES = 3.0; // outside or inside, in reaches of the nearer taps
const float FLAT_ENOUGH = 0.0175;  // bends of what is flat
#ifdef PLAIN
const float SHARP = FLAT_ENOUGH;   // and of what is looked at again: all else,
const float THIN = 4.0;
#else
const float SHARP = 0.5;           // and of what is looked at again: what cannot be curved alone,
const float THIN = 1.0;            // nor so thin that taps on both sides are outside
#endif
const float KINK = 0.06;           // a bend so near that an edge runs between the taps
const float FLATTER = 0.008;       // what is curved bends in proportion to the reach
const float FACING_ALIKE = 0.3;    // the least cosine between a side and the mean
const float ON_PLANE = 0.06;       // in parts of the reach
const float FACING_SAME = 0.999;   // the least cosine between a plane and what is beside the edge

const uint WIDE = 0u, AT_HIT = 1u, OUTSIDE = 2u, INSIDE = 3u, BESIDE = 4u, ONE_SIDE = 5u, MEAN = 6u;
#ifdef PLAIN
const uint FIRST = AT_HIT, LAST = INSIDE;
#else // most else is finer than a pixel
const uint FIRST = OUTSIDE, LAST = OUTSIDE;
#endif
uint  tap_set;         // which one it is
vec3  sum_wide, level_wide;
float middle;          // the distance in the middle of the taps; 0 of the wider ones
float reach;           // of these,
float bend_wide;       // and how they bend
float at_hit;          // the distance there
vec3  plane_normal;    // the plane that is looked for beside the edge

// How far from a plane all is, in parts of the reach.
float find_bend() { return length(level - 2.0 * middle) / length(sum); }

void begin_tap_set(uint which)
{
    float outward = which == OUTSIDE ? OUTWARD_REACHES : which == INSIDE ? -OUTWARD_REACHES : 0.0;
    tap_set = which;
    t = max(NEARER * reach, NOISE_NEARER * largest(hit.position) + hit.rounding);
    start = hit.position + outward * t * (normalize(sum_wide) + find_backwards());
    begin_taps();
    tap_limit = TAPS + 1u; // the first in their middle
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

// Whether the wider taps see the plane of the nearer ones, up to an edge.
bool is_confirmed()
{
    vec3 rise = reach / t * 0.5 * sum;
    vec3 ahead = 0.5 * (level_wide + sum_wide) - at_hit;
    vec3 behind = 0.5 * (level_wide - sum_wide) - at_hit;
    vec3 deviation = min(abs(ahead - rise), abs(behind + rise));
    return largest(deviation) < ON_PLANE * length(rise);
}

void end_wide_taps()
{
    bend_wide = find_bend();
    if (!(bend_wide > SHARP && bend_wide < THIN))
        return;
    sum_wide = sum;
    level_wide = level;
    reach = t;
    at_hit = 0.0;
    begin_tap_set(FIRST);
}

// What is so flat may be a seam within, but that has another normal.
bool is_one_side(float bend)
{
    bool alike = dot(sum, sum_wide) > FACING_ALIKE * length(sum) * length(sum_wide);
    return alike && tap_set != INSIDE && bend < FLATTER * bend_wide ||
           bend < FLAT_ENOUGH && is_confirmed();
}

// From the edge on which another solid stands: a reach away from that one along the plane.
void begin_beside()
{
    plane_normal = normalize(sum);
    vec3 wide = normalize(sum_wide), lateral = wide - dot(wide, plane_normal) * plane_normal;
    begin_tap_set(BESIDE);
    t = reach;
    start = hit.position + reach * lateral / max(length(lateral), 1e-6);
}

void end_beside()
{
    bool same = find_bend() < FLAT_ENOUGH && dot(sum, plane_normal) > FACING_SAME * length(sum);
    tap_set = same ? ONE_SIDE : MEAN;
    sum = plane_normal;
}

void end_nearer_taps()
{
    float bend = find_bend();
    at_hit = tap_set == AT_HIT ? middle : at_hit;
    if (bend > KINK && tap_set < LAST)
        begin_tap_set(tap_set + 1u);
    else if (is_one_side(bend))
        tap_set = ONE_SIDE;
    else if (bend < FLAT_ENOUGH && tap_set != INSIDE)
        begin_beside();
    else
        tap_set = MEAN;
}

// Whether there is more to look at.
bool needs_more_taps()
{
    if (tap_set == WIDE)
        end_wide_taps();
    else if (tap_set == BESIDE)
        end_beside();
    else
        end_nearer_taps();
    if (tap_set == MEAN) {
        sum = sum_wide;
        level = level_wide;
        t = reach;
    }
    return tap_set != WIDE && tap_set < ONE_SIDE;
}
