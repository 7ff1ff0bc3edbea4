/*
 * shading_normal.glsl: the normal of a hit by which a surface scatters light.
 */
// Returns the normal on the side of the ray.  Where a material tilts it too far, the surface's own
// is taken.
vec3 find_normal(HitPoint hit, KrsSurface surface, vec3 facing)
{
    vec3  normal = hit.side * surface.normal;
    float size = length(normal);
    bool  usable = size > 0.0 && dot(normal, hit.direction) < 0.0 && dot(normal, facing) > 0.0;
    return usable ? normal / size : facing;
}
