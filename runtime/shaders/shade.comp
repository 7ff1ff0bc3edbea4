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

vec3 lit(Place place, Hit hit)
{
    Light light = lights[control.light];
    vec3  toward = light.vector, color = light.color;
    if ((light.kind & POSITIONAL) != 0u) {
        vec3  apart = light.vector - place.position;
        float square = max(dot(apart, apart), 1e-12);
        toward = apart * inversesqrt(square);
        color /= square;
    }
    return hit.visible * color * reflected(hit.normal, -place.direction, toward, hit.color,
                                           hit.roughness, hit.metallic);
}

// The hemisphere of the sky, as far as it is open; what is closed off by a surface of like
// colour gives some light back.
vec3 ambient(Hit hit, vec3 toward_eye)
{
    vec3 bounce = hit.occlusion / max(1.0 - hit.color * (1.0 - hit.occlusion), 0.05);
    vec3 scattered = hit.color * (1.0 - hit.metallic) * sky_light(hit.normal) * bounce;
    vec3 mirrored = sky_reflected(hit.normal, toward_eye, hit.color, hit.roughness, hit.metallic);
    return scattered + mirrored * hit.occlusion;
}

void describe(Place place, Hit hit)
{
    vec3  apart = place.position - frame.eye.xyz;
    float along = dot(apart, frame.forward.xyz);
    pixels[place.index].depth = control.projection == PANORAMA ? length(apart) : along;
    pixels[place.index].position = place.position;
    pixels[place.index].normal = place.side * hit.normal;
    pixels[place.index].albedo = hit.color;
    pixels[place.index].component = hit.component;
    pixels[place.index].level = hit.level;
    pixels[place.index].instance = hit.instance;
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
        hits[place.index].radiance = hit.radiance + lit(place, hit);
    } else {
        vec3 radiance = hit.radiance + ambient(hit, -place.direction);
        pixels[place.index].color += vec4(sound(radiance), 1.0);
        if (control.first_ray != 0u)
            describe(place, hit);
    }
}
