#version 440
#extension GL_GOOGLE_include_directive : enable
/*
 * track.comp: where media scatter the light that rays of paths bring, before these end.
 *
 * A ray whose light a medium scatters gets a mark at its end (frame.glsl), and the place is stored for
 * collide.comp.
 */
#include "scene.glsl"
#include "frame.glsl"
#include "hit_lists.glsl"
#include "results.glsl"
#include "sines.glsl"
#include "light.glsl"
#include "path_samples.glsl"
#include "chances.glsl"
#include "media.glsl"
#ifndef VOLUMES
#define VOLUMES 1u
#endif
#include "volumes.glsl"

void begin_group() { krs_prepare(); }

void do_item(uint number)
{
    bool  of_paths = are_of_paths();
    uint  slot = of_paths ? load_tile_word(number) : number;
    if (!of_paths && !slot_has_ray(slot))
        return;
    uvec2  pixel = pixel_of(slot);
    uint   index = index_of(pixel);
    if (of_paths && load_path(PATH_WEIGHT, index).w < 0.0) // light that a plate catches
        return;
    RayEnd ray = find_end(index);
    vec3   origin, direction;
    float  base, slope, code = ray.side;
    find_ray(vec2(work.corner + pixel) + work.offset, origin, direction, base, slope);
    if (of_paths)
        code = load_path(PATH_TOWARD, index).w;
    enter_medium(code);
#ifdef MEDIA
    if (!of_paths)
        krs_medium = krs_medium_at(origin);
#endif
    begin_chances(work.corner + pixel, 0x60000u);
    float nearest = end_of_way(ray);
    uint  volume = VOLUMES;
    for (uint i = 0u; i < VOLUMES; i++) {
        float t = find_scattering(i, origin, direction, nearest);
        volume = t < nearest ? i : volume;
        nearest = t;
    }
    if (volume == VOLUMES)
        return;
    if (!of_paths) {
        store_path(PATH_ORIGIN, index, vec4(origin, base));
        store_path(PATH_DIRECTION, index, vec4(direction, slope));
        store_path(PATH_WEIGHT, index, vec4(vec3(1.0), 0.0));
#ifdef MEDIA
        code = code_of_ray(code, krs_medium);
#endif
        store_path(PATH_TOWARD, index, vec4(vec3(0.0), code));
    }
    store_path(PATH_LIGHT, index, vec4(origin + nearest * direction, float(volume)));
    ends[index].y |= IN_VOLUME;
    pixel_lists[LIST_IN_VOLUMES * band_pixels() + atomicAdd(counts.remaining, 1u)] = slot;
}

#include "pixels.glsl"
