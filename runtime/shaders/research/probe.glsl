/*
 * probe.glsl: the march by balls that are tried (KRS 2016; PROBE: BINARY or PREDICTED), in place of that by
 * distances in march_step.glsl.
 */
// SAFETY: the next radius, relative to the predicted one.
const uint  BINARY = 1u;
const float SAFETY = 0.9;

// The ball that was tried has the radius `step` and its centre at t + step, so it touches t.  A
// ball `larger` times as large would be empty, so it is empty if `larger` is above 1.  The ray hits
// where a ball no larger than the tolerance is not empty.
void take_distance(float larger)
{
    float radius = march.step, empty = float(larger > 1.0);
    float at = march.t + radius;
    float clearance = radius * larger; // at the centre, about
    march.side = 1.0;
    march.steps++;
    float least = 0.5 * tolerance_at(at);
    if (empty == 0.0 && radius <= 1.01 * least) {
        march.t = at;
        march.state = STATE_HIT;
        return;
    }
    if (PROBE == BINARY) {
        march.step = radius * (empty > 0.0 ? 2.0 : 0.5);
    } else {
        // The clearance at the centre of the next ball, clearance + slope * offset, should be its
        // radius, or a little more.
        float slope = march.clearance > 0.0 ? (clearance - march.clearance) / (at - march.slope)
                                            : -1.0;
        slope = clamp(slope, -1.0, 0.9);
        float excess = slope * (empty > 0.0 ? radius : -radius);
        march.step = SAFETY * (clearance + excess) / (1.0 - SAFETY * slope);
        march.step = empty > 0.0 ? clamp(march.step, 0.1 * radius, 8.0 * radius)
                                 : clamp(march.step, 0.1 * radius, 0.7 * radius);
        march.clearance = clearance;
        march.slope = at;
    }
    march.step = max(march.step, least);
    march.t += 2.0 * empty * radius;
    march.state = march.t > end ? STATE_MISS : STATE_MARCHING;
}
