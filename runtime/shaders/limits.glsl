/*
 * limits.glsl: depths that the caller has given, at which rays of pixels end.
 */

// The depth of the pixel of this index.  Depths are of the whole pixel, and lie behind the lights and
// listed rays, four in a texel.
float find_limit(uint index)
{
    uvec4 four = load_input(control.limits + index / 4u);
    uint  low = (index & 1u) == 0u ? four.x : four.y, high = (index & 1u) == 0u ? four.z : four.w;
    return uintBitsToFloat((index & 2u) == 0u ? low : high);
}

// The depth of a point, for each unit along its ray: as in store_planes (planes.glsl).
float find_depth_rate(vec3 direction)
{
    bool along = control.projection == PERSPECTIVE || control.projection == ORTHOGRAPHIC;
    return along ? dot(direction, frame.forward.xyz) : 1.0;
}
