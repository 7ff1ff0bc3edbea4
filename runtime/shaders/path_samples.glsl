/*
 * path_samples.glsl: points of the unit square for the choices along paths.
 *
 * Each choice of each pixel has its own sequence: the (0, 2)-sequence of Sobol, in an order and with
 * digits that are scrambled as Owen did, by hashes (Burley 2020).  So any number of rays of a pixel
 * fills the square evenly, and pixels are independent.
 */
#include "sines.glsl"
#include "samples.glsl"

const float BELOW_1 = 0.99999994; // the largest number below it

// Chooses by the first coordinate of a point: whether it lies in a part of [0, 1).  If it does, the part
// is stretched to all of it.  So the points of all rays that choose the same still fill the square evenly.
bool take_part(inout vec2 point, float low, float high)
{
    if (point.x < low || point.x >= high)
        return false;
    point.x = min((point.x - low) / (high - low), BELOW_1);
    return true;
}

// Returns the bits of a number, scrambled from the highest to the lowest.
uint scramble_reversed(uint bits, uint seed)
{
    return bitfieldReverse(scramble_bits(bitfieldReverse(bits), seed));
}

// Returns the point for ray `ray` of a pixel and one of its choices, which are numbered.
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
