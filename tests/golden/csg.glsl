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
#define KRS_SLOTS 1
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


// Everything that stays the same within a frame: call it first.
void krs_prepare()
{
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

float krs_distance_1(vec3 p)
{
    // library:solids.krs:48
    vec3 v0 = abs(p) - vec3(1.0, 0.5, 0.5);
    // library:solids.krs:14
    float t1 = KRS_MAX(v0.y, v0.z);
    // library:solids.krs:60
    float t2 = length(vec2(p.x, p.z)) - 0.3;
    float t3 = abs(p.y);
    float t4 = t3 - 1.5;
    // library:solids.krs:14
    float t5 = length(vec2(max(t2, 0.0), max(t4, 0.0))) + min(KRS_MAX(t2, t4), 0.0);
    // library:solids.krs:38
    float t6 = length((p - vec3(1.0, 0.5, 0.5))) - 0.6;
    // tests/golden/csg.krs:2
    float t7 = -(length(max(v0, vec3(0.0))) + min(KRS_MAX(v0.x, t1), 0.0));
    float t8 = -KRS_MIN(t6, t7);
    float t9 = abs(p.x) - 1.0;
    float t10 = t3 - 0.5;
    float t11 = KRS_MAX(t9, t10);
    float t12 = abs(p.z) - 0.5;
    float t13 = KRS_MAX(t11, t12);
    float t14 = KRS_MAX(t8, t13);
    // tests/golden/csg.krs:3
    float t15 = max(0.2 - abs(t14 - t5), 0.0);
    float t16 = KRS_MIN(t14, t5) - t15 * (t15 * (0.25 / max(0.2, 1e-30)));
    return t16;
}

float krs_distance_2(vec3 p)
{
    // tests/golden/csg.krs:4
    vec3 v0 = p - vec3(0.0, 2.0, 0.0);
    // library:solids.krs:48
    vec3 v1 = abs(v0) - vec3(0.5);
    // library:solids.krs:14
    float t2 = KRS_MAX(v1.y, v1.z);
    // tests/golden/csg.krs:4
    float t3 = 0.7 - length(v0);
    float t4 = -(length(max(v1, vec3(0.0))) + min(KRS_MAX(v1.x, t2), 0.0));
    float t5 = max(0.1 - abs(t4 - t3), 0.0);
    float t6 = -(KRS_MIN(t4, t3) - t5 * (t5 * (0.25 / max(0.1, 1e-30))));
    return t6;
}

// Never above the distance to the nearest surface; negative inside.
float krs_distance(vec3 p)
{
    float d = krs_distance_1(p);
    d = min(d, krs_distance_2(p));
    return krs_cut(p, d);
}

#ifdef EARLY_OUTS
float krs_distance_lod_1(vec3 p, float footprint)
{
    return krs_distance_1(p);
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
    if (krs_box_distance(p, vec3(0.0, 2.0, 0.0), vec3(0.500001, 0.500003, 0.500001)) < max(d, 1e-30))
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
        low = vec3((-1.0503913), (-1.5503918), (-0.5503908));
        high = vec3(1.0503913, 1.5503918, 0.5503908);
        break;
    case 1u:
        low = vec3((-0.5001737), 1.4998243, (-0.5001737));
        high = vec3(0.5001737, 2.5001757, 0.5001737);
        break;
    }
}
#endif

KrsSurface krs_surface_1(vec3 p, vec3 normal, float footprint)
{
    // library:solids.krs:48
    vec3 v0 = abs(p) - vec3(1.0, 0.5, 0.5);
    // library:solids.krs:14
    float t1 = KRS_MAX(v0.y, v0.z);
    // library:solids.krs:60
    float t2 = length(vec2(p.x, p.z)) - 0.3;
    float t3 = abs(p.y);
    float t4 = t3 - 1.5;
    // library:solids.krs:14
    float t5 = length(vec2(max(t2, 0.0), max(t4, 0.0))) + min(KRS_MAX(t2, t4), 0.0);
    // library:solids.krs:38
    float t6 = length((p - vec3(1.0, 0.5, 0.5))) - 0.6;
    // tests/golden/csg.krs:2
    float t7 = -(length(max(v0, vec3(0.0))) + min(KRS_MAX(v0.x, t1), 0.0));
    float t8 = -KRS_MIN(t6, t7);
    float t9 = abs(p.x) - 1.0;
    float t10 = t3 - 0.5;
    float t11 = KRS_MAX(t9, t10);
    float t12 = abs(p.z) - 0.5;
    float t13 = KRS_MAX(t11, t12);
    float t14 = KRS_MAX(t8, t13);
    // tests/golden/csg.krs:3
    float t15 = max(0.2 - abs(t14 - t5), 0.0);
    float t16 = KRS_MIN(t14, t5) - t15 * (t15 * (0.25 / max(0.2, 1e-30)));
    return KrsSurface(t16, vec3(0.6), 0.6, 0.0, vec3(0.0), 1u, uint(0.0), 1u, normal);
}

KrsSurface krs_surface_2(vec3 p, vec3 normal, float footprint)
{
    // tests/golden/csg.krs:4
    vec3 v0 = p - vec3(0.0, 2.0, 0.0);
    // library:solids.krs:48
    vec3 v1 = abs(v0) - vec3(0.5);
    // library:solids.krs:14
    float t2 = KRS_MAX(v1.y, v1.z);
    // tests/golden/csg.krs:4
    float t3 = 0.7 - length(v0);
    float t4 = -(length(max(v1, vec3(0.0))) + min(KRS_MAX(v1.x, t2), 0.0));
    float t5 = max(0.1 - abs(t4 - t3), 0.0);
    float t6 = -(KRS_MIN(t4, t3) - t5 * (t5 * (0.25 / max(0.1, 1e-30))));
    return KrsSurface(t6, vec3(0.6), 0.6, 0.0, vec3(0.0), 2u, uint(0.0), 1u, normal);
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
