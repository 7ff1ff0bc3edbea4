/*
 * lane_cells.c: in a ball the cell tape of a scene tells the distance that the scene has there, up to the cap;
 * farther away it tells no less than the cap.
 *
 * Scenes are trees of shapes at random, figures of many corners or letters that are made solid, and some that have other
 * operations.  What is pruned for a smaller ball than the one it is asked in must be seen to be wrong.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/graph/lanes/lane_cells.h"
#include "compiler/scene/program.h"
#include "rays/ray_field.h"
#include "rays/space.h"
#include "tests/support/random.h"

enum { TREES = 40, BALLS = 60, SHAPES = 24, FIGURES = 12, DEPTH = 2 };
/* Of single precision, for coordinates of this size. */
static const double SIZE = 2, ROUNDING = 2e-5;

static Random chance = {39};

static double uniform(double low, double high) { return random_between(&chance, low, high); }

/* ---- scenes ---- */

static const char *const others[] = {
    "show krs { kernel capsule([0, 0, 0], [0, 0.4, 0], radius: 0.05); for i in 0..6 { mobius "
    "translate([0, 0.4, 0]) * rotate([0, 1, 0], -70deg) * rotate([1, 0, 0], 28deg) * scale(0.8); "
    "reflect plane([1, 0, 0], 0); kernel capsule([0, 0, 0], [0, 0.4, 0], radius: 0.05); } };",
    "show box([1, 0.5, 0.3]).repeat([1.5, 1, 2], count: [3, 1, 3]);",
    "show torus(0.7, 0.2).twist([0, 1, 0], 60deg) - sphere(0.4);",
    "show cylinder(0.2, 2).move([1, 0, 0]).repeat_polar(7);",
    "show algebraic(x^4 + y^4 + z^4 == 0.5);",
    "show sphere(1).displace(0.05 * sin(9 * x) * sin(9 * y), 0.1);",
    "show box([1, 1, 1]).shell(0.1) & sphere(0.8); show plane([0, 1, 0], -1);",
    "show union([sphere(0.6), box([1, 0.3, 0.3])], blend: 0.2);",
    "show union([sphere(0.1 + 0.0005 * i).move(1.5 * random_direction(i)) for i in 0..300]) - "
    "union([box([0.2, 0.3, 0.1 + 0.001 * i]).rotate([1, 1, 0], i).move(1.2 * random_direction(i + "
    "99)) for i in 0..400]);",
    "show union([capsule([0, 0, 0], random_direction(i), 0.05 + 0.002 * i) for i in "
    "0..30]).rotate([0, 1, 0], 1).move([0.2, 0, 0]);",
    "show text(\"S8\", size: 1).extrude(0.3);",
    "show sphere(1).displace(0.1 * noise(3 * p), 0.1);",
    "show box([1, 1, 1]).displace(0.05 * noise(5 * [x, z]), 0.06) - sphere(0.6);",
    "show union([sphere(0.1 + 0.0005 * i).move(1.3 * random_direction(i)) for i in 0..200], blend: "
    "0.1);",
    "show union([box([0.2, 0.1, 0.1 + 0.0005 * i]).rotate([1, 1, 0], i).move(1.3 * "
    "random_direction(i)) "
    "for i in 0..90], blend: 0.05, kind: \"exponential\");",
    "show union([sphere(0.1 + 0.001 * i).move(1.3 * random_direction(i)) for i in 0..60], blend: "
    "0.1, "
    "kind: \"cubic\");",
    "show union([sphere(0.1 + 0.001 * i).move(1.3 * random_direction(i)) for i in 0..60], blend: "
    "0.1, "
    "kind: \"chamfer\");",
    "show union([sphere(0.1 + 0.001 * i).move(1.3 * random_direction(i)) for i in 0..60], blend: "
    "0.1, "
    "kind: \"circular\");",
    "show helix(radius: 0.6, pitch: 0.5, turns: 4, width: 0.2);",
    "show tube(spline([[-1.5, -1, 0], [-0.6, 0, 0.4], [0.6, 0.5, 0], [1, 1, -0.4]]), 0.1);",
    "show sweep(star(5, 0.3, 0.15), spline([[0, -1, 0], [0.6, 0.3, 0], [0, 1, 0]]), twist: "
    "360deg);",
    "show cylinder(0.2, 1).round(0.05).move([1, 0, 0]).repeat_polar(5).repeat([0, 1.5, 0]);",
    "show polygon([[0.8, -0.1], [1.3, -0.2], [1.5, 0], [1.3, 0.2], [0.8, 0.1], [0.7, 0]])"
    ".repeat_polar(9, [0, 0, 1]).extrude(0.4);",
};

