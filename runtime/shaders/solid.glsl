/*
 * solid.glsl: the pixels whose ray hits something, as a list: what comes after the primary rays
 * is about them alone.
 *
 * A quarter of them, those in columns and rows 0, 2, 5 and 7 of their tile of 8x8, are anchors:
 * where all of a tile agree, the pixels in between are filled in.  Lists lie where the queue of
 * rays was, each with room for all pixels: all, the anchors, and those that are not filled in; a
 * fourth part says of each tile whether its anchors agree.  Where groups of components were marched
 * one after the other, lists of what each of them shows follow.
 */
layout(std430, set = 1, binding = 6) buffer Solid { uint solid[]; };

uint band_pixels() { return work.extent.x * work.extent.y; }

bool is_anchor(uvec2 pixel)
{
    return (0xA5u >> (pixel.x & 7u) & 0xA5u >> (pixel.y & 7u) & 1u) != 0u;
}

// Hits once more, number by number: fill.comp works on either of two of these.
layout(std430, set = 1, binding = 2) buffer HitNumbers { float hit_numbers[]; };

// The ray of a pixel of the list, and where it hits, as background.comp has found it.
struct Place {
    uint  index;     // of the pixel in the band
    vec3  position;
    vec3  direction; // of the ray, unit
    float width;     // of a pixel there
    float rounding;  // of the coordinates
    float side;      // as of a Ray
};

Place find_place_of(uint index)
{
    vec4 place = hits[index].place, ray = hits[index].ray;
    return Place(index, place.xyz, ray.xyz, abs(place.w), ray.w, place.w < 0.0 ? -1.0 : 1.0);
}

// The place of item `number` of the list that is read.
Place find_place(uint number) { return find_place_of(solid[control.reading + number]); }
