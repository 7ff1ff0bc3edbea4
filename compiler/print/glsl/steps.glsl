/*
 * steps.glsl: a cubic step, and minima that are joined by stairs.  The built-in smoothstep is undefined
 * for a >= b.
 */

float krs_smoothstep(float a, float b, float c)
{
    float t = mix(clamp((c - a) / (b - a), 0.0, 1.0), step(a, c), a == b);
    return t * t * (3.0 - 2.0 * t);
}

float krs_smin_stairs(float a, float b, float k, float n)
{
    float s = max(k, 1e-30) / max(n, 1.0), u = b - k;
    float t = (u - a + s) / (2.0 * s);
    float wave = abs((t - floor(t)) * 2.0 * s - s);
    return mix(min(a, b), min(min(a, b), 0.5 * (u + a + wave)), k > 0.0);
}
