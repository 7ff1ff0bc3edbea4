/*
 * hit_point.glsl: the point that a ray hits.
 */
#ifndef HIT_POINT
#define HIT_POINT

// The point that the ray of a pixel hits.  It is computed again wherever it is needed, which costs
// no more than to load it.
struct HitPoint {
    uint  slot;
    vec3  position;
    vec3  direction; // of the ray, unit
    float width;     // of a pixel there
    float near;      // the same, but from a camera at most MAX_WIDTH of the ray
    float rounding;  // error of the coordinates
    float side;      // as in RayEnd
    uint  steps;     // as in RayEnd
};

// Returns the point of a ray at t, where a pixel is base + slope t wide.
HitPoint hit_point_on(uint slot, vec3 origin, vec3 direction, float base, float slope, float t, float side, uint steps)
{
    vec3  position = origin + t * direction;
    float rounding = ROUNDING * (largest(position) + largest(origin));
    float width = max(width_at(t, base + slope * t), 1e-30); // it is a divisor
    float near = are_of_paths() ? width : max(min(width, MAX_WIDTH * t), 1e-30);
    return HitPoint(slot, position, direction, width, near, rounding, side, steps);
}

// The reach of the differences of which normals are made.  Its least, relative to the coordinates:
// less would be noise.  compiler/passes/precision.c decides where it is too much.
const float NOISE = 1e-4;
float find_reach(HitPoint hit)
{
    return max(frame.normal_reach * hit.near, NOISE * largest(hit.position) + hit.rounding);
}
#endif
