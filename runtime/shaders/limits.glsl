/*
 * limits.glsl: depths that the caller has given, at which rays of pixels end.
 */

// Returns the depth of the pixel of this index.  Depths are of the whole pixel, and lie behind the
// lights and listed rays, four in a texel.
float find_limit(uint index)
{
    uvec4 four = load_input(control.limits + index / 4u);
    uint  low = (index & 1u) == 0u ? four.x : four.y, high = (index & 1u) == 0u ? four.z : four.w;
    return uintBitsToFloat((index & 2u) == 0u ? low : high);
}

// Returns the depth of a point, for each unit along its ray: as in store_aovs (aovs.glsl).
float find_depth_rate(vec3 direction)
{
    bool along = control.projection == PERSPECTIVE || control.projection == ORTHOGRAPHIC;
    return along ? dot(direction, frame.forward.xyz) : 1.0;
}

// Finds where the ray of a pixel need go no farther.  It goes a little beyond its depth, so that
// the steps before stay as they are; limit.comp ends it there.
const float BEYOND_LIMIT = 1.02;
float find_end_by_limit(uint index, vec3 direction)
{
    return BEYOND_LIMIT * find_limit(index) / max(find_depth_rate(direction), 1e-6);
}
