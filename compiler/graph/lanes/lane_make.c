/*
 * lane_make.c: lane tapes are made of tapes: vectors are taken apart into scalar steps.
 */
#include "compiler/graph/lanes/lanes.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "compiler/graph/bounds/numbers.h"
#include "compiler/graph/instance_table.h"
#include "compiler/graph/lanes/lane_rows.h"
#include "compiler/graph/op_values.h"

/* The components of a node, as operands of steps; NODE_NONE behind the last. */
typedef struct Parts {
    uint32_t of[4];
} Parts;

typedef struct Builder {
    const Graph *graph;
    const Tape  *tape;
    Arena       *arena;
    LaneSteps   *to;
    Parts *parts; /* by place on the tape; a frame's node that nobody has asked for is all 0 */
    const LaneBody **bodies; /* of instance functions, by their numbers */
    bool             in_body;
    Parts            of_frame; /* in a body, whose tape has no nodes of the frame: the last one */
    const double    *steepest; /* by node, as of LaneStep; NULL: it is not asked for */
} Builder;

static uint32_t add_scalar(LaneSteps *to, LaneScalar scalar)
{
    array_push(to->arena, &to->sources, scalar);
    return LANE_SCALAR | (uint32_t)(to->sources.count - 1);
}

uint32_t lane_steps_number(LaneSteps *to, double number)
{
    return add_scalar(to, (LaneScalar){NODE_NONE, 0, number});
}

uint32_t lane_steps_add(LaneSteps *to, LaneStep step)
{
    array_push(to->arena, &to->steps, step);
    return LANE_INPUTS + (uint32_t)(to->steps.count - 1);
}

static uint32_t emit(Builder *b, uint16_t op, uint32_t count, const uint32_t *operands)
{
    LaneStep step = {.op = op, .operand_count = (uint16_t)count};
    memcpy(step.operands, operands, count * sizeof *operands);
    return lane_steps_add(b->to, step);
}

static uint32_t emit1(Builder *b, uint16_t op, uint32_t x) { return emit(b, op, 1, &x); }

static uint32_t emit2(Builder *b, uint16_t op, uint32_t x, uint32_t y)
{
    return emit(b, op, 2, (uint32_t[]){x, y});
}

/* Returns the components of a node; those of the frame become scalars. */
static const Parts *parts_of(Builder *b, Node node)
{
    const Expr *e     = &b->graph->items[node];
    bool        place = !b->in_body || e->time == TIME_POINT;
    Parts      *parts = place ? &b->parts[tape_index(b->tape, node)] : &b->of_frame;
    if (place && (e->time == TIME_POINT || (parts->of[0] & LANE_SCALAR)))
        return parts;
    for (uint32_t k = 0; k < 4; k++)
        parts->of[k] = k < components(e->type) ? add_scalar(b->to, (LaneScalar){node, k, 0})
                                               : NODE_NONE;
    return parts;
}

/* ---- operations that are taken apart ---- */

/* An operation, and the components of its operands, behind the last one NODE_NONE. */
typedef struct Operands {
    const Expr     *e;
    const uint32_t *x, *y, *z, *w;
    uint32_t        size;     /* components of the first */
    double          steepest; /* of the first */
} Operands;

/* Makes the components of the result. */
typedef void MakeSteps(Builder *b, const Operands *o, uint32_t *to);

/* Tells how fast the result of a step changes at most. */
static void bound_step(Builder *b, uint32_t value, double steepest)
{
    if (value == NODE_NONE || (value & LANE_SCALAR) || value < LANE_INPUTS || !isfinite(steepest))
        return;
    LaneStep *step  = &b->to->steps.items[value - LANE_INPUTS];
    float     least = (float)(steepest * (1 + 1e-6));
    if (step->steepest == 0 || least < step->steepest)
        step->steepest = least;
}

static uint32_t emit_dot(Builder *b, const uint32_t *x, const uint32_t *y, uint32_t size)
{
    uint32_t sum = emit2(b, OP_mul, x[0], y[0]);
    for (uint32_t k = 1; k < size; k++)
        sum = emit2(b, OP_add, sum, emit2(b, OP_mul, x[k], y[k]));
    return sum;
}

static uint32_t emit_minor(Builder *b, const uint32_t *x, const uint32_t *y, int i, int k)
{
    const uint32_t less = emit2(b, OP_mul, x[k], y[i]);
    return emit2(b, OP_sub, emit2(b, OP_mul, x[i], y[k]), less);
}

