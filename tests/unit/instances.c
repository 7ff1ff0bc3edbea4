/*
 * Functions of instance groups: tapes give what loops over the same numbers give, in the graph as it was made and
 * as passes make it; the text holds each function once, and is GLSL.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <stdio.h>
#include <string.h>

#include "compiler/graph/evaluate.h"
#include "compiler/graph/rewrite/parameterise.h"
#include "compiler/graph/rewrite/simplify.h"
#include "compiler/print/module.h"
#include "compiler/target/spirv.h"
#include "tests/unit/instance_scene.h"

/* Columns of a table of spheres: centre, radius, shade. */
enum { POINTS = 1500 };

/* ---- tapes ---- */

static const double NORMAL[3] = {0.6, 0, -0.8}, FOOTPRINT = 0.125;

static double value_at(const Many *many, const NodeValue *values, int root)
{
    return values[many->roots[root]].v[0];
}

/* Returns how many points are nearer to something than all that is not listed. */
static uint32_t compare_at(const Many *many, const NodeValue *values, const double p[3],
                           bool by_cells)
{
    const Graph         *g     = many->graph;
    const InstanceTable *plain = table_of(g, many->sharp), *mixed = table_of(g, many->smooth);
    double               sharp  = all_spheres(plain, p, false, by_cells), lean[3];
    double               smooth = all_spheres(mixed, p, true, by_cells);
    double nested = all_copies(table_of(g, many->nested), table_of(g, many->inner), p, by_cells);
    assert_true(fabs(value_at(many, values, SHARP) - sharp) < 1e-12);
    assert_true(fabs(value_at(many, values, SMOOTH) - smooth) < 1e-12);
    assert_true(fabs(value_at(many, values, NESTED) - nested) < 1e-12);
    lean_there(plain, p, NORMAL, FOOTPRINT, lean);
    for (int k = 0; k < 3; k++)
        assert_true(fabs(values[many->roots[LEAN]].v[k] - lean[k]) < 1e-12);
    bool near = sharp < clearance_at(plain, p);
    if (!near && by_cells)
        return 0;
    uint32_t nearest = nearest_sphere(plain, p);
    assert_true(value_at(many, values, SHADED) == row_of(plain, nearest)[SHADE]);
    return near;
}

static void near_sphere(Bench *b, const InstanceTable *table, double p[3])
{
    const double *row = row_of(table, (uint32_t)random_below(&b->random, (int)table->rows));
    random_vector(&b->random, row[RADIUS] * TIME, p);
    for (int k = 0; k < 3; k++)
        p[k] += row[k];
}

static void compare_tape(Bench *b, const Many *many, bool by_cells)
{
    Tape            tape       = tape_new(many->graph, many->roots, KINDS, &b->arena);
    NodeValue      *values     = arena_new_array(&b->arena, NodeValue, many->graph->count);
    const NodeValue parameters = {{TIME}};
    uint32_t        near       = 0;
    tape.by_cells              = by_cells;
    tape_run_frame(&tape, &parameters, values);
    assert_int_equal(tape_frame_infinite(&tape, values), NODE_NONE);
    for (int i = 0; i < POINTS; i++) {
        double p[3];
        if (i % 2)
            random_vector(&b->random, i % 4 == 1 ? 6 : 20, p);
        else
            near_sphere(b, table_of(many->graph, many->sharp), p);
        tape_run_surface(&tape, p, NORMAL, FOOTPRINT, values);
        near += compare_at(many, values, p, by_cells);
    }
    assert_in_range(near, POINTS / 8, POINTS - POINTS / 8);
}

static void compare_with_loops(Bench *b, const Many *many)
{
    compare_tape(b, many, true);
    compare_tape(b, many, false);
}

static void tapes_give_what_loops_give(void **state)
{
    Bench *b    = *state;
    Many   many = make_many(b);
    graph_validate(many.graph, "making it");
    compare_with_loops(b, &many);
}

