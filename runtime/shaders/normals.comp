#version 440
#extension GL_GOOGLE_include_directive : enable
/*
 * normals.comp: the normal of each hit, from the distance at a few places around it.
 *
 * The places are known before, so a lane does pixel after pixel (pixels.glsl): lanes that loop
 * together are done together, but where something is looked at again (sides.glsl).
 *
 * ROOTS: rays go from root to root.
 */
#include "scene.glsl"
#include "frame.glsl"
#include "solid.glsl"
#include "stencil.glsl"

// Differences for normals reach as far as a pixel asks for, but less of the coordinates would be
// noise.
const float NOISE = 3e-4;
// What is so even is flat.
const float EVEN = 0.9995;

// The item.
Place place;
vec3  start, way;  // the next distance is asked for at start + t way
float t;
uint  taps, limit; // so far, and at most
vec3  sum, level;  // of the taps of a normal, with the signs of their directions and without
#if STENCIL == 3 && defined(ROOTS)
bool  again;       // they are looked at from nearer,
float even;        // where all was so even
#elif STENCIL == 3
void begin_taps();
vec3 find_backwards();
#include "sides.glsl"
#endif
#ifdef GRADIENT
bool  derived;     // the normal is by derivatives
#if defined(ROOTS) && STENCIL == 3
#define TAPS_OUTSIDE 1u // that say whether these can be believed
#else
#define TAPS_OUTSIDE 0u
#endif
#endif

// Where the ray comes from that hits here, unit.
vec3 find_backwards()
{
    return control.projection == ORTHOGRAPHIC ? -frame.forward.xyz
                                              : normalize(frame.eye - place.position);
}

// The taps of a stencil around the hit.
void begin_taps()
{
    taps = 0u;
    limit = TAPS;
    way = stencil(0u);
    sum = level = vec3(0.0);
}

#if defined(ROOTS) && STENCIL == 3
void begin_nearer();
#endif

void begin_normal()
{
    // Differences over a pixel or so: finer detail would only be noise.
    t = max(frame.blur * place.width, NOISE * largest(place.position) + place.rounding);
#if STENCIL == 3 && defined(ROOTS)
    again = false;
#elif STENCIL == 3
    look = WIDE;
#endif
    begin_taps();
#ifdef GRADIENT
    derived = false;
#ifndef ANCHORED
    // Differences are for where derivatives are no numbers.
    vec3 gradient = krs_gradient(place.position, t);
    // Differences are as well for where rounding makes what is seen face away.
    float facing_eye = place.side * dot(gradient, find_backwards());
#ifdef SHEETS // of which either side is seen
    gradient *= facing_eye < 0.0 ? -1.0 : 1.0;
    facing_eye = abs(facing_eye);
#endif
    derived = facing_eye > 0.0 && dot(gradient, gradient) < INFINITE;
    if (derived) {
        sum = place.side * normalize(gradient);
        way = sum;
        limit = TAPS_OUTSIDE;
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
    place = find_place(number);
    start = place.position;
    begin_normal();
}

bool item_wants_more()
{
    return taps < limit;
}

vec3 item_place()
{
    return start + t * way;
}

// The parts of the sum that do not cancel: where all is flat, opposite taps do; on an edge, or
// where things are smaller than the taps are apart, they do not.
float find_evenness()
{
    float size = length(sum), uneven = length(vec2(size, length(level)));
    return uneven > 0.0 && uneven < INFINITE ? size / uneven : 1.0;
}

#if defined(ROOTS) && STENCIL == 3
// Around a curve on which its gradient vanishes a polynomial's distance is far from linear.  So
// what is not even is looked at again from nearer, with the corners of a cube as well: of weight
// 9/8 they make the octahedron exact up to the fifth power.
const float NEARER = 0.125;
const uint CORNERS = 8u;
vec3 corner(uint i)
{
    return 0.57735026919 * (2.0 * vec3(i & 1u, i >> 1u & 1u, i >> 2u & 1u) - 1.0);
}

void look_nearer()
{
    t = max(NEARER * t, NOISE / 3.0 * largest(place.position) + place.rounding);
    again = true;
    begin_taps();
    limit = TAPS + CORNERS;
}

// At once: on such a curve all is odd, and six differences are even where they are wrong.
void begin_nearer()
{
    even = 1.0;
    look_nearer();
}

void take_difference(float distance)
{
    float weight = taps > TAPS ? 1.125 : 1.0;
    sum += weight * distance * way;
    level += weight * distance * abs(way);
    way = taps < TAPS ? stencil(taps) : corner(taps - TAPS);
    if (taps < TAPS || again)
        return;
    even = find_evenness();
    if (even < EVEN)
        look_nearer();
}

float find_flatness() { return again ? even : find_evenness(); }
#else
#if STENCIL != 3
void take_difference(float distance)
{
#if STENCIL == 1
    sum += distance * (taps == 1u ? vec3(-1.0) : way);
#else
    sum += distance * way;
    level += distance * abs(way);
#endif
    way = stencil(taps);
}
#endif

float find_flatness()
{
#if STENCIL == 3
    if (look == ONE_SIDE)
        return 1.0;
#endif
    return find_evenness();
}
#endif

#if defined(GRADIENT) && defined(ROOTS) && STENCIL == 3
// Where the distance rises by less than that from the surface, derivatives may be next to nothing
// but rounding, as near a curve on which a polynomial vanishes several times.
const float LEAST_OUTSIDE = 0.4;
void take_outside(float rise)
{
#ifndef SHEETS // of which differences see both sides
    if (rise >= LEAST_OUTSIDE)
        return;
    derived = false;
    begin_nearer();
#endif
}
#endif

void keep_normal()
{
    float size = length(sum), flatness = find_flatness();
    vec3  normal = size > 0.0 && size < INFINITE ? sum / size : find_backwards();
    keep_hit(FACING, place.slot, vec4(normal, flatness));
}

void take_distance(float distance)
{
    distance *= place.side;
    taps++;
#if defined(GRADIENT) && defined(ROOTS) && STENCIL == 3
    if (derived) {
        take_outside(distance / t);
        return;
    }
#endif
    take_difference(distance);
}

// What is looked at again is so in a loop of its own: what it needs to know would have to be
// carried through each step of the other.
bool item_begins_anew()
{
#if STENCIL == 3 && !defined(ROOTS)
#ifdef GRADIENT
    if (derived)
        return false;
#endif
    return looks_again();
#else
    return false;
#endif
}

void begin_group() { krs_prepare(); }

void do_item(uint number)
{
    begin_item(number);
    do { // lavapipe goes through the body of another loop once more
        do {
            float distance = krs_distance(item_place());
            if (item_wants_more())
                take_distance(distance);
        } while (item_wants_more());
    } while (item_begins_anew());
    keep_normal();
}

#include "pixels.glsl"
