/*
 * distance_normals.glsl: normals by differences of the distance at the taps of a stencil.
 *
 * Sets of taps are equally long.  Some hits need more than one set (edge_normals.glsl).
 *
 * ROOTS: rays go from root to root.  GRADIENT: where derivatives are finite, no tap is needed.
 *
 * The file that includes this has the hit and the taps.
 */
#include "stencil.glsl"

// Surfaces of this evenness or more are flat.
const float EVEN = 0.9995;

vec3 start, direction; // the next distance is sampled at start + t direction
vec3 level;            // the sum of distance * abs(direction)
#if STENCIL == 3 && defined(ROOTS)
bool  looks_nearer; // the nearer taps are evaluated
float even;         // evenness by the wide taps
#elif STENCIL == 3
void begin_taps();
#include "edge_normals.glsl"
#endif
#ifdef GRADIENT
bool  derived;     // the normal is by derivatives
#endif

// Begins the taps of the stencil around the hit.
void begin_taps()
{
    taps = 0u;
    tap_limit = TAPS;
    direction = stencil(0u);
    sum = level = vec3(0.0);
}

void begin_normal()
{
    start = hit.position;
    // Differences over a pixel or so: finer detail would only be noise.
    t = find_reach(hit);
#if STENCIL == 3 && defined(ROOTS)
    looks_nearer = false;
#elif STENCIL == 3
    tap_set = WIDE;
#endif
    begin_taps();
#ifdef GRADIENT
    // Differences are used where derivatives are not finite.
    vec3 gradient = krs_gradient(hit.position, t);
    // Differences are also used where rounding makes a visible surface face away from the eye.
    float facing_eye = hit.side * dot(gradient, find_backwards());
#ifdef OPEN_SURFACES // both sides are visible
    gradient *= facing_eye < 0.0 ? -1.0 : 1.0;
    facing_eye = abs(facing_eye);
#endif
    derived = facing_eye > 0.0 && dot(gradient, gradient) < INFINITE;
    if (derived) {
        sum = hit.side * normalize(gradient);
        tap_limit = 0u;
    }
#endif
}

// Tells how even the surface is: 1 where it is flat.  There opposite taps cancel in `level`.  On an edge,
// or on detail finer than the distance between taps, they do not.
float find_evenness()
{
    float size = length(sum), uneven = length(vec2(size, length(level)));
    return uneven > 0.0 && uneven < INFINITE ? size / uneven : 1.0;
}

#if defined(ROOTS) && STENCIL == 3
// Around a curve on which its gradient vanishes a polynomial's distance is far from linear.  So
// where the surface is not even, nearer taps are evaluated, with the corners of a cube as well.
// With weight 9/8 these make the octahedron exact up to the fifth power.
const float NEARER = 0.125;
const uint CORNERS = 8u;
vec3 corner(uint i)
{
    return 0.57735026919 * (2.0 * vec3(i & 1u, i >> 1u & 1u, i >> 2u & 1u) - 1.0);
}

void begin_nearer_taps()
{
    t = max(NEARER * t, NOISE * largest(hit.position) + hit.rounding);
    looks_nearer = true;
    begin_taps();
    tap_limit = TAPS + CORNERS;
}

void take_difference(float distance)
{
    float weight = taps > TAPS ? 1.125 : 1.0;
    sum += weight * distance * direction;
    level += weight * distance * abs(direction);
    direction = taps < TAPS ? stencil(taps) : corner(taps - TAPS);
    if (taps >= TAPS && !looks_nearer) {
        even = find_evenness();
        if (even < EVEN)
            begin_nearer_taps();
    }
}

float find_flatness() { return looks_nearer ? even : find_evenness(); }
#else
#if STENCIL != 3
void take_difference(float distance)
{
#if STENCIL == 1
    sum += distance * (taps == 1u ? vec3(-1.0) : direction);
#else
    sum += distance * direction;
    level += distance * abs(direction);
#endif
    direction = stencil(taps);
}
#endif

float find_flatness()
{
    float evenness = find_evenness();
#if STENCIL == 3
    evenness = tap_set == ONE_SIDE ? 1.0 : evenness;
#endif
    return evenness;
}
#endif

void take_tap()
{
    float distance = krs_distance(start + t * direction);
    if (!item_needs_step())
        return;
    taps++;
    take_difference(hit.side * distance);
}

// Ends a set of taps.  Returns whether another one has begun.
bool item_needs_more_taps()
{
#if STENCIL == 3 && !defined(ROOTS)
#ifdef GRADIENT
    if (derived)
        return false;
#endif
    return needs_more_taps();
#else
    return false;
#endif
}
