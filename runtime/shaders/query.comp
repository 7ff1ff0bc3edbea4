#version 440
#extension GL_GOOGLE_include_directive : enable
#extension GL_KHR_shader_subgroup_shuffle : enable
/*
 * query.comp: where rays that a program asks about end; sample.comp says what is there.
 *
 * The rule is that of trace.comp, without beams, and the permitted error is a length.  A ray that
 * runs out of steps ends where it is, and is told apart.
 */
#ifndef REFILL // which variant: the renderer says so; this one suits every device
#define REFILL 0
#endif
#include "scene.glsl"
#include "frame.glsl"

const uint HUNGRY = 2u;
const bool SAVES = false;

// What may be left open between two balls, of the permitted error.
const float OPEN = 0.0625;
const float LEARNING = 0.3; // of the mean slope
// Solids that touch are one: from inside they count as grown by what rounding may leave open at
// the seam between two.
const float SEAM = 4.0;     // roundings

// Where a ray begins nearer than this to a surface, rounding may have decided on which side.
const float DOUBTFUL = 64.0; // roundings

layout(std430, set = 1, binding = 5) readonly buffer Questions { QueryRay questions[]; };
layout(std430, set = 1, binding = 3) writeonly buffer Ways { RayHit ways[]; };
// Where rays hit, or were given up, for sample.comp.
layout(std430, set = 1, binding = 1) writeonly buffer Points { Point points[]; };

uint  index;              // of the ray
vec3  origin, direction;
float end;
float rounding;           // of coordinates at t = 0
float t, clear, gap;      // nothing is before t, nor for `clear` behind it; next look: at t + gap
float slope;              // of the room along the ray, as it was on average
float side;               // as of a Ray; 0: not known
bool  walls;              // all solids end at `end`
uint  steps, fate;
uint  unsure;             // on which side the ray begins, as of a RayHit

void look_up_item(uint number) {}
void begin_group(uint first) {}

void begin_item(uint number, bool saved)
{
    QueryRay question = questions[number];
    index = number;
    origin = question.origin;
    direction = question.direction;
    end = question.end;
    rounding = largest(origin);
    t = clear = gap = 0.0;
    slope = -1.0;
    side = question.kind == float(BEGINS_OUTSIDE) ? 1.0 : 0.0;
    walls = question.kind == float(ENDS_AT_WALLS);
    steps = unsure = 0u;
    fate = end >= 0.0 ? STATE_MARCHING : STATE_MISS;
}

bool item_wants_more()
{
    return (fate == STATE_MARCHING || fate == STATE_REFINING) && steps < frame.most_steps;
}

// What is far for its size need not be looked at, where a branch saves work.
float item_distance(vec3 place)
{
#ifdef ALONG
    // Some roundings farther back than the ray has been: what was just before a surface without
    // thickness there must not be behind it here.
    return krs_along(place, direction, gap > 0.0 ? gap + 2.0 * ROUNDING * (rounding + t) : 0.0);
#elif defined(EARLY_OUTS)
    return krs_distance_lod(place, 0.0);
#else
    return krs_distance(place);
#endif
}

vec3 item_place() { return origin + (t + gap) * direction; }

// The surface is crossed between t, where there is room (`before`), and t + gap, where there is
// none, within the permitted error: looks there once more, unless what is between is short anyway.
void close_in(float before, float room, float open)
{
    float along = before > room ? clamp(before / (before - room), 0.0, 2.0) : 0.0;
    bool  accurate = gap - clear <= 2.0 * open || fate == STATE_REFINING;
    gap *= along;
    t += accurate ? gap : 0.0;
    fate = !accurate ? STATE_REFINING : t <= end ? STATE_HIT : STATE_MISS;
}

void take_distance(float distance)
{
    float at = t + gap;
    float least = ROUNDING * (rounding + at), open = OPEN * frame.error + least;
    if (side == 0.0) {
        side = distance < 0.0 ? -1.0 : 1.0;
        unsure = abs(distance) > DOUBTFUL * least ? 0u
                 : distance < 0.0                 ? QUERY_SIDE_UNKNOWN | QUERY_BEGINS_INSIDE
                                                  : QUERY_SIDE_UNKNOWN;
    }
    float seam = side < 0.0 ? SEAM * least : 0.0;
    float room = side * distance + seam;
    float doubtful = gap - clear; // as long as may hide something
    steps++;
    // Twice: a gap of `open` beyond what is clear may be rounded up.
    if (fate == STATE_REFINING || (room <= 0.0 && doubtful <= frame.error + 2.0 * open)) {
        close_in(clear - seam, room - seam, open);
    } else if (room > 0.0 && doubtful <= room + 1.01 * open) {
        slope = mix(slope, gap > 0.0 ? (room - clear) / gap : -1.0, LEARNING);
        t = at;
        clear = room;
#ifdef ALONG // it is what is free ahead, and tells nothing of what is behind
        gap = room + open;
#else
        gap = room * max(1.0, 2.0 / (1.0 - min(slope, 0.98))) + open;
#endif
        fate = at + room > end ? STATE_MISS : STATE_MARCHING;
    } else {
        gap = max(0.5 * (gap + clear - max(room, 0.0)), clear + open);
        slope = -1.0;
    }
}

void end_item()
{
    uint place = 0u;
    if (fate == STATE_MISS && side < 0.0 && walls) {
        fate = STATE_HIT;
        t = end;
    }
    if (fate != STATE_MISS) {
        place = atomicAdd(counts.solid, 1u);
        points[place] = Point(origin + t * direction, 0.0);
    }
    ways[index] = RayHit(t, fate, place, steps | unsure);
}

void save_item() {}
void end_group(uint steps) {}

#include "schedule.glsl"
