/*
 * bsdf.glsl: how a surface scatters light: by a coat, sheen, a mirror of microfacets, a body that is
 * diffuse, and glass.
 *
 * Directions are in the frame of the surface: z is its normal, on the side of the ray.  A layer
 * lets through to those below what it does not reflect, so no light appears, and none is lost where
 * nothing absorbs it.  Microfacets follow GGX, with the masking of Smith (Walter et al. 2007, Heitz
 * 2014), and are sampled by their visible normals (Heitz 2018, Dupuy and Benyoub 2023).  What
 * bounces more than once between them is added as Turquin did (2019), by a table of the share that
 * bounces once.  Sheen is that of Estevez and Kulla (2017).
 */

#include "optics.glsl"
#ifdef FILM // a material may have a thin film
#include "thin_film.glsl"
#define PART vec3 // of light, for each colour
#define GLASS_PART vec4 // the same, and their luminance, by which directions are chosen
#else
#define PART float
#define GLASS_PART float
#endif

// The least width of a lobe; at most so much a mirror blurs.
const float MIN_ALPHA = 1e-3;
#ifdef ANISOTROPIC // a material may be rougher along its tangent than across
#include "anisotropy.glsl"
#define WIDTH vec2
const float MIN_TANGENT = 1e-3; // of the part across the normal; a shorter one is none
#else
#define WIDTH float
#endif
const float COAT_HEAD_ON = 0.04; // reflectance of a coat with an index of refraction of 1.5
const float MIN_SHEEN_ROUGHNESS = 0.3;

// ---- the surface, and directions seen from it ----

// Returns a number within its limits; NaN becomes the lower one.
float within(float number, float low, float high) { return number > low ? min(number, high) : low; }

vec3 within(vec3 numbers, float low, float high)
{
    return mix(vec3(low), min(numbers, high), greaterThan(numbers, vec3(low)));
}

KrsSurface within_limits(KrsSurface surface)
{
#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) \
    surface.name = within(surface.name, low, high);
#include "krs/surface.def"
    return surface;
}

struct Axes {
    vec3 right, up, normal;
};

// Finds the axes of a surface.  With ANISOTROPIC the first axis is the tangent; it is no unit
// vector, nor across the normal.
Axes find_axes(vec3 normal, vec3 tangent)
{
    Axes axes;
    axes.normal = normal;
    find_frame(normal, axes.right, axes.up);
#ifdef ANISOTROPIC
    vec3  along = tangent - dot(tangent, normal) * normal;
    float size = length(along);
    if (size > MIN_TANGENT) {
        axes.right = along / size;
        axes.up = cross(normal, axes.right);
    }
#endif
    return axes;
}

vec3 into(Axes axes, vec3 v)
{
    return vec3(dot(v, axes.right), dot(v, axes.up), dot(v, axes.normal));
}

vec3 out_of(Axes axes, vec3 v) { return v.x * axes.right + v.y * axes.up + v.z * axes.normal; }

// ---- what is known of a surface that an eye sees ----

struct Bsdf {
    vec3  color;
    float metallic;
    WIDTH alpha;
    float head_on, grazing;   // reflectance of the body's mirror, where it is no metal
    float eta;                // index of refraction on the far side, relative to this one
    float glass;              // share of the body that is glass, and no metal
    float coat;
    WIDTH coat_alpha;
    vec3  sheen;
    float sheen_alpha;
    // The following members depend on the eye.
    vec3  eye;                // unit, towards it
    float sheen_scale;        // keeps sheen from reflecting more than all
    float fuzzy, coated;      // what sheen that is white sends back, and what the coat does
    vec3  mirrored;           // what the mirrors of body and metal send back
    float under_sheen, under_coat; // what comes through
    float more_of_coat, more_of_body; // light that bounces more than once
    vec3  more_of_metal;
    PART  diffuse;            // what comes through the mirror
#ifdef FILM
    float film, film_thickness, film_ior;
    vec3  film_on_body, film_on_metal; // reflectance of films on them
#endif
#ifdef SUBSURFACE
    float below, upon; // of the diffuse: the part that goes on below the surface, and that does not
    float chance_below; // probability of following the former
    vec3  entering;     // the part of the eye's light that comes from below
#endif
    vec4  shares;             // probabilities of sampling coat, mirror, glass, and the diffuse
};

