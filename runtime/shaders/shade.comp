#version 440
#extension GL_GOOGLE_include_directive : enable
/*
 * shade.comp: the light that a hit sends along its ray: of one light, by a dispatch for each;
 * last of the sky, and then all of it becomes the pixel's.
 */
#include "frame.glsl"
#include "pixels.glsl"
#include "solid.glsl"
#include "light.glsl"
#include "results.glsl"

const uint ONE_LIGHT = 0u, FINISH = 1u; // control.phase

// Scattered light goes with the cosine, and so with the mean of the normals, which is shorter than
// each; what a coat mirrors is as much whatever its roughness.
vec3 mean_color(Hit hit) { return hit.coat.rgb * mix(hit.shading.w, 1.0, hit.radiance.a); }

vec3 lit(Place place, Hit hit)
{
    Light light = find_light(control.light);
    vec3  toward = light.vector, color = light.color;
    if ((light.kind & POSITIONAL) != 0u) {
        vec3  apart = light.vector - place.position;
        float square = max(dot(apart, apart), 1e-12);
        toward = apart * inversesqrt(square);
        color /= square;
    }
    // Who casts no shadows has not been looked for, but a surface that is turned away is dark.
    float visible = (light.kind & CASTS_SHADOWS) != 0u ? uintBitsToFloat(hit.identity.w)
                  : dot(hit.facing.xyz, toward) > 0.0  ? 1.0
                                                       : 0.0;
    return visible * color * reflected(hit.shading.xyz, -place.direction, toward, mean_color(hit),
                                       hit.coat.a, hit.radiance.a);
}

// The hemisphere of the sky, as far as it is open; what is closed off by a surface of like
// colour gives some light back.
vec3 ambient(Hit hit, vec3 toward_eye)
{
    vec3  normal = hit.shading.xyz, color = hit.coat.rgb;
    float open = control.open != 0u ? 1.0 : hit.facing.w, metallic = hit.radiance.a;
    vec3  bounce = open / max(1.0 - color * (1.0 - open), 0.05);
    vec3  scattered = color * (1.0 - metallic) * sky_light(hit.shading.w * normal) * bounce;
    vec3  mirrored = sky_reflected(normal, toward_eye, color, hit.coat.a, metallic);
    return scattered + mirrored * open;
}

void describe(Place place, Hit hit)
{
    vec3  apart = place.position - frame.eye.xyz;
    float along = dot(apart, frame.forward.xyz);
    float depth = control.projection == PANORAMA ? length(apart) : along;
    uvec3 normal = floatBitsToUint(place.side * hit.shading.xyz);
    set_result(PLACES, place.index, floatBitsToUint(vec4(place.position, depth)));
    set_result(NORMALS, place.index, uvec4(normal, hit.identity.x));
    set_result(ALBEDOS, place.index, uvec4(floatBitsToUint(hit.coat.rgb), hit.identity.y));
    set_result(COUNTS, place.index, uvec4(hit.identity.z, find_end(place.index).steps, 0u, 0u));
}

void main()
{
    load_frame();
    uint number;
    if (!find_item(number))
        return;
    Place place = find_place(number);
    Hit   hit = hits[place.index];
    if (control.phase == ONE_LIGHT) {
        hits[place.index].radiance = hit.radiance + vec4(lit(place, hit), 0.0);
    } else {
        vec3 radiance = hit.radiance.rgb + ambient(hit, -place.direction);
        add_color(place.index, vec4(sound(radiance), 1.0));
        describe(place, hit);
    }
}
