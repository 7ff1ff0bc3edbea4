/*
 * solid.glsl: the pixels whose ray hits something, as a list: what comes after the primary rays
 * is about them alone.  The list lies where the queue of rays was.
 */
layout(std430, set = 1, binding = 6) buffer Solid { uint solid[]; };

// The ray of a pixel of the list, and where it hits.
struct Place {
    uint  index;     // of the pixel
    vec3  position;
    vec3  direction; // of the ray, unit
    float width;     // of a pixel there
    float rounding;  // of the coordinates
    float side;      // as of a Ray
};

Place find_place(uint number)
{
    Place place;
    place.index = solid[number];
    uvec2 pixel = work.corner + find_cell(place.index, work.extent.x);
    vec3  origin;
    float base, slope;
    find_ray(vec2(pixel) + work.offset, origin, place.direction, base, slope);
    Ray ray = find_end(place.index);
    place.position = origin + ray.t * place.direction;
    place.width = base + slope * ray.t;
    place.rounding = ROUNDING * (largest(place.position) + largest(origin));
    place.side = ray.side;
    return place;
}
