/*
 * layers.glsl: how previews see materials that are more than a body and a mirror: coats, sheen, and
 * mirrors that are stronger or weaker than usual.
 *
 * What a lamp's light becomes is that which paths find (bsdf.glsl).  The sky's light is taken to be
 * the same for each layer, times what the layer sends back of light from all sides.
 */
#include "bsdf.glsl"

struct Layers {
    Axes  axes;
    Bsdf  bsdf;
    float roughness, coat_roughness; // with what varies within the pixel
    vec3  body;                      // what the body scatters
#ifdef ANISOTROPIC
    vec3 bent; // a normal by which the sky is mirrored
#endif
};

#ifdef ANISOTROPIC
// Bends a normal.  What a surface mirrors that is rougher along its tangent is drawn out into a fan
// of directions.  Its middle is that of a surface whose normal leans to the eye, along the tangent
// (McAuley 2015).
vec3 bend_normal(Axes axes, vec3 toward_eye, KrsSurface surface)
{
    vec3  leaning = toward_eye - dot(toward_eye, axes.up) * axes.up;
    float part = surface.specular_roughness_anisotropy * min(5.0 * surface.roughness, 1.0);
    vec3  bent = mix(axes.normal, leaning / max(length(leaning), 1e-3), 0.5 * part);
    return bent / max(length(bent), 1e-3);
}
#endif

// Finds the layers; `glass`: the part of the body that scatters nothing.
Layers find_layers(KrsSurface surface, bool entering, vec3 normal, vec3 toward_eye, float glass)
{
    Layers layers;
    surface = within_limits(surface);
    surface.transmission = 0.0;
    surface.color *= 1.0 - glass;
    layers.axes = find_axes(normal, surface.tangent);
    layers.bsdf = make_bsdf(surface, entering, into(layers.axes, toward_eye));
    layers.roughness = surface.roughness;
    layers.coat_roughness = surface.coat_roughness;
#ifdef ANISOTROPIC
    layers.bent = bend_normal(layers.axes, toward_eye, surface);
#endif
    layers.body = layers.bsdf.under_coat * (1.0 - layers.bsdf.metallic) * layers.bsdf.diffuse *
                  surface.color;
    return layers;
}

// Returns reflectance times cosine.
vec3 reflected_by_layers(Layers layers, vec3 toward_light)
{
    return scatter(layers.bsdf, into(layers.axes, toward_light)).rgb;
}

// Returns what rays that go on find of it: the parts of the body's mirror, and of the coat's, that
// they are `traced` for.
vec3 traced_by_layers(Layers layers, vec2 traced)
{
    return layers.bsdf.under_sheen * layers.bsdf.coated * traced.y +
           layers.bsdf.under_coat * layers.bsdf.mirrored * traced.x;
}

// Returns the light of the sky: `to_body` and `to_mirrors` are the parts that reach the body and
// what mirrors.
vec3 ambient_of_layers(Layers layers, vec3 toward_eye, vec3 normal, vec3 to_body, float to_mirrors,
                       vec2 traced)
{
    Bsdf bsdf = layers.bsdf;
    vec3 around = find_sky_around(normal);
#ifdef ANISOTROPIC
    vec3 body = find_sky_mirrored(layers.bent, toward_eye, layers.roughness);
#else
    vec3 body = find_sky_mirrored(layers.axes.normal, toward_eye, layers.roughness);
#endif
    vec3 coat = find_sky_mirrored(layers.axes.normal, toward_eye, layers.coat_roughness);
    vec3 mirrored = bsdf.under_sheen * bsdf.coated * (1.0 - traced.y) * coat +
                    bsdf.under_coat * bsdf.mirrored * (1.0 - traced.x) * body;
    return layers.body * around * to_body +
           (bsdf.sheen * bsdf.fuzzy * around + mirrored) * to_mirrors;
}
