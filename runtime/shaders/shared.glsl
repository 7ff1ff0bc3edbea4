/*
 * shared.glsl: what a ray from a pixel's hit has found, in a word that the pixels around read.
 *
 * The upper 24 bits are those of the depth of the hit along the pixel's axis, so that the word
 * alone gives the hit's position.  The lower 8 bits are a code.  A pixel without a ray has the word
 * 0.
 */
#include "discs.glsl"

// Codes of rays to a light.  LIT: nothing is in between.  BELOW_HORIZON: the point of the light
// lies behind the surface itself.  NARROWEST to WIDEST: the ray is blocked, and this is the width
// of the penumbra.  Those of rays over the hemisphere are the same, but the width is how far away
// the occluder is.
const uint LIT = 1u, BELOW_HORIZON = 255u, NARROWEST = 2u, WIDEST = 254u;
// Codes of widths, in pixels: powers of 2^(1/8), from 2^-4 on.
const float WIDTHS_A_DOUBLING = 8.0, NARROWEST_LOG = -4.0;
// Codes of openness: from CLOSED on, and OPEN_CODES above it where all is open.
const uint CLOSED = 1u;
const float OPEN_CODES = 254.0;

// The axis of a pixel, along its ray.  Where a unit vector would cost a root, the axis has length 1
// along the view.
#if defined(LISTED_RAYS) || defined(PATH_RAYS) || defined(LENS)
void find_axis(vec2 image_point, out vec3 origin, out vec3 axis)
{
    float base, slope;
    find_ray(image_point, origin, axis, base, slope);
}

// Tells how far a hit is along the axis of its pixel.
float find_depth(HitPoint hit) { return find_end(index_of(pixel_of(hit.slot))).t; }
#else
void find_axis(vec2 image_point, out vec3 origin, out vec3 axis)
{
    vec2 plane = vec2(2.0 * image_point.x / frame.size.x - 1.0,
                      1.0 - 2.0 * image_point.y / frame.size.y);
    vec3  lateral = plane.x * frame.right.xyz + plane.y * frame.up.xyz;
    float spreads = control.projection == PERSPECTIVE ? 1.0 : 0.0;
    origin = frame.eye + (1.0 - spreads) * lateral;
    axis = frame.forward.xyz + spreads * lateral;
#ifdef PANORAMIC
    float base, slope;
    if (control.projection == PANORAMA)
        find_ray(image_point, origin, axis, base, slope);
#endif
}

// Tells how far a hit is along the axis of its pixel.
float find_depth(HitPoint hit)
{
    float along = dot(hit.position - frame.eye, frame.forward.xyz);
#ifdef PANORAMIC
    if (control.projection == PANORAMA)
        along = find_end(index_of(pixel_of(hit.slot))).t;
#endif
    return along;
}
#endif

void store_shared(uint list, uint slot, float depth, uint code)
{
    pixel_lists[shared_at(list, slot)] = floatBitsToUint(depth) & 0xffffff00u | code;
}

uint find_shared(uint list, uint slot)
{
    return find_listed(shared_at(list, slot));
}

uint code_of_width(float pixels)
{
    float code = WIDTHS_A_DOUBLING * (log2(max(pixels, 1e-6)) - NARROWEST_LOG);
    return NARROWEST + uint(clamp(code, 0.0, float(WIDEST - NARROWEST)));
}

float width_of_code(uint code)
{
    return exp2(float(code - NARROWEST) / WIDTHS_A_DOUBLING + NARROWEST_LOG);
}

uint code_of_openness(float openness) { return CLOSED + uint(OPEN_CODES * openness + 0.5); }

float openness_of_code(uint code) { return float(code - CLOSED) / OPEN_CODES; }

// The counts of a light around a pixel.  `lit` and `hidden` are numbers of pixels that see it and
// that do not.  `width` is the sum of the penumbrae's widths of the latter, in pixels.
struct Penumbrae {
    float lit, hidden, width;
};

// Packs the numbers of a quarter of a tile, whose counts are at most 16.
uint pack_penumbrae(Penumbrae of)
{
    return packHalf2x16(vec2(of.width, 0.0)) | uint(of.lit) << 16u | uint(of.hidden) << 24u;
}

Penumbrae unpack_penumbrae(uint word)
{
    return Penumbrae(float(word >> 16u & 255u), float(word >> 24u),
                     unpackHalf2x16(word & 0xffffu).x);
}