static size_t add_shape(char *to, size_t room)
{
    static const char *const kinds[] = {"sphere(%.3f)", "box([%.3f, %.3f, %.3f])",
                                        "cylinder(%.3f, %.3f)", "torus(%.3f, 0.1)",
                                        "capsule([0, 0, 0], [%.3f, %.3f, %.3f], 0.1)"};
    char                     shape[80];
    double                   size[3];
    for (int k = 0; k < 3; k++)
        size[k] = uniform(0.1, 0.7);
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wformat-nonliteral"
    snprintf(shape, sizeof shape, kinds[random_below(&chance, 5)], size[0], size[1], size[2]);
#pragma GCC diagnostic pop
    return (size_t)snprintf(to, room,
                            "%s.rotate([%.3f, 1, %.3f], %.1fdeg).move([%.3f, %.3f, %.3f])", shape,
                            uniform(-1, 1), uniform(-1, 1), uniform(0, 360), uniform(-1.5, 1.5),
                            uniform(-1.5, 1.5), uniform(-1.5, 1.5));
}

/* Shapes that are joined from the left to the right. */
static void random_tree(char *text, size_t room)
{
    size_t at = (size_t)snprintf(text, room, "show ");
    at += add_shape(text + at, room - at);
    for (int i = 1; i < SHAPES; i++) {
        const unsigned kind = random_below(&chance, 8);
        at += (size_t)snprintf(text + at, room - at,
                               kind == 0   ? " - "
                               : kind == 1 ? " & (box([3, 3, 3]) - "
                                           : " | ");
        at += add_shape(text + at, room - at);
        at += (size_t)snprintf(text + at, room - at, kind == 1 ? ")" : "");
    }
    snprintf(text + at, room - at, ";");
}

/* Letters, or a figure whose corners go around: one edge may leave it, another come back. */
static size_t add_figure(char *to, size_t room)
{
    static const char solids[][24] = {".extrude(%.3f)", ".revolve(%.3f)"};
    const unsigned    corners      = 5 + random_below(&chance, 60);
    size_t            at           = 0;
    if (random_below(&chance, 3) == 0) {
        at += (size_t)snprintf(to, room, "text(\"%c%c\", size: 1.5)",
                               'A' + random_below(&chance, 26), 'a' + random_below(&chance, 26));
    } else {
        at += (size_t)snprintf(to, room, "polygon([");
        for (unsigned i = 0; i < corners; i++) {
            const double angle = 6.2831853 * i / corners, radius = uniform(0.3, 1.4);
            at += (size_t)snprintf(to + at, room - at, "%s[%.4f, %.4f]", i ? ", " : "",
                                   radius * cos(angle), radius * sin(angle));
        }
        at += (size_t)snprintf(to + at, room - at, "])");
    }
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wformat-nonliteral"
    at += (size_t)snprintf(to + at, room - at, solids[random_below(&chance, 2)], uniform(0.1, 1));
#pragma GCC diagnostic pop
    return at + (size_t)snprintf(to + at, room - at, ".rotate([%.3f, 1, %.3f], %.1fdeg)",
                                 uniform(-1, 1), uniform(-1, 1), uniform(0, 360));
}

static void random_figures(char *text, size_t room)
{
    size_t at = (size_t)snprintf(text, room, "show ");
    at += add_figure(text + at, room - at);
    at += (size_t)snprintf(text + at, room - at, random_below(&chance, 2) ? " - " : " | ");
    at += add_figure(text + at, room - at);
    snprintf(text + at, room - at, ";");
}

/* ---- a scene and its cells ---- */

typedef struct Opened {
    KrsScene *scene;
    KrsState *state;
    Memory    memory;
    Arena     arena;
    LaneTape  lanes;
    CellTape  cells;
    CellWork *work;
} Opened;

