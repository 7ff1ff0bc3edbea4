#version 440
#extension GL_GOOGLE_include_directive : enable
/*
 * scatter.comp: what paths do at the surfaces that they hit.
 *
 * A path adds the light that the surface emits.  It chooses a point of a light, and what this adds
 * if it is visible (secondary.comp).  And it goes on in a direction from which much of the light
 * comes that the surface scatters to the eye.  Paths whose light counts little end early, and the
 * others count more for it (Russian roulette).
 *
 * DIRECT: paths end at the second surface, but glass is none.  They go on through it, and light of lights
 * comes through it straight.
 *
 * VOLUMES: media dim the light of lights (volumes.glsl).
 *
 * PHOTONS_GATHERED: light that smooth surfaces gather on others is found by photons, unless there are none in this
 * picture.
 *
 * CATCHES: a plate catches shadows.  Paths that begin there have rows of results of their own.  What the
 * plate shows may hide lights from surfaces of the scene.
 */
#include "scene.glsl"
#include "frame.glsl"
#include "hit_lists.glsl"
#include "results.glsl"
#include "aovs.glsl"
#include "light.glsl"
#ifdef SKY_MAP
#include "sky_map.glsl"
#endif
#include "path_samples.glsl"
#include "bsdf.glsl"
#include "bsdf_samples.glsl"
#define CHOOSES_LIGHTS
#include "lights.glsl"
#include "emissive.glsl"
#include "boundary.glsl"
#include "shading_normal.glsl"
#ifdef CATCHES
#include "plate.glsl"
#include "plate_rays.glsl"
#endif
#ifdef DIRECT
#include "tints.glsl"
#endif

const uint CHOICES = 3u;      // points of the unit square for each surface of a path
// The surfaces on a path from which it may end.  At first what counts is how much of the light the
// surface sends back: where that is half of it, the path is sure to go on.  From surface LATE on
// what counts is the path's weight.
const uint  FIRST_ROULETTE = 1u, LATE = 3u;
const float SURE = 0.5, MAX_CHANCE = 0.95;
// The part of a light's irradiance that goes to the eye, from which on a path is sure to ask for that light.
const float SURE_OF_LIGHT = 1.0 / 64.0;
// The growth of the width of a ray where rough surfaces scatter it, relative to a camera's.
const float MAX_SPREAD = 3.0;

// Rays that rise less go along a plane for too many steps, so they are lifted.  They bring a hundred
// thousandth of the light on a dull surface; smooth ones mirror rays that come as low.
const float MIN_RISE = 2e-3, LOW = 0.05;
bool goes_along(float rise, HitPoint hit, vec3 facing)
{
    return rise < MIN_RISE && -dot(hit.direction, facing) > LOW;
}

// Returns the number of the choice at surface `control.value` of a path.
vec2 choose(uvec2 pixel, uint choice)
{
    return sample_choice(work.corner + pixel, control.ray, CHOICES * control.value + choice,
                         control.seed);
}

#if defined(SUBSURFACE) || defined(VOLUMES)
#include "chances.glsl"
#endif
#ifdef VOLUMES
#include "volumes.glsl"
#endif
#ifdef SUBSURFACE
#include "subsurface.glsl"

// Chooses whether the path goes on below the surface.  If it does, it leaves elsewhere: the hit is
// moved there, and what is seen of it is dull and white.
vec3 go_below(uvec2 pixel, inout HitPoint hit, inout vec4 facing, inout Bsdf bsdf, inout Axes axes,
              KrsSurface surface)
{
    uvec2 own = work.corner + pixel;
    if (sample_choice(own, control.ray, 0x20000u + control.value, control.seed).x >=
        bsdf.chance_below)
        return vec3(1.0 / max(1.0 - bsdf.chance_below, 1e-6));
    begin_chances(own, 0x30000u);
    Walk walk = walk_below(hit, facing.xyz, surface.subsurface_color, surface.subsurface_radius);
    vec3 part = bsdf.entering * walk.weight / bsdf.chance_below;
    bsdf = make_dull(bsdf);
    if (walk.moved) {
        hit.position = walk.position;
        hit.rounding = ROUNDING * 2.0 * largest(walk.position);
        facing = vec4(walk.normal, 0.0);
        axes = find_axes(walk.normal, vec3(0.0));
        store_hit(FACING, hit.slot, facing);
    }
    return part;
}
#endif

