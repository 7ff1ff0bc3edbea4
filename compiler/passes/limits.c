/*
 * limits.c: refuses scenes that have numbers which are not finite in single precision, and shaders of scenes that
 * are too large for these.
 *
 * The size of shaders is limited because drivers compile large ones slowly: a million bytes take about ten
 * seconds, two million three times as long.  Who needs none, such as meshes and lanes of the host, goes on.
 */
#include <float.h>
#include <math.h>
#include <string.h>

#include "compiler/passes/compilation.h"
#include "compiler/graph/instance_table.h"
#include "compiler/graph/bounds/facts.h"
#include "compiler/lower/context.h"

enum { MAX_OPERATIONS = 20000, MAX_GLSL_BYTES = 1500000 };

static const char fewer_shapes[] =
    "fewer shapes, reflections or copies; parts of a union that differ in constants alone count "
    "once.  Meshes, sections, grids and answers, and previews by `--rays lanes`, need no shader";

/* ---- operations ---- */

/* Returns the number of operations at each point; those that depend on the frame only do not
   count. */
static size_t count_operations(Compilation *c, const Node *roots, size_t count)
{
    Tape   tape   = tape_new(c->scene->graph, roots, count, &c->scratch);
    size_t result = tape_operations(&tape);
    arena_free(&c->scratch);
    return result;
}

/* The primitive with most operations in a tree, of the first few. */
typedef struct Heaviest {
    const Shape *shape;
    size_t       operations, looked_at;
} Heaviest;

static void find_heaviest(Compilation *c, const Shape *shape, Heaviest *heaviest)
{
    enum { MAX_LOOKED_AT = 200 };
    if (++heaviest->looked_at > MAX_LOOKED_AT)
        return;
    if (shape->kind == SHAPE_PRIMITIVE && shape->distance != NODE_NONE) {
        Tape   tape       = tape_new(c->elaborated.graph, &shape->distance, 1, &c->scratch);
        size_t operations = tape_operations(&tape);
        arena_free(&c->scratch);
        if (operations > heaviest->operations) {
            heaviest->operations = operations;
            heaviest->shape      = shape;
        }
    }
    for (uint32_t i = 0; i < shape->child_count; i++)
        find_heaviest(c, shape->children[i], heaviest);
}

/* Names a single shape that is most of a component that is too large. */
static void blame_heaviest(Compilation *c, Diag *diag, const Component *component)
{
    Heaviest heaviest = {0};
    find_heaviest(c, component->shape, &heaviest);
    if (heaviest.operations < MAX_OPERATIONS / 2)
        return;
    const Shape *shape = heaviest.shape;
    diag_secondary(
        &c->of_shaders, diag, shape->span,
        diag_text(&c->diags, "this `%s` has %zu of them", shape->name, heaviest.operations));
    diag->help =
        strcmp(shape->name, "polygon") == 0
            ? "corners that depend on a `param` or on `time` count one by one, and known ones "
              "hardly at all: let the `param` move or scale the whole polygon"
            : "make this shape of smaller ones, joined by `|`: where they are far, they are "
              "skipped";
}

void refuse_component(Compilation *c, size_t component)
{
    const Component *shown = &c->elaborated.components.items[component];
    Diag            *diag  = diag_add(&c->diags, DIAG_TOO_LARGE, shown->span,
                                      "the scene needs more than %d operations", MAX_LOWERED);
    diag->label            = diag_text(&c->diags, "`%s` alone needs more", shown->name);
    diag->help = "fewer shapes, reflections or copies; parts of a union that differ in constants "
                 "alone count once";
}

static void refuse_shaders_of_component(Compilation *c, size_t component, size_t operations)
{
    const Component *shown = &c->elaborated.components.items[component];
    Diag            *diag  = diag_add(&c->of_shaders, DIAG_TOO_LARGE, shown->span,
                                      "the scene needs more than %d operations", MAX_OPERATIONS);
    diag->label = diag_text(&c->diags, "`%s` is the largest component, with %zu", shown->name,
                            operations);
    diag->help  = fewer_shapes;
    blame_heaviest(c, diag, shown);
}

static void refuse_shaders_of_zones(Compilation *c, size_t operations)
{
    Span  span  = c->scene->graph->items[zone_root(c->scene)].span;
    Diag *diag  = diag_add(&c->of_shaders, DIAG_TOO_LARGE, span,
                           "the scene needs more than %d operations", MAX_OPERATIONS);
    diag->label = diag_text(&c->diags, "its %zu zones need %zu", c->elaborated.zone_count,
                            operations);
    diag->help  = "fewer zones";
}

