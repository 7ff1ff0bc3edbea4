/*
 * tints.glsl: what glass between a surface and a light leaves of the light, in previews and in direct
 * light.
 *
 * The way to the light is straight, as if nothing refracted, and each boundary reflects what it does
 * of light that meets it head on.  Where bodies of glass overlap they count as one.
 */
const uint  MAX_TINT_STEPS = 256u;
// The least step in pixels, by which a boundary is found too late, and how it grows.
const float MIN_STEP = 0.5, GROWTH = 1.03;

struct Glass {
    vec3  color, absorption;
    float kept; // by a boundary
};

Glass find_glass_at(vec3 position, vec3 toward, float width)
{
    krs_medium = 0u;
#ifdef KRS_VIEW
    krs_view = toward;
#endif
    KrsSurface surface = krs_surface(position, -toward, width);
    float ior = clamp(surface.ior, 1.0, 4.0), head_on = (ior - 1.0) / (ior + 1.0);
    return Glass(find_glass(surface) * clamp(surface.color, 0.0, 1.0),
                 max(surface.absorption, 0.0), 1.0 - head_on * head_on);
}

// Finds the way to a light, and where it ends.  The middle of the light stands for all of it.
vec3 find_way_to(Light light, vec3 start, out float end)
{
    bool  positional = (light.kind & LIGHT_POSITIONAL) != 0u;
    vec3  toward = positional ? light.vector - start : light.vector;
    float size = max(length(toward), 1e-12);
    toward /= size;
    end = clip_ray(start, toward, positional ? size : frame.farthest).y;
    return toward;
}

// Finds where such a way starts.
vec3 find_start_of_way(HitPoint hit, vec3 facing)
{
    return hit.position + find_height(hit, 0.0, 0.0) * facing;
}

// Returns the tint of a way that is `end` long, if it casts a shadow; `width`: that of the pixel.
vec3 find_tint_of_way(vec3 start, vec3 toward, float end, float width, bool casts)
{
    float t = 0.0, entered = 0.0, least = MIN_STEP * width;
    vec3  tint = vec3(1.0);
    bool  inside = false;
    Glass glass = Glass(vec3(1.0), vec3(0.0), 1.0);
    for (uint step = 0u; casts && step < MAX_TINT_STEPS && t <= end; step++) {
        vec3  position = start + t * toward;
        float distance = krs_glass(position);
        if (distance < 0.0 && !inside) {
            glass = find_glass_at(position, toward, width);
            entered = t + distance; // it is so deep inside at least
            tint *= glass.color * (step > 0u ? glass.kept : 1.0);
            inside = true;
        } else if (distance >= 0.0 && inside) {
            tint *= glass.kept * exp(-glass.absorption * (t - distance - entered));
            inside = false;
        }
        t += max(abs(distance), least);
        least *= GROWTH;
    }
    // The box around the scene may end the way where the glass does.
    return inside ? tint * glass.kept * exp(-glass.absorption * max(end - entered, 0.0)) : tint;
}

vec3 find_tint(Light light, HitPoint hit, vec3 facing)
{
    float end;
    vec3  start = find_start_of_way(hit, facing), toward = find_way_to(light, start, end);
    return find_tint_of_way(start, toward, end, hit.width,
                            (light.kind & LIGHT_CASTS_SHADOWS) != 0u);
}
