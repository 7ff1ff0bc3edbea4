/*
 * media.glsl: boundaries of media as a ray sees them that is in the medium `ray`, or in none (0).
 */

// The length to the boundary of medium `number`.  That of the ray's own is seen from inside; those
// of media before it are none.
float krs_in_medium(uint ray, uint number, float length)
{
    return ray > number ? 1e30 : ray == number ? -length : length;
}

// The same of a gradient and, behind it, a distance.
vec4 krs_gradient_in_medium(uint ray, uint number, vec4 gradient)
{
    return vec4(ray == number ? -gradient.xyz : gradient.xyz,
                krs_in_medium(ray, number, gradient.w));
}
