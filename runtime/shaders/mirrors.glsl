/*
 * mirrors.glsl: how previews follow what a smooth surface mirrors, and what glass lets through.
 *
 * One ray goes on from a surface: through glass, else back from a mirror.  So one sample has no
 * noise.  Where glass lets a ray through, what it mirrors is the sky alone.
 */
#include "optics.glsl"
#include "boundary.glsl"
#ifdef FILM
#include "thin_film.glsl"
#endif

// Roughnesses below which a ray finds what a surface mirrors, and above which it is the sky alone:
// of metals, and of others.
const vec2 SMOOTH_METAL = vec2(0.15, 0.3), SMOOTH_BODY = vec2(0.06, 0.12);
const float MIN_WEIGHT = 0.004; // rays that count less are not followed

// Returns the part of what a surface mirrors that a ray finds, and of what its clear coat mirrors.
vec2 find_traced(KrsSurface surface)
{
    vec2  limits = mix(SMOOTH_BODY, SMOOTH_METAL, clamp(surface.metallic, 0.0, 1.0));
    float body = 1.0 - smoothstep(limits.x, limits.y, surface.roughness);
    float coat = 1.0 - smoothstep(SMOOTH_BODY.x, SMOOTH_BODY.y, surface.coat_roughness);
    return find_glass(surface) > 0.0 ? vec2(0.0) : vec2(body, coat);
}

// The ray that goes on, and the part of its light that the surface sends back.
struct Onward {
    vec3  direction, part;
    float side; // on which it begins, relative to that of the ray: -1 behind the surface
    float code; // of where it begins (media.glsl)
};

// Finds how a ray goes on; `mirrored`: what it mirrors, as far as a ray finds that.
Onward find_onward(HitPoint hit, KrsSurface surface, Boundary boundary, vec3 normal, vec3 mirrored)
{
    Onward onward;
    float glass = find_glass(surface), eta = boundary.eta;
    float back = fresnel(clamp(-dot(hit.direction, normal), 0.0, 1.0), eta);
    bool  refracts = glass > 0.0 && back < 1.0;
    onward.direction = refracts ? refract(hit.direction, normal, 1.0 / eta)
                                : reflect(hit.direction, normal);
    vec3 through = vec3(1.0 - back);
#ifdef FILM
    through = 1.0 - find_film_on_glass(clamp(-dot(hit.direction, normal), 0.0, 1.0), eta,
                                       clamp(surface.thin_film_weight, 0.0, 1.0),
                                       clamp(surface.thin_film_thickness, 0.0, 1e3),
                                       clamp(surface.thin_film_ior, 1.0, 4.0));
#endif
    onward.part = refracts      ? glass * through * clamp(surface.color, 0.0, 1.0)
                  : glass > 0.0 ? vec3(glass)
                                : mirrored;
    onward.side = refracts ? -1.0 : 1.0;
    onward.code = refracts ? boundary.beyond : boundary.code;
    return onward;
}

// The width that a ray gains with each unit of its way beyond the surface: it is a cone about the
// pixel, and where the surface bends normals turn within the pixel.  The evenness tells how much
// over the reach of differences (normals.comp).  Mirrors turn rays twice as far as normals, glass
// by what it refracts.
const float MAX_TURNED = 0.5; // more comes from an edge, or from detail
float find_widening(HitPoint hit, vec4 facing, bool refracts, float eta)
{
    float evenness = max(facing.w, 1e-3);
    float bend = sqrt(max(1.0 / (evenness * evenness) - 1.0, 0.0));
    float cosine = max(abs(dot(hit.direction, facing.xyz)), 0.1);
    float turned = 2.0 * bend * hit.width / (cosine * find_reach(hit));
    return (refracts ? abs(1.0 - 1.0 / eta) : 2.0) * min(turned, MAX_TURNED);
}

// The width that a ray gains with each unit of its way beyond a rough mirror, relative to the width
// of the mirror's lobe.  So what it shows is as blurred as the mirror would make it, without noise.
const float LOBE = 2.0;
float find_lobe(KrsSurface surface)
{
    float roughness = clamp(surface.roughness, 0.0, 1.0);
    if (surface.coat > 0.0)
        roughness = min(roughness, clamp(surface.coat_roughness, 0.0, 1.0));
    return LOBE * roughness * roughness;
}
