/*
 * openness.glsl: how open a hit is to the sky, and what gives light back where it is not.
 */
#include "optics.glsl"

// The part of the hemisphere, by the cosine, that is open; and the mean albedo of what closes the
// rest.
struct Openness {
    float open, albedo;
};

// Both in a number, with twelve bits each.
const float OPEN_STEPS = 4095.0;

float pack_openness(Openness of) { return floor(of.open * OPEN_STEPS + 0.5) + 0.5 * of.albedo; }

Openness unpack_openness(float number)
{
    return Openness(floor(number) / OPEN_STEPS, 2.0 * fract(number));
}

// Returns the light that reaches the hit, relative to that of the open sky.  As much reaches the
// occluders, and they send the part `albedo` of it back, again and again.
vec3 with_bounces(float open, vec3 albedo)
{
    return open / max(1.0 - albedo * (1.0 - open), 0.05);
}

// Returns a guess at the colour of occluders, of which only the mean brightness is known: that of
// the surface, darkened or whitened.
vec3 guess_color(vec3 own, float albedo)
{
    float lum = luminance(own);
    vec3  darker = own * (albedo / max(lum, 1e-6));
    vec3  lighter = mix(own, vec3(1.0), (albedo - lum) / max(1.0 - lum, 1e-6));
    return albedo < lum ? darker : lighter;
}