static bool open_scene(Opened *o, const char *text)
{
    *o = (Opened){.scene = NULL};
    if (krs_compile_text(text, strlen(text), "scene.krs", NULL, &o->scene) != KRS_OK)
        return false;
    assert_int_equal(krs_state_new(o->scene, &o->state), KRS_OK);
    state_refresh_points(o->state);
    o->memory.limit    = (size_t)1 << 30;
    o->arena.memory    = &o->memory;
    const size_t count = o->scene->component_count;
    Node        *roots = arena_new_array(&o->arena, Node, count + 1);
    for (size_t i = 0; i < count; i++)
        roots[i] = distance_root(&o->scene->roots, i);
    o->lanes = lane_tape_new_steep(&o->state->tapes.distance, roots, count, true, 0, &o->arena);
    o->lanes.scalars = arena_new_array(&o->arena, double, o->lanes.scalar_count + 1);
    lane_tape_scalars(&o->lanes, o->state->values, o->lanes.scalars);
    o->cells = cell_tape_new(&o->lanes, o->state->values, &o->arena);
    o->work  = cell_work_new(&o->cells, DEPTH, o->state->values, &o->arena);
    return true;
}

static void close_scene(Opened *o)
{
    arena_free(&o->arena);
    krs_state_free(o->state);
    krs_scene_free(o->scene);
}

/* ---- balls ---- */

typedef struct Count {
    size_t points, wrong, steep, flat, capped, whole_steps, steps;
} Count;

static void random_in_ball(const double middle[3], double radius, double point[3])
{
    double offset[3], square;
    do {
        square = 0;
        for (int k = 0; k < 3; k++) {
            offset[k] = uniform(-1, 1);
            square += offset[k] * offset[k];
        }
    } while (square > 1);
    for (int k = 0; k < 3; k++)
        point[k] = middle[k] + radius * offset[k];
}

/* Blocks that are run together have what each has by itself, bit for bit. */
static void compare_wide(Opened *o, const CellTape *tape, const float points[3][CELL_LANES],
                         const float alone[CELL_LANES])
{
    float        wide[3][CELL_WIDE];
    const size_t blocks = 1 + random_below(&chance, CELL_BLOCKS);
    for (int i = 0; i < CELL_WIDE; i++)
        for (int k = 0; k < 3; k++)
            wide[k][i] = points[k][(i + i / CELL_LANES) % CELL_LANES];
    const float *found = cell_run_wide(tape, o->work, DEPTH, (const float(*)[CELL_WIDE])wide,
                                       blocks);
    for (size_t i = 0; i < blocks * CELL_LANES; i++)
        assert_memory_equal(&found[i], &alone[(i + i / CELL_LANES) % CELL_LANES], sizeof *found);
}

/* All instruction sets give the same, bit for bit. */
static const float *run_all_sets(Opened *o, const CellTape *tape, const float points[3][CELL_LANES])
{
    const LaneSet *sets;
    float          first[CELL_LANES];
    for (size_t count = lane_sets(&sets), set = 0; set < count; set++) {
        lane_use_set(&sets[set]);
        const float *found = cell_run(tape, o->work, DEPTH, points);
        if (set == 0)
            memcpy(first, found, sizeof first);
        assert_memory_equal(first, found, sizeof first);
        compare_wide(o, tape, points, first);
    }
    lane_use_set(NULL);
    return cell_run(tape, o->work, DEPTH, points);
}

static double apart(const double a[3], const double b[3])
{
    return hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
}

/* Compares a cell tape with the scene in the ball.  Between two points the distance changes by no more than `part` of the
   slope tells. */
static void compare(Opened *o, const CellTape *tape, const double middle[3], double radius,
                    double part, Count *count)
{
    float  points[3][CELL_LANES];
    double exact[CELL_LANES][3], distances[CELL_LANES];
    for (int i = 0; i < CELL_LANES; i++) {
        random_in_ball(middle, radius, exact[i]);
        for (int k = 0; k < 3; k++) {
            points[k][i] = (float)exact[i][k];
            exact[i][k]  = (double)points[k][i];
        }
    }
    assert_int_equal(krs_distance(o->state, (const double(*)[3])exact, CELL_LANES, distances),
                     KRS_OK);
    const float *found = count->points % (4 * CELL_LANES) == 0
                             ? run_all_sets(o, tape, (const float(*)[CELL_LANES])points)
                             : cell_run(tape, o->work, DEPTH, (const float(*)[CELL_LANES])points);
    for (int i = 0; i < CELL_LANES; i++) {
        const double value = (double)found[i], cap = (double)tape->cap;
        const bool   near  = distances[i] < cap;
        const bool   right = near ? fabs(value - distances[i]) < ROUNDING : value > cap - ROUNDING;
        count->points++;
        count->capped += !near;
        count->wrong += !right;
        count->steep += i > 0 && near && distances[i - 1] < cap &&
                        fabs(distances[i] - distances[i - 1]) >
                            part * (double)tape->slope * apart(exact[i], exact[i - 1]) + ROUNDING;
    }
    count->flat += tape->slope < 0.999f;
}

