// Distance code of a scene; slot 0 holds the time, then one slot for each `param`.
layout(std140, set = 0, binding = 0) uniform KrsParameters { vec4 krs_parameter[1]; };

struct KrsSurface {
    float distance;
    vec3  color;
    float roughness;
    float metallic;
    vec3  emission;
    float specular;
    float ior;
    float transmission;
    vec3  absorption;
    float coat;
    float coat_roughness;
    vec3  sheen;
    float sheen_roughness;
    float thin_film_weight;
    float thin_film_thickness;
    float thin_film_ior;
    float specular_roughness_anisotropy;
    vec3  tangent;
    float subsurface_weight;
    vec3  subsurface_color;
    vec3  subsurface_radius;
    uint  component;
    uint  level;
    uint  instance;
    uint  material;
    vec3  normal;
};

// Everything that stays the same within a frame: call it first.
void krs_prepare();

// Never above the distance to the nearest surface; negative inside.
float krs_distance(vec3 p);

// To march by: never above the distance to the nearest surface, and not above 0
// in the same places as krs_distance.  What is far for its size is not looked
// at, nor what is smaller than the footprint.
float krs_distance_lod(vec3 p, float footprint);

// What is at p: the component with the least distance.  `normal` is the
// gradient of krs_distance there, `footprint` the radius of a pixel, or 0.
KrsSurface krs_surface(vec3 p, vec3 normal, float footprint);

float krs_sine_small(float r, int n)
{
    float z = r * r;
    float p = 2.60831598e-6 * z - 1.98106907e-4;
    p = p * z + 8.33307859e-3;
    p = p * z - 1.66666597e-1;
    float s = r + r * z * p;
    return uintBitsToFloat(floatBitsToUint(s) ^ (uint(n) << 31));
}

float krs_reduce(float a, float n)
{
    precise float r = a - n * 3.140625;
    r = r - n * 9.67025756836e-4;
    r = r - n * 6.27832947e-7;
    return min(max(r, -1.6), 1.6); // what is left of large arguments may be anything
}

float krs_sin(float a)
{
    float n = floor(a * 0.318309886184 + 0.5);
    return krs_sine_small(krs_reduce(a, n), int(n));
}

float krs_cos(float a)
{
    float n = floor(a * 0.318309886184);
    return krs_sine_small(krs_reduce(a, n + 0.5), int(n) + 1);
}

uint krs_lattice(uint x)
{
    uint once = (x ^ (x >> 16)) * 0x7feb352du;
    uint twice = (once ^ (once >> 15)) * 0x846ca68bu;
    return twice ^ (twice >> 16);
}

float krs_slope_3(uint h, vec3 d)
{
    float u = mix(d.y, d.x, h < 8u);
    float v = mix(mix(d.z, d.x, (h | 2u) == 14u), d.y, h < 4u);
    return uintBitsToFloat(floatBitsToUint(u) ^ (h << 31)) +
           uintBitsToFloat(floatBitsToUint(v) ^ ((h >> 1) << 31));
}

uint krs_lattice_bits(uint x) { return krs_lattice(x) >> 28; }

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

float krs_box_distance(vec3 p, vec3 center, vec3 half_sides)
{
    return length(max(abs(p - center) - half_sides, vec3(0.0)));
}

void krs_prepare()
{
}

float krs_distance_1(vec3 p)
{
    // library:solids.krs
    vec3 v0 = abs(p) - vec3(1.0);
    float t1 = length(max(v0, vec3(0.0)));
    float t2 = max(v0.y, v0.z);
    float t3 = max(v0.x, t2);
    // tests/golden/fields.krs:2
    vec3 v4 = min(max(p, vec3((-1.0))), vec3(1.0));
    float t5 = (krs_sin((v4.x * 3.0)) * krs_cos((v4.y * 3.0))) + krs_sin((v4.z * 3.0));
    float t6 = t5 * 0.22840223;
    float t7 = -(t1 + min(t3, 0.0));
    float t8 = -(min(max(t3, t6), 0.0) + length(vec2(t1, max(t6, 0.0))));
    float t9 = -min(t7, t8);
    return t9;
}

