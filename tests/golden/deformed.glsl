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
    float t0 = length(vec2(p.x, p.z));
    // tests/golden/deformed.krs:2
    float t1 = min(max(p.y, (-1.0)), 1.0);
    float t2 = 0.42426407 / max(t0, 0.42426407);
    float t3 = length(vec2(max((t0 - 0.42426407), 0.0), (p.y - t1)));
    vec3 v4 = vec3((p.x * t2), t1, (p.z * t2));
    float t5 = krs_cos(t1);
    float t6 = krs_sin(t1);
    vec3 v7 = vec3(dot(vec3(t5, 0.0, (-t6)), v4), dot(vec3(0.0, 1.0, 0.0), v4), dot(vec3(t6, 0.0, t5), v4));
    // library:solids.krs
    vec3 v8 = abs(v7) - vec3(0.3, 1.0, 0.3);
    float t9 = max(v8.y, v8.z);
    // tests/golden/deformed.krs:2
    float t10 = (length(max(v8, vec3(0.0))) + min(max(v8.x, t9), 0.0)) * 0.8101204;
    float t11 = mix(length(vec2(t3, max(t10, 0.0))), t10, t3 <= 0.0);
    return t11;
}

float krs_distance_2(vec3 p)
{
    // tests/golden/deformed.krs:3
    vec3 v0 = p - vec3(0.0, 2.0, 0.0);
    vec3 v1 = vec3(dot(vec3(0.0, 0.0, 1.0), v0), dot(vec3(0.0, 1.0, 0.0), v0), dot(vec3((-1.0), 0.0, 0.0), v0));
    vec3 v2 = min(max(v1, vec3((-0.15), (-0.22478913), (-1.0))), vec3(0.15, 0.22478913, 1.0028112));
    float t3 = length((v1 - v2));
    float t4 = v2.y * 0.5;
    float t5 = 1.0 - (v2.z * 0.5);
    float t6 = length(vec2(t4, t5));
    vec3 v7 = vec3(v2.x, (krs_atan((t4 / t5)) * 2.0), (((v2.z * (t5 + 1.0)) - (v2.y * t4)) / (t6 + 1.0)));
    vec3 v8 = vec3(dot(vec3(0.0, 0.0, (-1.0)), v7), dot(vec3(0.0, 1.0, 0.0), v7), dot(vec3(1.0, 0.0, 0.0), v7));
    // library:solids.krs
    vec3 v9 = abs(v8) - vec3(1.0, 0.15, 0.15);
    float t10 = max(v9.y, v9.z);
    // tests/golden/deformed.krs:3
    float t11 = min(max((length(max(v9, vec3(0.0))) + min(max(v9.x, t10), 0.0)), (-0.5)), 0.5);
    float t12 = (t11 * min(t6, 1.0)) * 0.8;
    float t13 = mix(length(vec2(t3, max(t12, 0.0))), t12, t3 <= 0.0);
    return t13;
}

float krs_distance_3(vec3 p)
{
    // tests/golden/deformed.krs:4
    vec3 v0 = p - vec3(2.0, 0.0, 0.0);
    // library:solids.krs
    float t1 = length(vec2(v0.x, v0.z)) - 0.5;
    float t2 = abs(v0.y) - 0.5;
    // tests/golden/deformed.krs:4
    float t3 = abs((length(vec2(max(t1, 0.0), max(t2, 0.0))) + min(max(t1, t2), 0.0)));
    float t4 = t3 - 0.025;
    return t4;
}

float krs_distance_4(vec3 p)
{
    // library:solids.krs
    vec3 v0 = abs((p - vec3((-2.0), 0.0, 0.0))) - vec3(0.4);
    float t1 = max(v0.y, v0.z);
    float t2 = (length(max(v0, vec3(0.0))) + min(max(v0.x, t1), 0.0)) - 0.1;
    return t2;
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

KrsSurface krs_surface_4(vec3 p, vec3 normal, float footprint)
{
    float d = krs_distance_4(p);
    return KrsSurface(d, vec3(0.6), 0.6, 0.0, vec3(0.0), 1.0, 1.5, 0.0, vec3(0.0), 0.0, 0.0, vec3(0.0), 0.5, 0.0, 0.5, 1.4, 0.0, vec3(0.0), 0.0, vec3(0.8), vec3(1.0), 4u, uint(0.0), 1u, 0u, normal);
}

float krs_distance(vec3 p)
{
    float d = krs_distance_1(p);
    d = min(d, krs_distance_2(p));
    d = min(d, krs_distance_3(p));
    d = min(d, krs_distance_4(p));
    return d;
}

float krs_distance_lod(vec3 p, float footprint)
{
    float d = krs_distance_lod_1(p, footprint);
    if (krs_box_distance(p, vec3((-0.0014933478), 2.0, 0.0), vec3(1.0014954, 0.22488382, 0.1500003)) < max(d, 1e-30))
        d = min(d, krs_distance_lod_2(p, footprint));
    if (krs_box_distance(p, vec3(2.0, 0.0, 0.0), vec3(0.5250031, 0.52500105, 0.52500105)) < max(d, 1e-30))
        d = min(d, krs_distance_lod_3(p, footprint));
    if (krs_box_distance(p, vec3((-2.0), 0.0, 0.0), vec3(0.500003, 0.500001, 0.500001)) < max(d, 1e-30))
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
    return nearest;
}

