/*
 * lanes.c: how many times a second one core evaluates a distance: by the tape, by lane tapes of each
 * instruction set and precision, and pruned to small boxes.
 */
#include <setjmp.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "compiler/graph/lanes/lanes.h"
#include "compiler/scene/program.h"

enum { POINTS = 4096, BOXES = 64, PRUNED_FOR = 256 };

typedef struct Subject {
    KrsState  *state;
    Memory     memory;
    Arena      arena;
    LaneTape   tape;
    LaneWork   work;
    LaneRanges ranges;
} Subject;

static double now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

/* Spheres in rows, put on and taken off alternately, so that no list of alike parts is made of
   them. */
static void write_scene(char *text, size_t size, int spheres)
{
    size_t length = (size_t)snprintf(text, size, "let s0 = sphere(0.5);\n");
    for (int i = 1; i <= spheres; i++)
        length += (size_t)snprintf(text + length, size - length,
                                   "let s%d = %s(s%d, sphere(0.%d).move([%d.1, %d.2, %d.3]));\n", i,
                                   i % 2 ? "union" : "difference", i - 1, 300 + i, i % 6, i / 6 % 6,
                                   i / 36);
    snprintf(text + length, size - length, "show s%d;\n", spheres);
}

static bool open_subject(Subject *s, int spheres)
{
    static char text[1 << 18];
    KrsScene   *scene;
    write_scene(text, sizeof text, spheres);
    KrsOptions options = {0};
    if (krs_compile_text(text, strlen(text), "bench.krs", &options, &scene) != KRS_OK ||
        krs_state_new(scene, &s->state) != KRS_OK)
        return false;
    state_refresh(s->state);
    const Node root = distance_root(&scene->roots, 0);
    s->tape         = lane_tape_new(&scene->distance, &root, 1, true, 0, &s->arena);
    s->tape.scalars = arena_new_array(&s->arena, double, s->tape.scalar_count + 1);
    lane_tape_scalars(&s->tape, s->state->values, s->tape.scalars);
    s->work = lane_work_in(arena_alloc(&s->arena, lane_work_bytes(&s->tape), 1), s->state->values);
    s->ranges = lane_ranges_new(&s->tape, &s->arena);
    return true;
}

/* Points in one of the boxes, which are a hundredth of the scene wide. */
static void place_points(int box, int count, double (*points)[3])
{
    for (int i = 0; i < count; i++)
        for (int k = 0; k < 3; k++)
            points[i][k] = 0.09 * (box * (k + 3) % BOXES) +
                           0.06 * ((i * (2 * k + 3) * 40503u >> 4) % 1024 / 1024.0);
}

static double rate_of_tape(Subject *s, const double (*points)[3])
{
    double start = now(), spent;
    size_t done  = 0;
    do {
        for (int i = 0; i < 256; i++)
            tape_run_point(&s->state->scene->distance, points[i], s->state->values);
        done += 256;
        spent = now() - start;
    } while (spent < 0.3);
    return (double)done / spent;
}

static double rate_of_lanes(const LaneTape *tape, const Subject *s, LanePrecision precision,
                            const double (*points)[3])
{
    static double results[POINTS];
    double        start = now(), spent;
    size_t        done  = 0;
    do {
        lane_run(tape, &s->work, precision, (LanePoints){.points = points, .count = POINTS}, 0, 1,
                 results);
        done += POINTS;
        spent = now() - start;
    } while (spent < 0.3);
    return (double)done / spent;
}

/* The pruning counts as well. */
static double rate_of_pruned(Subject *s, double (*points)[3], double *left)
{
    static double results[LANES];
    double        start = now(), spent, steps = 0;
    size_t        done = 0, boxes = 0;
    do {
        ArenaMark mark = arena_mark(&s->arena);
        Box       box;
        place_points((int)(boxes % BOXES), PRUNED_FOR, points);
        for (int k = 0; k < 3; k++) {
            double low  = 0.09 * (double)((boxes % BOXES) * (size_t)(k + 3) % BOXES);
            box.axis[k] = (Range){low, low + 0.06};
        }
        start = boxes == 0 ? now() : start;
        lane_ranges_run(&s->tape, &s->ranges, box);
        LaneTape pruned = lane_prune(&s->tape, &s->ranges, 1, &s->arena);
        for (int i = 0; i < PRUNED_FOR / LANES; i++)
            lane_run(&pruned, &s->work, LANE_DOUBLE,
                     (LanePoints){.points = (const double(*)[3])points + LANES * i, .count = LANES},
                     0, 1, results);
        steps += (double)pruned.count;
        done += PRUNED_FOR;
        boxes++;
        arena_rewind(&s->arena, mark);
        spent = now() - start;
    } while (spent < 0.3);
    *left = steps / (double)boxes;
    return (double)done / spent;
}

static void measure(int spheres)
{
    static double  points[POINTS][3];
    Subject        s = {0};
    jmp_buf        exhausted;
    const LaneSet *sets;
    double         left;
    s.memory.exhausted = &exhausted;
    s.arena.memory     = &s.memory;
    if (setjmp(exhausted) != 0 || !open_subject(&s, spheres))
        return;
    place_points(5, POINTS, points);
    double scalar = rate_of_tape(&s, (const double(*)[3])points);
    printf("| %zu | tape, one point at a time | %.3g | |\n", s.tape.count, scalar);
    size_t count = lane_sets(&sets);
    for (size_t i = 0; i < count; i++)
        for (int precision = 0; precision < LANE_PRECISIONS; precision++) {
            lane_use_set(&sets[i]);
            double rate = rate_of_lanes(&s.tape, &s, (LanePrecision)precision,
                                        (const double(*)[3])points);
            printf("| %zu | %s, %s precision | %.3g | %.1f |\n", s.tape.count, sets[i].name,
                   precision == LANE_DOUBLE ? "double" : "single", rate, rate / scalar);
        }
    lane_use_set(NULL);
    double pruned = rate_of_pruned(&s, points, &left);
    printf("| %zu | double, pruned for 256 points at a time, to %.0f steps | %.3g | %.1f |\n",
           s.tape.count, left, pruned, pruned / scalar);
    arena_free(&s.arena);
    krs_state_free(s.state);
}

int main(void)
{
    static const int spheres[] = {3, 28, 285};
    printf("| steps | how | points a second on one core | times the tape |\n| --- | --- | --- | "
           "--- |\n");
    for (size_t i = 0; i < sizeof spheres / sizeof *spheres; i++)
        measure(spheres[i]);
    return 0;
}
