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

float krs_inverse_length(float square)
{
    return mix(0.0, inversesqrt(square), square > 0.0);
}

vec3 krs_normalize_vec3(vec3 a) { return a * krs_inverse_length(dot(a, a)); }

float krs_mirror_excess(vec3 p, vec3 n, float w)
{
    return (p.x * n.x + p.y * n.y) + (p.z * n.z - w);
}

vec3 krs_fold(vec3 p, vec3 n, float w)
{
    return p - max(krs_mirror_excess(p, n, w), 0.0) * (2.0 * n);
}

vec3 krs_frame0;
float krs_frame1;
vec3 krs_frame2;
float krs_frame3;
vec3 krs_frame4;
float krs_frame5;
vec3 krs_frame6;
float krs_frame7;
vec3 krs_frame8;
float krs_frame9;

void krs_prepare()
{
    // tests/golden/sequence.krs:6
    vec3 v0 = vec3(krs_cos(krs_parameter[1].x), krs_sin(krs_parameter[1].x), 0.2);
    krs_frame0 = krs_normalize_vec3(v0);
    krs_frame1 = 0.3 / length(v0);
    float t1 = krs_parameter[1].x * 2.0;
    vec3 v2 = vec3(krs_cos(t1), krs_sin(t1), 0.2);
    krs_frame2 = krs_normalize_vec3(v2);
    krs_frame3 = 0.3 / length(v2);
    float t3 = krs_parameter[1].x * 3.0;
    vec3 v4 = vec3(krs_cos(t3), krs_sin(t3), 0.2);
    krs_frame4 = krs_normalize_vec3(v4);
    krs_frame5 = 0.3 / length(v4);
    float t5 = krs_parameter[1].x * 4.0;
    vec3 v6 = vec3(krs_cos(t5), krs_sin(t5), 0.2);
    krs_frame6 = krs_normalize_vec3(v6);
    krs_frame7 = 0.3 / length(v6);
    float t7 = krs_parameter[1].x * 5.0;
    vec3 v8 = vec3(krs_cos(t7), krs_sin(t7), 0.2);
    krs_frame8 = krs_normalize_vec3(v8);
    krs_frame9 = 0.3 / length(v8);
}

float krs_distance_1(vec3 p)
{
    // tests/golden/sequence.krs:3
    vec3 v0 = krs_fold(p, krs_frame8, krs_frame9);
    // library:solids.krs
    float t1 = length((p - vec3(0.5, 0.5, 0.0))) - 0.2;
    // tests/golden/sequence.krs:7
    vec3 v2 = krs_fold(v0, krs_frame6, krs_frame7);
    // library:solids.krs
    float t3 = length((v0 - vec3(0.4, 0.5, 0.0))) - 0.2;
    // tests/golden/sequence.krs:7
    float t4 = min(t1, t3);
    vec3 v5 = krs_fold(v2, krs_frame4, krs_frame5);
    // library:solids.krs
    float t6 = length((v2 - vec3(0.3, 0.5, 0.0))) - 0.2;
    // tests/golden/sequence.krs:7
    float t7 = min(t4, t6);
    vec3 v8 = krs_fold(v5, krs_frame2, krs_frame3);
    // library:solids.krs
    float t9 = length((v5 - vec3(0.2, 0.5, 0.0))) - 0.2;
    // tests/golden/sequence.krs:7
    float t10 = min(t7, t9);
    vec3 v11 = krs_fold(v8, krs_frame0, krs_frame1);
    // library:solids.krs
    float t12 = length((v8 - vec3(0.1, 0.5, 0.0))) - 0.2;
    // tests/golden/sequence.krs:7
    float t13 = min(t10, t12);
    vec3 v14 = krs_fold(v11, vec3(0.9805807, 0.0, 0.19611613), 0.2941742);
    // library:solids.krs
    float t15 = length((v11 - vec3(0.0, 0.5, 0.0))) - 0.2;
    // tests/golden/sequence.krs:7
    float t16 = min(t13, t15);
    // library:solids.krs
    float t17 = min(max(dot(v14, vec3(0.0, 1.0, 0.0)), 0.0), 1.0);
    float t18 = t17 * 0.0;
    float t19 = length((v14 - vec3(t18, t17, t18))) - 0.08;
    // tests/golden/sequence.krs:4
    float t20 = min(t16, t19);
    return t20;
}

