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

float krs_inverse_length(float square)
{
    return mix(0.0, inversesqrt(square), square > 0.0);
}

vec3 krs_normalize_vec3(vec3 a) { return a * krs_inverse_length(dot(a, a)); }

float krs_box_distance(vec3 p, vec3 center, vec3 half_sides)
{
    return length(max(abs(p - center) - half_sides, vec3(0.0)));
}

vec3 krs_frame0;

void krs_prepare()
{
    // tests/golden/candle.krs:6
    krs_frame0 = vec3((krs_parameter[1].x * 3.0), (krs_parameter[1].x * 2.0), krs_parameter[1].x);
}

float krs_distance_1(vec3 p)
{
    // tests/golden/candle.krs:7
    vec3 v0 = p - vec3(0.0, 0.7, 0.0);
    // library:solids.krs
    float t1 = length(vec2(v0.x, v0.z)) - 0.3;
    float t2 = abs(v0.y) - 0.6;
    float t3 = length(vec2(max(t1, 0.0), max(t2, 0.0))) + min(max(t1, t2), 0.0);
    return t3;
}

float krs_distance_2(vec3 p)
{
    // library:solids.krs
    float t0 = length((p - vec3(0.0, 1.42, 0.0))) - 0.06;
    return t0;
}

float krs_shared_3(vec3 p, out vec3 s0)
{
    // tests/golden/candle.krs:9
    vec3 v0 = (p - vec3(0.9, 0.2, 0.3)) * vec3(1.0, 1.6666666, 1.0);
    float t1 = (length(v0) - 0.3) * 0.6;
    s0 = v0;
    return t1;
}

float krs_distance_3(vec3 p)
{
    vec3 s0;
    return krs_shared_3(p, s0);
}

float krs_shared_4(vec3 p, out vec3 s0)
{
    // tests/golden/candle.krs:10
    vec3 v0 = p - vec3(0.0, 0.05, 0.0);
    vec3 v1 = vec3(dot(vec3(0.9961947, 0.087155744, 0.0), v0), dot(vec3((-0.087155744), 0.9961947, 0.0), v0), dot(vec3(0.0, 0.0, 1.0), v0));
    // library:solids.krs
    float t2 = length(vec2(v1.x, v1.z)) - 0.7;
    float t3 = abs(v1.y) - 0.05;
    float t4 = length(vec2(max(t2, 0.0), max(t3, 0.0))) + min(max(t2, t3), 0.0);
    s0 = v1;
    return t4;
}

float krs_distance_4(vec3 p)
{
    vec3 s0;
    return krs_shared_4(p, s0);
}