uint rows;

void begin_group()
{
    krs_prepare();
    rows = control.value == 0u ? control.rows : 0u;
}

// Returns what glass leaves of the light of a point; 1: there is none in between.
vec3 find_tint_to(LightPoint point, HitPoint hit, vec3 facing)
{
    vec3 tint = vec3(1.0);
#ifdef DIRECT
    uint  medium = krs_medium;
    vec3  start = find_start_of_way(hit, facing);
    float end = min(point.end, clip_ray(start, point.toward, frame.farthest).y);
    tint = find_tint_of_way(start, point.toward, end, hit.width, point.end > 0.0);
    krs_medium = medium;
#endif
    return tint;
}

// The way by which the path has come here (media.glsl).
float come_by;

// Tells how a path of direct light goes on from glass, or from a surface.
float go_by(Bsdf bsdf, Boundary boundary, bool beyond)
{
    bool stays = bsdf.glass > 0.0 && (beyond || boundary.absorbs);
    return !stays ? 0.0 : come_by == 0.0 ? SCATTERED : come_by;
}

#ifdef DIRECT
bool is_direct() { return true; }
#else
bool is_direct() { return false; }
#endif

// Tells whether a path of direct light ends here.
bool ends_here(Bsdf bsdf) { return is_direct() && come_by != STRAIGHT && bsdf.glass == 0.0; }

// These tell whether the path began at the plate: densities are negative then.  If it is there now,
// it begins.
bool  caught, begins_at_plate;
bool  mirrored;      // by the plate, where the path began
uint  row_of_caught; // of results, where the path began at the plate
float sign_of_path() { return caught ? -1.0 : 1.0; }

void find_whether_caught(uvec2 pixel, uint index)
{
    caught = begins_at_plate = mirrored = false;
    row_of_caught = 0u;
#ifdef CATCHES
    caught = control.value == 0u ? is_of_plate(find_end(index))
                                 : load_path(PATH_WEIGHT, index).w < 0.0;
    begins_at_plate = caught && control.value == 0u;
    mirrored = caught && is_mirrored(pixel);
    row_of_caught = row_of_plate(mirrored);
#endif
}

#ifdef PHOTONS_GATHERED
#include "photons.glsl"

// Tells whether photons know of light of lights that a surface sends on.
bool has_photons() { return control.photons != 0u; }

bool is_known_by_photons(bool smooth_surface)
{
    return has_photons() && smooth_surface && (come_by == DULL || come_by == FOCUSED);
}

// Returns the code of a ray, with what photons know of its light.
float code_for_photons(float code, bool smooth_surface)
{
    bool known = !smooth_surface || is_known_by_photons(true);
    return has_photons() && code != 0.0 && known
               ? code_through(code, smooth_surface ? FOCUSED : DULL) : code;
}
#endif

// Tells whether the plate is before a point of a light.  What it casts on itself it shows already.
bool is_behind_plate(LightPoint point, HitPoint hit)
{
#ifdef CATCHES
    if (control.plate_map != 0u && point.end > 0.0 && (!begins_at_plate || mirrored))
        return find_plate_ahead(hit.position, point.toward, point.end, begins_at_plate) < INFINITE;
#endif
    return false;
}

