/*
 * lane_instances.c: instance groups and texts over lanes are what tapes find one point at a time, bit for bit, wherever
 * the points of a row are.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "compiler/graph/lanes/lanes.h"
#include "compiler/passes/inspect.h"
#include "compiler/scene/program.h"
#include "tests/support/instance_texts.h"
#include "tests/support/random.h"

enum { LEAST = 16, POINTS = 160, SEED = 5 };

static const char *const letters[] = {
    "show text(\"Krs 26 &\", size: 1).extrude(0.2);",
    "show text(\"ao\", size: 1, font: \"DejaVu Serif\").extrude(0.1) | sphere(0.3);",
    "show union(text(\"gR\", size: 1).extrude(0.2), box([2, 0.3, 0.3]), blend: 0.1);",
};

static Random randomness = {SEED};

/* One of the two tapes of a state, and its lanes. */
typedef struct Subject {
    Memory      memory;
    Arena       arena;
    KrsState   *state;
    const Tape *tape;
    Node        roots[ROOT_COUNT];
    size_t      count;
    LaneTape    lanes;
    LaneWork    work;
} Subject;

static void open_lanes(Subject *s, bool surface)
{
    const KrsScene *scene = s->state->scene;
    s->tape               = surface ? &scene->surface : &scene->distance;
    s->count              = surface ? ROOT_COUNT : 1;
    s->roots[0]           = distance_root(&scene->roots, 0);
    if (surface)
        memcpy(s->roots, surface_roots(&scene->roots, 0), sizeof s->roots);
    s->lanes         = lane_tape_new(s->tape, s->roots, s->count, false, 0, &s->arena);
    s->lanes.scalars = arena_new_array(&s->arena, double, s->lanes.scalar_count + 1);
    lane_tape_scalars(&s->lanes, s->state->values, s->lanes.scalars);
    s->work = lane_work_in(arena_alloc(&s->arena, lane_work_bytes(&s->lanes), 1), s->state->values);
}

/* Some are near each other, as those of one cell are; others anywhere. */
static void place(const Subject *s, double (*points)[3], double (*normals)[3])
{
    const KrsProgram *program   = &s->state->scene->program;
    double            middle[3] = {0, 0, 0};
    for (int i = 0; i < POINTS; i++) {
        bool alone = i < POINTS / 2;
        for (int k = 0; k < 3; k++) {
            double low = program->low[k], side = program->high[k] - low;
            double at     = low + random_between(&randomness, -0.2, 1.2) * side;
            middle[k]     = alone || i % 40 == 0 ? at : middle[k];
            points[i][k]  = middle[k] + (alone ? 0 : random_between(&randomness, 0, 0.05) * side);
            normals[i][k] = random_between(&randomness, -1, 1);
        }
    }
}

static size_t count_different(const Subject *s, const LanePoints *points, const double *results)
{
    size_t different = 0, output = 0;
    for (size_t i = 0; i < points->count; i++) {
        tape_run_surface(s->tape, points->points[i], points->normals[i], points->footprints[i],
                         s->state->values);
        for (size_t k = 0; k < s->count; k++) {
            GraphType type = (GraphType)s->tape->graph->items[s->roots[k]].type;
            uint32_t  size = type <= TYPE_VEC4 ? (uint32_t)type : 1;
            for (uint32_t c = 0; c < size; c++, output++) {
                double tape = s->state->values[s->roots[k]].v[c], lane = results[output];
                different += !(tape == lane || (isnan(tape) && isnan(lane)));
            }
        }
    }
    return different;
}

