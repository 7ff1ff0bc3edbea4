/*
 * secondary_step.glsl: a step of a ray from a hit, by its next distance.
 */
vec3 item_position() { return start + t * direction; }

// Returns the clearance that the axis of a cone needs.  Near its start that is less, since the
// surface there recedes only by the cosine.
float clearance_needed(float at) { return spread * at + min(margin, 0.5 * facing * at); }

// Returns a step longer than the empty ball: the longest that is safe if its radius goes on as it
// did.
float relax(float around)
{
    float needed = clearance_needed(t);
    float lateral = sqrt(max(around * around - needed * needed, 0.0));
    return max(2.0 * SAFETY / (1.0 - clamp(slope, -1.0, STEEPEST)) * lateral, around);
}

// Tells whether the empty balls of this step and the last are too narrow where they meet (math.md 6).
// That is `behind` this position; `lateral` is how far they reach from the axis there, squared.
bool has_overstepped(float around, float per_gap)
{
    float behind = 0.5 * (last_step + (around - last_radius) * (around + last_radius) * per_gap);
    float lateral = max(around * around - behind * behind, 0.0);
    float needed = clearance_needed(t - behind);
    bool  narrow = behind > 0.0 && behind < last_step && lateral < needed * needed;
    return !took_least_step && last_step > last_radius &&
           (narrow || last_step > last_radius + around);
}

// Tells whether a ray is inside of a solid, or a cone is not empty.  Near the start the distance may be
// small in the open as well, where it is only a bound.
bool is_blocked(float distance)
{
    float near = mix(start_ratio, 1.0, min(t / (NEAR_START * hit.width), 1.0));
    return distance < (is_cone ? clearance_needed(t) : near * hit.rounding);
}

// Returns the least step of a ray for occlusion that is as far from all there is, and was so far
// before.
float hurry(float distance)
{
#ifdef PATH_RAYS
    return 0.0;
#else
    bool recedes = control.phase == RAYS_OVER_HEMISPHERE && last_step > 0.0 && distance > last_distance;
    return recedes ? (t > FAR_REACHES * frame.occlusion_reach ? 1.0 : MIN_OF_LENGTH) * t : 0.0;
#endif
}

void take_distance(float distance)
{
    distance *= hit.side;
    float around = distance;
#ifdef STEPS
    around = radius_here;
#endif
    step_count++;
    float first = clamp(distance / lift, 0.0625, 1.0);
    start_ratio = step_count == 1u ? first : start_ratio;
#ifdef PLANES // distances do not tell of the plane that it starts at
    slope = step_count == 1u && distance > 2.0 * lift ? -1.0 : slope;
#endif
#ifdef PATH_RAYS // rounding may put it behind the surface where it starts, as in trace.comp
    if (last_step == 0.0 && is_blocked(distance) && t <= LEAVING_IN_PIXELS * hit.width) {
        t += max(t, lift);
        return;
    }
#endif
    float per_gap = 1.0 / max(last_step, 1e-30);
    bool  recedes = slope > 0.0;
    bool  inside = is_blocked(distance);
    bool  steps_back = has_overstepped(around, per_gap) && !(inside && !is_cone);
    float risen = mix(slope, (around - last_radius) * per_gap, LEARNING);
    slope = steps_back ? -1.0 : last_step > 0.0 ? risen : slope;
    blocked = blocked || inside && !steps_back;
    bool  arrives = t + max(distance, min_step) >= end;
    step_limit = !steps_back && (inside || arrives) ? 0u : step_limit;
    took_least_step = !steps_back && distance < min_step;
    // The ray enters the solid between the last position and this one.  If it was receding from another one, whose
    // distance tells nothing of this one, it has done so as late as it can.
    float chord = last_step * distance / max(last_distance - distance, 1e-30);
    float crossing = recedes ? distance : chord;
    float relaxed = relax(around);
#ifdef STEPS // inside of a polynomial the length may reach to its other side
    crossing = max(crossing, last_distance - last_step);
    relaxed = min(relaxed, max_ahead);
#endif
    float next = took_least_step ? min_step : max(relaxed, min_step);
    float hurried = hurry(distance);
#ifdef STEPS
    hurried = min(hurried, max_ahead);
#endif
    took_least_step = took_least_step || !steps_back && hurried > next;
    next = max(next, hurried);
    next = min(next, max(end - t, 0.0));
    min_step *= growth;
    t += steps_back ? last_radius - last_step : inside && !is_cone ? min(crossing, 0.0) : next;
    last_step = steps_back ? last_radius : next;
    last_distance = steps_back ? last_distance : distance;
#ifdef STEPS
    last_radius = steps_back ? last_radius : around;
#endif
}