// Chooses a point of a light, and what it adds if it is visible.  Returns the direction to it, and the
// row of results to which it is added.
vec3 choose_light(uvec2 pixel, uint index, HitPoint hit, Bsdf bsdf, Axes axes, vec3 facing,
                  vec3 weight, Cones cones, Boundary boundary, bool photons_know, out uint row)
{
    bool  is_sky;
    uint  number;
    float all;
    LightPoint point = choose_light_point(hit.position, choose(pixel, 1u), number, is_sky, all);
    vec3 light = into(axes, point.toward);
    vec4 scattered = scatter(bsdf, light);
    vec3 tint = find_tint_to(point, hit, facing);
    // Both methods together count once (escape.comp).  Rays do not find lights behind glass.
    float by_rays = tint == vec3(1.0) ? mixed_density(cones, point.toward, scattered.w) : 0.0;
    float share = point.density > 0.0 ? 1.0 / (1.0 + square(by_rays / point.density)) : 1.0;
    float rise = dot(point.toward, facing);
    bool  along = is_sky && abs(rise) < MIN_RISE;
    bool  sees = rise * light.z > 0.0 && all > 0.0 && !along;
    vec3  added = sees ? weight * scattered.rgb * point.light * share * tint : vec3(0.0);
    added = finite_or_black(added);
    if (photons_know && !is_sky && casts_shadows(find_light(number)))
        added = vec3(0.0);
    if (largest(added) > 0.0 && is_behind_plate(point, hit))
        added = vec3(0.0);
#ifdef VOLUMES
    begin_chances(work.corner + pixel, 0x70000u);
    enter_medium(rise < 0.0 ? boundary.beyond : boundary.code);
    float end = largest(added) > 0.0 ? point.end : 0.0;
    added *= find_left_by_volumes(hit.position, point.toward, end);
#endif
    // Light that hardly comes back to the eye, as beside the lobe of a mirror, is asked for seldom, and counts more.
    // The first surface always asks, so that light without a size has no noise there.
    float sent = PI * largest(weight * scattered.rgb);
    float chance = control.value == 0u || is_direct() || caught ? 1.0 : min(sent / SURE_OF_LIGHT, 1.0);
    bool  asks = sample_choice(work.corner + pixel, control.ray, 0x50000u + control.value,
                               control.seed).x < chance;
    added = asks ? added / max(chance, 1e-30) : vec3(0.0);
    store_path(PATH_LIGHT, index, vec4(added, point.end));
    if (largest(added) > 0.0)
        pixel_lists[LIST_TO_LIGHTS * band_pixels() + atomicAdd(counts.sparse, 1u)] = hit.slot;
    row = control.separate != 0u && !is_sky ? ROW_OF_LIGHTS + number : ROW_COLORS;
    if (caught)
        row = row_of_caught;
    if (begins_at_plate)
        add_light_to(row + 1u, index, clamp_factor(added) * added);
    return point.toward;
}

// Returns the direction in which the path goes on, in the frame of the surface; 0: it ends.
vec3 choose_direction(Bsdf bsdf, Axes axes, Cones cones, vec2 square_point, float choice)
{
    vec2 at = square_point;
    if (take_part(at, 0.0, cones.part))
        return into(axes, sample_cones(cones, at));
    take_part(at, cones.part, 1.0);
    return sample_direction(bsdf, at, choice);
}

