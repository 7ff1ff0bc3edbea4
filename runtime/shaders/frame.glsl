/*
 * frame.glsl: what the shaders of a picture share: the frame, the work of a dispatch, the state of
 * pixels between dispatches, and their rays.
 *
 * A picture is rendered in bands of rows; the buffers hold one band.  Declarations that the host
 * shares are in runtime/shared/blocks.h.
 */

#include "runtime/shared/blocks.h"
#include "grid.glsl"
#ifdef PANORAMIC // a camera of the scene is a panorama, whose rays need sines
#include "sines.glsl"
#endif

// The end of a ray.
struct RayEnd {
    float t;
    float side;  // 1 outside of all solids; -1 when the camera is inside of one
    uint  steps;
    uint  state;
    bool  unresolved;  // it ran out of steps
    uint  march_group; // of the component that it hits; 0: none, or unknown
};

// Values of pixels, lights and rays are stored in rows of four numbers, or singly, and are read as
// texels.  lavapipe compiles each number of a buffer access to a loop over the lanes, which takes
// five times as long.  Buffers are for what is written, and what is counted.

// The ends of rays and beams: the bits of t, and the rest by pack_ray.  First are the rays of
// pixels, then the beams of 8x8 tiles, of 32x32 tiles, and of the quarters of 8x8 tiles, tile by
// tile.
layout(std430, set = 1, binding = ENDS_BINDING) buffer Ends { uvec2 ends[]; };
// Tiles of 8x8 pixels whose beams find something: only their pixels have rays.  Later the slots of
// pixels whose paths go on.
layout(std430, set = 1, binding = TILES_BINDING) buffer Tiles { uint tiles[]; };
#ifdef NO_TEXELS // the device reads too few texels: buffers are read instead
layout(std430, set = 1, binding = HITS_BINDING) buffer Hits { vec4 hits[]; };
layout(std430, set = 1, binding = INPUT_ROWS_BINDING) readonly buffer Inputs {
    uvec4 input_rows[];
};
uvec4 load_input(uint number) { return input_rows[number]; }
uvec2 load_end(uint index) { return ends[index]; }
uint  load_tile_word(uint index) { return tiles[index]; }
uvec4 load_tile_row(uint index)
{
    return uvec4(tiles[index], tiles[index + 1u], tiles[index + 2u], tiles[index + 3u]);
}
vec4  load_hit_row(uint number) { return hits[number]; }
#else
layout(std430, set = 1, binding = HITS_BINDING) writeonly buffer Hits { vec4 hits[]; };
// A table of albedos; then balls around what emits light, lights, and behind them the rays of a list.
// The other texels are those of the buffers above (layouts.c).
layout(set = 1, binding = INPUT_TEXELS_BINDING) uniform usamplerBuffer input_texels;
layout(set = 1, binding = END_TEXELS_BINDING) uniform usamplerBuffer end_texels;
layout(set = 1, binding = HIT_TEXELS_BINDING) uniform usamplerBuffer hit_texels;
layout(set = 1, binding = TILE_TEXELS_BINDING) uniform usamplerBuffer tile_texels;
uvec4 load_input(uint number) { return texelFetch(input_texels, int(number)); }
uvec2 load_end(uint index) { return texelFetch(end_texels, int(index)).xy; }
uvec4 load_tile_row(uint index) { return texelFetch(tile_texels, int(index / 4u)); }
uint  load_tile_word(uint index) { return load_tile_row(index)[index & 3u]; }
vec4  load_hit_row(uint number) { return uintBitsToFloat(texelFetch(hit_texels, int(number))); }
#endif
layout(std140, set = 1, binding = FRAME_BINDING) uniform FrameBlock { Frame given_frame; };
layout(std140, set = 1, binding = WORK_BINDING) uniform WorkBlock { Work given_work; };
layout(std430, set = 1, binding = CONTROL_BINDING) buffer ControlBlock {
    Control given_control;
    COUNTER_MEMBERS
} counts;

Frame   frame;
Work    work;
Control control;

#ifdef FRAME_TEXELS
// lavapipe compiles each number of a block to a branch, which tests whether it is in the buffer.
// A texel is four numbers and no branch, and such shaders compile in nine tenths of the time.
layout(set = 1, binding = FRAME_TEXELS_BINDING) uniform usamplerBuffer frame_texels;
layout(set = 1, binding = CONTROL_TEXELS_BINDING) uniform usamplerBuffer control_texels;

