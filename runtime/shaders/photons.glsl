/*
 * photons.glsl: photons that smooth surfaces have sent from lights to others: how they are stored, and what
 * they light (Jensen 1996; Knaus and Zwicker 2011).
 */

// The greatest roughness of smooth metal and glass, and the least part of a surface that is metal or glass then.
const float SMOOTH = 0.1, ALL_OF_IT = 0.95;

// Tells whether photons go on from a surface.  They end at all others.
bool is_smooth(KrsSurface surface)
{
    return surface.roughness <= SMOOTH && surface.metallic + find_glass(surface) >= ALL_OF_IT;
}

// Packs a unit vector by the octahedron that it lies above, in the bits of a number that is neither 0, denormal nor
// infinite.
const float X_STEPS = 32767.0, Y_STEPS = 16383.0;
const uint  IS_NUMBER = 0x40000000u;
float pack_direction(vec3 v)
{
    v /= abs(v.x) + abs(v.y) + abs(v.z);
    vec2 folded = (1.0 - abs(v.yx)) * vec2(v.x < 0.0 ? -1.0 : 1.0, v.y < 0.0 ? -1.0 : 1.0);
    vec2 at = clamp(0.5 + 0.5 * (v.z < 0.0 ? folded : v.xy), 0.0, 1.0);
    return uintBitsToFloat(uint(X_STEPS * at.x + 0.5) | uint(Y_STEPS * at.y + 0.5) << 15u | IS_NUMBER);
}

vec3 unpack_direction(uint bits)
{
    vec2  at = 2.0 * vec2(bits & 0x7fffu, bits >> 15u & 0x3fffu) / vec2(X_STEPS, Y_STEPS) - 1.0;
    vec3  v = vec3(at, 1.0 - abs(at.x) - abs(at.y));
    float below = max(-v.z, 0.0);
    v.xy -= vec2(v.x < 0.0 ? -below : below, v.y < 0.0 ? -below : below);
    return normalize(v);
}

#ifdef PHOTONS_GATHERED
// As in photons.c.
uint bucket_of(ivec3 cell, uint mask)
{
    return hash_bits(uint(cell.x) + hash_bits(uint(cell.y) + hash_bits(uint(cell.z)))) & mask;
}

uint load_start(uint number)
{
    return load_input(control.photons + PHOTON_STARTS_AT + number / 4u)[number & 3u];
}

// The widest mirrors that photons show: in narrower ones few photons would be seen, and bright ones.  ASIDE: the
// distance of a photon from the plane of the surface, relative to the radius; ALIKE: the least cosine of normals.
const float WIDE = 0.1, ASIDE = 0.25, ALIKE = 0.7;

// Returns light that photons near a point bring to the eye.
vec3 gather_photons(vec3 place, vec3 facing, Bsdf bsdf, Axes axes)
{
    uvec4 bits = load_input(control.photons);
    float radius = uintBitsToFloat(bits.x), cells = uintBitsToFloat(bits.y);
    ivec3 corner = ivec3(floor(place * cells - 0.5));
    uint  visited[8];
    vec3  sum = vec3(0.0);
    bsdf.alpha = max(bsdf.alpha, WIDTH(WIDE));
    bsdf.coat_alpha = max(bsdf.coat_alpha, WIDTH(WIDE));
    for (uint i = 0u; i < 8u; i++) {
        uint bucket = bucket_of(corner + ivec3(i & 1u, i >> 1u & 1u, i >> 2u), bits.z);
        visited[i] = bucket;
        bool again = false; // two cells may share a bucket
        for (uint k = 0u; k < i; k++)
            again = again || visited[k] == bucket;
        uint photon = again ? 0u : load_start(bucket), end = again ? 0u : load_start(bucket + 1u);
        for (; photon < end; photon++) {
            uint  row = control.photons + PHOTONS_AT + PHOTON_ROWS * photon;
            uvec4 at = load_input(row);
            vec3  beside = uintBitsToFloat(at.xyz) - place;
            float aside = dot(beside, facing), square_beside = dot(beside, beside) - aside * aside;
            float near = 1.0 - square_beside / (radius * radius);
            if (near <= 0.0 || abs(aside) > ASIDE * radius)
                continue;
            uvec4 power = load_input(row + 1u);
            vec3  light = into(axes, -unpack_direction(at.w));
            if (light.z > 1e-4 && dot(unpack_direction(power.w), facing) > ALIKE)
                sum += near * uintBitsToFloat(power.xyz) * scatter(bsdf, light).rgb / light.z;
        }
    }
    return finite_or_black(2.0 / (PI * radius * radius) * sum);
}
#endif
