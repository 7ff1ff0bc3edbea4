/*
 * mandelbulb.glsl: an estimate of the distance to Mandelbulbs.
 *
 * Complex numbers are (2 re, im): a square is (2 re)^2 - 2 |.|^2 and 2 re im.  A tilt's imaginary
 * part is counted in lengths across the axis.  A turn is divided by them as late as single
 * precision permits: each step waits for the one before, and nothing in it takes as long as that
 * division and the root.  Up to eight steps are unrolled; more end when all orbits have left.
 */

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

vec2 krs_mandelbulb_trap(vec3 c, vec2 range, vec2 settings)
{
    float last = min(settings.x, range.y), norm = dot(c, c), size = sqrt(norm);
    vec3 w = c;
    vec2 trap = vec2(1.0);
    for (float n = 1.0; n <= last && size <= 2.0 * settings.y; n += 1.0) {
        w = krs_triplex_step(w, c, norm, int(range.x)).xyz;
        norm = dot(w, w);
        size = sqrt(norm);
        trap = size < trap.x ? vec2(size, n / last) : trap;
    }
    return trap;
}
