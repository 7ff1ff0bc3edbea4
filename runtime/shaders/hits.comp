#version 440
#extension GL_GOOGLE_include_directive : enable
/*
 * hits.comp: lists the pixels whose ray hits something, and where, tile by tile: all of the band,
 * or those tiles whose beams have found something (trace.comp).
 */
#include "frame.glsl"
#include "solid.glsl"

// Where the ray hits, for all that comes after.  Where there is no width there must be a sign.
void keep_place(uint slot, uvec2 pixel, Ray ray)
{
    vec3  origin, direction;
    float base, slope;
    find_ray(vec2(work.corner + pixel) + work.offset, origin, direction, base, slope);
    vec3  position = origin + ray.t * direction;
    float width = base + slope * ray.t;
    float rounding = ROUNDING * (largest(position) + largest(origin));
    keep_hit(PLACE, slot, vec4(position, ray.side * max(width, 1e-30)));
    keep_hit(RAY, slot, vec4(direction, rounding));
}

void begin_group() {}

void do_item(uint number)
{
    uint slot = control.listed != 0u ? 64u * tiles[number / 64u] + number % 64u : number;
    uvec2 pixel = pixel_of(slot);
    bool  exists = pixel.x < work.extent.x && pixel.y < work.extent.y;
    Ray   ray = find_end(exists ? index_of(pixel) : 0u);
    if (!exists || ray.fate != HIT)
        return;
    keep_place(slot, pixel, ray);
    solid[atomicAdd(counts.solid, 1u)] = slot;
    if (is_anchor(slot))
        solid[band_pixels() + atomicAdd(counts.anchors, 1u)] = slot;
    if (control.parts != 0u)
        solid[(4u + ray.group) * band_pixels() + atomicAdd(counts.of_group[ray.group], 1u)] = slot;
}

#include "pixels.glsl"