/* Emits a step of a body that has no operands, but a number. */
static uint32_t emit_of_instance(Builder *b, uint16_t op, uint32_t number)
{
    return lane_steps_add(b->to, (LaneStep){.op = op, .operands = {number}});
}

static void steps_of_component(Builder *b, const Operands *o, uint32_t *to)
{
    (void)b;
    to[0] = o->x[o->e->index];
}

static void steps_of_dot(Builder *b, const Operands *o, uint32_t *to)
{
    to[0] = emit_dot(b, o->x, o->y, o->size);
}

static void steps_of_cross(Builder *b, const Operands *o, uint32_t *to)
{
    to[0] = emit_minor(b, o->x, o->y, 1, 2);
    to[1] = emit_minor(b, o->x, o->y, 2, 0);
    to[2] = emit_minor(b, o->x, o->y, 0, 1);
}

static void steps_of_rotate(Builder *b, const Operands *o, uint32_t *to)
{
    to[0] = emit_dot(b, o->y, o->x, 3);
    to[1] = emit_dot(b, o->z, o->x, 3);
    to[2] = emit_dot(b, o->w, o->x, 3);
}

static void steps_of_fold(Builder *b, const Operands *o, uint32_t *to)
{
    uint32_t beyond = emit2(b, OP_sub, emit_dot(b, o->y, o->x, 3), o->z[0]);
    bound_step(b, beyond, o->steepest); /* normals of mirrors are unit vectors */
    uint32_t depth = emit2(b, OP_max, beyond, lane_steps_number(b->to, 0));
    uint32_t twice = emit2(b, OP_mul, lane_steps_number(b->to, 2), depth);
    for (int k = 0; k < 3; k++)
        to[k] = emit2(b, OP_sub, o->x[k], emit2(b, OP_mul, twice, o->y[k]));
}

static void steps_of_front(Builder *b, const Operands *o, uint32_t *to)
{
    to[0] = emit2(b, OP_less, o->z[0], emit_dot(b, o->y, o->x, 3));
}

static void steps_of_length(Builder *b, const Operands *o, uint32_t *to)
{
    to[0] = emit(b, OP_length, o->size, o->x);
}

static void steps_of_normalize(Builder *b, const Operands *o, uint32_t *to)
{
    uint32_t length = emit(b, OP_length, o->size, o->x);
    for (uint32_t k = 0; k < o->size; k++)
        to[k] = emit2(b, OP_normalize, o->x[k], length);
}

static void steps_of_scale(Builder *b, const Operands *o, uint32_t *to)
{
    for (uint32_t k = 0; k < o->size; k++)
        to[k] = emit2(b, OP_mul, o->x[k], o->y[0]);
}

/* Makes the steps of a footprint, which is 0: lanes have no pixels. */
static void steps_of_footprint(Builder *b, const Operands *o, uint32_t *to)
{
    for (uint32_t k = 0; k < components(o->e->type); k++)
        to[k] = lane_steps_number(b->to, 0);
}

static void steps_of_row(Builder *b, const Operands *o, uint32_t *to)
{
    (void)o;
    to[0] = emit_of_instance(b, LANE_INSTANCE, 0);
}

static void steps_of_state(Builder *b, const Operands *o, uint32_t *to)
{
    for (uint32_t k = 0; k < components(o->e->type); k++)
        to[k] = emit_of_instance(b, LANE_STATE, 4 * state_of(o->e->index) + k);
}

static MakeSteps *const steps_of[OP_COUNT] = {
#define STEPS(name, function) [OP_##name] = function,
#include "compiler/graph/ops.def"
};

/* Emits an operation on the same component of each operand; operands that are FLOAT have only one. */
static void emit_each(Builder *b, const Operands *o, uint32_t *to)
{
    const uint32_t *from[] = {o->x, o->y, o->z, o->w};
    for (uint32_t k = 0; k < components(o->e->type); k++) {
        uint32_t operands[MAX_OPERANDS];
        for (uint32_t i = 0; i < o->e->operand_count; i++)
            operands[i] = from[i][1] == NODE_NONE ? from[i][0] : from[i][k];
        to[k] = emit(b, o->e->op, o->e->operand_count, operands);
    }
}

