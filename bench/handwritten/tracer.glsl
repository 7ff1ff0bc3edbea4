/*
 * tracer.glsl: plain sphere tracing as a careful author of Shadertoy pictures writes it.
 *
 * A thread to a pixel, 8x8 to a group, one loop from where the ray enters a box around the scene,
 * a stop within a share of the pixel, a normal from four taps in a loop, light without shadows
 * and occlusion.  All numbers are literals.  The scene has said what map, material, LOW, HIGH and
 * METALLIC are.  Camera, stop and light are those of runtime/shaders.
 */
layout(local_size_x = 8, local_size_y = 8) in;

layout(std430, binding = 1) writeonly buffer Picture {
    vec4 picture[]; // colour, and the depth of the hit: 0 where there is none
};

// Always 0; a loop from it is not unrolled into copies of the distance.
layout(push_constant) uniform Zero { int zero; };

const float PI = 3.14159265358979;

// The scenes have no fog.
const struct Surroundings { vec4 zenith, horizon, ground, fog; vec2 fog_level; } frame =
    Surroundings(vec4(ZENITH, 0.0), vec4(HORIZON, 0.0), vec4(GROUND, 0.0), vec4(0.0), vec2(0.0));

#include "light.glsl"
#include "sky_means.glsl"

vec3 normal_at(vec3 p, float spacing)
{
    vec3 sum = vec3(0.0);
    for (int i = zero; i < 4; i++) {
        vec3 direction = 0.5773 * (2.0 * vec3(((i + 3) >> 1) & 1, (i >> 1) & 1, i & 1) - 1.0);
        sum += direction * map(p + spacing * direction);
    }
    return normalize(sum);
}

// Finds where the ray is inside of the box.
vec2 clip_to_box(vec3 eye, vec3 direction)
{
    vec3 a = (LOW - eye) / direction, b = (HIGH - eye) / direction;
    vec3 enter = min(a, b), leave = max(a, b);
    return vec2(max(max(enter.x, enter.y), max(enter.z, 0.0)), min(leave.x, min(leave.y, leave.z)));
}

// Groups are dealt out in contiguous shares on some devices: neighbours, which cost alike, are
// spread over them by a step that is prime to every number of groups.
ivec2 find_pixel()
{
    const uint across = (WIDTH + 7) / 8, groups = across * ((HEIGHT + 7) / 8);
    uint tile = gl_WorkGroupID.x * 7919u % groups;
    return ivec2(uvec2(tile % across, tile / across) * 8u + gl_LocalInvocationID.xy);
}

void main()
{
    ivec2 pixel = find_pixel();
    if (pixel.x >= WIDTH || pixel.y >= HEIGHT)
        return;

    vec3  forward = normalize(TARGET - EYE);
    vec3  right = normalize(cross(forward, vec3(0.0, 1.0, 0.0)));
    vec3  up = cross(right, forward);
    vec2  place = (2.0 * vec2(pixel) + 1.0 - vec2(WIDTH, HEIGHT)) / float(HEIGHT);
    vec3  straight = forward + tan(0.5 * FOV) * (place.x * right - place.y * up);
    float stretch = length(straight);
    vec3  direction = straight / stretch;
    float width = 2.0 * tan(0.5 * FOV) / float(HEIGHT) / stretch; // of a pixel, times t

    vec2  range = clip_to_box(EYE, direction);
    float t = range.x;
    int   steps = 0;
    bool  hit = false;
    for (; steps < MAX_STEPS && t < range.y; steps++) {
        float d = map(EYE + t * direction);
        if (d < ERROR * width * t) {
            hit = true;
            break;
        }
        t += d;
    }
    hit = hit || (steps == MAX_STEPS && t < range.y); // creeping along a surface

    vec3 color = sky_radiance(direction) +
                 sun_radiance(direction, SUN_DIRECTION, SUN_COLOR, SUN_SOFTNESS);
    if (hit) {
        vec3 p = EYE + t * direction;
        vec3 n = normal_at(p, 0.5 * width * t);
        vec4 m = material(p);
        Mirror mirror = find_mirror(n, -direction, m.rgb, m.a, METALLIC);
        color = mirror.below * m.rgb * sky_light(n) +
                find_sky_mirrored(n, -direction, m.a) * mirror.around +
                SUN_COLOR * reflected(n, -direction, SUN_DIRECTION, m.rgb, m.a, mirror);
    }
#ifdef COUNT_STEPS
    color = vec3(min(steps + (hit ? 1 : 0), MAX_STEPS));
#endif
    picture[pixel.y * WIDTH + pixel.x] = vec4(color, hit ? t / stretch : 0.0);
}