// Sends the path on, or ends it.  Returns where its ray begins (media.glsl); 0: it ends.  `off` is the
// distance of the hit from the surface.
float continue_path(uvec2 pixel, uint index, HitPoint hit, Bsdf bsdf, Axes axes, vec4 facing, vec3 weight,
            float roughness, float off, Boundary boundary, Cones cones)
{
    vec3  light = choose_direction(bsdf, axes, cones, choose(pixel, 0u), choose(pixel, 2u).y);
    vec4  scattered = scatter(bsdf, light);
    vec3  direction = out_of(axes, light) / max(length(light), 1e-6);
    float kept = largest(scattered.rgb) / max(scattered.w, 1e-30);
    scattered.w = mixed_density(cones, direction, scattered.w);
    weight *= scattered.rgb / max(scattered.w, 1e-30);
    float rise = dot(direction, facing.xyz) * sign(light.z);
    if (rise > 0.0 && goes_along(rise, hit, facing.xyz))
        direction = normalize(direction + (MIN_RISE - rise) * sign(light.z) * facing.xyz);
    bool  goes_on = rise > 0.0 && scattered.w > 0.0 && largest(weight) > 0.0 && largest(weight) < 1e30;
    if (control.value >= FIRST_ROULETTE) {
        float chance = control.value < LATE ? min(kept / SURE, 1.0)
                                            : min(find_survival(weight, kept), MAX_CHANCE);
        goes_on = goes_on && sample_choice(work.corner + pixel, control.ray,
                                           0x10000u + control.value, control.seed).x < chance;
        weight /= max(chance, 1e-30);
    }
    float side = light.z < 0.0 ? -1.0 : 1.0; // of the surface, relative to the ray's
    float spread = load_path(PATH_DIRECTION, index).w;
    spread = max(spread, min(1.0 + 2.0 * roughness, MAX_SPREAD) * frame.pixel_slope);
    store_path(PATH_ORIGIN, index, vec4(find_start(hit, direction, facing, side, off), hit.width));
    store_path(PATH_DIRECTION, index, vec4(direction, spread));
    store_path(PATH_WEIGHT, index, vec4(weight, sign_of_path() * scattered.w));
    float code = side > 0.0 ? boundary.code : boundary.beyond;
#ifdef DIRECT
    float by = go_by(bsdf, boundary, side < 0.0);
    goes_on = goes_on && (come_by == STRAIGHT || by != 0.0);
    code = code_through(code, by);
#endif
    return goes_on ? code : 0.0;
}

// Returns the colour of a body, with what comes from below its surface; metals have none.
vec3 albedo_of(KrsSurface surface)
{
#ifdef SUBSURFACE
    float below = surface.subsurface_weight * (1.0 - surface.metallic);
    return mix(surface.color, surface.subsurface_color, below);
#else
    return surface.color;
#endif
}

// Returns the surface that a path has hit.  What it reflects depends on the medium before it.
Boundary meet_boundary(inout HitPoint hit, uint index, vec3 facing, out KrsSurface surface)
{
    prepare_boundary(hit, load_path(PATH_TOWARD, index).w, facing);
    surface = within_limits(krs_surface(hit.position, hit.side * facing, 0.5 * hit.width));
    Boundary boundary = find_boundary(hit, surface);
    hit.side = boundary.side;
#ifdef MEDIA
    surface.ior = max(boundary.eta, 1.0 / boundary.eta);
#endif
    return boundary;
}

// Adds what the surface itself sends, and stores what is known of it.
void store_seen(uint index, vec3 radiance, HitPoint hit, vec3 normal, KrsSurface surface)
{
    radiance = clamped(finite_or_black(radiance));
    if (caught) {
        add_light_to(row_of_caught, index, begins_at_plate ? vec3(0.0) : radiance);
        return;
    }
    vec4 sum = find_color(index) + vec4(radiance, control.value == 0u ? 1.0 : 0.0);
    store_aovs(index, rows | 1u << ROW_COLORS, sum, hit, hit.side * normal, albedo_of(surface),
                 surface);
}

// Tells how the surface scatters light.
Bsdf find_bsdf(KrsSurface surface, HitPoint hit, Boundary boundary, Axes axes)
{
    Bsdf bsdf = make_bsdf(surface, hit.side > 0.0, into(axes, -hit.direction));
    bsdf.eta = boundary.eta;
    if (begins_at_plate) {
        bsdf = make_dull(bsdf);
#ifdef SUBSURFACE
        bsdf.chance_below = 0.0;
#endif
    }
#ifdef CATCHES
    if (begins_at_plate && mirrored)
        bsdf = make_glossy(surface, control.plate_roughness, control.plate_reflectance,
                           into(axes, -hit.direction));
#endif
    return bsdf;
}

