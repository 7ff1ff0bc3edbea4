/*
 * tree.glsl: what the trees are made of: a mirror that folds space, and a piece of a ring that
 * is capped by balls.
 */

// The half behind a mirror comes before it.
#define FOLD(normal, offset) p -= 2.0 * max(dot(p, normal) - offset, 0.0) * normal;

// Nearer of what there is so far and a limb: the axes of its arc's circle (x along the chord, y
// towards the middle of the arc), the centre along them, half of the angle as sine and cosine,
// and the radii of circle and limb.
#define LIMB(x, y, z, centre, half_angle, radius, thickness) \
    d = min(d, limb(vec3(dot(p, x), dot(p, y), dot(p, z)) - centre, half_angle, radius, thickness));

// Quilez' capped torus.
float limb(vec3 q, vec2 half_angle, float radius, float thickness)
{
    q.x = abs(q.x);
    float reach = half_angle.y * q.x > half_angle.x * q.y ? dot(q.xy, half_angle) : length(q.xy);
    return sqrt(dot(q, q) + radius * radius - 2.0 * radius * reach) - thickness;
}
