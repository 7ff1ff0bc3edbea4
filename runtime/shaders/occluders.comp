#version 440
#extension GL_GOOGLE_include_directive : enable
#extension GL_EXT_control_flow_attributes : enable
/*
 * occluders.comp: the albedo of what rays over the hemisphere have met (secondary.comp).
 */
#include "scene.glsl"
#include "frame.glsl"
#include "hit_lists.glsl"
#include "optics.glsl"
#include "hemisphere.glsl"
#include "occluders.glsl"

// Detail finer than this part of the ray's length is left out of the material.
const float FOOTPRINT = 0.05;

void begin_group() { krs_prepare(); }

void do_item(uint number)
{
    uint  slot = find_listed(control.reading + number);
    ivec2 pixel = ivec2(pixel_of(slot));
    float t = find_occluder(LIST_WIDE, pixel);
    vec2  square = sample_square(work.corner + pixel_of(slot), control.ray, 0u, control.seed);
    vec3  normal = load_hit(FACING, slot).xyz;
    vec3  direction = find_hemisphere_ray(normal, disc_of_square(square));
#ifdef KRS_VIEW
    krs_view = direction;
#endif
    HitPoint hit = hit_point_of_slot(slot);
    vec3 place = hit.position + LIFT_OF_OCCLUSION * hit.near * normal + t * direction;
    vec3 albedo = clamp(krs_surface(place, -direction, FOOTPRINT * t).color, 0.0, 1.0);
    store_occluder(LIST_WIDE, pixel, luminance(albedo));
}

#include "pixels.glsl"