/* A ball, and one within it: `part` of the radius is pruned for. */
static void try_ball(Opened *o, double part, Count *count)
{
    double   middle[3], radius = SIZE * exp(uniform(-4, 0));
    float    points[3][CELL_LANES];
    CellTape tape = o->cells;
    CellMark mark = cell_mark(o->work);
    for (int k = 0; k < 3; k++)
        middle[k] = uniform(-SIZE, SIZE);
    for (uint32_t depth = 0; depth < DEPTH; depth++) {
        const uint32_t lane = random_below(&chance, CELL_LANES);
        double         inner[3];
        for (int i = 0; i < CELL_LANES; i++)
            for (int k = 0; k < 3; k++)
                points[k][i] = (float)middle[k];
        cell_run(&tape, o->work, depth, (const float(*)[CELL_LANES])points);
        tape = cell_prune(&tape, o->work, depth, lane, (float)(part * radius),
                          ray_margin(&o->scene->program));
        compare(o, &tape, middle, radius, part, count);
        count->whole_steps += o->cells.count;
        count->steps += tape.count;
        random_in_ball(middle, radius / 2, inner);
        memcpy(middle, inner, sizeof middle);
        radius /= 2;
    }
    cell_release(o->work, mark);
}

static Count try_scene(const char *text, double part)
{
    Opened o;
    Count  count = {0};
    if (!open_scene(&o, text))
        fail_msg("%s", text);
    for (int i = 0; i < BALLS; i++)
        try_ball(&o, part, &count);
    close_scene(&o);
    return count;
}

/* ---- cubes ---- */

/* Asks cubes of space, of which `part` is pruned for, at points and in balls. */
static Count try_space(const char *text, double part)
{
    Opened      o;
    Count       count  = {0};
    const float low[3] = {-2, -2, -2}, high[3] = {2, 2, 2};
    if (!open_scene(&o, text))
        fail_msg("%s", text);
    for (int balls = 0; balls < 2; balls++) {
        Space           space;
        const SpaceRule rule = {.stretch    = (float)part * (float)(1 + balls),
                                .margin     = ray_margin(&o.scene->program),
                                .deepest    = 4,
                                .short_tape = 10,
                                .max_steps  = 1 << 20};
        space_new(&space, &o.cells, low, high, &rule, &o.arena);
        for (int i = 0; i < 4 * BALLS; i++) {
            const double middle[3]  = {uniform(-SIZE, SIZE), uniform(-SIZE, SIZE),
                                       uniform(-SIZE, SIZE)},
                         radius     = balls ? uniform(0, 0.5) : 0;
            const float    point[3] = {(float)middle[0], (float)middle[1], (float)middle[2]};
            const uint32_t number   = balls ? space_find_ball(&space, o.work, point,
                                                              (float)(part * radius))
                                            : space_find(&space, o.work, point);
            compare(&o, &space.cubes[number].tape, middle, radius, 1, &count);
            count.steps += space.cubes[number].tape.count < o.cells.count;
        }
        space_free(&space);
    }
    close_scene(&o);
    return count;
}

/* ---- tests ---- */

static Count try_random(void (*make)(char *text, size_t room), int scenes, double part)
{
    Count all = {0};
    chance    = (Random){39};
    for (int i = 0; i < scenes; i++) {
        char text[8000];
        make(text, sizeof text);
        const Count count = try_scene(text, part);
        all.points += count.points;
        all.wrong += count.wrong;
        all.steep += count.steep;
        all.flat += count.flat;
        all.capped += count.capped;
        all.whole_steps += count.whole_steps;
        all.steps += count.steps;
    }
    return all;
}

