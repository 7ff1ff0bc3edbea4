/*
 * differences.glsl: the gradient of a component by differences, and its distance.  N is the
 * component's number.
 */

vec4 krs_gradient_N(vec3 p, float reach)
{
    vec4 found = vec4(0.0);
    for (uint i = 0u; i < 7u; i++) {
        vec3 offset = vec3(float(i >> 1u == 0u), float(i >> 1u == 1u), float(i >> 1u == 2u));
        offset *= (i & 1u) == 0u ? reach : -reach;
        float d = krs_distance_N(p + offset);
        found += i < 6u ? vec4(d * offset, 0.0) : vec4(0.0, 0.0, 0.0, d);
    }
    return found;
}
