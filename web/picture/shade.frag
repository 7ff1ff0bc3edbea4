/*
 * shade.frag: the light that a pixel's ray brings, as shade.comp and background.comp find it for previews, added to sums.
 *
 * The sky's light at a hit is in proportion to nothing that one ray knows: it is found from means over the rays of a pixel
 * (resolve.frag).  So the sums have what the open sky would give, and how open it is.
 */
#define HITS
#include "page.glsl"
#include "light.glsl"
#include "sky_means.glsl"
#include "light_types.glsl"
#include "optics.glsl"
#include "openness.glsl"
#include "hemisphere.glsl"
#ifdef LAYERS
#include "layers.glsl"
#endif
#ifdef MIRRORS
#include "mirrors.glsl"
#endif
#include "coat.glsl"

// Of rays to lights, and over the hemisphere (secondary.frag).
uniform highp usampler2D secondaries;

// Weights are as much as the hit sends of an open sky: of roofs in the light and walls in the shade, which a pixel may both
// have, the brighter ones decide.
layout(location = 0) out vec4 direct;   // light of lamps, and of the sky where nothing is hit; 1
layout(location = 1) out vec4 scattered; // light of an open sky, by the body; the weight where the ray finds it open
layout(location = 2) out vec4 mirrored;  // the same by mirrors; the weight times the albedo of what closes it
layout(location = 3) out vec4 own;       // the weight times the body's colour; the weight

#ifdef MIRRORS // the ray that goes on: as in a path of the runtime, the weight with the code of where it begins
layout(location = 4) out vec4 next_origin;
layout(location = 5) out vec4 next_direction;
layout(location = 6) out vec4 next_weight;

// As in shade.comp.
void send_on(HitPoint hit, KrsSurface surface, Boundary boundary, Coat coat, vec4 facing, vec3 weight)
{
#ifdef LAYERS
    vec3 found = traced_by_layers(coat.layers, coat.traced);
#else
    vec3 found = coat.traced.x * coat.mirror.around;
#endif
    Onward onward = find_onward(hit, surface, boundary, coat.normal, found);
    float spread = are_of_paths() ? load_path(PATH_DIRECTION, 0u).w : frame.pixel_slope;
    if (filters_detail())
        spread += find_widening(hit, facing, onward.side < 0.0, boundary.eta);
    spread += find_lobe(surface);
    bool leaves = dot(onward.direction, facing.xyz) * onward.side > 0.0;
    vec3 part = weight * onward.part;
    if (leaves && largest(part) >= MIN_WEIGHT) {
        vec3 direction = normalize(onward.direction);
        next_origin = vec4(find_start(hit, direction, facing, onward.side, 0.0), hit.width);
        next_direction = vec4(direction, spread);
        next_weight = vec4(min(part, 1e30), onward.code);
    }
}
#endif

const float BRIGHTEST = 1e30, FOOTPRINT = 0.05; // as in shade.comp and occluders.comp

// Surfaces have shown what mirrors a sun.
vec3 find_sky(vec3 origin, vec3 direction)
{
    vec3 radiance = sky_radiance(direction);
    for (uint i = 0u; i < control.lights && !are_of_paths(); i++) {
        Light sun = find_light(i);
        if (!is_positional(sun))
            radiance += sun_radiance(direction, sun.vector, sun.color, sun.softness);
    }
    return finite_or_black(through_fog(radiance, let_through(origin.y, direction.y, FARTHEST), true));
}

bool is_visible(uvec4 secondary, uint light)
{
    uint bits = light < 32u ? secondary.x : light < 64u ? secondary.y : secondary.z;
    return (bits >> (light & 31u) & 1u) != 0u;
}

void main()
{
    load_frame();
    krs_prepare();
    HitPoint hit;
    bool  hits = find_own_hit(hit);
    direct = scattered = mirrored = own = vec4(0.0);
    vec3 weight = vec3(1.0);
#ifdef MIRRORS
    next_origin = next_direction = next_weight = vec4(0.0);
    if (!has_ray())
        return;
    if (are_of_paths())
        weight = load_path(PATH_WEIGHT, 0u).xyz;
#endif
    float counted = are_of_paths() ? 0.0 : 1.0;
    if (!hits) {
        vec3  origin, direction;
        float base, slope;
        find_ray(own_point(), origin, direction, base, slope);
        direct = vec4(weight * find_sky(origin, direction), counted);
        return;
    }
    vec4  facing = texelFetch(facings, ivec2(gl_FragCoord.xy), 0);
    uvec4 secondary = texelFetch(secondaries, ivec2(gl_FragCoord.xy), 0);
    float occluder = uintBitsToFloat(secondary.w);
    vec2  square = sample_square(own_pixel(), control.ray, 0u, control.seed);
    vec3  over = find_hemisphere_ray(facing.xyz, disc_of_square(square));
    // First the material of what closes the sky, then that of the hit: in a loop, so that it is compiled once.
    KrsSurface surface;
    float albedo = 0.0;
    for (uint i = occluder > 0.0 ? 0u : 1u; i < 2u; i++) {
        bool closes = i == 0u;
#ifdef KRS_VIEW
        krs_view = closes ? over : hit.direction;
#endif
        vec3 raised = hit.position + LIFT_OF_OCCLUSION * hit.near * facing.xyz;
        surface = krs_surface(closes ? raised + occluder * over : hit.position,
                              closes ? -over : hit.side * facing.xyz, closes ? FOOTPRINT * occluder : 0.5 * hit.width);
        if (closes)
            albedo = luminance(clamp(surface.color, 0.0, 1.0));
    }
#ifdef SUBSURFACE
    surface.color = color_below(surface);
    surface.subsurface_weight = 0.0;
#endif
#ifdef MIRRORS
    prepare_boundary(hit, 0.0, facing.xyz);
    Boundary boundary = find_boundary(hit, surface);
#endif
    Coat coat = find_coat(hit, surface, facing.w);
    vec3 light = saturate(vec4(surface.emission, 0.0), BRIGHTEST).rgb, glassy = vec3(1.0);
    for (uint i = 0u; i < control.lights; i++)
        light += direct_light(find_light(i), hit, coat, facing.xyz, is_visible(secondary, i) ? 1.0 : 0.0);
    float t = texelFetch(ends, ivec2(gl_FragCoord.xy), 0).x;
    float left = let_through(hit.position.y - t * hit.direction.y, hit.direction.y, t);
#ifdef MIRRORS
    if (are_of_paths()) {
        light += ambient_of(coat, vec3(1.0), 1.0);
        weight *= find_left(boundary, t);
    }
    glassy *= hit.side < 0.0 ? 1.0 - find_glass(surface) : 1.0;
    send_on(hit, surface, boundary, coat, facing, weight * left);
#endif
    direct = vec4(weight * finite_or_black(through_fog(glassy * light, left, true)), counted);
    if (are_of_paths())
        return;
    scattered.rgb = finite_or_black(left * glassy * ambient_of(coat, vec3(1.0), 0.0));
    mirrored.rgb = finite_or_black(left * glassy * ambient_of(coat, vec3(0.0), 1.0));
    float sent = luminance(scattered.rgb + mirrored.rgb);
    scattered.a = occluder > 0.0 ? 0.0 : sent;
    mirrored.a = sent * albedo;
    own = sent * vec4(coat.color, 1.0);
}