static void trees_of_shapes(void **context)
{
    (void)context;
    const Count count = try_random(random_tree, TREES, 1);
    print_message("%zu points, %zu beyond the cap; %.0f %% of the steps are left\n", count.points,
                  count.capped, 100.0 * (double)count.steps / (double)count.whole_steps);
    assert_int_equal(count.wrong, 0);
    assert_int_equal(count.steep, 0);
    assert_true(count.capped > count.points / 50);
    assert_true(2 * count.steps < count.whole_steps);
}

/* Fields whose slope is that of their steepest part, which is seldom near. */
static void random_field(char *text, size_t room)
{
    size_t at = (size_t)snprintf(text, room, "show field(");
    for (int i = 0; i < SHAPES; i++)
        at += (size_t)snprintf(text + at, room - at, "min(max(%.3f * x + %.3f * y, %.3f - z), ",
                               uniform(0.2, i == 0 ? 4 : 1), uniform(-1, 1), uniform(-2, 2));
    at += (size_t)snprintf(text + at, room - at, "x + 9");
    for (int i = 0; i < SHAPES; i++)
        at += (size_t)snprintf(text + at, room - at, ")");
    snprintf(text + at, room - at, ").within(box([3, 3, 3]));");
}

static void flat_fields(void **context)
{
    (void)context;
    const Count count = try_random(random_field, FIGURES, 1);
    print_message("%zu cells are flat\n", count.flat);
    assert_int_equal(count.wrong, 0);
    assert_int_equal(count.steep, 0);
    assert_true(count.flat > FIGURES);
    assert_true(try_random(random_field, FIGURES, 0.5).steep > 0);
}

/* Ground that is no plane has no box, so coordinates have no largest size. */
static void random_tree_on_ground(char *text, size_t room)
{
    const size_t at = (size_t)snprintf(text, room,
                                       "shape ground() { distance: length([x, y + 20, z]) - 18 - "
                                       "0.05 * sin(x) } show ground(); ");
    random_tree(text + at, room - at);
}

static void trees_on_endless_ground(void **context)
{
    (void)context;
    const Count count = try_random(random_tree_on_ground, FIGURES, 1);
    print_message("%.0f %% of the steps are left\n",
                  100.0 * (double)count.steps / (double)count.whole_steps);
    assert_int_equal(count.wrong, 0);
    assert_true(2 * count.steps < count.whole_steps);
}

static void figures_made_solid(void **context)
{
    (void)context;
    const Count count = try_random(random_figures, FIGURES, 1);
    print_message("%zu points, %zu beyond the cap\n", count.points, count.capped);
    assert_int_equal(count.wrong, 0);
    assert_true(count.capped > count.points / 50);
}

static void other_scenes(void **context)
{
    (void)context;
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        const Count count = try_scene(others[i], 1);
        if (count.wrong > 0)
            fail_msg("%zu of %zu are wrong: %s", count.wrong, count.points, others[i]);
    }
}

static void cubes_of_space(void **context)
{
    (void)context;
    Count all = {0}, halves = {0};
    chance = (Random){39};
    for (int i = 0; i < FIGURES; i++) {
        char text[8000];
        random_tree(text, sizeof text);
        const Count count = try_space(text, 1), half = try_space(text, 0.5);
        all.wrong += count.wrong;
        all.points += count.points;
        all.steps += count.steps;
        halves.wrong += half.wrong;
    }
    print_message("%zu points, %zu cubes have shorter tapes\n", all.points, all.steps);
    assert_int_equal(all.wrong, 0);
    assert_true(all.steps > all.points / CELL_LANES / 2);
    assert_true(halves.wrong > 0);
}

static void a_smaller_ball_is_seen(void **context)
{
    (void)context;
    assert_true(try_random(random_tree, TREES, 0.5).wrong > 0);
    assert_true(try_random(random_figures, FIGURES, 0.5).wrong > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(trees_of_shapes),       cmocka_unit_test(trees_on_endless_ground),
        cmocka_unit_test(figures_made_solid),    cmocka_unit_test(other_scenes),
        cmocka_unit_test(flat_fields),           cmocka_unit_test(cubes_of_space),
        cmocka_unit_test(a_smaller_ball_is_seen)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
