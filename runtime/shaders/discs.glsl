/*
 * discs.glsl: the discs of lights, and how much of one is above a surface's horizon.
 */
#ifndef DISCS // another file may have it already
#define DISCS

#include "sines.glsl"

// Returns the radius of a light's disc; a directional light is at distance 1.
float light_radius(Light light)
{
    bool positional = (light.kind & LIGHT_POSITIONAL) != 0u;
    return max(positional ? light.softness : krs_tan(0.5 * min(light.softness, 3.0)), 0.0);
}

// Returns the fraction of a disc above a line that is `depth` radii below its centre.
float fraction_above(float depth)
{
    float h = clamp(depth, -1.0, 1.0), segment_height = 1.0 - abs(h);
    // The segment's area over pi: its height^1.5 times a polynomial with an error of 5e-4.
    float segment = segment_height * sqrt(segment_height) * (0.607 - 0.107 * segment_height);
    return h < 0.0 ? segment : 1.0 - segment;
}

// The disc of a light as a hit sees it.
struct Disc {
    vec3  toward; // unit vector to its centre
    float spread; // its radius at distance 1
};

Disc find_disc(Light light, HitPoint hit)
{
    bool  positional = (light.kind & LIGHT_POSITIONAL) != 0u;
    vec3  toward = positional ? light.vector - hit.position : light.vector;
    float light_distance = max(length(toward), 1e-30);
    return Disc(toward / light_distance, light_radius(light) / light_distance);
}

// Returns the fraction of the disc in front of the surface; `rise`: cosine between normal and
// direction.
float find_fraction_above(Disc disc, float rise)
{
    float across = sqrt(max(1.0 - rise * rise, 0.0));
    return disc.spread > 0.0 ? fraction_above(rise / max(disc.spread * across, 1e-30))
                             : float(rise > 0.0);
}
#endif