float krs_distance_2(vec3 p)
{
    // library:solids.krs
    float t0 = length((p - vec3(0.0, 3.0, 0.0)));
    // tests/golden/fields.krs:3
    float t1 = min(max((t0 - 0.5), 0.0), 1.0);
    float t2 = 1.0 - (t1 * t1);
    float t3 = max((t0 - 1.5), 0.0);
    // library:solids.krs
    float t4 = length((p - vec3(0.8, 3.0, 0.0)));
    // tests/golden/fields.krs:3
    float t5 = min(max((t4 - 0.3), 0.0), 1.0);
    float t6 = 1.0 - (t5 * t5);
    float t7 = max((t4 - 1.3), 0.0);
    float t8 = min(t3, t7);
    float t9 = max((1.0 - ((t3 - t8) * 3.4346006)), 0.0) + max((1.0 - ((t7 - t8) * 3.4346006)), 0.0);
    float t10 = (0.29115468 - (((t2 * (t2 * t2)) + (t6 * (t6 * t6))) * 0.58230937)) / t9;
    float t11 = t8 + t10;
    return t11;
}

float krs_distance_3(vec3 p)
{
    // tests/golden/fields.krs:4
    vec3 v0 = p - vec3(3.0, 0.0, 0.0);
    vec3 v1 = min(max(v0, vec3((-1.01))), vec3(1.01));
    float t2 = ((length(v1) - 1.0) - (krs_noise3((v1 * vec3(3.0))) * 0.01)) * 0.90155065;
    float t3 = length((v0 - v1));
    float t4 = mix(length(vec2(t3, max(t2, 0.0))), t2, t3 <= 0.0);
    return t4;
}

float krs_distance_lod_1(vec3 p, float footprint)
{
    return krs_distance_1(p);
}

float krs_distance_lod_2(vec3 p, float footprint)
{
    return krs_distance_2(p);
}

float krs_distance_lod_3(vec3 p, float footprint)
{
    return krs_distance_3(p);
}

KrsSurface krs_surface_1(vec3 p, vec3 normal, float footprint)
{
    float d = krs_distance_1(p);
    return KrsSurface(d, vec3(0.6), 0.6, 0.0, vec3(0.0), 1.0, 1.5, 0.0, vec3(0.0), 0.0, 0.0, vec3(0.0), 0.5, 0.0, 0.5, 1.4, 0.0, vec3(0.0), 0.0, vec3(0.8), vec3(1.0), 1u, uint(0.0), 1u, 0u, normal);
}

KrsSurface krs_surface_2(vec3 p, vec3 normal, float footprint)
{
    float d = krs_distance_2(p);
    return KrsSurface(d, vec3(0.6), 0.6, 0.0, vec3(0.0), 1.0, 1.5, 0.0, vec3(0.0), 0.0, 0.0, vec3(0.0), 0.5, 0.0, 0.5, 1.4, 0.0, vec3(0.0), 0.0, vec3(0.8), vec3(1.0), 2u, uint(0.0), 1u, 0u, normal);
}

KrsSurface krs_surface_3(vec3 p, vec3 normal, float footprint)
{
    float d = krs_distance_3(p);
    return KrsSurface(d, vec3(0.6), 0.6, 0.0, vec3(0.0), 1.0, 1.5, 0.0, vec3(0.0), 0.0, 0.0, vec3(0.0), 0.5, 0.0, 0.5, 1.4, 0.0, vec3(0.0), 0.0, vec3(0.8), vec3(1.0), 3u, uint(0.0), 1u, 0u, normal);
}

float krs_distance(vec3 p)
{
    float d = krs_distance_1(p);
    d = min(d, krs_distance_2(p));
    d = min(d, krs_distance_3(p));
    return d;
}

float krs_distance_lod(vec3 p, float footprint)
{
    float d = krs_distance_lod_1(p, footprint);
    if (krs_box_distance(p, vec3(0.3, 3.0, 0.0), vec3(1.8000039, 1.500006, 1.500003)) < max(d, 1e-30))
        d = min(d, krs_distance_lod_2(p, footprint));
    if (krs_box_distance(p, vec3(3.0, 0.0, 0.0), vec3(1.010005, 1.010002, 1.010002)) < max(d, 1e-30))
        d = min(d, krs_distance_lod_3(p, footprint));
    return d;
}

KrsSurface krs_surface(vec3 p, vec3 normal, float footprint)
{
    KrsSurface nearest = krs_surface_1(p, normal, footprint);
    KrsSurface other;
    other = krs_surface_2(p, normal, footprint);
    if (other.distance < nearest.distance)
        nearest = other;
    other = krs_surface_3(p, normal, footprint);
    if (other.distance < nearest.distance)
        nearest = other;
    return nearest;
}

