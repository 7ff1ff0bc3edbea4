/*
 * plate_rays.glsl: where the rays of paths meet the surface that the plate of another renderer shows.
 *
 * That surface is known where the camera sees it: at the middles of pixels, and between neighbours that
 * are joined (film/plate_map.c).  A ray meets it where it passes through from the front.  At an edge it
 * goes on behind, since nothing is known of what the plate does not show.
 *
 * How near things are is linear in the picture, on planes as on rays (nearness in plate_map.c).  So both
 * are compared there, at steps of a pixel.  Blocks of pixels that the ray passes before are skipped.
 */

// Tells whether a path that begins at the plate follows what that mirrors, or else what it scatters
// as a dull surface does.  Either has rows of results of its own.
const uint  CHOICE_OF_LOBE = 0x40000u;
const float MIRRORED_LOBE = 0.5; // of all such paths
bool is_mirrored(uvec2 pixel)
{
    return control.plate_reflectance > 0.0 &&
           sample_choice(work.corner + pixel, control.ray, CHOICE_OF_LOBE, control.seed).x < MIRRORED_LOBE;
}

// Returns the row of light on the plate, behind which is that without the scene.
uint row_of_plate(bool mirrored) { return control.caught + (mirrored ? CAUGHT_ROWS : 0u); }

// Rays begin to meet the plate so many pixels from where they leave it.
const float LEFT_OF_PLATE = 1.5;
// The part of the way at which, in perspective, the picture of a ray ends before the eye.
const float NEAR_EYE = 1e-3;

uvec4 load_plate(ivec2 pixel)
{
    return load_input(control.plate_map + uint(pixel.y) * uint(frame.size.x) + uint(pixel.x));
}

// Returns a point in the picture: in pixels from the middle of the first one, and how near it is.
vec3 place_on_plate(vec3 point)
{
    vec3  way = point - frame.eye;
    float depth = dot(way, frame.forward.xyz);
    vec2  plane = vec2(dot(way, frame.right.xyz) / dot(frame.right.xyz, frame.right.xyz),
                       dot(way, frame.up.xyz) / dot(frame.up.xyz, frame.up.xyz));
    bool  perspective = control.projection == PERSPECTIVE;
    plane = (perspective ? plane / depth : plane) - frame.shift.xy;
    return vec3(0.5 * frame.size * vec2(1.0 + plane.x, 1.0 - plane.y) - 0.5,
                perspective ? 1.0 / depth : -depth);
}

// Returns the plate at a place between the middles of four pixels.  Where they are not joined, it
// is that of the nearest one.
vec4 find_plate_at(vec2 place)
{
    ivec2 last = ivec2(frame.size) - 1;
    ivec2 cell = clamp(ivec2(floor(place)), ivec2(0), max(last - 1, ivec2(0)));
    vec2  part = clamp(place - vec2(cell), 0.0, 1.0);
    uvec4 a = load_plate(cell), b = load_plate(cell + ivec2(1, 0));
    uvec4 c = load_plate(cell + ivec2(0, 1)), d = load_plate(cell + ivec2(1, 1));
    bool  joined = (a.w & b.w & PLATE_JOINS_BELOW) != 0u && (a.w & c.w & PLATE_JOINS_RIGHT) != 0u;
    part = joined ? part : floor(part + 0.5);
    uvec4 left = part.y > 0.5 ? c : a, right = part.y > 0.5 ? d : b;
    vec4  nearest = uintBitsToFloat(part.x > 0.5 ? right : left);
    return joined ? mix(mix(uintBitsToFloat(a), uintBitsToFloat(b), part.x),
                        mix(uintBitsToFloat(c), uintBitsToFloat(d), part.x), part.y)
                  : nearest;
}

// Tells whether the pixels of two places, which are neighbours at most, are joined.
bool are_joined(ivec2 a, ivec2 b)
{
    ivec2 low = min(a, b);
    bool  across = a.x == b.x || (load_plate(ivec2(low.x, a.y)).w & PLATE_JOINS_RIGHT) != 0u;
    bool  down = a.y == b.y || (load_plate(ivec2(b.x, low.y)).w & PLATE_JOINS_BELOW) != 0u;
    return across && down;
}

