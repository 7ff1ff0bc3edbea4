#version 440
#extension GL_GOOGLE_include_directive : enable
/*
 * escape.comp: what the rays of paths find before they hit a surface: lights, and the sky behind
 * everything.  Paths that hit nothing end.  The pixels of all others are listed.
 *
 * PATH_RAYS: the rays of paths that have begun.  Else these are rays of a camera, and paths begin.
 *
 * CATCHES: paths may meet the plate of another renderer, and end there with the light that it shows.
 *
 * An item is a pixel whose path goes on, or a quarter of a tile of 8x8 pixels.
 */
#include "frame.glsl"
#include "hit_lists.glsl"
#include "results.glsl"
#include "sines.glsl"
#include "light.glsl"

#include "optics.glsl"
#define SKY_MAP
#include "sky_map.glsl"
#include "lights.glsl"
#include "media.glsl"
#ifdef CATCHES
#include "path_samples.glsl"
#include "plate_rays.glsl"
#endif

// The state of a path when its ray ends.
struct Path {
    vec3  origin, direction, weight;
    float density;
    bool  caught; // it began at the plate; its density is stored as a negative number
    bool  mirrored; // by the plate
    bool  knows_lights; // what lights send here is known already
    bool  focused;      // photons tell what comes from lights
};

// Returns the part of a light that counts where rays find it as well as points of it are chosen, so
// that both together count once (Veach 1997, the power heuristic).
float share_of_rays(float by_rays, float by_lights)
{
    return by_rays > 0.0 ? 1.0 / (1.0 + square(by_lights / by_rays)) : 1.0;
}

// Returns the light of all sources that a path's ray meets before it ends.  Where the light of each
// is separate, it is added to their own rows, as far as it is `shown`.
vec3 find_sources(Path path, float end, uint index, vec3 shown)
{
    vec3  sum = vec3(0.0);
    bool  from_camera = path.density == 0.0;
    float all = from_camera ? 1.0 : sum_importance(path.origin);
    for (uint i = 0u; i < control.lights; i++) {
        Light light = find_light(i);
        float density;
        vec3  radiance = find_radiance_of(light, path.origin, path.direction, end, density);
        float chance = find_importance(light, path.origin) / max(all, 1e-30);
        float share = share_of_rays(path.density, chance * density);
        bool  shows = path.focused ? !casts_shadows(light) : !from_camera || (light.kind & LIGHT_POSITIONAL) == 0u;
        vec3  own = shows && density > 0.0 ? share * radiance : vec3(0.0);
        uint separate = path.caught ? 0u : control.separate;
        sum += separate != 0u ? vec3(0.0) : own;
        for (uint once = 0u; once < separate; once++) // as in aovs.glsl
            add_light_to(ROW_OF_LIGHTS + i, index, finite_or_black(shown * own));
    }
    return sum;
}

// Returns the light of the sky that a path's ray meets, which directions may have been chosen by,
// too.
vec3 find_sky(Path path)
{
    if (!has_sky_map())
        return sky_radiance(path.direction);
    vec2  place = place_on_sky(path.direction);
    vec3  radiance = radiance_on_sky(place);
    float all = max(sum_importance(path.origin), 1e-30);
    float by_lights = sky_map_density(radiance, place) * frame.sky_power / all;
    bool  chosen = control.phase == ESCAPE_TO_LIGHTS && path.density > 0.0;
    return radiance * (chosen ? share_of_rays(path.density, by_lights) : 1.0);
}

void begin_group() {}

Path load(uvec2 pixel, uint index, out float base, out float slope)
{
    Path path;
    find_ray(vec2(work.corner + pixel) + work.offset, path.origin, path.direction, base, slope);
#ifdef PATH_RAYS
    vec4 weight = load_path(PATH_WEIGHT, index);
    path.weight = weight.xyz;
    path.density = abs(weight.w);
    path.caught = weight.w < 0.0;
    path.mirrored = false;
#ifdef CATCHES
    path.mirrored = path.caught && is_mirrored(pixel);
#endif
    path.knows_lights = fract(abs(load_path(PATH_TOWARD, index).w)) == SCATTERED;
    path.focused = fract(abs(load_path(PATH_TOWARD, index).w)) == FOCUSED;
#else
    path.weight = vec3(1.0);
    path.density = 0.0;
    path.caught = false;
    path.mirrored = false;
    path.knows_lights = false;
    path.focused = false;
#endif
    return path;
}

// Returns the light of sources and of the sky that a ray brings, which ends at a surface or hits
// nothing.
vec3 find_light_before(Path path, bool hits, bool lost, float end, uint index)
{
    vec3  found = vec3(0.0);
    float left = let_through(path.origin.y, path.direction.y, FARTHEST);
    // Fog does not dim lights, but it hides the sun's disc as it hides the sky.
    float shown = hits ? 1.0 : lost ? 0.0 : path.density == 0.0 ? left : 1.0;
#ifndef PATH_RAYS
    shown = !hits && control.no_background != 0u ? 0.0 : shown;
#endif
    if (control.phase == ESCAPE_TO_LIGHTS && !path.knows_lights)
        found = find_sources(path, hits ? end : INFINITE, index, path.weight * shown);
    if (!hits) {
        vec3  behind = path.knows_lights && has_sky_map() ? vec3(0.0) : find_sky(path);
        vec3  light = found;
        if (path.density == 0.0) {
            behind += found;
            light = vec3(0.0);
        }
        found = lost ? vec3(0.0) : through_fog(behind, left, true) + light;
#ifndef PATH_RAYS
        found = control.no_background != 0u ? vec3(0.0) : found;
#endif
    }
    return finite_or_black(path.weight * found);
}

