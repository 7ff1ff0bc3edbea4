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
#include "limits.glsl"

// The depth of a hit, for each unit along its ray.
float find_rate_of_pixel(uvec2 pixel)
{
    vec3  origin, direction;
    float base, slope;
    find_ray(vec2(work.corner + pixel) + work.offset, origin, direction, base, slope);
    return find_depth_rate(direction);
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
        bool   behind = ray.t * find_rate_of_pixel(pixel) > find_limit(index);
        if (exists && ray.state == STATE_HIT && behind) {
            ray.state = STATE_MISS;
            ends[index] = uvec2(floatBitsToUint(ray.t), pack_ray(ray));
        }
        bit++;
    } while (bit < 16u);
}

#include "pixels.glsl"
