/*
 * box_plan.c: boxes of shapes at the values that parameters have in a state, by the rules of their
 * kinds.
 */
#include "compiler/shape/box_plan.h"

#include <string.h>

#include "compiler/graph/bounds/facts.h"
#include "compiler/graph/op_values.h"
#include "compiler/shape/sequence_box.h"

/* Shapes that are looked at, each where it is used, and those that are planned: what a state does for
   them should take less than a millisecond. */
enum { MAX_VISITED = 1 << 16, MAX_PLANNED = 1 << 12 };
/* The stages of a sequence at most: the search for its reach takes a state some milliseconds,
   then. */
enum { MAX_STAGES = 40 };

/* The dependences of a node, as bits. */
enum { ON_PARAMETERS = 1, ON_TIME = 2 };

typedef struct Planning {
    ShapeBuilder  *builder;
    Arena         *arena;
    BoxPlan       *boxes;
    Node           leaf;    /* of iterations, which counts as the one parameter; or NODE_NONE */
    unsigned char *depends; /* by nodes, */
    size_t *places; /* where they are among those that states are asked for, from 1; 0: not yet */
    size_t  visited;
    bool    failed; /* a box that depends on the leaf has no rule */
} Planning;

/* ---- numbers ---- */

static int parameter_depends(const Planning *plan, Node node)
{
    if (plan->leaf != NODE_NONE)
        return node == plan->leaf ? ON_PARAMETERS : 0;
    return plan->builder->graph->items[node].index == 0 ? ON_TIME : ON_PARAMETERS;
}

static unsigned char *find_depends(const Planning *plan)
{
    const Graph   *graph   = plan->builder->graph;
    unsigned char *depends = arena_new_array(plan->arena, unsigned char, graph->count);
    for (Node node = 0; node < graph->count; node++) {
        const Expr *e     = &graph->items[node];
        int         found = e->op == OP_PARAMETER ? parameter_depends(plan, node) : 0;
        for (int k = 0; k < e->operand_count; k++)
            found |= depends[e->operands[k]];
        depends[node] = (unsigned char)found;
    }
    return depends;
}

static Planning planning_new(ShapeBuilder *builder, Node leaf, Arena *arena, BoxPlan *boxes)
{
    Planning plan = {.builder = builder, .arena = arena, .boxes = boxes, .leaf = leaf};
    plan.depends  = find_depends(&plan);
    plan.places   = arena_new_array(arena, size_t, builder->graph->count);
    return plan;
}

static size_t place_of(const Planning *plan, Node node)
{
    if (plan->places[node] == 0) {
        array_push(plan->arena, &plan->boxes->nodes, node);
        plan->places[node] = plan->boxes->nodes.count;
    }
    return plan->places[node] - 1;
}

static PlannedNumber plan_number(const Planning *plan, Node node)
{
    ShapeBuilder  *builder = plan->builder;
    PlannedNumber  number  = {.node = node, .asked = plan->depends[node] == ON_PARAMETERS};
    const uint32_t size    = components((GraphType)builder->graph->items[node].type);
    if (number.asked)
        number.place = place_of(plan, node);
    else
        for (uint32_t i = 0; i < size; i++)
            number.ranges[i] = node_range(builder, node, i);
    return number;
}

PlannedNumber box_plan_number(ShapeBuilder *builder, Node node, BoxPlan *boxes)
{
    const Planning plan = planning_new(builder, NODE_NONE, builder->arena, boxes);
    return plan_number(&plan, node);
}

Range planned_range(const PlannedNumber *number, uint32_t component, const Node *nodes,
                    const NodeValue *values)
{
    return number->asked && values ? range_of(values[nodes[number->place]].v[component])
                                   : number->ranges[component];
}

/* ---- shapes ---- */

/* Places for shapes that are found one after the other: the first of them. */
static size_t add_shapes(Planning *plan, size_t count)
{
    const PlannedShape none  = {.number_count = 0};
    const size_t       first = plan->boxes->shapes.count;
    for (size_t i = 0; i < count; i++)
        array_push(plan->arena, &plan->boxes->shapes, none);
    return first;
}

static bool is_sequence(const Shape *shape)
{
    return shape->kind == SHAPE_KRS && shape->stage_count <= MAX_STAGES && sequence_is_rigid(shape);
}

