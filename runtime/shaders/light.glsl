/*
 * light.glsl: the sky, fog, and how a surface reflects light.
 */

const float FARTHEST = 1e30; // the sky is behind all fog

// Returns the radiance of the sky: the horizon's colour fades to the zenith's above and the
// ground's below.
vec3 sky_radiance(vec3 direction)
{
    float rise = clamp(direction.y, -1.0, 1.0);
    float left = 1.0 - max(rise, 0.0);
    vec3  above = mix(frame.zenith.rgb, frame.horizon.rgb, left * left * left);
    return mix(above, frame.ground.rgb, smoothstep(0.0, 0.25, -rise));
}

// Tells how much light of the zenith and of the ground there is in light of the sky; the rest is the
// horizon's.
vec3 mix_sky(vec2 parts)
{
    return frame.horizon.rgb + parts.x * (frame.zenith.rgb - frame.horizon.rgb) +
           parts.y * (frame.ground.rgb - frame.horizon.rgb);
}

// Returns these parts of the mean over the half sky around a normal that rises so much, weighted by
// the cosine.  What changes its sign with the normal is linear in its rise, and exact; so are the
// ends.  The rest is a fit, off by 0.0023 at most (math.md 9).
vec2 sky_parts_around(float rise)
{
    float square = rise * rise;
    vec2  sides = vec2(0.1039, 0.0708) +
                 square * (vec2(0.0228, 0.0082) + square * vec2(0.0468, 0.0838));
    return vec2(0.45, 0.490625) - (1.0 - square) * sides + vec2(0.45, -0.490625) * rise;
}

// Returns the mean radiance of the half sky around a normal, which may be shorter than 1.
vec3 sky_light(vec3 normal) { return mix_sky(sky_parts_around(clamp(normal.y, -1.0, 1.0))); }

// Returns what a surface mirrors of the sky around a direction: the mean over the lobe of its
// roughness (GGX).  From a mirror on the edges of the sky are ever softer; the widest lobe is the
// half sky around the normal.  This is a fit: in root mean square it is off by 0.025 at most.
vec3 sky_mirrored(vec3 direction, vec3 normal, float roughness)
{
    float soft = 0.2 * roughness, rise = clamp(direction.y, -1.0, 1.0);
    float above = (rise + sqrt(rise * rise + soft * soft)) / (1.0 + sqrt(1.0 + soft * soft));
    float left = 1.0 - above, edge = sqrt(0.015625 + roughness * roughness);
    vec2  parts = vec2(1.0 - left * left * left, smoothstep(-edge, edge, -rise - 0.125));
    vec2  around = sky_parts_around(clamp(normal.y, -1.0, 1.0));
    return mix_sky(mix(parts, around, smoothstep(0.1, 0.9, roughness)));
}

// Returns the radiance that a directional light with a size adds to the sky: a disc and a glow
// around it.
vec3 sun_radiance(vec3 direction, vec3 toward_sun, vec3 color, float diameter)
{
    float angle = length(direction - toward_sun); // nearly the angle, where it is small
    float disc = 1.0 - smoothstep(0.4 * diameter, 0.6 * diameter, angle);
    float glow = 0.12 * exp2(-24.0 * angle) + 0.03 * exp2(-5.0 * angle);
    return diameter > 0.0 ? color * (2.0 * disc + glow) : vec3(0.0);
}

// Returns the part of light that fog lets through from t along a ray.  The fog is denser the lower
// it is: its density is integrated along the ray.
float let_through(float origin_height, float rise, float t)
{
    float steepness = frame.fog_level.x * rise, change = steepness * t;
    float along = abs(change) > 1e-3 ? (1.0 - exp(-max(change, -80.0))) / steepness
                                     : t * (1.0 - 0.5 * change);
    float base = exp(min(frame.fog_level.x * (frame.fog_level.y - origin_height), 80.0));
    return frame.fog.w > 0.0 ? exp(-min(frame.fog.w * base * along, 80.0)) : 1.0;
}

