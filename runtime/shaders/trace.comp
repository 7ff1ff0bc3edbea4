#version 440
#extension GL_GOOGLE_include_directive : enable
#extension GL_KHR_shader_subgroup_shuffle : enable
#extension GL_KHR_shader_subgroup_arithmetic : enable
#extension GL_KHR_shader_subgroup_ballot : enable
/*
 * trace.comp: primary rays, by sphere tracing, behind beams.
 *
 * A ray advances from a place where the distance was known, `t`, by a gap to the next.  The ball
 * of empty space around `t` and the one around the next place must meet, or something may be in
 * between: then the ray goes back to four fifths of the way to the middle of what they leave open,
 * and so on, until they meet or what is open is no longer than a twentieth of the permitted error.
 * A ray hits where the distance is not above 0, never where it is only small: thin things are as
 * thick as they are, however coarse the steps, and a bound that is far too small shows nothing.  A
 * ray that runs out of steps before it is unresolved: it is counted, and shows the background.  A
 * ray from inside of a solid sees the solid's inner wall.
 *
 * How far a gap is, is the method's affair (TRACE): the distance (plain), 1.2 times as much
 * (relaxed), or up to where the balls just meet if the distance goes on as it did (automatic), and
 * where a surface is expected within the permitted error, beyond it: a surface that has been
 * crossed is found by the chord, one that is approached by ever shorter steps.
 *
 * Planes that are components of their own need no march: with FLATS a ray knows where it meets the
 * first, and marches the rest up to there.
 *
 * What the rays of a tile share is marched once before, by the beam through the middle of the
 * tile: a ray through empty space less the tile's width.  Tiles of 32x32 pixels are followed by
 * tiles of 8x8; they count from the corner of the picture, whatever the crop and the band, so that
 * equal pixels come out of all of them.  Tiles of 8x8 whose beam goes through the scene unhindered
 * need no rays: the others are listed, and followed by tiles of 4x4, the quarters of these.
 */
#ifndef TRACE // which variant: the renderer says so; this one suits every device
#define TRACE 3u
#define REFILL 0
#endif
#include "scene.glsl"
#include "frame.glsl"

const uint PLAIN = 1u, RELAXED = 2u, AUTOMATIC = 3u; // TRACE: as KrsTrace
const uint MOST_BEAM_STEPS = 256u; // the rest is left to the rays

// What may be left open between two balls: of the permitted error, and of a pixel at most.  Twigs
// of a tenth of a pixel lose less than 1 % by it (tests/oracle/coverage.c).
const float OPEN = 0.05;
const float MOST_OPEN = 0.0125;
// Relaxation: how far beyond the distance; how fast the mean slope is learned.
const float RELAXATION = 1.2;
const float LEARNING = 0.3;
// Automatic: how far beyond the surface that is expected; a chord that ends inside at a distance
// below such a part of the one where it began is believed.
const float BEYOND = 1.05;
const float SHALLOW = 0.25;
// Balls that are tried (PROBE): how large the next may be, of what is expected.
const uint  BINARY = 1u;
const float CAUTION = 0.9;
// Solids that touch are one: from inside they count as grown by what rounding may leave open at
// the seam between two.
const float SEAM = 4.0; // roundings
// A beam ends where its ball is hardly wider than the tile.
const float WIDER = 1.05;

#ifdef PACKED
const bool SAVES = false; // there is a march of each part
#else
const bool SAVES = true;
#endif
const uint HUNGRY = 2u;

// A ray under way; in the queue two rows of four numbers.
struct March {
    uint  index;     // of its pixel, or its beam: where it ends up in `ends`
    float t;         // nothing is before this place, where it has been,
    float room;      // nor for this long behind it
    float gap;       // from t to the next place to look at
    float slope;     // of the room along the ray, as it was on average
    float side;      // as of a Ray; 0: not known
    uint  steps;
    uint  fate;
};

layout(std430, set = 1, binding = 6) buffer Queue { uvec4 queue[]; };

