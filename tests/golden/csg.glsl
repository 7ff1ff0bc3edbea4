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
    // library:solids.krs
    vec3 v0 = abs(p) - vec3(1.0, 0.5, 0.5);
    float t1 = max(v0.y, v0.z);
    float t2 = length(vec2(p.x, p.z)) - 0.3;
    float t3 = abs(p.y) - 1.5;
    float t4 = length(vec2(max(t2, 0.0), max(t3, 0.0))) + min(max(t2, t3), 0.0);
    float t5 = length((p - vec3(1.0, 0.5, 0.5))) - 0.6;
    // tests/golden/csg.krs:2
    float t6 = -(length(max(v0, vec3(0.0))) + min(max(v0.x, t1), 0.0));
    float t7 = -min(t5, t6);
    // tests/golden/csg.krs:3
    float t8 = max(0.2 - abs(t7 - t4), 0.0);
    float t9 = min(t7, t4) - t8 * (t8 * (0.25 / max(0.2, 1e-30)));
    return t9;
}

float krs_distance_2(vec3 p)
{
    // tests/golden/csg.krs:4
    vec3 v0 = p - vec3(0.0, 2.0, 0.0);
    // library:solids.krs
    vec3 v1 = abs(v0) - vec3(0.5);
    float t2 = max(v1.y, v1.z);
    // tests/golden/csg.krs:4
    float t3 = 0.7 - length(v0);
    float t4 = -(length(max(v1, vec3(0.0))) + min(max(v1.x, t2), 0.0));
    float t5 = max(0.1 - abs(t4 - t3), 0.0);
    float t6 = -(min(t4, t3) - t5 * (t5 * (0.25 / max(0.1, 1e-30))));
    return t6;
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
    if (krs_box_distance(p, vec3(0.0, 2.0, 0.0), vec3(0.500001, 0.500003, 0.500001)) < max(d, 1e-30))
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

