#version 440
#extension GL_GOOGLE_include_directive : enable
/*
 * fill.comp: what saves work: shadow or occlusion of the pixels between anchors, where that cannot
 * be seen.
 *
 * A tile of 8x8 pixels whose sixteen anchors see one surface, which faces one way, is filled in
 * if they agree about occlusion; and if they are lit and nothing else is near their ways to the
 * light (shadows.comp), which goes for thin shadows, too.  A pixel that is not as they are,
 * and all pixels of other tiles, are listed, to be looked at one by one.
 */
#include "frame.glsl"
#include "solid.glsl"

const uint JUDGE = 0u, FILL = 1u;             // control.phase
const uint OCCLUSION = 0u;                    // control.value; else a shadow
const float MOST_APART = 0.03;                // of the anchors' occlusion
const float FACING_ALIKE = 0.9;               // least cosine between normals
const float ON_PLANE = 4.0;                   // farthest from it, in pixels

float value_at(uint index)
{
    vec4 lighting = find_hit(LIGHTING, index);
    return control.value < 2u ? (control.value == 0u ? lighting.x : lighting.y)
                              : (control.value == 2u ? lighting.z : lighting.w);
}

// Whether a pixel of a tile is as its first anchor: on one surface, which faces one way.
bool is_like(uint slot, vec3 first, vec3 normal)
{
    Place here = find_place_of(slot);
    float above = abs(dot(normal, here.position - first));
    return dot(find_hit(FACING, slot).xyz, normal) > FACING_ALIKE &&
           above < ON_PLANE * here.width;
}

void judge(uint tile)
{
    uint  first = 64u * tile;
    bool  agree = true;
    vec3  position = find_place_of(first).position, normal = find_hit(FACING, first).xyz;
    float least = INFINITE, most = -INFINITE;
    for (uint i = 0u; i < 16u && agree; i++) {
        uint  slot = first + (0x7520u >> 4u * (i & 3u) & 7u) + 8u * (0x7520u >> i / 4u * 4u & 7u);
        uvec2 pixel = pixel_of(slot);
        bool  exists = pixel.x < work.extent.x && pixel.y < work.extent.y;
        float value = value_at(slot);
        least = min(least, value);
        most = max(most, value);
        agree = exists && find_end(exists ? index_of(pixel) : 0u).fate == HIT &&
                is_like(slot, position, normal);
    }
    agree = agree && (control.value == OCCLUSION ? most - least <= MOST_APART : least == 1.0);
    solid[3u * band_pixels() + tile] = agree ? 1u : 0u;
}

// Between the anchors around it: columns and rows 0, 2, 5 and 7.
float interpolate(uint slot)
{
    uvec2 within = uvec2(slot, slot >> 3u) & 7u;
    uvec2 low = uvec2(0x75522200u) >> 4u * within & 7u;
    uvec2 high = uvec2(0x77555220u) >> 4u * within & 7u;
    vec2  part = vec2(within - low) / vec2(max(high - low, 1u));
    uint  first = slot & ~63u;
    return mix(mix(value_at(first + 8u * low.y + low.x), value_at(first + 8u * low.y + high.x),
                   part.x),
               mix(value_at(first + 8u * high.y + low.x), value_at(first + 8u * high.y + high.x),
                   part.x), part.y);
}

void fill(uint number)
{
    uint slot = find_listed(number), first = slot & ~63u;
    bool agree = find_listed(3u * band_pixels() + slot / 64u) != 0u;
    if (is_anchor(slot))
        return;
    if (!agree || !is_like(slot, find_place_of(first).position, find_hit(FACING, first).xyz))
        solid[2u * band_pixels() + atomicAdd(counts.rest, 1u)] = slot;
    else
        keep_lighting(control.value, slot, interpolate(slot));
}

void begin_group() {}

void do_item(uint number)
{
    if (control.phase == JUDGE)
        judge(number);
    else
        fill(number);
}

#include "pixels.glsl"