static const SequenceStage *copy_stages(const Shape *shape, Arena *arena)
{
    if (!is_sequence(shape))
        return NULL;
    SequenceStage *stages = arena_new_array(arena, SequenceStage, shape->stage_count + 1);
    for (uint32_t i = 0; i < shape->stage_count; i++)
        stages[i] = shape->stages[i];
    return stages;
}

/* Copies what rules look at, and nothing that is freed when the scene is made. */
static Shape shape_for_rule(const Shape *shape, Arena *arena)
{
    Shape copy       = *shape;
    copy.children    = NULL;
    copy.stages      = copy_stages(shape, arena);
    copy.within      = shape->within ? shape : NULL; /* asked for, never followed */
    copy.declaration = NULL;
    return copy;
}

static bool any_node_depends(const Planning *plan, const Node *nodes, uint32_t count)
{
    bool found = false;
    for (uint32_t i = 0; i < count; i++)
        found = found || (nodes[i] != NODE_NONE && plan->depends[nodes[i]] != 0);
    return found;
}

static bool stage_depends(const Planning *plan, const SequenceStage *stage)
{
    const Map *map = &stage->map;
    Node       nodes[MAX_BOX_NODES];
    switch (stage->kind) {
    case SEQUENCE_REFLECT: return any_node_depends(plan, (Node[]){stage->normal, stage->offset}, 2);
    case SEQUENCE_SPHERE: return any_node_depends(plan, (Node[]){stage->centre, stage->radius}, 2);
    case SEQUENCE_MAP:
        return any_node_depends(plan, nodes, map_box_nodes(map, nodes, 0)) ||
               any_node_depends(plan, &map->pole, 1);
    default: return false;
    }
}

/* Tells whether anything in the tree of a shape depends on the leaf. */
static bool any_depends(const Planning *plan, const Shape *shape)
{
    const Node others[] = {shape->distance, shape->bound, shape->formula, shape->blend.steps,
                           shape->map.scale != NODE_NONE ? shape->map.pole : NODE_NONE};
    Node       nodes[MAX_BOX_NODES];
    bool       found = any_node_depends(plan, nodes, box_nodes(shape, nodes)) ||
                 any_node_depends(plan, others, sizeof others / sizeof *others);
    for (uint32_t i = 0; i < shape->stage_count && !found; i++)
        found = stage_depends(plan, &shape->stages[i]);
    for (uint32_t i = 0; i < box_part_count(shape) && !found; i++)
        found = any_depends(plan, box_part(shape, i));
    return found || (shape->iterated && any_depends(plan, shape->iterated));
}

/* Tells whether a rule tells the box.  A search for the reach of a sequence would take too long for many
   iterations. */
static bool is_planned(const Planning *plan, const Shape *shape)
{
    return (has_box_rule(shape) || (plan->leaf == NODE_NONE && is_sequence(shape))) &&
           plan->visited <= MAX_VISITED &&
           plan->boxes->shapes.count + box_part_count(shape) <= MAX_PLANNED;
}

/* Tells whether the box depends on parameters alone; only then its parts and numbers are planned. */
static bool plan_shape(Planning *plan, const Shape *shape, size_t at)
{
    BoxPlan *boxes                = plan->boxes;
    boxes->shapes.items[at].shape = shape_for_rule(shape, plan->arena);
    plan->visited++;
    const uint32_t parts = box_part_count(shape);
    if (!is_planned(plan, shape)) {
        plan->failed = plan->failed || (plan->leaf != NODE_NONE && any_depends(plan, shape));
        return false;
    }
    Node           nodes[MAX_BOX_NODES + MAX_STAGES * MAX_STAGE_NODES];
    const uint32_t count = is_sequence(shape) ? sequence_nodes(shape, nodes)
                                              : box_nodes(shape, nodes);
    const size_t   first = add_shapes(plan, parts);
    bool           found = false;
    for (uint32_t i = 0; i < count; i++)
        found = found || plan->depends[nodes[i]] == ON_PARAMETERS;
    for (uint32_t i = 0; i < parts; i++)
        found |= plan_shape(plan, box_part(shape, i), first + i);
    if (!found) {
        boxes->shapes.count = first;
        return false;
    }
    PlannedShape *planned = &boxes->shapes.items[at];
    planned->first_part   = first;
    planned->part_count   = parts;
    planned->first_number = boxes->numbers.count;
    planned->number_count = count;
    for (uint32_t i = 0; i < count; i++) {
        const PlannedNumber number = plan_number(plan, nodes[i]);
        array_push(plan->arena, &boxes->numbers, number);
    }
    return true;
}