March march;
bool  exists;                  // the item is in the band
uint  slot;                    // of the item, from the first of the group on
vec3  origin, direction;
float end;
float flat_ahead;              // with FLATS: where a ray meets a plane; INFINITE: nowhere
float pixel_base, pixel_slope; // a pixel is as wide as base + slope t
vec2  width;                   // so is the beam; 0 for a ray, or less: solids count as grown
float shrinking;               // of the room, since the beam gets wider: 1 / (1 + slope)
bool  walls;                   // all solids end at `end`
float rounding;                // of coordinates at t = 0
float open_share;              // of a pixel, may be left open
uvec2 first_8, count_8, first_32, count_32; // the tiles of beams
uint  most_steps;              // of a ray of this lane
uint  finds;                   // beams of this lane that find something: a bit each, by slot

// What the items of a tile have in common: 64 rays or four beams of 4x4 pixels, by quarters; the
// other beams have one to themselves.
struct Slot {
    uvec2 tile;   // its column and row in the picture, of tiles of 8x8 or of 32x32 pixels
    vec4  starts; // nothing is before: the beam that it is in has ended here; of rays, by quarters
};

uint  first_slot; // of the group
uvec2 item_tile;  // of the item that is about to begin: its slot's,
float item_start; // and where it starts
#if REFILL
uvec2 kept_tiles;               // of two slots a lane, which is as many as a group has
vec4  kept_starts, more_starts; // of the one, and of the other
#endif

// Items go through slots one after the other, and through the quarters of each.
uint slot_of(uint number)
{
    return number >> (control.phase == TRACE_RAYS ? 6u : control.phase == TRACE_BEAMS_4 ? 2u : 0u);
}

uint quarter_of(uint number)
{
    return control.phase == TRACE_RAYS      ? number >> 4u & 3u
           : control.phase == TRACE_BEAMS_4 ? number & 3u
                                            : 0u;
}

// The tile of a beam, counted in the band.
uvec2 cell_of_beam(uint number)
{
    return find_cell(number, control.across) +
           uvec2(control.window & 0xffffu, control.window >> 16u);
}

// Where in `ends` the beam of a tile is, by its place in the band.
uint end_of_8(uvec2 cell) { return work.extent.x * work.extent.y + cell.y * count_8.x + cell.x; }

uint end_of_32(uvec2 cell)
{
    return end_of_8(uvec2(0u, count_8.y)) + cell.y * count_32.x + cell.x;
}

uint end_of_4(uvec2 cell, uint quarter)
{
    return end_of_32(uvec2(0u, count_32.y)) + 4u * (cell.y * count_8.x + cell.x) + quarter;
}

float load_start(uint end) { return uintBitsToFloat(ends[end].x); }

// Rays and beams of 4x4 pixels are those of all tiles of the band, or of those that are listed.
// Rays start where the beam of 4x4 pixels has ended, if there is one, that one where its beam of
// 8x8 has, and that one where its beam of 32x32 has.
Slot load_slot(uint number)
{
    bool  is_ray = control.phase == TRACE_RAYS, large = control.phase == TRACE_BEAMS_32;
    bool  small = control.phase == TRACE_BEAMS_4;
    bool  exists = control.source != ITEMS_QUEUED && number <= slot_of(control.items - 1u);
    if (exists && (is_ray || small) && control.listed != 0u)
        number = tiles[number];
    uvec2 cell = is_ray || small ? find_cell(number, count_8.x) : cell_of_beam(number);
    uvec2 tile = cell + (large ? first_32 : first_8);
    vec4  starts = vec4(0.0);
    if (exists && !large && control.follow != 0u) {
        bool quarters = is_ray && control.follow == 2u;
        uint end = quarters ? end_of_4(cell, 0u)
                 : is_ray || small ? end_of_8(cell) : end_of_32(tile / 4u - first_32);
        starts = vec4(load_start(end));
        if (quarters)
            starts.yzw = vec3(load_start(end + 1u), load_start(end + 2u), load_start(end + 3u));
    }
    return Slot(tile, starts);
}

