/*
 * subsurface.glsl: paths that go on below a surface, as in wax, marble and skin.
 *
 * Light enters as if dull, is scattered evenly at random places inside, and leaves as if dull where
 * it meets the surface again.  Its mean free path is the radius.  The albedo of a single event is the
 * one with which a half-space has the given colour (van de Hulst 1980, as in OpenPBR).
 *
 * Each colour has a mean free path of its own.  A path takes that of one of them, chosen by how much
 * is left of each, and counts by the mean of all probabilities.
 *
 * Where everything within many mean free paths is inside, light diffuses: it leaves that ball
 * anywhere with the same probability, and what absorption leaves of it is known.  So one
 * distance does for very many events, as a ray takes a long step where nothing is near.
 */

const uint  MAX_DISTANCES = 3000u; // of a walk; then it leaves where it has entered
const float MIN_RADIUS = 1e-3;   // of a colour, relative to the largest
const float MIN_SEEN = 0.02;     // a radius in pixels; light that goes less far stays
const float NEAREST = 0.05;        // the least step, in mean free paths
const float NEAREST_IN_PIXELS = 0.25;
const float DIFFUSES = 6.0, MARGIN = 2.0; // mean free paths: of a ball, and how far it is from walls
const uint  FIRST_DISTANCES = 24u; // before paths of which little is left end

struct Walk {
    vec3 position, normal; // where it leaves
    vec3 weight;
    bool moved; // it leaves elsewhere
};

// Chooses a point on the unit sphere, evenly.
vec3 choose_anywhere()
{
    float z = 2.0 * find_chance() - 1.0, angle = 2.0 * PI * find_chance();
    float ring = sqrt(max(1.0 - z * z, 0.0));
    return vec3(ring * krs_cos(angle), ring * krs_sin(angle), z);
}

// ---- what is inside ----

struct Inside {
    vec3 density; // 1 / the mean free path
    vec3 kept;    // of light at an event
    vec3 decay;   // of light that diffuses, on a unit of length
};

Inside find_inside(vec3 color, vec3 radius)
{
    Inside inside;
    float  most = max(max(radius.x, radius.y), radius.z);
    vec3   root = 4.09712 + 4.20863 * color -
                  sqrt(9.59217 + 41.6808 * color + 17.7126 * color * color);
    vec3   lost = clamp(root * root, 0.0, 1.0);
    inside.density = 1.0 / max(radius, MIN_RADIUS * most);
    inside.kept = 1.0 - lost;
    inside.decay = inside.density * sqrt(3.0 * lost / (1.0 + lost)); // Grosjean 1956
    return inside;
}

// Returns what is left of light that diffuses from the middle of a ball to its wall.
vec3 find_diffused(Inside inside, float radius)
{
    vec3 x = inside.decay * radius;
    vec3 sunk = 2.0 * x * exp(-x) / max(1.0 - exp(-2.0 * x), 1e-12);
    return mix(sunk, vec3(1.0), lessThan(x, vec3(1e-3)));
}

// Finds with what probability each colour is chosen.
vec3 find_shares(vec3 weight) { return weight / max(dot(weight, vec3(1.0)), 1e-30); }

float choose_length(Inside inside, vec3 weight)
{
    vec3  shares = find_shares(weight);
    float choice = find_chance();
    float density = choice < shares.x              ? inside.density.x
                    : choice < shares.x + shares.y ? inside.density.y
                                                   : inside.density.z;
    return -log(find_chance()) / density;
}

// Weighs light after a length at whose end there is an event, or a wall.
vec3 weigh_event(Inside inside, vec3 weight, float length)
{
    vec3 left = inside.density * exp(-inside.density * length);
    return weight * inside.kept * left / max(dot(find_shares(weight), left), 1e-30);
}

vec3 weigh_wall(Inside inside, vec3 weight, float length)
{
    vec3 left = exp(-inside.density * length);
    return weight * left / max(dot(find_shares(weight), left), 1e-30);
}

// ---- the walk ----

