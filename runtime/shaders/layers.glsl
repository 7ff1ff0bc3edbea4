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
};

// `glass`: the part of the body that scatters nothing.
Layers find_layers(KrsSurface surface, bool entering, vec3 normal, vec3 toward_eye, float glass)
{
    Layers layers;
    surface = within_limits(surface);
    surface.transmission = 0.0;
    surface.color *= 1.0 - glass;
    layers.axes = find_axes(normal);
    layers.bsdf = make_bsdf(surface, entering, into(layers.axes, toward_eye));
    layers.roughness = surface.roughness;
    layers.coat_roughness = surface.coat_roughness;
    layers.body = layers.bsdf.under_coat * (1.0 - layers.bsdf.metallic) * layers.bsdf.diffuse *
                  surface.color;
    return layers;
}

// Reflectance times cosine.
vec3 reflected_by_layers(Layers layers, vec3 toward_light)
{
    return scatter(layers.bsdf, into(layers.axes, toward_light)).rgb;
}

// What rays that go on find of it: the parts of the body's mirror, and of the coat's, that they
// are `traced` for.
vec3 traced_by_layers(Layers layers, vec2 traced)
{
    return layers.bsdf.under_sheen * layers.bsdf.coated * traced.y +
           layers.bsdf.under_coat * layers.bsdf.mirrored * traced.x;
}

// The light of the sky.  `bounce`: the part that reaches the body, with the light between it and
// what occludes it.
vec3 ambient_of_layers(Layers layers, vec3 toward_eye, vec3 normal, float openness, vec3 bounce,
                       vec2 traced)
{
    Bsdf bsdf = layers.bsdf;
    vec3 around = find_sky_around(normal);
    vec3 body = find_sky_mirrored(layers.axes.normal, toward_eye, layers.roughness);
    vec3 coat = find_sky_mirrored(layers.axes.normal, toward_eye, layers.coat_roughness);
    vec3 mirrored = bsdf.under_sheen * bsdf.coated * (1.0 - traced.y) * coat +
                    bsdf.under_coat * bsdf.mirrored * (1.0 - traced.x) * body;
    return layers.body * around * bounce + (bsdf.sheen * bsdf.fuzzy * around + mirrored) * openness;
}
