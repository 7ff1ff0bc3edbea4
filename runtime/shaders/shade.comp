#version 440
#extension GL_GOOGLE_include_directive : enable
/*
 * shade.comp: what is at each hit, and the light that it sends along its ray: its own, that of the
 * sky, and of some lights at once.  All of it becomes the pixel's.
 */
#include "scene.glsl"
#include "frame.glsl"
#include "hit_lists.glsl"
#include "light.glsl"
#include "results.glsl"

const float EVEN = 0.98;              // less is not a curved surface's own, but detail
const float LEAST_NORMAL_REACH = 0.5; // without filtering (normal_reach in job.c)
const float SEEN = 0.78;              // the mean of the normals that are seen of a thin round thing

// A sum of rays of such light is still a number.
const float BRIGHTEST = 1e30;

// What reflects light.
struct Coat {
    vec3  color, normal; // the latter is the direction of the mean of the normals,
    float mean_length;   // and this its length
    float roughness, metallic;
    vec3  toward_eye;
};

// Within 0 and most; what is not a number is 0.
vec4 saturate(vec4 numbers, float most)
{
    return mix(vec4(0.0), min(numbers, most), greaterThan(numbers, vec4(0.0)));
}

// The mean of the normals that the pixel sees, not a unit vector, where the mean of all around is
// this share of a unit normal.  Of what is thin only the side towards the eye is seen.
vec3 mean_normal(vec3 normal, float mean_length, vec3 toward_eye)
{
    float rest = 1.0 - mean_length;
    return mean_length * normal + SEEN * rest * rest * toward_eye;
}

// Normals that vary within the pixel make the coat rougher: the shorter their mean, the wider
// their lobe (Toksvig 2005).
float roughen(float roughness, float mean_length)
{
    float square = roughness * roughness;
    float spread = 2.0 * (1.0 - mean_length) / max(mean_length, 1e-3);
    return sqrt(sqrt(min(square * square + spread, 1.0)));
}

Coat find_coat(HitPoint hit, KrsSurface surface, float evenness)
{
    float mean_length = frame.normal_reach > LEAST_NORMAL_REACH ? min(evenness / EVEN, 1.0) : 1.0;
    vec3  mean = mean_normal(hit.side * surface.normal, mean_length, -hit.direction);
    vec4  coat = saturate(vec4(surface.color, surface.roughness), 1.0);
    float size = length(mean);
    return Coat(coat.rgb, mean / max(size, 1e-6), min(size, 1.0), roughen(coat.a, mean_length),
                saturate(vec4(surface.metallic), 1.0).x, -hit.direction);
}

// Scattered light goes with the cosine, and so with the mean of the normals, which is shorter than
// each; what a coat mirrors is as much whatever its roughness.
vec3 mean_color(Coat coat) { return coat.color * mix(coat.mean_length, 1.0, coat.metallic); }

vec3 direct_light(Light light, HitPoint hit, Coat coat, vec3 facing, float visible)
{
    vec3 toward = light.vector, color = light.color;
    if ((light.kind & LIGHT_POSITIONAL) != 0u) {
        vec3  difference = light.vector - hit.position;
        float square = max(dot(difference, difference), 1e-12);
        toward = difference * inversesqrt(square);
        color /= square;
    }
    // Who casts no shadows has not been looked for, but a surface that is turned away is dark.
    if ((light.kind & LIGHT_CASTS_SHADOWS) == 0u)
        visible = dot(facing, toward) > 0.0 ? 1.0 : 0.0;
    return visible * color * reflected(coat.normal, coat.toward_eye, toward, mean_color(coat),
                                       coat.roughness, coat.metallic);
}

// The hemisphere of the sky, as far as it is open; what is closed off by a surface of like
// colour gives some light back.
vec3 ambient(Coat coat, float openness)
{
    vec3 bounce = openness / max(1.0 - coat.color * (1.0 - openness), 0.05);
    vec3 scattered = coat.color * (1.0 - coat.metallic) *
                     sky_light(coat.mean_length * coat.normal) * bounce;
    vec3 mirrored = sky_reflected(coat.normal, coat.toward_eye, coat.color, coat.roughness,
                                  coat.metallic);
    return scattered + mirrored * openness;
}

// What becomes of the pixel of a hit, row by row: whatever is not asked for would take lavapipe as
// long as what is.
void store_results(uint index, uint rows, vec4 color, HitPoint hit, Coat coat, KrsSurface surface)
{
    vec3  difference = hit.position - frame.eye;
    float along = dot(difference, frame.forward.xyz);
    float depth = control.projection == PANORAMA ? length(difference) : along;
#ifdef LISTED_RAYS
    depth = find_end(index).t;
#endif
    uvec3 normal = floatBitsToUint(hit.side * coat.normal);
    do { // as in pixels.glsl
        uint  row = uint(findLSB(rows));
        uvec4 numbers = floatBitsToUint(color);
        if (row == ROW_POSITIONS)
            numbers = floatBitsToUint(vec4(hit.position, depth));
        if (row == ROW_NORMALS)
            numbers = uvec4(normal, surface.component);
        if (row == ROW_ALBEDOS)
            numbers = uvec4(floatBitsToUint(coat.color), surface.level);
        if (row == ROW_COUNTS)
            numbers = uvec4(surface.instance, hit.steps, 0u, 0u);
        results[row * band_pixels() + index] = numbers;
        rows &= rows - 1u;
    } while (rows != 0u);
}

uint  rows;       // of the results
Light lights[LIGHTS_AT_ONCE]; // each lane fetches them once

void begin_group()
{
    krs_prepare();
    lights[0] = find_light(control.light);
    lights[1] = find_light(control.light + 1u);
    lights[2] = find_light(control.light + 2u);
    rows = control.first_ray != 0u && control.light == 0u ? control.rows : 1u << ROW_COLORS;
}

void do_item(uint number)
{
    HitPoint      hit = find_hit_point(number);
    vec4       facing = load_hit(FACING, hit.slot), lighting = load_hit(LIGHTING, hit.slot);
    KrsSurface surface = krs_surface(hit.position, hit.side * facing.xyz, 0.5 * hit.width);
    uint       index = index_of(pixel_of(hit.slot));
    Coat       coat = find_coat(hit, surface, facing.w);
    vec4       radiance = vec4(0.0);
    if (control.light == 0u) {
        radiance.rgb = saturate(vec4(surface.emission, 0.0), BRIGHTEST).rgb +
                       ambient(coat, control.no_occlusion != 0u ? 1.0 : lighting.x);
        radiance.a = 1.0;
    }
    uint end = min(control.light + LIGHTS_AT_ONCE, control.lights);
    vec3 visible = lighting.yzw;
    uint i = control.light;
    Light now = lights[0], next = lights[1];
    do { // as in pixels.glsl
        vec3 light = direct_light(now, hit, coat, facing.xyz, visible.x);
        radiance.rgb += i < end ? light : vec3(0.0);
        visible = visible.yzx;
        now = next;
        next = lights[2];
        i++;
    } while (i < end);
    vec4 sum = find_color(index) + vec4(finite_or_black(radiance.rgb), radiance.a);
    store_results(index, rows, sum, hit, coat, surface);
}

#include "pixels.glsl"
