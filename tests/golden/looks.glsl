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

float krs_box_distance(vec3 p, vec3 center, vec3 half_sides)
{
    return length(max(abs(p - center) - half_sides, vec3(0.0)));
}

vec3 krs_frame0;

void krs_prepare()
{
    // tests/golden/looks.krs:4
    krs_frame0 = vec3((krs_parameter[1].x * 3.0), (krs_parameter[1].x * 2.0), krs_parameter[1].x);
}

// How deep p is in the zones of the scene, where nothing is.
float krs_zone_depth(vec3 p)
{
    // tests/golden/looks.krs:8
    float t0 = 0.3 - length((p - vec3(0.0, 1.0, 0.0)));
    return t0;
}

// The distance where zones have been cut out.
float krs_cut(vec3 p, float d)
{
    d = max(d, krs_zone_depth(p));
    return d;
}

float krs_distance_1(vec3 p)
{
    // library:solids.krs
    float t0 = length(p) - 1.0;
    return t0;
}

float krs_distance_2(vec3 p)
{
    // library:solids.krs
    vec3 v0 = abs((p - vec3(2.0, 0.0, 0.0))) - vec3(0.5);
    float t1 = max(v0.y, v0.z);
    float t2 = length(max(v0, vec3(0.0))) + min(max(v0.x, t1), 0.0);
    return t2;
}

float krs_distance_3(vec3 p)
{
    // library:solids.krs
    float t0 = dot(p, vec3(0.0, 1.0, 0.0)) - (-1.0);
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

KrsSurface krs_surface_1(vec3 p, vec3 normal, float footprint)
{
    float d = krs_distance_1(p);
    // tests/golden/looks.krs:3
    float t0 = dot(normal, vec3(0.0, 1.0, 0.0));
    vec3 v1 = vec3(((t0 * (-0.3)) + 0.5), ((t0 * (-0.2)) + 0.4), ((t0 * 0.05) + 0.25));
    return KrsSurface(d, v1, 0.3, 1.0, vec3(0.0), 1.0, 1.5, 0.0, vec3(0.0), 0.0, 0.0, vec3(0.0), 0.5, 0.0, 0.5, 1.4, 0.0, vec3(0.0), 0.0, vec3(0.8), vec3(1.0), 1u, uint(0.0), 1u, 1u, normal);
}

KrsSurface krs_surface_2(vec3 p, vec3 normal, float footprint)
{
    float d = krs_distance_2(p);
    return KrsSurface(d, vec3(1.0), 0.6, 0.0, krs_frame0, 1.0, 1.5, 0.0, vec3(0.0), 0.0, 0.0, vec3(0.0), 0.5, 0.0, 0.5, 1.4, 0.0, vec3(0.0), 0.0, vec3(0.8), vec3(1.0), 2u, uint(0.0), 1u, 2u, normal);
}

KrsSurface krs_surface_3(vec3 p, vec3 normal, float footprint)
{
    float d = krs_distance_3(p);
    return KrsSurface(d, vec3(0.2158605, 0.27889428, 0.3515326), 0.6, 0.0, vec3(0.0), 1.0, 1.5, 0.0, vec3(0.0), 0.0, 0.0, vec3(0.0), 0.5, 0.0, 0.5, 1.4, 0.0, vec3(0.0), 0.0, vec3(0.8), vec3(1.0), 3u, uint(0.0), 1u, 3u, normal);
}

float krs_distance(vec3 p)
{
    float d = krs_distance_1(p);
    d = min(d, krs_distance_2(p));
    d = min(d, krs_distance_3(p));
    return krs_cut(p, d);
}

float krs_distance_lod(vec3 p, float footprint)
{
    float d = krs_distance_lod_3(p, footprint);
    if (krs_box_distance(p, vec3(0.0), vec3(1.000002)) < max(d, 1e-30))
        d = min(d, krs_distance_lod_1(p, footprint));
    if (krs_box_distance(p, vec3(2.0, 0.0, 0.0), vec3(0.500003, 0.500001, 0.500001)) < max(d, 1e-30))
        d = min(d, krs_distance_lod_2(p, footprint));
    return krs_cut(p, d);
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
    float cut = krs_cut(p, nearest.distance);
    if (cut > nearest.distance)
        nearest.normal = normal;
    nearest.distance = cut;
    return nearest;
}

