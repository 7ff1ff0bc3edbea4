/*
 * vectors.glsl: unit vectors; of 0, which has no direction, 0.
 */

float krs_inverse_length(float square)
{
    return mix(0.0, inversesqrt(square), square > 0.0);
}

vec2 krs_normalize_vec2(vec2 a) { return a * krs_inverse_length(dot(a, a)); }

vec3 krs_normalize_vec3(vec3 a) { return a * krs_inverse_length(dot(a, a)); }

vec4 krs_normalize_vec4(vec4 a) { return a * krs_inverse_length(dot(a, a)); }
