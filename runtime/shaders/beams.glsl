/*
 * beams.glsl: light of lamps that media scatter into the rays of a camera.
 *
 * Much of it comes from near a lamp, where its light is strong.  Paths meet a thin medium there by chance alone.  So each
 * ray of a camera asks one lamp at a place of its own as well, chosen by how its light falls off (equiangular
 * sampling, Kulla and Fajardo 2012).  Both ways together count once, by the power heuristic (Veach 1997).  The density by
 * which paths choose a place is known but for what media leave on the way; for the weights it need not be.
 */

// The part of a ray that is in boxes of media; none: it ends before it begins.
struct Beam {
    vec3  origin, direction;
    float from, to;
};

Beam find_beam(vec3 origin, vec3 direction, float end)
{
    Beam beam = Beam(origin, direction, INFINITE, 0.0);
    for (uint i = 0u; i < VOLUMES; i++) {
        Volume volume = find_volume(i);
        vec2   range = clip_to(volume.low, volume.high, origin, direction, end);
        bool   meets = volume.exists && range.x < range.y;
        beam.from = meets ? min(beam.from, range.x) : beam.from;
        beam.to = meets ? max(beam.to, range.y) : beam.to;
    }
    return beam;
}

// A beam as a lamp sees it: the part where the lamp shines, where on the ray it is nearest, how far, and the angles
// of the ends from there.
struct SeenBeam {
    float from, to;
    float nearest, gap;
    float first, last;
};

// Cuts a beam to the cone of a spot.  `way`: from the lamp to where the ray begins.
void cut_to_cone(Light light, vec3 way, vec3 direction, inout SeenBeam seen)
{
    vec3  axis = cross(light.right, light.up);
    axis *= inversesqrt(max(dot(axis, axis), 1e-30));
    float ahead = dot(direction, axis), start = dot(way, axis), square_of = square(light.outer);
    float a = ahead * ahead - square_of, b = ahead * start - square_of * dot(way, direction);
    float c = start * start - square_of * dot(way, way), root = sqrt(max(b * b - a * c, 0.0));
    // q is not a difference of what is alike; the walls are at q / a and c / q.
    float q = -(b + (b < 0.0 ? -root : root));
    float one = q / (abs(a) > 1e-9 ? a : 1e-9), two = c / (abs(q) > 1e-30 ? q : 1e-30);
    float near = min(one, two), far = max(one, two);
    bool  crosses = a < 0.0; // else the ray stays in the cone, or has come from there
    bool  meets = b * b >= a * c && (!crosses || start + 0.5 * (near + far) * ahead > 0.0);
    seen.from = !meets ? INFINITE : crosses ? max(seen.from, near) : ahead > 0.0 ? max(seen.from, far) : seen.from;
    seen.to = crosses ? min(seen.to, far) : ahead > 0.0 ? seen.to : min(seen.to, near);
}

SeenBeam see_beam(Beam beam, Light light)
{
    vec3     way = light.vector - beam.origin;
    SeenBeam seen = SeenBeam(beam.from, beam.to, dot(way, beam.direction), 0.0, 0.0, 0.0);
    if ((light.kind & LIGHT_SPOT) != 0u && light.outer > 0.05)
        cut_to_cone(light, -way, beam.direction, seen);
    seen.gap = max(length(way - seen.nearest * beam.direction), 1e-5 * (1.0 + length(way)));
    seen.first = krs_atan2(seen.from - seen.nearest, seen.gap);
    seen.last = krs_atan2(seen.to - seen.nearest, seen.gap);
    return seen;
}

// Tells how much light a lamp sends to a beam: the integral of what it has anywhere.
float find_beam_importance(Beam beam, Light light)
{
    SeenBeam seen = see_beam(beam, light);
    bool meets = is_positional(light) && seen.from < seen.to;
    return meets ? luminance(light.color) * max(seen.last - seen.first, 0.0) / seen.gap : 0.0;
}

float sum_beam_importance(Beam beam)
{
    float sum = 0.0;
    for (uint i = 0u; i < control.lights; i++)
        sum += find_beam_importance(beam, find_light(i));
    return sum;
}

// Returns by how much more beams choose a lamp and a place than paths do.
float find_beam_ratio(Light light, vec3 place, float sum)
{
    vec3  way = light.vector - place;
    float by_beams = luminance(light.color) / max(sum * dot(way, way), 1e-30), density = 0.0;
    for (uint i = 0u; i < VOLUMES; i++)
        density += find_volume(i).exists ? krs_volume_density(i, place) : 0.0;
    float chance = find_importance(light, place) / max(sum_importance(place), 1e-30);
    return by_beams / max(density * chance, 1e-30);
}
