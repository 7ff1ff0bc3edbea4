// Distance code of a scene; slot 0 holds the time, then one slot for each `param`.
// Where branches save work there are many threads, and operations count.
// Elsewhere what has to be waited for counts, and built-in min and max of
// variables are three instructions, since they mind what is not a number.
#ifdef EARLY_OUTS
#define KRS_MIN(a, b) min(a, b)
#define KRS_MAX(a, b) max(a, b)
#define KRS_BACK(back, here) here
#else
#define KRS_MIN(a, b) mix(a, b, (b) < (a))
#define KRS_MAX(a, b) mix(a, b, (a) < (b))
#define KRS_BACK(back, here) back
#endif
#define KRS_SLOTS 1
#ifdef ZONES
layout(std140, set = 0, binding = 0) uniform KrsParameters { vec4 krs_parameter[KRS_SLOTS + ZONES]; };
vec4 krs_zones[ZONES];
#else
layout(std140, set = 0, binding = 0) uniform KrsParameters { vec4 krs_parameter[KRS_SLOTS]; };
#endif

struct KrsSurface {
    float distance;
    vec3  color;
    float roughness;
    float metallic;
    vec3  emission;
    uint  component;
    uint  level;
    uint  instance;
    vec3  normal;
};

/*
 * sines.glsl: sine, cosine and tangent in single precision, the same on every device.
 *
 * Vulkan promises 2^-11 of the built-in ones, and only within +-pi.  These are good to 2^-22 up to
 * 51,000 = 2^14 pi.  Beyond, they are those of an argument that is off by its last digit.
 *
 * An argument is reduced by the nearest multiple of pi (Cody and Waite 1980): n times the first two
 * parts of pi is exact, so the differences must stay as they are written.  sin(a) is then sin(r),
 * with its sign changed where n is odd; cos(a) = sin(a + pi / 2).  Both operations of ops.def and
 * kernels include this file.
 */
#ifndef KRS_SINES
#define KRS_SINES

