/*
 * results.glsl: the results of each pixel, in rows of four numbers: the colours of all pixels of
 * the band, then their positions, and so on.  The rows are in runtime/shared/blocks.h.  Rows that
 * are not wanted are not written.  The first ray of a pixel goes through its centre, and gives all
 * results but the colour.
 */
#include "optics.glsl"

#ifdef NO_TEXELS
layout(std430, set = 1, binding = RESULTS_BINDING) buffer Results { uvec4 results[]; };
uvec4 load_result(uint number) { return results[number]; }
#else
layout(std430, set = 1, binding = RESULTS_BINDING) writeonly buffer Results { uvec4 results[]; };
// Bits of floats.
layout(set = 1, binding = RESULT_TEXELS_BINDING) uniform usamplerBuffer result_texels;
uvec4 load_result(uint number) { return texelFetch(result_texels, int(number)); }
#endif

// Stores a colour, and leaves alpha as it is: number by number, as all four are written else.
void store_color(uint number, vec3 color)
{
    results[number].x = floatBitsToUint(color.r);
    results[number].y = floatBitsToUint(color.g);
    results[number].z = floatBitsToUint(color.b);
}

bool is_wanted(uint row) { return (control.rows >> row & 1u) != 0u; }

vec4 load_color(uint row, uint index)
{
    return uintBitsToFloat(load_result(row * band_pixels() + index));
}

// Returns the colour of a pixel, or its light of a light.
vec4 find_color(uint index) { return load_color(control.color_row, index); }

// Adds light to a row of a pixel; alpha stays as it is.
void add_light_to(uint row, uint index, vec3 color)
{
    store_color(row * band_pixels() + index, load_color(row, index).rgb + color);
}

void add_light(uint index, vec3 color) { add_light_to(control.color_row, index, color); }

// Returns the factor by which light must be multiplied so that none of its components exceeds the
// limit of a ray; 1 where none does.
float clamp_factor(vec3 radiance)
{
    float most = max(max(radiance.r, radiance.g), radiance.b);
    return most > control.max_radiance ? control.max_radiance / most : 1.0;
}

// Returns the same light, within that limit; counts where it was beyond.
vec3 clamped(vec3 radiance)
{
    float factor = clamp_factor(radiance);
    if (factor < 1.0)
        atomicAdd(counts.clamped, 1u);
    return factor * radiance;
}
