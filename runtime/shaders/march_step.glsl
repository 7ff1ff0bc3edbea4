/*
 * march_step.glsl: a step of a ray or beam by its next distance.  It finds out whether a surface
 * was crossed and where, and how long the step after it is.  The march is described in trace.comp.
 */
// Returns where the surface is crossed, measured from t: the root of the chord.  The clearance is
// positive at t, and not at t + step.  The result is at least the clearance at t, within which
// there is no surface.
float find_crossing(float clearance)
{
    float along = march.clearance > clearance
                      ? min(march.clearance / (march.clearance - clearance), 2.0)
                      : 0.0;
    return max(march.step * along, march.clearance);
}

#ifdef STEPS
const uint BALLS = AUTOMATIC;
#else
const uint BALLS = TRACE;
#endif

// Returns the next step from a position with an empty ball of this radius, by the last slope of the
// radius and the mean slope.  The balls at its ends should still meet.  Else the surface should be
// crossed, with no longer unverified interval than is permitted; with STEPS none is left there.
float find_step(float clearance, float last_slope, float slope, float permitted, float tolerance)
{
    bool  crosses = BALLS == TRACE && OVERSHOOT * clearance <= -last_slope * (clearance + permitted);
    float factor = crosses ? OVERSHOOT / -last_slope : 2.0 / (1.0 - min(slope, 0.98));
    float automatic = max(clearance, factor * clearance);
    return (BALLS == RELAXED     ? RELAXATION * clearance
            : BALLS == AUTOMATIC ? automatic
                                 : clearance) +
           tolerance;
}

#ifdef PROBE
#include "research/probe.glsl"
#else
// Snaps a hit to the surface: takes steps of the secant method, each at most half as long as the last, until what is
// left is small.  The step after that leaves about its square.  Behind the surface t stays before it, and the
// chord from there is taken.  So what is found is the side of a thin wall that the ray has met, not the other.
// A length to the next root is negative nowhere before it, and is followed while it shrinks.
const float SMALL = 256.0; // roundings
void snap(float at, float clearance, float rounded)
{
    float most = 0.5 * abs(march.step);
#if defined(STEPS) || defined(ALONG)
    float next = clearance > 0.0 && clearance < most ? clearance : 0.0;
    bool  behind = false;
#else
    float slope = (clearance - march.clearance) / march.step;
    bool  behind = clearance < 0.0 && march.clearance > 0.0 && march.step > 0.0;
    float next = behind        ? -clearance / slope
                 : slope < 0.0 ? clamp(-clearance / slope, -most, most)
                               : sign(clearance) * most;
#endif
    bool snapped = !(abs(next) > SMALL * rounded); // also where it is not a number
    march.state = snapped ? STATE_HIT : STATE_REFINING;
    if (behind && !snapped) {
        march.step += next;
        return;
    }
    march.t = snapped ? at + next : at;
    march.clearance = clearance;
    march.step = next;
}

#ifdef TOUCHES
// Takes the distance above the start.  If the ball around that place reaches down to the start, the ray is
// free up to the far end of its chord.  The march goes on from the ball that reaches as far on the ray and
// touches the plane that the ray leaves.  The slope is halfway between those off the plane and towards a wall.
void take_ball(float radius)
{
    float height = length(aside), middle = height * cosine;
    radius = clamp(radius, 0.0, end);
    float square = radius * radius - (height - middle) * (height + middle);
    float half_chord = sqrt(max(square, 0.0)), free = middle + half_chord;
    bool  touches = square > 0.0 && middle - half_chord <= SNAPPED_START * ROUNDING * rounding;
    aside = vec3(0.0);
    march.steps++;
    if (touches && free > march.step) {
        march.t = free / (1.0 + cosine);
        march.clearance = free - march.t;
        march.slope = 0.5 * (cosine - 1.0);
        march.step = 2.0 / (1.0 - march.slope) * march.clearance;
        march.state = free >= end ? STATE_MISS : STATE_MARCHING;
    }
}
#endif

void take_distance(float distance)
{
#ifdef TOUCHES
    if (aside != vec3(0.0)) {
        take_ball(march.side * distance);
        return;
    }
#endif
    bool  is_ray = control.phase == TRACE_RAYS, refining = march.state == STATE_REFINING;
    float at = march.t + march.step, pixel = width_at(at, pixel_base + pixel_slope * at);
    if (march.side == 0.0) {
        march.side = distance < 0.0 ? -1.0 : 1.0;
        width = distance < 0.0 ? inside_width() : width;
    }
    float taken = width.x + width.y * at;
    float clearance = (march.side * distance - taken) * shrinking;
    float rounded = ROUNDING * (rounding + at);
    float tolerance = (leaves_surfaces() ? UNVERIFIED * at : tolerance_in_pixels * pixel) + rounded;
    float least = is_ray ? 0.0 : max(rounded, (BEAM_MARGIN - 1.0) * taken);
    float unverified = march.step - march.clearance; // a surface may hide in such an interval
    float permitted = !is_ray ? 0.0 : leaves_surfaces() ? PERMITTED * at : frame.error * pixel;
    march.steps++;
    if (is_ray && refining && snaps()) {
        snap(at, clearance, rounded);
#ifdef PACKED
        advance_to_next_part();
#endif
        return;
    }
    float last_radius = march.clearance, radius = clearance;
#ifdef STEPS // from inside of one solid nothing is known of balls around others
    last_radius = march_radius;
    radius = march.side < 0.0 ? clearance : sampled.y;
    float ahead = march.side < 0.0 ? clearance : sampled.x;
#endif
    bool leaves = leaves_surfaces() && march.clearance == 0.0 && clearance <= 0.0 &&
                  at <= max(LEAVING * ROUNDING * rounding, LEAVING_IN_PIXELS * pixel_base);
    bool found_surface = clearance <= least && (unverified <= permitted + tolerance || !is_ray) &&
                             !leaves ||
                         refining;
    bool verified = !found_surface && clearance > least &&
                    march.step - last_radius <= radius + 1.01 * tolerance;
    bool accurate = unverified <= 2.0 * tolerance || refining || !is_ray ||
                    BALLS == AUTOMATIC && -clearance <= SHALLOW * march.clearance;
    accurate = accurate && !(is_ray && snaps());
    float crossing = find_crossing(clearance);
    float last_slope = march.step > 0.0 ? (radius - last_radius) / march.step : 0.0;
    float slope = (1.0 - LEARNING) * march.slope + LEARNING * last_slope;

    float shorter_step = max(0.4 * (march.step + march.clearance - max(clearance, 0.0)),
                             march.clearance + tolerance);
    float advance = found_surface && accurate ? is_ray ? crossing : march.clearance : 0.0;
    march.t = verified ? at : march.t + advance;
    float next = find_step(radius, last_slope, slope, permitted, tolerance);
#ifdef STEPS
    next = min(next, ahead + tolerance);
#endif
    march.step = verified        ? next
                 : found_surface ? crossing
                                 : shorter_step;
    march.clearance = verified ? clearance : march.clearance;
#ifdef STEPS
    march_radius = verified ? radius : march_radius;
#endif
    march.slope = verified ? slope : -1.0;
    march.state = found_surface                           ? (accurate ? STATE_HIT : STATE_REFINING)
                  : verified && at + clearance >= end ? STATE_MISS
                                                     : STATE_MARCHING;
    if (leaves) { // as if it began here
        march.t = at;
        march.step = max(at, rounded);
        march.clearance = 0.0;
        march.state = STATE_MARCHING;
    }
#ifdef PACKED
    advance_to_next_part();
#endif
}
#endif