float krs_reduce(float a, float n)
{
    precise float r = a - n * 3.140625;
    r = r - n * 9.67025756836e-4;
    r = r - n * 6.27832947e-7;
    return min(max(r, -1.6), 1.6); // what is left of large arguments may be anything
}
float krs_sine_small(float r, int n)
{
    float z = r * r;
    float p = 2.60831598e-6 * z - 1.98106907e-4;
    p = p * z + 8.33307859e-3;
    p = p * z - 1.66666597e-1;
    float s = r + r * z * p;
    return uintBitsToFloat(floatBitsToUint(s) ^ uint(n) << 31);
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
float krs_tan(float a) { return krs_sin(a) / krs_cos(a); }

vec2 krs_sin(vec2 a) { return vec2(krs_sin(a.x), krs_sin(a.y)); }
vec3 krs_sin(vec3 a) { return vec3(krs_sin(a.x), krs_sin(a.y), krs_sin(a.z)); }
vec4 krs_sin(vec4 a) { return vec4(krs_sin(a.x), krs_sin(a.y), krs_sin(a.z), krs_sin(a.w)); }
vec2 krs_cos(vec2 a) { return vec2(krs_cos(a.x), krs_cos(a.y)); }
vec3 krs_cos(vec3 a) { return vec3(krs_cos(a.x), krs_cos(a.y), krs_cos(a.z)); }
vec4 krs_cos(vec4 a) { return vec4(krs_cos(a.x), krs_cos(a.y), krs_cos(a.z), krs_cos(a.w)); }
vec2 krs_tan(vec2 a) { return vec2(krs_tan(a.x), krs_tan(a.y)); }
vec3 krs_tan(vec3 a) { return vec3(krs_tan(a.x), krs_tan(a.y), krs_tan(a.z)); }
vec4 krs_tan(vec4 a) { return vec4(krs_tan(a.x), krs_tan(a.y), krs_tan(a.z), krs_tan(a.w)); }

#endif

uint krs_lattice(uint x)
{
    x = (x ^ (x >> 16)) * 0x7feb352du;
    x = (x ^ (x >> 15)) * 0x846ca68bu;
    return x ^ (x >> 16);
}
uint krs_lattice_bits(uint x) { return krs_lattice(x) >> 28; }
float krs_slope_2(uint h, vec2 d)
{
    bool second = (h & 2u) != 0u;
    float straight = mix(d.x, d.y, second) * 1.41421356237;
    float along = mix(d.x + mix(d.y, -d.y, second), straight, (h & 4u) != 0u);
    return mix(along, -along, (h & 1u) != 0u);
}
float krs_slope_3(uint h, vec3 d)
{
    float u = mix(d.y, d.x, h < 8u);
    float v = mix(mix(d.z, d.x, (h | 2u) == 14u), d.y, h < 4u);
    return mix(u, -u, (h & 1u) != 0u) + mix(v, -v, (h & 2u) != 0u);
}
float krs_noise2(vec2 p)
{
    p = clamp(p, -1073741824.0, 1073741824.0);
    vec2 whole = floor(p), f = p - whole;
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
    p = clamp(p, -1073741824.0, 1073741824.0);
    vec3 whole = floor(p), f = p - whole;
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


// Everything that stays the same within a frame: call it first.
void krs_prepare()
{
#ifdef ZONES
    for (int i = 0; i < ZONES; i++)
        krs_zones[i] = krs_parameter[KRS_SLOTS + i];
#endif
}

// The distance where zones have been cut out: those of the scene, and ZONES of
// the caller, of which slot KRS_SLOTS holds the first: center and radius.
float krs_cut(vec3 p, float d)
{
#ifdef ZONES
    for (int i = 0; i < ZONES; i++)
        d = max(d, krs_zones[i].w - length(p - krs_zones[i].xyz));
#endif
    return d;
}

#if !defined MARCH_GROUP || MARCH_GROUP == 2
float krs_distance_1(vec3 p)
{
    // library:solids.krs:48
    vec3 v0 = abs(p) - vec3(1.0);
    // library:solids.krs:14
    float t1 = length(max(v0, vec3(0.0)));
    float t2 = KRS_MAX(v0.y, v0.z);
    // tests/golden/fields.krs:2
    vec3 v3 = min(max(p, vec3((-1.0))), vec3(1.0));
    float t4 = (krs_sin((v3.x * 3.0)) * krs_cos((v3.y * 3.0))) + krs_sin((v3.z * 3.0));
    float t5 = t4 * 0.22840223;
    float t6 = abs(p.x) - 1.0;
    float t7 = abs(p.y) - 1.0;
    float t8 = KRS_MAX(t6, t7);
    float t9 = abs(p.z) - 1.0;
    float t10 = KRS_MAX(t8, t9);
    float t11 = -(t1 + min(KRS_MAX(v0.x, t2), 0.0));
    float t12 = -(min(KRS_MAX(t5, t10), 0.0) + length(vec2(t1, max(t5, 0.0))));
    float t13 = -KRS_MIN(t11, t12);
    return t13;
}
#endif

#if !defined MARCH_GROUP || MARCH_GROUP == 2
float krs_distance_2(vec3 p)
{
    // library:solids.krs:38
    float t0 = length((p - vec3(0.0, 3.0, 0.0)));
    // tests/golden/fields.krs:3
    float t1 = min(max((t0 - 0.5), 0.0), 1.0);
    float t2 = 1.0 - (t1 * t1);
    float t3 = max((t0 - 1.5), 0.0);
    // library:solids.krs:38
    float t4 = length((p - vec3(0.8, 3.0, 0.0)));
    // tests/golden/fields.krs:3
    float t5 = min(max((t4 - 0.3), 0.0), 1.0);
    float t6 = 1.0 - (t5 * t5);
    float t7 = max((t4 - 1.3), 0.0);
    float t8 = KRS_MIN(t3, t7);
    float t9 = max((1.0 - ((t3 - t8) * 3.4346006)), 0.0) + max((1.0 - ((t7 - t8) * 3.4346006)), 0.0);
    float t10 = (0.29115468 - (((t2 * (t2 * t2)) + (t6 * (t6 * t6))) * 0.58230937)) / t9;
    float t11 = t8 + t10;
    return t11;
}
#endif

#if !defined MARCH_GROUP || MARCH_GROUP == 1
float krs_distance_3(vec3 p)
{
    // tests/golden/fields.krs:4
    vec3 v0 = p - vec3(3.0, 0.0, 0.0);
    vec3 v1 = min(max(v0, vec3((-1.01))), vec3(1.01));
    float t2 = ((length(v1) - 1.0) - (krs_noise3((v1 * vec3(3.0))) * 0.01)) * 0.90155065;
    float t3 = length(vec2(length((v0 - v1)), max(t2, 0.0))) + min(t2, 0.0);
    return t3;
}
#endif

// Never above the distance to the nearest surface; negative inside.
float krs_distance(vec3 p)
{
#ifdef MARCH_GROUP
    float d = 1e30;
#if MARCH_GROUP == 2
    d = min(d, krs_distance_1(p));
#endif
#if MARCH_GROUP == 2
    d = min(d, krs_distance_2(p));
#endif
#if MARCH_GROUP == 1
    d = min(d, krs_distance_3(p));
#endif
#else
    float d = krs_distance_1(p);
    d = min(d, krs_distance_2(p));
    d = min(d, krs_distance_3(p));
#endif
    return krs_cut(p, d);
}

#ifndef MARCH_GROUP
#ifdef EARLY_OUTS
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

float krs_box_distance(vec3 p, vec3 center, vec3 half_sides)
{
    return length(max(abs(p - center) - half_sides, 0.0));
}

// To march by: never above the distance to the nearest surface, and not above 0 in
// the same places as krs_distance.  What is far for its size is not looked at, nor
// what is smaller than the footprint.
float krs_distance_lod(vec3 p, float footprint)
{
    float d = krs_distance_lod_1(p, footprint);
    if (krs_box_distance(p, vec3(0.3, 3.0, 0.0), vec3(1.8000039, 1.500006, 1.500003)) < max(d, 1e-30))
        d = min(d, krs_distance_lod_2(p, footprint));
    if (krs_box_distance(p, vec3(3.0, 0.0, 0.0), vec3(1.010005, 1.010002, 1.010002)) < max(d, 1e-30))
        d = min(d, krs_distance_lod_3(p, footprint));
    return krs_cut(p, d);
}
#endif

#ifdef PACKED
// Parts of the scene, most of them one component: the distance of one, and a box
// around it; where there is none the box stays empty.
const uint KRS_SCENE_PARTS = 3u;

float krs_scene_part_distance(uint scene_part, vec3 p)
{
    float d = 1e30;
    switch (scene_part) {
    case 0u:
#ifdef EARLY_OUTS
        d = min(d, krs_distance_lod_1(p, 0.0));
#else
        d = min(d, krs_distance_1(p));
#endif
        break;
    case 1u:
#ifdef EARLY_OUTS
        d = min(d, krs_distance_lod_2(p, 0.0));
#else
        d = min(d, krs_distance_2(p));
#endif
        break;
    case 2u:
#ifdef EARLY_OUTS
        d = min(d, krs_distance_lod_3(p, 0.0));
#else
        d = min(d, krs_distance_3(p));
#endif
        break;
    }
    return krs_cut(p, d);
}

void krs_scene_part_box(uint scene_part, inout vec3 low, inout vec3 high)
{
    switch (scene_part) {
    case 0u:
        low = vec3((-1.0003474));
        high = vec3(1.0003474);
        break;
    case 1u:
        low = vec3((-1.5005585), 1.4994391, (-1.5005579));
        high = vec3(2.1005585, 4.5005608, 1.5005579);
        break;
    case 2u:
        low = vec3(1.9896461, (-1.010351), (-1.010351));
        high = vec3(4.010354, 1.010351, 1.010351);
        break;
    }
}
#endif

KrsSurface krs_surface_1(vec3 p, vec3 normal, float footprint)
{
    // library:solids.krs:48
    vec3 v0 = abs(p) - vec3(1.0);
    // library:solids.krs:14
    float t1 = length(max(v0, vec3(0.0)));
    float t2 = KRS_MAX(v0.y, v0.z);
    // tests/golden/fields.krs:2
    vec3 v3 = min(max(p, vec3((-1.0))), vec3(1.0));
    float t4 = (krs_sin((v3.x * 3.0)) * krs_cos((v3.y * 3.0))) + krs_sin((v3.z * 3.0));
    float t5 = t4 * 0.22840223;
    float t6 = abs(p.x) - 1.0;
    float t7 = abs(p.y) - 1.0;
    float t8 = KRS_MAX(t6, t7);
    float t9 = abs(p.z) - 1.0;
    float t10 = KRS_MAX(t8, t9);
    float t11 = -(t1 + min(KRS_MAX(v0.x, t2), 0.0));
    float t12 = -(min(KRS_MAX(t5, t10), 0.0) + length(vec2(t1, max(t5, 0.0))));
    float t13 = -KRS_MIN(t11, t12);
    return KrsSurface(t13, vec3(0.6), 0.6, 0.0, vec3(0.0), 1u, uint(0.0), 1u, normal);
}

KrsSurface krs_surface_2(vec3 p, vec3 normal, float footprint)
{
    // library:solids.krs:38
    float t0 = length((p - vec3(0.0, 3.0, 0.0)));
    // tests/golden/fields.krs:3
    float t1 = min(max((t0 - 0.5), 0.0), 1.0);
    float t2 = 1.0 - (t1 * t1);
    float t3 = max((t0 - 1.5), 0.0);
    // library:solids.krs:38
    float t4 = length((p - vec3(0.8, 3.0, 0.0)));
    // tests/golden/fields.krs:3
    float t5 = min(max((t4 - 0.3), 0.0), 1.0);
    float t6 = 1.0 - (t5 * t5);
    float t7 = max((t4 - 1.3), 0.0);
    float t8 = KRS_MIN(t3, t7);
    float t9 = max((1.0 - ((t3 - t8) * 3.4346006)), 0.0) + max((1.0 - ((t7 - t8) * 3.4346006)), 0.0);
    float t10 = (0.29115468 - (((t2 * (t2 * t2)) + (t6 * (t6 * t6))) * 0.58230937)) / t9;
    float t11 = t8 + t10;
    return KrsSurface(t11, vec3(0.6), 0.6, 0.0, vec3(0.0), 2u, uint(0.0), 1u, normal);
}

KrsSurface krs_surface_3(vec3 p, vec3 normal, float footprint)
{
    // tests/golden/fields.krs:4
    vec3 v0 = p - vec3(3.0, 0.0, 0.0);
    vec3 v1 = min(max(v0, vec3((-1.01))), vec3(1.01));
    float t2 = ((length(v1) - 1.0) - (krs_noise3((v1 * vec3(3.0))) * 0.01)) * 0.90155065;
    float t3 = length(vec2(length((v0 - v1)), max(t2, 0.0))) + min(t2, 0.0);
    return KrsSurface(t3, vec3(0.6), 0.6, 0.0, vec3(0.0), 3u, uint(0.0), 1u, normal);
}

// What is at p: the component with the least distance.  `normal` is the
// gradient of krs_distance there, `footprint` the radius of a pixel, or 0.
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
    float cut = krs_cut(p, nearest.distance);
    if (cut > nearest.distance)
        nearest.normal = normal;
    nearest.distance = cut;
    return nearest;
}
#endif
