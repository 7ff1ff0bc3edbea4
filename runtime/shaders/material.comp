#version 450
#extension GL_GOOGLE_include_directive : enable
/*
 * material.comp: what is at each hit: colour, coat, identity.
 */
#include "scene.glsl"
#include "frame.glsl"

void main()
{
    uvec2 pixel;
    uint  index;
    if (!find_pixel(pixel, index))
        return;
    krs_prepare();

    KrsSurface surface = krs_surface(hits[index].position);
    bool solid = rays[index].fate == HIT;
    hits[index].color = clamp(surface.color, 0.0, 1.0);
    hits[index].roughness = clamp(surface.roughness, 0.0, 1.0);
    hits[index].metallic = clamp(surface.metallic, 0.0, 1.0);
    hits[index].radiance = solid ? surface.emission : vec3(0.0);
    hits[index].component = surface.component;
    hits[index].level = surface.level;
    hits[index].instance = surface.instance;
}