void do_item(uint number)
{
    HitPoint   hit = find_hit_point(number);
    vec4       facing = load_hit(FACING, hit.slot);
#ifdef KRS_VIEW // as in shade.comp
    krs_view = hit.direction;
#endif
    uvec2 pixel = pixel_of(hit.slot);
    uint  index = index_of(pixel);
    find_whether_caught(pixel, index);
    KrsSurface surface;
    come_by = fract(abs(load_path(PATH_TOWARD, index).w));
    if (control.value == 0u)
        come_by = STRAIGHT;
    Boundary   boundary = meet_boundary(hit, index, facing.xyz, surface);
    float t = find_end(index).t;
    vec3  origin = load_path(PATH_ORIGIN, index).xyz, weight = load_path(PATH_WEIGHT, index).xyz;
    weight *= find_left(boundary, find_way(index, hit, t, control.value == 0u));
    float left = let_through(origin.y, hit.direction.y, t);
    vec3  radiance = weight * through_fog(surface.emission, left, true);
    weight *= left;
    vec3 normal = find_normal(hit, surface, facing.xyz);
    if (begins_at_plate) {
        normal = facing.xyz;
        surface.roughness = control.plate_roughness;
#ifdef CATCHES
        weight /= control.plate_reflectance == 0.0 ? 1.0
                  : mirrored                       ? MIRRORED_LOBE
                                                   : 1.0 - MIRRORED_LOBE;
#endif
    }
#ifdef VOLUMES // a medium is before the surface, whose colour nobody sees
    if (ends_in_volume(index)) {
        if ((rows & ~(1u << ROW_COLORS)) != 0u)
            store_aovs(index, rows & ~(1u << ROW_COLORS), vec4(0.0), hit, hit.side * normal,
                       albedo_of(surface), surface);
        return;
    }
#endif
#ifndef PHOTONS_GATHERED
    store_seen(index, radiance, hit, normal, surface);
    if (control.phase == PATHS_END)
        return;
#endif
    Axes axes = find_axes(normal, surface.tangent);
    Bsdf bsdf = find_bsdf(surface, hit, boundary, axes);
    if (ends_here(bsdf))
        return;
    HitPoint seen = hit;
#ifdef SUBSURFACE
    if (bsdf.chance_below > 0.0)
        weight *= go_below(pixel, hit, facing, bsdf, axes, surface);
#endif
    bool photons_know = false;
#ifdef PHOTONS_GATHERED
    bool smooth_surface = is_smooth(surface);
    bool gathers = control.phase != PATHS_END && !smooth_surface && has_photons();
    photons_know = is_known_by_photons(smooth_surface);
    if (gathers)
        radiance += weight * gather_photons(hit.position, facing.xyz, bsdf, axes);
    store_seen(index, radiance, seen, normal, surface);
    if (control.phase == PATHS_END)
        return;
#endif
    // Glass bends what leaves it, so that cones are of no use there.
    float dull = mix(surface.roughness * (1.0 - bsdf.glass), 1.0, bsdf.shares.w);
    Cones cones = find_cones(hit.position, facing.xyz, hit.side > 0.0 ? dull : 0.0);
    uint  row;
    vec3  of_lights = is_direct() && come_by != STRAIGHT ? vec3(0.0) : weight;
    vec3  toward = choose_light(pixel, index, hit, bsdf, axes, facing.xyz, of_lights, cones,
                                boundary, photons_know, row);
    float side = continue_path(pixel, index, hit, bsdf, axes, facing, weight, surface.roughness,
                       surface.distance, boundary, cones);
#ifdef PHOTONS_GATHERED
    side = code_for_photons(side, smooth_surface);
#endif
    store_path(PATH_TOWARD, index, vec4(toward, side));
    if (side != 0.0)
        tiles[atomicAdd(counts.tiles, 1u)] = hit.slot;
    float of_light = dot(facing.xyz, toward) < 0.0 ? boundary.beyond : boundary.code;
    of_light += sign(of_light) * float(row * CODES_OF_RAYS);
    store_path(PATH_SURFACE, index, vec4(hit.position, of_light));
}

#include "pixels.glsl"