static void passes_keep_functions(void **state)
{
    Bench *b     = *state;
    Many   many  = make_many(b);
    Arena  arena = {.memory = &b->memory};
    many.graph   = graph_simplify(many.graph, many.roots, KINDS, &arena);
    instances_keep(many.graph->instances, &arena);
    arena_free(&b->arena); /* the rest stands by itself */
    graph_validate(many.graph, "simplify");
    compare_with_loops(b, &many);
    many.graph = graph_parameterise(many.graph, many.roots, KINDS, 0, &arena);
    graph_validate(many.graph, "parameterise");
    compare_with_loops(b, &many);
    arena_free(&arena);
}

/* Calls are never folded, and a point that does not move does not make them cheaper. */
static void calls_are_of_point_time(void **state)
{
    Bench *b    = *state;
    Many   many = make_many(b);
    Node   zero = graph_vec3(b->graph, 0, 0, 0), three = graph_uint(b->graph, 3);
    Node   call = graph_instance_call(b->graph, OP_instance_distance, many.sharp, zero);
    Node   row  = graph_row(b->graph, 0, RADIUS, three);
    assert_int_equal(b->graph->items[call].op, OP_instance_distance);
    assert_int_equal(b->graph->items[call].time, TIME_POINT);
    assert_int_equal(b->graph->items[row].time, TIME_POINT);
    Tape      tape = tape_new(b->graph, &row, 1, &b->arena);
    NodeValue values[4096];
    assert_in_range(b->graph->count, 1, 4096);
    tape_run_frame(&tape, NULL, values);
    tape_run_point(&tape, (double[3]){0}, values);
    assert_true(values[row].v[0] == row_of(&b->graph->instances->tables.items[0], 3)[RADIUS]);
}

/* A call costs more than what it does for one instance, and its loop is as long as the longest list. */
static void costs_count_instances(void **state)
{
    Bench   *b       = *state;
    Many     many    = make_many(b);
    Tape     sharp   = tape_new(b->graph, &many.roots[SHARP], 1, &b->arena);
    Tape     nested  = tape_new(b->graph, &many.roots[NESTED], 1, &b->arena);
    uint32_t longest = table_of(b->graph, many.sharp)->grid.max_listed;
    uint32_t outer   = table_of(b->graph, many.nested)->grid.max_listed;
    uint32_t inner   = table_of(b->graph, many.inner)->grid.max_listed;
    assert_int_equal(tape_loops(&sharp), longest);
    assert_int_equal(tape_loops(&nested), outer * (1 + inner));
    assert_true(tape_flops(&nested) > tape_flops(&sharp));
    assert_true(tape_operations(&sharp) > sharp.count - sharp.frame_count);
}

/* ---- text ---- */

/* The distance is the sharp one with the nested one; properties come from the others. */
static Module make_module(Bench *b, Many *many)
{
    Graph *g     = b->graph;
    Node  *roots = arena_new_array(&b->arena, Node, ROOT_COUNT + 6);
    for (ComponentRoot r = 0; r < ROOT_COUNT; r++)
        roots[r] = r == ROOT_DISTANCE ? NODE_NONE : root_otherwise(g, r);
    Node nearest          = graph_op2(g, OP_min, many->roots[SHARP], many->roots[NESTED]);
    roots[ROOT_DISTANCE]  = graph_op2(g, OP_min, nearest, many->roots[SMOOTH]);
    roots[ROOT_NORMAL]    = many->roots[LEAN];
    roots[ROOT_roughness] = many->roots[SHADED];
    Node *rest            = roots + ROOT_COUNT;
    for (int i = 0; i < 6; i++)
        rest[i] = roots[ROOT_DISTANCE];
    Box *box = arena_new(&b->arena, Box);
    *box     = box_around((double[3]){0, 0, 0}, 8);
    return (Module){.graph      = g,
                    .components = 1,
                    .surfaces   = roots,
                    .guarded    = rest,
                    .along      = rest,
                    .gradients  = rest,
                    .planes     = rest,
                    .zone       = NODE_NONE,
                    .boxes      = box};
}

static char *print(Bench *b, const Module *module, const KrsVariant *variant, bool surfaces)
{
    const KrsFunction wanted[] = {KRS_FUNCTION_DISTANCE, KRS_FUNCTION_DISTANCE_LOD,
                                  KRS_FUNCTION_SURFACE};
    Text              text     = {.arena = &b->arena};
    module_print(module, variant, wanted, surfaces ? 3 : 1, &glsl_printer, &text);
    return text.bytes;
}

