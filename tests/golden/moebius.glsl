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
// With FRAME_VALUES defined, 2 more slots hold what else depends on the
// frame alone: krs_frame_values in krs.h.
#ifdef FRAME_VALUES
#define KRS_SLOTS 4
#else
#define KRS_SLOTS 2
#endif
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

float krs_mirror_excess(vec3 p, vec3 n, float w)
{ return (p.x * n.x + p.y * n.y) + (p.z * n.z - w); }
vec3 krs_fold(vec3 p, vec3 n, float w)
{ return p - max(krs_mirror_excess(p, n, w), 0.0) * (2.0 * n); }

vec3 krs_frame0;
vec3 krs_frame1;
vec3 krs_frame2;
vec3 krs_frame3;

// Everything that stays the same within a frame: call it first.
void krs_prepare()
{
#ifdef FRAME_VALUES // the host has found them
    krs_frame0 = vec3(0.0, 0.6, 0.0);
    krs_frame1 = vec3(krs_parameter[2].x, krs_parameter[2].y, 0.0);
    krs_frame2 = vec3(krs_parameter[2].z, krs_parameter[2].w, 0.0);
    krs_frame3 = vec3(0.0, 0.0, krs_parameter[3].x);
#else
    float t0 = krs_cos(krs_parameter[1].x);
    float t1 = krs_sin(krs_parameter[1].x);
    vec3 v2 = (vec3(1.0, 0.0, 0.0) * t0) + (vec3(0.0, (-1.0), 0.0) * t1);
    vec3 v3 = (vec3(0.0, 1.0, 0.0) * t0) + (vec3(1.0, 0.0, 0.0) * t1);
    vec3 v4 = (vec3(0.0) * t1) + ((vec3(0.0, 0.0, 1.0) * t0) + (vec3(0.0, 0.0, 1.0) * (1.0 - t0)));
    vec3 v5 = ((vec3(1.0, 0.0, 0.0) * v2.x) + (vec3(0.0, 1.0, 0.0) * v2.y)) + (vec3(0.0, 0.0, 1.0) * v2.z);
    vec3 v6 = ((vec3(1.0, 0.0, 0.0) * v3.x) + (vec3(0.0, 1.0, 0.0) * v3.y)) + (vec3(0.0, 0.0, 1.0) * v3.z);
    vec3 v7 = ((vec3(1.0, 0.0, 0.0) * v4.x) + (vec3(0.0, 1.0, 0.0) * v4.y)) + (vec3(0.0, 0.0, 1.0) * v4.z);
    krs_frame0 = vec3(dot(v2, vec3(0.0)), dot(v3, vec3(0.0)), dot(v4, vec3(0.0))) + vec3(0.0, 0.6, 0.0);
    // tests/golden/moebius.krs:8
    krs_frame1 = vec3(v5.x, v6.x, v7.x);
    krs_frame2 = vec3(v5.y, v6.y, v7.y);
    krs_frame3 = vec3(v5.z, v6.z, v7.z);
#endif
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

#if !defined MARCH_GROUP || MARCH_GROUP == 1
float krs_distance_1(vec3 p)
{
    // library:solids.krs:48
    vec3 v0 = abs(p) - vec3(0.15, 0.05, 0.1);
    // library:solids.krs:14
    float t1 = KRS_MAX(v0.y, v0.z);
    float t2 = length(max(v0, vec3(0.0))) + min(KRS_MAX(v0.x, t1), 0.0);
    // tests/golden/moebius.krs:8
    vec3 v3 = vec3(KRS_MIN(p.x, 2.0 * 0.1 - p.x), p.y, p.z) - krs_frame0;
    vec3 v4 = vec3(dot(krs_frame1, v3), dot(krs_frame2, v3), dot(krs_frame3, v3)) * 1.25;
    // library:solids.krs:48
    vec3 v5 = abs(v4) - vec3(0.15, 0.05, 0.1);
    // library:solids.krs:14
    float t6 = KRS_MAX(v5.y, v5.z);
    // tests/golden/moebius.krs:8
    float t7 = (length(max(v5, vec3(0.0))) + min(KRS_MAX(v5.x, t6), 0.0)) * 0.8;
    float t8 = KRS_MIN(t2, t7);
    vec3 v9 = vec3(KRS_MIN(v4.x, 2.0 * 0.1 - v4.x), v4.y, v4.z) - krs_frame0;
    vec3 v10 = vec3(dot(krs_frame1, v9), dot(krs_frame2, v9), dot(krs_frame3, v9)) * 1.25;
    // library:solids.krs:48
    vec3 v11 = abs(v10) - vec3(0.15, 0.05, 0.1);
    // library:solids.krs:14
    float t12 = KRS_MAX(v11.y, v11.z);
    // tests/golden/moebius.krs:8
    float t13 = (length(max(v11, vec3(0.0))) + min(KRS_MAX(v11.x, t12), 0.0)) * 0.64;
    float t14 = KRS_MIN(t8, t13);
    vec3 v15 = vec3(KRS_MIN(v10.x, 2.0 * 0.1 - v10.x), v10.y, v10.z) - krs_frame0;
    vec3 v16 = vec3(dot(krs_frame1, v15), dot(krs_frame2, v15), dot(krs_frame3, v15)) * 1.25;
    // library:solids.krs:48
    vec3 v17 = abs(v16) - vec3(0.15, 0.05, 0.1);
    // library:solids.krs:14
    float t18 = KRS_MAX(v17.y, v17.z);
    // tests/golden/moebius.krs:8
    float t19 = (length(max(v17, vec3(0.0))) + min(KRS_MAX(v17.x, t18), 0.0)) * 0.512;
    float t20 = KRS_MIN(t14, t19);
    vec3 v21 = vec3(KRS_MIN(v16.x, 2.0 * 0.1 - v16.x), v16.y, v16.z) - krs_frame0;
    vec3 v22 = vec3(dot(krs_frame1, v21), dot(krs_frame2, v21), dot(krs_frame3, v21)) * 1.25;
    // tests/golden/moebius.krs:4
    float t23 = (length(v22) - 0.3) * 0.4096;
    float t24 = KRS_MIN(t20, t23);
    return t24;
}
#endif

#if !defined MARCH_GROUP || MARCH_GROUP == 2
float krs_distance_2(vec3 p)
{
    // tests/golden/moebius.krs:11
    float t0 = length((p - vec3(2.3846219, 0.0, 0.0))) - 0.5995648;
    vec3 v1 = p - vec3(1.0, 0.0, 0.0);
    float t2 = 2.25 / max(dot(v1, v1), 2.25e-12);
    // library:solids.krs:48
    vec3 v3 = abs(((v1 * t2) + vec3((-2.0), 0.0, 0.0))) - vec3(0.5);
    // library:solids.krs:14
    float t4 = KRS_MAX(v3.y, v3.z);
    float t5 = length(max(v3, vec3(0.0))) + min(KRS_MAX(v3.x, t4), 0.0);
    // tests/golden/moebius.krs:11
    float t6 = t5 / (t2 + ((sqrt(t2) * 0.6666667) * abs(t5)));
    float t7 = KRS_MAX(t0, t6);
    return t7;
}
#endif

// Never above the distance to the nearest surface; negative inside.
float krs_distance(vec3 p)
{
#ifdef MARCH_GROUP
    float d = 1e30;
#if MARCH_GROUP == 1
    d = min(d, krs_distance_1(p));
#endif
#if MARCH_GROUP == 2
    d = min(d, krs_distance_2(p));
#endif
#else
    float d = krs_distance_1(p);
    d = min(d, krs_distance_2(p));
#endif
    return krs_cut(p, d);
}

#if defined(ALONG) && ALONG == 3
#if !defined MARCH_GROUP || MARCH_GROUP == 2
float krs_along_2(vec3 p, vec3 direction, float footprint)
{
    // tests/golden/moebius.krs:11
    float t0 = length((p - vec3(2.3846219, 0.0, 0.0))) - 0.5995648;
    vec3 v1 = p - vec3(1.0, 0.0, 0.0);
    float t2 = 2.25 / max(dot(v1, v1), 2.25e-12);
    float t3 = sqrt(t2) * 0.6666667;
    vec3 v4 = v1 * t3;
    // library:solids.krs:48
    vec3 v5 = abs(((v1 * t2) + vec3((-2.0), 0.0, 0.0))) - vec3(0.5);
    // library:solids.krs:14
    float t6 = KRS_MAX(v5.y, v5.z);
    float t7 = length(max(v5, vec3(0.0))) + min(KRS_MAX(v5.x, t6), 0.0);
    // tests/golden/moebius.krs:11
    float t8 = abs(t7);
    float t9 = t2 + (t3 * t8);
    vec3 v10 = v4 * (-t3);
    float t11 = dot(v10, (direction - (v4 * (dot(v4, direction) * 2.0))));
    float t12 = sqrt(max(((t2 * t2) - ((dot(v10, v10) - (t11 * t11)) * (t7 * t7))), 0.0));
    float t13 = max((t12 - (t8 * t11)), 0.0) + (t9 * 1e-05);
    float t14 = t7 / KRS_MIN(t9, t13);
    float t15 = KRS_MAX(t0, t14);
    return t15;
}

#endif
// How far a ray from p along a unit direction may go before it can meet a surface: at
// least the distance, and farther where polynomials or maps tell; negative inside, and
// where a surface without thickness lies between p and the last place, `footprint` behind.
float krs_along(vec3 p, vec3 direction, float footprint)
{
    float t = 1e30;
#if !defined MARCH_GROUP || MARCH_GROUP == 1
    t = min(t, krs_distance_1(p));
#endif
#if !defined MARCH_GROUP || MARCH_GROUP == 2
    t = min(t, krs_along_2(p, direction, footprint));
#endif
    return krs_cut(p, t);
}

float krs_along(vec3 p, vec3 direction)
{
    return krs_along(p, direction, 0.0);
}
#endif

#if defined(ALONG) && ALONG == 4
#if !defined MARCH_GROUP || MARCH_GROUP == 2
float krs_along_2(vec3 p, float footprint)
{
    // tests/golden/moebius.krs:11
    float t0 = length((p - vec3(2.3846219, 0.0, 0.0))) - 0.5995648;
    vec3 v1 = p - vec3(1.0, 0.0, 0.0);
    float t2 = dot(v1, v1);
    float t3 = t2 - (footprint * footprint);
    float t4 = (t2 * 0.001) + 1e-30;
    float t5 = 2.25 / KRS_MAX(t3, t4);
    float t6 = length(v1) * 0.999;
    // library:solids.krs:48
    vec3 v7 = abs(((v1 * t5) + vec3((-2.0), 0.0, 0.0))) - vec3(0.5);
    // library:solids.krs:14
    float t8 = KRS_MAX(v7.y, v7.z);
    // tests/golden/moebius.krs:11
    float t9 = (length(max(v7, vec3(0.0))) + min(KRS_MAX(v7.x, t8), 0.0)) * (footprint / (footprint * t5));
    float t10 = KRS_MIN(t6, t9);
    float t11 = KRS_MAX(t0, t10);
    return t11;
}

#endif
// Whether the ball around p of this radius is empty: if it could be more than 1 times as
// large, which is what this says, about.
float krs_probe(vec3 p, float footprint)
{
    float t = 1e30;
#if !defined MARCH_GROUP || MARCH_GROUP == 1
    t = min(t, krs_distance_1(p));
#endif
#if !defined MARCH_GROUP || MARCH_GROUP == 2
    t = min(t, krs_along_2(p, footprint));
#endif
    return krs_cut(p, t) / footprint;
}
#endif

#ifndef MARCH_GROUP
#ifdef EARLY_OUTS
float krs_distance_lod_1(vec3 p, float footprint)
{
    // tests/golden/moebius.krs:4
    vec3 v0 = abs((p - vec3(0.1, 1.7821991, 0.0))) - vec3(3.757339, 2.7159839, 0.1228845);
    float t1 = length(max(v0, vec3(0.0)));
    float t2 = mix(2.3189008, (-1e+30), 4.6378016 < footprint);
    if (t1 >= t2 && t1 > min(t2, 0.0))
        return t1;
    // library:solids.krs:48
    vec3 v3 = abs(p) - vec3(0.15, 0.05, 0.1);
    // library:solids.krs:14
    float t4 = KRS_MAX(v3.y, v3.z);
    float t5 = length(max(v3, vec3(0.0))) + min(KRS_MAX(v3.x, t4), 0.0);
    // tests/golden/moebius.krs:8
    vec3 v6 = vec3(KRS_MIN(p.x, 2.0 * 0.1 - p.x), p.y, p.z) - krs_frame0;
    vec3 v7 = vec3(dot(krs_frame1, v6), dot(krs_frame2, v6), dot(krs_frame3, v6)) * 1.25;
    // tests/golden/moebius.krs:4
    vec3 v8 = abs((v7 - vec3(0.1, 1.3936018, 0.0))) - vec3(2.1999407, 1.5437934, 0.15360294);
    float t9 = length(max(v8, vec3(0.0))) * 0.8;
    float t10 = mix(1.076781, (-1e+30), 2.153562 < footprint);
    if (t9 >= min(t5, t10) && t9 > min(t10, 0.0))
        return min(t9, t5);
    // library:solids.krs:48
    vec3 v11 = abs(v7) - vec3(0.15, 0.05, 0.1);
    // library:solids.krs:14
    float t12 = KRS_MAX(v11.y, v11.z);
    // tests/golden/moebius.krs:8
    float t13 = (length(max(v11, vec3(0.0))) + min(KRS_MAX(v11.x, t12), 0.0)) * 0.8;
    float t14 = KRS_MIN(t5, t13);
    vec3 v15 = vec3(KRS_MIN(v7.x, 2.0 * 0.1 - v7.x), v7.y, v7.z) - krs_frame0;
    vec3 v16 = vec3(dot(krs_frame1, v15), dot(krs_frame2, v15), dot(krs_frame3, v15)) * 1.25;
    // tests/golden/moebius.krs:4
    vec3 v17 = abs((v16 - vec3(0.1, 0.90785515, 0.0))) - vec3(1.1549829, 0.957857, 0.19200186);
    float t18 = length(max(v17, vec3(0.0))) * 0.64;
    float t19 = mix(0.4540648, (-1e+30), 0.9081296 < footprint);
    if (t18 >= min(t14, t19) && t18 > min(t19, 0.0))
        return min(t18, t14);
    // library:solids.krs:48
    vec3 v20 = abs(v16) - vec3(0.15, 0.05, 0.1);
    // library:solids.krs:14
    float t21 = KRS_MAX(v20.y, v20.z);
    // tests/golden/moebius.krs:8
    float t22 = (length(max(v20, vec3(0.0))) + min(KRS_MAX(v20.x, t21), 0.0)) * 0.64;
    float t23 = KRS_MIN(t14, t22);
    vec3 v24 = vec3(KRS_MIN(v16.x, 2.0 * 0.1 - v16.x), v16.y, v16.z) - krs_frame0;
    vec3 v25 = vec3(dot(krs_frame1, v24), dot(krs_frame2, v24), dot(krs_frame3, v24)) * 1.25;
    // tests/golden/moebius.krs:4
    vec3 v26 = abs((v25 - vec3(0.1, 0.4959765, 0.0))) - vec3(0.5419541, 0.54597753, 0.24000104);
    float t27 = length(max(v26, vec3(0.0))) * 0.512;
    float t28 = mix(0.19644251, (-1e+30), 0.39288503 < footprint);
    if (t27 >= min(t23, t28) && t27 > min(t28, 0.0))
        return min(t27, t23);
    // library:solids.krs:48
    vec3 v29 = abs(v25) - vec3(0.15, 0.05, 0.1);
    // library:solids.krs:14
    float t30 = KRS_MAX(v29.y, v29.z);
    // tests/golden/moebius.krs:8
    float t31 = (length(max(v29, vec3(0.0))) + min(KRS_MAX(v29.x, t30), 0.0)) * 0.512;
    float t32 = KRS_MIN(t23, t31);
    vec3 v33 = vec3(KRS_MIN(v25.x, 2.0 * 0.1 - v25.x), v25.y, v25.z) - krs_frame0;
    vec3 v34 = vec3(dot(krs_frame1, v33), dot(krs_frame2, v33), dot(krs_frame3, v33)) * 1.25;
    // tests/golden/moebius.krs:4
    float t35 = length(max((abs(v34) - vec3(0.3000003)), vec3(0.0))) * 0.4096;
    float t36 = mix(0.1064172, (-1e+30), 0.2128344 < footprint);
    if (t35 >= min(t32, t36) && t35 > min(t36, 0.0))
        return min(t35, t32);
    float t37 = (length(v34) - 0.3) * 0.4096;
    return KRS_MIN(t32, t37);
}

float krs_distance_lod_2(vec3 p, float footprint)
{
    return krs_distance_2(p);
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
    if (krs_box_distance(p, vec3(2.2025456, 0.0, 0.0), vec3(0.3758914, 0.48396072, 0.48396072)) < max(d, 1e-30))
        d = min(d, krs_distance_lod_2(p, footprint));
    return krs_cut(p, d);
}
#endif

#ifdef PACKED
// Parts of the scene, most of them one component: the distance of one, and a box
// around it; where there is none the box stays empty.
const uint KRS_SCENE_PARTS = 2u;

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
    }
    return krs_cut(p, d);
}

