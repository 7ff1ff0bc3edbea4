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
    // tests/golden/shapes.krs:2
    float t0 = length(vec3(p.x, (p.y * 0.7), p.z)) - 0.5;
    return t0;
}

float krs_distance_2(vec3 p)
{
    // tests/golden/shapes.krs:5
    vec3 v0 = p - vec3(1.0, 0.5527268, 0.0);
    // library:solids.krs:60
    float t1 = length(vec2(v0.x, v0.z)) - 0.1;
    float t2 = abs(v0.y) - 0.6;
    // library:solids.krs:14
    float t3 = length(vec2(max(t1, 0.0), max(t2, 0.0))) + min(KRS_MAX(t1, t2), 0.0);
    // library:solids.krs:38
    float t4 = length((p - vec3(1.0, 1.1527268, 0.0))) - 0.2;
    // tests/golden/shapes.krs:3
    float t5 = KRS_MIN(t3, t4);
    // tests/golden/shapes.krs:5
    vec3 v6 = p - vec3(2.0, 0.7458692, 0.0);
    // library:solids.krs:60
    float t7 = length(vec2(v6.x, v6.z)) - 0.1;
    float t8 = abs(v6.y) - 0.7;
    // library:solids.krs:14
    float t9 = length(vec2(max(t7, 0.0), max(t8, 0.0))) + min(KRS_MAX(t7, t8), 0.0);
    // library:solids.krs:38
    float t10 = length((p - vec3(2.0, 1.4458692, 0.0))) - 0.2;
    // tests/golden/shapes.krs:3
    float t11 = KRS_MIN(t9, t10);
    // tests/golden/shapes.krs:5
    vec3 v12 = p - vec3(3.0, 0.5657722, 0.0);
    // library:solids.krs:60
    float t13 = length(vec2(v12.x, v12.z)) - 0.1;
    float t14 = abs(v12.y) - 0.8;
    // library:solids.krs:14
    float t15 = length(vec2(max(t13, 0.0), max(t14, 0.0))) + min(KRS_MAX(t13, t14), 0.0);
    // library:solids.krs:38
    float t16 = length((p - vec3(3.0, 1.3657721, 0.0))) - 0.2;
    // tests/golden/shapes.krs:3
    float t17 = KRS_MIN(t15, t16);
    float t18 = KRS_MIN(t11, t17);
    float t19 = KRS_MIN(t5, t18);
    return t19;
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
    if (krs_box_distance(p, vec3(2.0, 0.7058207, 0.0), vec3(1.2000045, 0.94005114, 0.2000004)) < max(d, 1e-30))
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
        low = vec3((-1.0003474));
        high = vec3(1.0003474);
        break;
    case 1u:
        low = vec3(0.7996893, (-0.23453695), (-0.20030768));
        high = vec3(3.2003107, 1.6461784, 0.20030768);
        break;
    }
}
#endif

KrsSurface krs_surface_1(vec3 p, vec3 normal, float footprint)
{
    // tests/golden/shapes.krs:2
    float t0 = length(vec3(p.x, (p.y * 0.7), p.z)) - 0.5;
    return KrsSurface(t0, vec3(0.6), 0.6, 0.0, vec3(0.0), 1u, uint(0.0), 1u, normal);
}

KrsSurface krs_surface_2(vec3 p, vec3 normal, float footprint)
{
    // tests/golden/shapes.krs:5
    vec3 v0 = p - vec3(1.0, 0.5527268, 0.0);
    // library:solids.krs:60
    float t1 = length(vec2(v0.x, v0.z)) - 0.1;
    float t2 = abs(v0.y) - 0.6;
    // library:solids.krs:14
    float t3 = length(vec2(max(t1, 0.0), max(t2, 0.0))) + min(KRS_MAX(t1, t2), 0.0);
    // library:solids.krs:38
    float t4 = length((p - vec3(1.0, 1.1527268, 0.0))) - 0.2;
    // tests/golden/shapes.krs:3
    float t5 = KRS_MIN(t3, t4);
    // tests/golden/shapes.krs:5
    vec3 v6 = p - vec3(2.0, 0.7458692, 0.0);
    // library:solids.krs:60
    float t7 = length(vec2(v6.x, v6.z)) - 0.1;
    float t8 = abs(v6.y) - 0.7;
    // library:solids.krs:14
    float t9 = length(vec2(max(t7, 0.0), max(t8, 0.0))) + min(KRS_MAX(t7, t8), 0.0);
    // library:solids.krs:38
    float t10 = length((p - vec3(2.0, 1.4458692, 0.0))) - 0.2;
    // tests/golden/shapes.krs:3
    float t11 = KRS_MIN(t9, t10);
    // tests/golden/shapes.krs:5
    vec3 v12 = p - vec3(3.0, 0.5657722, 0.0);
    // library:solids.krs:60
    float t13 = length(vec2(v12.x, v12.z)) - 0.1;
    float t14 = abs(v12.y) - 0.8;
    // library:solids.krs:14
    float t15 = length(vec2(max(t13, 0.0), max(t14, 0.0))) + min(KRS_MAX(t13, t14), 0.0);
    // library:solids.krs:38
    float t16 = length((p - vec3(3.0, 1.3657721, 0.0))) - 0.2;
    // tests/golden/shapes.krs:3
    float t17 = KRS_MIN(t15, t16);
    float t18 = KRS_MIN(t11, t17);
    float t19 = KRS_MIN(t5, t18);
    return KrsSurface(t19, vec3(0.6), 0.6, 0.0, vec3(0.0), 2u, uint(0.0), 1u, normal);
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