vec4 load_frame_row(int row) { return uintBitsToFloat(texelFetch(frame_texels, row)); }

#define LOAD_ONE(row, a) frame.a = load_frame_row(row);
#define LOAD_TWO(row, a, b)                                                                        \
    numbers = load_frame_row(row);                                                                 \
    frame.a = numbers.xyz;                                                                         \
    frame.b = numbers.w;
#define LOAD_THREE(row, a, b, c)                                                                   \
    numbers = load_frame_row(row);                                                                 \
    frame.a = numbers.xy;                                                                          \
    frame.b = numbers.z;                                                                           \
    frame.c = numbers.w;
#define SET_FOUR(block, a, b, c, d, row)                                                           \
    block.a = row.x;                                                                               \
    block.b = row.y;                                                                               \
    block.c = row.z;                                                                               \
    block.d = row.w;
#define LOAD_FLOATS(row, a, b, c, d)                                                               \
    numbers = load_frame_row(row);                                                                 \
    SET_FOUR(frame, a, b, c, d, numbers)
#define LOAD_UINTS(row, a, b, c, d)                                                                \
    bits = texelFetch(frame_texels, row);                                                          \
    SET_FOUR(frame, a, b, c, d, bits)
#define LOAD_CONTROL_FLOATS(row, a, b, c, d)                                                       \
    numbers = uintBitsToFloat(texelFetch(control_texels, row));                                    \
    SET_FOUR(control, a, b, c, d, numbers)
#define LOAD_CONTROL_UINTS(row, a, b, c, d)                                                        \
    bits = texelFetch(control_texels, row);                                                        \
    SET_FOUR(control, a, b, c, d, bits)
#endif

// Copies the blocks, first of all in main.  Inside of a loop lavapipe would fetch every number
// again, lane by lane.
void load_frame()
{
    work = given_work;
#ifdef FRAME_TEXELS
    vec4  numbers;
    uvec4 bits;
    FRAME_ROWS(LOAD_ONE, LOAD_TWO, LOAD_THREE, LOAD_FLOATS, LOAD_UINTS)
    CONTROL_ROWS(LOAD_CONTROL_FLOATS, LOAD_CONTROL_UINTS)
#else
    frame = given_frame;
    control = counts.given_control;
#endif
}

// Returns the workgroup whose items this one takes.  The stride spreads neighbours, which cost the
// same, over a device that assigns workgroups in contiguous halves.
uint find_group()
{
    return work.first + find_cell(gl_WorkGroupID.x * work.stride, work.groups).x;
}

// Loads a row of the hit in a slot (hit_lists.glsl).
vec4 load_hit(uint row, uint slot) { return load_hit_row(HIT_ROWS * slot + row); }

void store_hit(uint row, uint slot, vec4 numbers) { hits[HIT_ROWS * slot + row] = numbers; }

// Stores one number of the row LIGHTING.
void store_lighting(uint which, uint slot, float number)
{
    hits[HIT_ROWS * slot + LIGHTING][which] = number;
}

uint count_tiles()
{
    uvec2 tiles = (work.extent + 7u) / 8u;
    return tiles.x * tiles.y;
}

// Returns the pixel of a slot (hit_lists.glsl), counted in the band.
uvec2 pixel_of(uint slot)
{
    uvec2 tile = find_cell(slot / 64u, (work.extent.x + 7u) / 8u);
    return 8u * tile + uvec2(slot & 7u, slot >> 3u & 7u);
}

// Returns the bits of the pixels of a quarter of a tile that have rays: all, but where samples end
// by noise (noise.comp).
uint find_sampled(uint quarter)
{
    return control.sampled_at != 0u ? load_tile_word(control.sampled_at + quarter) : 0xffffu;
}

// Tells whether a pixel of a quarter, by its number, has a ray; or whether a whole tile has any.
bool has_rays(uint tile, uint quarter, bool is_pixel, uint number)
{
    uvec4 sampled = load_tile_row(control.sampled_at + 4u * tile);
    uint  bits = sampled[quarter];
    uint  all = sampled.x | sampled.y | sampled.z | sampled.w;
    return (is_pixel ? bits >> (number & 15u) & 1u : all) != 0u;
}

// Returns where the rows of a pixel's path begin; hits have rows for whole tiles.
uint path_at(uint index) { return HIT_ROWS * 64u * count_tiles() + PATH_ROWS * index; }

