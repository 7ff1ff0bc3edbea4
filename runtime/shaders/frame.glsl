/*
 * frame.glsl: what the kernels of a picture share: the frame, the work of a dispatch, the
 * state of each pixel between dispatches, and the rays of pixels.
 *
 * A picture is rendered in bands of rows; the buffers hold one band.  A workgroup is a tile of
 * 8x8 pixels.  The C side of these blocks is in runtime/tracer/blocks.h.
 */
layout(local_size_x = 8, local_size_y = 8) in;

const float PI       = 3.14159265358979;
const float INFINITE = 1e38;
const float ROUNDING = 2.4e-7; // four units in the last place of 1

const uint PERSPECTIVE = 0u, ORTHOGRAPHIC = 1u, PANORAMA = 2u;
const uint MARCHING = 0u, HIT = 1u, MISS = 2u; // the fate of a ray

layout(std140, set = 1, binding = 0) uniform Frame {
    vec4  eye;               // w: no ray goes farther
    vec4  right, up;         // to the edges of the picture, at distance 1 where it is perspective
    vec4  forward;           // unit
    vec4  low, high;         // a box around the scene
    vec4  zenith, horizon, ground;
    vec2  size;              // of the picture in pixels
    float pixel_base;        // the width of a pixel at distance t is base + slope t
    float pixel_slope;
    float error;             // permitted distance from the surface, in pixels
    float occlusion_reach;   // of the farthest occlusion tap
    uint  most_steps;
} frame;

layout(push_constant) uniform Work {
    uvec2 corner, extent;        // of the band, in pixels
    vec3  light_vector;          // towards it, or its position
    float light_softness;        // angular diameter, or radius
    vec3  light_color;
    uint  steps;                 // of a ray in this dispatch
    vec2  offset;                // of the ray within its pixel
    uint  first, groups, stride; // tiles [first, first + groups), in an order of this stride
} work;

struct Ray {
    float t;
    float side;  // 1 outside of all solids; -1 when the camera is inside of one
    uint  steps;
    uint  fate;
};

struct Hit {
    vec3  position;
    float occlusion; // 1: open
    vec3  normal;    // towards the side that the ray comes from
    float roughness;
    vec3  color;
    float metallic;
    vec3  radiance;  // found so far: emission, then light by light
    uint  component;
    uint  level, instance;
    float pixel;     // the width of a pixel there
    float beam;      // before there is a hit: where the beam of a tile ends
};

layout(std430, set = 1, binding = 1) buffer Rays { Ray rays[]; };
layout(std430, set = 1, binding = 2) buffer Hits { Hit hits[]; };

// What decides branches is here and not among the constants above: lavapipe compiles a kernel
// anew, and keeps it, for every set of constants that decides one.
layout(std430, set = 1, binding = 4) buffer Control {
    uint marching;   // counts rays that need another dispatch
    uint unresolved; // counts rays that ran out of steps
    uint projection;
    uint phase;      // of secondary.comp
    uint beginning;  // 1: rays start here; for resolve.comp: the first ray of a pixel
    uint light_kind; // bit 0: positional, bit 1: casts shadows
    uint beams;      // of trace.comp: NO_BEAMS, MARCH_BEAMS, or FOLLOW_BEAMS
    uint beam_evaluations; // counts distances spent on beams
} control;

const uint NO_BEAMS = 0u, MARCH_BEAMS = 1u, FOLLOW_BEAMS = 2u;

// The pixel of this invocation; false when there is none.  The stride spreads neighbouring
// tiles over a device that deals out workgroups in contiguous halves.
bool find_pixel(out uvec2 pixel, out uint index)
{
    uint  tile = work.first + gl_WorkGroupID.x * work.stride % work.groups;
    uint  across = (work.extent.x + 7u) / 8u;
    uvec2 local = uvec2(tile % across, tile / across) * 8u + gl_LocalInvocationID.xy;
    index = local.y * work.extent.x + local.x;
    pixel = work.corner + local;
    return local.x < work.extent.x && local.y < work.extent.y;
}

// The ray through a place of the picture, in pixels from its top left corner, and how wide a
// pixel is along it: base + slope t.
void find_ray(vec2 place, out vec3 origin, out vec3 direction, out float base, out float slope)
{
    vec2 plane = vec2(2.0 * place.x / frame.size.x - 1.0, 1.0 - 2.0 * place.y / frame.size.y);
    origin = frame.eye.xyz;
    base = frame.pixel_base;
    slope = frame.pixel_slope;
    if (control.projection == PERSPECTIVE) {
        vec3  straight = frame.forward.xyz + plane.x * frame.right.xyz + plane.y * frame.up.xyz;
        float stretch = length(straight);
        direction = straight / stretch;
        slope /= stretch;
    } else if (control.projection == ORTHOGRAPHIC) {
        origin += plane.x * frame.right.xyz + plane.y * frame.up.xyz;
        direction = frame.forward.xyz;
    } else {
        float longitude = plane.x * PI, latitude = plane.y * 0.5 * PI;
        vec3  level = cos(longitude) * frame.forward.xyz + sin(longitude) * frame.right.xyz;
        direction = cos(latitude) * level + sin(latitude) * frame.up.xyz;
    }
}

// Where a ray is inside of the box around the scene; empty when the second is the smaller.  The
// box may be as large as 1e18, and no component of a direction is taken as smaller than 1e-18,
// so that nothing here is infinite times zero.
vec2 clip_ray(vec3 origin, vec3 direction, float farthest)
{
    vec3 safe = mix(direction, vec3(1e-18), lessThan(abs(direction), vec3(1e-18)));
    vec3 a = (frame.low.xyz - origin) / safe;
    vec3 b = (frame.high.xyz - origin) / safe;
    vec3 enter = min(a, b), leave = max(a, b);
    return vec2(max(max(enter.x, enter.y), max(enter.z, 0.0)),
                min(min(leave.x, leave.y), min(leave.z, farthest)));
}

float largest(vec3 v) { return max(max(abs(v.x), abs(v.y)), abs(v.z)); }
