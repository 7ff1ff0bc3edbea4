#version 440
#extension GL_GOOGLE_include_directive : enable
#extension GL_EXT_control_flow_attributes : enable
/*
 * shade.comp: finds the material of each hit, and the light that it sends along its ray.  That is
 * emitted light, light of the sky, and that of LIGHTS_AT_ONCE lights.  All of it is added to the
 * pixel.
 *
 * MIRRORS: what smooth surfaces mirror is found by rays, and glass lets them through.  The hits are
 * those of the camera's rays or of these (MIXED_RAYS).
 *
 * LAYERS: materials have coats, sheen, or mirrors other than usual.
 *
 * CATCHES: a plate catches shadows.  Its light is added to rows of results of its own.
 */
#include "scene.glsl"
#include "frame.glsl"
#include "hit_lists.glsl"
#include "light.glsl"
#include "results.glsl"
#include "aovs.glsl"
#include "sky_means.glsl"
#include "light_types.glsl"
#include "optics.glsl"
#include "openness.glsl"
#ifdef MIRRORS
#include "mirrors.glsl"
#endif
#ifdef LAYERS
#include "layers.glsl"
#endif
#ifdef MEDIA
#include "tints.glsl"
#endif
#ifdef CATCHES
#include "discs.glsl"
#include "plate.glsl"
#endif

#include "coat.glsl"

// The most light that a hit emits: sums over rays are still finite.
const float BRIGHTEST = 1e30;

#ifdef MIRRORS
// Stores the path that goes on, and lists it.
void follow_onward(HitPoint hit, uint index, Onward onward, vec4 facing, vec3 weight, float spread)
{
    bool leaves = dot(onward.direction, facing.xyz) * onward.side > 0.0;
    if (leaves && largest(weight) >= MIN_WEIGHT) {
        vec3 direction = normalize(onward.direction);
        vec3 start = find_start(hit, direction, facing, onward.side, 0.0);
        store_path(PATH_ORIGIN, index, vec4(start, hit.width));
        store_path(PATH_DIRECTION, index, vec4(direction, spread));
        store_path(PATH_WEIGHT, index, vec4(min(weight, 1e30), 1.0));
        store_path(PATH_TOWARD, index, vec4(0.0, 0.0, 0.0, onward.code));
        store_path(PATH_SURFACE, index, vec4(hit.position, onward.code));
        tiles[atomicAdd(counts.tiles, 1u)] = hit.slot;
    }
}

// Follows what the surface mirrors or lets through.  `weight` is that of the ray that hit it.
void send_on(HitPoint hit, uint index, KrsSurface surface, Boundary boundary, Coat coat,
             vec4 facing, vec3 weight)
{
#ifdef LAYERS
    vec3 mirrored = traced_by_layers(coat.layers, coat.traced);
#else
    vec3 mirrored = coat.traced.x * coat.mirror.around;
#endif
    Onward onward = find_onward(hit, surface, boundary, coat.normal, mirrored);
    float spread = are_of_paths() ? load_path(PATH_DIRECTION, index).w : frame.pixel_slope;
    if (filters_detail())
        spread += find_widening(hit, facing, onward.side < 0.0, boundary.eta);
    spread += find_lobe(surface);
    follow_onward(hit, index, onward, facing, weight * onward.part, spread);
}
#endif

bool  first;      // this pass adds what is no light of lights, and the planes
uint  rows;       // wanted rows of results
Light lights[LIGHTS_AT_ONCE]; // each lane fetches them once

void begin_group()
{
    krs_prepare();
    lights[0] = find_light(control.light);
    lights[1] = find_light(control.light + 1u);
    lights[2] = find_light(control.light + 2u);
    first = control.light == 0u && control.color_row == ROW_COLORS;
    rows = first ? control.rows : 1u << ROW_COLORS;
}

Openness find_openness(vec4 lighting)
{
    return control.no_occlusion != 0u ? Openness(1.0, 0.0) : unpack_openness(lighting.x);
}

#ifdef CATCHES
// Returns the irradiance over pi by a light at the plate, if nothing is in its way.
vec3 light_on_plate(Light light, HitPoint hit, vec3 normal, out float above)
{
    Disc  disc = find_disc(light, hit);
    vec3  color = light.color, difference = light.vector - hit.position;
    float rise = dot(normal, disc.toward);
    if ((light.kind & LIGHT_POSITIONAL) != 0u)
        color *= find_share(light, -disc.toward) / max(dot(difference, difference), 1e-12);
    above = (light.kind & LIGHT_CASTS_SHADOWS) != 0u ? find_fraction_above(disc, rise) : 1.0;
    return color * max(rise, 0.0) / PI;
}

