/*
 * secondary_ends.glsl: what comes of rays that start at hits (secondary.glsl).
 */
#include "shared.glsl"
#include "occluders.glsl"

#ifndef PATH_RAYS
// A ray of a hit that has ended at t; how wide a pixel is at the hit, the radius of the light, and how far that is, or 0
// if it has no place.
struct RayOfHit {
    bool  blocked, below_horizon;
    float t, width, radius, light_distance;
};

// Returns the width of the blocker's penumbra at the hit, in pixels.
float find_penumbra(RayOfHit ray)
{
    float width = 2.0 * ray.radius * ray.t;
    if (ray.light_distance > 0.0)
        width /= max(ray.light_distance - ray.t, 1e-30);
    return width / ray.width;
}

// Lists a hit as one whose ray has met an occluder.
void list_occluder(uint slot, float t)
{
    store_occluder(LIST_WIDE, ivec2(pixel_of(slot)), t);
    pixel_lists[LIST_REMAINING * band_pixels() + atomicAdd(counts.remaining, 1u)] = slot;
}

void store_end(uint slot, float depth, RayOfHit ray)
{
    uint code = ray.below_horizon ? BELOW_HORIZON
                : ray.blocked     ? code_of_width(find_penumbra(ray))
                                  : LIT;
    if (control.phase == RAYS_OVER_HEMISPHERE) {
        code = ray.blocked ? code_of_width(ray.t / ray.width) : LIT;
        if (ray.blocked)
            list_occluder(slot, ray.t);
    }
    if (control.filters != 0u)
        store_shared(RAYS_SHARED, slot, depth, code);
    else
        store_lighting(control.value, slot, ray.blocked || ray.below_horizon ? 0.0 : 1.0);
}
#endif
