#version 440
#extension GL_GOOGLE_include_directive : enable
/*
 * background.comp: ends the pixels whose ray hits nothing: the sky, and the lights that have a
 * disc in it; lists the others, and where they are hit.
 */
#include "frame.glsl"
#include "pixels.glsl"
#include "solid.glsl"
#include "light.glsl"
#include "results.glsl"

// Where the ray hits, for all that comes after.  Where there is no width there must be a sign.
void keep_place(uint index, Ray ray, vec3 origin, vec3 direction, float width)
{
    vec3  position = origin + ray.t * direction;
    float rounding = ROUNDING * (largest(position) + largest(origin));
    hits[index].place = vec4(position, ray.side * max(width, 1e-30));
    hits[index].ray = vec4(direction, rounding);
}

void main()
{
    load_frame();
    uint index;
    if (!find_item(index))
        return;
    Ray ray = find_end(index);
    set_result(COUNTS, index, uvec4(0u, ray.steps, 0u, 0u));
    if (ray.lost)
        atomicAdd(counts.unresolved, 1u);
    uvec2 pixel = work.corner + find_cell(index, work.extent.x);

    vec3  origin, direction;
    float base, slope;
    find_ray(vec2(pixel) + work.offset, origin, direction, base, slope);
    if (ray.fate == HIT) {
        keep_place(index, ray, origin, direction, base + slope * ray.t);
        solid[atomicAdd(counts.solid, 1u)] = index;
        if (is_anchor(pixel))
            solid[band_pixels() + atomicAdd(counts.anchors, 1u)] = index;
        if (control.parts != 0u)
            solid[(4u + ray.group) * band_pixels() + atomicAdd(counts.of_group[ray.group], 1u)] =
                index;
    }

    vec3 radiance = sky_radiance(direction);
    for (uint i = 0u; i < control.lights; i++) {
        Light light = find_light(i);
        if ((light.kind & POSITIONAL) == 0u)
            radiance += sun_radiance(direction, light.vector, light.color, light.softness);
    }
    if (ray.fate != HIT)
        add_color(index, vec4(sound(radiance), 0.0));
}