// Adds the light on the plate, as it is and as it would be without the scene: that of the sky, and of
// the lights of this pass.
void catch_light(HitPoint hit, uint index, vec3 normal, vec4 lighting)
{
    float openness = find_openness(lighting).open;
    vec3  sky = first ? find_sky_around(normal) : vec3(0.0);
    vec3  found = openness * sky, without = sky;
    for (uint i = 0u; i < control.count; i++) {
        float above;
        vec3  light = light_on_plate(lights[i], hit, normal, above);
        bool  casts = (lights[i].kind & LIGHT_CASTS_SHADOWS) != 0u;
        float visible = casts ? i == 0u ? lighting.y : i == 1u ? lighting.z : lighting.w : 1.0;
        without += above * light;
#ifdef MEDIA
        if (visible > 0.0)
            light *= find_tint(lights[i], hit, normal);
#endif
        found += visible * light;
    }
    add_light_to(control.caught, index, finite_or_black(found));
    add_light_to(control.caught + 1u, index, finite_or_black(without));
}
#endif

void shade_item(HitPoint hit)
{
    vec4       facing = load_hit(FACING, hit.slot), lighting = load_hit(LIGHTING, hit.slot);
#ifdef KRS_VIEW // materials see how long the pixel is on the surface
    krs_view = hit.direction;
#endif
#ifdef SURFACES
    krs_slot = hit.slot;
#endif
    uint       index = index_of(pixel_of(hit.slot));
#ifdef MIRRORS
    float code = are_of_paths() ? load_path(PATH_TOWARD, index).w : hit.side;
    prepare_boundary(hit, code, facing.xyz);
#endif
    KrsSurface surface = krs_surface(hit.position, hit.side * facing.xyz, 0.5 * hit.width);
#ifdef SUBSURFACE // light leaves where it has entered
    surface.color = color_below(surface);
    surface.subsurface_weight = 0.0; // layers are not to leave this light to paths
#endif
#ifdef MIRRORS
    Boundary boundary = find_boundary(hit, surface);
    hit.side = boundary.side;
#endif
    Coat       coat = find_coat(hit, surface, facing.w);
    vec4       radiance = vec4(0.0);
    vec3       weight = vec3(1.0);
    Openness   openness = find_openness(lighting);
#ifdef MIRRORS
    if (are_of_paths()) {
        openness = Openness(1.0, 0.0);
        weight = load_path(PATH_WEIGHT, index).xyz;
        weight *= find_left(boundary, find_way(index, hit, find_end(index).t, false));
    }
#endif
    if (first) {
        radiance.rgb = saturate(vec4(surface.emission, 0.0), BRIGHTEST).rgb +
                       ambient(coat, openness);
        radiance.a = 1.0;
    }
    uint end = control.light + control.count;
    vec3 visible = lighting.yzw;
    uint i = control.light;
    Light now = lights[0], next = lights[1];
    do { // do-while, as in pixels.glsl
        vec3 light = direct_light(now, hit, coat, facing.xyz, visible.x);
#ifdef MEDIA
        if (i < end && largest(light) > 0.0)
            light *= find_tint(now, hit, facing.xyz);
#endif
        radiance.rgb += i < end ? light : vec3(0.0);
        visible = visible.yzx;
        now = next;
        next = lights[2];
        i++;
    } while (i < end);
#ifdef MIRRORS // glass mirrors no light to those inside of it
    radiance.rgb *= hit.side < 0.0 ? 1.0 - find_glass(surface) : 1.0;
#endif
    float t = find_end(index).t;
    float left = let_through(hit.position.y - t * hit.direction.y, hit.direction.y, t);
    radiance.rgb = weight * through_fog(radiance.rgb, left, first);
#ifdef MIRRORS
    if (control.phase == PATHS_GO_ON && end >= control.lights)
        send_on(hit, index, surface, boundary, coat, facing, weight * left);
#endif
    vec3 added = clamped(finite_or_black(radiance.rgb));
    vec4 sum = find_color(index) + vec4(added, radiance.a);
    vec3 albedo = saturate(vec4(surface.color, 0.0), 1.0).rgb; // also where glass has no coat
    if (are_of_paths())
        add_light(index, added);
    else
        store_aovs(index, rows, sum, hit, hit.side * coat.normal, albedo, surface);
}

void do_item(uint number)
{
    HitPoint hit = find_hit_point(number);
#ifdef CATCHES
    uint index = index_of(pixel_of(hit.slot));
    if (!are_of_paths() && is_of_plate(find_end(index))) {
        catch_light(hit, index, load_hit(FACING, hit.slot).xyz, load_hit(LIGHTING, hit.slot));
        return;
    }
#endif
    shade_item(hit);
}

#include "pixels.glsl"
