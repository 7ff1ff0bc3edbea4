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

float krs_box_distance(vec3 p, vec3 center, vec3 half_sides)
{
    return length(max(abs(p - center) - half_sides, vec3(0.0)));
}

void krs_prepare()
{
}

float krs_distance_1(vec3 p)
{
    // tests/golden/shapes.krs:2
    float t0 = length(vec3(p.x, (p.y * 0.7), p.z)) - 0.5;
    return t0;
}

float krs_distance_2(vec3 p)
{
    // tests/golden/shapes.krs:5
    vec3 v0 = p - vec3(1.0, 0.5527268, 0.0);
    // library:solids.krs
    float t1 = length(vec2(v0.x, v0.z)) - 0.1;
    float t2 = abs(v0.y) - 0.6;
    float t3 = length(vec2(max(t1, 0.0), max(t2, 0.0))) + min(max(t1, t2), 0.0);
    float t4 = length((p - vec3(1.0, 1.1527268, 0.0))) - 0.2;
    // tests/golden/shapes.krs:3
    float t5 = min(t3, t4);
    // tests/golden/shapes.krs:5
    vec3 v6 = p - vec3(2.0, 0.7458692, 0.0);
    // library:solids.krs
    float t7 = length(vec2(v6.x, v6.z)) - 0.1;
    float t8 = abs(v6.y) - 0.7;
    float t9 = length(vec2(max(t7, 0.0), max(t8, 0.0))) + min(max(t7, t8), 0.0);
    float t10 = length((p - vec3(2.0, 1.4458692, 0.0))) - 0.2;
    // tests/golden/shapes.krs:3
    float t11 = min(t9, t10);
    // tests/golden/shapes.krs:5
    vec3 v12 = p - vec3(3.0, 0.5657722, 0.0);
    // library:solids.krs
    float t13 = length(vec2(v12.x, v12.z)) - 0.1;
    float t14 = abs(v12.y) - 0.8;
    float t15 = length(vec2(max(t13, 0.0), max(t14, 0.0))) + min(max(t13, t14), 0.0);
    float t16 = length((p - vec3(3.0, 1.3657721, 0.0))) - 0.2;
    // tests/golden/shapes.krs:3
    float t17 = min(t15, t16);
    float t18 = min(t11, t17);
    float t19 = min(t5, t18);
    return t19;
}

float krs_distance_lod_1(vec3 p, float footprint)
{
    return krs_distance_1(p);
}

float krs_distance_lod_2(vec3 p, float footprint)
{
    return krs_distance_2(p);
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

float krs_distance(vec3 p)
{
    float d = krs_distance_1(p);
    d = min(d, krs_distance_2(p));
    return d;
}

float krs_distance_lod(vec3 p, float footprint)
{
    float d = krs_distance_lod_1(p, footprint);
    if (krs_box_distance(p, vec3(2.0, 0.7058207, 0.0), vec3(1.2000045, 0.94005114, 0.2000004)) < max(d, 1e-30))
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

