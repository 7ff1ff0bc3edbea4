/*
 * volumes.glsl: light on its way through media that scatter it.
 *
 * A medium has a box of cells, with bounds of its density in each that are proven (state_volumes.c).  Where
 * something may be scattered is chosen by the most that the density can be; then the density decides
 * whether it is (Woodcock et al. 1965).  How much light is left on a way is known up to the least
 * density, and found by such points for the rest (Novak et al. 2014).  Both are right on average, whatever the bounds are.
 *
 * Media that overlap add up.  In glass that is shown later there is none of them.
 *
 * VOLUMES: how many there are.
 */
// The most walls of cells on a way, and points where something may be scattered.
const uint MAX_WALLS = 256u, MAX_POINTS = 1024u;

// Returns where a ray ends, of which media may scatter light before.
float end_of_way(RayEnd ray)
{
    return ray.state == STATE_HIT || ray.unresolved ? ray.t : frame.farthest;
}

struct Volume {
    vec3  low, high, cell;
    uvec3 cells;
    uint  first;
    bool  exists; // for the ray
};

Volume find_volume(uint number)
{
    uint   row = frame.volumes_at + VOLUME_ROWS * number;
    uvec4  first = load_input(row), second = load_input(row + 1u);
    Volume volume;
    volume.low = uintBitsToFloat(first.xyz);
    volume.cell = uintBitsToFloat(second.xyz);
    volume.cells = load_input(row + 2u).xyz;
    volume.high = volume.low + vec3(volume.cells) * volume.cell;
    volume.first = frame.volumes_at + second.w;
#ifdef MEDIA
    volume.exists = krs_medium <= first.w;
#else
    volume.exists = true;
#endif
    return volume;
}

// A ray on its way through the cells of a medium.
struct Crossing {
    float t, end;
    float least, most; // of the density in the cell at t
    float wall;        // where the ray leaves that cell
};

// Finds the cell of a crossing.
void find_cell(Volume volume, vec3 origin, vec3 direction, inout Crossing crossing)
{
    vec3  place = (origin + crossing.t * direction - volume.low) / volume.cell;
    uvec3 at = uvec3(clamp(floor(place), vec3(0.0), vec3(volume.cells - 1u)));
    uint  index = at.x + volume.cells.x * (at.y + volume.cells.y * at.z);
    uvec4 pair = load_input(volume.first + index / 2u);
    vec2  bounds = uintBitsToFloat((index & 1u) == 0u ? pair.xy : pair.zw);
    vec3  low = volume.low + vec3(at) * volume.cell;
    float wall = clip_to(low, low + volume.cell, origin, direction, crossing.end).y;
    // Rounding must not keep the ray at a wall; cells reach beyond their walls for as much.
    float some = 1e-4 * min(volume.cell.x, min(volume.cell.y, volume.cell.z));
    crossing.wall = min(max(wall, crossing.t) + some, crossing.end);
    crossing.least = bounds.x;
    crossing.most = bounds.y;
}

Crossing begin_crossing(Volume volume, vec3 origin, vec3 direction, float end)
{
    vec2 range = clip_to(volume.low, volume.high, origin, direction, end);
    return Crossing(range.x, volume.exists ? range.y : -1.0, 0.0, 0.0, 0.0);
}

// Goes on to the next point that is chosen at random, or to the end; returns whether there is such a point before it.
// Points are as dense as the medium at its densest in each cell; with `rest` as that less the least density there, of which
// the caller takes account by `depth`.
bool find_point(Volume volume, vec3 origin, vec3 direction, bool rest, inout Crossing crossing,
                inout float depth)
{
    float left = -log(find_chance());
    bool  found = false;
    for (uint i = 0u; i < MAX_WALLS && !found && crossing.t < crossing.end; i++) {
        find_cell(volume, origin, direction, crossing);
        float density = crossing.most - (rest ? crossing.least : 0.0);
        float to_wall = crossing.wall - crossing.t, ahead = left / max(density, 1e-30);
        found = ahead < to_wall;
        float gone = found ? ahead : to_wall;
        crossing.t = found ? crossing.t + ahead : crossing.wall;
        left -= density * gone;
        depth += crossing.least * gone;
    }
    return found;
}

// Returns where a medium scatters or swallows light first; `end`: nowhere before.
float find_scattering(uint number, vec3 origin, vec3 direction, float end)
{
    Volume   volume = find_volume(number);
    Crossing crossing = begin_crossing(volume, origin, direction, end);
    float    depth = 0.0, found = end;
    for (uint i = 0u; i < MAX_POINTS && crossing.t < crossing.end; i++) {
        if (!find_point(volume, origin, direction, false, crossing, depth))
            continue;
        vec3  place = origin + crossing.t * direction;
        float part = krs_volume_density(number, place) / crossing.most;
        if (find_chance() < part) {
            found = crossing.t;
            crossing.end = crossing.t;
        }
    }
    return found;
}

// Returns the part of light that a medium leaves on a way.
float find_left_by_volume(uint number, vec3 origin, vec3 direction, float end)
{
    Volume   volume = find_volume(number);
    Crossing crossing = begin_crossing(volume, origin, direction, end);
    float    depth = 0.0, left = 1.0;
    for (uint i = 0u; i < MAX_POINTS && left > 0.0 && crossing.t < crossing.end; i++) {
        if (!find_point(volume, origin, direction, true, crossing, depth))
            continue;
        float density = krs_volume_density(number, origin + crossing.t * direction);
        left *= 1.0 - (density - crossing.least) / (crossing.most - crossing.least);
        if (left * exp(-depth) < 0.05) { // half of what is that weak ends, and the other counts twice
            left = find_chance() < 0.5 ? 0.0 : 2.0 * left;
        }
    }
    return left * exp(-depth);
}

float find_left_by_volumes(vec3 origin, vec3 direction, float end)
{
    float left = 1.0;
    for (uint i = 0u; i < VOLUMES; i++)
        left *= find_left_by_volume(i, origin, direction, end);
    return left;
}
