#version 440
#extension GL_GOOGLE_include_directive : enable
#extension GL_KHR_shader_subgroup_shuffle : enable
#extension GL_KHR_shader_subgroup_arithmetic : enable
#extension GL_KHR_shader_subgroup_ballot : enable
/*
 * trace.comp: marches beams, and behind them primary rays, by sphere tracing.
 *
 * A ray advances by a step from `t`, where the distance is known.  The ball of empty space around
 * `t` and the ball around the next position must meet, or something may be in between.  If they do
 * not meet, a shorter step is tried, which ends at four fifths of the distance to the middle of the
 * unverified interval.  This goes on until the balls meet, or until the unverified interval is no
 * longer than the tolerance: a twentieth of the permitted error.
 *
 * A ray hits where the distance is not above 0, never where it is only small.  So thin things keep
 * their thickness, however coarse the steps, and a bound that is far too small shows no false
 * surface.  A ray that runs out of steps before is unresolved: it is counted, and shows the
 * background.  A ray from inside of a solid sees the solid's inner wall.
 *
 * The length of a step depends on the method (TRACE).  It is the distance (plain), or 1.2 times the
 * distance (relaxed).  Or it goes as far as the balls just meet if the distance goes on as it did
 * (automatic).  Where the automatic method expects a surface within the permitted error, it steps
 * behind it.  A surface that has been crossed is found by the chord.  One that is only approached
 * takes ever shorter steps.
 *
 * STEPS: there is krs_steps.  What rays know roots of is free up to the next root.  Balls are of all
 * else, by the automatic method.
 *
 * Planes that are components of their own need no march.  With PLANES a ray knows where it meets
 * the first plane, and marches the other components up to there.
 *
 * The empty space that the rays of a tile share is marched once before, by a beam through the
 * middle of the tile.  A beam is a ray whose clearance is less by the tile's width.  Beams of tiles
 * of 32x32 pixels are followed by those of 8x8.  Tiles are counted from the corner of the picture,
 * whatever the crop and the band, so that these do not change pixels.  Tiles of 8x8 whose beam hits
 * nothing need no rays.  The others are listed, and followed by beams of their quarters, tiles of
 * 4x4.
 */
#ifndef TRACE // chosen by the renderer; these choices suit every device
#define TRACE 3u
#define REFILL 0
#define SAVES 1
#endif
#include "scene.glsl"
#include "frame.glsl"
#if defined(PATH_RAYS) || defined(MIXED_RAYS)
#define FOLLOWS_PATHS
#include "media.glsl"
#if !defined(STEPS) && !defined(ALONG) && !defined(PACKED) && !defined(PROBE)
#define TOUCHES // balls that touch the surface tell the first step (begin_at_surface)
#endif
#endif
#ifndef PATH_RAYS
#include "limits.glsl"
#endif

const uint MAX_BEAM_STEPS = 256u; // the rest is left to the rays

const uint REFILL_THRESHOLD = 2u;

layout(std430, set = 1, binding = QUEUE_BINDING) buffer Queue { uvec4 queue[]; };

#include "tile_starts.glsl"
#include "march.glsl"

bool  exists;                  // the item is in the band
uint  tile_index;              // of the item, counted from the workgroup's first tile
uint  max_steps;              // of a ray of this lane
uint  found_tiles;             // bits of this lane's beams that find something

uint  first_tile; // of the workgroup
uvec2 item_tile;  // of the item that is about to begin
float item_start; // where that item starts
#if REFILL
uvec2 kept_tiles;               // two tiles of each lane are all tiles of the workgroup
vec4  kept_starts, more_starts; // starts of the first tile, and of the second
#endif

void begin_group(uint first)
{
    max_steps = found_tiles = 0u;
    tolerance_in_pixels = min(TOLERANCE * frame.error, MAX_TOLERANCE);
    find_tiles(8u, first_8, count_8);
    find_tiles(32u, first_32, count_32);
    first_tile = tile_of_item(first);
#if REFILL
    TileStart a = load_tile(first_tile + gl_LocalInvocationIndex);
    TileStart b = load_tile(first_tile + gl_LocalInvocationIndex + uint(REFILL));
    kept_tiles = uvec2(a.tile.x | a.tile.y << 16u, b.tile.x | b.tile.y << 16u);
    kept_starts = a.starts;
    more_starts = b.starts;
#endif
}

