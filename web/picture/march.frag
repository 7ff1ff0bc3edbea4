/*
 * march.frag: the rays of pixels, by the march of trace.comp, without beams.
 *
 * Steps are plain.  By predicted ones a ray would pass the foot of a wall and be found on the ground below, since a chord
 * that ends behind both says little of where it has met the first.
 */
#define TRACE 1u
#ifdef OPEN_SURFACES
#define ALONG
#endif
#include "page.glsl"
#include "march.glsl"

layout(location = 0) out vec4 found;

vec3 item_position() { return origin + (march.t + march.step) * direction; }

float item_distance(vec3 position)
{
#ifdef ALONG
    return krs_along(position, direction, distance_behind());
#elif defined(EARLY_OUTS)
    return krs_distance_lod(position, 0.0);
#else
    return krs_distance(position);
#endif
}

#include "march_step.glsl"

bool goes_on() { return march.state == STATE_MARCHING || march.state == STATE_REFINING; }

void main()
{
    load_frame();
    control.phase = TRACE_RAYS;
    krs_prepare();
    tolerance_in_pixels = min(TOLERANCE * frame.error, MAX_TOLERANCE);
    aim(own_point());
    width = vec2(0.0);
    shrinking = 1.0;
    vec2 range = clip_ray(origin, direction, frame.farthest);
    end = range.y;
    ends_at_walls = end < frame.farthest;
    begin_march(0u, range.x, true);
    if (are_of_paths()) { // it begins at a surface, whose side is known
        march.side = sign(load_path(PATH_WEIGHT, 0u).w);
        march.state = has_ray() ? march.state : STATE_MISS;
    }
    width = march.side < 0.0 ? inside_width() : width;
    while (goes_on() && march.steps < frame.max_steps)
        take_distance(item_distance(item_position()));
    // A ray from inside of a solid that reaches the box around all solids hits a wall there.
    bool unresolved = goes_on(), wall = !unresolved && march.state == STATE_MISS && march.side < 0.0 && ends_at_walls;
    uint state = wall ? STATE_HIT : unresolved ? STATE_MISS : march.state;
    found = vec4(wall ? end : march.t, march.side, float(state), float(march.steps));
}
