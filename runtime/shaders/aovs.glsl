/*
 * aovs.glsl: stores the AOVs of a picture (krs/aovs.def) where something is hit.
 */
// Stores the results of a pixel, one wanted row after the other.  Without the loop lavapipe would
// take as long for unwanted rows as for wanted ones.
void store_aovs(uint index, uint rows, vec4 color, HitPoint hit, vec3 outward, vec3 albedo,
                  KrsSurface surface)
{
    vec3  difference = hit.position - frame.eye;
    float along = dot(difference, frame.forward.xyz);
    float depth = control.projection == PANORAMA ? length(difference) : along;
#ifdef LISTED_RAYS
    depth = find_end(index).t;
#endif
    uvec3 normal = floatBitsToUint(outward);
    do { // do-while, as in pixels.glsl
        uint  row = uint(findLSB(rows));
        uvec4 numbers = floatBitsToUint(color);
        if (row == ROW_POSITIONS)
            numbers = floatBitsToUint(vec4(hit.position, depth));
        if (row == ROW_NORMALS)
            numbers = uvec4(normal, surface.component);
        if (row == ROW_ALBEDOS)
            numbers = uvec4(floatBitsToUint(albedo), surface.level);
        if (row == ROW_COUNTS)
            numbers = uvec4(surface.instance, hit.steps, surface.material, 0u);
        results[(row == ROW_COLORS ? control.color_row : row) * band_pixels() + index] = numbers;
        rows &= rows - 1u;
    } while (rows != 0u);
}
