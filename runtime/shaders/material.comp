#version 440
#extension GL_GOOGLE_include_directive : enable
/*
 * material.comp: what is at each hit: colour, coat, identity.
 */
#include "scene.glsl"
#include "frame.glsl"
#include "pixels.glsl"
#include "solid.glsl"

void main()
{
    load_frame();
    uint number;
    if (!find_item(number))
        return;
    krs_prepare();

    Place      place = find_place(number);
    KrsSurface surface = krs_surface(place.position);
    hits[place.index].color = clamp(surface.color, 0.0, 1.0);
    hits[place.index].roughness = clamp(surface.roughness, 0.0, 1.0);
    hits[place.index].metallic = clamp(surface.metallic, 0.0, 1.0);
    hits[place.index].radiance = surface.emission;
    hits[place.index].component = surface.component;
    hits[place.index].level = surface.level;
    hits[place.index].instance = surface.instance;
}
