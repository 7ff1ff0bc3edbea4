// Distance code of a scene; slot 0 holds the time, then one slot for each `param`.
// Textures are in krs_cells, two words each (RG32UI), and equal in all frames:
// krs_state_tables in krs.h.
layout(std140, set = 0, binding = 0) uniform KrsParameters { vec4 krs_parameter[1]; };

layout(set = 0, binding = 2) uniform usamplerBuffer krs_cells;

uvec2 krs_cell_texel(uint i) { return texelFetch(krs_cells, int(i)).xy; }

// A texture: the texel where its list of levels begins, how many there are, what is
// outside (0: the picture again, 1: its edge, 2: its mirror image), and whether it is
// gray.
struct KrsTexture {
    uint list, levels, wrap;
    bool gray;
};

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

KrsTexture krs_read_texture(uint header)
{
    uvec2 texel = krs_cell_texel(header);
    return KrsTexture(header + 1u, texel.x, texel.y & 3u, (texel.y & 4u) != 0u);
}

vec4 krs_texel(uint i, bool gray)
{
    uvec2 texel = krs_cell_texel(i);
    vec4 color = vec4(unpackHalf2x16(texel.x), unpackHalf2x16(texel.y));
    vec2 number = uintBitsToFloat(texel);
    return mix(color, number.xxxy, bvec4(gray));
}

// Bilinear between four texels of a level, whose texel in the list is `found`.
vec4 krs_texture_level(vec2 place, uvec2 found, KrsTexture picture)
{
    bool round = picture.wrap == 0u;
    uvec2 size = uvec2(found.y & 0xffffu, found.y >> 16);
    vec2 at = place * vec2(size) - 0.5;
    vec2 whole = floor(at), part = at - whole, end = vec2(size) - 1.0;
    vec2 low = mix(max(whole, 0.0), end, bvec2(whole.x < 0.0 && round, whole.y < 0.0 && round));
    vec2 high = mix(min(whole + 1.0, end), vec2(0.0),
                    bvec2(whole.x >= end.x && round, whole.y >= end.y && round));
    uvec2 a = min(uvec2(low), size - 1u), b = min(uvec2(high), size - 1u);
    uint row = found.x + a.y * size.x, above = found.x + b.y * size.x;
    vec4 below = mix(krs_texel(row + a.x, picture.gray), krs_texel(row + b.x, picture.gray), part.x);
    vec4 over = mix(krs_texel(above + a.x, picture.gray), krs_texel(above + b.x, picture.gray), part.x);
    return mix(below, over, part.y);
}

// A place in the picture that stands there, in [0, 1].
vec2 krs_wrapped(vec2 uv, uint wrap)
{
    vec2 at = clamp(uv, -1073741824.0, 1073741824.0);
    vec2 mirrored = abs(at - 2.0 * floor(0.5 * at + 0.5));
    vec2 other = mix(clamp(at, 0.0, 1.0), mirrored, bvec2(wrap == 2u));
    return mix(other, fract(at), bvec2(wrap == 0u));
}