ivec2 nearest_pixel(vec2 place)
{
    return clamp(ivec2(floor(place + 0.5)), ivec2(0), ivec2(frame.size) - 1);
}

// The steps, and a part of one, that leave the block of a place; and how near the nearest pixel is
// of the block and of those around it.
const float BEYOND_BLOCK = 1e-3;
float count_steps_in_block(vec2 place, vec2 step_across, out float nearest)
{
    ivec2 block = clamp(ivec2(floor(place)), ivec2(0), ivec2(frame.size) - 1) / int(PLATE_BLOCK);
    uint  across = (uint(frame.size.x) + PLATE_BLOCK - 1u) / PLATE_BLOCK;
    uint  pixels = uint(frame.size.x) * uint(frame.size.y);
    nearest = uintBitsToFloat(
        load_input(control.plate_map + pixels + uint(block.y) * across + uint(block.x)).x);
    vec2  low = vec2(block) * float(PLATE_BLOCK), room = place - low;
    room = mix(room, float(PLATE_BLOCK) - room, greaterThan(step_across, vec2(0.0)));
    vec2  count = room / max(abs(step_across), vec2(1e-6));
    return max(min(count.x, count.y), 0.0) + BEYOND_BLOCK;
}

// Returns the part of a ray whose points are before the eye; in perspective their depths are
// positive.
vec2 clip_to_eye(vec3 origin, vec3 direction, float end)
{
    vec3  way = origin - frame.eye;
    vec2  range = vec2(0.0, min(end, frame.farthest));
    float depth = dot(way, frame.forward.xyz), rate = dot(direction, frame.forward.xyz);
    if (control.projection != PERSPECTIVE)
        return range;
    float before = NEAR_EYE * length(way) - depth;
    if (abs(rate) < 1e-9)
        return before < 0.0 ? range : vec2(0.0);
    return rate > 0.0 ? vec2(max(range.x, before / rate), range.y)
                      : vec2(range.x, min(range.y, before / rate));
}

// Returns the place on the ray of a part of its picture.
float place_on_ray(vec2 range, vec3 from, vec3 to, float part)
{
    if (control.projection == PERSPECTIVE) // depths are 1 / nearness
        part = part * to.z / mix(from.z, to.z, part);
    return mix(range.x, range.y, part);
}

// Tells how far along a ray the plate is; INFINITE: the ray does not meet it before its end.  `left`: it begins
// on the plate.
float find_plate_ahead(vec3 origin, vec3 direction, float end, bool left)
{
    vec2 range = clip_to_eye(origin, direction, end);
    if (range.x >= range.y)
        return INFINITE;
    vec3  from = place_on_plate(origin + range.x * direction);
    vec3  to = place_on_plate(origin + range.y * direction), way = to - from;
    vec2  seen = clip_to(vec3(0.0, 0.0, -1e18), vec3(frame.size - 1.0, 1e18), from, way, 1.0);
    float pixels = max(abs(way.x), abs(way.y));
    seen.x = max(seen.x, left ? LEFT_OF_PLATE / max(pixels, 1e-6) : 0.0);
    if (seen.x >= seen.y)
        return INFINITE;
    float count = max(ceil((seen.y - seen.x) * pixels), 1.0);
    float each = (seen.y - seen.x) / count, at = 0.0;
    vec3  start = from + seen.x * way, advance = each * way;
    while (at < count) {
        vec3  here = start + at * advance;
        float nearest, room = count_steps_in_block(here.xy, advance.xy, nearest);
        if (min(here.z, here.z + room * advance.z) >= nearest) {
            at += room;
            continue;
        }
        float each_step = min(1.0, count - at);
        vec3  next = here + each_step * advance;
        float before = here.z - find_plate_at(here.xy).w, behind = next.z - find_plate_at(next.xy).w;
        if (before >= 0.0 && behind < 0.0 &&
            are_joined(nearest_pixel(here.xy), nearest_pixel(next.xy)))
            return place_on_ray(range, from, to,
                                seen.x + each * (at + each_step * before / (before - behind)));
        at += 1.0;
    }
    return INFINITE;
}

// Returns the light that the plate shows there.
vec3 find_plate_color(vec3 origin, vec3 direction, float t)
{
    return find_plate_at(place_on_plate(origin + t * direction).xy).rgb;
}
