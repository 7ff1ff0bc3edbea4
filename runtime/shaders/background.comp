#version 440
#extension GL_GOOGLE_include_directive : enable
/*
 * background.comp: ends the pixels whose ray hits nothing: the sky, and the lights that have a
 * disc in it; lists the others; and counts steps.
 */
#include "frame.glsl"
#include "pixels.glsl"
#include "solid.glsl"
#include "light.glsl"
#include "results.glsl"

// The pixel is zero before its first ray.
void count_steps(uint index, uint steps)
{
    if (control.first_ray != 0u) {
        pixels[index].steps = steps;
    } else {
        pixels[index].evaluations += steps;
        pixels[index].most = max(pixels[index].most, steps);
    }
}

void main()
{
    load_frame();
    uint index;
    if (!find_item(index))
        return;
    Ray ray = find_end(index);
    count_steps(index, ray.steps);
    if (ray.lost)
        atomicAdd(counts.unresolved, 1u);
    uvec2 pixel = work.corner + find_cell(index, work.extent.x);
    if (ray.fate == HIT) {
        solid[atomicAdd(counts.solid, 1u)] = index;
        if (is_anchor(pixel))
            solid[band_pixels() + atomicAdd(counts.anchors, 1u)] = index;
    }

    vec3  origin, direction;
    float base, slope;
    find_ray(vec2(pixel) + work.offset, origin, direction, base, slope);
    vec3 radiance = sky_radiance(direction);
    for (uint i = 0u; i < control.lights; i++) {
        Light light = lights[i];
        if ((light.kind & POSITIONAL) == 0u)
            radiance += sun_radiance(direction, light.vector, light.color, light.softness);
    }
    if (ray.fate != HIT)
        pixels[index].color.rgb += sound(radiance);
}
