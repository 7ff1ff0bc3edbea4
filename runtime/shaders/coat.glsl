/*
 * coat.glsl: how a surface that previews show sends light on: of lights, and of the sky.  Shaders of pages include it as
 * well (web/picture).
 */
// Less evenness comes from detail, not from curvature.  Mirrors make things so small that curvature
// turns normals within a pixel, too.
const float EVEN = 0.98, EVEN_IN_MIRRORS = 1.0;
const float MIN_NORMAL_REACH = 0.5; // the reach without filtering (normal_reach in job.c)
const float SEEN = 0.78;              // length of the mean visible normal of a thin round thing

// The reflection of light by a surface.
struct Coat {
    vec3  color, normal; // normal: direction of the mean of the normals
    float mean_length;   // length of this mean
    float roughness, metallic;
    vec3  toward_eye;
    vec2  traced; // the parts of what the body mirrors, and its clear coat, that a ray finds
#ifdef LAYERS
    Layers layers;
#else
    Mirror mirror;
#endif
};

// Clamps numbers to [0, most]; NaN becomes 0.
vec4 saturate(vec4 numbers, float most)
{
    return mix(vec4(0.0), min(numbers, most), greaterThan(numbers, vec4(0.0)));
}

#ifdef SUBSURFACE
// Returns the colour of a body, with what comes from below its surface; metals have none.
vec3 color_below(KrsSurface surface)
{
    vec2 parts = saturate(vec4(surface.subsurface_weight, surface.metallic, 0.0, 0.0), 1.0).xy;
    return mix(surface.color, surface.subsurface_color, parts.x * (1.0 - parts.y));
}
#endif

// Returns the mean of the normals that the pixel shows; it is no unit vector.  `mean_length` is the
// length of the mean of all normals around.  Of a thin thing only the side towards the eye is
// visible.
vec3 mean_normal(vec3 normal, float mean_length, vec3 toward_eye)
{
    float rest = 1.0 - mean_length;
    return mean_length * normal + SEEN * rest * rest * toward_eye;
}

// Roughens the coat by normals that vary within the pixel: the shorter their mean, the wider their
// lobe (Toksvig 2005).
float roughen(float roughness, float mean_length)
{
    float square = roughness * roughness;
    float spread = 2.0 * (1.0 - mean_length) / max(mean_length, 1e-3);
    return sqrt(sqrt(min(square * square + spread, 1.0)));
}

// Tells whether one sample stands for all that its pixel shows.
bool filters_detail() { return frame.normal_reach > MIN_NORMAL_REACH; }

Coat find_coat(HitPoint hit, KrsSurface surface, float evenness)
{
    float even = are_of_paths() ? EVEN_IN_MIRRORS : EVEN;
    float mean_length = filters_detail() || are_of_paths() ? min(evenness / even, 1.0) : 1.0;
    vec3  mean = mean_normal(hit.side * surface.normal, mean_length, -hit.direction);
    vec4  coat = saturate(vec4(surface.color, surface.roughness), 1.0);
    float size = length(mean);
    vec2  traced = vec2(0.0);
    float glass = 0.0;
#ifdef MIRRORS // glass scatters nothing
    glass = find_glass(surface);
    coat.rgb *= 1.0 - glass;
    traced = find_traced(surface);
#endif
    Coat found;
    found.color = coat.rgb;
    found.normal = mean / max(size, 1e-6);
    found.mean_length = min(size, 1.0);
    found.roughness = roughen(coat.a, mean_length);
    found.metallic = saturate(vec4(surface.metallic), 1.0).x;
    found.toward_eye = -hit.direction;
    found.traced = traced;
#ifdef LAYERS
    surface.roughness = found.roughness;
    surface.coat_roughness = roughen(saturate(vec4(surface.coat_roughness), 1.0).x, mean_length);
    found.layers = find_layers(surface, hit.side > 0.0, found.normal, found.toward_eye, glass);
    found.layers.bsdf.diffuse *= found.mean_length;
#else
    // Normals that vary are not microfacets: light does not bounce between them.
    found.mirror = find_mirror(found.normal, found.toward_eye, found.color, coat.a, found.metallic);
#endif
    return found;
}

// Returns reflectance times cosine.  Scattered light is in proportion to the cosine, and so to the
// mean of the normals, which is shorter than each.  What a coat mirrors is the same amount at any
// roughness.
vec3 find_reflected(Coat coat, vec3 toward)
{
#ifdef LAYERS
    return reflected_by_layers(coat.layers, toward);
#else
    return reflected(coat.normal, coat.toward_eye, toward, coat.mean_length * coat.color,
                     coat.roughness, coat.mirror);
#endif
}

vec3 direct_light(Light light, HitPoint hit, Coat coat, vec3 facing, float visible)
{
    vec3 toward = light.vector, color = light.color;
    if ((light.kind & LIGHT_POSITIONAL) != 0u) {
        vec3  difference = light.vector - hit.position;
        float square = max(dot(difference, difference), 1e-12);
        toward = difference * inversesqrt(square);
        color *= find_share(light, -toward) / square;
    }
    // Rays do not test lights without shadows, but a surface that faces away from one is dark.
    if ((light.kind & LIGHT_CASTS_SHADOWS) == 0u)
        visible = dot(facing, toward) > 0.0 ? 1.0 : 0.0;
    return visible * color * find_reflected(coat, toward);
}

// Returns the light of the sky, of which these parts reach the body and what mirrors.
vec3 ambient_of(Coat coat, vec3 body, float mirror)
{
#ifdef LAYERS
    return ambient_of_layers(coat.layers, coat.toward_eye, coat.mean_length * coat.normal, body,
                             mirror, coat.traced);
#else
    vec3 scattered = coat.mirror.below * coat.color *
                     find_sky_around(coat.mean_length * coat.normal) * body;
    vec3 mirrored = find_sky_mirrored(coat.normal, coat.toward_eye, coat.roughness) *
                    coat.mirror.around;
    return scattered + mirrored * mirror * (1.0 - coat.traced.x);
#endif
}

// Returns the light of the sky, with what occluders give back of it.
vec3 ambient(Coat coat, Openness openness)
{
    vec3  body = with_bounces(openness.open, guess_color(coat.color, openness.albedo));
    float mirror = with_bounces(openness.open, vec3(openness.albedo)).x;
    return ambient_of(coat, body, mirror);
}
