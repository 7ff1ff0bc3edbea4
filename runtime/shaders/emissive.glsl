/*
 * emissive.glsl: paths go on towards what emits light.
 *
 * Around what emits light there are balls (compiler/scene/state_emissive.c).  A path that is scattered goes on in
 * a direction of the surface's own choice, or into the cone in which one of these balls is seen.  The
 * probability density is that of both together (Veach 1997, the balance heuristic with one sample).
 * So light is the same whatever is in a ball, also where it is hidden or emits nothing; only noise
 * differs.
 *
 * EMISSIVE: something may emit light.
 */

// The cones of the balls, as seen from a place.
struct Cones {
    vec3  place, facing;
    float part; // of the directions that are chosen by cones
    float all;  // sum of the weights of balls
};

#ifdef EMISSIVE
// The most of the directions that are chosen by cones, at the first surface of a path and at others.
// Light that bounces often is found by other directions, which count more the fewer they are.
const float MAX_AT_FIRST = 0.5, MAX_BY_CONES = 0.3;

// Returns the radiance of what is found in directions that surfaces choose.
float find_around(vec3 facing)
{
#ifdef SKY_MAP
    if (has_sky_map()) // its light is found by choosing
        return 0.0;
#endif
    return luminance(sky_light(facing));
}

// The cone of a ball: its axis, and 1 less the cosine of its half angle.
struct Cone {
    vec3  axis;
    float gap;
    float weight; // about how much light it may send; 0: it is not used
};

// Finds the cone of a ball.  From inside of a ball, or with a ball behind the surface, nothing is
// gained.
Cone find_cone(Cones cones, uint number)
{
    uint  row = ALBEDO_ROWS + EMISSIVE_ROWS * number;
    vec4  ball = uintBitsToFloat(load_input(row));
    float radiance = uintBitsToFloat(load_input(row + 1u).x);
    vec3  way = ball.xyz - cones.place;
    float far_squared = max(dot(way, way), 1e-20);
    float sine_squared = square(ball.w) / far_squared;
    Cone  cone;
    cone.axis = way * inversesqrt(far_squared);
    cone.gap = gap_of_sine(min(sine_squared, 1.0));
    float rise = dot(cone.axis, cones.facing) + sqrt(sine_squared);
    cone.weight = sine_squared < 1.0 ? radiance * cone.gap * clamp(rise, 0.0, 1.0) : 0.0;
    return cone;
}

// Finds the cones; `dull`: how widely the surface scatters light, from 0 to 1.  The more light
// comes from elsewhere, the fewer directions are chosen by cones.
Cones find_cones(vec3 place, vec3 facing, float dull)
{
    Cones cones = Cones(place, facing, 0.0, 0.0);
    for (uint i = 0u; i < frame.emissive_count; i++)
        cones.all += find_cone(cones, i).weight;
    float by_cones = 2.0 * cones.all; // over pi
    float most = control.value == 0u ? MAX_AT_FIRST : MAX_BY_CONES;
    cones.part = by_cones > 1e-20
                     ? most * dull * by_cones / (by_cones + find_around(facing)) : 0.0;
    return cones;
}

// Returns the density with which paths go on in a direction, in solid angle, where the surface
// alone has `density`.
float mixed_density(Cones cones, vec3 direction, float density)
{
    float sum = 0.0;
    for (uint i = 0u; i < frame.emissive_count; i++) {
        Cone cone = find_cone(cones, i);
        vec3 apart = direction - cone.axis; // |apart|^2 = 2 (1 - cosine)
        sum += 0.5 * dot(apart, apart) < cone.gap ? cone.weight / max(2.0 * PI * cone.gap, 1e-30)
                                                  : 0.0;
    }
    return mix(density, sum / max(cones.all, 1e-30), cones.part);
}

// Returns a direction by cones; `choice` is of [0, 1).
vec3 sample_cones(Cones cones, vec2 square_point)
{
    float left = square_point.x * cones.all, part = 0.0;
    Cone  chosen = Cone(cones.facing, 0.0, 0.0);
    for (uint i = 0u; i < frame.emissive_count; i++) {
        Cone cone = find_cone(cones, i);
        if (left >= 0.0 && cone.weight > 0.0) {
            chosen = cone;
            part = left / cone.weight;
        }
        left -= cone.weight;
    }
    float gap = chosen.gap * square_point.y, ring = sqrt(gap * (2.0 - gap));
    float angle = 2.0 * PI * min(part, BELOW_1);
    vec3  right, up;
    find_frame(chosen.axis, right, up);
    return normalize(ring * (krs_cos(angle) * right + krs_sin(angle) * up) +
                     (1.0 - gap) * chosen.axis);
}

// Tells how likely a path goes on.  Its weight is small where it goes towards a bright light, as many do.
// What the surface keeps of light from directions of its own choice tells that it counts.
float find_survival(vec3 weight, float kept) { return max(largest(weight), kept); }
#else
Cones find_cones(vec3 place, vec3 facing, float dull) { return Cones(place, facing, 0.0, 0.0); }

float mixed_density(Cones cones, vec3 direction, float density) { return density; }

float find_survival(vec3 weight, float kept) { return largest(weight); }

vec3 sample_cones(Cones cones, vec2 square_point) { return cones.facing; }
#endif
