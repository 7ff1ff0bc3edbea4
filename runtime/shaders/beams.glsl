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

// A beam as a lamp sees it: where on the ray it is nearest, how far, and the angles of the ends from there.
struct SeenBeam {
    float nearest, gap;
    float first, last;
};

SeenBeam see_beam(Beam beam, Light light)
{
    SeenBeam seen;
    vec3 way = light.vector - beam.origin;
    seen.nearest = dot(way, beam.direction);
    seen.gap = max(length(way - seen.nearest * beam.direction), 1e-5 * (1.0 + length(way)));
    seen.first = krs_atan2(beam.from - seen.nearest, seen.gap);
    seen.last = krs_atan2(beam.to - seen.nearest, seen.gap);
    return seen;
}

// Tells how much light a lamp sends to a beam: the integral of what it has anywhere.
float find_beam_importance(Beam beam, Light light)
{
    SeenBeam seen = see_beam(beam, light);
    bool meets = is_positional(light) && beam.from < beam.to;
    return meets ? luminance(light.color) * (seen.last - seen.first) / seen.gap : 0.0;
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
