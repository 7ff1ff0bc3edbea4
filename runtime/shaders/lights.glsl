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

#ifdef CHOOSES_LIGHTS
// Chooses a point of a light, or of the sky; `all`: the importance of all lights together.
LightPoint choose_light_point(vec3 place, vec2 square_point, out uint number, out bool is_sky,
                              out float all)
{
    all = sum_importance(place);
    float left = square_point.x * all - frame.sky_power;
    is_sky = left < 0.0;
    float part = 1.0 + left / max(frame.sky_power, 1e-30); // of what the chosen one has of the square
    number = 0u;
    float importance = 0.0;
    for (uint i = 0u; i < control.lights; i++) {
        float own = find_importance(find_light(i), place);
        bool  chosen = left >= 0.0 && own > 0.0;
        number = chosen ? i : number;
        importance = chosen ? own : importance;
        part = chosen ? left / own : part;
        left -= own;
    }
    square_point.x = min(part, BELOW_1);
    LightPoint point = sample_light(find_light(number), place, importance / max(all, 1e-30),
                                    square_point);
#ifdef SKY_MAP
    if (is_sky)
        point = sample_sky(place, frame.sky_power / all, square_point);
#endif
    return point;
}
#endif