float krs_distance_lod_1(vec3 p, float footprint)
{
    // tests/golden/sequence.krs:4
    vec3 v0 = max((abs((p - vec3(0.19529413, 0.98853356, 1.3386656))) - vec3(23.841957)), vec3(0.0));
    float t1 = length(v0);
    float t2 = mix(11.920966, (-1e+30), 23.841932 < footprint);
    if (t1 >= t2 && t1 > min(t2, 0.0))
        return t1;
    // tests/golden/sequence.krs:3
    vec3 v3 = krs_fold(p, krs_frame8, krs_frame9);
    // library:solids.krs
    float t4 = length((p - vec3(0.5, 0.5, 0.0))) - 0.2;
    // tests/golden/sequence.krs:4
    vec3 v5 = max((abs((v3 - vec3(0.19529413, 0.98853356, 1.1247915))) - vec3(17.059797)), vec3(0.0));
    float t6 = length(v5);
    float t7 = mix(8.529889, (-1e+30), 17.059778 < footprint);
    if (t6 >= min(t4, t7) && t6 > min(t7, 0.0))
        return min(t6, t4);
    // tests/golden/sequence.krs:7
    vec3 v8 = krs_fold(v3, krs_frame6, krs_frame7);
    // library:solids.krs
    float t9 = length((v3 - vec3(0.4, 0.5, 0.0))) - 0.2;
    // tests/golden/sequence.krs:7
    float t10 = min(t4, t9);
    // tests/golden/sequence.krs:4
    vec3 v11 = max((abs((v8 - vec3(0.19529413, 0.98853356, 0.6273937))) - vec3(10.23508)), vec3(0.0));
    float t12 = length(v11);
    float t13 = mix(5.117534, (-1e+30), 10.235068 < footprint);
    if (t12 >= min(t10, t13) && t12 > min(t13, 0.0))
        return min(t12, t10);
    // tests/golden/sequence.krs:7
    vec3 v14 = krs_fold(v8, krs_frame4, krs_frame5);
    // library:solids.krs
    float t15 = length((v8 - vec3(0.3, 0.5, 0.0))) - 0.2;
    // tests/golden/sequence.krs:7
    float t16 = min(t10, t15);
    // tests/golden/sequence.krs:4
    vec3 v17 = max((abs((v14 - vec3(0.19529413, 1.0332536, 0.67211366))) - vec3(5.757064)), vec3(0.0));
    float t18 = length(v17);
    float t19 = mix(2.8785286, (-1e+30), 5.757057 < footprint);
    if (t18 >= min(t16, t19) && t18 > min(t19, 0.0))
        return min(t18, t16);
    // tests/golden/sequence.krs:7
    vec3 v20 = krs_fold(v14, krs_frame2, krs_frame3);
    // library:solids.krs
    float t21 = length((v14 - vec3(0.2, 0.5, 0.0))) - 0.2;
    // tests/golden/sequence.krs:7
    float t22 = min(t16, t21);
    // tests/golden/sequence.krs:4
    vec3 v23 = abs((v20 - vec3(0.08748466, 0.3945249, (-0.28967765)))) - vec3(1.7067112, 1.8145207, 1.0555377);
    float t24 = length(max(v23, vec3(0.0)));
    float t25 = mix(0.9072592, (-1e+30), 1.8145185 < footprint);
    if (t24 >= min(t22, t25) && t24 > min(t25, 0.0))
        return min(t24, t22);
    // tests/golden/sequence.krs:7
    vec3 v26 = krs_fold(v20, krs_frame0, krs_frame1);
    // library:solids.krs
    float t27 = length((v20 - vec3(0.1, 0.5, 0.0))) - 0.2;
    // tests/golden/sequence.krs:7
    float t28 = min(t22, t27);
    // tests/golden/sequence.krs:4
    vec3 v29 = abs((v26 - vec3(0.24076924, 0.5, 0.01))) - vec3(0.4407703, 0.58000106, 0.21000108);
    float t30 = length(max(v29, vec3(0.0)));
    float t31 = mix(0.35492435, (-1e+30), 0.7098487 < footprint);
    if (t30 >= min(t28, t31) && t30 > min(t31, 0.0))
        return min(t30, t28);
    // tests/golden/sequence.krs:7
    vec3 v32 = krs_fold(v26, vec3(0.9805807, 0.0, 0.19611613), 0.2941742);
    // library:solids.krs
    float t33 = length((v26 - vec3(0.0, 0.5, 0.0))) - 0.2;
    // tests/golden/sequence.krs:7
    float t34 = min(t28, t33);
    // tests/golden/sequence.krs:4
    vec3 v35 = abs((v32 - vec3(0.0, 0.5, 0.0))) - vec3(0.08000108, 0.58000106, 0.08000108);
    float t36 = length(max(v35, vec3(0.0)));
    float t37 = mix(0.29546574, (-1e+30), 0.5909315 < footprint);
    if (t36 >= min(t34, t37) && t36 > min(t37, 0.0))
        return min(t36, t34);
    // library:solids.krs
    float t38 = min(max(dot(v32, vec3(0.0, 1.0, 0.0)), 0.0), 1.0);
    float t39 = t38 * 0.0;
    float t40 = length((v32 - vec3(t39, t38, t39))) - 0.08;
    return min(t34, t40);
}