// Returns light that comes through fog, with what the fog itself scatters to the eye.
vec3 through_fog(vec3 radiance, float left, bool adds_fog)
{
    return radiance * left + (adds_fog ? frame.fog.rgb * (1.0 - left) : vec3(0.0));
}

// The light that a surface sends back to an eye: by a body below a mirror of microfacets, and
// metal.
struct Mirror {
    vec3  metal;         // its reflectance head-on
    vec3  metal_bounces; // its share, times what bounces more than once adds
    float body_bounces;  // the same of the mirror above the body
    vec3  around;        // the part of light from all sides that is mirrored
    float below;         // the part that comes through to the body
};

const float BODY_HEAD_ON = 0.04; // with an index of refraction of 1.5

// Returns the part of light from around that microfacets send back: of those that mirror all, and
// of those that mirror by Schlick's factor alone.  The first is a fit, off by a tenth at most and
// 0.03 in root mean square (albedos.h tells of them), the second that of the split-sum integral
// (Karis 2014).
vec2 find_sent_back(float cosine, float roughness)
{
    float root = sqrt(cosine);
    float lost = 0.707 - 0.292 * root * cosine + roughness * (1.145 * root - 0.852);
    vec3  r = roughness * vec3(-1.0, -0.0275, 0.022) + vec3(1.0, 0.0425, -0.04);
    float edge = 1.04 * min(r.x * r.x, exp2(-9.28 * cosine)) * r.x + 1.04 * r.y + r.z;
    float all = 1.0 - max(roughness * roughness * lost, 0.0);
    return vec2(all, clamp(edge, 0.0, all));
}

// Finds the mirror of a surface.  What microfacets do not send back at once bounces again (Turquin
// 2019), so that no light is lost.
Mirror find_mirror(vec3 normal, vec3 toward_eye, vec3 color, float roughness, float metallic)
{
    vec2  sent = find_sent_back(clamp(dot(normal, toward_eye), 0.0, 1.0), roughness);
    float more = 1.0 / sent.x - 1.0;
    Mirror mirror;
    mirror.metal = color;
    mirror.metal_bounces = metallic * (1.0 + more * color);
    mirror.body_bounces = (1.0 - metallic) * (1.0 + more * BODY_HEAD_ON);
    float above = mirror.body_bounces * (BODY_HEAD_ON * (sent.x - sent.y) + sent.y);
    mirror.around = mirror.metal_bounces * (color * (sent.x - sent.y) + sent.y) + above;
    mirror.below = 1.0 - metallic - above;
    return mirror;
}

// Returns reflectance times cosine: Lambert below a GGX coat (Smith's masking, Schlick's Fresnel).
vec3 reflected(vec3 normal, vec3 toward_eye, vec3 toward_light, vec3 color, float roughness,
               Mirror mirror)
{
    vec3  between = toward_eye + toward_light;
    vec3  halfway = between / max(length(between), 1e-6);
    float light = clamp(dot(normal, toward_light), 0.0, 1.0);
    float eye = max(dot(normal, toward_eye), 1e-3);
    float tilt = clamp(dot(normal, halfway), 0.0, 1.0);
    float facing = clamp(1.0 - dot(toward_eye, halfway), 0.0, 1.0);

    float width = max(roughness * roughness, 2e-3);
    float square = width * width;
    float spread = tilt * tilt * (square - 1.0) + 1.0;
    float lobe = square / (PI * spread * spread);
    float masked = 0.5 / (light * sqrt(eye * eye * (1.0 - square) + square) +
                          eye * sqrt(light * light * (1.0 - square) + square));
    float edge = facing * facing;
    edge *= edge * facing;
    vec3 mirrored = mirror.metal_bounces * mix(mirror.metal, vec3(1.0), edge) +
                    mirror.body_bounces * mix(BODY_HEAD_ON, 1.0, edge);
    return (mirror.below * color / PI + mirrored * lobe * masked) * light;
}
