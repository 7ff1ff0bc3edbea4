#version 440
#extension GL_GOOGLE_include_directive : enable
/*
 * normals.comp: the normal of each hit, from a few taps around it.
 *
 * Mostly all hits need as many taps, so lanes that loop together end together.  Where a hit needs
 * more, its lane falls behind, and the others go on.
 *
 * TANGENTS: taps tell the gradient (tangent_normals.glsl).  Else they tell the distance
 * (distance_normals.glsl).
 */
#include "scene.glsl"
#include "frame.glsl"
#include "hit_lists.glsl"
#if defined(PATH_RAYS) || defined(MIXED_RAYS)
#define FOLLOWS_PATHS
#include "media.glsl"
#endif

// The current item.
HitPoint hit;
float t;               // how far the taps reach
uint  taps, tap_limit; // evaluated so far, and at most
vec3  sum;             // of what taps say; along the normal in the end

// Returns the unit vector from the hit back along its ray.
vec3 find_backwards()
{
#if defined(LISTED_RAYS) || defined(PATH_RAYS) || defined(LENS)
    return -hit.direction;
#else
    vec3 backwards = control.projection == ORTHOGRAPHIC ? -frame.forward.xyz
                                                        : normalize(frame.eye - hit.position);
    return are_of_paths() ? -hit.direction : backwards;
#endif
}

bool item_needs_step() { return taps < tap_limit; }

#ifdef TANGENTS
#include "tangent_normals.glsl"
#else
#include "distance_normals.glsl"
#endif

void begin_item(uint number)
{
    hit = find_hit_point(number);
#ifdef FOLLOWS_PATHS
    uint index = index_of(pixel_of(hit.slot));
    enter_medium(are_of_paths() ? load_path(PATH_TOWARD, index).w : 0.0);
#endif
    begin_normal();
}

void store_normal()
{
    float size = length(sum), flatness = find_flatness();
    vec3  normal = size > 0.0 && size < INFINITE ? sum / size : find_backwards();
    store_hit(FACING, hit.slot, vec4(normal, flatness));
}

layout(local_size_x = 64) in;

void main()
{
    load_frame();
    krs_prepare();
    uint group = find_group(), lane = gl_LocalInvocationIndex & 7u;
    // A lane's items are those of pixels.glsl, in their order.
    uint number = (group * 64u + gl_LocalInvocationIndex - lane) * control.items_per_lane + lane;
    uint end = min(number + 8u * control.items_per_lane, control.items);
    bool goes_on = false; // with another set of taps for the same item
    taps = tap_limit = 0u;
    do { // do-while, as in pixels.glsl
        bool exists = number < end;
        if (exists && !goes_on)
            begin_item(number);
        do {
            take_tap();
        } while (item_needs_step());
        goes_on = exists && item_needs_more_taps();
        if (exists && !goes_on) {
            store_normal();
            number += 8u;
        }
    } while (number < end);
}
