/*
 * plate.glsl: the plate of another renderer, as far as its depths tell of its surface.
 */

// Returns the plane through what a pixel shows: its unit normal, towards the eye, and the product
// of that with the points of the plane (film/plate.c).
vec4 find_plate_plane(uint index)
{
    return uintBitsToFloat(load_input(control.plate_planes + index));
}

// Tells whether a ray has ended at the plate (limit.comp).
bool is_of_plate(RayEnd ray)
{
    return ray.state == STATE_HIT && ray.march_group == MARCH_GROUP_OF_PLATE;
}
