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
    // tests/golden/places.krs:2
    vec3 v0 = (p - vec3(0.0, 3.0, 0.0)) * vec3(1.0, 0.5, 2.0);
    vec3 v1 = vec3(dot(vec3(0.78275555, 0.54879886, (-0.2934511)), v0), dot(vec3((-0.48195443), 0.8328889, 0.27205887), v0), dot(vec3(0.39371777, (-0.071525544), 0.9164444), v0));
    // library:solids.krs
    float t2 = length(vec2(v1.x, v1.z));
    float t3 = t2 - 0.4;
    float t4 = v1.y - (-0.5);
    float t5 = min(max((dot(vec2(t3, t4), vec2((-0.4), 1.0)) * 0.86206895), 0.0), 1.0);
    float t6 = t3 - (t5 * (-0.4));
    float t7 = abs(v1.y) - 0.5;
    vec2 v8 = vec2(t6, (t4 - t5));
    float t9 = dot(v8, v8);
    vec2 v10 = vec2(max((t2 - mix(0.0, 0.4, v1.y < 0.0)), 0.0), t7);
    float t11 = dot(v10, v10);
    float t12 = mix(1.0, (-1.0), all(bvec2((t6 < 0.0), (t7 < 0.0)))) * sqrt(min(t9, t11));
    // tests/golden/places.krs:2
    float t13 = t12 * 0.5;
    return t13;
}

float krs_distance_2(vec3 p)
{
    // tests/golden/places.krs:3
    vec3 v0 = p * 2.0;
    vec3 v1 = vec3(min(v0.x, 2.0 * 0.3 - v0.x), v0.y, v0.z);
    // library:solids.krs
    float t2 = length(vec2((length(vec2(v1.x, v1.z)) - 1.0), v1.y)) - 0.2;
    // tests/golden/places.krs:3
    float t3 = t2 * 0.5;
    return t3;
}

float krs_distance_3(vec3 p)
{
    // tests/golden/places.krs:4
    vec3 v0 = vec3((p.x - (min(max(floor((p.x * 2.0) + 0.5), (-2.0)), 2.0) * 0.5)), p.y, (p.z - (min(max(floor((p.z * 2.0) + 0.5), (-1.0)), 1.0) * 0.5)));
    // library:solids.krs
    vec3 v1 = abs(v0) - vec3(0.1, 0.3, 0.1);
    float t2 = max(v1.y, v1.z);
    float t3 = length(max(v1, vec3(0.0))) + min(max(v1.x, t2), 0.0);
    return t3;
}

float krs_distance_4(vec3 p)
{
    // tests/golden/places.krs:5
    vec3 v0 = p - vec3(0.0, (-2.0), 0.0);
    // library:solids.krs
    float t1 = length((v0 - vec3(min(max(dot(v0, vec3(1.0, 0.0, 0.0)), 0.0), 1.0), 0.0, 0.0)));
    float t2 = t1 - 0.1;
    // tests/golden/places.krs:5
    vec3 v3 = vec3(dot(vec3(0.5, 0.0, 0.8660254), v0), dot(vec3(0.0, 1.0, 0.0), v0), dot(vec3((-0.8660254), 0.0, 0.5), v0));
    // library:solids.krs
    float t4 = length((v3 - vec3(min(max(dot(v3, vec3(1.0, 0.0, 0.0)), 0.0), 1.0), 0.0, 0.0)));
    float t5 = t4 - 0.1;
    // tests/golden/places.krs:5
    vec3 v6 = vec3(dot(vec3((-0.5), 0.0, 0.8660254), v0), dot(vec3(0.0, 1.0, 0.0), v0), dot(vec3((-0.8660254), 0.0, (-0.5)), v0));
    // library:solids.krs
    float t7 = length((v6 - vec3(min(max(dot(v6, vec3(1.0, 0.0, 0.0)), 0.0), 1.0), 0.0, 0.0)));
    float t8 = t7 - 0.1;
    // tests/golden/places.krs:5
    float t9 = min(t5, t8);
    float t10 = min(t2, t9);
    vec3 v11 = vec3(dot(vec3((-1.0), 0.0, 1.2246469e-16), v0), dot(vec3(0.0, 1.0, 0.0), v0), dot(vec3((-1.2246469e-16), 0.0, (-1.0)), v0));
    // library:solids.krs
    vec3 v12 = v11 - vec3(min(max(dot(v11, vec3(1.0, 0.0, 0.0)), 0.0), 1.0), 0.0, 0.0);
    float t13 = length(v12) - 0.1;
    // tests/golden/places.krs:5
    vec3 v14 = vec3(dot(vec3((-0.5), 0.0, (-0.8660254)), v0), dot(vec3(0.0, 1.0, 0.0), v0), dot(vec3(0.8660254, 0.0, (-0.5)), v0));
    // library:solids.krs
    vec3 v15 = v14 - vec3(min(max(dot(v14, vec3(1.0, 0.0, 0.0)), 0.0), 1.0), 0.0, 0.0);
    float t16 = length(v15) - 0.1;
    // tests/golden/places.krs:5
    vec3 v17 = vec3(dot(vec3(0.5, 0.0, (-0.8660254)), v0), dot(vec3(0.0, 1.0, 0.0), v0), dot(vec3(0.8660254, 0.0, 0.5), v0));
    // library:solids.krs
    vec3 v18 = v17 - vec3(min(max(dot(v17, vec3(1.0, 0.0, 0.0)), 0.0), 1.0), 0.0, 0.0);
    float t19 = length(v18) - 0.1;
    // tests/golden/places.krs:5
    float t20 = min(t16, t19);
    float t21 = min(t13, t20);
    float t22 = min(t10, t21);
    return t22;
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
    if (krs_box_distance(p, vec3(0.15, 0.0, 0.0), vec3(0.75000167, 0.1000002, 0.6000012)) < max(d, 1e-30))
        d = min(d, krs_distance_lod_2(p, footprint));
    if (krs_box_distance(p, vec3(0.0), vec3(1.1000022, 0.3000006, 0.6000012)) < max(d, 1e-30))
        d = min(d, krs_distance_lod_3(p, footprint));
    if (krs_box_distance(p, vec3(0.0, (-2.0), 0.0), vec3(1.1045383, 0.1000022, 1.1045383)) < max(d, 1e-30))
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

