/*
 * sky_map.glsl: a sky that is a picture of all directions, longitude by latitude.
 *
 * Its middle is towards -z, before it is rotated.  The table of the sky is described in
 * runtime/shared/blocks.h.  A path chooses a direction by the sums, from the whole picture down to a
 * cell: first left or right, then above or below.  So neighbouring points of the unit square choose
 * neighbouring directions (Clarberg et al. 2005).  A cell lies between the middles of four texels,
 * where radiance is bilinear, and so is the density within it.
 */
#include "sines.glsl"
#include "arcs.glsl"
#include "optics.glsl"

#ifdef NO_TEXELS
layout(std430, set = 0, binding = SKY_BINDING) readonly buffer SkyRows { vec4 sky_rows[]; };
vec4 load_sky(uint number) { return sky_rows[number]; }
#else
layout(set = 0, binding = SKY_BINDING) uniform samplerBuffer sky_texels;
vec4 load_sky(uint number) { return texelFetch(sky_texels, int(number)); }
#endif

bool has_sky_map() { return frame.sky_map.x > 0.0; }

uvec2 sky_size() { return uvec2(frame.sky_map.xy); }

// Finds where a direction is on the picture, in parts of its width and height.
vec2 place_on_sky(vec3 direction)
{
    float longitude = krs_atan2(direction.x, -direction.z) + frame.sky_map.z;
    float latitude = krs_atan2(direction.y, length(direction.xz));
    float across = longitude / (2.0 * PI) + 0.5;
    return vec2(across - floor(across), 0.5 - latitude / PI);
}

// Returns the mixture of the four texels around a place, of a picture that begins at a row of the
// table.
vec3 mix_on_sky(uint first, uvec2 size, vec2 place)
{
    vec2  at = place * vec2(size) - 0.5, low = floor(at), part = at - low;
    uint  left = low.x < 0.0 ? size.x - 1u : min(uint(low.x), size.x - 1u);
    uint  right = left + 1u < size.x ? left + 1u : 0u;
    uint  above = uint(max(low.y, 0.0)), below = min(uint(low.y + 1.0), size.y - 1u);
    uint  high_row = first + above * size.x, low_row = first + below * size.x;
    vec3  high = mix(load_sky(high_row + left).rgb, load_sky(high_row + right).rgb, part.x);
    vec3  deep = mix(load_sky(low_row + left).rgb, load_sky(low_row + right).rgb, part.x);
    return frame.sky_map.w * mix(high, deep, part.y);
}

vec3 radiance_on_sky(vec2 place) { return mix_on_sky(SKY_ITSELF, sky_size(), place); }

vec3 sky_map_radiance(vec3 direction) { return radiance_on_sky(place_on_sky(direction)); }

// Returns the mean over the half sky around a normal, weighted by the cosine.
vec3 sky_map_around(vec3 normal)
{
    uint width = SKY_AROUND_WIDTH;
    return mix_on_sky(0u, uvec2(width, width / 2u), place_on_sky(normal));
}

// Returns the means for surfaces that are so rough: 0 is the sky itself, 1 and 2 are for roughness
// 0.1 and 0.2, and so on in steps of 0.2.
vec3 sky_map_level(uint level, vec2 place)
{
    uint width = level == 1u ? SKY_SMOOTHER_WIDTH : level == 2u ? SKY_SMOOTH_WIDTH : SKY_ROUGH_WIDTH;
    uint rough = (2u + SKY_ROUGH_LEVELS - level) * SKY_ROUGH_WIDTH * SKY_ROUGH_WIDTH / 2u;
    uint first = level == 0u   ? SKY_ITSELF
                 : level == 1u ? SKY_SMOOTHER
                 : level == 2u ? SKY_SMOOTH
                               : SKY_ROUGH + rough;
    uvec2 size = level == 0u ? sky_size() : uvec2(width, width / 2u);
    return mix_on_sky(first, size, place);
}

// Returns what a surface mirrors of the sky around a direction.
vec3 sky_map_mirrored(vec3 direction, float roughness)
{
    float level = roughness < 0.2 ? 10.0 * roughness : 1.0 + 5.0 * roughness;
    level = clamp(level, 0.0, 5.999);
    vec2  place = place_on_sky(direction);
    uint  finer = uint(level);
    return mix(sky_map_level(finer, place), sky_map_level(finer + 1u, place), fract(level));
}

