/*
 * packed.glsl: marches the scene parts by themselves within one ray or beam (KRS paper of 2016,
 * section 5.1).  Most parts are one component.  For each part a length of the ray is known to miss
 * it.  The part with the shortest such length takes the next step, by its own distance, which is a
 * branch.
 *
 * A ray has ended when the next part has been hit, as the others are farther.  The order of the
 * parts is in words of eight numbers of four bits, the nearest first.  After a step a part may be
 * farther than others, so its number moves up past theirs.  Where there are more than eight parts,
 * there are more words, whose first numbers are compared.
 *
 * The eye must be outside of all solids.
 */
const uint WORDS = (KRS_SCENE_PARTS + 7u) / 8u;

vec4  saved_marches[8u * WORDS]; // of each part: t, clearance, step and slope,
uint  saved_states[8u * WORDS];  // state,
float exit_t[8u * WORDS];        // where the ray leaves the part's box,
float free_until[8u * WORDS];    // where it may hit the part at the earliest; INFINITE: nowhere
uint  order[WORDS];
uint  scene_part;                // the part whose march is `march`

// Moves the number at this bit of a word up past the numbers of all nearer parts.
void reorder(uint word, uint shift)
{
    uint order_word = order[word], first = 8u * word;
    for (; shift < 28u; shift += 4u) {
        uint a = order_word >> shift & 7u, b = order_word >> shift + 4u & 7u;
        if (free_until[first + a] <= free_until[first + b])
            break;
        order_word ^= (a ^ b) << shift | (a ^ b) << shift + 4u;
    }
    order[word] = order_word;
}

void save_part()
{
    saved_marches[scene_part] = vec4(march.t, march.clearance, march.step, march.slope);
    saved_states[scene_part] = march.state;
    free_until[scene_part] = march.state == STATE_MISS ? INFINITE
                           : march.state == STATE_HIT  ? march.t : march.t + march.clearance;
}

void select_next_part()
{
    scene_part = order[0] & 7u;
    for (uint word = 1u; word < WORDS; word++) {
        uint first = 8u * word + (order[word] & 7u);
        scene_part = free_until[first] < free_until[scene_part] ? first : scene_part;
    }
    vec4 kept = saved_marches[scene_part];
    march.t = kept.x;
    march.clearance = kept.y;
    march.step = kept.z;
    march.slope = kept.w;
    march.state = saved_states[scene_part];
    end = exit_t[scene_part];
}

void advance_to_next_part()
{
    save_part();
    reorder(scene_part / 8u, 0u);
    select_next_part();
}

// Begins the marches of all parts, for a ray or beam that has just begun.  Beams have a width, so
// they are not clipped to boxes.
void begin_scene_parts(bool is_ray)
{
    float start = march.t, farthest = end;
    vec3  margin = vec3(4.0 * ROUNDING * rounding);
    march.side = 1.0;
    for (scene_part = 0u; scene_part < 8u * WORDS; scene_part++) {
        vec3 low = vec3(1.0), high = vec3(-1.0);
        if (scene_part < KRS_SCENE_PARTS)
            krs_scene_part_box(scene_part, low, high);
        vec2 within = clip_to(low - margin, high + margin, origin, direction, farthest);
        within = is_ray ? within : vec2(0.0, farthest);
        march.t = max(start, within.x);
        end = min(farthest, within.y);
        march.state = low.x <= high.x && march.t <= end ? STATE_MARCHING : STATE_MISS;
        exit_t[scene_part] = end;
        save_part();
    }
    for (uint word = 0u; word < WORDS; word++) {
        order[word] = 0x76543210u;
        for (uint shift = 28u; shift > 0u; shift -= 4u)
            reorder(word, shift - 4u);
    }
    select_next_part();
}
