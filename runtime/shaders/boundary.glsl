/*
 * boundary.glsl: what is on both sides of a surface that the ray of a path has met, and how far it
 * has come.
 */
#include "media.glsl"

// A boundary that a ray has met.
struct Boundary {
    float side;        // 1: it enters what has the boundary, -1: it leaves that
    float eta;         // index of refraction beyond, relative to here
    vec3  absorption;  // of the medium that the ray has been in
    bool  absorbs;     // it has been in one
    float code, beyond; // of rays that stay on this side, and of those that go on beyond
};

// Returns the part of a surface that lets light through.
float find_glass(KrsSurface surface)
{
    return clamp(surface.transmission, 0.0, 1.0) * (1.0 - clamp(surface.metallic, 0.0, 1.0));
}

// Nothing refracts less than this.
const float MIN_ETA = 1.001;

float find_eta(float here, float beyond)
{
    float eta = clamp(beyond, 1.0, 4.0) / clamp(here, 1.0, 4.0);
    return eta < 1.0 ? min(eta, 1.0 / MIN_ETA) : max(eta, MIN_ETA);
}

#ifdef STARTS_BY_DISTANCE
#include "research/starts_by_distance.glsl"
#else
// The pixels above a surface at which rays of previews start, where it is even and where it is not,
// as in secondary.comp.
const float START_OF_EVEN = 0.125, START = 0.5;

// The height above the surface at which a ray starts.  Where hits are snapped, that is by what
// rounding may be wrong by: of coordinates, and of the distance, which shows in differences around
// the hit.  These are large at edges as well, so they count up to MAX_BEND alone.
const float MAX_BEND = 0.04;
float find_snapped_height(HitPoint hit, float evenness)
{
    float bend = sqrt(max(1.0 / max(evenness * evenness, 1e-6) - 1.0, 0.0));
    return max(SNAPPED_START * hit.rounding, 2.0 * find_reach(hit) * min(bend, MAX_BEND));
}

float find_height(HitPoint hit, float evenness, float distance)
{
    float pixels = mix(START, START_OF_EVEN, smoothstep(0.9, 0.99, evenness));
    return snaps() ? find_snapped_height(hit, evenness)
                   : pixels * hit.near + 4.0 * hit.rounding;
}
#endif

// Finds where a ray starts that leaves the hit into a direction, on the side `side` of the surface.
// That is so far along the ray that it is as high above the surface as it must be.  So the ray
// itself is not displaced, unless it leaves the surface at less than this cosine: then it is
// lifted, too.
const float MIN_COSINE = 0.25;
vec3 find_start(HitPoint hit, vec3 direction, vec4 facing, float side, float distance)
{
    float height = find_height(hit, facing.w, distance);
    float cosine = abs(dot(direction, facing.xyz));
    float ahead = height / max(cosine, MIN_COSINE);
    return hit.position + ahead * direction + side * (height - ahead * cosine) * facing.xyz;
}

// Tells how long a path's ray has been on its way from the last surface.  It began somewhat beyond that,
// but the camera's did not (`first`).
float find_way(uint index, HitPoint hit, float t, bool first)
{
    vec3 lifted = load_path(PATH_ORIGIN, index).xyz - load_path(PATH_SURFACE, index).xyz;
    return first ? t : t + dot(lifted, hit.direction);
}

// Returns what absorption leaves of light on that way.
vec3 find_left(Boundary boundary, float way)
{
    return boundary.absorbs ? exp(-max(boundary.absorption, 0.0) * way) : vec3(1.0);
}

#ifdef MEDIA
// Prepares what krs_surface needs to know of the ray.  A camera's ray does not know its medium, but
// whether it began inside of something.
void prepare_boundary(inout HitPoint hit, float code, vec3 facing)
{
    enter_medium(code);
    krs_lift = find_height(hit, 0.0, 0.0);
    if (hit.side < 0.0) {
        krs_medium = krs_medium_at(hit.position + krs_lift * facing);
        hit.side = krs_medium == 0u ? -1.0 : 1.0;
    }
}

// Returns what it has told, for the surface that it has found.
Boundary find_boundary(HitPoint hit, KrsSurface surface)
{
    bool leaves = krs_medium != 0u && krs_struck == krs_medium;
    Boundary boundary;
    boundary.side = leaves ? -1.0 : hit.side;
    boundary.eta = find_eta(krs_ior_here, krs_struck == 0u ? surface.ior : krs_ior_beyond);
    boundary.absorption = krs_absorption;
    boundary.absorbs = krs_medium != 0u;
    boundary.code = code_of_ray(hit.side, krs_medium);
    boundary.beyond = code_of_ray(krs_struck == 0u ? -hit.side : hit.side, krs_beyond);
    return boundary;
}
#else
void prepare_boundary(inout HitPoint hit, float code, vec3 facing) {}

Boundary find_boundary(HitPoint hit, KrsSurface surface)
{
    float ior = max(surface.ior, MIN_ETA);
    return Boundary(hit.side, hit.side > 0.0 ? ior : 1.0 / ior, surface.absorption, hit.side < 0.0,
                    hit.side, -hit.side);
}
#endif
