/*
 * noise.glsl: gradient noise: the same hashes as in graph/op_values.c, so the same hills.
 *
 * A lane takes both sides of a choice, so directions are chosen by arithmetic on what is there, and
 * their signs by the bits of the hash.
 */

uint krs_lattice(uint x)
{
    uint once = (x ^ (x >> 16)) * 0x7feb352du;
    uint twice = (once ^ (once >> 15)) * 0x846ca68bu;
    return twice ^ (twice >> 16);
}

uint krs_lattice_bits(uint x) { return krs_lattice(x) >> 28; }

float krs_slope_2(uint h, vec2 d)
{
    bool second = (h & 2u) != 0u;
    float straight = mix(d.x, d.y, second) * 1.41421356237;
    float along = mix(d.x + mix(d.y, -d.y, second), straight, (h & 4u) != 0u);
    return uintBitsToFloat(floatBitsToUint(along) ^ (h << 31));
}

float krs_slope_3(uint h, vec3 d)
{
    float u = mix(d.y, d.x, h < 8u);
    float v = mix(mix(d.z, d.x, (h | 2u) == 14u), d.y, h < 4u);
    return uintBitsToFloat(floatBitsToUint(u) ^ (h << 31)) +
           uintBitsToFloat(floatBitsToUint(v) ^ ((h >> 1) << 31));
}

float krs_noise2(vec2 p)
{
    vec2 place = clamp(p, -1073741824.0, 1073741824.0), whole = floor(place), f = place - whole;
    vec2 s = f * f * f * (f * (6.0 * f - 15.0) + 10.0);
    uvec2 cell = uvec2(ivec2(whole));
    uint a = krs_lattice(cell.x) + cell.y, b = krs_lattice(cell.x + 1u) + cell.y;
    vec2 rows = mix(vec2(krs_slope_2(krs_lattice_bits(a), f),
                         krs_slope_2(krs_lattice_bits(b), f - vec2(1.0, 0.0))),
                    vec2(krs_slope_2(krs_lattice_bits(a + 1u), f - vec2(0.0, 1.0)),
                         krs_slope_2(krs_lattice_bits(b + 1u), f - 1.0)), s.y);
    return 0.99 * mix(rows.x, rows.y, s.x);
}

float krs_noise_row(uint row, vec3 f, float s)
{
    return mix(krs_slope_3(krs_lattice_bits(row), f),
               krs_slope_3(krs_lattice_bits(row + 1u), f - vec3(0.0, 0.0, 1.0)), s);
}

float krs_noise3(vec3 p)
{
    vec3 place = clamp(p, -1073741824.0, 1073741824.0), whole = floor(place), f = place - whole;
    vec3 s = f * f * f * (f * (6.0 * f - 15.0) + 10.0);
    uvec3 cell = uvec3(ivec3(whole));
    uint a = krs_lattice(cell.x) + cell.y, b = krs_lattice(cell.x + 1u) + cell.y;
    float near = mix(krs_noise_row(krs_lattice(a) + cell.z, f, s.z),
                     krs_noise_row(krs_lattice(a + 1u) + cell.z, f - vec3(0.0, 1.0, 0.0), s.z),
                     s.y);
    float far = mix(krs_noise_row(krs_lattice(b) + cell.z, f - vec3(1.0, 0.0, 0.0), s.z),
                    krs_noise_row(krs_lattice(b + 1u) + cell.z, f - vec3(1.0, 1.0, 0.0), s.z),
                    s.y);
    return 0.96 * mix(near, far, s.x);
}