/* Emits an operation that has no steps: point by point. */
static void emit_call(Builder *b, Node node, uint32_t *to)
{
    const Expr *e    = &b->graph->items[node];
    LaneCall    call = {.node = node, .parts = components(e->type)};
    if (is_call((Op)e->op)) {
        call.body = b->bodies[(size_t)b->graph->items[e->operands[0]].number[0]];
        if (b->steepest && isfinite(b->steepest[e->operands[1]]))
            call.steepest = (float)(b->steepest[e->operands[1]] * (1 + 1e-6));
    }
    for (uint32_t k = 0; k < e->operand_count; k++)
        memcpy(call.operands[k], parts_of(b, e->operands[k])->of, sizeof call.operands[k]);
    array_push(b->arena, &b->to->calls, call);
    to[0] = emit1(b, LANE_CALL, (uint32_t)(b->to->calls.count - 1));
    for (uint32_t k = 1; k < call.parts; k++)
        to[k] = emit1(b, LANE_PART, to[0]);
}

static void emit_operation(Builder *b, Node node, const Operands *o, uint32_t *to)
{
    const Expr     *e      = o->e;
    const uint32_t *from[] = {o->x, o->y, o->z, o->w};
    if (steps_of[e->op])
        steps_of[e->op](b, o, to);
    else if (op_has_traits((Op)e->op, BUILDS))
        for (uint32_t k = 0; k < components(e->type); k++)
            to[k] = from[e->operand_count == 1 ? 0 : k][0];
    else if (number_rows[e->op].map || op_has_traits((Op)e->op, COMPONENTWISE))
        emit_each(b, o, to);
    else
        emit_call(b, node, to);
}

/* Emits, in a body, a number of the instance's own row. */
static bool emit_row(Builder *b, const Expr *e, uint32_t *to)
{
    if (e->op != OP_row || !b->in_body || b->graph->items[e->operands[1]].op != OP_INSTANCE_ROW)
        return false;
    uint32_t id = (uint32_t)b->graph->items[e->operands[0]].number[0];
    to[0]       = emit_of_instance(b, LANE_ROW, row_column(id));
    return true;
}

/* Leaves that are no input have the same value everywhere, or are numbers of the instance. */
static void emit_leaf(Builder *b, const Expr *e, uint32_t *to)
{
    static const struct {
        bool    has;
        uint8_t first;
    } inputs[OP_COUNT] = {
#define INPUT(name, input) [OP_##name] = {true, input},
#include "compiler/graph/ops.def"
    };
    assert(b->in_body || !is_of_instances((Op)e->op));
    if (steps_of[e->op]) {
        steps_of[e->op](b, &(Operands){.e = e}, to);
        return;
    }
    const NodeValue same = inputs[e->op].has ? number(0) : leaf_unseen(e);
    for (uint32_t k = 0; k < components(e->type); k++)
        to[k] = inputs[e->op].has ? inputs[e->op].first + k : lane_steps_number(b->to, same.v[k]);
}

static void emit_node(Builder *b, size_t place)
{
    Node        node            = b->tape->nodes[place];
    const Expr *e               = &b->graph->items[node];
    uint32_t    to[4]           = {NODE_NONE, NODE_NONE, NODE_NONE, NODE_NONE};
    const Parts nothing         = {{NODE_NONE, NODE_NONE, NODE_NONE, NODE_NONE}};
    Parts       o[MAX_OPERANDS] = {nothing, nothing, nothing, nothing};
    for (uint32_t k = 0; k < e->operand_count; k++)
        o[k] = *parts_of(b, e->operands[k]);
    Operands operands = {e, o[0].of, o[1].of, o[2].of, o[3].of, 0, HUGE_VAL};
    if (e->operand_count == 0) {
        emit_leaf(b, e, to);
    } else if (!emit_row(b, e, to)) {
        operands.size = components(b->graph->items[e->operands[0]].type);
        if (b->steepest)
            operands.steepest = b->steepest[e->operands[0]];
        emit_operation(b, node, &operands, to);
        for (uint32_t k = 0; b->steepest && k < 4; k++)
            bound_step(b, to[k], b->steepest[node]);
    }
    memcpy(b->parts[place].of, to, sizeof to);
}

/* ---- outputs ---- */

static void add_outputs(Builder *b, Node root)
{
    const Parts *parts = parts_of(b, root);
    for (uint32_t k = 0; k < components(b->graph->items[root].type); k++)
        array_push(b->arena, &b->to->outputs, parts->of[k]);
}

/* Emits the distance of a scene as queries find it: the least of the first ones, cut by the
   others. */
