/*
 * packed.glsl: the parts of a scene, most of them one component, each marched by itself within one
 * ray or beam (KRS paper of 2016, section 5.1): of each is kept how far nothing of it is, and the
 * part for which that is least makes the next step, by its own distance, which is a branch.
 *
 * A ray is done when the part that comes next has been hit: nothing of the others is before.  Which
 * comes next is told by words of eight numbers of four bits, the nearest first; a step moves one
 * part farther away, so its number moves up past those that are nearer now.  Where there are more
 * than eight parts, there are more words, whose first numbers are compared.
 *
 * The eye must be outside of everything.
 */
const uint WORDS = (KRS_PARTS + 7u) / 8u;

vec4  part_march[8u * WORDS]; // t, room, gap and slope of its March,
uint  part_fate[8u * WORDS];  // and fate;
float part_end[8u * WORDS];   // where the ray leaves its box;
float part_free[8u * WORDS];  // nothing of it is before; INFINITE: it is missed
uint  order[WORDS];
uint  part;                   // whose March is `march`

// The number at a place of its word, in bits, moves up past all that are nearer.
void move_up(uint word, uint place)
{
    uint numbers = order[word], first = 8u * word;
    for (; place < 28u; place += 4u) {
        uint a = numbers >> place & 7u, b = numbers >> place + 4u & 7u;
        if (part_free[first + a] <= part_free[first + b])
            break;
        numbers ^= (a ^ b) << place | (a ^ b) << place + 4u;
    }
    order[word] = numbers;
}

void keep_part()
{
    part_march[part] = vec4(march.t, march.room, march.gap, march.slope);
    part_fate[part] = march.fate;
    part_free[part] = march.fate == STATE_MISS ? INFINITE
                    : march.fate == STATE_HIT  ? march.t : march.t + march.room;
}

void find_next_part()
{
    part = order[0] & 7u;
    for (uint word = 1u; word < WORDS; word++) {
        uint first = 8u * word + (order[word] & 7u);
        part = part_free[first] < part_free[part] ? first : part;
    }
    vec4 kept = part_march[part];
    march.t = kept.x;
    march.room = kept.y;
    march.gap = kept.z;
    march.slope = kept.w;
    march.fate = part_fate[part];
    end = part_end[part];
}

void turn_to_next_part()
{
    keep_part();
    move_up(part / 8u, 0u);
    find_next_part();
}

// For the ray or beam that has just begun to march.  Beams are wider than boxes know.
void begin_parts(bool is_ray)
{
    float start = march.t, farthest = end;
    vec3  margin = vec3(4.0 * ROUNDING * rounding);
    march.side = 1.0;
    for (part = 0u; part < 8u * WORDS; part++) {
        vec3 low = vec3(1.0), high = vec3(-1.0);
        if (part < KRS_PARTS)
            krs_part_box(part, low, high);
        vec2 within = clip_to(low - margin, high + margin, origin, direction, farthest);
        within = is_ray ? within : vec2(0.0, farthest);
        march.t = max(start, within.x);
        end = min(farthest, within.y);
        march.fate = low.x <= high.x && march.t <= end ? STATE_MARCHING : STATE_MISS;
        part_end[part] = end;
        keep_part();
    }
    for (uint word = 0u; word < WORDS; word++) {
        order[word] = 0x76543210u;
        for (uint place = 28u; place > 0u; place -= 4u)
            move_up(word, place - 4u);
    }
    find_next_part();
}
