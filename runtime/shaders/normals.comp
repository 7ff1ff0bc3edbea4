#version 440
#extension GL_GOOGLE_include_directive : enable
/*
 * normals.comp: the normal of each hit, from the distance at a few taps around it.
 *
 * Sets of taps are equally long, so lanes that loop together end them together.  Some pixels need
 * more than one set (edge_normals.glsl).  Then their lane falls behind, and the others go on.
 *
 * ROOTS: rays go from root to root.
 */
#include "scene.glsl"
#include "frame.glsl"
#include "hit_lists.glsl"
#include "stencil.glsl"
#if defined(PATH_RAYS) || defined(MIXED_RAYS)
#define FOLLOWS_PATHS
#include "media.glsl"
#endif

// Surfaces of this evenness or more are flat.
const float EVEN = 0.9995;

// The current item.
HitPoint hit;
vec3  start, direction; // the next distance is sampled at start + t direction
float t;
uint  taps, tap_limit; // evaluated so far, and at most
vec3  sum, level;      // of distance * direction, and of distance * abs(direction)
#if STENCIL == 3 && defined(ROOTS)
bool  looks_nearer; // the nearer taps are evaluated
float even;         // evenness by the wide taps
#elif STENCIL == 3
void begin_taps();
vec3 find_backwards();
#include "edge_normals.glsl"
#endif
#ifdef GRADIENT
bool  derived;     // the normal is by derivatives
#if defined(ROOTS) && STENCIL == 3
#define TAPS_OUTSIDE 1u // a tap that tells whether the derivatives can be trusted
#else
#define TAPS_OUTSIDE 0u
#endif
#endif

// The unit vector from the hit back along its ray.
vec3 find_backwards()
{
#if defined(LISTED_RAYS) || defined(PATH_RAYS) || defined(LENS)
    return -hit.direction;
#else
    vec3 backwards = control.projection == ORTHOGRAPHIC ? -frame.forward.xyz
                                                        : normalize(frame.eye - hit.position);
    return are_of_paths() ? -hit.direction : backwards;
#endif
}

// Begins the taps of the stencil around the hit.
void begin_taps()
{
    taps = 0u;
    tap_limit = TAPS;
    direction = stencil(0u);
    sum = level = vec3(0.0);
}

#if defined(ROOTS) && STENCIL == 3
void begin_nearer();
#endif

void begin_normal()
{
    // Differences over a pixel or so: finer detail would only be noise.
    t = find_reach(hit);
#if STENCIL == 3 && defined(ROOTS)
    looks_nearer = false;
#elif STENCIL == 3
    tap_set = WIDE;
#endif
    begin_taps();
#ifdef GRADIENT
    derived = false;
#ifndef CAMERA_RELATIVE
    // Differences are used where derivatives are not finite.
    vec3 gradient = krs_gradient(hit.position, t);
    // They are also used where rounding makes a visible surface face away from the eye.
    float facing_eye = hit.side * dot(gradient, find_backwards());
#ifdef SHEETS // both sides are visible
    gradient *= facing_eye < 0.0 ? -1.0 : 1.0;
    facing_eye = abs(facing_eye);
#endif
    derived = facing_eye > 0.0 && dot(gradient, gradient) < INFINITE;
    if (derived) {
        sum = hit.side * normalize(gradient);
        direction = sum;
        tap_limit = TAPS_OUTSIDE;
    }
#if defined(ROOTS) && STENCIL == 3
    else
        begin_nearer();
#endif
#endif
#endif
}

void begin_item(uint number)
{
    hit = find_hit_point(number);
    start = hit.position;
#ifdef FOLLOWS_PATHS
    uint index = index_of(pixel_of(hit.slot));
    enter_medium(are_of_paths() ? load_path(PATH_TOWARD, index).w : 0.0);
#endif
    begin_normal();
}

bool item_needs_step()
{
    return taps < tap_limit;
}

vec3 item_position()
{
    return start + t * direction;
}

// How even the surface is: 1 where it is flat.  There opposite taps cancel in `level`.  On an edge,
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
    t = max(NEARER * t, NOISE / 3.0 * largest(hit.position) + hit.rounding);
    looks_nearer = true;
    begin_taps();
    tap_limit = TAPS + CORNERS;
}

// Begins the nearer taps without the wide ones.  On such a curve the distance is an odd function,
// and six differences look even where they are wrong.
void begin_nearer()
{
    even = 1.0;
    begin_nearer_taps();
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

#if defined(GRADIENT) && defined(ROOTS) && STENCIL == 3
// The least slope of the distance just outside of the surface.  Where it is less, derivatives may
// be little more than rounding.  That happens near a curve on which a polynomial vanishes several
// times.
const float LEAST_OUTSIDE = 0.4;
void take_outside(float rise)
{
#ifndef SHEETS // differences see both sides of a sheet
    if (!(rise >= LEAST_OUTSIDE)) {
        derived = false;
        begin_nearer();
    }
#endif
}
#endif

void store_normal()
{
    float size = length(sum), flatness = find_flatness();
    vec3  normal = size > 0.0 && size < INFINITE ? sum / size : find_backwards();
    store_hit(FACING, hit.slot, vec4(normal, flatness));
}

void take_distance(float distance)
{
    distance *= hit.side;
    taps++;
#if defined(GRADIENT) && defined(ROOTS) && STENCIL == 3
    if (derived)
        take_outside(distance / t);
    else
        take_difference(distance);
#else
    take_difference(distance);
#endif
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

layout(local_size_x = 64) in;

void main()
{
    load_frame();
    krs_prepare();
    uint group = find_group(), lane = gl_LocalInvocationIndex & 7u;
    // A lane's items are those of pixels.glsl, in their order.
    uint number = (group * 64u + gl_LocalInvocationIndex - lane) * control.items_per_lane + lane;
    uint end = min(number + 8u * control.items_per_lane, control.items);
    bool goes_on = false; // with another set of taps for the same item
    taps = tap_limit = 0u;
    do { // do-while, as in pixels.glsl
        bool exists = number < end;
        if (exists && !goes_on)
            begin_item(number);
        do {
            float distance = krs_distance(item_position());
            if (item_needs_step())
                take_distance(distance);
        } while (item_needs_step());
        goes_on = exists && item_needs_more_taps();
        if (exists && !goes_on) {
            store_normal();
            number += 8u;
        }
    } while (number < end);
}