static uint32_t emit_least(Builder *b, const Node *roots, size_t count, size_t cuts)
{
    assert(count > cuts);
    for (size_t i = 0; i < count - cuts; i++) {
        const uint32_t root = parts_of(b, roots[i])->of[0];
        if (!(root & LANE_SCALAR) && root >= LANE_INPUTS)
            b->to->steps.items[root - LANE_INPUTS].component = true;
    }
    uint32_t least = parts_of(b, roots[0])->of[0];
    for (size_t i = 1; i < count - cuts; i++)
        least = emit2(b, LANE_LESSER, least, parts_of(b, roots[i])->of[0]);
    for (size_t i = count - cuts; i < count; i++)
        least = emit2(b, LANE_GREATER, least, parts_of(b, roots[i])->of[0]);
    return least;
}

static void emit_nodes(Builder *b)
{
    b->parts = arena_new_array(b->arena, Parts, b->tape->count + 1);
    for (size_t i = b->tape->frame_count; i < b->tape->count; i++)
        emit_node(b, i);
}

/* ---- bodies ---- */

/* Makes the body of an instance function; those that it calls have smaller numbers, and bodies already. */
static LaneBody *make_body(const Tape *tape, uint32_t id, const LaneBody **bodies, Arena *arena)
{
    const Instances        *instances = tape->graph->instances;
    const InstanceFunction *function  = &instances->functions.items[id];
    LaneBody               *body      = arena_new(arena, LaneBody);
    LaneSteps               steps     = {.arena = arena};
    Builder                 b         = {.graph   = tape->graph,
                                         .tape    = &tape->functions[id],
                                         .arena   = arena,
                                         .to      = &steps,
                                         .bodies  = bodies,
                                         .in_body = true};
    emit_nodes(&b);
    for (uint32_t k = 0; k < function->state_count; k++)
        add_outputs(&b, instances->bodies.items[function->first_body + k]);
    body->tape     = lane_steps_finish(&steps, b.tape);
    body->function = id;
    body->table    = function->table_number;
    return body;
}

/* Gives bodies rows behind those of the tape.  Returns where they end. */
static uint32_t place_bodies(const LaneTape *made, const Tape *tape, LaneBody **bodies)
{
    uint32_t end = (uint32_t)lane_max_rows(made);
    for (uint32_t id = 0; id < tape->function_count; id++)
        if (bodies[id]) {
            bodies[id]->first_row = end;
            end += bodies[id]->tape.rows + (uint32_t)bodies[id]->tape.scalar_count / LANES + 1;
        }
    return tape->function_count ? end : 0;
}

static LaneTape make(const Tape *tape, const Node *roots, size_t root_count, bool least,
                     size_t cuts, const double *steepest, Arena *arena)
{
    LaneSteps  steps  = {.arena = arena};
    LaneBody **bodies = arena_new_array(arena, LaneBody *, tape->function_count + 1);
    Builder    b      = {.graph    = tape->graph,
                         .tape     = tape,
                         .arena    = arena,
                         .to       = &steps,
                         .bodies   = (const LaneBody **)bodies,
                         .steepest = steepest};
    assert(!tape->skips);
    for (uint32_t id = 0; id < tape->function_count; id++)
        if (tape->functions[id].graph)
            bodies[id] = make_body(tape, id, b.bodies, arena);
    emit_nodes(&b);
    if (least)
        array_push(arena, &steps.outputs, emit_least(&b, roots, root_count, cuts));
    for (size_t i = 0; i < root_count; i++)
        add_outputs(&b, roots[i]);
    for (size_t i = 0; i < steps.steps.count; i++)
        steps.steps.items[i].kin = steps.steps.items[i].origin = (uint32_t)i + 1;
    LaneTape made   = lane_steps_finish(&steps, tape);
    made.bodies_end = place_bodies(&made, tape, bodies);
    return made;
}

LaneTape lane_tape_new(const Tape *tape, const Node *roots, size_t root_count, bool least,
                       size_t cuts, Arena *arena)
{
    return make(tape, roots, root_count, least, cuts, NULL, arena);
}

LaneTape lane_tape_new_steep(const Tape *tape, const Node *roots, size_t root_count, bool least,
                             size_t cuts, Arena *arena)
{
    return make(tape, roots, root_count, least, cuts, lane_steepest(tape->graph, arena), arena);
}

void lane_tape_scalars(const LaneTape *tape, const NodeValue *values, double *scalars)
{
    for (size_t i = 0; i < tape->scalar_count; i++) {
        const LaneScalar *source = &tape->sources[i];
        scalars[i]               = source->node == NODE_NONE ? source->number
                                                             : values[source->node].v[source->component];
    }
}