void krs_scene_part_box(uint scene_part, inout vec3 low, inout vec3 high)
{
    switch (scene_part) {
    case 0u:
        low = vec3((-3.6582658), (-0.93471235), (-0.12380768));
        high = vec3(3.8582659, 4.4991107, 0.12380768);
        break;
    case 1u:
        low = vec3(1.8264984, (-0.4841164), (-0.4841164));
        high = vec3(2.5785928, 0.4841164, 0.4841164);
        break;
    }
}
#endif

KrsSurface krs_surface_1(vec3 p, vec3 normal, float footprint)
{
    // library:solids.krs:48
    vec3 v0 = abs(p) - vec3(0.15, 0.05, 0.1);
    // library:solids.krs:14
    float t1 = KRS_MAX(v0.y, v0.z);
    float t2 = length(max(v0, vec3(0.0))) + min(KRS_MAX(v0.x, t1), 0.0);
    // tests/golden/moebius.krs:8
    vec3 v3 = vec3(KRS_MIN(p.x, 2.0 * 0.1 - p.x), p.y, p.z) - krs_frame0;
    vec3 v4 = vec3(dot(krs_frame1, v3), dot(krs_frame2, v3), dot(krs_frame3, v3)) * 1.25;
    // library:solids.krs:48
    vec3 v5 = abs(v4) - vec3(0.15, 0.05, 0.1);
    // library:solids.krs:14
    float t6 = KRS_MAX(v5.y, v5.z);
    // tests/golden/moebius.krs:8
    float t7 = (length(max(v5, vec3(0.0))) + min(KRS_MAX(v5.x, t6), 0.0)) * 0.8;
    float t8 = KRS_MIN(t2, t7);
    vec3 v9 = vec3(KRS_MIN(v4.x, 2.0 * 0.1 - v4.x), v4.y, v4.z) - krs_frame0;
    vec3 v10 = vec3(dot(krs_frame1, v9), dot(krs_frame2, v9), dot(krs_frame3, v9)) * 1.25;
    // library:solids.krs:48
    vec3 v11 = abs(v10) - vec3(0.15, 0.05, 0.1);
    // library:solids.krs:14
    float t12 = KRS_MAX(v11.y, v11.z);
    // tests/golden/moebius.krs:8
    float t13 = (length(max(v11, vec3(0.0))) + min(KRS_MAX(v11.x, t12), 0.0)) * 0.64;
    float t14 = KRS_MIN(t8, t13);
    vec3 v15 = vec3(KRS_MIN(v10.x, 2.0 * 0.1 - v10.x), v10.y, v10.z) - krs_frame0;
    vec3 v16 = vec3(dot(krs_frame1, v15), dot(krs_frame2, v15), dot(krs_frame3, v15)) * 1.25;
    // library:solids.krs:48
    vec3 v17 = abs(v16) - vec3(0.15, 0.05, 0.1);
    // library:solids.krs:14
    float t18 = KRS_MAX(v17.y, v17.z);
    // tests/golden/moebius.krs:8
    float t19 = (length(max(v17, vec3(0.0))) + min(KRS_MAX(v17.x, t18), 0.0)) * 0.512;
    float t20 = KRS_MIN(t14, t19);
    vec3 v21 = vec3(KRS_MIN(v16.x, 2.0 * 0.1 - v16.x), v16.y, v16.z) - krs_frame0;
    vec3 v22 = vec3(dot(krs_frame1, v21), dot(krs_frame2, v21), dot(krs_frame3, v21)) * 1.25;
    // tests/golden/moebius.krs:4
    float t23 = (length(v22) - 0.3) * 0.4096;
    float t24 = KRS_MIN(t20, t23);
    // tests/golden/moebius.krs:8
    uint n25 = 1u * 2u + uint((dot(vec3(1.0, 0.0, 0.0), p) > 0.1));
    bool b26 = t2 < t7;
    uint n27 = n25 * 2u + uint((dot(vec3(1.0, 0.0, 0.0), v4) > 0.1));
    bool b28 = t8 < t13;
    uint n29 = n27 * 2u + uint((dot(vec3(1.0, 0.0, 0.0), v10) > 0.1));
    bool b30 = t14 < t19;
    // tests/golden/moebius.krs:4
    bool b31 = t20 < t23;
    float t32 = mix(0.0, mix(1.0, mix(2.0, mix(3.0, 4.0, b26), b28), b30), b31);
    uint n33 = b31 ? (b30 ? (b28 ? (b26 ? 1u : n25) : n27) : n29) : (n29 * 2u + uint((dot(vec3(1.0, 0.0, 0.0), v16) > 0.1)));
    return KrsSurface(t24, vec3(0.6), 0.6, 0.0, vec3(0.0), 1u, uint(t32), n33, normal);
}

