/*
 * light_types.glsl: what the shapes of lights are, seen from a place: five functions of each row of
 * light_types.def, and of discs.
 *
 * share_of_NAME: the part of its light that it sends into a direction; `cosine` is that between the
 *     direction and where it shines.
 * weight_of_NAME: how often a path chooses it that is `way` from it, relative to others.
 * place_on_NAME: in previews, a random point of it: point.x * right + point.y * up from its middle.
 * sample_NAME: a point of it.  `chance` is that of having chosen this light.
 * radiance_of_NAME: that which a ray meets before `end`, and the density of choosing it; 0 where it passes.
 *
 * LIGHT_SAMPLES: the shader chooses points of lights, and has sines for it; else it has only what previews
 * need.
 */
#ifndef KRS_LIGHT_TYPES
#define KRS_LIGHT_TYPES

#include "optics.glsl"
#ifdef LIGHT_SAMPLES
#include "sines.glsl"

// A point of a light, seen from a place.
struct LightPoint {
    vec3  toward;   // unit
    float end;      // its distance; 0: nothing casts a shadow
    vec3  light;    // over the probability density of the point
    float density;  // in solid angle; 0: rays cannot find the light
};
#endif

// Returns the part of its light that a light sends into a direction: 1, unless it shines to one
// side.
float find_share(Light light, vec3 direction);

bool casts_shadows(Light light) { return (light.kind & LIGHT_CASTS_SHADOWS) != 0u; }

bool is_positional(Light light) { return (light.kind & LIGHT_POSITIONAL) != 0u; }

bool has_size(Light light) { return light.softness > 0.0 && casts_shadows(light); }

// Returns the irradiance from a light at a place that faces it.
vec3 find_irradiance(Light light, vec3 place)
{
    vec3 toward = light.vector - place;
    return light.color / (is_positional(light) ? max(dot(toward, toward), 1e-12) : 1.0);
}

// ---- rectangles: half the width is to the right, half the height upwards ----

float share_of_rectangle(Light light, vec3 direction, float cosine) { return max(cosine, 0.0); }

void place_on_rectangle(Light light, vec2 square, inout vec2 point, inout vec3 right, inout vec3 up)
{
    point = 2.0 * square - 1.0;
    right = light.right;
    up = light.up;
}

#ifdef LIGHT_SAMPLES
// The light sends nothing behind it.
float weight_of_rectangle(Light light, vec3 way)
{
    return dot(cross(light.right, light.up), way) <= 0.0 ? 0.0 : 1.0;
}

float area_of_rectangle(Light light) { return 4.0 * length(cross(light.right, light.up)); }

// Samples a rectangle evenly over its area.
LightPoint sample_rectangle(Light light, vec3 place, float chance, vec2 square_point)
{
    LightPoint point;
    vec2  at = 2.0 * square_point - 1.0;
    vec3  way = light.vector + at.x * light.right + at.y * light.up - place;
    float far_squared = max(dot(way, way), 1e-12);
    point.end = sqrt(far_squared);
    point.toward = way / point.end;
    // Its light has the cosine of its own side; in solid angle the area has it, too.
    float cosine = dot(normalize(cross(light.right, light.up)), -point.toward);
    point.density = cosine > 0.0 && has_size(light)
                        ? chance * far_squared / (cosine * area_of_rectangle(light)) : 0.0;
    point.light = light.color * find_share(light, -point.toward) / (far_squared * chance);
    return point;
}

vec3 radiance_of_rectangle(Light light, vec3 origin, vec3 direction, float end, out float density)
{
    vec3  normal = cross(light.right, light.up), center = light.vector - origin;
    float cosine = -dot(normalize(normal), direction);
    float reach = dot(normal, center) / min(dot(normal, direction), -1e-30);
    vec3  beside = reach * direction - center;
    vec2  at = vec2(dot(beside, light.right) / dot(light.right, light.right),
                    dot(beside, light.up) / dot(light.up, light.up));
    bool  meets = cosine > 0.0 && reach > 0.0 && reach < end && max(abs(at.x), abs(at.y)) < 1.0 &&
                 has_size(light);
    float area = area_of_rectangle(light);
    density = meets ? reach * reach / (cosine * area) : 0.0;
    return meets ? light.color * find_share(light, -direction) / (cosine * area) : vec3(0.0);
}
#endif

// ---- discs in the sky, and balls, which are discs from everywhere ----

#ifdef LIGHT_SAMPLES
// Returns 1 - cos, which is not found by a difference where it is small.
float gap_of_sine(float sine_squared)
{
    return sine_squared / (1.0 + sqrt(max(1.0 - sine_squared, 0.0)));
}

// Finds 1 less the cosine of a light's angular radius, as seen from a place.
float find_gap(Light light, float distance_squared)
{
    if (is_positional(light))
        return gap_of_sine(min(square(light.softness) / distance_squared, 1.0));
    float radius = 0.5 * clamp(light.softness, 0.0, 3.0);
    return gap_of_sine(square(krs_sin(radius)));
}

// Returns the mean radiance of a disc: its irradiance over the solid angle, weighted by the cosine
// from the middle.
vec3 disc_radiance(Light light, vec3 place, float gap)
{
    float sine_squared = gap * (2.0 - gap);
    return find_irradiance(light, place) / (PI * max(sine_squared, 1e-20));
}