void begin_group(uint first)
{
    most_steps = finds = 0u;
    open_share = min(OPEN * frame.error, MOST_OPEN);
    find_tiles(8u, first_8, count_8);
    find_tiles(32u, first_32, count_32);
    first_slot = slot_of(first);
#if REFILL
    Slot a = load_slot(first_slot + gl_LocalInvocationIndex);
    Slot b = load_slot(first_slot + gl_LocalInvocationIndex + uint(REFILL));
    kept_tiles = uvec2(a.tile.x | a.tile.y << 16u, b.tile.x | b.tile.y << 16u);
    kept_starts = a.starts;
    more_starts = b.starts;
#endif
}

void look_up_item(uint number)
{
#if REFILL
    uint at = slot_of(number) - first_slot, lane = at % uint(REFILL);
    bool low = at < uint(REFILL);
    uint low_tile = subgroupShuffle(kept_tiles.x, lane);
    uint high_tile = subgroupShuffle(kept_tiles.y, lane);
    uint tile = low ? low_tile : high_tile;
    vec4 low_starts = subgroupShuffle(kept_starts, lane);
    vec4 high_starts = subgroupShuffle(more_starts, lane);
    Slot found = Slot(uvec2(tile & 0xffffu, tile >> 16u), low ? low_starts : high_starts);
#else
    Slot found = load_slot(slot_of(number));
#endif
    uint quarter = control.phase == TRACE_RAYS ? quarter_of(number) : 0u;
    vec2 starts = quarter < 2u ? found.starts.xy : found.starts.zw;
    item_tile = found.tile;
    item_start = (quarter & 1u) == 0u ? starts.x : starts.y;
}

float open_at(float t)
{
    return open_share * (pixel_base + pixel_slope * t) + ROUNDING * (rounding + t);
}

// The ray, or the beam's middle, through a place of the picture.
void aim(vec2 place)
{
    find_ray(place, origin, direction, pixel_base, pixel_slope);
    rounding = largest(origin);
}

// What the beam of a tile of `side` pixels a side must keep clear: a ray of it is at most base +
// slope t from the ray through the middle at the same t.  The difference of two unit vectors
// a/|a| and b/|b| is at most 2 |a - b| / (|a| + |b|).
vec2 find_width(float side)
{
    float half_diagonal = 0.7071068 * side;
    float apart = half_diagonal * frame.pixel_slope;
    float stretch = frame.pixel_slope / max(pixel_slope, 1e-30);
    return vec2(half_diagonal * pixel_base, apart / max(stretch - 0.5 * apart, 0.1));
}

vec2 inside_width() { return -SEAM * ROUNDING * vec2(rounding, 1.0); }

March unpack_march(uvec4 low, uvec4 high)
{
    vec4 rest = uintBitsToFloat(high);
    return March(low.x, uintBitsToFloat(low.z), uintBitsToFloat(low.w), rest.x, rest.y,
                 float(low.y >> 2u & 3u) - 1.0, low.y >> 4u, low.y & 3u);
}

// In the queue.  On a graphics card lanes that go together take their places at once (SUBGROUPS).
uint take_place()
{
#ifdef SUBGROUPS
    uint before = subgroupExclusiveAdd(1u), all = subgroupAdd(1u), first = 0u;
    if (subgroupElect())
        first = atomicAdd(counts.queued, all);
    return subgroupBroadcastFirst(first) + before;
#else
    return atomicAdd(counts.queued, 1u);
#endif
}

void save_item()
{
    uint at = 2u * (control.writing + take_place());
    uint bits = march.fate | uint(march.side + 1.0) << 2u | march.steps << 4u;
    queue[at] = uvec4(march.index, bits, floatBitsToUint(vec2(march.t, march.room)));
    queue[at + 1u] = floatBitsToUint(vec4(march.gap, march.slope, 0.0, 0.0));
}

