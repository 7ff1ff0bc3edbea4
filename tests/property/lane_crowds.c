/*
 * lane_crowds.c: crowds and texts over lanes are what tapes find one point at a time, bit for bit, wherever
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

#include "compiler/graph/lanes.h"
#include "compiler/inspect.h"
#include "compiler/program.h"
#include "tests/support/crowd_texts.h"
#include "tests/support/random.h"

enum { LEAST = 16, POINTS = 160, SEED = 5 };

static const char *const letters[] = {
    "show text(\"Krs 26 &\", size: 1).extrude(0.2);",
    "show text(\"ao\", size: 1, font: \"DejaVu Serif\").extrude(0.1) | sphere(0.3);",
    "show union(text(\"gR\", size: 1).extrude(0.2), box([2, 0.3, 0.3]), blend: 0.1);",
};

static Random randomness = {SEED};

/* One of the two tapes of a frame, and its lanes. */
typedef struct Subject {
    Memory      memory;
    Arena       arena;
    KrsFrame   *frame;
    const Tape *tape;
    Node        roots[ROOT_COUNT];
    size_t      count;
    LaneTape    lanes;
    LaneWork    work;
} Subject;

static void open_lanes(Subject *s, bool surface)
{
    const KrsScene *scene = s->frame->scene;
    s->tape               = surface ? &scene->surface : &scene->distance;
    s->count              = surface ? ROOT_COUNT : 1;
    s->roots[0]           = distance_root(&scene->roots, 0);
    if (surface)
        memcpy(s->roots, surface_roots(&scene->roots, 0), sizeof s->roots);
    s->lanes         = lane_tape_new(s->tape, s->roots, s->count, false, 0, &s->arena);
    s->lanes.scalars = arena_new_array(&s->arena, double, s->lanes.scalar_count + 1);
    lane_tape_scalars(&s->lanes, s->frame->values, s->lanes.scalars);
    s->work = lane_work_in(arena_alloc(&s->arena, lane_work_bytes(&s->lanes), 1), s->frame->values);
}

/* Some are near each other, as those of one cell are; others anywhere. */
static void place(const Subject *s, double (*points)[3], double (*normals)[3])
{
    const KrsProgram *program   = &s->frame->scene->program;
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
                         s->frame->values);
        for (size_t k = 0; k < s->count; k++) {
            GraphType type = (GraphType)s->tape->graph->items[s->roots[k]].type;
            uint32_t  size = type <= TYPE_VEC4 ? (uint32_t)type : 1;
            for (uint32_t c = 0; c < size; c++, output++) {
                double tape = s->frame->values[s->roots[k]].v[c], lane = results[output];
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

static void compare_scene(const char *name, const char *text, bool by_cells)
{
    Subject   s = {0};
    jmp_buf   exhausted;
    KrsScene *scene;
    s.memory.exhausted = &exhausted;
    s.arena.memory     = &s.memory;
    assert_int_equal(setjmp(exhausted), 0);
    if (compile_with_crowds(text, strlen(text), LEAST, NULL, &scene) != KRS_OK)
        fail_msg("%s does not compile", name);
    assert_true(scene->program.table_count > 0);
    assert_int_equal(krs_frame_new(scene, &s.frame), KRS_OK);
    frame_refresh(s.frame);
    scene->distance.by_cells = scene->surface.by_cells = by_cells;
    compare(&s, name, false);
    compare(&s, name, true);
    arena_free(&s.arena);
    krs_frame_free(s.frame);
    krs_scene_free(scene);
}

static void crowds_over_lanes_are_as_on_tapes(void **state)
{
    (void)state;
    for (size_t i = 0; i < crowd_text_count; i++) {
        char *text = crowd_text(&crowd_texts[i], 1, SEED);
        compare_scene(crowd_texts[i].name, text, i % 4 == 3);
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
    const struct CMUnitTest tests[] = {cmocka_unit_test(crowds_over_lanes_are_as_on_tapes),
                                       cmocka_unit_test(letters_over_lanes_are_as_on_tapes)};
    return cmocka_run_group_tests_name("crowds over lanes", tests, NULL, NULL);
}
