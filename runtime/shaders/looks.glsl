/*
 * looks.glsl: how steep the distance is around a place where it is only a bound (LOOSE), which says
 * how far away a surface is.
 *
 * Steps go by the bound, since that is safe, but a penumbra or a corner that it told of would be
 * too dark.  So where it matters taps around a place say where the bound falls and how steeply:
 * enough for occlusion, which is broad; for penumbras a walk follows (walk.glsl).  The estimate
 * must have no seams, or they would show as rings: nothing here is decided but by minima and
 * maxima.
 *
 * Who includes this has vec3 sum and level, float extent, and LEAST_STEEPNESS.
 */
#ifndef WALK
#define WALK 0u // looks after the taps
#endif

uint  looks;        // that are still to come
vec3  look_place;
float look_bound;   // the distance there
float look_reach;   // of the taps

void begin_looks(vec3 place_there, float bound, float reach)
{
    looks = TAPS + WALK;
    look_place = place_there;
    look_bound = bound;
    look_reach = max(reach * bound, 64.0 * place.rounding);
    sum = level = vec3(0.0);
    extent = 0.0;
}

vec3 find_tap() { return stencil(TAPS + WALK - looks); }

vec3 tap_point() { return look_place + look_reach * find_tap(); }

void take_tap(float distance)
{
    vec3  from = find_tap();
    float more = distance - look_bound;
    sum += more * from;
    level += more * abs(from);
    extent += dot(from, from);
    looks--;
}

// Of a sum, for a slope of 1.
float find_scale() { return extent * look_reach / 3.0; }

// On an edge of the bound, hollow or convex, the gradients of its two sides cancel in part: what
// the sum has lost is in the level, from none to all of it.  In between is what is to be expected.
float find_sum(float likely) { return clamp(likely, length(sum), length(abs(sum) + abs(level))); }

// How steeply the bound falls, whose sum is this.
float find_fall(float found) { return max(found / find_scale(), LEAST_STEEPNESS); }
