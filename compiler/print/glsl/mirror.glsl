/*
 * mirror.glsl: a point mirrored into a half-space.
 *
 * Mirrors follow one another, each waiting for the one before: six operations deep, where the usual
 * way of writing it is eight.
 */

float krs_mirror_excess(vec3 p, vec3 n, float w)
{
    return (p.x * n.x + p.y * n.y) + (p.z * n.z - w);
}

vec3 krs_fold(vec3 p, vec3 n, float w)
{
    return p - max(krs_mirror_excess(p, n, w), 0.0) * (2.0 * n);
}
