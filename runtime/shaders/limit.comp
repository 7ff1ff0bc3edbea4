#version 440
#extension GL_GOOGLE_include_directive : enable
/*
 * limit.comp: rays that hit something behind the depth that the caller has given for their pixel
 * hit nothing.
 *
 * An item is a quarter of a tile of 8x8 pixels.
 */
#include "frame.glsl"
#include "hit_lists.glsl"

// Depths are of the whole pixel, and lie behind the lights and listed rays, four in a texel.
float find_limit(uint index)
{
    uvec4 four = load_input(control.limits + index / 4u);
    uint  low = (index & 1u) == 0u ? four.x : four.y, high = (index & 1u) == 0u ? four.z : four.w;
    return uintBitsToFloat((index & 2u) == 0u ? low : high);
}

// The depth of a hit, for each unit along its ray: as in store_results of shade.comp.
float find_depth_rate(uvec2 pixel)
{
    vec3  origin, direction;
    float base, slope;
    find_ray(vec2(work.corner + pixel) + work.offset, origin, direction, base, slope);
    bool along = control.projection == PERSPECTIVE || control.projection == ORTHOGRAPHIC;
    return along ? dot(direction, frame.forward.xyz) : 1.0;
}

void begin_group() {}

void do_item(uint quarter)
{
    uvec2 corner = pixel_of(slot_of_quarter(quarter));
    uint  bit = 0u;
    do { // do-while, as in pixels.glsl
        uvec2  pixel = corner + uvec2(bit & 3u, bit >> 2u);
        bool   exists = all(lessThan(pixel, work.extent));
        uint   index = index_of(exists ? pixel : uvec2(0u));
        RayEnd ray = find_end(index);
        bool   behind = ray.t * find_depth_rate(pixel) > find_limit(index);
        if (exists && ray.state == STATE_HIT && behind) {
            ray.state = STATE_MISS;
            ends[index] = uvec2(floatBitsToUint(ray.t), pack_ray(ray));
        }
        bit++;
    } while (bit < 16u);
}

#include "pixels.glsl"
