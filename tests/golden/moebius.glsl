// Distance code of a scene; slot 0 holds the time, then one slot for each `param`.
layout(std140, set = 0, binding = 0) uniform KrsParameters { vec4 krs_parameter[2]; };

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

float krs_cos(float a)
{
    float n = floor(a * 0.318309886184);
    return krs_sine_small(krs_reduce(a, n + 0.5), int(n) + 1);
}

float krs_sin(float a)
{
    float n = floor(a * 0.318309886184 + 0.5);
    return krs_sine_small(krs_reduce(a, n), int(n));
}

float krs_box_distance(vec3 p, vec3 center, vec3 half_sides)
{
    return length(max(abs(p - center) - half_sides, vec3(0.0)));
}

vec3 krs_frame0;
vec3 krs_frame1;
vec3 krs_frame2;
vec3 krs_frame3;

void krs_prepare()
{
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
}

float krs_shared_1(vec3 p, out float s0, out float s1, out float s2, out float s3, out vec3 s4, out float s5, out float s6, out vec3 s7, out float s8, out float s9, out vec3 s10)
{
    // library:solids.krs
    vec3 v0 = abs(p) - vec3(0.15, 0.05, 0.1);
    float t1 = max(v0.y, v0.z);
    float t2 = length(max(v0, vec3(0.0))) + min(max(v0.x, t1), 0.0);
    // tests/golden/moebius.krs:8
    vec3 v3 = vec3(min(p.x, 2.0 * 0.1 - p.x), p.y, p.z) - krs_frame0;
    vec3 v4 = vec3(dot(krs_frame1, v3), dot(krs_frame2, v3), dot(krs_frame3, v3)) * 1.25;
    // library:solids.krs
    vec3 v5 = abs(v4) - vec3(0.15, 0.05, 0.1);
    float t6 = max(v5.y, v5.z);
    // tests/golden/moebius.krs:8
    float t7 = (length(max(v5, vec3(0.0))) + min(max(v5.x, t6), 0.0)) * 0.8;
    float t8 = min(t2, t7);
    vec3 v9 = vec3(min(v4.x, 2.0 * 0.1 - v4.x), v4.y, v4.z) - krs_frame0;
    vec3 v10 = vec3(dot(krs_frame1, v9), dot(krs_frame2, v9), dot(krs_frame3, v9)) * 1.25;
    // library:solids.krs
    vec3 v11 = abs(v10) - vec3(0.15, 0.05, 0.1);
    float t12 = max(v11.y, v11.z);
    // tests/golden/moebius.krs:8
    float t13 = (length(max(v11, vec3(0.0))) + min(max(v11.x, t12), 0.0)) * 0.64;
    float t14 = min(t8, t13);
    vec3 v15 = vec3(min(v10.x, 2.0 * 0.1 - v10.x), v10.y, v10.z) - krs_frame0;
    vec3 v16 = vec3(dot(krs_frame1, v15), dot(krs_frame2, v15), dot(krs_frame3, v15)) * 1.25;
    // library:solids.krs
    vec3 v17 = abs(v16) - vec3(0.15, 0.05, 0.1);
    float t18 = max(v17.y, v17.z);
    // tests/golden/moebius.krs:8
    float t19 = (length(max(v17, vec3(0.0))) + min(max(v17.x, t18), 0.0)) * 0.512;
    float t20 = min(t14, t19);
    vec3 v21 = vec3(min(v16.x, 2.0 * 0.1 - v16.x), v16.y, v16.z) - krs_frame0;
    vec3 v22 = vec3(dot(krs_frame1, v21), dot(krs_frame2, v21), dot(krs_frame3, v21)) * 1.25;
    // tests/golden/moebius.krs:4
    float t23 = (length(v22) - 0.3) * 0.4096;
    float t24 = min(t20, t23);
    s0 = t20;
    s1 = t23;
    s2 = t14;
    s3 = t19;
    s4 = v16;
    s5 = t8;
    s6 = t13;
    s7 = v10;
    s8 = t2;
    s9 = t7;
    s10 = v4;
    return t24;
}

float krs_distance_1(vec3 p)
{
    float s0;
    float s1;
    float s2;
    float s3;
    vec3 s4;
    float s5;
    float s6;
    vec3 s7;
    float s8;
    float s9;
    vec3 s10;
    return krs_shared_1(p, s0, s1, s2, s3, s4, s5, s6, s7, s8, s9, s10);
}