#ifdef CATCHES
// Tells how far along its ray a path meets the plate; INFINITE: nowhere.  The first ray of what the plate scatters
// as a dull surface does not: that light is the same with the scene and without it.
float find_plate_of_path(Path path)
{
    bool begins = path.caught && control.value == 1u;
    bool meets = control.plate_map != 0u && (!begins || path.mirrored);
    return meets ? find_plate_ahead(path.origin, path.direction, INFINITE, begins) : INFINITE;
}

// Returns light of sources, and of the plate at `plate`, where a path ends there before it hits
// anything else.
vec3 find_light_with_plate(Path path, bool hits, bool lost, float end, float plate, uint index)
{
    bool at_plate = plate < (hits || lost ? end : INFINITE);
    vec3 found = find_light_before(path, hits || at_plate, lost && !at_plate, at_plate ? plate : end,
                                   index);
    float left = let_through(path.origin.y, path.direction.y, plate);
    vec3  shown = at_plate ? find_plate_color(path.origin, path.direction, plate) : vec3(0.0);
    return found + finite_or_black(path.weight * (at_plate ? through_fog(shown, left, true) : vec3(0.0)));
}

// Adds the light of a path that began at the plate.  Its first ray also adds what it would bring if
// nothing of the scene were in its way.
void add_caught(Path path, vec3 found, bool hits, float plate, uint index)
{
    uint row = row_of_plate(path.mirrored);
    add_light_to(row, index, found);
    if (control.value != 1u)
        return;
    vec3 without = found;
    for (uint once = 0u; once < uint(hits); once++) // as in aovs.glsl
        without = find_light_with_plate(path, false, false, INFINITE, plate, index);
    add_light_to(row + 1u, index, clamp_factor(without) * without);
}
#endif

// Begins or ends a path whose ray has ended.  Returns whether it hits a surface.
bool follow(uvec2 pixel, uint index, inout uint unresolved)
{
    float base, slope;
    RayEnd ray = find_end(index);
    Path  path = load(pixel, index, base, slope);
    bool  hits = ray.state == STATE_HIT;
    unresolved += ray.unresolved ? 1u : 0u;
    if (ends_in_volume(index)) // a medium is before it (track.comp); AOVs are those of the surface
        return hits && path.density == 0.0 && control.first_ray != 0u;
    bool lost = ray.unresolved && path.density > 0.0;
#ifdef PATH_RAYS
    float begun = abs(load_path(PATH_TOWARD, index).w); // in a medium
#else
    float begun = 1.0;
#endif
#ifdef CATCHES
    float plate = find_plate_of_path(path);
    vec3  found = clamped(find_light_with_plate(path, hits, lost, ray.t, plate, index));
    bool  hits_scene = hits && ray.t <= plate;
    if (path.caught)
        add_caught(path, found, hits_scene, plate, index);
    else
        add_light(index, found);
    hits = hits_scene;
#else
    add_light(index, clamped(find_light_before(path, hits, lost, ray.t, index)));
#endif
    if (!hits) // nobody reads what is stored of a path that has ended
        return false;
#ifndef PATH_RAYS
    store_path(PATH_ORIGIN, index, vec4(path.origin, base));
    store_path(PATH_DIRECTION, index, vec4(path.direction, slope));
    store_path(PATH_WEIGHT, index, vec4(path.weight, path.density));
#endif
    store_path(PATH_TOWARD, index, vec4(0.0, 0.0, 0.0, begun * ray.side));
    return true;
}

// Lists hits, whose indices in the list are reserved for all pixels of a quarter at once
// (background.comp).
void list_hits(uint first, uint hits)
{
    uint at = hits != 0u ? atomicAdd(counts.hit_count, bitCount(hits)) : 0u;
    for (; hits != 0u; hits &= hits - 1u)
        pixel_lists[at++] = slot_of_bit(first, hits & ~hits + 1u);
}

#ifdef PATH_RAYS
void do_item(uint number)
{
    uint slot = load_tile_word(number), unresolved = 0u;
    uvec2 pixel = pixel_of(slot);
    if (follow(pixel, index_of(pixel), unresolved))
        pixel_lists[atomicAdd(counts.hit_count, 1u)] = slot;
    if (unresolved != 0u)
        atomicAdd(counts.unresolved, unresolved);
}
#else
void do_item(uint quarter)
{
    uint  first = slot_of_quarter(quarter), hits = 0u, unresolved = 0u;
    uvec2 corner = pixel_of(first);
    for (uint left = find_existing(corner) & find_sampled(quarter); left != 0u; left &= left - 1u) {
        uint  number = uint(findLSB(left));
        uvec2 pixel = corner + uvec2(number & 3u, number >> 2u);
        uint  index = index_of(pixel);
        hits |= uint(follow(pixel, index, unresolved)) << number;
        if (control.first_ray != 0u && is_wanted(ROW_COUNTS))
            results[ROW_COUNTS * band_pixels() + index] = uvec4(0u, find_end(index).steps, 0u, 0u);
    }
    if (unresolved != 0u)
        atomicAdd(counts.unresolved, unresolved);
    list_hits(first, hits);
}
#endif

#include "pixels.glsl"