vec3 load_albedo(uint number) { return uintBitsToFloat(load_input(number).xyz); }

// Returns light that microfacets reflect: all, the part by Schlick's factor, and sheen, whose rows
// begin at its least roughness.
vec3 find_albedo(float cosine, float roughness)
{
    vec2  at = clamp(vec2(sqrt(cosine), roughness), 0.0, 1.0) * float(ALBEDO_SIDE - 1u);
    uvec2 cell = min(uvec2(at), uvec2(ALBEDO_SIDE - 2u));
    vec2  part = at - vec2(cell);
    uint  low = cell.y * ALBEDO_SIDE + cell.x, high = low + ALBEDO_SIDE;
    return mix(mix(load_albedo(low), load_albedo(low + 1u), part.x),
               mix(load_albedo(high), load_albedo(high + 1u), part.x), part.y);
}

// ---- microfacets ----

#ifndef ANISOTROPIC
// Returns Smith's function: how much of the microfacets is hidden from a direction.
float find_hidden(vec3 direction, float alpha)
{
    float tangent = dot(direction.xy, direction.xy) / max(square(direction.z), 1e-12);
    return 0.5 * (sqrt(1.0 + alpha * alpha * tangent) - 1.0);
}

// Returns the density of microfacets with a normal (GGX).
float find_density(vec3 normal, float alpha)
{
    float across = dot(normal.xy, normal.xy) / (alpha * alpha) + normal.z * normal.z;
    return 1.0 / (PI * alpha * alpha * across * across);
}
#endif

// Returns the density of normals that are visible from the eye, in solid angle.
float find_visible(vec3 eye, vec3 normal, WIDTH alpha)
{
    return find_density(normal, alpha) * max(dot(eye, normal), 0.0) /
           (eye.z * (1.0 + find_hidden(eye, alpha)));
}

float schlick(float cosine)
{
    float left = clamp(1.0 - cosine, 0.0, 1.0), twice = left * left;
    return twice * twice * left;
}

// Returns reflected light times the cosine, of microfacets that mirror all, and its probability.
vec2 mirror(vec3 eye, vec3 light, WIDTH alpha, out float cosine)
{
    vec3 sum = eye + light;
    vec3 halfway = sum / max(length(sum), 1e-12);
    cosine = clamp(dot(eye, halfway), 0.0, 1.0);
    float density = find_density(halfway, alpha) / (4.0 * eye.z);
    float hidden = find_hidden(eye, alpha);
    return light.z > 0.0
               ? density * vec2(1.0 / (1.0 + hidden + find_hidden(light, alpha)), 1.0 / (1.0 + hidden))
               : vec2(0.0);
}

// ---- glass ----

// The part of light that a microfacet mirrors.
#ifdef FILM
vec4 find_glass_part(Bsdf bsdf, float cosine)
{
    vec3 mirrors = find_film_on_glass(cosine, bsdf.eta, bsdf.film, bsdf.film_thickness,
                                      bsdf.film_ior);
    return vec4(mirrors, luminance(mirrors));
}

float find_mirrored_share(Bsdf bsdf, float cosine) { return find_glass_part(bsdf, cosine).a; }
#else
float find_glass_part(Bsdf bsdf, float cosine) { return fresnel(cosine, bsdf.eta); }

float find_mirrored_share(Bsdf bsdf, float cosine) { return find_glass_part(bsdf, cosine); }
#endif