float krs_distance_2(vec3 p)
{
    // tests/golden/moebius.krs:11
    float t0 = length((p - vec3(2.3846219, 0.0, 0.0))) - 0.5995648;
    vec3 v1 = p - vec3(1.0, 0.0, 0.0);
    float t2 = 2.25 / max(dot(v1, v1), 2.25e-12);
    // library:solids.krs
    vec3 v3 = abs(((v1 * t2) + vec3((-2.0), 0.0, 0.0))) - vec3(0.5);
    float t4 = max(v3.y, v3.z);
    float t5 = length(max(v3, vec3(0.0))) + min(max(v3.x, t4), 0.0);
    // tests/golden/moebius.krs:11
    float t6 = t5 / (t2 + ((sqrt(t2) * 0.6666667) * abs(t5)));
    float t7 = max(t0, t6);
    return t7;
}

float krs_distance_lod_1(vec3 p, float footprint)
{
    // tests/golden/moebius.krs:4
    vec3 v0 = abs((p - vec3(0.1, 1.7821991, 0.0))) - vec3(3.757339, 2.7159839, 0.1228845);
    float t1 = length(max(v0, vec3(0.0)));
    float t2 = mix(2.3189008, (-1e+30), 4.6378016 < footprint);
    if (t1 >= t2 && t1 > min(t2, 0.0))
        return t1;
    // library:solids.krs
    vec3 v3 = abs(p) - vec3(0.15, 0.05, 0.1);
    float t4 = max(v3.y, v3.z);
    float t5 = length(max(v3, vec3(0.0))) + min(max(v3.x, t4), 0.0);
    // tests/golden/moebius.krs:8
    vec3 v6 = vec3(min(p.x, 2.0 * 0.1 - p.x), p.y, p.z) - krs_frame0;
    vec3 v7 = vec3(dot(krs_frame1, v6), dot(krs_frame2, v6), dot(krs_frame3, v6)) * 1.25;
    // tests/golden/moebius.krs:4
    vec3 v8 = abs((v7 - vec3(0.1, 1.3936018, 0.0))) - vec3(2.1999407, 1.5437934, 0.15360294);
    float t9 = length(max(v8, vec3(0.0))) * 0.8;
    float t10 = mix(1.076781, (-1e+30), 2.153562 < footprint);
    if (t9 >= min(t5, t10) && t9 > min(t10, 0.0))
        return min(t9, t5);
    // library:solids.krs
    vec3 v11 = abs(v7) - vec3(0.15, 0.05, 0.1);
    float t12 = max(v11.y, v11.z);
    // tests/golden/moebius.krs:8
    float t13 = (length(max(v11, vec3(0.0))) + min(max(v11.x, t12), 0.0)) * 0.8;
    float t14 = min(t5, t13);
    vec3 v15 = vec3(min(v7.x, 2.0 * 0.1 - v7.x), v7.y, v7.z) - krs_frame0;
    vec3 v16 = vec3(dot(krs_frame1, v15), dot(krs_frame2, v15), dot(krs_frame3, v15)) * 1.25;
    // tests/golden/moebius.krs:4
    vec3 v17 = abs((v16 - vec3(0.1, 0.90785515, 0.0))) - vec3(1.1549829, 0.957857, 0.19200186);
    float t18 = length(max(v17, vec3(0.0))) * 0.64;
    float t19 = mix(0.4540648, (-1e+30), 0.9081296 < footprint);
    if (t18 >= min(t14, t19) && t18 > min(t19, 0.0))
        return min(t18, t14);
    // library:solids.krs
    vec3 v20 = abs(v16) - vec3(0.15, 0.05, 0.1);
    float t21 = max(v20.y, v20.z);
    // tests/golden/moebius.krs:8
    float t22 = (length(max(v20, vec3(0.0))) + min(max(v20.x, t21), 0.0)) * 0.64;
    float t23 = min(t14, t22);
    vec3 v24 = vec3(min(v16.x, 2.0 * 0.1 - v16.x), v16.y, v16.z) - krs_frame0;
    vec3 v25 = vec3(dot(krs_frame1, v24), dot(krs_frame2, v24), dot(krs_frame3, v24)) * 1.25;
    // tests/golden/moebius.krs:4
    vec3 v26 = abs((v25 - vec3(0.1, 0.4959765, 0.0))) - vec3(0.5419541, 0.54597753, 0.24000104);
    float t27 = length(max(v26, vec3(0.0))) * 0.512;
    float t28 = mix(0.19644251, (-1e+30), 0.39288503 < footprint);
    if (t27 >= min(t23, t28) && t27 > min(t28, 0.0))
        return min(t27, t23);
    // library:solids.krs
    vec3 v29 = abs(v25) - vec3(0.15, 0.05, 0.1);
    float t30 = max(v29.y, v29.z);
    // tests/golden/moebius.krs:8
    float t31 = (length(max(v29, vec3(0.0))) + min(max(v29.x, t30), 0.0)) * 0.512;
    float t32 = min(t23, t31);
    vec3 v33 = vec3(min(v25.x, 2.0 * 0.1 - v25.x), v25.y, v25.z) - krs_frame0;
    vec3 v34 = vec3(dot(krs_frame1, v33), dot(krs_frame2, v33), dot(krs_frame3, v33)) * 1.25;
    // tests/golden/moebius.krs:4
    float t35 = length(max((abs(v34) - vec3(0.3000003)), vec3(0.0))) * 0.4096;
    float t36 = mix(0.1064172, (-1e+30), 0.2128344 < footprint);
    if (t35 >= min(t32, t36) && t35 > min(t36, 0.0))
        return min(t35, t32);
    float t37 = (length(v34) - 0.3) * 0.4096;
    return min(t32, t37);
}

