/*
 * instances_deformed.c: instance groups below deformations are what the same parts make that stay apart.
 *
 * As kernels have them, with the lists of cells: distances are right near the surface, and bounds elsewhere.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "compiler/graph/build.h"
#include "tests/property/instance_parts.h"

/* How far from the surface distances must be right. */
#define NEAR_SURFACE 0.03

typedef const Shape *Deform(const Shape *shape);

static DeformArguments about_y(double a, double b)
{
    Graph *g = builder.graph;
    return (DeformArguments){.name    = "deform",
                             .axis    = graph_vec3(g, 0, 1, 0),
                             .numbers = {graph_number(g, a), graph_number(g, b)}};
}

static const Shape *twisted(const Shape *shape)
{
    DeformArguments asked = about_y(0.3, 0);
    return make_twist(&builder, shape, &asked);
}

static const Shape *tapered(const Shape *shape)
{
    DeformArguments asked = about_y(1.2, 0.4);
    return make_taper(&builder, shape, &asked);
}

static const Shape *bent(const Shape *shape)
{
    DeformArguments asked = about_y(0.2, 0);
    asked.axis            = graph_vec3(builder.graph, 1, 0, 0);
    return make_bend(&builder, shape, &asked);
}

/* By up to 0.6. */
static const Shape *displaced(const Shape *shape)
{
    Graph          *g     = builder.graph;
    DeformArguments asked = about_y(0.6, 0);
    Node            x     = graph_component(g, graph_leaf(g, OP_POINT), 0);
    Node            wave  = graph_op1(g, OP_sin, graph_op2(g, OP_mul, x, graph_number(g, 2)));
    return make_displace(&builder, shape, wave, no_place, &asked);
}

/* Blended, so that distances below must be right farther from the surface. */
static const Shape *beside_a_ball(const Shape *shape)
{
    Blend        blend   = {BLEND_quadratic, graph_number(builder.graph, 0.5), 0, NODE_NONE};
    const Shape *parts[] = {shape, ball(2)};
    return make_csg_node(&builder, SHAPE_UNION, parts, 2, blend, no_place);
}

static const Shape *twisted_and_blended(const Shape *shape)
{
    return beside_a_ball(twisted(shape));
}

static const Shape *tapered_and_blended(const Shape *shape)
{
    return beside_a_ball(tapered(shape));
}

static const Shape *bent_and_blended(const Shape *shape) { return beside_a_ball(bent(shape)); }

static const Shape *displaced_and_blended(const Shape *shape)
{
    return beside_a_ball(displaced(shape));
}

/* The first ALONE are not blended. */
enum { ALONE = 4 };
static Deform *const deforms[] = {twisted,
                                  tapered,
                                  bent,
                                  displaced,
                                  twisted_and_blended,
                                  tapered_and_blended,
                                  bent_and_blended,
                                  displaced_and_blended};

typedef struct Found {
    double wrong; /* near the surface */
    double above; /* how much more than the distance a bound is */
    int    near, less;
} Found;

static Found compare(Seen apart, Seen group)
{
    Found found = {0};
    prepare(&apart);
    prepare(&group);
    group.tape.by_cells = true;
    for (int i = 0; i < 10 * POINTS; i++) {
        double p[3];
        random_vector(&randomness, 4, p);
        double wanted = look(&apart, p), is = look(&group, p);
        found.above = fmax(found.above, is - wanted);
        found.less += is < wanted - 1e-9;
        if (fabs(wanted) > NEAR_SURFACE)
            continue;
        found.near++;
        found.wrong = fmax(found.wrong, fabs(is - wanted));
    }
    return found;
}

/* Far parts are left out: there is more than one cell, and a bound is less than the distance somewhere,
   but for blends that reach far. */
static void instances_are_as_apart(void **state)
{
    for (size_t i = 0; i < sizeof deforms / sizeof *deforms; i++) {
        const Shape **parts = random_parts(PARTS, true);
        const Shape  *all   = make_csg_node(&builder, SHAPE_UNION, parts, PARTS, blend_sharp,
                                            no_place);
        const Shape  *whole = deforms[i](all);
        assert_non_null(whole);
        LoweredGroups *instances = lowered_groups_new(builder.graph, &arena, &arena, LEAST);
        Seen           apart = lower(whole, NULL), group = lower(whole, instances);
        for (size_t k = 0; k < builder.graph->instances->tables.count; k++)
            assert_true(grid_cell_count(&builder.graph->instances->tables.items[k].cells) > 100);
        Found found = compare(apart, group);
        assert_true(found.near > 200 && (found.less > 20 || i >= ALONE));
        assert_true(found.wrong <= 1e-12 && found.above <= 1e-12);
        finish(state);
        start(state);
    }
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, start, finish)

int main(void)
{
    const struct CMUnitTest tests[] = {TEST(instances_are_as_apart)};
    return cmocka_run_group_tests_name("instance groups below deformations", tests, NULL, NULL);
}