// Returns the density of light that visible microfacets mirror, or refract, into a direction.
GLASS_PART glass_density(Bsdf bsdf, vec3 light, bool refracts)
{
    vec3  sum = refracts ? bsdf.eye + bsdf.eta * light : bsdf.eye + light;
    float size = max(length(sum), 1e-12);
    vec3  normal = sum / (sum.z < 0.0 ? -size : size);
    float to_eye = dot(bsdf.eye, normal), to_light = dot(light, normal);
    float gap = to_eye + bsdf.eta * to_light;
    float spread = refracts ? square(bsdf.eta) * abs(to_light) / max(gap * gap, 1e-12)
                            : 0.25 / max(to_eye, 1e-6);
    bool  meets = to_eye > 0.0 && (to_light < 0.0) == refracts;
    float density = find_visible(bsdf.eye, normal, bsdf.alpha) * spread;
    GLASS_PART mirrors = find_glass_part(bsdf, clamp(to_eye, 0.0, 1.0));
    return meets ? density * (refracts ? 1.0 - mirrors : mirrors) : GLASS_PART(0.0);
}

// Returns the density of light that glass sends into a direction.  What a microfacet mirrors or
// refracts to the wrong side of the surface is sent to the right one, upside down.  So all light
// leaves, as if it went on between microfacets.
GLASS_PART glass_towards(Bsdf bsdf, vec3 light)
{
    vec3 upside_down = vec3(light.xy, -light.z);
    bool refracts = light.z < 0.0;
    return glass_density(bsdf, light, refracts) + glass_density(bsdf, upside_down, refracts);
}

// ---- sheen ----

float sheen_towards(Bsdf bsdf, vec3 light)
{
    vec3  halfway = normalize(bsdf.eye + light);
    float sine = sqrt(max(1.0 - square(halfway.z), 1e-12));
    float density = (2.0 + 1.0 / bsdf.sheen_alpha) * pow(sine, 1.0 / bsdf.sheen_alpha) / (2.0 * PI);
    float seen = 0.25 / (light.z + bsdf.eye.z - light.z * bsdf.eye.z);
    return bsdf.sheen_scale * density * seen * light.z;
}

// ---- all of it ----

#ifdef FILM
// A film's colour is that in which the eye sees the surface as a whole, so that no light is lost on
// rough ones.  `all`: what microfacets send back that mirror all.
void add_film(inout Bsdf bsdf, KrsSurface surface, float all)
{
    bsdf.film = surface.thin_film_weight;
    bsdf.film_thickness = surface.thin_film_thickness;
    bsdf.film_ior = surface.thin_film_ior;
    if (bsdf.film <= 0.0)
        return;
    vec3 on_body = find_filmed(bsdf.eye.z, bsdf.film_thickness, bsdf.film_ior,
                               ior_of(vec3(bsdf.head_on)));
    vec3 on_metal = find_filmed(bsdf.eye.z, bsdf.film_thickness, bsdf.film_ior, ior_of(bsdf.color));
    float more = (1.0 - all) / all;
    bsdf.film_on_body = on_body * (1.0 + on_body * more);
    bsdf.film_on_metal = on_metal * (1.0 + on_metal * more);
}
#endif

#ifdef SUBSURFACE
// Divides the body's diffuse light: a part of it goes on below the surface.  `shares` are those of all
// that is scattered at the surface.
void share_below(inout Bsdf bsdf, KrsSurface surface, float body, bool enters, inout vec4 shares)
{
    bsdf.below = enters ? surface.subsurface_weight : 0.0;
    bsdf.upon = 1.0 - bsdf.below;
    float diffuse = bsdf.under_coat * body * luminance(bsdf.diffuse);
    float all = diffuse * max(luminance(bsdf.color), 0.05);
    float goes = diffuse * bsdf.below * max(luminance(surface.subsurface_color), 0.05);
    shares.w -= all * bsdf.below;
    bsdf.chance_below = goes / max(goes + dot(shares, vec4(1.0)), 1e-6);
    bsdf.entering = vec3(bsdf.under_coat * body * bsdf.below * bsdf.diffuse);
}
#endif

