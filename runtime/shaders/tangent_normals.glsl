/*
 * tangent_normals.glsl: normals by gradients, where rays go from root to root.
 *
 * Near a curve on which a polynomial vanishes m times its gradient may be little more than rounding.
 * There the distance to the gradient's plane is an m-th of the distance.  So just outside of the
 * surface it rises too slowly.  Then the hit moves on to the surface by Newton's steps, and is
 * looked at again from nearer.  Where it is still too near to that curve, points beside it do the
 * same.  The surface may well be smooth there, so the first that is confirmed has the normal.
 *
 * The file that includes this has the hit and the taps.
 */
const float MIN_OUTSIDE = 0.4; // least slope of the distance, at the first tap outside
const float NEARER = 0.125;      // the reach of nearer taps, relative to the first one
const float NOISE_NEARER = 1e-4; // their least reach, relative to coordinates: less is rounding
const uint  POINTS = 7u;         // the hit, and those beside it
const uint  MOVES = 5u;          // steps of each, before taps at it and outside of it
const uint  POINT_TAPS = MOVES + 2u;
const float ARRIVED = 0.005;     // how far from the surface a point may end, in reaches
const float OUTSIDE = 0.25;      // how far outside of a point its last tap is, in reaches
const float MIN_NEARER = 0.5;  // least slope of the distance up to there
// The distance, in parts of reaches from the surface, within which the mean of all normals counts
// if no point is confirmed.
const float NEAR = 0.1, MIN_WEIGHT = 1e-3;

vec3  place;  // of the next tap
vec3  normal; // of a point, before the tap outside of it
float before; // and its distance

void begin_normal()
{
    t = find_reach(hit);
    place = hit.position;
    sum = vec3(0.0);
    taps = 0u;
    tap_limit = 1u;
}

// Returns the hit, and then the corners of an octahedron that lies across all axes: along an axis
// of a polynomial Newton's steps may lead to the curve on which it vanishes.
vec3 find_point(uint i)
{
    vec3 corner = i < 3u   ? vec3(0.36, 0.48, -0.8)
                  : i < 5u ? vec3(-0.8, 0.6, 0.0)
                           : vec3(0.48, 0.64, 0.6);
    return hit.position + (i == 0u ? 0.0 : (i & 1u) == 0u ? t : -t) * corner;
}

void begin_nearer()
{
    t = max(NEARER * t, NOISE_NEARER * largest(hit.position) + hit.rounding);
    place = find_point(0u);
    sum *= MIN_WEIGHT;
    taps = 2u;
    tap_limit = taps + POINTS * POINT_TAPS;
}

// Moves a point, or looks at what it has found.
void take_nearer(vec3 uphill, float distance, vec3 facing)
{
    uint phase = (taps - 3u) % POINT_TAPS;
    if (phase < MOVES) {
#ifndef OPEN_SURFACES // distances do not tell the side of an open surface
        place -= clamp(distance, -t, t) * uphill;
#endif
    } else if (phase == MOVES) {
        normal = facing;
        before = distance;
        place += OUTSIDE * t * normal;
        sum += max(1.0 - abs(distance) / (NEAR * t), MIN_WEIGHT) * normal;
    } else {
        bool  arrived = abs(before) <= ARRIVED * t && dot(normal, normal) > 0.0;
        float rise = hit.side * (distance - before);
        place = find_point((taps - 3u) / POINT_TAPS + 1u);
        if (arrived && rise >= MIN_NEARER * OUTSIDE * t) {
            sum = normal;
            tap_limit = taps;
        }
    }
}

void take_tangent(vec3 gradient, float distance)
{
    float square = dot(gradient, gradient);
    vec3  uphill = square > 0.0 && square < INFINITE ? inversesqrt(square) * gradient : vec3(0.0);
    float facing_eye = hit.side * dot(uphill, find_backwards());
    // Rounding may make a visible surface face away from the eye; 0: nothing is known of it.
    vec3 facing = (facing_eye > 0.0 ? hit.side : 0.0) * uphill;
#ifdef OPEN_SURFACES // both sides are visible
    facing = sign(facing_eye) * hit.side * uphill;
#endif
    bool known = dot(facing, facing) > 0.0;
    taps++;
    if (tap_limit > 2u) {
        take_nearer(uphill, distance, facing);
    } else if (taps == 1u) {
        sum = facing;
        place += t * facing;
#ifndef OPEN_SURFACES
        tap_limit = 2u;
#endif
        if (!known)
            begin_nearer();
    } else if (!(hit.side * distance >= MIN_OUTSIDE * t)) {
        begin_nearer();
    }
}

void take_tap()
{
    vec4 tangent = krs_tangent(place, t);
    if (item_needs_step())
        take_tangent(tangent.xyz, tangent.w);
}

// Returns that a surface is even: derivatives see no unevenness.
float find_flatness() { return 1.0; }

bool item_needs_more_taps() { return false; }
