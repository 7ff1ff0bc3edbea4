/*
 * cells.glsl: a point moved by whole periods into one cell, or rotated into one sector.
 */

vec3 krs_cell(vec3 p, vec3 period, vec3 low, vec3 high)
{
    bvec3 repeats = greaterThan(period, vec3(0.0));
    vec3 step = mix(vec3(1.0), period, repeats);
    vec3 number = min(max(floor(p / step + 0.5), low), high);
    return mix(p, p - step * number, repeats);
}

vec3 krs_cell_polar(vec3 p, float count)
{
    float sector = 6.28318530718 / max(count, 1.0);
    float angle = sector * floor(krs_atan2(p.z, p.x) / sector + 0.5);
    float c = krs_cos(angle), s = krs_sin(angle);
    vec3 turned = vec3(c * p.x + s * p.z, p.y, c * p.z - s * p.x);
    return mix(turned, p, bvec3(count < 1.0));
}
