/*
 * secondary.frag: rays of hits: one to each light that casts shadows, and one over the hemisphere.
 *
 * Found are a bit for each light whose ray nothing blocks, and how far it is to what blocks the last ray, or 0.
 */
#define HITS
#include "page.glsl"
#include "secondary_rays.glsl"

layout(location = 0) out uvec4 found;

bool item_needs_step() { return step_count < step_limit; }

#include "secondary_step.glsl"

void begin_item(uint number, vec4 facing)
{
    bool over_hemisphere = number == control.lights;
    control.phase = over_hemisphere ? RAYS_OVER_HEMISPHERE : RAYS_TO_LIGHT;
    vec2 square = sample_square(own_pixel(), control.ray, over_hemisphere ? 0u : 1u + number, control.seed);
    vec2 disc = disc_of_square(square);
    spread = margin = 0.0;
    is_cone = blocked = below_horizon = false;
    lift = find_lift(facing.w);
    if (over_hemisphere) {
        aim_over_hemisphere(facing.xyz, disc);
    } else {
        begin_light(number);
        radius = from_middles != 0u ? 0.0 : radius;
        aim_at_light(facing.xyz, square, disc);
        step_limit = casts_shadows(light) ? step_limit : 0u;
        blocked = blocked && casts_shadows(light);
    }
    begin_steps();
}

void main()
{
    load_frame();
    krs_prepare();
    found = uvec4(0u);
    if (!find_own_hit(hit))
        return;
    vec4 facing = texelFetch(facings, ivec2(gl_FragCoord.xy), 0);
    uint count = are_of_paths() ? control.lights : control.lights + 1u; // there the sky is open
    for (uint number = 0u; number < count; number++) {
        begin_item(number, facing);
        while (item_needs_step())
            take_distance(krs_distance(item_position()));
        uint bit = blocked || below_horizon ? 0u : 1u << (number & 31u);
        if (number == control.lights)
            found.w = blocked ? floatBitsToUint(max(t, 1e-30)) : 0u;
        else if (number < 32u)
            found.x |= bit;
        else if (number < 64u)
            found.y |= bit;
        else
            found.z |= bit;
    }
}