// Makes a BSDF; `entering`: the ray comes from outside.  The eye's direction may lie below the
// horizon by rounding.
Bsdf make_bsdf(KrsSurface surface, bool entering, vec3 eye)
{
    Bsdf bsdf;
    bsdf.eye = normalize(vec3(eye.xy, max(abs(eye.z), 1e-3)));
    bsdf.color = surface.color;
    bsdf.metallic = surface.metallic;
#ifdef ANISOTROPIC
    bsdf.alpha = find_widths(surface.roughness, surface.specular_roughness_anisotropy);
#else
    bsdf.alpha = max(square(surface.roughness), MIN_ALPHA);
#endif
    bsdf.coat = entering ? surface.coat : 0.0;
    bsdf.coat_alpha = WIDTH(max(square(surface.coat_roughness), MIN_ALPHA));
    bsdf.sheen = entering ? surface.sheen : vec3(0.0);
    float ior = max(surface.ior, 1.001);
    bsdf.eta = entering ? ior : 1.0 / ior;
    bsdf.head_on = surface.specular * square((ior - 1.0) / (ior + 1.0));
    bsdf.grazing = surface.specular;
    bsdf.glass = (1.0 - surface.metallic) * surface.transmission;

    float fuzz = max(surface.sheen_roughness, MIN_SHEEN_ROUGHNESS);
    bsdf.sheen_alpha = square(fuzz);
    float row = (fuzz - MIN_SHEEN_ROUGHNESS) / (1.0 - MIN_SHEEN_ROUGHNESS);
    float fuzzy = find_albedo(bsdf.eye.z, row).z;
    bsdf.sheen_scale = 1.0 / max(fuzzy, 1.0);
    bsdf.fuzzy = min(fuzzy, 1.0);
    bsdf.under_sheen = 1.0 - max(max(bsdf.sheen.r, bsdf.sheen.g), bsdf.sheen.b) * bsdf.fuzzy;

    vec2 all = find_albedo(bsdf.eye.z, surface.coat_roughness).xy;
    bsdf.more_of_coat = 1.0 + COAT_HEAD_ON * (1.0 - all.x) / all.x;
    bsdf.coated = bsdf.coat * bsdf.more_of_coat * (COAT_HEAD_ON * (all.x - all.y) + all.y);
    bsdf.under_coat = bsdf.under_sheen * (1.0 - bsdf.coated);

#ifdef ANISOTROPIC
    all = find_wide_albedo(bsdf.eye, surface.roughness, surface.specular_roughness_anisotropy);
#else
    all = find_albedo(bsdf.eye.z, surface.roughness).xy;
#endif
    float lost = (1.0 - all.x) / all.x;
    bsdf.more_of_body = 1.0 + bsdf.head_on * lost;
    bsdf.more_of_metal = 1.0 + bsdf.color * lost;
    PART mirrored = PART(bsdf.more_of_body *
                         (bsdf.head_on * (all.x - all.y) + bsdf.grazing * all.y));
    vec3 metal = bsdf.metallic * bsdf.more_of_metal * (bsdf.color * (all.x - all.y) + all.y);
#ifdef FILM
    add_film(bsdf, surface, all.x);
    mirrored = mix(mirrored, bsdf.film_on_body * all.x, bsdf.film);
    metal = mix(metal, bsdf.metallic * bsdf.film_on_metal * all.x, bsdf.film);
#endif
    bsdf.diffuse = 1.0 - mirrored;

    float body = (1.0 - bsdf.metallic) * (1.0 - surface.transmission);
    vec4  shares;
    bsdf.mirrored = metal + body * mirrored;
    shares.x = bsdf.under_sheen * bsdf.coated;
    shares.y = bsdf.under_coat * luminance(bsdf.mirrored);
    shares.z = bsdf.under_coat * bsdf.glass;
    shares.w = luminance(bsdf.sheen) * bsdf.fuzzy +
               bsdf.under_coat * body * luminance(bsdf.diffuse) * max(luminance(bsdf.color), 0.05);
#ifdef SUBSURFACE
    share_below(bsdf, surface, body, entering, shares);
#endif
    bsdf.shares = shares / max(dot(shares, vec4(1.0)), 1e-6);
    return bsdf;
}

