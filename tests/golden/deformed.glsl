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

float krs_atan_unit(float x)
{
    bool far = x > 0.414213562373;
    float y = mix(x, (x - 1.0) / (x + 1.0), far);
    float z = y * y;
    float p = 8.05374449538e-2 * z - 1.38776856032e-1;
    p = p * z + 1.99777106478e-1;
    p = p * z - 3.33329491539e-1;
    y += y * z * p;
    return mix(y, 0.785398163397 + y, far);
}
float krs_atan(float a)
{
    float x = abs(a);
    float s = krs_atan_unit(mix(x, 1.0 / x, x > 1.0));
    s = mix(s, 1.57079632679 - s, x > 1.0);
    return mix(s, -s, a < 0.0);
}
float krs_atan2(float a, float b)
{
    float x = abs(b), y = abs(a), most = max(x, y);
    float s = krs_atan_unit(mix(0.0, min(x, y) / most, most > 0.0));
    s = mix(s, 1.57079632679 - s, y > x);
    s = mix(s, 3.14159265359 - s, b < 0.0);
    return mix(s, -s, a < 0.0);
}
vec2 krs_atan(vec2 a) { return vec2(krs_atan(a.x), krs_atan(a.y)); }
vec3 krs_atan(vec3 a) { return vec3(krs_atan(a.x), krs_atan(a.y), krs_atan(a.z)); }
vec4 krs_atan(vec4 a) { return vec4(krs_atan(a.x), krs_atan(a.y), krs_atan(a.z), krs_atan(a.w)); }
vec2 krs_atan2(vec2 a, vec2 b) { return vec2(krs_atan2(a.x, b.x), krs_atan2(a.y, b.y)); }
vec3 krs_atan2(vec3 a, vec3 b)
{ return vec3(krs_atan2(a.x, b.x), krs_atan2(a.y, b.y), krs_atan2(a.z, b.z)); }
vec4 krs_atan2(vec4 a, vec4 b)
{ return vec4(krs_atan2(a.x, b.x), krs_atan2(a.y, b.y), krs_atan2(a.z, b.z), krs_atan2(a.w, b.w)); }


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

float krs_distance_1(vec3 p)
{
    // library:solids.krs:60
    float t0 = length(vec2(p.x, p.z));
    // tests/golden/deformed.krs:2
    float t1 = min(max(p.y, (-1.0)), 1.0);
    float t2 = 0.42426407 / max(t0, 0.42426407);
    vec3 v3 = vec3((p.x * t2), t1, (p.z * t2));
    float t4 = krs_cos(t1);
    float t5 = krs_sin(t1);
    vec3 v6 = vec3(dot(vec3(t4, 0.0, (-t5)), v3), dot(vec3(0.0, 1.0, 0.0), v3), dot(vec3(t5, 0.0, t4), v3));
    // library:solids.krs:48
    vec3 v7 = abs(v6) - vec3(0.3, 1.0, 0.3);
    // library:solids.krs:14
    float t8 = KRS_MAX(v7.y, v7.z);
    // tests/golden/deformed.krs:2
    float t9 = (length(max(v7, vec3(0.0))) + min(KRS_MAX(v7.x, t8), 0.0)) * 0.8101204;
    vec2 v10 = vec2(length(vec2(max((t0 - 0.42426407), 0.0), (p.y - t1))), max(t9, 0.0));
    float t11 = length(v10) + min(t9, 0.0);
    return t11;
}

float krs_distance_2(vec3 p)
{
    // tests/golden/deformed.krs:3
    vec3 v0 = p - vec3(0.0, 2.0, 0.0);
    vec3 v1 = vec3(dot(vec3(0.0, 0.0, 1.0), v0), dot(vec3(0.0, 1.0, 0.0), v0), dot(vec3((-1.0), 0.0, 0.0), v0));
    vec3 v2 = min(max(v1, vec3((-0.15), (-0.22478913), (-1.0))), vec3(0.15, 0.22478913, 1.0028112));
    float t3 = v2.y * 0.5;
    float t4 = 1.0 - (v2.z * 0.5);
    float t5 = max(abs((t3 / t4)), 1e-06);
    float t6 = length(vec2(t3, t4));
    vec3 v7 = vec3(v2.x, ((krs_atan(t5) / t5) * (v2.y / t4)), (((v2.z * (t4 + 1.0)) - (v2.y * t3)) / (t6 + 1.0)));
    vec3 v8 = vec3(dot(vec3(0.0, 0.0, (-1.0)), v7), dot(vec3(0.0, 1.0, 0.0), v7), dot(vec3(1.0, 0.0, 0.0), v7));
    // library:solids.krs:48
    vec3 v9 = abs(v8) - vec3(1.0, 0.15, 0.15);
    // library:solids.krs:14
    float t10 = KRS_MAX(v9.y, v9.z);
    // tests/golden/deformed.krs:3
    float t11 = min(max((length(max(v9, vec3(0.0))) + min(KRS_MAX(v9.x, t10), 0.0)), (-0.5)), 0.5);
    float t12 = (t11 * min(t6, 1.0)) * 0.8;
    float t13 = length(vec2(length((v1 - v2)), max(t12, 0.0))) + min(t12, 0.0);
    return t13;
}

