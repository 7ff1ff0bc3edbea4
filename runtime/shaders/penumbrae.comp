#version 440
#extension GL_GOOGLE_include_directive : enable
/*
 * penumbrae.comp: for each quarter of a tile, how many pixels see the light, how many do not, and
 * the widths of their penumbrae; then the same with what quarters around know.  From that shadow.comp
 * finds the radius of its means.
 *
 * An item is a quarter of the list, for which unproven.comp has stored two bits a pixel.
 */
#include "frame.glsl"
#include "hit_lists.glsl"
#include "shared.glsl"
#include "neighbours.glsl"
#include "quarters.glsl"

// The widest penumbra that counts, in pixels: no mean reaches farther.
const float WIDEST_PENUMBRA = 1024.0;

// The quarters that are asked to each side, where the penumbra is at least so many pixels wide;
// more would be beyond the halo of a band.
const int   SPREAD = 1;
const float MIN_WIDTH = 4.15; // no width that a code says, as rounding would decide

void begin_group() {}

void count_penumbrae(uint quarter)
{
    uint  first = slot_of_quarter(quarter);
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

// Stores what is known with the quarters around.  At the dark end of a wide penumbra a quarter may have no
// ray that sees the light, though it sees some of it: one of the quarters around has such a ray.
void spread_penumbrae(uint quarter)
{
    ivec2     place = ivec2(pixel_of(slot_of_quarter(quarter))) >> 2, tap = ivec2(-SPREAD);
    Penumbrae own = find_quarter(LIGHT_OF_QUARTERS, place);
    bool      seeks = own.lit == 0.0 && own.width > MIN_WIDTH * own.hidden;
    do {
        float lit = find_quarter(LIGHT_OF_QUARTERS, place + tap).lit;
        own.lit = seeks && lit > 0.0 ? 1.0 : own.lit;
        tap = next_offset(tap, SPREAD);
    } while (seeks && tap.y <= SPREAD);
    pixel_lists[quarter_at(LIGHT_AROUND_QUARTERS, quarter)] = pack_penumbrae(own);
}

void do_item(uint number)
{
    uint quarter = find_listed(control.reading + number);
    if (control.phase == PENUMBRAE_COUNTED)
        count_penumbrae(quarter);
    else
        spread_penumbrae(quarter);
}

#include "pixels.glsl"
