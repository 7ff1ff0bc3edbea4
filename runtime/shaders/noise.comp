#version 440
#extension GL_GOOGLE_include_directive : enable
/*
 * noise.comp: estimates the error of each pixel's colour, and ends the samples of those where it is
 * small.
 *
 * The estimate comes from the means of the first and of the second half of the samples so far.  Half
 * their difference is as large as the error of the mean of all, since samples fill a pixel evenly:
 * the difference of single samples would tell more.  One such difference may be small by chance, so
 * the variance is the mean of this one and of the last estimate, which had half as many samples.
 *
 * A pixel goes on as well where the mean over its quarter of a tile is too noisy: what a neighbour
 * has found, its own rays may have missed so far.
 *
 * What a pixel was when it ended is kept in ROW_EARLIER.  So passes may go on to add light to it,
 * which is forgotten in the end.
 *
 * An item is a quarter of a tile of 8x8 pixels.
 */
#include "frame.glsl"
#include "hit_lists.glsl"
#include "results.glsl"

void begin_group() {}

vec4 load_earlier(uint index)
{
    return uintBitsToFloat(load_result(ROW_EARLIER * band_pixels() + index));
}

void store_earlier(uint index, vec4 numbers)
{
    results[ROW_EARLIER * band_pixels() + index] = floatBitsToUint(numbers);
}

uvec4 load_noise(uint index) { return load_result(ROW_NOISE * band_pixels() + index); }

// Returns the sums of which the error is estimated.  Light on a plate counts as on a white surface.
vec3 find_sum(uint index)
{
    vec3 caught = control.caught != 0u ? load_color(control.caught, index).rgb : vec3(0.0);
    if (control.plate_reflectance > 0.0)
        caught += load_color(control.caught + CAUGHT_ROWS, index).rgb;
    return find_color(index).rgb + caught;
}

float mean_of(vec3 v) { return (v.x + v.y + v.z) / 3.0; }

// Estimates the error of a pixel.  `count`: its samples so far, which have doubled.
float find_error(uint index, float count)
{
    vec4  earlier = load_earlier(index);
    vec3  sum = find_sum(index), difference = (sum - 2.0 * earlier.rgb) / count;
    float variance = mean_of(difference * difference);
    if (uint(count) > 2u * FIRST_NOISE_SAMPLES)
        variance = 0.5 * variance + 0.25 * earlier.w;
    store_earlier(index, vec4(sum, variance));
    return sqrt(variance) / (mean_of(sum) / count + control.noise_floor);
}

// Ends the samples of a pixel.
void end_samples(uint index, float error)
{
    store_earlier(index, find_color(index));
    results[ROW_NOISE * band_pixels() + index] =
        uvec4(floatBitsToUint(error), control.value, 0u, 0u);
}

// Returns the bits of the pixels of a quarter that go on, among `exist`.
uint find_unended(uvec2 corner, uint exist)
{
    uint sampled = 0u;
    for (uint left = exist; left != 0u; left &= left - 1u) {
        uint number = uint(findLSB(left));
        uint index = index_of(corner + uvec2(number & 3u, number >> 2u));
        sampled |= uint(load_noise(index).y == 0u) << number;
    }
    return sampled;
}

// Estimates errors of the pixels of a quarter; returns the bits of those that go on.
uint check_quarter(uvec2 corner, uint exist, uint sampled)
{
    float squares = 0.0, count = float(control.value), errors[16];
    for (uint left = exist; left != 0u; left &= left - 1u) {
        uint number = uint(findLSB(left));
        uint index = index_of(corner + uvec2(number & 3u, number >> 2u));
        bool goes_on = (sampled >> number & 1u) != 0u;
        float error = goes_on ? find_error(index, count) : uintBitsToFloat(load_noise(index).x);
        if (goes_on)
            results[ROW_NOISE * band_pixels() + index] = uvec4(floatBitsToUint(error), 0u, 0u, 0u);
        squares += error * error;
        errors[number] = error;
    }
    bool noisy = squares > control.noise * control.noise * float(bitCount(exist));
    bool all_continue = control.value < MIN_NOISE_SAMPLES || noisy;
    for (uint left = all_continue ? 0u : sampled; left != 0u; left &= left - 1u) {
        uint number = uint(findLSB(left));
        if (errors[number] <= control.noise) {
            end_samples(index_of(corner + uvec2(number & 3u, number >> 2u)), errors[number]);
            sampled &= ~(1u << number);
        }
    }
    return sampled;
}

// Gives pixels that have ended their colours back.
void restore_quarter(uvec2 corner, uint exist)
{
    for (uint left = exist; left != 0u; left &= left - 1u) {
        uint number = uint(findLSB(left));
        uint index = index_of(corner + uvec2(number & 3u, number >> 2u));
        if (load_noise(index).y != 0u)
            results[ROW_COLORS * band_pixels() + index] = floatBitsToUint(load_earlier(index));
    }
}

// Keeps the sums of the pixels of a quarter.
void begin_quarter(uvec2 corner, uint exist)
{
    for (uint left = exist; left != 0u; left &= left - 1u) {
        uint number = uint(findLSB(left));
        uint index = index_of(corner + uvec2(number & 3u, number >> 2u));
        store_earlier(index, vec4(find_sum(index), 0.0));
    }
}

// Tells whether a pixel goes on in a tile or next to it: passes share what they find with neighbours.
bool is_near_sampled(uint tile)
{
    uvec2 count = (work.extent + 7u) / 8u, cell = find_cell(tile, count.x);
    uint  any = 0u;
    for (uint i = 0u; i < 9u; i++) {
        uvec2 near = cell + uvec2(i % 3u, i / 3u); // one more to the right and below
        bool  inside = all(greaterThan(near, uvec2(0u))) && all(lessThanEqual(near, count));
        uint  at = inside ? 4u * ((near.y - 1u) * count.x + near.x - 1u) : 0u;
        for (uint k = 0u; k < 4u && inside; k++)
            any |= tiles[control.sampled_at + at + k];
    }
    return any != 0u;
}

void do_item(uint quarter)
{
    uvec2 corner = pixel_of(slot_of_quarter(quarter));
    uint  exist = find_existing(corner);
    if (control.phase == NOISE_BEGINS)
        begin_quarter(corner, exist);
    if (control.phase == NOISE_RESTORES)
        restore_quarter(corner, exist);
    if (control.phase == NOISE_SPREADS)
        tiles[control.sampled_at + 4u * count_tiles() + quarter] = is_near_sampled(quarter / 4u)
                                                                       ? exist
                                                                       : 0u;
    if (control.phase == NOISE_ENDS_SAMPLES || control.phase == NOISE_LISTS) {
        uint sampled = find_unended(corner, exist);
        if (control.phase == NOISE_ENDS_SAMPLES)
            sampled = check_quarter(corner, exist, sampled);
        tiles[control.sampled_at + quarter] = sampled;
        if (sampled != 0u)
            atomicAdd(counts.sampled, bitCount(sampled));
    }
}

#include "pixels.glsl"
