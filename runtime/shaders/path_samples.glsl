/*
 * path_samples.glsl: points of the unit square for the choices along paths.
 *
 * Each choice of each pixel has its own sequence: the (0, 2)-sequence of Sobol, in an order and with
 * digits that are scrambled as Owen did, by hashes (Burley 2020).  So any number of rays of a pixel
 * fills the square evenly, and pixels are independent.
 */
#include "sines.glsl"
#include "samples.glsl"

// The bits of a number, scrambled from the highest to the lowest.
uint scramble_reversed(uint bits, uint seed)
{
    return bitfieldReverse(scramble_bits(bitfieldReverse(bits), seed));
}

// The point for ray `ray` of a pixel and one of its choices, which are numbered.
vec2 sample_choice(uvec2 pixel, uint ray, uint choice, uint seed)
{
    uint own = hash_bits(pixel.x + hash_bits(pixel.y + hash_bits(choice + hash_bits(seed))));
    uint number = scramble_reversed(ray, own);
    uint y = number; // Pascal's triangle modulo 2 makes the second dimension
    y ^= (y & 0xaaaaaaaau) >> 1u;
    y ^= (y & 0xccccccccu) >> 2u;
    y ^= (y & 0xf0f0f0f0u) >> 4u;
    y ^= (y & 0xff00ff00u) >> 8u;
    y ^= (y & 0xffff0000u) >> 16u;
    uint x = scramble_reversed(bitfieldReverse(number), hash_bits(own + 1u));
    y = scramble_reversed(bitfieldReverse(y), hash_bits(own + 2u));
    return vec2(x >> 8u, y >> 8u) / 16777216.0;
}