float krs_distance_5(vec3 p)
{
    // library:solids.krs
    float t0 = dot(p, vec3(0.0, 1.0, 0.0));
    return t0;
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

float krs_distance_lod_4(vec3 p, float footprint)
{
    return krs_distance_4(p);
}

float krs_distance_lod_5(vec3 p, float footprint)
{
    return krs_distance_5(p);
}

KrsSurface krs_surface_1(vec3 p, vec3 normal, float footprint)
{
    float d = krs_distance_1(p);
    // tests/golden/candle.krs:3
    float t0 = (p.y * 0.2) + 0.8;
    return KrsSurface(d, vec3(1.0), 0.4, 0.0, vec3(0.0), 1.0, 1.5, 0.0, vec3(0.0), 0.0, 0.0, vec3(0.0), 0.5, 0.0, 0.5, 1.4, 0.0, vec3(0.0), t0, vec3(0.95, 0.8, 0.55), vec3(0.2, 0.1, 0.05), 1u, uint(0.0), 1u, 1u, normal);
}

KrsSurface krs_surface_2(vec3 p, vec3 normal, float footprint)
{
    float d = krs_distance_2(p);
    return KrsSurface(d, vec3(0.0), 0.6, 0.0, krs_frame0, 1.0, 1.5, 0.0, vec3(0.0), 0.0, 0.0, vec3(0.0), 0.5, 0.0, 0.5, 1.4, 0.0, vec3(0.0), 0.0, vec3(0.8), vec3(1.0), 2u, uint(0.0), 1u, 4u, normal);
}

KrsSurface krs_surface_3(vec3 p, vec3 normal, float footprint)
{
    vec3 s0;
    float d = krs_shared_3(p, s0);
    // library:solids.krs
    vec2 v0 = vec2(s0.x, s0.z);
    float t1 = length(v0);
    float t2 = max(t1, 1e-30);
    float t3 = (s0.x * s0.x) + (s0.z * s0.z);
    float t4 = (t1 * t1) + (s0.y * s0.y);
    float t5 = (-s0.y) / t4;
    // tests/golden/candle.krs:9
    vec3 v6 = vec3(((-s0.z) / t3), 0.0, (s0.x / t3));
    vec3 v7 = vec3(((dot(v0, vec2(1.0, 0.0)) / t2) * t5), ((t1 / t4) * 1.6666666), (t5 * (dot(v0, vec2(0.0, 1.0)) / t2)));
    vec3 v8 = cross(v7, normal);
    vec3 v9 = mix(mix(v8, (-v8), bvec3(dot(v6, v8) < 0.0)), v6, bvec3(dot(v8, v8) < (dot(v7, v7) * 0.0001)));
    vec3 v10 = krs_normalize_vec3(v9);
    return KrsSurface(d, vec3(0.9, 0.75, 0.4), 0.4, 1.0, vec3(0.0), 1.0, 1.5, 0.0, vec3(0.0), 0.0, 0.0, vec3(0.0), 0.5, 0.0, 0.5, 1.4, 0.8, v10, 0.0, vec3(0.8), vec3(1.0), 3u, uint(0.0), 1u, 2u, normal);
}

KrsSurface krs_surface_4(vec3 p, vec3 normal, float footprint)
{
    vec3 s0;
    float d = krs_shared_4(p, s0);
    // tests/golden/candle.krs:10
    vec3 v0 = (vec3(0.9961947, 0.087155744, 0.0) * s0.x) + (vec3(0.0, 0.0, 1.0) * s0.z);
    vec3 v1 = krs_normalize_vec3(v0);
    return KrsSurface(d, vec3(0.8, 0.8, 0.82), 0.35, 1.0, vec3(0.0), 1.0, 1.5, 0.0, vec3(0.0), 0.0, 0.0, vec3(0.0), 0.5, 0.0, 0.5, 1.4, 0.9, v1, 0.0, vec3(0.8), vec3(1.0), 4u, uint(0.0), 1u, 3u, normal);
}

KrsSurface krs_surface_5(vec3 p, vec3 normal, float footprint)
{
    float d = krs_distance_5(p);
    return KrsSurface(d, vec3(0.051269457, 0.051269457, 0.064803265), 0.6, 0.0, vec3(0.0), 1.0, 1.5, 0.0, vec3(0.0), 0.0, 0.0, vec3(0.0), 0.5, 0.0, 0.5, 1.4, 0.0, vec3(0.0), 0.0, vec3(0.8), vec3(1.0), 5u, uint(0.0), 1u, 5u, normal);
}

float krs_distance(vec3 p)
{
    float d = krs_distance_1(p);
    d = min(d, krs_distance_2(p));
    d = min(d, krs_distance_3(p));
    d = min(d, krs_distance_4(p));
    d = min(d, krs_distance_5(p));
    return d;
}

float krs_distance_lod(vec3 p, float footprint)
{
    float d = 1e30;
    d = min(d, krs_distance_lod_5(p, footprint));
    if (krs_box_distance(p, vec3(0.0, 0.7, 0.0), vec3(0.3000006, 0.6000019, 0.3000006)) < max(d, 1e-30))
        d = min(d, krs_distance_lod_1(p, footprint));
    if (krs_box_distance(p, vec3(0.0, 1.42, 0.0), vec3(0.06000012, 0.06000154, 0.06000012)) < max(d, 1e-30))
        d = min(d, krs_distance_lod_2(p, footprint));
    if (krs_box_distance(p, vec3(0.9, 0.2, 0.3), vec3(0.3000015, 0.18000056, 0.3000009)) < max(d, 1e-30))
        d = min(d, krs_distance_lod_3(p, footprint));
    if (krs_box_distance(p, vec3(0.0, 0.05, 0.0), vec3(0.7016955, 0.11081903, 0.7000014)) < max(d, 1e-30))
        d = min(d, krs_distance_lod_4(p, footprint));
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
    other = krs_surface_4(p, normal, footprint);
    if (other.distance < nearest.distance)
        nearest = other;
    other = krs_surface_5(p, normal, footprint);
    if (other.distance < nearest.distance)
        nearest = other;
    return nearest;
}

