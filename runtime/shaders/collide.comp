#version 440
#extension GL_GOOGLE_include_directive : enable
/*
 * collide.comp: what paths do where a medium scatters their light (track.comp has found where).
 *
 * A path chooses a point of a light, and goes on in a direction, by Henyey's and Greenstein's phase function.  Of the
 * light of lights it is known what media leave on the way (volumes.glsl).
 */
#include "scene.glsl"
#include "frame.glsl"
#include "hit_lists.glsl"
#include "results.glsl"
#include "sines.glsl"
#include "arcs.glsl"
#include "light.glsl"
#ifdef SKY_MAP
#include "sky_map.glsl"
#endif
#include "path_samples.glsl"
#define CHOOSES_LIGHTS
#include "lights.glsl"
#include "chances.glsl"
#include "media.glsl"
#ifndef VOLUMES
#define VOLUMES 1u
#endif
#include "volumes.glsl"
#include "phase.glsl"
#include "beams.glsl"

const uint CHOICES = 3u; // as in scatter.comp
// From this event on paths may end of which little is left.  What scatters all light keeps its weight.
const uint LATE = 3u;

void begin_group() { krs_prepare(); }

vec2 choose(uvec2 pixel, uint choice)
{
    return sample_choice(work.corner + pixel, control.ray, CHOICES * control.value + choice,
                         control.seed);
}

// Chooses a direction with that density.
vec3 choose_scattered(float anisotropy, vec3 direction, vec2 square_point)
{
    float at = 2.0 * square_point.x - 1.0, g = anisotropy;
    float ratio = (1.0 - g * g) / (1.0 + g * at);
    float cosine = abs(g) < 1e-3 ? at : (1.0 + g * g - ratio * ratio) / (2.0 * g);
    cosine = clamp(cosine, -1.0, 1.0);
    float ring = sqrt(max(1.0 - cosine * cosine, 0.0)), angle = 2.0 * PI * square_point.y;
    vec3  right, up;
    find_frame(direction, right, up);
    return normalize(ring * (krs_cos(angle) * right + krs_sin(angle) * up) + cosine * direction);
}

// An event in a medium.
struct Event {
    vec3  place, direction; // the direction that the path came by
    vec3  weight;
    float anisotropy, code;
    Beam  beam; // of the camera's ray
};

// Chooses a point of a light, and what it adds if it is visible.  Returns the direction to it, and the row of
// results.
vec3 choose_light(uvec2 pixel, uint index, uint slot, Event event, out uint row)
{
    bool  is_sky;
    uint  number;
    float all;
    LightPoint point = choose_light_point(event.place, choose(pixel, 1u), number, is_sky, all);
    float phase = find_phase(event.anisotropy, dot(event.direction, point.toward));
    float by_rays = phase / max(point.density, 1e-30);
    float share = point.density > 0.0 ? 1.0 / (1.0 + by_rays * by_rays) : 1.0; // as in scatter.comp
    Light light = find_light(number);
    if (control.value == 0u && !is_sky && is_positional(light)) { // beam.comp asks it, too
        float ratio = find_beam_ratio(light, event.place, sum_beam_importance(event.beam));
        share /= 1.0 + ratio * ratio;
    }
    vec3  added = all > 0.0 ? event.weight * phase * point.light * share : vec3(0.0);
    float end = largest(added) > 0.0 ? point.end : 0.0;
    added = finite_or_black(added * find_left_by_volumes(event.place, point.toward, end));
    store_path(PATH_LIGHT, index, vec4(added, point.end));
    if (largest(added) > 0.0)
        pixel_lists[LIST_TO_LIGHTS * band_pixels() + atomicAdd(counts.sparse, 1u)] = slot;
    row = control.separate != 0u && !is_sky ? ROW_OF_LIGHTS + number : ROW_COLORS;
    return point.toward;
}

// Sends the path on, or ends it.  Returns where its ray begins (media.glsl); 0: it ends.
float continue_path(uvec2 pixel, uint index, uint slot, Event event, float width, float spread)
{
    vec3  direction = choose_scattered(event.anisotropy, event.direction, choose(pixel, 0u));
    float density = find_phase(event.anisotropy, dot(event.direction, direction));
    vec3  weight = event.weight;
    bool  goes_on = largest(weight) > 0.0;
    if (control.value >= LATE) {
        float chance = min(largest(weight), 1.0);
        goes_on = goes_on && find_chance() < chance;
        weight /= max(chance, 1e-30);
    }
    store_path(PATH_ORIGIN, index, vec4(event.place, width));
    store_path(PATH_DIRECTION, index, vec4(direction, max(spread, 3.0 * frame.pixel_slope)));
    store_path(PATH_WEIGHT, index, vec4(weight, density));
    store_hit(FACING, slot, vec4(direction, 1.0)); // as if it left a surface upright
    float code = event.code;
#ifdef DIRECT
    bool straight = control.value == 0u || fract(abs(code)) == STRAIGHT;
    code = code_through(sign(code) * floor(abs(code)), straight ? SCATTERED : 0.0);
    goes_on = goes_on && straight;
#endif
    return goes_on ? code : 0.0;
}

void do_item(uint number)
{
    uint  slot = find_listed(control.reading + number);
    uvec2 pixel = pixel_of(slot);
    uint  index = index_of(pixel);
    vec4  place = load_path(PATH_LIGHT, index), start = load_path(PATH_ORIGIN, index);
    vec4  ahead = load_path(PATH_DIRECTION, index);
    uint  volume = uint(place.w);
    float way = dot(place.xyz - start.xyz, ahead.xyz);
    Event event;
    event.place = place.xyz;
    event.direction = ahead.xyz;
    event.code = load_path(PATH_TOWARD, index).w;
    enter_medium(event.code);
    event.weight = load_path(PATH_WEIGHT, index).xyz;
    float left = let_through(start.y, ahead.y, way); // by fog
    vec3  sent = frame.fog.rgb * (1.0 - left) + left * krs_volume_emission(volume, event.place);
#ifdef MEDIA // what glass absorbs on the way
    if (krs_medium != 0u) {
        krs_lift = 0.0;
#ifdef KRS_VIEW
        krs_view = event.direction;
#endif
        krs_surface(event.place, -event.direction, 0.0);
        event.weight *= exp(-max(krs_absorption, 0.0) * way);
    }
#endif
    vec3  radiance = clamped(finite_or_black(event.weight * sent));
    vec4  sum = find_color(index) + vec4(radiance, control.value == 0u ? 1.0 : 0.0);
    results[control.color_row * band_pixels() + index] = floatBitsToUint(sum);
    if (control.phase == PATHS_END)
        return;
    begin_chances(work.corner + pixel, 0x80000u);
    event.weight *= left * krs_volume_albedo(volume, event.place);
    event.anisotropy = krs_volume_anisotropy(volume, event.place);
    event.beam = find_beam(start.xyz, ahead.xyz, end_of_way(find_end(index)));
    uint  row;
    vec3  toward = choose_light(pixel, index, slot, event, row);
    float width = start.w + way * ahead.w;
    float code = continue_path(pixel, index, slot, event, width, ahead.w);
    store_path(PATH_TOWARD, index, vec4(toward, code));
    if (code != 0.0)
        tiles[atomicAdd(counts.tiles, 1u)] = slot;
    float of_light = sign(event.code) * floor(abs(event.code));
    of_light += sign(of_light) * float(row * CODES_OF_RAYS);
    store_path(PATH_SURFACE, index, vec4(event.place, of_light));
}

#include "pixels.glsl"
