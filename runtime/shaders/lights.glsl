/*
 * lights.glsl: lights as sources of a size: paths choose a point on one, and rays may find one.
 *
 * A path chooses one of all lights, by the light that each would send if it were visible.
 */

#define LIGHT_SAMPLES
#include "light_types.glsl"

// Tells how often a path chooses this light, relative to others: never where it sends nothing.
float find_importance(Light light, vec3 place)
{
    return luminance(find_irradiance(light, place)) * find_weight(light, place - light.vector);
}

// Sums the importance of lights; that of the sky comes first.
float sum_importance(vec3 place)
{
    float sum = frame.sky_power;
    for (uint i = 0u; i < control.lights; i++)
        sum += find_importance(find_light(i), place);
    return sum;
}

#ifdef SKY_MAP
// Returns a direction of a sky that is a picture, by how bright it is there.  Fog hides it as it
// hides all of the sky.
LightPoint sample_sky(vec3 place, float chance, vec2 square_point)
{
    LightPoint point;
    uvec2 cell = choose_cell(square_point);
    vec2  on_sky = choose_in_cell(cell, square_point);
    vec3  radiance = radiance_on_sky(on_sky);
    point.toward = direction_on_sky(on_sky);
    point.density = chance * sky_map_density(radiance, on_sky);
    float left = let_through(place.y, point.toward.y, FARTHEST);
    point.light = left * radiance / max(point.density, 1e-30);
    point.end = INFINITE;
    return point;
}
#endif