vec4 krs_texture_sharp(vec2 uv, KrsTexture picture)
{
    return krs_texture_level(krs_wrapped(uv, picture.wrap), krs_cell_texel(picture.list), picture);
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

float krs_atan2(float a, float b)
{
    float x = abs(b), y = abs(a), most = max(x, y);
    float s = krs_atan_unit(mix(0.0, min(x, y) / most, most > 0.0));
    s = mix(s, 1.57079632679 - s, y > x);
    s = mix(s, 3.14159265359 - s, b < 0.0);
    return mix(s, -s, a < 0.0);
}

// Tap i of some, whose places advance along a pixel.  `found` are two levels; of the taps as large a share
// reads the second as it has.  A single tap mixes both, and is two.
vec4 krs_texture_tap(float i, float taps, vec2 middle, vec2 advance, uvec4 found, float share,
                     KrsTexture picture)
{
    bool single = taps < 1.5;
    bool coarse = single ? i > 0.0 : floor((i + 1.0) * share + 0.5) > floor(i * share + 0.5);
    float weight = single ? (coarse ? share : 1.0 - share) : 1.0 / taps;
    vec2 at = middle + (single ? 0.0 : i + 0.5 - 0.5 * taps) * advance;
    uvec2 own = uvec2(coarse ? found.z : found.x, coarse ? found.w : found.y);
    vec4 color = krs_texture_level(krs_wrapped(at, picture.wrap), own, picture);
    return (i < max(taps, 2.0) ? weight : 0.0) * color;
}

// For a pixel: its long side in u and v, how many taps that has, and the width of each in texels.  There is
// no loop over taps, in which lavapipe would be slow.
vec4 krs_texture(vec2 uv, vec4 pixel, KrsTexture picture)
{
    float most = float(picture.levels - 1u);
    float width = mix(65536.0, max(pixel.w, 1.0), pixel.w < 65536.0); // also where it is no number
    float level = min(log2(width), most), fine = floor(level), share = level - fine;
    uvec4 found = uvec4(krs_cell_texel(picture.list + uint(fine)),
                        krs_cell_texel(picture.list + uint(min(fine + 1.0, most))));
    float taps = pixel.z > 1.0 ? min(pixel.z, 3.0) : 1.0;
    vec2 advance = taps > 1.0 ? pixel.xy / taps : vec2(0.0);
    return krs_texture_tap(0.0, taps, uv, advance, found, share, picture) +
           krs_texture_tap(1.0, taps, uv, advance, found, share, picture) +
           krs_texture_tap(2.0, taps, uv, advance, found, share, picture);
}

float krs_inverse_length(float square)
{
    return mix(0.0, inversesqrt(square), square > 0.0);
}

vec3 krs_normalize_vec3(vec3 a) { return a * krs_inverse_length(dot(a, a)); }

float krs_box_distance(vec3 p, vec3 center, vec3 half_sides)
{
    return length(max(abs(p - center) - half_sides, vec3(0.0)));
}

KrsTexture krs_texture0;
KrsTexture krs_texture1;
// The direction of the ray that sees a surface, if it is set behind krs_prepare: pixels
// are as long on the surface as that tells.
vec3 krs_view;

void krs_prepare()
{
    krs_texture0 = krs_read_texture(0u);
    krs_texture1 = krs_read_texture(17u);
    krs_view = vec3(0.0);
}

float krs_shared_1(vec3 p, out vec3 s0)
{
    // tests/golden/textures.krs:7
    vec3 v0 = min(max(p, vec3((-1.0960784))), vec3(1.0960784));
    float t1 = (length(v0) - 1.0) - (krs_texture_sharp(vec2(v0.x, v0.y), krs_texture1).x * 0.1);
    float t2 = t1 * 0.5733904;
    float t3 = length((p - v0));
    float t4 = mix(length(vec2(t3, max(t2, 0.0))), t2, t3 <= 0.0);
    s0 = v0;
    return t4;
}

float krs_distance_1(vec3 p)
{
    vec3 s0;
    return krs_shared_1(p, s0);
}

float krs_distance_2(vec3 p)
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

KrsSurface krs_surface_1(vec3 p, vec3 normal, float footprint)
{
    vec3 s0;
    float d = krs_shared_1(p, s0);
    // library:solids.krs
    vec2 v0 = vec2(s0.x, s0.z);
    float t1 = length(v0);
    // tests/golden/textures.krs:7
    vec3 v2 = (vec3(1.0) - step(vec3(1.0960784), p)) * (vec3(1.0) - step(p, vec3((-1.0960784))));
    vec3 v3 = v2 * vec3(1.0, 0.0, 0.0);
    // library:solids.krs
    float t4 = (s0.x * s0.x) + (s0.z * s0.z);
    float t5 = s0.x / t4;
    float t6 = (-s0.z) / t4;
    float t7 = max(t1, 1e-30);
    float t8 = (t1 * t1) + (s0.y * s0.y);
    float t9 = t1 / t8;
    float t10 = (-s0.y) / t8;
    vec2 v11 = vec2(((v3.z * t5) + (v3.x * t6)), ((v3.y * t9) + ((dot(v0, vec2(v3.x, v3.z)) / t7) * t10)));
    // tests/golden/textures.krs:7
    vec2 v12 = v11 * vec2(96.0, 288.0);
    vec3 v13 = v2 * vec3(0.0, 1.0, 0.0);
    // library:solids.krs
    vec2 v14 = vec2(((t5 * v13.z) + (t6 * v13.x)), ((t9 * v13.y) + (t10 * (dot(v0, vec2(v13.x, v13.z)) / t7))));
    // tests/golden/textures.krs:7
    vec2 v15 = v14 * vec2(96.0, 288.0);
    vec3 v16 = v2 * vec3(0.0, 0.0, 1.0);
    // library:solids.krs
    vec2 v17 = vec2(((t5 * v16.z) + (t6 * v16.x)), ((t9 * v16.y) + (t10 * (dot(v0, vec2(v16.x, v16.z)) / t7))));
    // tests/golden/textures.krs:7
    vec2 v18 = v17 * vec2(96.0, 288.0);
    vec3 v19 = vec3(v12.x, v15.x, v18.x);
    float t20 = dot(normal, krs_view);
    float t21 = max((t20 * t20), 1e-06);
    vec3 v22 = v19 - (normal * ((t20 * dot(krs_view, v19)) / t21));
    vec3 v23 = vec3(v12.y, v15.y, v18.y);
    vec3 v24 = v23 - (normal * ((t20 * dot(krs_view, v23)) / t21));
    float t25 = dot(v22, v22);
    float t26 = dot(v24, v24);
    float t27 = dot(v22, v24);
    float t28 = (t25 + t26) * 0.5;
    float t29 = (t25 - t26) * 0.5;
    float t30 = length(vec2(t27, t29));
    float t31 = t29 / max(t30, 1e-30);
    float t32 = sqrt(max(((1.0 - t31) * 0.5), 0.0));
    float t33 = footprint + footprint;
    float t34 = t33 * sqrt((t28 + t30));
    float t35 = t33 * sqrt(max((t28 - t30), 0.0));
    vec2 v36 = vec2((sqrt(max(((t31 + 1.0) * 0.5), 0.0)) * t34), (mix(t32, (-t32), t27 < 0.0) * t34));
    float t37 = length(v36);
    float t38 = max(min(ceil((t37 / max(t35, 1.0))), 3.0), 1.0);
    float t39 = t37 / t38;
    vec2 v40 = v36 * vec2(0.010416667, 0.0034722222);
    vec4 v41 = krs_texture(vec2(krs_atan2(s0.z, s0.x), krs_atan2(s0.y, t1)), vec4(v40.x, v40.y, t38, max(t35, t39)), krs_texture0);
    vec3 v42 = vec3(v41.x, v41.y, v41.z) + vec3((1.0 - v41.w));
    return KrsSurface(d, v42, 0.6, 0.0, vec3(0.0), 1.0, 1.5, 0.0, vec3(0.0), 0.0, 0.0, vec3(0.0), 0.5, 0.0, 0.5, 1.4, 0.0, vec3(0.0), 0.0, vec3(0.8), vec3(1.0), 1u, uint(0.0), 1u, 1u, normal);
}

KrsSurface krs_surface_2(vec3 p, vec3 normal, float footprint)
{
    float d = krs_distance_2(p);
    // tests/golden/textures.krs:7
    float t0 = dot(normal, krs_view);
    float t1 = max((t0 * t0), 1e-06);
    float t2 = footprint + footprint;
    // tests/golden/textures.krs:8
    vec3 v3 = vec3(p.y, p.x, 0.0);
    float t4 = length((v3 - (normal * ((t0 * dot(krs_view, v3)) / t1))));
    float t5 = t2 * t4;
    vec3 v6 = vec3(t5, t5, ((t5 * 0.7841395) + 0.2158605));
    vec3 v7 = vec3(8.0, 0.0, 0.0) - (normal * ((t0 * dot(krs_view, vec3(8.0, 0.0, 0.0))) / t1));
    vec3 v8 = vec3(0.0, 0.0, 4.0) - (normal * ((t0 * dot(krs_view, vec3(0.0, 0.0, 4.0))) / t1));
    float t9 = dot(v7, v7);
    float t10 = dot(v8, v8);
    float t11 = dot(v7, v8);
    float t12 = (t9 + t10) * 0.5;
    float t13 = (t9 - t10) * 0.5;
    float t14 = length(vec2(t11, t13));
    float t15 = t13 / max(t14, 1e-30);
    float t16 = sqrt(max(((1.0 - t15) * 0.5), 0.0));
    float t17 = t2 * sqrt((t12 + t14));
    float t18 = t2 * sqrt(max((t12 - t14), 0.0));
    vec2 v19 = vec2((sqrt(max(((t15 + 1.0) * 0.5), 0.0)) * t17), (mix(t16, (-t16), t11 < 0.0) * t17));
    float t20 = length(v19);
    float t21 = max(min(ceil((t20 / max(t18, 1.0))), 3.0), 1.0);
    float t22 = t20 / t21;
    vec2 v23 = v19 * vec2(0.125, 0.25);
    vec4 v24 = vec4(v23.x, v23.y, t21, max(t18, t22));
    // tests/golden/textures.krs:9
    float t25 = (length(p) + 1.0) * 0.0001;
    float t26 = max(footprint, t25);
    vec3 v27 = mix(vec3(0.0, 1.0, 0.0), vec3(1.0, 0.0, 0.0), bvec3(abs(normal.x) < 0.6));
    vec3 v28 = krs_normalize_vec3(cross(v27, normal));
    vec3 v29 = v28 * t26;
    vec3 v30 = p + v29;
    vec3 v31 = p - v29;
    float t32 = (krs_texture(vec2(v30.x, v30.z), v24, krs_texture1).x * 0.01) - (krs_texture(vec2(v31.x, v31.z), v24, krs_texture1).x * 0.01);
    vec3 v33 = v30 - v31;
    vec3 v34 = cross(normal, v28) * t26;
    vec3 v35 = p + v34;
    vec3 v36 = p - v34;
    float t37 = (krs_texture(vec2(v35.x, v35.z), v24, krs_texture1).x * 0.01) - (krs_texture(vec2(v36.x, v36.z), v24, krs_texture1).x * 0.01);
    vec3 v38 = v35 - v36;
    vec3 v39 = (normal - (v33 * (t32 / max(dot(v33, v33), 1e-30)))) - (v38 * (t37 / max(dot(v38, v38), 1e-30)));
    vec3 v40 = krs_normalize_vec3(v39);
    vec3 v41 = mix(krs_normalize_vec3(v40), normal, bvec3(dot(v40, v40) < 1e-08));
    return KrsSurface(d, v6, 0.6, 0.0, vec3(0.0), 1.0, 1.5, 0.0, vec3(0.0), 0.0, 0.0, vec3(0.0), 0.5, 0.0, 0.5, 1.4, 0.0, vec3(0.0), 0.0, vec3(0.8), vec3(1.0), 2u, uint(0.0), 1u, 2u, v41);
}

float krs_distance(vec3 p)
{
    float d = krs_distance_1(p);
    d = min(d, krs_distance_2(p));
    return d;
}

float krs_distance_lod(vec3 p, float footprint)
{
    float d = 1e30;
    d = min(d, krs_distance_lod_2(p, footprint));
    if (krs_box_distance(p, vec3(0.0), vec3(1.0960807)) < max(d, 1e-30))
        d = min(d, krs_distance_lod_1(p, footprint));
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

