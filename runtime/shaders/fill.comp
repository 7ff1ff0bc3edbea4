#version 440
#extension GL_GOOGLE_include_directive : enable
/*
 * fill.comp: what saves work: shadow or occlusion of the pixels between anchors, where that cannot
 * be seen.
 *
 * A tile of 8x8 pixels whose sixteen anchors see one component and face the same way is filled in
 * if they agree about occlusion; and if they are lit and nothing else is near their ways to the
 * light (secondary.comp), which goes for thin shadows, too.  A pixel that is not as they are,
 * and all pixels of other tiles, are listed, to be looked at one by one.
 */
#include "frame.glsl"
#include "pixels.glsl"
#include "solid.glsl"

const uint JUDGE = 0u, FILL = 1u;             // control.phase
const uint OCCLUSION = 1u, SHADOW = 2u;       // control.value
const float MOST_APART = 0.03;                // of the anchors' occlusion
const float FACING = 0.9;                     // least cosine between normals

uint number_of(uint index)
{
    return OF_HIT * index + (control.value == SHADOW ? VISIBLE_OF_HIT : OCCLUSION_OF_HIT);
}

float value_at(uint index) { return hit_numbers[number_of(index)]; }

uint tile_of(uvec2 local) { return local.y / 8u * ((work.extent.x + 7u) / 8u) + local.x / 8u; }

void judge(uint tile)
{
    uvec2 corner = 8u * find_cell(tile, (work.extent.x + 7u) / 8u);
    bool  agree = corner.x + 8u <= work.extent.x && corner.y + 8u <= work.extent.y;
    uint  first = corner.y * work.extent.x + corner.x;
    uint  component = hits[first].identity.x;
    vec3  normal = hits[first].facing.xyz;
    float least = INFINITE, most = -INFINITE;
    for (uint i = 0u; i < 16u && agree; i++) {
        uvec2 at = corner + uvec2(0x7520u >> 4u * (i & 3u) & 7u, 0x7520u >> i / 4u * 4u & 7u);
        uint  index = at.y * work.extent.x + at.x;
        float value = value_at(index);
        least = min(least, value);
        most = max(most, value);
        agree = find_end(index).fate == HIT && hits[index].identity.x == component &&
                dot(hits[index].facing.xyz, normal) > FACING;
    }
    agree = agree && (control.value == SHADOW ? least == 1.0 : most - least <= MOST_APART);
    solid[3u * band_pixels() + tile] = agree ? 1u : 0u;
}

// Whether a pixel of a tile is as its first anchor: on one surface, which faces one way.
bool is_like(uint index, uint first)
{
    vec4  here = hits[index].place;
    vec3  normal = hits[first].facing.xyz;
    float above = abs(dot(normal, here.xyz - hits[first].place.xyz));
    return hits[index].identity.x == hits[first].identity.x &&
           dot(hits[index].facing.xyz, normal) > FACING && above < 4.0 * abs(here.w);
}

// Between the anchors around it: columns and rows 0, 2, 5 and 7.
float interpolate(uvec2 corner, uvec2 within)
{
    uvec2 low = uvec2(0x75522200u) >> 4u * within & 7u;
    uvec2 high = uvec2(0x77555220u) >> 4u * within & 7u;
    vec2  part = vec2(within - low) / vec2(max(high - low, 1u));
    uint  across = work.extent.x;
    uvec2 a = corner + low, b = corner + high;
    return mix(mix(value_at(a.y * across + a.x), value_at(a.y * across + b.x), part.x),
               mix(value_at(b.y * across + a.x), value_at(b.y * across + b.x), part.x), part.y);
}

void fill(uint number)
{
    uint  index = solid[number];
    uvec2 local = find_cell(index, work.extent.x), corner = local & ~7u;
    bool  agree = solid[3u * band_pixels() + tile_of(local)] != 0u;
    uint  first = corner.y * work.extent.x + corner.x;
    if (is_anchor(local))
        return;
    if (!agree || !is_like(index, first))
        solid[2u * band_pixels() + atomicAdd(counts.rest, 1u)] = index;
    else
        hit_numbers[number_of(index)] = interpolate(corner, local & 7u);
}

void main()
{
    load_frame();
    uint number;
    if (!find_item(number))
        return;
    if (control.phase == JUDGE)
        judge(number);
    else
        fill(number);
}
