/*
 * anisotropy.glsl: microfacets that are wider along the tangent of a surface than across it.
 *
 * The first axis of the surface is its tangent.  Widths are those of OpenPBR, whose mean square is
 * that of the same roughness without anisotropy.
 */

vec2 find_widths(float roughness, float anisotropy)
{
    float across = 1.0 - anisotropy;
    float along = roughness * roughness * sqrt(2.0 / (1.0 + across * across));
    return max(vec2(along, across * along), MIN_ALPHA);
}

// Returns Smith's function: how much of the microfacets is hidden from a direction.
float find_hidden(vec3 direction, vec2 alpha)
{
    vec2  slope = alpha * direction.xy;
    float square = dot(slope, slope) / max(direction.z * direction.z, 1e-12);
    return 0.5 * (sqrt(1.0 + square) - 1.0);
}

// Returns the density of microfacets with a normal (GGX).
float find_density(vec3 normal, vec2 alpha)
{
    vec2  slope = normal.xy / alpha;
    float across = dot(slope, slope) + normal.z * normal.z;
    return 1.0 / (PI * alpha.x * alpha.y * across * across);
}

// Returns the weights of the azimuths whose squared cosines are 0, 1/3, 2/3 and 1: a cubic goes
// through all.
vec4 find_azimuth_weights(vec2 along)
{
    float square = dot(along, along);
    float x = 3.0 * (square > 1e-12 ? along.x * along.x / square : 0.0);
    return vec4((1.0 - x) * (2.0 - x) * (3.0 - x), 3.0 * x * (2.0 - x) * (3.0 - x),
                3.0 * x * (x - 1.0) * (3.0 - x), x * (x - 1.0) * (x - 2.0)) / 6.0;
}

vec2 load_wide_albedo(uint number, vec4 weights)
{
    uvec4 row = load_input(WIDE_ALBEDOS_AT + number);
    return vec2(dot(weights, vec4(unpackUnorm2x16(row.x), unpackUnorm2x16(row.y))),
                dot(weights, vec4(unpackUnorm2x16(row.z), unpackUnorm2x16(row.w))));
}

// Interpolates between two cosines and two roughnesses.
vec2 mix_wide_albedos(uint low, vec2 part, vec4 weights)
{
    uint high = low + WIDE_COSINES;
    return mix(mix(load_wide_albedo(low, weights), load_wide_albedo(low + 1u, weights), part.x),
               mix(load_wide_albedo(high, weights), load_wide_albedo(high + 1u, weights), part.x),
               part.y);
}

// Returns light that microfacets reflect: all, and the part by Schlick's factor.
vec2 find_wide_albedo(vec3 eye, float roughness, float anisotropy)
{
    uvec3 most = uvec3(WIDE_COSINES, WIDE_ROUGHNESSES, WIDE_ANISOTROPIES) - 1u;
    vec3  at = clamp(vec3(sqrt(eye.z), roughness, anisotropy), 0.0, 1.0) * vec3(most);
    uvec3 cell = min(uvec3(at), most - 1u);
    vec3  part = at - vec3(cell);
    vec4  weights = find_azimuth_weights(eye.xy);
    uint  low = (cell.z * WIDE_ROUGHNESSES + cell.y) * WIDE_COSINES + cell.x;
    return mix(mix_wide_albedos(low, part.xy, weights),
               mix_wide_albedos(low + WIDE_COSINES * WIDE_ROUGHNESSES, part.xy, weights), part.z);
}