// Returns light from a direction that goes to the eye, times the cosine; and the probability
// density of sampling that direction.
vec4 scatter(Bsdf bsdf, vec3 light)
{
    GLASS_PART glass = GLASS_PART(0.0);
    if (bsdf.glass > 0.0)
        glass = bsdf.glass * glass_towards(bsdf, light);
#ifdef FILM
    vec3  through = glass.rgb;
    float by_glass = glass.a;
#else
    float through = glass, by_glass = glass;
#endif
    vec3  sum = bsdf.under_coat * through * (light.z < 0.0 ? bsdf.color : vec3(1.0));
    float density = bsdf.glass > 0.0 ? bsdf.shares.z * by_glass / bsdf.glass : 0.0;
    if (light.z > 0.0) {
        float facing;
        vec2  coat = mirror(bsdf.eye, light, bsdf.coat_alpha, facing);
        float edge = COAT_HEAD_ON + (1.0 - COAT_HEAD_ON) * schlick(facing);
        sum += bsdf.under_sheen * bsdf.coat * bsdf.more_of_coat * edge * coat.x;
        vec2  all = mirror(bsdf.eye, light, bsdf.alpha, facing);
        float body = (1.0 - bsdf.metallic) - bsdf.glass;
        edge = bsdf.head_on + (bsdf.grazing - bsdf.head_on) * schlick(facing);
        PART of_body = PART(body * bsdf.more_of_body * edge);
        vec3 metal = bsdf.color + (1.0 - bsdf.color) * schlick(facing);
        metal *= bsdf.metallic * bsdf.more_of_metal;
#ifdef FILM
        of_body = mix(of_body, body * bsdf.film_on_body, bsdf.film);
        metal = mix(metal, bsdf.metallic * bsdf.film_on_metal, bsdf.film);
#endif
        sum += bsdf.under_coat * all.x * (metal + of_body);
#ifdef SUBSURFACE
        body *= bsdf.upon;
#endif
        sum += bsdf.under_coat * body * bsdf.diffuse * bsdf.color * (light.z / PI);
        sum += bsdf.sheen * sheen_towards(bsdf, light);
        density += bsdf.shares.x * coat.y + bsdf.shares.y * all.y + bsdf.shares.w * light.z / PI;
    }
    return vec4(sum, density);
}

#ifdef CATCHES
// Makes what the surface of a plate mirrors, and nothing else, in place of a surface within limits.
Bsdf make_glossy(KrsSurface surface, float roughness, float head_on, vec3 eye)
{
#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) \
    surface.name *= 0.0;
#include "krs/surface.def"
    float root = sqrt(head_on);
    surface.ior = (1.0 + root) / (1.0 - root);
    surface.specular = 1.0;
    surface.roughness = roughness;
    Bsdf bsdf = make_bsdf(surface, true, eye);
    bsdf.shares = vec4(0.0, 1.0, 0.0, 0.0);
    return bsdf;
}
#endif

// Makes a dull white surface in place of another: the plate, and where light leaves from below a
// surface.
Bsdf make_dull(Bsdf bsdf)
{
    bsdf.color = vec3(1.0);
    bsdf.metallic = bsdf.glass = bsdf.coat = bsdf.head_on = bsdf.grazing = 0.0;
    bsdf.sheen = vec3(0.0);
    bsdf.under_coat = bsdf.under_sheen = 1.0;
#ifdef SUBSURFACE
    bsdf.upon = 1.0;
#endif
    bsdf.diffuse = PART(1.0);
#ifdef FILM
    bsdf.film = 0.0;
#endif
    bsdf.shares = vec4(0.0, 0.0, 0.0, 1.0);
    return bsdf;
}