float krs_distance_3(vec3 p)
{
    // tests/golden/deformed.krs:4
    vec3 v0 = p - vec3(2.0, 0.0, 0.0);
    // library:solids.krs:60
    float t1 = length(vec2(v0.x, v0.z)) - 0.5;
    float t2 = abs(v0.y) - 0.5;
    // tests/golden/deformed.krs:4
    float t3 = abs((length(vec2(max(t1, 0.0), max(t2, 0.0))) + min(KRS_MAX(t1, t2), 0.0)));
    float t4 = t3 - 0.025;
    return t4;
}

float krs_distance_4(vec3 p)
{
    // library:solids.krs:48
    vec3 v0 = abs((p - vec3((-2.0), 0.0, 0.0))) - vec3(0.4);
    // library:solids.krs:14
    float t1 = KRS_MAX(v0.y, v0.z);
    // library:solids.krs:51
    float t2 = (length(max(v0, vec3(0.0))) + min(KRS_MAX(v0.x, t1), 0.0)) - 0.1;
    return t2;
}

// Never above the distance to the nearest surface; negative inside.
float krs_distance(vec3 p)
{
    float d = krs_distance_1(p);
    d = min(d, krs_distance_2(p));
    d = min(d, krs_distance_3(p));
    d = min(d, krs_distance_4(p));
    return krs_cut(p, d);
}

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

float krs_distance_lod_4(vec3 p, float footprint)
{
    return krs_distance_4(p);
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
    if (krs_box_distance(p, vec3((-0.0014933478), 2.0, 0.0), vec3(1.0014954, 0.22488382, 0.1500003)) < max(d, 1e-30))
        d = min(d, krs_distance_lod_2(p, footprint));
    if (krs_box_distance(p, vec3(2.0, 0.0, 0.0), vec3(0.5250031, 0.52500105, 0.52500105)) < max(d, 1e-30))
        d = min(d, krs_distance_lod_3(p, footprint));
    if (krs_box_distance(p, vec3((-2.0), 0.0, 0.0), vec3(0.500003, 0.500001, 0.500001)) < max(d, 1e-30))
        d = min(d, krs_distance_lod_4(p, footprint));
    return krs_cut(p, d);
}
#endif

#ifdef PACKED
// Parts of the scene, most of them one component: the distance of one, and a box
// around it; where there is none the box stays empty.
const uint KRS_SCENE_PARTS = 4u;

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
    case 3u:
#ifdef EARLY_OUTS
        d = min(d, krs_distance_lod_4(p, 0.0));
#else
        d = min(d, krs_distance_4(p));
#endif
        break;
    }
    return krs_cut(p, d);
}

void krs_scene_part_box(uint scene_part, inout vec3 low, inout vec3 high)
{
    switch (scene_part) {
    case 0u:
        low = vec3((-0.42449772), (-1.0002342), (-0.42449772));
        high = vec3(0.42449772, 1.0002342, 0.42449772);
        break;
    case 1u:
        low = vec3((-1.0031952), 1.7749089, (-0.15020762));
        high = vec3(1.0002085, 2.225091, 0.15020762);
        break;
    case 2u:
        low = vec3(1.4748156, (-0.52518237), (-0.52518237));
        high = vec3(2.5251844, 0.52518237, 0.52518237);
        break;
    case 3u:
        low = vec3((-2.5001757), (-0.5001737), (-0.5001737));
        high = vec3((-1.4998243), 0.5001737, 0.5001737);
        break;
    }
}
#endif