vec4 load_path(uint row, uint index) { return load_hit_row(path_at(index) + row); }

void store_path(uint row, uint index, vec4 numbers) { hits[path_at(index) + row] = numbers; }

#ifdef AIMS
// Returns where the rows of a ray of a hit begin.  Pixels have paths where these rays may be theirs.
uint lane_at(uint number)
{
#ifdef MIXED_RAYS
    return path_at(64u * count_tiles()) + LANE_ROWS * number;
#else
    return path_at(0u) + LANE_ROWS * number;
#endif
}

vec4 load_lane(uint row, uint number) { return load_hit_row(lane_at(number) + row); }

void store_lane(uint row, uint number, vec4 numbers) { hits[lane_at(number) + row] = numbers; }
#endif

// Packs from the lowest bit on: state, side, unresolved, march group; then the steps, and at last whether
// a medium scatters its light before it ends (track.comp).
const uint MAX_RAY_STEPS = 0x7fffffu, IN_VOLUME = 0x80000000u;
uint pack_ray(RayEnd ray)
{
    return ray.state | (ray.side < 0.0 ? 4u : 0u) | (ray.unresolved ? 8u : 0u) |
           ray.march_group << 4u | ray.steps << 8u;
}

RayEnd find_end(uint index)
{
    uvec2 row = load_end(index);
    uint  bits = row.y;
    return RayEnd(uintBitsToFloat(row.x), (bits & 4u) != 0u ? -1.0 : 1.0, bits >> 8u & MAX_RAY_STEPS, bits & 3u,
                  (bits & 8u) != 0u, bits >> 4u & 15u);
}

bool ends_in_volume(uint index) { return (load_end(index).y & IN_VOLUME) != 0u; }

// Finds the tiles that overlap the band, of `side` pixels a side, counted in the whole picture: the
// first one, and how many in each direction.
void find_tiles(uint side, out uvec2 first, out uvec2 count)
{
    first = work.corner / side;
    count = (work.corner + work.extent - 1u) / side - first + 1u;
}

#include "rays.glsl"

#if defined(PATH_RAYS) || defined(MIXED_RAYS)
// Finds the ray of the path that the point's pixel follows.
void find_ray_of_path(vec2 image_point, out vec3 origin, out vec3 direction, out float base,
                      out float slope)
{
    uvec2 pixel = min(uvec2(image_point - work.offset + 0.5) - work.corner, work.extent - 1u);
    uint  index = pixel.y * work.extent.x + pixel.x;
    vec4  start = load_path(PATH_ORIGIN, index), ahead = load_path(PATH_DIRECTION, index);
    origin = start.xyz;
    base = start.w;
    direction = ahead.xyz;
    slope = ahead.w;
}
#endif

#ifdef LISTED_RAYS // the ray of the point's pixel, in the list of the band
void find_ray_of_picture(vec2 image_point, out vec3 origin, out vec3 direction, out float base,
                         out float slope)
{
    uvec2 pixel = min(uvec2(image_point) - work.corner, work.extent - 1u);
    uint  number = pixel.y * work.extent.x + pixel.x;
    uint  row = LIGHTS_AT + LIGHT_ROWS * (control.lights + LIGHTS_AT_ONCE) + 2u * number;
    vec4  start = uintBitsToFloat(load_input(row)), ahead = uintBitsToFloat(load_input(row + 1u));
    origin = start.xyz;
    base = start.w;
    direction = ahead.xyz;
    slope = ahead.w;
}
#endif

// Tells whether the rays are those of paths.  Shaders with MIXED_RAYS are for both.
bool are_of_paths()
{
#ifdef MIXED_RAYS
    return control.of_paths != 0u;
#elif defined(PATH_RAYS)
    return true;
#else
    return false;
#endif
}

// Finds the ray through a point of the picture, which is given in pixels from the top left corner.
// At t a pixel is base + slope t wide.
void find_ray(vec2 image_point, out vec3 origin, out vec3 direction, out float base,
              out float slope)
{
#ifdef PATH_RAYS
    find_ray_of_path(image_point, origin, direction, base, slope);
#else
    find_ray_of_picture(image_point, origin, direction, base, slope);
#endif
#ifdef MIXED_RAYS
    if (are_of_paths())
        find_ray_of_path(image_point, origin, direction, base, slope);
#endif
}
