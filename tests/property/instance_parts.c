/*
 * instance_parts.c: random parts of CSG nodes, and CSG nodes lowered in two ways.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/property/instance_parts.h"

static Memory      memory;
Arena              arena, scratch;
static Sources     sources;
static Diags       diags;
static Parameters  parameters;
static StateSlopes slopes;
ShapeBuilder       builder;
Random             randomness;
double             now, height; /* the time, and a parameter from 0 to 1 */

int start(void **state)
{
    (void)state;
    arena = scratch = (Arena){.memory = &memory};
    now = height = 0;
    sources      = (Sources){.arena = &arena};
    diags        = (Diags){.arena = &arena, .sources = &sources};
    parameters   = (Parameters){0};
    slopes       = (StateSlopes){0};
    randomness   = (Random){7};
    builder      = (ShapeBuilder){.arena      = &arena,
                                  .scratch    = &scratch,
                                  .diags      = &diags,
                                  .graph      = graph_new(&arena),
                                  .parameters = &parameters,
                                  .slopes     = &slopes};
    return 0;
}

int finish(void **state)
{
    (void)state;
    arena_free(&arena);
    arena_free(&scratch);
    return 0;
}

/* ---- parts ---- */

static Box cube(double half) { return (Box){{{-half, half}, {-half, half}, {-half, half}}}; }

const Shape *ball(double radius)
{
    Graph *g     = builder.graph;
    Node   point = graph_leaf(g, OP_POINT), size = graph_number(g, radius);
    Node   length = graph_op1(g, OP_length, point);
    Shape *made = primitive_new(&builder, "ball", graph_op2(g, OP_sub, length, size), cube(radius),
                                no_place);
    made->exact = true;
    return made;
}

/* Returns a disc of a radius about a circle around y. */
const Shape *ring(double radius, double thick)
{
    Graph *g     = builder.graph;
    Node   point = graph_leaf(g, OP_POINT);
    Node   x = graph_component(g, point, 0), y = graph_component(g, point, 1);
    Node   z        = graph_component(g, point, 2);
    Node   flat     = graph_op1(g, OP_length, graph_op2(g, OP_vec2, x, z));
    flat            = graph_op2(g, OP_sub, flat, graph_number(g, radius));
    Node   size     = graph_op1(g, OP_length, graph_op2(g, OP_vec2, flat, y));
    Node   distance = graph_op2(g, OP_sub, size, graph_number(g, thick));
    Shape *made     = primitive_new(&builder, "ring", distance, cube(radius + thick), no_place);
    made->exact     = true;
    return made;
}

const Shape *placed(const Shape *shape, double x, double y, double z, double turn, double scale)
{
    Graph *g   = builder.graph;
    Map    map = {.scale = graph_number(g, scale),
                  .rows  = {graph_vec3(g, cos(turn), sin(turn), 0),
                            graph_vec3(g, -sin(turn), cos(turn), 0), graph_vec3(g, 0, 0, 1)},
                  .shift = graph_vec3(g, x, y, z),
                  .pole  = NODE_NONE};
    return make_transform(&builder, shape, &map, no_place);
}

double between(double low, double high) { return random_between(&randomness, low, high); }

const Shape *painted(const Shape *shape)
{
    Graph    *g        = builder.graph;
    Material *material = arena_new(&arena, Material);
#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) \
    material->name = NODE_NONE;
#include "krs/surface.def"
    double red = between(0, 1), green = between(0, 1), blue = between(0, 1);
    material->bump      = NODE_NONE;
    material->name      = "random";
    material->color     = graph_vec3(g, red, green, blue);
    material->roughness = graph_number(g, between(0, 1));
    return make_paint(&builder, shape, material, no_place);
}

static const Shape *random_part(bool paint)
{
    double       radius = between(0.1, 0.3), thick = between(0.02, 0.08);
    const Shape *shape = between(0, 1) < 0.6 ? ball(radius) : ring(radius, thick);
    double       x = between(-3, 3), y = between(-3, 3), z = between(-3, 3), turn = between(0, 6);
    shape = placed(shape, x, y, z, turn, between(0.5, 1.5));
    return paint ? painted(shape) : shape;
}

const Shape **random_parts(uint32_t count, bool paint)
{
    const Shape **parts = arena_new_array(&arena, const Shape *, count);
    for (uint32_t i = 0; i < count; i++)
        parts[i] = random_part(paint);
    return parts;
}

/* ---- what is compared ---- */

Seen lower(const Shape *shape, LoweredGroups *instances)
{
    Graph *g = builder.graph;
    Seen   seen;
    assert_true(lower_component(g, shape, 1, instances, &scratch, seen.roots, NULL));
    seen.tape = tape_new(g, seen.roots, ROOT_COUNT, &arena);
    return seen;
}

void prepare(Seen *seen)
{
    Graph     *g     = builder.graph;
    NodeValue *frame = arena_new_array(&arena, NodeValue, g->parameters.count + 1);
    seen->values     = arena_new_array(&arena, NodeValue, g->count);
    frame[0].v[0]    = now;
    if (g->parameters.count > 1)
        frame[1].v[0] = height;
    tape_run_frame(&seen->tape, frame, seen->values);
}

double look(const Seen *seen, const double p[3])
{
    static const double normal[3] = {0, 0, 1};
    tape_run_surface(&seen->tape, p, normal, 0.001, seen->values);
    return seen->values[seen->roots[ROOT_DISTANCE]].v[0];
}

double clearance_at(const double p[3])
{
    double     least = HUGE_VAL, clearance;
    uint32_t   count;
    Instances *instances = builder.graph->instances;
    for (size_t i = 0; i < instances->tables.count; i++) {
        grid_find(&instances->tables.items[i].cells, p, &count, &clearance);
        least = fmin(least, clearance);
    }
    return least;
}

static bool same_surface(const Seen *a, const Seen *b)
{
    for (int root = 0; root < ROOT_COUNT; root++)
        for (int k = 0; root != ROOT_DISTANCE && k < 3; k++)
            if (!(fabs(a->values[a->roots[root]].v[k] - b->values[b->roots[root]].v[k]) < 1e-9))
                return false;
    return true;
}

/* In the frame that is now. */
Difference compare_lowered(const Shape *shape, Seen apart, Seen group, double side)
{
    Difference found = {0};
    prepare(&apart);
    prepare(&group);
    for (int i = 0; i < POINTS; i++) {
        double p[3];
        random_vector(&randomness, side, p);
        double wanted = look(&apart, p), is = look(&group, p);
        found.above = fmax(found.above, fabs(is) - fabs(wanted));
        found.inside += wanted < 0;
        assert_true((wanted > 0) == (is > 0));
        if (fabs(wanted) * shape->slope >= clearance_at(p))
            continue;
        found.right++;
        found.below = fmax(found.below, fabs(is - wanted));
        found.other_surfaces += !same_surface(&apart, &group);
    }
    return found;
}

void assert_right(Difference found)
{
    assert_true(found.right > POINTS / 20);
    assert_true(found.inside > 0);
    assert_true(found.below <= 1e-12);
    assert_true(found.above <= 1e-12);
    assert_int_equal(found.other_surfaces, 0);
}

void assert_same(const Shape *shape, double side)
{
    LoweredGroups *instances = lowered_groups_new(builder.graph, &arena, &arena, LEAST);
    Seen           apart = lower(shape, NULL), group = lower(shape, instances);
    assert_true(builder.graph->instances->tables.count > 0);
    assert_right(compare_lowered(shape, apart, group, side));
}