KrsSurface krs_surface_1(vec3 p, vec3 normal, float footprint)
{
    // library:solids.krs:60
    float t0 = length(vec2(p.x, p.z));
    // tests/golden/deformed.krs:2
    float t1 = min(max(p.y, (-1.0)), 1.0);
    float t2 = 0.42426407 / max(t0, 0.42426407);
    vec3 v3 = vec3((p.x * t2), t1, (p.z * t2));
    float t4 = krs_cos(t1);
    float t5 = krs_sin(t1);
    vec3 v6 = vec3(dot(vec3(t4, 0.0, (-t5)), v3), dot(vec3(0.0, 1.0, 0.0), v3), dot(vec3(t5, 0.0, t4), v3));
    // library:solids.krs:48
    vec3 v7 = abs(v6) - vec3(0.3, 1.0, 0.3);
    // library:solids.krs:14
    float t8 = KRS_MAX(v7.y, v7.z);
    // tests/golden/deformed.krs:2
    float t9 = (length(max(v7, vec3(0.0))) + min(KRS_MAX(v7.x, t8), 0.0)) * 0.8101204;
    vec2 v10 = vec2(length(vec2(max((t0 - 0.42426407), 0.0), (p.y - t1))), max(t9, 0.0));
    float t11 = length(v10) + min(t9, 0.0);
    return KrsSurface(t11, vec3(0.6), 0.6, 0.0, vec3(0.0), 1u, uint(0.0), 1u, normal);
}

KrsSurface krs_surface_2(vec3 p, vec3 normal, float footprint)
{
    // tests/golden/deformed.krs:3
    vec3 v0 = p - vec3(0.0, 2.0, 0.0);
    vec3 v1 = vec3(dot(vec3(0.0, 0.0, 1.0), v0), dot(vec3(0.0, 1.0, 0.0), v0), dot(vec3((-1.0), 0.0, 0.0), v0));
    vec3 v2 = min(max(v1, vec3((-0.15), (-0.22478913), (-1.0))), vec3(0.15, 0.22478913, 1.0028112));
    float t3 = v2.y * 0.5;
    float t4 = 1.0 - (v2.z * 0.5);
    float t5 = max(abs((t3 / t4)), 1e-06);
    float t6 = length(vec2(t3, t4));
    vec3 v7 = vec3(v2.x, ((krs_atan(t5) / t5) * (v2.y / t4)), (((v2.z * (t4 + 1.0)) - (v2.y * t3)) / (t6 + 1.0)));
    vec3 v8 = vec3(dot(vec3(0.0, 0.0, (-1.0)), v7), dot(vec3(0.0, 1.0, 0.0), v7), dot(vec3(1.0, 0.0, 0.0), v7));
    // library:solids.krs:48
    vec3 v9 = abs(v8) - vec3(1.0, 0.15, 0.15);
    // library:solids.krs:14
    float t10 = KRS_MAX(v9.y, v9.z);
    // tests/golden/deformed.krs:3
    float t11 = min(max((length(max(v9, vec3(0.0))) + min(KRS_MAX(v9.x, t10), 0.0)), (-0.5)), 0.5);
    float t12 = (t11 * min(t6, 1.0)) * 0.8;
    float t13 = length(vec2(length((v1 - v2)), max(t12, 0.0))) + min(t12, 0.0);
    return KrsSurface(t13, vec3(0.6), 0.6, 0.0, vec3(0.0), 2u, uint(0.0), 1u, normal);
}

KrsSurface krs_surface_3(vec3 p, vec3 normal, float footprint)
{
    // tests/golden/deformed.krs:4
    vec3 v0 = p - vec3(2.0, 0.0, 0.0);
    // library:solids.krs:60
    float t1 = length(vec2(v0.x, v0.z)) - 0.5;
    float t2 = abs(v0.y) - 0.5;
    // tests/golden/deformed.krs:4
    float t3 = abs((length(vec2(max(t1, 0.0), max(t2, 0.0))) + min(KRS_MAX(t1, t2), 0.0)));
    float t4 = t3 - 0.025;
    return KrsSurface(t4, vec3(0.6), 0.6, 0.0, vec3(0.0), 3u, uint(0.0), 1u, normal);
}

KrsSurface krs_surface_4(vec3 p, vec3 normal, float footprint)
{
    // library:solids.krs:48
    vec3 v0 = abs((p - vec3((-2.0), 0.0, 0.0))) - vec3(0.4);
    // library:solids.krs:14
    float t1 = KRS_MAX(v0.y, v0.z);
    // library:solids.krs:51
    float t2 = (length(max(v0, vec3(0.0))) + min(KRS_MAX(v0.x, t1), 0.0)) - 0.1;
    return KrsSurface(t2, vec3(0.6), 0.6, 0.0, vec3(0.0), 4u, uint(0.0), 1u, normal);
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
    other = krs_surface_4(p, normal, footprint);
    if (other.distance < nearest.distance)
        nearest = other;
    float cut = krs_cut(p, nearest.distance);
    if (cut > nearest.distance)
        nearest.normal = normal;
    nearest.distance = cut;
    return nearest;
}