static void compare(Subject *s, const char *name, bool surface)
{
    double         points[POINTS][3], normals[POINTS][3], footprints[POINTS];
    const LaneSet *sets;
    size_t         count = lane_sets(&sets);
    open_lanes(s, surface);
    double *results = arena_new_array(&s->arena, double, POINTS *(s->lanes.output_count + 1));
    place(s, points, normals);
    for (int i = 0; i < POINTS; i++)
        footprints[i] = random_between(&randomness, 0, 0.01);
    LanePoints all = {(const double(*)[3])points, (const double(*)[3])normals, footprints, POINTS};
    for (size_t i = 0; i < 2 * count; i++) {
        all.count = i < count ? POINTS : POINTS - 27;
        lane_use_set(&sets[i % count]);
        lane_run(&s->lanes, &s->work, LANE_DOUBLE, all, 0, s->lanes.output_count, results);
        size_t different = count_different(s, &all, results);
        if (different)
            fail_msg("%s: %zu numbers of %zu points differ on %s%s", name, different, all.count,
                     sets[i % count].name, surface ? ", of surfaces" : "");
    }
    lane_use_set(NULL);
}

static KrsScene *open_scene(Subject *s, const char *name, const char *text)
{
    static jmp_buf exhausted;
    KrsScene      *scene;
    s->memory.exhausted = &exhausted;
    s->arena.memory     = &s->memory;
    if (setjmp(exhausted) != 0 ||
        compile_with_instances(text, strlen(text), LEAST, NULL, &scene) != KRS_OK)
        fail_msg("%s does not compile", name);
    assert_true(scene->program.table_count > 0);
    assert_int_equal(krs_state_new(scene, &s->state), KRS_OK);
    state_refresh(s->state);
    return scene;
}

static void close_scene(Subject *s, KrsScene *scene)
{
    arena_free(&s->arena);
    krs_state_free(s->state);
    krs_scene_free(scene);
}

static void compare_scene(const char *name, const char *text, bool by_cells)
{
    Subject   s              = {0};
    KrsScene *scene          = open_scene(&s, name, text);
    scene->distance.by_cells = scene->surface.by_cells = by_cells;
    compare(&s, name, false);
    compare(&s, name, true);
    close_scene(&s, scene);
}

/* ---- outlines in boxes ---- */

/* What is known of many small boxes about an outline. */
typedef struct Tally {
    size_t listed, bounded, different, steep, bent, halved;
} Tally;

static Box box_near(Subject *s)
{
    double points[POINTS][3], normals[POINTS][3], distances[POINTS];
    Box    box;
    int    nearest = 0;
    place(s, points, normals);
    lane_run(&s->lanes, &s->work, LANE_DOUBLE,
             (LanePoints){.points = (const double(*)[3])points, .count = POINTS}, 0, 1, distances);
    for (int i = 1; i < POINTS; i++)
        nearest = fabs(distances[i]) < fabs(distances[nearest]) ? i : nearest;
    double half = pow(2, -random_between(&randomness, 4, 10));
    for (int k = 0; k < 3; k++)
        box.axis[k] = (Range){points[nearest][k] - half, points[nearest][k] + half};
    return box;
}

/* The second difference about the middle of two points is what second derivatives permit, and the first what the
   first ones do. */
static bool permits(const LaneSlope *slope, const LaneHessian *hessian, const double a[3],
                    const double b[3], const double values[3], double share)
{
    static const int ROW[6] = {0, 1, 2, 1, 0, 0}, COLUMN[6] = {0, 1, 2, 2, 2, 1};
    double           bend = values[0] + values[1] - 2 * values[2], slack = 1e-9;
    Range            first = range_of(0), second = range_of(0);
    for (int k = 0; k < 3; k++)
        first = range_add(first, range_mul(slope->by[k], range_of(b[k] - a[k])));
    for (int i = 0; i < 6; i++)
        second = range_add(
            second,
            range_mul(hessian->by[i], range_of((i < 3 ? 0.25 : 0.5) * (b[ROW[i]] - a[ROW[i]]) *
                                               (b[COLUMN[i]] - a[COLUMN[i]]))));
    return values[1] - values[0] >= first.low - slack &&
           values[1] - values[0] <= first.high + slack && bend >= share * second.low - slack &&
           bend <= share * second.high + slack;
}