KrsSurface krs_surface_2(vec3 p, vec3 normal, float footprint)
{
    // tests/golden/moebius.krs:11
    float t0 = length((p - vec3(2.3846219, 0.0, 0.0))) - 0.5995648;
    vec3 v1 = p - vec3(1.0, 0.0, 0.0);
    float t2 = 2.25 / max(dot(v1, v1), 2.25e-12);
    // library:solids.krs:48
    vec3 v3 = abs(((v1 * t2) + vec3((-2.0), 0.0, 0.0))) - vec3(0.5);
    // library:solids.krs:14
    float t4 = KRS_MAX(v3.y, v3.z);
    float t5 = length(max(v3, vec3(0.0))) + min(KRS_MAX(v3.x, t4), 0.0);
    // tests/golden/moebius.krs:11
    float t6 = t5 / (t2 + ((sqrt(t2) * 0.6666667) * abs(t5)));
    float t7 = KRS_MAX(t0, t6);
    return KrsSurface(t7, vec3(0.6), 0.6, 0.0, vec3(0.0), 2u, uint(0.0), 1u, normal);
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
    float cut = krs_cut(p, nearest.distance);
    if (cut > nearest.distance)
        nearest.normal = normal;
    nearest.distance = cut;
    return nearest;
}
#endif