// Returns the gradient of the distance, by differences at the corners of a tetrahedron.
vec3 find_gradient_below(vec3 position, float reach)
{
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < 4u; i++) {
        vec3 corner = vec3(i == 0u || i == 3u ? 1.0 : -1.0, i == 1u || i == 3u ? 1.0 : -1.0,
                           i == 2u || i == 3u ? 1.0 : -1.0);
        sum += corner * krs_subsurface(position + reach * corner);
    }
    return sum / (4.0 * reach);
}

// Moves a place near the surface onto it.
void leave(inout Walk walk, HitPoint hit)
{
    float reach = max(0.5 * hit.width, 3e-4 * largest(walk.position) + hit.rounding);
    vec3  gradient = find_gradient_below(walk.position, reach);
    float square = dot(gradient, gradient);
    walk.moved = square > 1e-6 && square < 1e6;
    for (uint i = 0u; i < 2u; i++)
        walk.position -= krs_subsurface(walk.position) * gradient / max(square, 1e-6);
    walk.normal = gradient * inversesqrt(max(square, 1e-12));
}

// Returns a direction into the solid, as of light that enters a dull surface.
vec3 choose_direction_in(vec3 facing)
{
    vec3 right, up;
    vec2 point = disc_of_square(vec2(find_chance(), find_chance()));
    find_frame(facing, right, up);
    return point.x * right + point.y * up - sqrt(max(1.0 - dot(point, point), 0.0)) * facing;
}

// Goes on after an event, or as far as light diffuses.  Returns how far the next event is.
float scatter_inside(Inside inside, float depth, inout Walk walk, inout vec3 direction)
{
    float least = min(min(inside.density.x, inside.density.y), inside.density.z);
    direction = choose_anywhere();
    if (depth * least < DIFFUSES)
        return choose_length(inside, walk.weight);
    float radius = depth - MARGIN / least;
    walk.position += radius * direction;
    walk.weight *= find_diffused(inside, radius);
    return 0.0;
}

// Ends most paths of which little is left.
bool survives(inout vec3 weight)
{
    float chance = min(max(max(weight.x, weight.y), weight.z), 1.0);
    bool  goes_on = find_chance() < chance;
    weight = goes_on ? weight / chance : vec3(0.0);
    return goes_on;
}

Walk walk_below(HitPoint hit, vec3 facing, vec3 color, vec3 radius)
{
    Walk   walk = Walk(hit.position, facing, vec3(1.0), false);
    float  most = max(max(radius.x, radius.y), radius.z);
    Inside inside = find_inside(color, max(radius, 1e-12));
    if (most < MIN_SEEN * hit.width) {
        walk.weight = color;
        return walk;
    }
    float densest = max(max(inside.density.x, inside.density.y), inside.density.z);
    float least = min(NEAREST / densest, NEAREST_IN_PIXELS * hit.width) + 4.0 * hit.rounding;
    vec3  direction = choose_direction_in(facing);
    float left = choose_length(inside, walk.weight), gone = 0.0; // to the next event; since the last
    float step = 0.0, before = 0.0; // the last step, and the depth before it
    for (uint i = 0u; i < MAX_DISTANCES; i++) {
        float depth = -krs_subsurface(walk.position);
        if (depth <= 0.0 && i > 0u) {
            float back = step * -depth / max(before - depth, 1e-30);
            walk.position -= back * direction;
            walk.weight = weigh_wall(inside, walk.weight, gone - back);
            leave(walk, hit);
            return walk;
        }
        if (left <= 0.0 && i > 0u) {
            if (gone > 0.0)
                walk.weight = weigh_event(inside, walk.weight, gone);
            if (i > FIRST_DISTANCES && !survives(walk.weight))
                return walk;
            gone = 0.0;
            left = scatter_inside(inside, depth, walk, direction);
            if (left <= 0.0)
                continue;
        }
        before = max(depth, 0.0);
        step = min(max(depth, least), left);
        walk.position += step * direction;
        gone += step;
        left -= step;
    }
    walk.position = hit.position;
    return walk;
}