/* Sets c->operations: those of each component and, behind them, of the zones. */
static void count_all_operations(Compilation *c)
{
    const Roots *roots = &c->scene->roots;
    size_t       count = c->elaborated.components.count;
    RootRange    zones = roots_of(roots, ROOTS_ZONE);
    c->operations      = arena_new_array(&c->work, size_t, count + 1);
    for (size_t i = 0; i < count; i++) {
        Node distance    = distance_root(roots, i);
        c->operations[i] = count_operations(c, &distance, 1);
    }
    c->operations[count] = zones.count ? count_operations(c, zones.items, zones.count) : 0;
}

static size_t total_operations(const Compilation *c)
{
    size_t total = 0;
    for (size_t i = 0; i <= c->elaborated.components.count; i++)
        total += c->operations[i];
    return total;
}

static void check_operations(Compilation *c)
{
    size_t count = c->elaborated.components.count, largest = 0, most = 0;
    count_all_operations(c);
    if (total_operations(c) <= MAX_OPERATIONS)
        return;
    for (size_t i = 0; i < count; i++)
        if (c->operations[i] > most) {
            most    = c->operations[i];
            largest = i;
        }
    if (c->operations[count] > most)
        refuse_shaders_of_zones(c, c->operations[count]);
    else
        refuse_shaders_of_component(c, largest, most);
}

/* ---- numbers ---- */

/* Tells whether a node is a constant beyond the range of single precision, or an operation on constants.
   The latter would have been folded if its result were finite. */
static bool is_beyond_numbers(const Graph *graph, const Expr *expr)
{
    bool constants = expr->operand_count > 0 && !op_has_traits((Op)expr->op, READS_TABLES);
    bool too_large = false;
    for (uint32_t i = 0; i < expr->operand_count; i++)
        constants = constants && graph->items[expr->operands[i]].op == OP_CONSTANT;
    for (uint32_t i = 0; i < 4 && expr->op == OP_CONSTANT; i++)
        too_large = too_large || !(fabs(expr->number[i]) <= FLT_MAX);
    return constants || too_large;
}

static void refuse_number(Compilation *c, const Component *shown, Span span)
{
    Diag *diag  = diag_add(&c->diags, DIAG_NOT_A_NUMBER, shown->span,
                           "a number in `%s` is too large, or not finite", shown->name);
    diag->label = "single precision goes to 3.4e38";
    /* Equal expressions share a node, so its span may be in another component. */
    if (span.source == shown->span.source && span.start > shown->span.start &&
        span.end <= shown->span.end)
        diag_secondary(&c->diags, diag, span, "in here");
}

/* Finds the first node beyond numbers at points and in frames, in functions of instance groups too. */
static Node first_beyond_numbers(const Tape *tape)
{
    Node found = NODE_NONE;
    for (size_t k = 0; k < tape->count; k++)
        if (is_beyond_numbers(tape->graph, &tape->graph->items[tape->nodes[k]]))
            return tape->nodes[k];
    for (uint32_t id = 0; id < tape->function_count && found == NODE_NONE; id++)
        found = first_beyond_numbers(&tape->functions[id]);
    return found;
}

/* Returns the first node of some components that is_beyond_numbers, or NODE_NONE. */
static Node find_overflow(Compilation *c, size_t first, size_t count)
{
    Tape tape  = tape_new(c->scene->graph, surface_roots(&c->scene->roots, first),
                          count * ROOT_COUNT, &c->scratch);
    Node found = first_beyond_numbers(&tape);
    arena_free(&c->scratch);
    return found;
}

/* Tells whether a component was written where a span is, or around it. */
static bool is_around(const Component *shown, Span span)
{
    return shown->span.source == span.source && shown->span.start <= span.start &&
           shown->span.end >= span.end;
}

/* Refuses tables with numbers that single precision does not have; they belong to the component around
   them, or else to the first. */
static bool check_tables(Compilation *c)
{
    const Instances *instances  = c->scene->graph->instances;
    const Component *components = c->elaborated.components.items;
    for (size_t t = 0; instances && t < instances->tables.count; t++) {
        const InstanceTable *table = &instances->tables.items[t];
        size_t               i = 0, of = 0, count = (size_t)table->rows * table->columns;
        while (i < count && fabs(table->numbers[i]) <= FLT_MAX)
            i++;
        if (i == count)
            continue;
        while (of < c->elaborated.components.count && !is_around(&components[of], table->span))
            of++;
        refuse_number(c, &components[of < c->elaborated.components.count ? of : 0], table->span);
        return false;
    }
    return true;
}

