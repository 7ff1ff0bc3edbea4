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

float krs_frame0;
float krs_frame1;
float krs_frame2;

void krs_prepare()
{
    krs_frame0 = krs_parameter[1].x;
    // tests/golden/folds.krs:7
    krs_frame1 = krs_frame0 * 1e-06;
    krs_frame2 = (krs_frame0 * krs_frame0) / max(krs_frame0, 1.7196324);
}

float krs_shared_1(vec3 p, out float s0, out float s1, out float s2, out vec3 s3, out float s4)
{
    // tests/golden/folds.krs:3
    vec3 v0 = p - vec3(0.18, 0.81, 0.9);
    float t1 = length(v0);
    float t2 = 1.0 / max(t1, 4.5e-07);
    float t3 = t2 * 0.45;
    vec3 v4 = p + (v0 * max(((t3 * t3) - 1.0), 0.0));
    float t5 = 0.09111234 - t1;
    vec3 v6 = vec3(v4.x, v4.y, min(v4.z, 2.0 * 0.5 - v4.z));
    // library:solids.krs
    vec3 v7 = abs((v4 - vec3(0.0, 1.0, 0.0))) - vec3(0.15, 0.05, 0.1);
    float t8 = max(v7.y, v7.z);
    float t9 = length(max(v7, vec3(0.0))) + min(max(v7.x, t8), 0.0);
    // tests/golden/folds.krs:7
    float t10 = length(v6);
    float t11 = 1.0 / max(t10, krs_frame1);
    float t12 = krs_frame0 * t11;
    float t13 = krs_frame2 - t10;
    // tests/golden/folds.krs:4
    vec3 v14 = (v6 + (v6 * max(((t12 * t12) - 1.0), 0.0))) - vec3(1.2, 0.0, 0.0);
    // library:solids.krs
    float t15 = length(v14) - 0.3;
    // tests/golden/folds.krs:4
    float t16 = t15 / max((t11 * ((krs_frame0 * max(t12, 1.0)) + abs(t15))), 1.0);
    float t17 = max(t13, t16);
    float t18 = min(t9, t17);
    float t19 = t18 / max((t2 * ((max(t3, 1.0) * 0.45) + abs(t18))), 1.0);
    float t20 = max(t5, t19);
    s0 = t9;
    s1 = t17;
    s2 = t1;
    s3 = v4;
    s4 = t10;
    return t20;
}

float krs_distance_1(vec3 p)
{
    float s0;
    float s1;
    float s2;
    vec3 s3;
    float s4;
    return krs_shared_1(p, s0, s1, s2, s3, s4);
}

float krs_distance_lod_1(vec3 p, float footprint)
{
    // tests/golden/folds.krs:4
    vec3 v0 = abs((p - vec3(0.69249505, 0.20649655, 0.5))) - vec3(0.8624104, 0.85984737, 1.1533508);
    float t1 = length(max(v0, vec3(0.0)));
    float t2 = mix(0.6677266, (-1e+30), 1.3354532 < footprint);
    if (t1 >= t2 && t1 > min(t2, 0.0))
        return t1;
    // tests/golden/folds.krs:3
    vec3 v3 = p - vec3(0.18, 0.81, 0.9);
    float t4 = length(v3);
    float t5 = 1.0 / max(t4, 4.5e-07);
    float t6 = t5 * 0.45;
    float t7 = max(t6, 1.0);
    vec3 v8 = p + (v3 * max(((t6 * t6) - 1.0), 0.0));
    float t9 = 0.09111234 - t4;
    float t10 = 1.0 / (t7 * t7);
    // tests/golden/folds.krs:4
    vec3 v11 = abs((v8 - vec3(0.69249505, 0.20649655, 0.5))) - vec3(0.8624104, 0.85984737, 1.1533508);
    float t12 = length(max(v11, vec3(0.0)));
    float t13 = mix(0.6677266, (-1e+30), (t10 * 1.3354532) < footprint);
    float t14 = min(t12, 1e+30);
    if (!(t12 >= t13 && t12 > min(t13, 0.0))) {
    // tests/golden/folds.krs:3
    vec3 v15 = vec3(v8.x, v8.y, min(v8.z, 2.0 * 0.5 - v8.z));
    // library:solids.krs
    vec3 v16 = abs((v8 - vec3(0.0, 1.0, 0.0))) - vec3(0.15, 0.05, 0.1);
    float t17 = max(v16.y, v16.z);
    float t18 = length(max(v16, vec3(0.0))) + min(max(v16.x, t17), 0.0);
    // tests/golden/folds.krs:7
    float t19 = length(v15);
    float t20 = 1.0 / max(t19, krs_frame1);
    float t21 = krs_frame0 * t20;
    float t22 = max(t21, 1.0);
    vec3 v23 = v15 + (v15 * max(((t21 * t21) - 1.0), 0.0));
    float t24 = krs_frame2 - t19;
    // tests/golden/folds.krs:4
    vec3 v25 = abs((v23 - vec3(1.2, 0.0, 0.0))) - vec3(0.35490537, 0.35490537, 0.35490537);
    float t26 = length(max(v25, vec3(0.0)));
    float t27 = mix(0.25980762, (-1e+30), ((t10 * (1.0 / (t22 * t22))) * 0.51961523) < footprint);
    float t28 = min(t26, 1e+30);
    if (!(t26 >= t27 && t26 > min(t27, 0.0))) {
    t28 = (length((v23 - vec3(1.2, 0.0, 0.0))) - 0.3);
    }
    float t29 = t28 / max((t20 * ((krs_frame0 * t22) + abs(t28))), 1.0);
    float t30 = max(t24, t29);
    t14 = min(t18, t30);
    }
    float t31 = t14 / max((t5 * ((t7 * 0.45) + abs(t14))), 1.0);
    return max(t9, t31);
}

KrsSurface krs_surface_1(vec3 p, vec3 normal, float footprint)
{
    float s0;
    float s1;
    float s2;
    vec3 s3;
    float s4;
    float d = krs_shared_1(p, s0, s1, s2, s3, s4);
    // tests/golden/folds.krs:3
    uint n0 = 1u * 2u + uint((0.0 < (0.45 - s2)));
    // tests/golden/folds.krs:7
    uint n1 = (n0 * 2u + uint((dot(vec3(0.0, 0.0, 1.0), s3) > 0.5))) * 2u + uint((0.0 < (krs_frame0 - s4)));
    // tests/golden/folds.krs:4
    bool b2 = s0 < s1;
    float t3 = mix(0.0, 2.0, b2);
    uint n4 = b2 ? n0 : n1;
    return KrsSurface(d, vec3(0.6), 0.6, 0.0, vec3(0.0), 1.0, 1.5, 0.0, vec3(0.0), 0.0, 0.0, vec3(0.0), 0.5, 0.0, 0.5, 1.4, 0.0, vec3(0.0), 0.0, vec3(0.8), vec3(1.0), 1u, uint(t3), n4, 0u, normal);
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

