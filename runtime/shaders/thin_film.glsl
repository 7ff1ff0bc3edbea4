/*
 * thin_film.glsl: how a film changes what a surface mirrors, by interference.
 *
 * Light that goes back and forth in the film adds up as waves do (Airy 1833).  The sum is a series of
 * cosines of multiples of the phase, whose means over a band of wave numbers are known (Belcour and
 * Barla 2017).  Red, green and blue are a normal distribution of wave numbers each.  A film takes no
 * light away: what it does not send back goes on.
 */
#ifndef THIN_FILM // another file may have it already
#define THIN_FILM
#include "sines.glsl"
#include "optics.glsl"

// The middle and the standard deviation of each band, in waves in a micrometre.
const vec3 WAVES = vec3(1.0 / 0.611, 1.0 / 0.549, 1.0 / 0.465);
const vec3 WAVE_DEVIATION = vec3(0.08, 0.11, 0.12);
const uint MAX_TERMS = 8u;
// The reflectance of a metal is at most this, so that an index of refraction has it.
const float MAX_HEAD_ON = 0.9998;

// Returns the index of refraction that has this reflectance in a vacuum, head on.
vec3 ior_of(vec3 head_on)
{
    vec3 root = sqrt(clamp(head_on, 0.0, MAX_HEAD_ON));
    return (1.0 + root) / (1.0 - root);
}

// Returns the reflectance of one polarization, by the ratios of amplitudes at both boundaries, the
// cosine of the phase between two paths, and what is left of waves of a band that are so far apart.
vec3 sum_paths(float outer, vec3 inner, vec3 cosine, vec3 left)
{
    vec3 both = outer * inner, sum = vec3(1.0), term = vec3(1.0);
    vec3 before = vec3(1.0), now = cosine, fade = left, fading = left * left * left;
    for (uint m = 1u; m <= MAX_TERMS; m++) { // cosines of m times the phase, left^(m m)
        term *= -both;
        sum += 2.0 * term * now * fade;
        vec3 next = 2.0 * cosine * now - before;
        before = now;
        now = next;
        fade *= fading;
        fading *= left * left;
    }
    vec3 through = (1.0 - outer * outer) * (1.0 - inner * inner) / max(1.0 - both * both, 1e-9);
    return 1.0 - through * sum;
}

// Returns the reflectance of a film, so thick in micrometres, on a base; both have indices of
// refraction relative to what is outside.  `cosine` is that outside.
vec3 find_filmed(float cosine, float thickness, float film, vec3 base)
{
    float sine_squared = 1.0 - cosine * cosine;
    float within_film = sqrt(max(1.0 - sine_squared / (film * film), 0.0));
    vec3  beyond = sqrt(max(1.0 - sine_squared / (base * base), 0.0));
    float path = 2.0 * film * thickness * within_film;
    vec3  cycles = fract(path * WAVES);
    vec3  phase = vec3(krs_cos(2.0 * PI * cycles.x), krs_cos(2.0 * PI * cycles.y),
                       krs_cos(2.0 * PI * cycles.z));
    vec3  left = exp(-2.0 * square(PI * path) * WAVE_DEVIATION * WAVE_DEVIATION);
    float across = (cosine - film * within_film) / (cosine + film * within_film);
    float along = (film * cosine - within_film) / (film * cosine + within_film);
    vec3  deep_across = (film * within_film - base * beyond) / (film * within_film + base * beyond);
    vec3  deep_along = (base * within_film - film * beyond) / (base * within_film + film * beyond);
    return clamp(0.5 * (sum_paths(across, deep_across, phase, left) +
                        sum_paths(along, deep_along, phase, left)), 0.0, 1.0);
}

// Returns the same of glass that has so much of a film; `eta` is that beyond relative to here.  A
// film sends back the same from both sides, at angles that refraction makes of each other.
vec3 find_film_on_glass(float cosine, float eta, float weight, float thickness, float film)
{
    float mirrors = fresnel(cosine, eta);
    float outside = sqrt(max(1.0 - (1.0 - cosine * cosine) / square(min(eta, 1.0)), 0.0));
    vec3  filmed = vec3(mirrors);
    if (weight > 0.0 && mirrors < 1.0)
        filmed = find_filmed(outside, thickness, film, vec3(max(eta, 1.0 / eta)));
    return mix(vec3(mirrors), filmed, weight);
}
#endif