static void try_derivatives(Subject *s, const LaneTape *pruned, Box box, LaneRanges *ranges,
                            Tally *tally)
{
    LaneSlope   *slopes   = lane_slopes_new(&s->lanes, &s->arena), slope;
    LaneHessian *hessians = lane_hessians_new(&s->lanes, &s->arena), hessian;
    bool         halved   = false;
    lane_ranges_run(pruned, ranges, box);
    if (!lane_slopes_run(pruned, ranges, slopes, &slope) ||
        !lane_hessians_run(pruned, ranges, slopes, hessians, &hessian))
        return;
    tally->bounded++;
    for (int i = 0; i < 20; i++) {
        double at[3][3], values[3];
        for (int k = 0; k < 3; k++) {
            at[0][k] = random_between(&randomness, box.axis[k].low, box.axis[k].high);
            at[1][k] = random_between(&randomness, box.axis[k].low, box.axis[k].high);
            at[2][k] = 0.5 * (at[0][k] + at[1][k]);
        }
        lane_run(&s->lanes, &s->work, LANE_DOUBLE,
                 (LanePoints){.points = (const double(*)[3])at, .count = 3}, 0, 1, values);
        tally->bent += !permits(&slope, &hessian, at[0], at[1], values, 1);
        halved = halved || !permits(&slope, &hessian, at[0], at[1], values, 0.25);
    }
    tally->halved += halved;
}

static void try_box(Subject *s, Tally *tally)
{
    double     points[LANES][3], whole[LANES], less[LANES];
    Box        box    = box_near(s);
    LaneRanges ranges = lane_ranges_new(&s->lanes, &s->arena);
    ranges.values     = s->state->values;
    lane_ranges_run(&s->lanes, &ranges, box);
    LaneTape pruned = lane_prune(&s->lanes, &ranges, 1, &s->arena);
    for (int i = 0; i < LANES; i++)
        for (int k = 0; k < 3; k++)
            points[i][k] = random_between(&randomness, box.axis[k].low, box.axis[k].high);
    LanePoints all = {.points = (const double(*)[3])points, .count = LANES};
    lane_run(&s->lanes, &s->work, LANE_DOUBLE, all, 0, 1, whole);
    lane_run(&pruned, &s->work, LANE_DOUBLE, all, 0, 1, less);
    for (size_t i = 0; i < pruned.call_count; i++)
        tally->listed += pruned.calls[i].instances != NULL;
    for (int i = 0; i < LANES; i++)
        tally->different += whole[i] != less[i];
    try_derivatives(s, &pruned, box, &ranges, tally);
}

/* Instances that are left out never count; where one is left there are derivatives. */
static void letters_are_pruned(void **state)
{
    (void)state;
    for (size_t i = 0; i < 2; i++) {
        Subject   s     = {0};
        Tally     tally = {0};
        KrsScene *scene = open_scene(&s, letters[i], letters[i]);
        open_lanes(&s, false);
        for (int turn = 0; turn < 400; turn++) {
            ArenaMark mark = arena_mark(&s.arena);
            try_box(&s, &tally);
            arena_rewind(&s.arena, mark);
        }
        print_message("# %zu lists, %zu boxes with bounds, %zu wrong if a quarter\n", tally.listed,
                      tally.bounded, tally.halved);
        assert_int_equal(tally.different, 0);
        assert_int_equal(tally.bent, 0);
        assert_true(tally.listed > 100 && tally.bounded > 20 && tally.halved > 0);
        close_scene(&s, scene);
    }
}

static void instances_over_lanes_are_as_on_tapes(void **state)
{
    (void)state;
    for (size_t i = 0; i < instance_text_count; i++) {
        char *text = instance_text(&instance_texts[i], 1, SEED);
        compare_scene(instance_texts[i].name, text, i % 4 == 3);
        free(text);
    }
}

static void letters_over_lanes_are_as_on_tapes(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof letters / sizeof *letters; i++)
        for (int by_cells = 0; by_cells < 2; by_cells++)
            compare_scene(letters[i], letters[i], by_cells);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(instances_over_lanes_are_as_on_tapes),
                                       cmocka_unit_test(letters_over_lanes_are_as_on_tapes),
                                       cmocka_unit_test(letters_are_pruned)};
    return cmocka_run_group_tests_name("instance groups over lanes", tests, NULL, NULL);
}