void exchange_item(uint number)
{
#if defined(PATH_RAYS) // a list has their pixels
    TileStart found = TileStart(uvec2(0u), vec4(0.0));
#elif REFILL
    uint at = tile_of_item(number) - first_tile, lane = at % uint(REFILL);
    bool low = at < uint(REFILL);
    uint low_tile = subgroupShuffle(kept_tiles.x, lane);
    uint high_tile = subgroupShuffle(kept_tiles.y, lane);
    uint tile = low ? low_tile : high_tile;
    vec4 low_starts = subgroupShuffle(kept_starts, lane);
    vec4 high_starts = subgroupShuffle(more_starts, lane);
    TileStart found = TileStart(uvec2(tile & 0xffffu, tile >> 16u), low ? low_starts : high_starts);
#else
    TileStart found = load_tile(tile_of_item(number));
#endif
    uint quarter = control.phase == TRACE_RAYS ? quarter_of(number) : 0u;
    vec2 starts = quarter < 2u ? found.starts.xy : found.starts.zw;
    item_tile = found.tile;
    item_start = (quarter & 1u) == 0u ? starts.x : starts.y;
}

// Returns the width of the beam of a tile, `side` pixels a side: base + slope t.  A ray of the tile
// is at most as far from the ray through the middle, at the same t.  The difference of two unit
// vectors a/|a| and b/|b| is at most 2 |a - b| / (|a| + |b|).
vec2 find_width(float side)
{
    float half_diagonal = 0.7071068 * side;
    float spread = half_diagonal * frame.pixel_slope;
    float stretch = frame.pixel_slope / max(pixel_slope, 1e-30);
    return vec2(half_diagonal * pixel_base, spread / max(stretch - 0.5 * spread, 0.1));
}

#if SAVES
RayMarch unpack_march(uvec4 low, uvec4 high)
{
    vec4 rest = uintBitsToFloat(high);
    return RayMarch(low.x, uintBitsToFloat(low.z), uintBitsToFloat(low.w), rest.x, rest.y,
                    float(low.y >> 2u & 3u) - 1.0, low.y >> 4u, low.y & 3u);
}

// Takes an index in the queue.  On a graphics card a subgroup takes the indices of its lanes at
// once (SUBGROUPS).
uint take_queue_index()
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
    uint at = 2u * (control.writing + take_queue_index());
    uint bits = march.state | uint(march.side + 1.0) << 2u | march.steps << 4u;
    queue[at] = uvec4(march.index, bits, floatBitsToUint(vec2(march.t, march.clearance)));
#ifdef STEPS
    queue[at + 1u] = floatBitsToUint(vec4(march.step, march.slope, march_radius, 0.0));
#else
    queue[at + 1u] = floatBitsToUint(vec4(march.step, march.slope, 0.0, 0.0));
#endif
}
#else
void save_item() {}
#endif

#ifdef PACKED
#include "packed.glsl"
#endif

#ifdef FOLLOWS_PATHS
// Begins just above a plane that the ray leaves by this cosine.  After the first step the clearance
// rises by a little less than that.
const float LESS = 0.1;
void begin_above_plane(float cosine)
{
    march.step = (1.0 + cosine) * 2.0 * SNAPPED_START * ROUNDING * rounding;
    march.slope = cosine - LESS - LEARNING / ((1.0 - LEARNING) * (1.0 + cosine));
}

// Begins at a surface.  Mostly there is an empty ball that touches the surface at the start, with a part of
// the last ray's length as its radius.  So the first distance is taken in its middle instead of on the ray.
const float TOUCHING = 0.125;
void begin_at_surface(vec3 normal, float last_length)
{
    float rise = dot(normal, direction);
    begin_above_plane(abs(rise));
#ifdef TOUCHES
    aside = TOUCHING * min(last_length, end) * (rise < 0.0 ? -normal : normal);
    cosine = abs(rise);
#endif
}
#endif

