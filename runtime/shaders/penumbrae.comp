#version 440
#extension GL_GOOGLE_include_directive : enable
/*
 * penumbrae.comp: for each quarter of a tile, how many pixels see the light, how many do not, and
 * the widths of their penumbrae.  From that shadow.comp finds the radius of its means.
 *
 * An item is a quarter of the list, for which unproven.comp has stored two bits a pixel.
 */
#include "frame.glsl"
#include "hit_lists.glsl"
#include "shared.glsl"

// The widest penumbra that counts, in pixels: no mean reaches farther.
const float WIDEST_PENUMBRA = 1024.0;

void begin_group() {}

void do_item(uint number)
{
    uint  quarter = find_listed(control.reading + number), first = slot_of_quarter(quarter);
    uint  at = quarter_at(LIGHT_OF_QUARTERS, quarter), bits = find_listed(at);
    uint  lit = bitCount(bits >> 16u), hidden = 0u;
    float width = 0.0;
    for (uint left = bits & 0xffffu; left != 0u; left &= left - 1u) {
        uint code = find_shared(RAYS_SHARED, slot_of_bit(first, left)) & 255u;
        bool hides = code >= NARROWEST && code <= WIDEST;
        lit += uint(code == LIT);
        hidden += uint(hides);
        width += hides ? min(width_of_code(code), WIDEST_PENUMBRA) : 0.0;
    }
    pixel_lists[at] = pack_penumbrae(Penumbrae(float(lit), float(hidden), width));
}

#include "pixels.glsl"
