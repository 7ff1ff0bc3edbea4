#version 440
#extension GL_GOOGLE_include_directive : enable
/*
 * even_hits.comp: moves the hits of camera rays along their rays, so that their distances from the
 * surface no longer jump from pixel to pixel (Keinert et al. 2014, 3.4).
 *
 * The paper iterates t = t + f(t) - err(t), towards the level at which a ray may stop.  Rays here
 * hit where the distance is not above 0, so err is 0.  Of all points that were tried, the one with
 * the least distance is kept.  So a hit is never farther from the surface than it was.
 *
 * An item is a quarter of a tile of 8x8 pixels; `control.value` is the number of iterations.
 */
#include "scene.glsl"
#include "frame.glsl"
#include "hit_lists.glsl"

void begin_group() { krs_prepare(); }

// Finds where the iterations lead from a hit.
float find_even_hit(RayEnd ray, vec3 origin, vec3 direction)
{
    float t = ray.t, nearest = ray.t, least = INFINITE;
    uint  left = control.value + 1u;
    do { // do-while, as in pixels.glsl
        float off = ray.side * krs_distance(origin + t * direction);
        nearest = abs(off) < least ? t : nearest;
        least = min(abs(off), least);
        t += off;
        left--;
    } while (left > 0u);
    return nearest;
}

void do_item(uint quarter)
{
    uvec2 corner = pixel_of(slot_of_quarter(quarter));
    uint  bit = 0u;
    do {
        uvec2  pixel = corner + uvec2(bit & 3u, bit >> 2u);
        bool   exists = all(lessThan(pixel, work.extent));
        uint   index = index_of(exists ? pixel : uvec2(0u));
        RayEnd ray = find_end(index);
        vec3   origin, direction;
        float  base, slope;
        find_ray(vec2(work.corner + pixel) + work.offset, origin, direction, base, slope);
        if (exists && ray.state == STATE_HIT) {
            ray.t = find_even_hit(ray, origin, direction);
            ends[index] = uvec2(floatBitsToUint(ray.t), pack_ray(ray));
        }
        bit++;
    } while (bit < 16u);
}

#include "pixels.glsl"