void begin_item(uint number, bool saved)
{
    bool  is_ray = control.phase == TRACE_RAYS, large = control.phase == TRACE_BEAMS_32;
    bool  small = control.phase == TRACE_BEAMS_4;
    uint  quarter = quarter_of(number);
    uvec2 half_tile = uvec2(quarter & 1u, quarter >> 1u);
    uvec2 pixel = 8u * item_tile + 4u * half_tile + uvec2(number & 3u, number >> 2u & 3u);
    uvec2 local = pixel - work.corner;
#ifdef FOLLOWS_PATHS
    if (are_of_paths()) {
        local = pixel_of(saved ? 0u : load_tile_word(number));
        pixel = work.corner + local;
    }
#endif
    uint  index = local.y * work.extent.x + local.x;
    tile_index = tile_of_item(number) - first_tile;
    exists = !is_ray || local.x < work.extent.x && local.y < work.extent.y;
#ifndef PATH_RAYS
    uint tile_number = (item_tile.y - first_8.y) * count_8.x + item_tile.x - first_8.x;
    if (control.sampled_at != 0u && !are_of_paths() && (is_ray || !large && !small))
        exists = exists && has_rays(tile_number, quarter, is_ray, number);
#endif
#if SAVES
    if (saved) {
        uint at = 2u * (control.reading + number);
        march = unpack_march(queue[at], queue[at + 1u]);
#ifdef STEPS
        march_radius = uintBitsToFloat(queue[at + 1u].z);
#endif
        index = march.index;
        pixel = work.corner + find_cell(index, work.extent.x);
        exists = true;
    }
#endif

    float side = large ? 32.0 : small ? 4.0 : 8.0;
    uvec2 tile = small ? 2u * item_tile + half_tile : item_tile;
    vec2  middle = side * (vec2(tile) + 0.5);
    // Filters that are wider than a pixel move all rays out of their pixels by the same offset.
    vec2  outside = work.offset - clamp(work.offset, 0.0, 1.0);
    aim(is_ray ? vec2(pixel) + work.offset : middle + outside);
    width = is_ray ? vec2(0.0) : find_width(side);
    shrinking = 1.0 / (1.0 + width.y);
    if (saved && march.side < 0.0)
        width = inside_width();
#ifdef FOLLOWS_PATHS
    float code = are_of_paths() ? load_path(PATH_TOWARD, index).w : 0.0;
    enter_medium(code);
    width = is_in_medium() ? inside_width() : width;
#endif
    vec2 range = is_ray ? clip_ray(origin, direction, frame.farthest) : vec2(0.0, frame.farthest);
    end = range.y;
    ends_at_walls = is_ray && end < frame.farthest;
#ifdef MARCH_GROUP
    if (exists && is_ray) {
        RayEnd known = find_end(index);
        end = known.state == STATE_HIT || known.unresolved ? min(end, known.t) : end;
    }
#endif
#ifndef PATH_RAYS // what is behind the caller's depth is not seen
    if (is_ray && control.limits != 0u && !are_of_paths()) {
        float limit = find_end_by_limit(exists ? index : 0u, direction);
        ends_at_walls = ends_at_walls && !(limit < end);
        end = min(end, limit);
    }
#endif
#ifdef PLANES
    plane_t = is_ray ? krs_plane_t(origin, direction) : INFINITE;
    plane_t = plane_t > frame.farthest ? INFINITE : max(plane_t, 0.0);
    end = min(end, plane_t);
#endif
#ifdef TOUCHES
    aside = vec3(0.0);
#endif
    if (!saved) {
        uvec2 cell = item_tile - (large ? first_32 : first_8);
        uint  beam = large ? end_of_32(cell) : small ? end_of_4(cell, quarter) : end_of_8(cell);
        begin_march(is_ray ? index : beam, max(range.x, item_start), is_ray);
#ifdef FOLLOWS_PATHS // it begins at a surface, so its first distance is too small to tell the side
        march.side = are_of_paths() ? sign(code) : march.side;
        width = march.side < 0.0 ? inside_width() : width;
        if (leaves_surfaces())
            begin_at_surface(load_hit(FACING, load_tile_word(number)).xyz, find_end(index).t);
#endif
#ifdef PACKED
        begin_scene_parts(is_ray);
#endif
    }
}

bool item_needs_step()
{
    uint most = control.phase == TRACE_RAYS ? frame.max_steps : MAX_BEAM_STEPS;
    return exists && (march.state == STATE_MARCHING || march.state == STATE_REFINING) &&
           march.steps < most;
}