// Tells how dense the directions are that are chosen within a cell, relative to those that are even in solid
// angle, at a place of the picture in parts of its height: they are chosen by their latitude.
float crowding_on_sky(float down)
{
    float rows = frame.sky_map.y, line = floor(down * rows + 0.5);
    vec2  edges = PI * clamp(vec2(line - 0.5, line + 0.5), 0.0, rows) / rows;
    float size = edges.y - edges.x, middle = krs_sin(0.5 * (edges.x + edges.y));
    return middle * krs_sin(0.5 * size) / (0.5 * size * max(krs_sin(PI * down), 1e-7));
}

// Returns the probability density with which a direction is chosen, in solid angle: in proportion
// to its luminance.
float sky_map_density(vec3 radiance, vec2 place)
{
    float all = 4.0 * frame.sky_power;
    return luminance(radiance) / max(all, 1e-30) * crowding_on_sky(place.y);
}

// Halves a picture: whether a number of [0, 1) is in the part of `first` of both; it becomes the
// number within its half.
bool is_in_second(float first, float second, inout float number)
{
    float part = first / (first + second);
    bool  beyond = number >= part;
    number = min(beyond ? (number - part) / (1.0 - part) : number / part, 0.9999999);
    return beyond;
}

// Returns a number of [0, 1] with a density that goes from a to b.
float choose_by_line(float a, float b, float number)
{
    float root = sqrt(mix(a * a, b * b, number));
    return a + b > 0.0 ? clamp(number * (a + b) / (a + root), 0.0, 1.0) : number;
}

// Returns the cell that a point of the unit square chooses; the point becomes the one within the
// cell.  Cells have the middles of texels as corners, so there is a row of them more than of
// texels.
uvec2 choose_cell(inout vec2 square_point)
{
    uvec2 size = sky_size() + uvec2(0u, 1u), cell = uvec2(0u);
    uint  first = SKY_ITSELF + sky_size().x * sky_size().y, side = 1u;
    while (side < max(size.x, size.y))
        side *= 2u;
    for (; side > 1u; side /= 2u) {
        uvec2 cells = (size + side - 1u) / side;
        vec4  sums = load_sky(first + cell.y * cells.x + cell.x);
        bool  right = is_in_second(sums.x + sums.z, sums.y + sums.w, square_point.x);
        vec2  column = right ? sums.yw : sums.xz;
        bool  below = is_in_second(column.x, column.y, square_point.y);
        cell = 2u * cell + uvec2(right ? 1u : 0u, below ? 1u : 0u);
        first += cells.x * cells.y;
    }
    return min(cell, size - 1u);
}

float load_luminance(uint column, uint line)
{
    return luminance(load_sky(SKY_ITSELF + line * sky_size().x + column).rgb);
}

// Returns the place in a cell that a point of the unit square chooses, as bilinear as the radiance
// there.
vec2 choose_in_cell(uvec2 cell, vec2 square_point)
{
    uvec2 size = sky_size();
    uint  left = cell.x > 0u ? cell.x - 1u : size.x - 1u;
    uint  above = max(cell.y, 1u) - 1u, below = min(cell.y, size.y - 1u);
    vec2  high = vec2(load_luminance(left, above), load_luminance(cell.x, above));
    vec2  deep = vec2(load_luminance(left, below), load_luminance(cell.x, below));
    float down = choose_by_line(high.x + high.y, deep.x + deep.y, square_point.y);
    vec2  ends = mix(high, deep, down);
    float line = float(cell.y);
    vec2  edges = clamp(vec2(line - 0.5, line + 0.5), 0.0, float(size.y));
    float column = float(cell.x) - 0.5 + choose_by_line(ends.x, ends.y, square_point.x);
    return vec2(column, mix(edges.x, edges.y, down)) / vec2(size);
}

vec3 direction_on_sky(vec2 place)
{
    float longitude = 2.0 * PI * (place.x - 0.5) - frame.sky_map.z;
    float level = krs_sin(PI * place.y);
    return vec3(level * krs_sin(longitude), krs_cos(PI * place.y), -level * krs_cos(longitude));
}
