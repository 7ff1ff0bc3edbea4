#version 440
#extension GL_GOOGLE_include_directive : enable
/*
 * limit.comp: rays that hit something behind the depth that the caller has given for their pixel
 * hit nothing.  Where a plate catches shadows, they and rays that miss hit the plate, if the depth is
 * finite.
 *
 * An item is a quarter of a tile of 8x8 pixels.
 */
#include "frame.glsl"
#include "hit_lists.glsl"
#include "limits.glsl"
#include "plate.glsl"

// Finds where a ray meets the plane of the plate in its pixel.  At an edge of the plate that may be
// far from the pixel's own depth, which holds then.
const float MAX_TILTED = 1.25;
float find_plate(uint index, vec3 origin, vec3 direction, float at_depth)
{
    vec4  plane = find_plate_plane(index);
    float along = dot(plane.xyz, direction);
    float t = (plane.w - dot(plane.xyz, origin)) / (abs(along) > 1e-6 ? along : 1e-6);
    bool  near = t * MAX_TILTED > at_depth && t < at_depth * MAX_TILTED;
    return near ? t : at_depth;
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
        vec3   origin, direction;
        float  base, slope, limit = find_limit(index);
        find_ray(vec2(work.corner + pixel) + work.offset, origin, direction, base, slope);
        float  rate = find_depth_rate(direction);
        bool   hits = ray.state == STATE_HIT, behind = ray.t * rate > limit;
        bool   catches = control.caught != 0u && limit > 0.0 && limit < INFINITE;
        if (exists && (hits ? behind : catches)) {
            ray.state = catches ? STATE_HIT : STATE_MISS;
            ray.march_group = catches ? MARCH_GROUP_OF_PLATE : ray.march_group;
            if (catches)
                ray.t = find_plate(index, origin, direction, limit / max(rate, 1e-6));
            ends[index] = uvec2(floatBitsToUint(ray.t), pack_ray(ray));
        }
        bit++;
    } while (bit < 16u);
}

#include "pixels.glsl"
