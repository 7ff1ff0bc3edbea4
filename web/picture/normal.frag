/*
 * normal.frag: the normal of each hit, and how even the surface is there, by the taps of normals.comp.
 */
#define HITS
#include "page.glsl"

layout(location = 0) out vec4 found;

HitPoint hit;
float t;               // how far the taps reach
uint  taps, tap_limit; // evaluated so far, and at most
vec3  sum;             // of what taps say; along the normal in the end

vec3 find_backwards() { return -hit.direction; }

bool item_needs_step() { return taps < tap_limit; }

#include "distance_normals.glsl"

void main()
{
    load_frame();
    krs_prepare();
    found = vec4(0.0);
    if (!find_own_hit(hit))
        return;
    begin_normal();
    do {
        do
            take_tap();
        while (item_needs_step());
    } while (item_needs_more_taps());
    float size = length(sum), flatness = find_flatness();
    found = vec4(size > 0.0 && size < INFINITE ? sum / size : find_backwards(), flatness);
}
