#version 440
#extension GL_GOOGLE_include_directive : enable
/*
 * background.comp: what becomes of the rays: those that hit nothing see the sky and a light that
 * has a disc in it; the pixels of the others are listed.  More lights with a disc take it once
 * more each.
 *
 * An item is a row of a tile of 8x8 pixels.
 */
#include "frame.glsl"
#include "solid.glsl"
#include "light.glsl"
#include "results.glsl"

const uint FIRST = 0u; // control.phase; else it is about the light alone

Light sun;
float sky; // 1: with the sky
bool  keeps_counts;

void begin_group()
{
    sun = find_light(control.light);
    if (control.light >= control.lights)
        sun.softness = 0.0; // there is none
    sky = control.phase == FIRST ? 1.0 : 0.0;
    keeps_counts = control.phase == FIRST && control.first_ray != 0u && is_wanted(COUNTS);
}

// In the order of the pixels, whatever hits something in between.  Room is taken for a row at once:
// what lanes count together costs each of them as much as many distances.
void list(uint first, uint hits, uint anchors)
{
    uint at = 0u, anchor_at = 0u;
    if (hits != 0u)
        at = atomicAdd(counts.solid, bitCount(hits));
    if (anchors != 0u)
        anchor_at = band_pixels() + atomicAdd(counts.anchors, bitCount(anchors));
    do { // as in pixels.glsl
        uint bit = hits & ~hits + 1u, slot = first + bitCount(bit - 1u);
        if (hits != 0u)
            solid[at++] = slot;
        if ((anchors & bit) != 0u)
            solid[anchor_at++] = slot;
        hits &= ~bit;
    } while (hits != 0u);
}

// What is not often asked for: how many steps there were, and lists by groups of components.
void keep_more(uint index, uint first, uint exist, uint hits)
{
    bool parts = control.parts != 0u;
    uint column = parts || keeps_counts ? 0u : 7u;
    do {
        Ray ray = find_end(index + column);
        if (keeps_counts && (exist >> column & 1u) != 0u)
            results[COUNTS * band_pixels() + index + column] = uvec4(0u, ray.steps, 0u, 0u);
        if (parts && (hits >> column & 1u) != 0u)
            solid[(4u + ray.group) * band_pixels() + atomicAdd(counts.of_group[ray.group], 1u)] =
                first + column;
        column++;
    } while (column < 8u);
}

vec3 find_radiance(uvec2 pixel)
{
    vec3  origin, direction;
    float base, slope;
    find_ray(vec2(work.corner + pixel) + work.offset, origin, direction, base, slope);
    return sound(sky * sky_radiance(direction) +
                 sun_radiance(direction, sun.vector, sun.color, sun.softness));
}

void do_item(uint row)
{
    uint  first = 8u * row, hits = 0u, lost = 0u, column = 0u;
    uvec2 pixel = pixel_of(first);
    uint  index = index_of(pixel);
    uint  end = pixel.y < work.extent.y ? min(work.extent.x - pixel.x, 8u) : 0u;
    do {
        Ray  ray = find_end(index + column);
        hits |= uint(ray.fate == HIT) << column;
        lost |= uint(ray.lost) << column;
        vec3 radiance = find_radiance(pixel + uvec2(column, 0u));
        if (column < end && ray.fate != HIT)
            add_light(index + column, radiance);
        column++;
    } while (column < 8u);
    uint exist = control.phase == FIRST ? (1u << end) - 1u : 0u;
    lost &= exist;
    hits &= exist;
    if (lost != 0u)
        atomicAdd(counts.unresolved, bitCount(lost));
    list(first, hits, is_anchor(first) ? hits & 0xa5u : 0u);
    keep_more(index, first, exist, hits);
}

#include "pixels.glsl"
