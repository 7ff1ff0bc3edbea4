#version 440
#extension GL_GOOGLE_include_directive : enable
/*
 * photons.comp: follows photons from lights through smooth metal and glass to the first surface that is neither.
 *
 * An item is a photon (blocks.h).  It is scattered as a path is (scatter.comp), in the other direction.  Paths do not
 * divide radiance by the square of the index of refraction, so photons are divided by it where they go in.
 */
#include "scene.glsl"
#include "frame.glsl"
#include "hit_point.glsl"
#include "sines.glsl"
#include "samples.glsl"
#include "light.glsl"
#include "path_samples.glsl"
#include "bsdf.glsl"
#include "bsdf_samples.glsl"
#define LIGHT_SAMPLES
#include "light_types.glsl"
#include "boundary.glsl"
#include "shading_normal.glsl"
#include "chances.glsl"
#include "photons.glsl"

const uint MAX_SURFACES = 16u, MAX_PHOTON_STEPS = 400u, SECANTS = 4u;
// The least step, and the reach of differences for normals, relative to coordinates.
const float LEAST_STEP = 4e-6, NORMAL_REACH = 3e-4;

vec3  place, ahead, power;
float way; // since the last surface

// Finds where a ray meets a surface; false: nowhere.
bool march()
{
    float before = 0.0, clearance = krs_distance(place), t = 0.0;
    float farthest = frame.farthest;
    if (clearance < 0.0) // rounding has put it behind what it leaves, or a light is inside of a solid
        return false;
    for (uint i = 0u; i < MAX_PHOTON_STEPS; i++) {
        before = t;
        t += max(clearance, LEAST_STEP * (largest(place) + t));
        float last = clearance;
        clearance = krs_distance(place + t * ahead);
        if (clearance >= 0.0 && t < farthest)
            continue;
        if (clearance >= 0.0)
            return false;
        float behind = clearance, end = t;
        for (uint k = 0u; k < SECANTS; k++) {
            t = mix(before, end, clamp(last / (last - behind), 0.05, 0.95));
            clearance = krs_distance(place + t * ahead);
            if (clearance < 0.0) {
                end = t;
                behind = clearance;
            } else {
                before = t;
                last = clearance;
            }
        }
        way = mix(before, end, last / (last - behind));
        return true;
    }
    return false;
}

// Returns the normal, towards the side that the ray comes from.
vec3 find_facing(HitPoint hit)
{
    float reach = max(frame.normal_reach * hit.width, NORMAL_REACH * largest(hit.position));
    vec3  sum = vec3(0.0);
    for (uint axis = 0u; axis < 3u; axis++) {
        vec3 tap = vec3(0.0);
        tap[axis] = reach;
        sum[axis] = krs_distance(hit.position + tap) - krs_distance(hit.position - tap);
    }
    float size = length(sum);
    return size > 0.0 ? sum / size : -ahead;
}

// Sends the photon on from a smooth surface; false: it ends.
bool scatter_photon(HitPoint hit, vec3 facing, KrsSurface surface, Boundary boundary, inout float code)
{
    Axes axes = find_axes(find_normal(hit, surface, facing), surface.tangent);
    Bsdf bsdf = make_bsdf(surface, hit.side > 0.0, into(axes, -ahead));
    bsdf.eta = boundary.eta;
    vec2  square_point = vec2(find_chance(), find_chance());
    vec3  light = sample_direction(bsdf, square_point, find_chance());
    vec4  scattered = scatter(bsdf, light);
    vec3  direction = out_of(axes, light) / max(length(light), 1e-6);
    bool  through = light.z < 0.0;
    float side = through ? -1.0 : 1.0, rise = side * dot(direction, facing);
    power *= scattered.rgb / max(scattered.w, 1e-30) / (through ? square(bsdf.eta) : 1.0);
    place = find_start(hit, direction, vec4(facing, 1.0), side, surface.distance);
    ahead = direction;
    code = through ? boundary.beyond : boundary.code;
    return rise > 0.0 && scattered.w > 0.0 && largest(power) > 0.0 && largest(power) < 1e30;
}

// Follows the photon; false: it is lost.
bool follow(out vec3 normal)
{
    float code = 1.0;
    for (uint number = 0u; number < MAX_SURFACES; number++) {
        enter_medium(code);
        if (!march())
            return false;
        float    width = frame.pixel_base + frame.pixel_slope * distance(place + way * ahead, frame.eye);
        HitPoint hit = hit_point_on(0u, place, ahead, width, 0.0, way, 1.0, 0u);
        normal = find_facing(hit);
#ifdef KRS_VIEW
        krs_view = ahead;
#endif
        prepare_boundary(hit, code, normal);
        KrsSurface surface = within_limits(krs_surface(hit.position, hit.side * normal, 0.5 * hit.width));
        Boundary   boundary = find_boundary(hit, surface);
        hit.side = boundary.side;
#ifdef MEDIA
        surface.ior = max(boundary.eta, 1.0 / boundary.eta);
#endif
        power *= find_left(boundary, way);
        if (!is_smooth(surface)) {
            place = hit.position;
            return number > 0u; // others are known without photons
        }
        if (!scatter_photon(hit, normal, surface, boundary, code))
            return false;
    }
    return false;
}

void begin_group() { krs_prepare(); }

void do_item(uint number)
{
    vec4  start = load_hit_row(PHOTON_ROWS * number), toward = load_hit_row(PHOTON_ROWS * number + 1u);
    Light light = find_light(floatBitsToUint(start.w));
    vec3  normal;
    begin_chances(uvec2(number, 0u), 0x80000u);
    place = start.xyz;
    ahead = toward.xyz;
    power = toward.w * light.color * find_share(light, ahead);
    bool ends = largest(power) > 0.0 && follow(normal);
    hits[PHOTON_ROWS * number] = vec4(place, pack_direction(ahead));
    hits[PHOTON_ROWS * number + 1u] = vec4(ends ? finite_or_black(power) : vec3(0.0),
                                           ends ? pack_direction(normal) : 0.0);
}

#include "pixels.glsl"
