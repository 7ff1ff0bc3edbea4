/*
 * lights.glsl: lights as sources of a size: paths choose a point on one, and rays may find one.
 *
 * A path chooses one of all lights, by the light that each would send if it were visible.
 */

// A point of a light, seen from a place.
struct LightPoint {
    vec3  toward;   // unit
    float end;      // its distance; 0: nothing casts a shadow
    vec3  light;    // over the probability density of the point
    float density;  // in solid angle; 0: rays cannot find the light
};

// Where 1 - cos is small it is not found by a difference.
float gap_of_sine(float sine_squared)
{
    return sine_squared / (1.0 + sqrt(max(1.0 - sine_squared, 0.0)));
}

// The disc, or sphere, of a light as seen from a place: 1 less the cosine of its radius.
float find_gap(Light light, float distance_squared)
{
    if ((light.kind & LIGHT_POSITIONAL) != 0u)
        return gap_of_sine(min(square(light.softness) / distance_squared, 1.0));
    float radius = 0.5 * clamp(light.softness, 0.0, 3.0);
    return gap_of_sine(square(krs_sin(radius)));
}

bool has_size(Light light)
{
    return light.softness > 0.0 && (light.kind & LIGHT_CASTS_SHADOWS) != 0u;
}

// Irradiance from a light at a place that faces it.
vec3 find_irradiance(Light light, vec3 place)
{
    vec3 toward = light.vector - place;
    bool positional = (light.kind & LIGHT_POSITIONAL) != 0u;
    return light.color / (positional ? max(dot(toward, toward), 1e-12) : 1.0);
}

bool is_rectangle(Light light) { return (light.kind & LIGHT_RECTANGLE) != 0u; }

// How often a path chooses this light, relative to others: never where it sends nothing, which is
// behind a rectangle and outside of the cone of a spot.
float find_importance(Light light, vec3 place)
{
    vec3  way = place - light.vector;
    bool  behind = dot(cross(light.right, light.up), way) <= 0.0;
    float share = is_rectangle(light) ? (behind ? 0.0 : 1.0) : find_share(light, normalize(way));
    return luminance(find_irradiance(light, place)) * share;
}

// That of the sky comes first.
float sum_importance(vec3 place)
{
    float sum = frame.sky_power;
    for (uint i = 0u; i < control.lights; i++)
        sum += find_importance(find_light(i), place);
    return sum;
}

#ifdef SKY_MAP
// A direction of a sky that is a picture, by how bright it is there.  Fog hides it as it hides all of
// the sky.
LightPoint sample_sky(vec3 place, float chance, vec2 square_point)
{
    LightPoint point;
    uvec2 cell = choose_cell(square_point);
    vec2  on_sky = choose_in_cell(cell, square_point);
    vec3  radiance = radiance_on_sky(on_sky);
    point.toward = direction_on_sky(on_sky);
    point.density = chance * sky_map_density(radiance, on_sky);
    float left = let_through(place.y, point.toward.y, FARTHEST);
    point.light = left * radiance / max(point.density, 1e-30);
    point.end = INFINITE;
    return point;
}
#endif

// The mean radiance of a light's disc: its irradiance over the solid angle, weighted by the cosine
// from the middle.
vec3 disc_radiance(Light light, vec3 place, float gap)
{
    float sine_squared = gap * (2.0 - gap);
    return find_irradiance(light, place) / (PI * max(sine_squared, 1e-20));
}

float find_area(Light light) { return 4.0 * length(cross(light.right, light.up)); }

// A point of a rectangle, evenly over its area.
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
                        ? chance * far_squared / (cosine * find_area(light)) : 0.0;
    point.light = light.color * find_share(light, -point.toward) / (far_squared * chance);
    if ((light.kind & LIGHT_CASTS_SHADOWS) == 0u)
        point.end = 0.0;
    return point;
}

// The radiance of a rectangle that a ray meets before `end`.
vec3 find_radiance_of_rectangle(Light light, vec3 origin, vec3 direction, float end,
                                out float density)
{
    vec3  normal = cross(light.right, light.up), center = light.vector - origin;
    float cosine = -dot(normalize(normal), direction);
    float reach = dot(normal, center) / min(dot(normal, direction), -1e-30);
    vec3  beside = reach * direction - center;
    vec2  at = vec2(dot(beside, light.right) / dot(light.right, light.right),
                    dot(beside, light.up) / dot(light.up, light.up));
    bool  meets = cosine > 0.0 && reach > 0.0 && reach < end && max(abs(at.x), abs(at.y)) < 1.0 &&
                 has_size(light);
    float area = find_area(light);
    density = meets ? reach * reach / (cosine * area) : 0.0;
    return meets ? light.color * find_share(light, -direction) / (cosine * area) : vec3(0.0);
}

// A point of a light, evenly over its solid angle.  `chance` is that of having chosen this light.
LightPoint sample_light(Light light, vec3 place, float chance, vec2 square_point)
{
    LightPoint point;
    if (is_rectangle(light))
        return sample_rectangle(light, place, chance, square_point);
    bool  positional = (light.kind & LIGHT_POSITIONAL) != 0u;
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
    if ((light.kind & LIGHT_CASTS_SHADOWS) == 0u)
        point.end = 0.0;
    return point;
}

// The radiance of a light that a ray meets before `end`; 0 where it passes.
vec3 find_radiance_of(Light light, vec3 origin, vec3 direction, float end, out float density)
{
    if (is_rectangle(light))
        return find_radiance_of_rectangle(light, origin, direction, end, density);
    bool  positional = (light.kind & LIGHT_POSITIONAL) != 0u;
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
