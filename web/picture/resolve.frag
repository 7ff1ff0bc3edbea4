/*
 * resolve.frag: sums of samples become colours of a screen: how open a surface is to the sky is a mean over rays of the
 * pixel, and while these are few, of its neighbours; then exposure, tone map and sRGB.
 */
const float INFINITE = 1e38;
#include "openness.glsl"

uniform highp sampler2D direct_sums, scattered_sums, mirrored_sums, own_sums, ends;
uniform ivec2 sums_size;
uniform float exposure;         // a factor
uniform mat3  balance;          // makes the light white that shall be
uniform int   tone_map;         // a row of choices.def
uniform int   reach;            // of the mean over neighbours, in pixels

layout(location = 0) out vec4 shown;

Openness find_mean(ivec2 pixel, float samples)
{
    float open = 0.0, hits = 0.0, albedo = 0.0, closed = 0.0, t = texelFetch(ends, pixel, 0).x;
    for (int y = -reach; y <= reach; y++)
        for (int x = -reach; x <= reach; x++) {
            ivec2 at = clamp(pixel + ivec2(x, y), ivec2(0), sums_size - 1);
            vec4  other = texelFetch(own_sums, at, 0);
            bool  alike = x == 0 && y == 0 || abs(texelFetch(ends, at, 0).x - t) < 0.02 * t;
            float weight = alike ? 1.0 : 0.0;
            float here = texelFetch(scattered_sums, at, 0).a;
            open += weight * here;
            hits += weight * other.a;
            closed += weight * (other.a - here);
            albedo += weight * texelFetch(mirrored_sums, at, 0).a;
        }
    return Openness(hits > 0.0 ? open / hits : 1.0, closed > 0.0 ? albedo / closed : 0.0);
}

vec3 find_light(ivec2 pixel, vec4 direct)
{
    vec4 own = texelFetch(own_sums, pixel, 0);
    if (own.a == 0.0)
        return direct.rgb / direct.a;
    Openness openness = find_mean(pixel, direct.a);
    vec3  body = with_bounces(openness.open, guess_color(own.rgb / own.a, openness.albedo));
    float mirror = with_bounces(openness.open, vec3(openness.albedo)).x;
    return (direct.rgb + texelFetch(scattered_sums, pixel, 0).rgb * body +
            texelFetch(mirrored_sums, pixel, 0).rgb * mirror) / direct.a;
}

// As in runtime/display/tone_maps.c.
vec3 neutral(vec3 color)
{
    const float start = 0.76, desaturation = 0.15;
    float least = min(min(color.r, color.g), color.b);
    float offset = least < 0.08 ? least - 6.25 * least * least : 0.04;
    float peak = max(max(color.r, color.g), color.b) - offset, top = peak, white = 0.0;
    if (peak >= start) {
        float room = 1.0 - start;
        top = 1.0 - room * room / (peak + room - start);
        white = 1.0 - 1.0 / (desaturation * (peak - top) + 1.0);
    }
    float scale = peak > 0.0 ? top / peak : 1.0;
    return (color - offset) * scale * (1.0 - white) + top * white;
}

vec3 aces(vec3 color)
{
    vec3 v = color * mat3(0.59719, 0.35458, 0.04823, 0.07600, 0.90834, 0.01566, 0.02840, 0.13383, 0.83777);
    v = (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081);
    return v * mat3(1.60475, -0.53108, -0.07367, -0.10208, 1.10813, -0.00605, -0.00327, -0.07276, 1.07602);
}

vec3 agx(vec3 color)
{
    color = color * mat3(0.6274039, 0.3292830, 0.0433131, 0.0690973, 0.9195404, 0.0113623, 0.0163914, 0.0880133, 0.8955953);
    color = color * mat3(0.856627153315983, 0.0951212405381588, 0.0482516061458583, 0.137318972929847, 0.761241990602591,
                         0.101439036467562, 0.11189821299995, 0.0767994186031903, 0.811302368396859);
    vec3 x = (clamp(log2(max(color, 1e-10)), -12.47393, 4.026069) + 12.47393) / (4.026069 + 12.47393);
    x = -0.00232 + x * (0.1191 + x * (0.4298 + x * (-6.868 + x * (31.96 + x * (-40.14 + x * 15.5)))));
    x = x * mat3(1.1271005818144368, -0.1106066430966032, -0.0164939387178346, -0.1413297634984383, 1.157823702216272,
                 -0.0164939387178343, -0.1413297634984383, -0.1106066430966029, 1.2519364065950405);
    x = pow(max(x, 0.0), vec3(2.2));
    return x * mat3(1.6604910, -0.5876411, -0.0728499, -0.1245505, 1.1328999, -0.0083494, -0.0181508, -0.1005789, 1.1187297);
}

vec3 to_srgb(vec3 linear)
{
    vec3 color = clamp(linear, 0.0, 1.0);
    return mix(1.055 * pow(color, vec3(1.0 / 2.4)) - 0.055, 12.92 * color, lessThanEqual(color, vec3(0.0031308)));
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4  direct = texelFetch(direct_sums, pixel, 0);
    vec3 color = clamp(balance * (exposure * find_light(pixel, direct)), 0.0, 1e9);
    color = tone_map == 1 ? aces(color) : tone_map == 2 ? agx(color) : tone_map == 3 ? color : neutral(color);
    shown = vec4(to_srgb(color), 1.0);
}