void box_plan_states(ShapeBuilder *builder, const Shape *const *shapes, size_t count,
                     BoxPlan *boxes)
{
    *boxes = (BoxPlan){.nodes.count = 0};
    if (builder->parameters->count == 0 || count > MAX_PLANNED)
        return;
    Planning plan    = planning_new(builder, NODE_NONE, builder->arena, boxes);
    boxes->asked_for = count;
    add_shapes(&plan, count);
    for (size_t i = 0; i < count; i++)
        plan_shape(&plan, shapes[i], i);
    if (boxes->nodes.count == 0)
        boxes->shapes.count = boxes->asked_for = 0;
}

bool box_plan_iterations(ShapeBuilder *builder, const Shape *shape, Node leaf, Arena *arena,
                         BoxPlan *boxes)
{
    *boxes        = (BoxPlan){.asked_for = 1};
    Planning plan = planning_new(builder, leaf, arena, boxes);
    add_shapes(&plan, 1);
    plan_shape(&plan, shape, 0);
    return !plan.failed;
}

BoxPlan box_plan_copy(const BoxPlan *plan, Arena *arena)
{
    BoxPlan copy       = *plan;
    copy.nodes.items   = arena_new_array(arena, Node, plan->nodes.count + 1);
    copy.numbers.items = arena_new_array(arena, PlannedNumber, plan->numbers.count + 1);
    copy.shapes.items  = arena_new_array(arena, PlannedShape, plan->shapes.count + 1);
    for (size_t i = 0; i < plan->nodes.count; i++)
        copy.nodes.items[i] = plan->nodes.items[i];
    for (size_t i = 0; i < plan->numbers.count; i++)
        copy.numbers.items[i] = plan->numbers.items[i];
    for (size_t i = 0; i < plan->shapes.count; i++) {
        PlannedShape *shape = &copy.shapes.items[i];
        *shape              = plan->shapes.items[i];
        shape->shape.stages = shape->shape.stages ? copy_stages(&shape->shape, arena) : NULL;
    }
    return copy;
}

/* ---- boxes ---- */

typedef struct Finding {
    BoxNumbers           numbers; /* those of `current` */
    const PlannedNumber *current;
    const Node          *nodes;
    const NodeValue     *values;
} Finding;

static Range range_in_state(const BoxNumbers *numbers, Node node, uint32_t component)
{
    const Finding       *finding = (const Finding *)numbers;
    const PlannedNumber *number  = finding->current;
    while (number->node != node)
        number++;
    return planned_range(number, component, finding->nodes, finding->values);
}

static Box box_by_rule(const BoxInput *in)
{
    ReachStage reach[MAX_STAGES];
    return in->shape->kind == SHAPE_KRS ? sequence_box(in, reach, NULL) : shape_box(in);
}

void box_plan_find(const BoxPlan *plan, const Node *nodes, const NodeValue *values, Box *boxes)
{
    Finding finding = {{range_in_state}, NULL, nodes, values};
    for (size_t i = plan->shapes.count; i-- > 0;) {
        const PlannedShape *planned = &plan->shapes.items[i];
        finding.current             = plan->numbers.items + planned->first_number;
        boxes[i]                    = planned->shape.box;
        if (planned->part_count + planned->number_count > 0)
            boxes[i] = box_by_rule(
                &(BoxInput){&finding.numbers, &planned->shape, boxes + planned->first_part, 1});
    }
}

void box_plan_default(ShapeBuilder *builder, const BoxPlan *plan, Box *boxes)
{
    const Graph *graph      = builder->graph;
    NodeValue   *parameters = arena_new_array(builder->arena, NodeValue, graph->parameters.count);
    NodeValue   *values     = arena_new_array(builder->arena, NodeValue, graph->count);
    const Tape   tape       = tape_new(graph, plan->nodes.items, plan->nodes.count, builder->arena);
    parameter_defaults(builder->parameters, parameters);
    tape_run_frame(&tape, parameters, values);
    box_plan_find(plan, plan->nodes.items, values, boxes);
}
