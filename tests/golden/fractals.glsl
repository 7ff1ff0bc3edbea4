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

vec2 krs_times(vec2 a, vec2 b, float square)
{
    return vec2(a.x * b.x - square * a.y * b.y, a.x * b.y + a.y * b.x);
}

vec2 krs_raise(vec2 base, int power, float square)
{
    vec2 all = vec2(1.0, 0.0), factor = base;
    for (uint i = 0u; i < 5u; i++) {
        if (((power >> i) & 1) != 0)
            all = krs_times(all, factor, square);
        factor = krs_times(factor, factor, square);
    }
    return all;
}

vec4 krs_julia_step(vec4 z, vec4 c, int power)
{
    vec2 parts = krs_raise(vec2(z.x, 1.0), power, dot(z.yzw, z.yzw));
    return vec4(parts.x, parts.y * z.yzw) + c;
}

float krs_step_back(float size, float x, int power)
{
    float sum = 1.0, lower = 1.0, raised = krs_raise(vec2(size, 0.0), power, 0.0).x + x;
    float root = power == 2 ? sqrt(raised)
                            : exp2(log2(max(raised, 1e-37)) / float(power));
    for (int i = 1; i < power; i++) {
        lower *= size;
        sum = sum * root + lower;
    }
    return mix(0.0, x / sum, sum > 0.0);
}

float krs_julia(vec3 p, vec4 c, vec2 range, vec2 settings)
{
    int power = int(range.x), most = int(range.y), n = 0;
    float radius = settings.y, norm = dot(p, p), last = norm, sizes[64];
    bool going = true;
    vec4 z = vec4(p, 0.0);
    for (int i = 0; i < most; i++) {
        going = going && float(i) < settings.x && norm <= 4.0 * radius * radius;
        if (most > 32 && !going)
            break;
        sizes[i] = sqrt(norm);
        n += int(going);
        z = krs_julia_step(z, c, power);
        norm = dot(z, z);
        last = going ? norm : last;
    }
    float size = sqrt(last), x = abs(size - radius);
    for (int i = (most > 32 ? n : most) - 1; i >= 0; i--)
        x = i < n ? max(krs_step_back(sizes[i], x, power), sizes[i] - radius) : x;
    return mix(-x, x, size > radius);
}

float krs_whole_power(float x, int power)
{
    float all = 1.0, factor = x;
    for (uint i = 0u; i < 5u; i++) {
        if (((power >> i) & 1) != 0)
            all *= factor;
        factor *= factor;
    }
    return all;
}

vec2 krs_doubled(vec2 a, float norm)
{
    return vec2(a.x * a.x - 2.0 * norm, a.x * a.y);
}

vec2 krs_multiplied(vec2 base, int power, float norm, float square)
{
    vec2 all = base, factor = base;
    float size = norm;
    for (uint i = 0u; i < 5u; i++) {
        if (((power >> i) & 1) != 0)
            all = (power & ((1 << i) - 1)) == 0
                ? factor : vec2(0.5 * all.x * factor.x - 2.0 * square * all.y * factor.y,
                                0.5 * (all.x * factor.y + all.y * factor.x));
        factor = krs_doubled(factor, size);
        size *= size;
    }
    return all;
}

// The next place, and how far the tilt is lateral.
vec4 krs_triplex_step(vec3 w, vec3 c, float norm, int power)
{
    float square = max(dot(w.xz, w.xz), 1e-18), inverse = 1.0 / square;
    vec2 tilt = krs_multiplied(vec2(2.0 * w.y, 1.0), power, norm, square);
    vec2 once = vec2(2.0 * w.z, w.x), turn = krs_doubled(once, square);
    if (power % 4 == 0) {
        turn = krs_doubled(turn, square * square) * (inverse * inverse);
        turn = krs_multiplied(turn, power / 4, 1.0, 1.0);
    } else
        turn = krs_multiplied(turn * inverse, power / 2, 1.0, 1.0);
    if (power % 2 == 1)
        turn = vec2(0.5 * turn.x * once.x - 2.0 * turn.y * once.y,
                    0.5 * (turn.x * once.y + turn.y * once.x));
    float reach = power % 2 == 0 ? tilt.y * sqrt(square) : tilt.y;
    return vec4(vec3(reach * turn.y, 0.5 * tilt.x, 0.5 * reach * turn.x) + c, tilt.y);
}

float krs_mandelbulb(vec3 c, vec2 range, vec2 settings)
{
    int power = int(range.x), most = int(range.y);
    float radius = settings.y, norm = dot(c, c), start = sqrt(norm), steep = 1.0;
    float far = min(256.0, exp2(64.0 / range.x)), sum = 0.0;
    float root = -1.0 / (range.x - 1.0), core = pow(range.x, root) * (1.0 - 1.0 / range.x);
    float least = pow(4.0 * range.x, root), min_even = 1.0 / (16.0 * range.x * range.x);
    float last = norm, stretch = 1.0;
    bool going = true;
    vec3 w = c;
    for (int i = 0; i < most; i++) {
        going = going && float(i) < settings.x && norm <= far;
        if (most > 8 && !going)
            break;
        float even = max(krs_whole_power(norm, power - 1), min_even);
        vec4 next = krs_triplex_step(w, c, norm, power);
        w = next.xyz;
        norm = dot(w, w);
        sum = going ? sum + steep : sum;
        even = max(0.85 * even, mix(even, next.w * next.w, 0.33333333));
        steep = range.x * sqrt(even) * steep + 1.0;
        last = going ? norm : last;
        stretch = going ? steep : stretch;
    }
    float size = sqrt(last), room = radius - size, rim = start - radius;
    bool outside = room < 0.0;
    float under = stretch + (0.5 * (range.x - 1.0) / least) * sum * room;
    float d = (outside ? 0.25 * size : -0.5 * room) / (outside ? stretch : under);
    float farthest = start > 1.15 * radius ? rim : max(start - core, 0.0);
    d = outside ? d * log(last * (1.0 / (radius * radius))) : d;
    return max(rim, min(d, farthest));
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
    // tests/golden/fractals.krs:2
    float t0 = krs_julia(p, vec4((-0.2), 0.6, 0.2, 0.2), vec2(2.0, 6.0), vec2(6.0, 1.4709893));
    return t0;
}

float krs_distance_2(vec3 p)
{
    // tests/golden/fractals.krs:3
    float t0 = krs_mandelbulb((p - vec3(3.0, 0.0, 0.0)), vec2(8.0, 4.0), vec2(4.0, 1.1040895));
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
    if (krs_box_distance(p, vec3(3.0, 0.0, 0.0), vec3(1.1040947, 1.1040918, 1.1040918)) < max(d, 1e-30))
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