// Returns the distance to march by.  Where branches save work, it skips components that are far
// away for their size.
float item_distance(vec3 position)
{
#ifdef PROBE
    return krs_probe(position, march.step);
#elif defined(PACKED)
    return krs_scene_part_distance(scene_part, position);
#elif defined(ALONG)
    return krs_along(position, direction, distance_behind());
#elif defined(STEPS)
    sampled = krs_steps(position, direction, distance_behind());
    return min(sampled.x, sampled.y);
#elif defined(EARLY_OUTS) && !defined(MARCH_GROUP)
    return krs_distance_lod(position, 0.0);
#else
    return krs_distance(position);
#endif
}

// Returns where the distance is evaluated next; with PROBE the centre of a ball.
vec3 item_position()
{
#ifdef TOUCHES
    if (aside != vec3(0.0))
        return origin + aside;
#endif
    return origin + (march.t + march.step) * direction;
}

#include "march_step.glsl"

// A ray that has run out of steps is unresolved.  A beam may end anywhere, since everything before
// its end is empty.
void end_item()
{
    bool is_ray = control.phase == TRACE_RAYS;
    bool unresolved = is_ray && (march.state == STATE_MARCHING || march.state == STATE_REFINING);
    uint march_group = 0u;
    march.state = unresolved ? STATE_MISS : march.state;
    // A ray from inside of a solid that reaches the box around all solids hits a wall there.
    bool is_inside = march.side < 0.0;
#ifdef FOLLOWS_PATHS
    is_inside = is_inside || is_in_medium();
#endif
    if (is_ray && !unresolved && march.state == STATE_MISS && is_inside && ends_at_walls) {
        march.state = STATE_HIT;
        march.t = end;
    }
#ifdef PLANES
    // A ray that hits nothing else meets its plane.  A beam whose rays may meet a plane counts as a
    // hit, so that its rays are marched.
    if (!unresolved && march.state == STATE_MISS && plane_t < INFINITE) {
        march.state = STATE_HIT;
        march.t = plane_t;
        march.side = 1.0;
    }
    if (!is_ray && march.state == STATE_MISS &&
        krs_plane_cosine(direction) < 1.01 * width.y + 1e-6) {
        march.state = STATE_HIT;
        march.t = end;
    }
#endif
#ifdef MARCH_GROUP
    // The hit of another group stays, unless this one is nearer.  So does the point where another
    // group ran out of steps.
    if (exists && is_ray) {
        RayEnd known = find_end(march.index);
        bool ends = march.state == STATE_HIT || unresolved,
             ended = known.state == STATE_HIT || known.unresolved;
        bool farther = !ends || ended && known.t < march.t;
        march.t = farther ? known.t : march.t;
        march.state = farther ? known.state : march.state;
        march.steps += known.steps;
        march_group = uint(MARCH_GROUP);
#ifdef PLANES
        march_group = march.t < plane_t ? march_group : 0u;
#endif
        march_group = farther ? known.march_group : march_group;
        unresolved = farther ? known.unresolved : unresolved;
    }
#endif
    if (!is_ray && march.state == STATE_MISS)
        march.t = INFINITE;
    found_tiles |= exists && march.state != STATE_MISS ? 1u << (tile_index & 15u) : 0u;
    uint bits = pack_ray(
        RayEnd(march.t, march.side, march.steps, march.state, unresolved, march_group));
    if (exists) {
        ends[march.index] = uvec2(floatBitsToUint(march.t), bits);
        max_steps = max(max_steps, is_ray ? march.steps : 0u);
    }
}

void end_group(uint steps)
{
    if (control.phase == TRACE_BEAMS_8)
        for (; found_tiles != 0u; found_tiles &= found_tiles - 1u) {
            uvec2 cell = cell_of_beam(first_tile + (tile_index & ~15u) +
                                      uint(findLSB(found_tiles)));
            tiles[atomicAdd(counts.tiles, 1u)] = cell.y * count_8.x + cell.x;
        }
    uint sum = steps, most = max_steps;
#ifdef SUBGROUPS
    sum = subgroupAdd(sum);
    most = subgroupMax(most);
    if (!subgroupElect())
        return;
#endif
    if (sum > 0u)
        atomicAdd(counts.evaluations, sum);
    if (most > 0u)
        atomicMax(counts.max_evaluations, most);
}

#include "schedule.glsl"
