#version 440
#extension GL_GOOGLE_include_directive : enable
/*
 * beam.comp: chooses a lamp for each ray of a camera that goes through media, and a place on the ray where they
 * scatter its light (beams.glsl).  What this adds if the lamp is visible is found as for paths (secondary.comp).
 */
#include "scene.glsl"
#include "frame.glsl"
#include "hit_lists.glsl"
#include "results.glsl"
#include "sines.glsl"
#include "arcs.glsl"
#include "light.glsl"
#include "path_samples.glsl"
#include "lights.glsl"
#include "chances.glsl"
#include "media.glsl"
#ifndef VOLUMES
#define VOLUMES 1u
#endif
#include "volumes.glsl"
#include "phase.glsl"
#include "beams.glsl"

void begin_group() { krs_prepare(); }

// Chooses a lamp by a number of the unit interval, which becomes one within the lamp's part of it.
uint choose_lamp(Beam beam, float sum, inout float place)
{
    float left = place * sum;
    uint  number = 0u;
    for (uint i = 0u; i < control.lights; i++) {
        float own = find_beam_importance(beam, find_light(i));
        bool  chosen = left >= 0.0 && own > 0.0;
        number = chosen ? i : number;
        place = chosen ? min(left / own, BELOW_1) : place;
        left -= own;
    }
    return number;
}

// Returns the part of light from a direction that media scatter at a place to where a ray comes from, on a unit
// of length; less what counts where paths meet the light, which choose the direction with `density` else.
vec3 find_scattered(vec3 place, float cosine, float density)
{
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < VOLUMES; i++) {
        float own = find_volume(i).exists ? krs_volume_density(i, place) : 0.0;
        float phase = find_phase(krs_volume_anisotropy(i, place), cosine);
        float share = density > 0.0 ? 1.0 / (1.0 + square(phase / density)) : 1.0;
        sum += own * phase * share * krs_volume_albedo(i, place);
    }
    return sum;
}

void do_item(uint slot)
{
    if (!slot_has_ray(slot))
        return;
    uvec2  pixel = pixel_of(slot), own = work.corner + pixel;
    uint   index = index_of(pixel);
    RayEnd ray = find_end(index);
    vec3   origin, direction;
    float  base, slope, side = ray.side;
    find_ray(vec2(own) + work.offset, origin, direction, base, slope);
#ifdef MEDIA
    krs_medium = krs_medium_at(origin);
    side = code_of_ray(side, krs_medium);
#endif
    Beam  beam = find_beam(origin, direction, end_of_way(ray));
    float sum = sum_beam_importance(beam);
    if (!(sum > 0.0))
        return;
    begin_chances(own, 0x90000u);
    vec2  square_point = sample_choice(own, control.ray, 0x91000u, control.seed);
    uint  number = choose_lamp(beam, sum, square_point.x);
    Light light = find_light(number);
    SeenBeam seen = see_beam(beam, light);
    float angle = mix(seen.first, seen.last, square_point.x);
    float t = clamp(seen.nearest + seen.gap * krs_tan(angle), seen.from, seen.to);
    vec3  place = origin + t * direction, way = light.vector - place;
    LightPoint point = sample_light(light, place, 1.0,
                                    sample_choice(own, control.ray, 0x92000u, control.seed));
    float ratio = find_beam_ratio(light, place, sum);
    float share = ratio * ratio / (1.0 + ratio * ratio);
    float chance = find_importance(light, place) / max(sum_importance(place), 1e-30);
    float density = luminance(light.color) / max(sum * dot(way, way), 1e-30);
    vec3  added = find_scattered(place, dot(direction, point.toward), chance * point.density);
    added *= point.light * share / max(density, 1e-30);
    added *= let_through(origin.y, direction.y, t);
    if (!(largest(added) > 0.0))
        return;
    added *= find_left_by_volumes(origin, direction, t) *
             find_left_by_volumes(place, point.toward, point.end);
    added = finite_or_black(added);
    uint  row = control.separate != 0u ? ROW_OF_LIGHTS + number : ROW_COLORS;
    float code = side + sign(side) * float(row * CODES_OF_RAYS);
    store_path(PATH_LIGHT, index, vec4(clamped(added), point.end));
    store_path(PATH_TOWARD, index, vec4(point.toward, side));
    store_path(PATH_ORIGIN, index, vec4(place, base + slope * t));
    store_path(PATH_SURFACE, index, vec4(place, code));
    store_hit(FACING, slot, vec4(point.toward, 1.0));
    if (largest(added) > 0.0)
        pixel_lists[LIST_TO_LIGHTS * band_pixels() + atomicAdd(counts.sparse, 1u)] = slot;
}

#include "pixels.glsl"