// The march of a ray or a beam that starts where nothing is before `start`.
void begin_march(uint index, float start, bool is_ray)
{
    march.index = index;
    march.t = start;
    march.room = march.gap = 0.0;
    march.slope = -1.0 / (1.0 - LEARNING); // -1 after the first step
    // No side yet: the first distance tells, unless something empty lies behind the ray.
    march.side = march.t > 0.0 || !is_ray ? 1.0 : 0.0;
    march.steps = 0u;
    march.fate = march.t <= end ? STATE_MARCHING : STATE_MISS;
#ifdef PROBE
    // Beams end where there is no room for a tile.
    march.gap = start > 0.0 ? 3.0 * (pixel_base + pixel_slope * start)
                            : 0.05 * (end - start);
    march.gap = max(march.gap, ROUNDING * (rounding + start));
#endif
}

#ifdef PACKED
#include "packed.glsl"
#endif

void begin_item(uint number, bool saved)
{
    bool  is_ray = control.phase == TRACE_RAYS, large = control.phase == TRACE_BEAMS_32;
    bool  small = control.phase == TRACE_BEAMS_4;
    uint  quarter = quarter_of(number);
    uvec2 half_tile = uvec2(quarter & 1u, quarter >> 1u);
    uvec2 pixel = 8u * item_tile + 4u * half_tile + uvec2(number & 3u, number >> 2u & 3u);
    uvec2 local = pixel - work.corner;
    uint  index = local.y * work.extent.x + local.x;
    slot = slot_of(number) - first_slot;
    exists = !is_ray || local.x < work.extent.x && local.y < work.extent.y;
    if (saved) {
        uint at = 2u * (control.reading + number);
        march = unpack_march(queue[at], queue[at + 1u]);
        pixel = work.corner + find_cell(march.index, work.extent.x);
        exists = true;
    }

    float side = large ? 32.0 : small ? 4.0 : 8.0;
    uvec2 tile = small ? 2u * item_tile + half_tile : item_tile;
    vec2  middle = side * (vec2(tile) + 0.5);
    aim(is_ray ? vec2(pixel) + work.offset : middle);
    width = is_ray ? vec2(0.0) : find_width(side);
    shrinking = 1.0 / (1.0 + width.y);
    if (saved && march.side < 0.0)
        width = inside_width();
    vec2 range = is_ray ? clip_ray(origin, direction, frame.farthest) : vec2(0.0, frame.farthest);
    end = range.y;
    walls = is_ray && end < frame.farthest;
#ifdef GROUP
    uint at_pixel = saved ? march.index : index;
    if (exists && is_ray) {
        Ray known = find_end(at_pixel);
        end = known.fate == STATE_HIT || known.lost ? min(end, known.t) : end;
    }
#endif
#ifdef FLATS
    flat_ahead = is_ray ? krs_ahead(origin, direction) : INFINITE;
    flat_ahead = flat_ahead > frame.farthest ? INFINITE : max(flat_ahead, 0.0);
    end = min(end, flat_ahead);
#endif
    if (saved)
        return;

    uvec2 cell = item_tile - (large ? first_32 : first_8);
    uint  beam = large ? end_of_32(cell) : small ? end_of_4(cell, quarter) : end_of_8(cell);
    begin_march(is_ray ? index : beam, max(range.x, item_start), is_ray);
#ifdef PACKED
    begin_parts(is_ray);
#endif
}

bool item_wants_more()
{
    uint most = control.phase == TRACE_RAYS ? frame.most_steps : MOST_BEAM_STEPS;
    return exists && (march.fate == STATE_MARCHING || march.fate == STATE_REFINING) &&
           march.steps < most;
}

#ifdef ALONG
// Where the ray has been before, and some roundings farther: what was just before a surface without
// thickness there must not be behind it here.
float look_back()
{
    float some = 2.0 * ROUNDING * (rounding + march.t + march.gap);
    return march.gap > 0.0 ? march.gap + some : 0.0;
}
#endif