static int count_text(const char *text, const char *part)
{
    int count = 0;
    for (const char *at = text; (at = strstr(at, part)); at += strlen(part))
        count++;
    return count;
}

static void compile_text(Bench *b, const char *text)
{
    uint32_t *words;
    size_t    count;
    char     *log    = NULL;
    Text      shader = {.arena = &b->arena};
    text_format(&shader,
                "#version 440\nlayout(local_size_x = 8) in;\n"
                "layout(std430, set = 1, binding = 0) buffer Data { vec4 data[]; };\n%s"
                "void main() {\n    krs_prepare();\n"
                "    uint i = gl_GlobalInvocationID.x;\n    vec3 p = data[i].xyz;\n"
                "    KrsSurface s = krs_surface(p, p, 0.1);\n"
                "    data[i] = vec4(s.normal, s.roughness + s.distance + krs_distance(p) +\n"
                "                   krs_distance_lod(p, 0.1));\n}\n",
                text);
    if (spirv_compile(shader.bytes, "instance groups", &words, &count, &log) != KRS_OK)
        fail_msg("%s\n%s", log, shader.bytes);
    free(words);
    free(log);
}

/* Each function stands there once, whatever it returns, and the least are six. */
static void look_at_text(const char *text)
{
    static const char *const types[] = {"float", "uint", "vec3"};
    char                     head[64];
    int                      found = 0;
    for (int id = 0; id < 64; id++) {
        int times = 0;
        for (int i = 0; i < 3; i++) {
            snprintf(head, sizeof head, "\n%s krs_instances_%d(vec3 p", types[i], id);
            times += count_text(text, head);
        }
        assert_true(times <= 1);
        found += times;
    }
    assert_true(found >= 6);
    assert_int_equal(count_text(text, " = krs_read_table("), 4); /* of each table that is read */
    assert_int_equal(count_text(text, "uniform samplerBuffer krs_rows;"), 1);
    assert_int_equal(count_text(text, "uniform usamplerBuffer krs_cells;"), 1);
}

static void texts_hold_functions_once(void **state)
{
    Bench           *b          = *state;
    Many             many       = make_many(b);
    Module           module     = make_module(b, &many);
    Arena            scratch    = {.memory = &b->memory};
    const KrsVariant variants[] = {{0}, {.many_threads = true, .shares = true}, {.values = true}};
    module_lay_out(&module, 0, &b->arena, &scratch);
    arena_free(&scratch);
    spirv_start();
    for (size_t i = 0; i < sizeof variants / sizeof *variants; i++) {
        const char *text = print(b, &module, &variants[i], true);
        look_at_text(text);
        compile_text(b, text);
    }
    spirv_stop();
}

static void texts_hold_what_is_called(void **state)
{
    Bench           *b      = *state;
    Many             many   = make_many(b);
    Module           module = make_module(b, &many);
    const KrsVariant plain  = {0};
    const char      *text   = print(b, &module, &plain, false);
    assert_int_equal(count_text(text, "krs_instances_4(vec3 p)\n{"), 1);
    assert_null(strstr(text, "krs_instances_5"));
    assert_null(strstr(text, "krs_instances_6"));
    ((Node *)module.surfaces)[ROOT_DISTANCE] = many.roots[SHARP];
    text                                     = print(b, &module, &plain, false);
    assert_int_equal(count_text(text, "krs_instances_2(vec3 p)\n{"), 1);
    assert_null(strstr(text, "krs_instances_1"));
    assert_int_equal(count_text(text, " = krs_read_table("), 1);
    ((Node *)module.surfaces)[ROOT_DISTANCE] = b->x;
    text                                     = print(b, &module, &plain, false);
    assert_null(strstr(text, "krs_rows"));
    assert_null(strstr(text, "krs_instances_"));
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, bench_start, bench_stop)
    const struct CMUnitTest tests[] = {
        TEST(tapes_give_what_loops_give), TEST(passes_keep_functions),
        TEST(calls_are_of_point_time),    TEST(costs_count_instances),
        TEST(texts_hold_functions_once),  TEST(texts_hold_what_is_called),
    };
    return cmocka_run_group_tests_name("instance groups", tests, NULL, NULL);
}
