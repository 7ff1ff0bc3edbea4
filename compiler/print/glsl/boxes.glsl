/*
 * boxes.glsl: how far it is to a box; 0 inside.
 */

float krs_box_distance(vec3 p, vec3 center, vec3 half_sides)
{
    return length(max(abs(p - center) - half_sides, vec3(0.0)));
}
