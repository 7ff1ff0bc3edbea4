/*
 * packed.glsl: the parts of a scene, most of them one component, each marched by itself within one
 * ray or beam (KRS paper of 2016, section 5.1).  Each part has a length of the ray that is known to
 * miss it.  The part with the shortest such length takes the next step, by its own distance, which
 * is a branch.
 *
 * A ray is done when the next part has been hit: the others are farther.  The order of the parts is
 * in words of eight numbers of four bits, the nearest first.  After a step the part may be farther
 * than others, so its number moves up past theirs.  Where there are more than eight parts, there
 * are more words, whose first numbers are compared.
 *
 * The eye must be outside of everything.
 */
const uint WORDS = (KRS_SCENE_PARTS + 7u) / 8u;

vec4  saved_marches[8u * WORDS]; // t, clearance, step and slope of its march,
uint  saved_states[8u * WORDS];  // and state;
float exit_t[8u * WORDS];        // where the ray leaves its box;
float free_until[8u * WORDS];    // the ray misses it up to here; INFINITE: it does so everywhere
uint  order[WORDS];
uint  scene_part;                // whose march is `march`

// The number at this bit of its word moves up past all that are nearer.
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

// For the ray or beam that has just begun to march.  Boxes are not clipped against beams, which
// have a width.
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