float krs_distance_lod_2(vec3 p, float footprint)
{
    return krs_distance_2(p);
}

KrsSurface krs_surface_1(vec3 p, vec3 normal, float footprint)
{
    float s0;
    float s1;
    float s2;
    float s3;
    vec3 s4;
    float s5;
    float s6;
    vec3 s7;
    float s8;
    float s9;
    vec3 s10;
    float d = krs_shared_1(p, s0, s1, s2, s3, s4, s5, s6, s7, s8, s9, s10);
    // tests/golden/moebius.krs:8
    uint n0 = 1u * 2u + uint((dot(vec3(1.0, 0.0, 0.0), p) > 0.1));
    bool b1 = s8 < s9;
    uint n2 = n0 * 2u + uint((dot(vec3(1.0, 0.0, 0.0), s10) > 0.1));
    bool b3 = s5 < s6;
    uint n4 = n2 * 2u + uint((dot(vec3(1.0, 0.0, 0.0), s7) > 0.1));
    bool b5 = s2 < s3;
    // tests/golden/moebius.krs:4
    bool b6 = s0 < s1;
    float t7 = mix(0.0, mix(1.0, mix(2.0, mix(3.0, 4.0, b1), b3), b5), b6);
    uint n8 = b6 ? (b5 ? (b3 ? (b1 ? 1u : n0) : n2) : n4) : (n4 * 2u + uint((dot(vec3(1.0, 0.0, 0.0), s4) > 0.1)));
    return KrsSurface(d, vec3(0.6), 0.6, 0.0, vec3(0.0), 1.0, 1.5, 0.0, vec3(0.0), 0.0, 0.0, vec3(0.0), 0.5, 0.0, 0.5, 1.4, 0.0, vec3(0.0), 0.0, vec3(0.8), vec3(1.0), 1u, uint(t7), n8, 0u, normal);
}

KrsSurface krs_surface_2(vec3 p, vec3 normal, float footprint)
{
    float d = krs_distance_2(p);
    return KrsSurface(d, vec3(0.6), 0.6, 0.0, vec3(0.0), 1.0, 1.5, 0.0, vec3(0.0), 0.0, 0.0, vec3(0.0), 0.5, 0.0, 0.5, 1.4, 0.0, vec3(0.0), 0.0, vec3(0.8), vec3(1.0), 2u, uint(0.0), 1u, 0u, normal);
}

float krs_distance(vec3 p)
{
    float d = krs_distance_1(p);
    d = min(d, krs_distance_2(p));
    return d;
}

float krs_distance_lod(vec3 p, float footprint)
{
    float d = krs_distance_lod_1(p, footprint);
    if (krs_box_distance(p, vec3(2.2025456, 0.0, 0.0), vec3(0.3758914, 0.48396072, 0.48396072)) < max(d, 1e-30))
        d = min(d, krs_distance_lod_2(p, footprint));
    return d;
}

KrsSurface krs_surface(vec3 p, vec3 normal, float footprint)
{
    KrsSurface nearest = krs_surface_1(p, normal, footprint);
    KrsSurface other;
    other = krs_surface_2(p, normal, footprint);
    if (other.distance < nearest.distance)
        nearest = other;
    return nearest;
}

