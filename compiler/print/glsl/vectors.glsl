/*
 * vectors.glsl: unit vectors; of 0, which has no direction, 0.
 */

float krs_inverse_length(float square)
{
    return mix(0.0, inversesqrt(square), square > 0.0);
}

vec2 krs_normalize(vec2 a) { return a * krs_inverse_length(dot(a, a)); }

vec3 krs_normalize(vec3 a) { return a * krs_inverse_length(dot(a, a)); }

vec4 krs_normalize(vec4 a) { return a * krs_inverse_length(dot(a, a)); }
