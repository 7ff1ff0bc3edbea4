#version 440
#extension GL_GOOGLE_include_directive : enable
/*
 * material.comp: what is at each hit: colour, coat, identity.
 */
#include "scene.glsl"
#include "frame.glsl"
#include "pixels.glsl"
#include "solid.glsl"

const float EVEN = 0.98;      // less is not a curved surface's own, but detail
const float LEAST_BLUR = 0.5; // without filtering (normal_reach in render.c)
const float SEEN = 0.78;      // the mean of the normals that are seen of a thin round thing

// A sum of rays of such light is still a number.
const float BRIGHTEST = 1e30;

// Within 0 and most; what is not a number is 0.
vec4 between(vec4 numbers, float most)
{
    return mix(vec4(0.0), min(numbers, most), greaterThan(numbers, vec4(0.0)));
}

// The mean of the normals that the pixel sees, not a unit vector, where the mean of all around is
// this share of a unit normal.  Of what is thin only the side towards the eye is seen.
vec3 mean_normal(vec3 normal, float share, vec3 toward_eye)
{
    float rest = 1.0 - share;
    return share * normal + SEEN * rest * rest * toward_eye;
}

// Normals that vary within the pixel make the coat rougher: the shorter their mean, the wider
// their lobe (Toksvig 2005).
float roughen(float roughness, float share)
{
    float square = roughness * roughness;
    float spread = 2.0 * (1.0 - share) / max(share, 1e-3);
    return sqrt(sqrt(min(square * square + spread, 1.0)));
}

void main()
{
    load_frame();
    uint number;
    if (!find_item(number))
        return;
    krs_prepare();

    Place      place = find_place(number);
    vec4       facing = hits[place.index].facing;
    KrsSurface surface = krs_surface(place.position, place.side * facing.xyz, 0.5 * place.width);
    vec4       coat = between(vec4(surface.color, surface.roughness), 1.0);
    float      share = frame.blur > LEAST_BLUR ? min(facing.w / EVEN, 1.0) : 1.0;
    vec3       mean = mean_normal(place.side * surface.normal, share, -place.direction);
    float      size = length(mean);
    coat.a = roughen(coat.a, share);
    hits[place.index].shading = vec4(mean / max(size, 1e-6), min(size, 1.0));
    hits[place.index].coat = coat;
    hits[place.index].radiance = vec4(between(vec4(surface.emission, 0.0), BRIGHTEST).rgb,
                                      between(vec4(surface.metallic), 1.0).x);
    uint last = hits[place.index].identity.w; // stays
    hits[place.index].identity =
        uvec4(surface.component, surface.level, surface.instance, last);
}
