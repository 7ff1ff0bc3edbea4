/*
 * bsdf_samples.glsl: directions from which much of the light comes that a surface scatters to the
 * eye, for points of the unit square.
 *
 * Microfacets are chosen by their visible normals (Dupuy and Benyoub 2023).  The densities are
 * those of bsdf.glsl.
 */

vec3 sample_visible(vec3 eye, WIDTH alpha, vec2 square)
{
    vec3  tall = normalize(vec3(alpha * eye.xy, eye.z));
    float angle = 2.0 * PI * square.x;
    float z = (1.0 - square.y) * (1.0 + tall.z) - tall.z;
    float ring = sqrt(clamp(1.0 - z * z, 0.0, 1.0));
    vec3  cap = vec3(ring * krs_cos(angle), ring * krs_sin(angle), z) + tall;
    return normalize(vec3(alpha * cap.xy, max(cap.z, 1e-6)));
}

vec3 sample_glass(Bsdf bsdf, vec2 square_point, float choice)
{
    vec3  normal = sample_visible(bsdf.eye, bsdf.alpha, square_point);
    float cosine = clamp(dot(bsdf.eye, normal), 0.0, 1.0);
    float beyond = max(1.0 - (1.0 - cosine * cosine) / square(bsdf.eta), 0.0);
    bool  mirrors = choice < find_mirrored_share(bsdf, cosine);
    vec3  light = mirrors ? 2.0 * cosine * normal - bsdf.eye
                          : (cosine / bsdf.eta - sqrt(beyond)) * normal - bsdf.eye / bsdf.eta;
    light.z = mirrors ? abs(light.z) : -abs(light.z);
    return normalize(light);
}

// Returns a direction that light comes from, by the density of `scatter`; 0 where microfacets
// mirror below the surface.  If that were a direction, glass would count it as well.  `choice`: of
// what glass does.
vec3 sample_direction(Bsdf bsdf, vec2 square_point, float choice)
{
    vec4 below = bsdf.shares;
    below.y += below.x;
    below.z += below.y;
    vec2 at = square_point;
    if (take_part(at, below.z, 1.0)) {
        float angle = 2.0 * PI * at.x, ring = sqrt(at.y);
        return vec3(ring * krs_cos(angle), ring * krs_sin(angle), sqrt(max(1.0 - at.y, 0.0)));
    }
    if (take_part(at, below.y, below.z))
        return sample_glass(bsdf, at, choice);
    bool  coat = take_part(at, 0.0, below.x);
    WIDTH alpha = coat ? bsdf.coat_alpha : bsdf.alpha;
    if (!coat)
        take_part(at, below.x, below.y);
    vec3 normal = sample_visible(bsdf.eye, alpha, at);
    vec3 light = 2.0 * dot(bsdf.eye, normal) * normal - bsdf.eye;
    return light.z > 0.0 ? light : vec3(0.0);
}
