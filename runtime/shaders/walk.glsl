/*
 * walk.glsl: how far away a surface is where the distance is only a bound (LOOSE), for penumbras.
 *
 * After the taps of looks.glsl a walk goes down there by the secant method, from as far as the
 * bound permits.  All walks have as many steps, and nothing is decided but by minima and maxima.
 */
// Of the taps around, in bounds.  Where two bounds meet taps see both, which darkens by as much.
const float REACH = 0.0625;
const float LEAST_FALL = 0.125;  // of the bound on the walk, for what it is at the taps
const float EDGE = 0.8;          // where the sum has less of the gradient nothing is walked
const float FARTHEST = 2.0;      // a walk, for what the taps say: its way may miss the surface

vec3  down;           // where it falls; shorter than 1 where it falls more steeply elsewhere
float fall;           // how steeply it falls there, or on the walk's first step
float walked, walked_before, bound_before;

void begin_walk(vec3 place_there, float bound)
{
    begin_looks(place_there, bound, REACH);
    bound_before = bound;
    walked = walked_before = 0.0;
}

vec3 look_point()
{
    float size = length(down);
    vec3  way_down = size > 0.0 ? down / size : vec3(0.0);
    return looks > WALK ? tap_point() : look_place + walked * way_down;
}

// The two sides of an edge are expected at right angles, as where the edge is.
void end_taps()
{
    float found = find_sum(length(vec2(length(sum), length(level))));
    fall = find_fall(found);
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

void take_look(float distance)
{
    if (looks > WALK) {
        take_tap(distance);
        if (looks == WALK)
            end_taps();
        return;
    }
    looks--;
    take_step(distance);
}

// Of how far away the surface is, when no look is left.
float find_estimate()
{
    float known = look_bound / min(fall, 1.0);
    float direct = clamp((length(down) - EDGE) / (1.0 - EDGE), 0.0, 1.0);
    return mix(known, clamp(walked, known, FARTHEST * known), direct);
}