// Samples a disc evenly over its solid angle.
LightPoint sample_disc(Light light, vec3 place, float chance, vec2 square_point)
{
    LightPoint point;
    bool  positional = is_positional(light);
    vec3  center = positional ? light.vector - place : light.vector;
    float center_squared = max(dot(center, center), 1e-12), center_distance = sqrt(center_squared);
    vec3  axis = center / center_distance, right, up;
    bool  sized = has_size(light);
    float gap = find_gap(light, center_squared) * (sized ? square_point.y : 0.0);
    float ring = sqrt(gap * (2.0 - gap)), angle = 2.0 * PI * square_point.x;
    find_frame(axis, right, up);
    point.toward = normalize(ring * (krs_cos(angle) * right + krs_sin(angle) * up) +
                             (1.0 - gap) * axis);
    float whole = find_gap(light, center_squared);
    // A place inside of a lamp sees it by chosen points alone, as no ray meets it from there.
    bool  inside = positional && center_squared <= square(light.softness);
    point.density = sized && !inside ? chance / (2.0 * PI * whole) : 0.0;
    float share = find_share(light, -axis) / chance;
    point.light = sized ? disc_radiance(light, place, whole) * (2.0 * PI * whole * share)
                        : find_irradiance(light, place) * share;
    float reach = center_distance * (1.0 - gap);
    float before = sqrt(max(square(light.softness) - center_squared * gap * (2.0 - gap), 0.0));
    float end = sized ? max(reach - before, 0.0) : center_distance;
    point.end = !positional ? INFINITE : end;
    return point;
}

vec3 radiance_of_disc(Light light, vec3 origin, vec3 direction, float end, out float density)
{
    bool  positional = is_positional(light);
    vec3  center = positional ? light.vector - origin : light.vector;
    float along = dot(center, direction), center_squared = max(dot(center, center), 1e-12);
    vec3  across = center - along * direction;
    float radius_squared = square(light.softness), reach = along;
    bool  meets;
    float gap = find_gap(light, center_squared);
    if (positional) {
        reach = along - sqrt(max(radius_squared - dot(across, across), 0.0));
        meets = dot(across, across) < radius_squared && along > 0.0 &&
                center_squared > radius_squared && reach < end;
    } else {
        vec3 apart = direction - light.vector; // |apart|^2 = 2 (1 - cosine)
        meets = 0.5 * dot(apart, apart) < gap && end >= frame.farthest;
    }
    meets = meets && has_size(light);
    density = meets ? 1.0 / (2.0 * PI * gap) : 0.0;
    vec3 axis = center * inversesqrt(center_squared);
    return meets ? disc_radiance(light, origin, gap) * find_share(light, -axis) : vec3(0.0);
}
#endif

// ---- all of them ----

float find_share(Light light, vec3 direction)
{
    uint  type = light.kind / LIGHT_FIRST_TYPE;
    vec3  axis = cross(light.right, light.up);
    float cosine = dot(axis, direction) * inversesqrt(max(dot(axis, axis), 1e-30)), share = 1.0;
#define KRS_LIGHT_TYPE(number, id, name, given, across, along, disc)                                   \
    share = type == uint(number) ? share_of_##name(light, direction, cosine) : share;
#include "krs/light_types.def"
    return (light.kind & LIGHT_SPOT) != 0u
               ? share * smoothstep(light.outer, light.inner + 1e-6, cosine) : share;
}

// Places a point as place_on_NAME does; a disc is as it is given.
void place_on_light(Light light, vec2 square, inout vec2 point, inout vec3 right, inout vec3 up)
{
    uint type = light.kind / LIGHT_FIRST_TYPE;
#define KRS_LIGHT_TYPE(number, id, name, given, across, along, disc)                                   \
    if (type == uint(number))                                                                      \
        place_on_##name(light, square, point, right, up);
#include "krs/light_types.def"
}

#ifdef LIGHT_SAMPLES
float find_weight(Light light, vec3 way)
{
    uint type = light.kind / LIGHT_FIRST_TYPE;
#define KRS_LIGHT_TYPE(number, id, name, given, across, along, disc)                                   \
    if (type == uint(number))                                                                      \
        return weight_of_##name(light, way);
#include "krs/light_types.def"
    return find_share(light, normalize(way));
}

LightPoint sample_shape(Light light, vec3 place, float chance, vec2 square_point)
{
    uint type = light.kind / LIGHT_FIRST_TYPE;
#define KRS_LIGHT_TYPE(number, id, name, given, across, along, disc)                                   \
    if (type == uint(number))                                                                      \
        return sample_##name(light, place, chance, square_point);
#include "krs/light_types.def"
    return sample_disc(light, place, chance, square_point);
}

LightPoint sample_light(Light light, vec3 place, float chance, vec2 square_point)
{
    LightPoint point = sample_shape(light, place, chance, square_point);
    point.end = casts_shadows(light) ? point.end : 0.0;
    return point;
}

vec3 find_radiance_of(Light light, vec3 origin, vec3 direction, float end, out float density)
{
    uint type = light.kind / LIGHT_FIRST_TYPE;
#define KRS_LIGHT_TYPE(number, id, name, given, across, along, disc)                                   \
    if (type == uint(number))                                                                      \
        return radiance_of_##name(light, origin, direction, end, density);
#include "krs/light_types.def"
    return radiance_of_disc(light, origin, direction, end, density);
}
#endif
#endif
