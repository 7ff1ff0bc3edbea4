/*
 * looks.glsl: how far away a surface is where the distance is only a bound (LOOSE).
 *
 * Steps go by the bound, since that is safe, but a penumbra or a corner that it told of would be
 * too dark.  So where it matters taps around a place say where the bound falls and how steeply:
 * enough for occlusion, which is broad.  For penumbras a walk goes down there by the secant method,
 * from as far as the bound permits.  The estimate must have no seams, or they would show as rings:
 * nothing here is decided but by minima and maxima, and all walks have as many steps.
 */
// Of the taps around, in bounds.  Where two bounds meet taps see both, which darkens by as much;
// near taps see one of them give way to the other at once, which shows as a contour in what is as
// broad as occlusion.
const float REACH = 0.0625, REACH_OF_OCCLUSION = 0.5;
const uint  WALK = 4u;
const float LEAST_FALL = 0.125;  // of the bound on the walk, for what it is at the taps
const float EDGE = 0.8;          // where the sum has less of the gradient nothing is walked
const float FARTHEST = 2.0;      // a walk, for what the taps say: its way may miss the surface

uint  looks;          // that are still to come: taps, then steps
vec3  look_place;
float look_bound;     // the distance there
vec3  down;           // where it falls; shorter than 1 where it falls more steeply elsewhere
float fall;           // how steeply it falls there, or on the walk's first step
float walked, walked_before, bound_before;
float estimate;       // of how far away the surface is

void begin_looks(vec3 place, float bound)
{
    looks = TAPS + WALK;
    look_place = place;
    look_bound = bound_before = bound;
    sum = level = vec3(0.0);
    extent = 0.0;
    walked = walked_before = 0.0;
}

float look_reach()
{
    float reach = control.phase == OCCLUSION ? REACH_OF_OCCLUSION : REACH;
    return max(reach * look_bound, 64.0 * place.rounding);
}

vec3 look_way()
{
    float size = length(down);
    return looks > WALK ? stencil(TAPS + WALK - looks) : size > 0.0 ? down / size : vec3(0.0);
}

vec3 look_point()
{
    return look_place + (looks > WALK ? look_reach() : walked) * look_way();
}

// On an edge of the bound, hollow or convex, the gradients of its two sides cancel in part: what
// the sum has lost is in the level, from none to all of it.  In between is what is to be expected:
// as steep as at the hit, or, for a way to a light, both at right angles, as where the edge is.
void end_taps()
{
    float scale = extent * look_reach() / 3.0;
    float likely = control.phase == OCCLUSION ? steepness * scale
                                              : length(vec2(length(sum), length(level)));
    float found = clamp(likely, length(sum), length(abs(sum) + abs(level)));
    fall = max(found / scale, LEAST_STEEPNESS);
    down = found > 0.0 ? -sum / found : vec3(0.0);
    walked = look_bound;
}

void take_step(float bound)
{
    float falls = (bound_before - bound) / max(walked - walked_before, 1e-30);
    float steep = clamp(falls, LEAST_FALL * fall, 1.0);
    if (looks == WALK - 1u)
        fall = max(fall, steep);
    walked_before = walked;
    bound_before = bound;
    walked = max(walked + bound / steep, look_bound);
}

// The estimate is there when no look is left.
void take_look(float distance)
{
    if (looks > WALK) {
        vec3  from = look_way();
        float more = distance - look_bound;
        sum += more * from;
        level += more * abs(from);
        extent += dot(from, from);
        looks--;
        if (looks == WALK) {
            end_taps();
            if (control.phase == OCCLUSION) {
                estimate = look_bound / min(fall, 1.0);
                looks = 0u;
            }
        }
        return;
    }
    looks--;
    take_step(distance);
    float known = look_bound / min(fall, 1.0);
    float direct = clamp((length(down) - EDGE) / (1.0 - EDGE), 0.0, 1.0);
    estimate = mix(known, clamp(walked, known, FARTHEST * known), direct);
}