/* Refuses numbers that overflow in the simplified graph, where all constants have been combined. */
static bool check_numbers(Compilation *c)
{
    size_t count = c->elaborated.components.count;
    if (find_overflow(c, 0, count) == NODE_NONE)
        return true;
    for (size_t i = 0; i < count; i++) {
        Node node = find_overflow(c, i, 1);
        if (node != NODE_NONE)
            refuse_number(c, &c->elaborated.components.items[i], c->scene->graph->items[node].span);
    }
    return false;
}

/* ---- what is a number nowhere ---- */

/* Roots and logarithms of what differs from point to point, which are no numbers below 0. */
static bool needs_positive(const Expr *expr)
{
    bool root = expr->op == OP_sqrt || expr->op == OP_inversesqrt;
    return (root || expr->op == OP_log || expr->op == OP_log2) && expr->time == TIME_POINT &&
           expr->type == TYPE_FLOAT;
}

/* Returns what an expression can be, at all points and for all values of the parameters. */
static Range range_everywhere(Compilation *c, Node node)
{
    RangeTask task = range_task(c->scene->graph, &node, 1, &c->scratch);
    range_task_run(&task, box_infinite);
    return range_task_value(&task, node);
}

/* Returns the first root or logarithm of a tape that is a number nowhere, or NODE_NONE; few are
   looked at, for a mistake like this is soon met with. */
static Node first_undefined(Compilation *c, const Tape *tape, double *most)
{
    enum { MAX_LOOKED_AT = 64 };
    size_t looked_at = 0;
    for (size_t i = tape->frame_count; i < tape->count && looked_at < MAX_LOOKED_AT; i++) {
        const Expr *expr = &tape->graph->items[tape->nodes[i]];
        if (!needs_positive(expr))
            continue;
        looked_at++;
        *most = range_everywhere(c, expr->operands[0]).high;
        if (*most < 0)
            return tape->nodes[i];
    }
    return NODE_NONE;
}

static bool check_domains(Compilation *c)
{
    const Graph *graph = c->scene->graph;
    double       most  = 0;
    Tape         tape  = tape_new(graph, surface_roots(&c->scene->roots, 0),
                                  c->elaborated.components.count * ROOT_COUNT, &c->scratch);
    Node         node  = first_undefined(c, &tape, &most);
    arena_free(&c->scratch);
    if (node == NODE_NONE)
        return true;
    Diag *diag  = diag_add(&c->diags, DIAG_NOT_A_NUMBER, graph->items[node].span,
                           "`%s` of what is negative at all points",
                           graph_op_name((Op)graph->items[node].op));
    diag->label = diag_text(&c->diags, "a number nowhere: what it is taken of is at most %.3g",
                            most);
    return false;
}

KrsStatus pass_limits(Compilation *c)
{
    check_operations(c);
    const bool good = check_numbers(c) && check_tables(c) && check_domains(c);
    return good ? KRS_OK : KRS_BAD_SCENE;
}

void print_limits(Compilation *c, Text *out)
{
    size_t count = c->elaborated.components.count;
    for (size_t i = 0; i < count; i++)
        text_format(out, "%s  %zu operations\n", c->elaborated.components.items[i].name,
                    c->operations[i]);
    if (c->elaborated.zone_count > 0)
        text_format(out, "zones  %zu operations\n", c->operations[count]);
    text_format(out, "all  %zu operations of %d\n", total_operations(c), MAX_OPERATIONS);
}

/* ---- the first frame ---- */

/* Returns the first component that uses a node; NULL if only a camera, a light or the sky does. */
static const Component *component_with(Compilation *c, Node node)
{
    for (size_t i = 0; i < c->elaborated.components.count; i++) {
        const Node *roots = surface_roots(&c->scene->roots, i);
        Tape        tape  = tape_new(c->scene->graph, roots, ROOT_COUNT, &c->scratch);
        for (size_t k = 0; k < tape.count; k++)
            if (tape.nodes[k] == node)
                return &c->elaborated.components.items[i];
    }
    return NULL;
}

static void refuse_default(Compilation *c, Node node)
{
    Span             span  = c->scene->graph->items[node].span;
    const Component *shown = component_with(c, node);
    bool             ours  = span.source == 0 || c->sources.items[span.source].library;
    Diag *diag  = diag_add(&c->diags, DIAG_NOT_A_NUMBER, ours && shown ? shown->span : span,
                           "this is not finite with the default of every `param` at time 0");
    diag->label = ours ? "a number in here divides by zero, or overflows"
                       : "a division by zero, or an overflow";
    diag->help  = "choose another default, or guard it, as in `1 / max(a, 0.001)`";
    arena_free(&c->scratch);
}