// What is far for its size need not be looked at, where a branch saves work.
float item_distance(vec3 place)
{
#ifdef PROBE
    return krs_probe(place, march.gap);
#elif defined(PACKED)
    return krs_distance_of(part, place);
#elif defined(ALONG)
    return krs_along(place, direction, look_back());
#elif defined(EARLY_OUTS) && !defined(GROUP)
    return krs_distance_lod(place, 0.0);
#else
    return krs_distance(place);
#endif
}

// With PROBE the middle of a ball.
vec3 item_place() { return origin + (march.t + march.gap) * direction; }

// The surface is crossed between t, where there is room, and t + gap, where there is none: where on
// the chord.  It cannot be crossed within the room; where steps are exact, that says more.
float find_crossing(float room)
{
    float along = march.room > room ? min(march.room / (march.room - room), 2.0) : 0.0;
    return max(march.gap * along, march.room);
}

// How far to go from a place with so much room, given the slope up to there and the mean: the balls
// should still meet, or the surface be crossed with no more in doubt than is permitted.
float find_gap(float room, float last_slope, float slope, float permitted, float open)
{
    if (TRACE == RELAXED)
        return RELAXATION * room + open;
    if (TRACE == AUTOMATIC) {
        bool  crosses = BEYOND * room <= -last_slope * (room + permitted);
        float factor = crosses ? BEYOND / -last_slope : 2.0 / (1.0 - min(slope, 0.98));
        return max(room, factor * room) + open;
    }
    return room + open;
}

#ifdef PROBE
// The ball that was tried, of radius gap, touches t, and its middle is behind it by as much; it is
// empty if it could be more than 1 times as large.  A ray hits where one is not that is no longer
// than what may stay open.
void take_distance(float larger)
{
    float radius = march.gap, empty = float(larger > 1.0);
    float at = march.t + radius;
    float room = radius * larger; // at the middle, about
    march.side = 1.0;
    march.steps++;
    float least = 0.5 * open_at(at);
    if (empty == 0.0 && radius <= 1.01 * least) {
        march.t = at;
        march.fate = STATE_HIT;
        return;
    }
    if (PROBE == BINARY) {
        march.gap = radius * (empty > 0.0 ? 2.0 : 0.5);
    } else {
        // The room at the middle of the next ball, room + slope * way, is to be its radius, or a
        // little more.
        float slope = march.room > 0.0 ? (room - march.room) / (at - march.slope) : -1.0;
        slope = clamp(slope, -1.0, 0.9);
        float beyond = slope * (empty > 0.0 ? radius : -radius);
        march.gap = CAUTION * (room + beyond) / (1.0 - CAUTION * slope);
        march.gap = empty > 0.0 ? clamp(march.gap, 0.1 * radius, 8.0 * radius)
                                : clamp(march.gap, 0.1 * radius, 0.7 * radius);
        march.room = room;
        march.slope = at;
    }
    march.gap = max(march.gap, least);
    march.t += 2.0 * empty * radius;
    march.fate = march.t > end ? STATE_MISS : STATE_MARCHING;
}
#else
void take_distance(float distance)
{
    bool  is_ray = control.phase == TRACE_RAYS, closing = march.fate == STATE_REFINING;
    float at = march.t + march.gap, pixel = pixel_base + pixel_slope * at;
    if (march.side == 0.0) {
        march.side = distance < 0.0 ? -1.0 : 1.0;
        width = distance < 0.0 ? inside_width() : width;
    }
    float taken = width.x + width.y * at;
    float room = (march.side * distance - taken) * shrinking;
    float rounded = ROUNDING * (rounding + at), open = open_share * pixel + rounded;
    float least = is_ray ? 0.0 : max(rounded, (WIDER - 1.0) * taken);
    float doubtful = march.gap - march.room; // as long as may hide something
    float permitted = is_ray ? frame.error * pixel : 0.0;
    march.steps++;
    bool met = room <= least && (doubtful <= permitted + open || !is_ray) || closing;
    bool passed = !met && room > least && doubtful <= room + 1.01 * open;
    bool accurate = doubtful <= 2.0 * open || closing || !is_ray ||
                    TRACE == AUTOMATIC && -room <= SHALLOW * march.room;
    float crossing = find_crossing(room);
    float last_slope = march.gap > 0.0 ? (room - march.room) / march.gap : 0.0;
    float slope = (1.0 - LEARNING) * march.slope + LEARNING * last_slope;

    float back = max(0.4 * (march.gap + march.room - max(room, 0.0)), march.room + open);
    float step = met && accurate ? is_ray ? crossing : march.room : 0.0;
    march.t = passed ? at : march.t + step;
    march.gap = passed ? find_gap(room, last_slope, slope, permitted, open) : met ? crossing : back;
    march.room = passed ? room : march.room;
    march.slope = passed ? slope : -1.0;
    march.fate = met                           ? (accurate ? STATE_HIT : STATE_REFINING)
                 : passed && at + room > end ? STATE_MISS
                                             : STATE_MARCHING;
#ifdef PACKED
    turn_to_next_part();
#endif
}
#endif

