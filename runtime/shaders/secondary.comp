#version 450
#extension GL_GOOGLE_include_directive : enable
/*
 * secondary.comp: what the distance around a hit tells: its normal, how open it is, and whether
 * it sees a light.
 *
 * The three phases are dispatches of one kernel, so that the scene is compiled once for them
 * and its distance stands once, in one loop.  A dispatch of the last phase is about one light
 * and adds its reflection to the pixel.
 */
#include "scene.glsl"
#include "frame.glsl"
#include "light.glsl"

const uint NORMALS = 0u, OCCLUSION = 1u, SHADOW = 2u;
const uint POSITIONAL = 1u, CASTS_SHADOWS = 2u;
const uint SHADOW_STEPS = 1024u;
const uint OCCLUSION_TAPS = 5u;

// The i-th corner of an octahedron: taps along the axes have an error of second order only.
vec3 octahedron(uint i)
{
    float side = (i & 1u) == 0u ? 1.0 : -1.0;
    return side * vec3(i >> 1u == 0u, i >> 1u == 1u, i >> 1u == 2u);
}

void main()
{
    uvec2 pixel;
    uint  index;
    if (!find_pixel(pixel, index))
        return;
    krs_prepare();

    vec3  origin, direction;
    float base, slope;
    find_ray(vec2(pixel) + work.offset, origin, direction, base, slope);
    Ray  ray = rays[index];
    Hit  hit = hits[index];
    bool solid = ray.fate == HIT;
    uint phase = control.phase;
    float rounding = ROUNDING * (largest(hit.position) + largest(origin));

    // Differences over half a pixel: finer detail would only be noise.  Below 3e-4 of the
    // coordinates rounding would be the noise.
    float apart = max(0.5 * hit.pixel, 3e-4 * largest(hit.position) + rounding);

    // From which the taps and the shadow ray start: off the surface, which the hit may be
    // below by the permitted error.
    vec3  start = hit.position;
    vec3  way = hit.normal;
    float far = 0.0, sharpness = 0.0;
    uint  limit = phase == NORMALS ? 6u : OCCLUSION_TAPS;
    if (phase == SHADOW) {
        start += hit.normal * (hit.pixel + 4.0 * rounding);
        bool  positional = (control.light_kind & POSITIONAL) != 0u;
        vec3  toward = positional ? work.light_vector - start : work.light_vector;
        float remote = positional ? max(length(toward), 1e-12) : 1.0;
        way = toward / remote;
        far = positional ? remote : frame.eye.w;
        far = min(far, clip_ray(start, way, far).y);
        // As wide as the light is seen, and outwards of the hard shadow's edge: the distance
        // of a ray that misses is known, not how deep one is that does not.
        sharpness = work.light_softness <= 0.0 ? INFINITE
                  : positional ? 0.5 * remote / work.light_softness
                               : 0.5 / tan(0.5 * min(work.light_softness, 3.0));
        bool needed = (control.light_kind & CASTS_SHADOWS) != 0u && dot(hit.normal, way) > 0.0;
        limit = needed ? SHADOW_STEPS : 0u;
    }
    if (!solid)
        limit = 0u;

    vec3  sum = vec3(0.0);
    float blocked = 0.0, weight = 0.33, reach = 0.0625 * frame.occlusion_reach;
    float visible = 1.0, t = 0.0, before = INFINITE;
    bool  done = false;
    for (uint i = 0u; i < limit && !done; i++) {
        if (phase == NORMALS) {
            way = octahedron(i);
            t = apart;
        } else if (phase == OCCLUSION) {
            t = reach;
        }
        float distance = ray.side * krs_distance(start + t * way);

        if (phase == NORMALS) {
            sum += distance * way;
        } else if (phase == OCCLUSION) {
            // How much less room there is than an open surface would leave, at five scales.
            blocked += weight * clamp(1.0 - distance / t, 0.0, 1.0);
            weight *= 0.75;
            reach *= 2.0;
        } else {
            // A surface may be as near as the rim where this step's sphere meets the last one's,
            // which lies `back` behind here, if that is ahead of the last step.
            visible = min(visible, sharpness * distance / max(t, rounding));
            float back = distance * distance / (2.0 * before);
            float aside = sqrt(max(distance * distance - back * back, 0.0));
            if (back < before)
                visible = min(visible, sharpness * aside / max(t - back, rounding));
            if (distance < max(frame.error * hit.pixel, rounding))
                visible = 0.0;
            // A ray that creeps along a surface goes on by a pixel at least, or a quarter of the
            // penumbra's width: what it could miss is too small to be seen.
            float least = max(hit.pixel, 0.25 * t / sharpness);
            before = distance < least ? INFINITE : distance;
            t += max(distance, least);
            done = visible < 4e-3 || t >= far;
        }
    }

    if (!solid && phase != SHADOW)
        return;
    if (phase == NORMALS) {
        float steepness = length(sum);
        hits[index].normal = steepness > 0.0 && steepness < INFINITE ? sum / steepness : -direction;
    } else if (phase == OCCLUSION) {
        hits[index].occlusion = exp2(-2.5 * blocked); // light finds its way in by reflection
    } else if (!solid) {
        if ((control.light_kind & POSITIONAL) == 0u)
            hits[index].radiance += sun_radiance(direction, work.light_vector, work.light_color,
                                                 work.light_softness);
    } else {
        if (limit > 0u && !done && t < far)
            atomicAdd(control.unresolved, 1u);
        vec3 light = work.light_color;
        if ((control.light_kind & POSITIONAL) != 0u) {
            vec3 apart_from_light = work.light_vector - hit.position;
            light /= max(dot(apart_from_light, apart_from_light), 1e-12);
        }
        visible = visible < 4e-3 ? 0.0 : visible;
        visible = visible * visible * (3.0 - 2.0 * visible);
        hits[index].radiance += visible * light * reflected(hit.normal, -direction, way, hit.color,
                                                            hit.roughness, hit.metallic);
    }
}