KrsSurface krs_surface_1(vec3 p, vec3 normal, float footprint)
{
    // tests/golden/sequence.krs:3
    vec3 v0 = krs_fold(p, krs_frame8, krs_frame9);
    // library:solids.krs
    float t1 = length((p - vec3(0.5, 0.5, 0.0))) - 0.2;
    // tests/golden/sequence.krs:7
    vec3 v2 = krs_fold(v0, krs_frame6, krs_frame7);
    // library:solids.krs
    float t3 = length((v0 - vec3(0.4, 0.5, 0.0))) - 0.2;
    // tests/golden/sequence.krs:7
    float t4 = min(t1, t3);
    vec3 v5 = krs_fold(v2, krs_frame4, krs_frame5);
    // library:solids.krs
    float t6 = length((v2 - vec3(0.3, 0.5, 0.0))) - 0.2;
    // tests/golden/sequence.krs:7
    float t7 = min(t4, t6);
    vec3 v8 = krs_fold(v5, krs_frame2, krs_frame3);
    // library:solids.krs
    float t9 = length((v5 - vec3(0.2, 0.5, 0.0))) - 0.2;
    // tests/golden/sequence.krs:7
    float t10 = min(t7, t9);
    vec3 v11 = krs_fold(v8, krs_frame0, krs_frame1);
    // library:solids.krs
    float t12 = length((v8 - vec3(0.1, 0.5, 0.0))) - 0.2;
    // tests/golden/sequence.krs:7
    float t13 = min(t10, t12);
    vec3 v14 = krs_fold(v11, vec3(0.9805807, 0.0, 0.19611613), 0.2941742);
    // library:solids.krs
    float t15 = length((v11 - vec3(0.0, 0.5, 0.0))) - 0.2;
    // tests/golden/sequence.krs:7
    float t16 = min(t13, t15);
    // library:solids.krs
    float t17 = min(max(dot(v14, vec3(0.0, 1.0, 0.0)), 0.0), 1.0);
    float t18 = t17 * 0.0;
    float t19 = length((v14 - vec3(t18, t17, t18))) - 0.08;
    // tests/golden/sequence.krs:4
    float t20 = min(t16, t19);
    // tests/golden/sequence.krs:7
    uint n21 = 1u * 2u + uint((dot(krs_frame8, p) > krs_frame9));
    bool b22 = t1 < t3;
    uint n23 = n21 * 2u + uint((dot(krs_frame6, v0) > krs_frame7));
    bool b24 = t4 < t6;
    uint n25 = n23 * 2u + uint((dot(krs_frame4, v2) > krs_frame5));
    bool b26 = t7 < t9;
    uint n27 = n25 * 2u + uint((dot(krs_frame2, v5) > krs_frame3));
    bool b28 = t10 < t12;
    uint n29 = n27 * 2u + uint((dot(krs_frame0, v8) > krs_frame1));
    bool b30 = t13 < t15;
    float t31 = mix(1.0, mix(2.0, mix(3.0, mix(4.0, mix(5.0, 6.0, b22), b24), b26), b28), b30);
    uint n32 = b30 ? (b28 ? (b26 ? (b24 ? (b22 ? 1u : n21) : n23) : n25) : n27) : n29;
    uint n33 = n29 * 2u + uint((dot(vec3(0.9805807, 0.0, 0.19611613), v11) > 0.2941742));
    // tests/golden/sequence.krs:4
    bool b34 = t16 < t19;
    float t35 = mix(0.0, t31, b34);
    uint n36 = b34 ? n32 : n33;
    return KrsSurface(t20, vec3(0.6), 0.6, 0.0, vec3(0.0), 1.0, 1.5, 0.0, vec3(0.0), 0.0, 0.0, vec3(0.0), 0.5, 0.0, 0.5, 1.4, 0.0, vec3(0.0), 0.0, vec3(0.8), vec3(1.0), 1u, uint(t35), n36, 0u, normal);
}

float krs_distance(vec3 p)
{
    float d = krs_distance_1(p);
    return d;
}

float krs_distance_lod(vec3 p, float footprint)
{
    float d = krs_distance_lod_1(p, footprint);
    return d;
}

KrsSurface krs_surface(vec3 p, vec3 normal, float footprint)
{
    KrsSurface nearest = krs_surface_1(p, normal, footprint);
    return nearest;
}