// Of a ray that has run out of steps nothing is known beyond where it is; a beam ends anywhere,
// since everything before is empty.
void end_item()
{
    bool is_ray = control.phase == TRACE_RAYS;
    bool lost = is_ray && (march.fate == STATE_MARCHING || march.fate == STATE_REFINING);
    uint group = 0u;
    march.fate = lost ? STATE_MISS : march.fate;
    // From inside of a solid nothing leaves the box around all of them.
    if (is_ray && !lost && march.fate == STATE_MISS && march.side < 0.0 && walls) {
        march.fate = STATE_HIT;
        march.t = end;
    }
#ifdef FLATS
    // Planes are met where nothing else was; a beam whose rays may meet one is not done with.
    if (!lost && march.fate == STATE_MISS && flat_ahead < INFINITE) {
        march.fate = STATE_HIT;
        march.t = flat_ahead;
        march.side = 1.0;
    }
    if (!is_ray && march.fate == STATE_MISS && krs_rise(direction) < 1.01 * width.y + 1e-6) {
        march.fate = STATE_HIT;
        march.t = end;
    }
#endif
#ifdef GROUP
    // What other groups have found stays, unless this is nearer; so does where they gave up.
    if (exists && is_ray) {
        Ray known = find_end(march.index);
        bool ends = march.fate == STATE_HIT || lost, ended = known.fate == STATE_HIT || known.lost;
        bool farther = !ends || ended && known.t < march.t;
        march.t = farther ? known.t : march.t;
        march.fate = farther ? known.fate : march.fate;
        march.steps += known.steps;
        group = uint(GROUP);
#ifdef FLATS
        group = march.t < flat_ahead ? group : 0u;
#endif
        group = farther ? known.group : group;
        lost = farther ? known.lost : lost;
    }
#endif
    if (!is_ray && march.fate == STATE_MISS)
        march.t = INFINITE;
    finds |= march.fate != STATE_MISS ? 1u << (slot & 15u) : 0u;
    uint bits = pack_ray(Ray(march.t, march.side, march.steps, march.fate, lost, group));
    if (exists) {
        ends[march.index] = uvec2(floatBitsToUint(march.t), bits);
        most_steps = max(most_steps, is_ray ? march.steps : 0u);
    }
}

void end_group(uint steps)
{
    if (control.phase == TRACE_BEAMS_8)
        for (; finds != 0u; finds &= finds - 1u) {
            uvec2 cell = cell_of_beam(first_slot + (slot & ~15u) + uint(findLSB(finds)));
            tiles[atomicAdd(counts.tiles, 1u)] = cell.y * count_8.x + cell.x;
        }
    uint sum = steps, most = most_steps;
#ifdef SUBGROUPS
    sum = subgroupAdd(sum);
    most = subgroupMax(most);
    if (!subgroupElect())
        return;
#endif
    if (sum > 0u)
        atomicAdd(counts.evaluations, sum);
    if (most > 0u)
        atomicMax(counts.most_evaluations, most);
}

#include "schedule.glsl"
