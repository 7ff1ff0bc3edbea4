/*
 * julia.glsl: Julia sets of quaternions; graph/fractal.c says why this is a bound.
 *
 * Loops over the power have constant ends, so that they are unrolled; so are those of a Julia set
 * up to 32 iterations, as an array whose index varies costs more than all the rest, and lavapipe
 * ends the loops of a dispatch silently after 65,535 iterations.  What an orbit does after it has
 * left is not looked at, so it need not be kept from going on: a step would have to wait for its
 * mask.
 */

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

vec2 krs_julia_trap(vec3 p, vec4 c, vec2 range, vec2 settings)
{
    float last = min(settings.x, range.y), size = length(p);
    vec4 z = vec4(p, 0.0);
    vec2 trap = vec2(1.0);
    for (float n = 1.0; n <= last && size <= 2.0 * settings.y; n += 1.0) {
        z = krs_julia_step(z, c, int(range.x));
        size = length(z);
        trap = size < trap.x ? vec2(size, n / last) : trap;
    }
    return trap;
}