/* A cell of a medium in which the density has no bound. */
typedef struct UnboundedCell {
    KrsVolume volume;
    uint32_t  at[3];
} UnboundedCell;

enum { SIDE_OF_VOLUMES = 8 }; /* of media that are looked at, in cells */

/* Returns the number of a medium whose density has no bound somewhere, as near a pole; that of all media: there
   is none. */
static size_t find_unbounded(const Compilation *c, KrsState *state, float (*bounds)[2],
                             UnboundedCell *cell)
{
    size_t i = 0;
    for (; i < c->scene->volume_count; i++) {
        cell->volume = krs_scene_volume(c->scene, i);
        for (int k = 0; k < 3; k++)
            cell->volume.cells[k] = SIDE_OF_VOLUMES;
        if (state_volume(state, i, &cell->volume, bounds, cell->at) == KRS_BAD_SCENE)
            break;
    }
    return i;
}

static void refuse_volume(Compilation *c, size_t number, const UnboundedCell *cell)
{
    double middle[3];
    for (int k = 0; k < 3; k++)
        middle[k] = cell->volume.low[k] + (cell->at[k] + 0.5) / SIDE_OF_VOLUMES *
                                              (cell->volume.high[k] - cell->volume.low[k]);
    Diag *diag  = diag_add(&c->diags, DIAG_BAD_VALUE, c->elaborated.volumes.items[number].span,
                           "the density of a medium has no bound");
    diag->label = diag_text(&c->diags, "none near [%.3g, %.3g, %.3g]", middle[0], middle[1],
                            middle[2]);
    diag->help  = "limit it, as in `min(1 / length(p), 100)`";
}

/* Refuses a scene that is not finite at time 0 with all defaults, the first frame of all
   callers. */
static KrsStatus check_defaults(Compilation *c)
{
    const size_t  volumes = c->scene->volume_count;
    UnboundedCell cell;
    float(*bounds)[2] = arena_alloc(
        &c->scratch, volumes ? SIDE_OF_VOLUMES * SIDE_OF_VOLUMES * SIDE_OF_VOLUMES : 1,
        sizeof *bounds);
    KrsState *state;
    KrsStatus status = state_new(c->scene, &state);
    if (status != KRS_OK)
        return status;
    Node   node      = state_infinite(state);
    size_t unbounded = node == NODE_NONE ? find_unbounded(c, state, bounds, &cell) : volumes;
    state_free(state);
    if (node != NODE_NONE)
        refuse_default(c, node);
    if (unbounded < volumes)
        refuse_volume(c, unbounded, &cell);
    return node == NODE_NONE && unbounded == volumes ? KRS_OK : KRS_BAD_SCENE;
}

/* ---- text ---- */

static void refuse_length_of_shaders(Compilation *c, size_t largest, size_t operations)
{
    size_t           count = c->elaborated.components.count;
    const Component *shown = count ? &c->elaborated.components.items[largest] : NULL;
    Diag *diag = diag_add(&c->of_shaders, DIAG_TOO_LARGE, shown ? shown->span : (Span){1, 0, 0},
                          "the scene needs %.1f MB of shader; the limit is %.1f MB",
                          (double)c->scene->program.glsl_length * 1e-6, MAX_GLSL_BYTES * 1e-6);
    if (count > 1)
        diag->label = diag_text(&c->diags, "the largest of %zu components, with %zu operations",
                                count, operations);
    else if (shown)
        diag->label = diag_text(&c->diags, "`%s` has %zu operations", shown->name, operations);
    diag->help = count > 100 ? "`show union([...])` makes one component of many shapes"
                             : fewer_shapes;
}

/* Limits the text in addition to the operations: many small components have few operations but much
   text. */
static void check_length(Compilation *c)
{
    size_t largest = 0, most = 0;
    if (c->scene->program.glsl_length <= MAX_GLSL_BYTES)
        return;
    arena_free(&c->scratch);
    for (size_t i = 0; i < c->elaborated.components.count; i++) {
        const Node *roots      = surface_roots(&c->scene->roots, i);
        size_t      operations = count_operations(c, roots, ROOT_COUNT);
        largest                = operations > most ? i : largest;
        most                   = operations > most ? operations : most;
    }
    refuse_length_of_shaders(c, largest, most);
}

KrsStatus pass_check(Compilation *c)
{
    check_length(c);
    return check_defaults(c);
}

void print_check(Compilation *c, Text *out)
{
    const KrsProgram *program = &c->scene->program;
    text_format(out, "shader  %zu bytes of %d\n", program->glsl_length, MAX_GLSL_BYTES);
    text_format(out, "first frame  finite in %u slots of parameters and %u of values\n",
                program->parameter_slots, program->value_slots);
}
