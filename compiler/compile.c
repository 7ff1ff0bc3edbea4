/*
 * compile.c: the whole compiler: each step of run() turns one form of the scene into the next.
 */
#include "compiler/compile.h"

#include <errno.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

#include "compiler/framing.h"
#include "compiler/front/parse.h"
#include "compiler/geometry/elaborate.h"
#include "compiler/graph/anchor.h"
#include "compiler/graph/derive.h"
#include "compiler/inspect.h"
#include "compiler/program.h"
#include "compiler/shader/emit.h"

/* Drivers take some ten seconds for a million bytes of shader, and three times as long for two. */
enum { MOST_OPERATIONS = 20000, MOST_GLSL_BYTES = 1500000, MOST_SOURCE_BYTES = 16 << 20 };

static const char fewer_shapes[] =
    "fewer shapes, reflections or copies; `.repeat` with a margin in its cells needs one copy only";

/* Components of so many flops are marched by themselves, in scenes of so many: as bench/krs.c
   found.  Less is gained where their boxes lie within each other. */
static const double HEAVY_FLOPS = 100, SCATTERED_FLOPS = 1000, MIXED_FLOPS = 2000;

static const size_t DEFAULT_MEMORY = (size_t)2 << 30;

const char *const dump_stage_names[DUMP_STAGE_COUNT] = {
    "tokens", "syntax", "scene", "graph", "simplify", "glsl"};

/* What is wanted beside the scene. */
typedef struct Request {
    DumpStage stage; /* DUMP_STAGE_COUNT: nothing is dumped */
    char    **dump;
    Inspect  *inspect; /* or NULL */
    void     *user;
} Request;
static const Request scene_alone = {.stage = DUMP_STAGE_COUNT};

/* One run of the compiler: three arenas for three lifetimes.  `kept` stays with the scene,
   `work` holds sources, diagnostics, the syntax tree and the elaborated scene until the end of
   the run, `scratch` what one step needs. */
typedef struct Compilation {
    KrsScene  *scene;
    Arena      work, syntax, scratch;
    Sources    sources;
    Names      names;
    Diags      diags;
    Scene      elaborated;
    Node      *roots;
    size_t     root_count, point_roots; /* the first of them are point time */
    const char *text, *name;
    size_t     length;
    const Request    *request;
    const KrsOptions *options;
    Text       dump;
    double     started;
} Compilation;

static double now_ms(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

static bool dumps(const Compilation *c, DumpStage stage) { return c->request->stage == stage; }

/* ---- files ---- */

/* The whole of a regular file, malloc'ed; NULL with *reason (a static text). */
static char *read_whole(const char *path, size_t *length, const char **reason)
{
    struct stat about;
    FILE       *file = fopen(path, "rb");
    char       *text = NULL;
    *reason = strerror(errno);
    if (!file)
        return NULL;
    if (fstat(fileno(file), &about) == 0 && S_ISDIR(about.st_mode)) {
        *reason = "it is a folder";
        fclose(file);
        return NULL;
    }
    size_t capacity = 0;
    *length         = 0;
    for (;;) {
        if (*length == capacity) {
            capacity     = capacity ? 2 * capacity : 16384;
            char *larger = capacity <= 4u * MOST_SOURCE_BYTES ? realloc(text, capacity) : NULL;
            *reason      = "it is too large";
            if (!larger)
                break;
            text = larger;
        }
        size_t count = fread(text + *length, 1, capacity - *length, file);
        *length += count;
        if (count == 0) {
            *reason = ferror(file) ? "an error while reading" : NULL;
            break;
        }
    }
    fclose(file);
    if (*reason) {
        free(text);
        text = NULL;
    }
    return text;
}

/* 64-bit FNV-1a (Fowler, Noll, Vo) of all sources that are not the library's. */
static void hash_sources(const Sources *sources, char hash[17])
{
    uint64_t h = 0xcbf29ce484222325u;
    for (size_t i = 1; i < sources->count; i++)
        for (uint32_t k = 0; !sources->items[i].library && k < sources->items[i].length; k++)
            h = (h ^ (uint8_t)sources->items[i].text[k]) * 0x100000001b3u;
    snprintf(hash, 17, "%016llx", (unsigned long long)h);
}

/* ---- steps ---- */

static void dump_front(Compilation *c, uint32_t source)
{
    if (!dumps(c, DUMP_TOKENS) && !dumps(c, DUMP_SYNTAX))
        return;
    Diags  silent = {.arena = &c->scratch, .sources = &c->sources};
    Tokens tokens = lex(source, &c->sources, &c->names, &silent, &c->scratch);
    if (dumps(c, DUMP_TOKENS))
        tokens_print(&tokens, &c->sources, &c->dump);
    else
        syntax_print(parse(&tokens, &silent, &c->scratch), &c->sources, &c->dump);
}

static Graph *elaborate_scene(Compilation *c)
{
    uint32_t source = source_add(&c->sources, c->name, c->text, c->length, false);
    dump_front(c, source);
    Graph *graph        = graph_new(&c->work);
    c->elaborated       = (Scene){.graph = graph, .zenith = NODE_NONE, .zone = NODE_NONE};
    Elaboration e       = {.arena      = &c->work,
                           .syntax     = &c->syntax,
                           .scratch    = &c->scratch,
                           .diags      = &c->diags,
                           .names      = &c->names,
                           .sources    = &c->sources,
                           .graph      = graph,
                           .scene      = &c->elaborated,
                           .read_file  = read_whole,
                           .text_total = c->length};
    elaborate(&e, source, c->name);
    arena_free(&c->scratch);
    if (dumps(c, DUMP_SCENE) && c->diags.errors == 0)
        scene_print(&c->elaborated, &c->sources, &c->dump);
    return graph;
}

/* Operations at each point: what depends on the frame only does not count. */
static size_t count_operations(const Graph *graph, const Node *roots, size_t count, Arena *scratch)
{
    Tape tape = tape_new(graph, roots, count, scratch);
    return tape.count - tape.frame_count;
}

/* `operations`: of that component; 0 when they were too many to be counted. */
static void refuse_size(Compilation *c, size_t component, size_t operations)
{
    const Component *shown = &c->elaborated.components.items[component];
    Diag *diag  = diag_add(&c->diags, DIAG_TOO_LARGE, shown->span,
                           "the scene needs more than %d operations", MOST_OPERATIONS);
    diag->label = operations ? diag_text(&c->diags, "`%s` is the largest component, with %zu",
                                         shown->name, operations)
                             : diag_text(&c->diags, "`%s` alone needs more", shown->name);
    diag->help  = fewer_shapes;
}

static void refuse_zones(Compilation *c, Span span, size_t operations)
{
    Diag *diag  = diag_add(&c->diags, DIAG_TOO_LARGE, span,
                           "the scene needs more than %d operations", MOST_OPERATIONS);
    diag->label = diag_text(&c->diags, "its %zu zones need %zu", c->elaborated.zone_count,
                            operations);
    diag->help  = "fewer zones";
}

static bool is_flat(const Component *component) { return component->plane_normal != NODE_NONE; }

/*
 * Components that are half-spaces need no march: a ray from p along d enters the one with n.x <= w
 * at (w - n.p) / n.d, if n.d < 0.  The first root is the least of these, the second the least n.d.
 * Where there are zones, planes have holes, and are marched like the rest.
 */
static void lower_flats(Compilation *c, Graph *g, Node roots[FLAT_ROOTS])
{
    const Scene *s     = &c->elaborated;
    Node         point = graph_leaf(g, OP_POINT), direction = graph_leaf(g, OP_DIRECTION);
    Node         far = graph_number(g, 1e30), zero = graph_number(g, 0);
    roots[0]           = far;
    roots[1]           = graph_number(g, 1);
    for (size_t i = 0; i < s->components.count && s->zone_count == 0; i++) {
        const Component *component = &s->components.items[i];
        if (!is_flat(component))
            continue;
        c->scene->program.flats = true;
        Node rise  = graph_op2(g, OP_dot, component->plane_normal, direction);
        Node depth = graph_op2(g, OP_dot, component->plane_normal, point);
        Node room  = graph_op2(g, OP_sub, component->plane_offset, depth);
        Node falls = graph_op2(g, OP_less, rise, zero);
        Node way   = graph_op3(g, OP_select, falls, graph_op2(g, OP_div, room, rise), far);
        roots[0]   = graph_op2(g, OP_min, roots[0], way);
        roots[1]   = graph_op2(g, OP_min, roots[1], rise);
    }
}

/* Whether rays go by roots of polynomials and nothing has many levels: then derivatives cost less
   than the differences of a bound, which is no better than its series. */
static bool is_algebraic(const Compilation *c)
{
    const Scene *s = &c->elaborated;
    const Node  *exact = &c->roots[c->root_count + (1 + ALONG_EXACT) * s->components.count];
    bool         found = false;
    for (size_t i = 0; i < s->components.count; i++) {
        const Shape *shape = s->components.items[i].shape;
        if (shape->levels > 0 || shape->inversions > 0)
            return false;
        found = found || exact[i] != c->roots[i * ROOT_COUNT + ROOT_DISTANCE];
    }
    return found;
}

/* Of components and of the zones, where they are asked for or the best there is. */
static void lower_gradients(Compilation *c, Graph *g, Node *roots)
{
    const Scene *s = &c->elaborated;
    bool         wanted = c->options->gradients || is_algebraic(c);
    c->scene->program.gradients = wanted;
    c->scene->program.algebraic = is_algebraic(c);
    for (size_t i = 0; i <= s->components.count; i++, roots += GRADIENT_ROOTS) {
        bool zones = i == s->components.count, known = false;
        Node near = s->zone_count > 0 ? s->zone : graph_number(g, 0), gradient = NODE_NONE;
        if (zones && wanted)
            known = graph_gradient(g, near, &gradient, NULL, &c->scratch) != DERIVED_NOT;
        else if (wanted)
            known = lower_gradient(g, s->components.items[i].shape, &gradient, &near, &c->scratch);
        Node distance = zones ? near : c->roots[i * ROOT_COUNT + ROOT_DISTANCE];
        roots[0]      = known ? gradient : distance;
        roots[1]      = known ? near : distance;
        arena_free(&c->scratch);
    }
}

/* ---- far from the origin ---- */

/* Beyond this, single precision may show: a unit is known to a sixteen-thousandth there. */
static const double FAR_OUT = 1000;

/* Whether a camera may stand, and something be, so far out that points need an anchor. */
static bool reaches_far(const Compilation *c, const Graph *graph)
{
    const Scene *s   = &c->elaborated;
    bool         far = false;
    for (size_t i = 0; i < 3 * s->components.count; i++) {
        Range side = s->components.items[i / 3].shape->box.axis[i % 3];
        far = far || (isfinite(side.low) && side.low < -FAR_OUT) ||
              (isfinite(side.high) && side.high > FAR_OUT);
    }
    for (size_t i = 0; i < s->cameras.count && !s->cameras.items[i].standing_in; i++) {
        const Expr *eye = &graph->items[s->cameras.items[i].eye];
        for (int k = 0; k < 3; k++)
            far = far || (eye->op == OP_CONSTANT && fabs(eye->number[k]) > FAR_OUT);
    }
    return far && s->zone_count == 0;
}

static size_t anchored_count(const Compilation *c)
{
    return c->scene->program.anchored ? c->elaborated.components.count * ROOT_COUNT + FLAT_ROOTS
                                      : 0;
}

/* They stand behind all but slopes. */
static Node *anchored_roots(const Compilation *c)
{
    size_t components = c->elaborated.components.count;
    return c->roots + c->root_count + MARCH_ROOTS * components + FLAT_ROOTS +
           GRADIENT_ROOTS * (components + 1);
}

/* Behind all others: what has a slope of each frame. */
static Node *slope_roots(const Compilation *c) { return anchored_roots(c) + anchored_count(c); }

static size_t all_roots(const Compilation *c)
{
    return (size_t)(slope_roots(c) - c->roots) + c->elaborated.slopes.count;
}

/* The roots of the components, and those of planes, for points given from an anchor. */
static void lower_anchored(Compilation *c, Graph *graph, const Node *flats)
{
    Node          *roots = anchored_roots(c);
    size_t         count = c->elaborated.components.count * ROOT_COUNT;
    GraphParameter anywhere = {{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}, {HUGE_VAL, HUGE_VAL, HUGE_VAL}};
    Node anchor = graph_parameter(graph, (uint32_t)graph->parameters.count, TYPE_VEC3);
    array_push(&c->scene->arena, &graph->parameters, anywhere);
    memcpy(roots, c->roots, count * sizeof *roots);
    memcpy(roots + count, flats, FLAT_ROOTS * sizeof *roots);
    graph_anchor(graph, roots, count + FLAT_ROOTS, anchor, &c->scratch);
    arena_free(&c->scratch);
}

/* All roots: of components, zones, cameras, lights and the sky. */
static bool lower_scene(Compilation *c, Graph *graph)
{
    const Scene *s = &c->elaborated;
    c->point_roots = s->components.count * ROOT_COUNT + (s->zone_count > 0);
    c->root_count  = c->point_roots + s->cameras.count * CAMERA_ROOTS +
                    s->lights.count * LIGHT_ROOTS + SKY_ROOTS;
    c->scene->program.anchored = reaches_far(c, graph);
    c->roots   = arena_new_array(&c->scene->arena, Node, c->root_count +
                                  MARCH_ROOTS * s->components.count + FLAT_ROOTS +
                                  GRADIENT_ROOTS * (s->components.count + 1) + anchored_count(c) +
                                  s->slopes.count);
    Node *root = c->roots;
    for (size_t i = 0; i < s->components.count; i++, root += ROOT_COUNT)
        if (!lower_component(graph, s->components.items[i].shape, &c->scratch, root)) {
            refuse_size(c, i, 0);
            return false;
        }
    if (s->zone_count > 0)
        *root++ = s->zone;
    for (size_t i = 0; i < s->cameras.count; i++, root += CAMERA_ROOTS) {
        const SceneCamera *camera = &s->cameras.items[i];
        memcpy(root, (Node[]){camera->eye, camera->target, camera->up, camera->fov, camera->height},
               CAMERA_ROOTS * sizeof *root);
    }
    for (size_t i = 0; i < s->lights.count; i++, root += LIGHT_ROOTS) {
        const SceneLight *light = &s->lights.items[i];
        memcpy(root, (Node[]){light->vector, light->color, light->softness},
               LIGHT_ROOTS * sizeof *root);
    }
    memcpy(root, (Node[]){s->zenith, s->horizon, s->ground}, SKY_ROOTS * sizeof *root);
    /* Behind all others, and last, so that nothing else depends on them. */
    for (size_t i = 0; i < s->components.count; i++) {
        const Shape *shape = s->components.items[i].shape;
        Node         plain = c->roots[i * ROOT_COUNT + ROOT_DISTANCE];
        Node        *march = &c->roots[c->root_count + i];
        *march = lower_guarded(graph, shape, plain, &c->scratch);
        for (AlongMethod method = 0; method < ALONG_COUNT; method++) {
            march += s->components.count;
            *march = lower_along(graph, shape, plain, method, &c->scratch);
        }
    }
    Node *flats = &c->roots[c->root_count + MARCH_ROOTS * s->components.count];
    lower_flats(c, graph, flats);
    arena_free(&c->scratch);
    lower_gradients(c, graph, flats + FLAT_ROOTS);
    if (c->scene->program.anchored)
        lower_anchored(c, graph, flats);
    for (size_t i = 0; i < s->slopes.count; i++)
        slope_roots(c)[i] = s->slopes.items[i].formula;
    graph_validate(graph, "lower");
    if (dumps(c, DUMP_GRAPH))
        graph_print(graph, &c->sources, c->roots, c->root_count, &c->dump);
    return true;
}

/* Size is limited by construction: compilers of shaders are slow on what is too large. */
static bool check_size(Compilation *c, const Graph *graph)
{
    size_t total = 0, largest = 0, most = 0;
    for (size_t i = 0; i < c->elaborated.components.count; i++) {
        size_t operations = count_operations(graph, &c->roots[i * ROOT_COUNT], 1, &c->scratch);
        total += operations;
        if (operations > most) {
            most    = operations;
            largest = i;
        }
        arena_free(&c->scratch);
    }
    size_t zones = 0;
    if (c->elaborated.zone_count > 0)
        zones = count_operations(graph, &c->roots[c->point_roots - 1], 1, &c->scratch);
    if (total + zones <= MOST_OPERATIONS)
        return true;
    if (zones > most)
        refuse_zones(c, graph->items[c->roots[c->point_roots - 1]].span, zones);
    else
        refuse_size(c, largest, most);
    return false;
}

/* Whether an operation is on constants alone and yet not folded: its result is not finite; or a
   constant that single precision does not have. */
static bool is_beyond_numbers(const Graph *graph, const Expr *expr)
{
    bool constants = expr->operand_count > 0, beyond = false;
    for (uint32_t i = 0; i < expr->operand_count; i++)
        constants = constants && graph->items[expr->operands[i]].op == OP_CONSTANT;
    for (uint32_t i = 0; i < 4 && expr->op == OP_CONSTANT; i++)
        beyond = beyond || !(fabs(expr->number[i]) <= FLT_MAX);
    return constants || beyond;
}

static void refuse_number(Compilation *c, const Component *shown, Span span)
{
    Diag *diag  = diag_add(&c->diags, DIAG_NOT_A_NUMBER, shown->span,
                           "a number in `%s` is too large, or not finite", shown->name);
    diag->label = "single precision goes to 3.4e38";
    /* Equal expressions are one node, whose place may be in another component. */
    if (span.source == shown->span.source && span.start > shown->span.start &&
        span.end <= shown->span.end)
        diag_place(&c->diags, diag, span, "in here");
}

/* The first node that the roots of some components need and no shader can have; else NODE_NONE. */
static Node find_beyond_numbers(Compilation *c, const Graph *graph, size_t first, size_t count)
{
    Tape tape  = tape_new(graph, &c->roots[first * ROOT_COUNT], count * ROOT_COUNT, &c->scratch);
    Node found = NODE_NONE;
    for (size_t k = 0; k < tape.count && found == NODE_NONE; k++)
        if (is_beyond_numbers(graph, &graph->items[tape.nodes[k]]))
            found = tape.nodes[k];
    arena_free(&c->scratch);
    return found;
}

/* An overflow of what is given shows here only, where it has met everything else. */
static bool check_numbers(Compilation *c, const Graph *graph)
{
    size_t count = c->elaborated.components.count;
    if (find_beyond_numbers(c, graph, 0, count) == NODE_NONE)
        return true;
    for (size_t i = 0; i < count; i++) {
        Node node = find_beyond_numbers(c, graph, i, 1);
        if (node != NODE_NONE)
            refuse_number(c, &c->elaborated.components.items[i], graph->items[node].span);
    }
    return false;
}

/* The cost of what is computed at each point, in multiply-adds. */
static double flops_of(const Graph *graph, const Tape *tape)
{
    double flops = 0;
    for (size_t i = tape->frame_count; i < tape->count; i++) {
        const Expr *expr = &graph->items[tape->nodes[i]];
        GraphType   types[MAX_OPERANDS];
        for (uint32_t k = 0; k < expr->operand_count; k++)
            types[k] = graph->items[expr->operands[k]].type;
        if (expr->operand_count)
            flops += op_cost((Op)expr->op, expr->type, types);
    }
    return flops;
}

static const char *keep(Compilation *c, const char *text)
{
    return text ? arena_copy_text(&c->scene->arena, text, strlen(text)) : NULL;
}

/* Whether a component has a face on one before it; among too many, it is taken to have. */
static bool touches_others(const Scene *scene, size_t component)
{
    enum { MANY = 100 };
    const Component *items = scene->components.items;
    for (size_t i = 0; i < component && component < MANY; i++)
        if (boxes_touch(items[i].shape->box, items[component].shape->box))
            return true;
    return component >= MANY;
}

static void keep_components(Compilation *c)
{
    KrsScene    *scene = c->scene;
    const Scene *s     = &c->elaborated;
    scene->component_count = s->components.count;
    scene->components      = arena_new_array(&scene->arena, KrsComponent, s->components.count + 1);
    scene->bounds          = arena_new_array(&scene->arena, KrsBounds, s->components.count + 1);
    for (size_t i = 0; i < s->components.count; i++) {
        const Component *from = &s->components.items[i];
        KrsComponent    *to   = &scene->components[i];
        *to = (KrsComponent){.name      = keep(c, from->name),
                             .slope     = from->shape->slope * from->shape->derived,
                             .per_frame = from->shape->per_frame,
                             .exact     = from->shape->exact,
                             .estimate  = from->shape->estimate,
                             .levels    = from->shape->levels,
                             .instances = from->shape->instances,
                             .inversions = from->shape->inversions};
        for (int k = 0; k < 3; k++) {
            to->low[k]  = from->shape->box.axis[k].low;
            to->high[k] = from->shape->box.axis[k].high;
        }
        scene->program.loose = scene->program.loose || shape_is_loose(from->shape);
        scene->program.seams = scene->program.seams || from->shape->seams || touches_others(s, i);
        bounds_of(from->shape, &c->sources, &scene->bounds[i], &scene->arena, &c->scratch);
        arena_free(&c->scratch);
    }
}

/* Shapes that were cut again leave slopes behind that nothing is divided by. */
static bool is_needed(const Graph *graph, uint32_t slot)
{
    for (Node n = 0; n < graph->count; n++)
        if (graph->items[n].op == OP_PARAMETER && graph->items[n].index == slot)
            return true;
    return false;
}

static void keep_slopes(Compilation *c)
{
    KrsScene    *scene = c->scene;
    const Scene *s     = &c->elaborated;
    scene->slopes      = arena_new_array(&scene->arena, KeptSlope, s->slopes.count + 1);
    for (size_t i = 0; i < s->slopes.count; i++) {
        const FrameSlope *from = &s->slopes.items[i];
        if (!is_needed(scene->graph, from->slot))
            continue;
        const Source *source   = &c->sources.items[from->span.source];
        Position      position = source_position(source, from->span.start);
        Text          place    = {.arena = &scene->arena};
        text_format(&place, "%s:%u:%u", source->name, position.line, position.column);
        scene->slopes[scene->slope_count++] = (KeptSlope){
            from->slot,
            slope_task(scene->graph, slope_roots(c)[i], from->region,
                       frame_slope_cells(from->region), &scene->arena),
            place.bytes};
    }
}

/* Copies what the program needs out of the elaborated scene, whose memory goes. */
static void keep_scene(Compilation *c)
{
    KrsScene    *scene = c->scene;
    const Scene *s     = &c->elaborated;
    Arena       *arena = &scene->arena;
    keep_components(c);
    keep_slopes(c);
    scene->parameter_count = s->parameters.count;
    scene->parameters      = arena_new_array(arena, Parameter, s->parameters.count + 1);
    for (size_t i = 0; i < s->parameters.count; i++) {
        scene->parameters[i]      = s->parameters.items[i];
        scene->parameters[i].name = keep(c, s->parameters.items[i].name);
    }
    scene->camera_count = s->cameras.count;
    scene->cameras      = arena_new_array(arena, SceneCamera, s->cameras.count + 1);
    for (size_t i = 0; i < s->cameras.count; i++) {
        scene->cameras[i]      = s->cameras.items[i];
        scene->cameras[i].name = keep(c, s->cameras.items[i].name);
    }
    scene->light_count = s->lights.count;
    scene->lights      = arena_new_array(arena, SceneLight, s->lights.count + 1);
    memcpy(scene->lights, s->lights.items, s->lights.count * sizeof *scene->lights);
    scene->zone_count       = s->zone_count;
    scene->image            = s->image;
    scene->image.integrator = keep(c, s->image.integrator);
    scene->image.tone_map   = keep(c, s->image.tone_map);
    for (int k = 0; k < 3; k++) {
        scene->program.low[k]  = s->box.axis[k].low;
        scene->program.high[k] = s->box.axis[k].high;
    }
}

/* Everything that the host finds for kernels with an anchor, in the order of its slots. */
static Tape precise_tape(Compilation *c)
{
    KrsScene    *scene = c->scene;
    const Graph *graph = scene->graph;
    Node        *found = arena_new_array(&scene->arena, Node, graph->count + 1);
    size_t       count = 0;
    for (Node n = 0; n < graph->count; n++)
        if (graph->items[n].op == OP_precise)
            found[count++] = n;
    scene->precise_nodes = found;
    scene->precise_count = count;
    return tape_new(graph, found, count, &scene->arena);
}

static void make_tapes(Compilation *c)
{
    KrsScene *scene = c->scene;
    size_t    count = scene->component_count;
    Node     *distances = arena_new_array(&c->scratch, Node, count + 1);
    for (size_t i = 0; i < count; i++)
        distances[i] = c->roots[i * ROOT_COUNT + ROOT_DISTANCE];
    scene->roots = c->roots;
    scene->guarded_roots = c->roots + c->root_count;
    scene->along_roots   = scene->guarded_roots + count;
    const Node *directional = scene->along_roots + ALONG_DIRECTIONAL * count;
    for (size_t i = 0; i < count; i++) {
        scene->program.along = scene->program.along || scene->along_roots[i] != distances[i];
        scene->program.inverts = scene->program.inverts || directional[i] != distances[i];
    }
    Node *guarded = arena_new_array(&c->scratch, Node, count + 1);
    memcpy(guarded, scene->guarded_roots, count * sizeof *guarded);
    if (scene->zone_count > 0)
        guarded[count] = distances[count] = zone_root(scene);
    count += scene->zone_count > 0;
    scene->guarded  = tape_new_guarded(scene->graph, guarded, count, &scene->arena);
    scene->distance = tape_new(scene->graph, distances, count, &scene->arena);
    scene->surface  = tape_new(scene->graph, c->roots, c->point_roots, &scene->arena);
    scene->view     = tape_new(scene->graph, c->roots + c->point_roots,
                               c->root_count - c->point_roots, &scene->arena);
    if (scene->program.anchored)
        scene->precise = precise_tape(c);
    scene->program.precise_slots = scene->precise_count;
    scene->program.operations = scene->distance.count - scene->distance.frame_count;
    scene->program.flops      = flops_of(scene->graph, &scene->distance);
}

static void keep_group(KrsGroup *group, double flops, Box box)
{
    group->flops = flops;
    for (int i = 0; i < 3; i++) {
        group->low[i]  = box.axis[i].low;
        group->high[i] = box.axis[i].high;
    }
}

static double component_flops(Compilation *c, size_t component)
{
    const KrsScene *scene = c->scene;
    Tape tape = tape_new(scene->graph, &c->roots[component * ROOT_COUNT + ROOT_DISTANCE], 1,
                         &c->scratch);
    return flops_of(scene->graph, &tape);
}

/* The group that a component joins: one of its own if it is heavy and bounded, while there are any;
   else the last, of all the others. */
static size_t choose_group(const KrsProgram *program, double flops, Box box)
{
    bool own = flops >= HEAVY_FLOPS && box_is_finite(box) && !box_is_empty(box);
    return own && program->group_count < KRS_MOST_GROUPS - 1 ? program->group_count
                                                             : KRS_MOST_GROUPS - 1;
}

static double flops_worth_splitting(const KrsProgram *program)
{
    double sum = 0, hull = 1;
    for (size_t i = 0; i < program->group_count; i++) {
        double volume = 1;
        for (int k = 0; k < 3; k++)
            volume *= program->groups[i].high[k] - program->groups[i].low[k];
        sum += volume;
    }
    for (int k = 0; k < 3; k++)
        hull *= program->high[k] - program->low[k];
    return sum <= hull ? SCATTERED_FLOPS : MIXED_FLOPS;
}

/* Which components are marched by themselves.  `groups` gets the number of each, from 1; 0 for
   those that need no march. */
static void form_groups(Compilation *c, const Box *boxes, const bool *flat, uint32_t *groups)
{
    KrsProgram *program = &c->scene->program;
    Box         rest    = box_empty;
    double      light   = 0;
    for (size_t i = 0; i < c->scene->component_count; i++) {
        groups[i] = 0;
        if (program->flats && flat[i])
            continue;
        double flops = component_flops(c, i);
        c->scene->components[i].flops = flops;
        program->heavy += flops >= HEAVY_FLOPS;
        size_t group = choose_group(program, flops, boxes[i]);
        groups[i]    = (uint32_t)group + 1;
        if (group < KRS_MOST_GROUPS - 1) {
            program->group_count++;
            keep_group(&program->groups[group], flops, boxes[i]);
            continue;
        }
        light += flops;
        rest = box_hull(rest, boxes[i]);
    }
    if (light > 0 && program->group_count > 0) {
        for (size_t i = 0; i < c->scene->component_count; i++)
            if (groups[i] == KRS_MOST_GROUPS)
                groups[i] = (uint32_t)program->group_count + 1;
        keep_group(&program->groups[program->group_count++], light, rest);
    }
    if (program->group_count < 2)
        program->group_count = 0;
    program->apart = program->group_count > 0 && program->flops >= flops_worth_splitting(program);
}

static void emit(Compilation *c)
{
    KrsScene *scene = c->scene;
    Text      glsl  = {.arena = &scene->arena};
    Box      *boxes = arena_new_array(&c->scratch, Box, scene->component_count + 1);
    bool     *flat  = arena_new_array(&c->scratch, bool, scene->component_count + 1);
    Box       rest  = box_empty;
    for (size_t i = 0; i < scene->component_count; i++) {
        const Component *component = &c->elaborated.components.items[i];
        boxes[i] = component->shape->box;
        flat[i]  = is_flat(component);
        rest     = flat[i] ? rest : box_hull(rest, boxes[i]);
    }
    for (int k = 0; k < 3; k++) {
        scene->program.rest_low[k]  = box_is_empty(rest) ? 0 : rest.axis[k].low;
        scene->program.rest_high[k] = box_is_empty(rest) ? 0 : rest.axis[k].high;
    }
    const Node *flats  = scene->along_roots + ALONG_COUNT * scene->component_count;
    uint32_t   *groups = arena_new_array(&c->scratch, uint32_t, scene->component_count + 1);
    form_groups(c, boxes, flat, groups);
    scene->program.parts = emit_part_count(scene->component_count);
    emit_glsl(scene->graph, &c->sources, c->roots, scene->component_count, zone_root(scene),
              &(EmitMarch){.guarded      = scene->guarded_roots,
                           .along        = scene->along_roots,
                           .boxes        = boxes,
                           .groups       = scene->program.group_count ? groups : NULL,
                           .flat         = scene->program.flats ? flat : NULL,
                           .anchored     = scene->program.anchored ? anchored_roots(c) : NULL,
                           .precise_slot = (uint32_t)scene->graph->parameters.count + KRS_MOST_ZONES,
                           .ahead        = flats,
                           .slopes       = scene->slope_count > 0,
                           .gradient =
                               scene->program.gradients ? flats + FLAT_ROOTS : NULL},
              &c->scratch, &glsl);
    scene->program.glsl            = glsl.bytes;
    scene->program.glsl_length     = glsl.length;
    scene->program.parameter_slots = (uint32_t)scene->graph->parameters.count;
    if (dumps(c, DUMP_GLSL))
        text_add(&c->dump, glsl.bytes);
}

/* Many small components have few operations, and much text around them. */
static bool check_length(Compilation *c)
{
    size_t length = c->scene->program.glsl_length, largest = 0, most = 0;
    size_t count  = c->elaborated.components.count;
    if (length <= MOST_GLSL_BYTES)
        return true;
    for (size_t i = 0; i < count; i++) {
        arena_free(&c->scratch);
        size_t operations = count_operations(c->scene->graph, &c->roots[i * ROOT_COUNT], ROOT_COUNT,
                                             &c->scratch);
        largest = operations > most ? i : largest;
        most    = operations > most ? operations : most;
    }
    const Component *shown = count ? &c->elaborated.components.items[largest] : NULL;
    Diag *diag = diag_add(&c->diags, DIAG_TOO_LARGE, shown ? shown->span : (Span){1, 0, 0},
                          "the scene needs %.1f MB of shader; the limit is %.1f MB",
                          (double)length * 1e-6, MOST_GLSL_BYTES * 1e-6);
    if (count > 1)
        diag->label = diag_text(&c->diags, "the largest of %zu components, with %zu operations",
                                count, most);
    else if (shown)
        diag->label = diag_text(&c->diags, "`%s` has %zu operations", shown->name, most);
    diag->help = count > 100 ? "`show union([...])` makes one component of many shapes"
                             : fewer_shapes;
    return false;
}

static KrsStatus inspect(Compilation *c)
{
    c->diags.count = c->diags.warnings = 0;
    arena_free(&c->scratch);
    return c->request->inspect(c->request->user,
                               &(Inspected){&c->elaborated, &c->diags, &c->work, &c->scratch});
}

/* Text to program; ends at the first step that found mistakes. */
static KrsStatus run(Compilation *c)
{
    if (c->length > MOST_SOURCE_BYTES) {
        source_add(&c->sources, c->name, "", 0, false);
        diag_add(&c->diags, DIAG_LIMIT, (Span){1, 0, 0},
                 "the file has %zu bytes; the limit is 16 MiB", c->length);
        return KRS_BAD_SCENE;
    }
    Graph *graph = elaborate_scene(c);
    if (c->diags.errors || !lower_scene(c, graph))
        return KRS_BAD_SCENE;
    Graph *simple = graph_simplify(graph, c->roots, all_roots(c), &c->scene->arena);
    graph_validate(simple, "simplify");
    c->scene->graph = simple;
    if (dumps(c, DUMP_SIMPLIFY))
        graph_print(simple, &c->sources, c->roots, c->root_count, &c->dump);
    if (!check_size(c, simple) || !check_numbers(c, simple))
        return KRS_BAD_SCENE;
    hash_sources(&c->sources, c->scene->hash);
    keep_scene(c);
    make_tapes(c);
    c->scene->program.front_ms = now_ms() - c->started;
    emit(c);
    c->scene->program.glsl_ms = now_ms() - c->started - c->scene->program.front_ms;
    if (!check_length(c))
        return KRS_BAD_SCENE;
    KrsStatus status = c->scene->cameras[0].standing_in ? frame_scene(c->scene) : KRS_OK;
    return status == KRS_OK && c->request->inspect ? inspect(c) : status;
}

/* ---- the doorstep ---- */

static void hand_over(const Diags *diags, const Diag *diag, const KrsOptions *options, Arena *arena)
{
    const Source *source   = &diags->sources->items[diag->span.source];
    Position      position = source_position(source, diag->span.start);
    Text          text = {.arena = arena}, json = {.arena = arena};
    diag_print_one(diags, diag, false, &text);
    diag_json_one(diags, diag, &json);
    KrsDiagnostic public = {.error   = diag_info[diag->code].severity == DIAG_ERROR,
                            .code    = diag_info[diag->code].code,
                            .message = diag->message,
                            .source  = source->name,
                            .line    = position.line,
                            .column  = position.column,
                            .text    = text.bytes,
                            .json    = json.bytes};
    options->diagnostic(options->user, &public);
}

static void report(Compilation *c)
{
    const KrsOptions *options = c->options;
    diags_sort(&c->diags);
    for (size_t i = 0; options->diagnostic && i < c->diags.count; i++)
        hand_over(&c->diags, c->diags.items[i], options, &c->scratch);
}

/* Running out of memory anywhere in there leads back to here. */
static KrsStatus run_guarded(Compilation *c)
{
    jmp_buf exhausted;
    c->scene->memory.exhausted = &exhausted;
    if (setjmp(exhausted) != 0)
        return KRS_OUT_OF_MEMORY;
    source_add(&c->sources, "", "", 0, true); /* source 0: no place */
    KrsStatus status = run(c);
    report(c);
    return status;
}

static KrsStatus compile(const char *text, size_t length, const char *name,
                         const KrsOptions *options, const Request *request, KrsScene **result)
{
    static const KrsOptions defaults = {0};
    options                          = options ? options : &defaults;
    *result                          = NULL;
    const KrsAllocator *allocator    = &options->allocator;
    KrsScene *scene = allocator->allocate ? allocator->allocate(allocator->user, sizeof *scene)
                                          : malloc(sizeof *scene);
    if (!scene)
        return KRS_OUT_OF_MEMORY;
    memset(scene, 0, sizeof *scene);
    Compilation c = {.scene      = scene,
                     .text       = text,
                     .length     = length,
                     .name       = name,
                     .request    = request,
                     .options    = options,
                     .started    = now_ms()};
    scene->memory = (Memory){allocator->allocate, allocator->release, allocator->user, 0,
                             options->memory_limit ? options->memory_limit : DEFAULT_MEMORY, NULL};
    scene->arena = c.work = c.syntax = c.scratch = (Arena){.memory = &scene->memory};
    c.sources = (Sources){.arena = &c.work};
    c.names   = (Names){.arena = &c.work};
    c.diags   = (Diags){.arena = &c.work, .sources = &c.sources};
    c.dump    = (Text){.arena = &c.work};

    KrsStatus status = run_guarded(&c);
    if (request->dump && status != KRS_OUT_OF_MEMORY)
        *request->dump = strdup(c.dump.bytes ? c.dump.bytes : "");
    arena_free(&c.work);
    arena_free(&c.syntax);
    arena_free(&c.scratch);
    scene->memory.exhausted = NULL;
    if (status != KRS_OK) {
        krs_scene_free(scene);
        return status;
    }
    *result = scene;
    return KRS_OK;
}

KrsStatus krs_compile_text(const char *text, size_t length, const char *name,
                           const KrsOptions *options, KrsScene **scene)
{
    return compile(text, length, name, options, &scene_alone, scene);
}

static KrsStatus compile_path(const char *path, const KrsOptions *options, const Request *request,
                              KrsScene **scene)
{
    size_t      length;
    const char *reason;
    *scene     = NULL;
    char *text = read_whole(path, &length, &reason);
    if (!text)
        return KRS_IO_ERROR;
    KrsStatus status = compile(text, length, path, options, request, scene);
    free(text);
    return status;
}

KrsStatus krs_compile_file(const char *path, const KrsOptions *options, KrsScene **scene)
{
    return compile_path(path, options, &scene_alone, scene);
}

KrsStatus krs_dump(const char *path, DumpStage stage, const KrsOptions *options, char **dump)
{
    KrsScene *scene;
    Request   request = {.stage = stage, .dump = dump};
    *dump             = NULL;
    KrsStatus status  = compile_path(path, options, &request, &scene);
    krs_scene_free(scene);
    return status;
}

KrsStatus inspect_file(const char *path, const KrsOptions *options, Inspect *look, void *user)
{
    KrsScene *scene;
    Request   request = {.stage = DUMP_STAGE_COUNT, .inspect = look, .user = user};
    KrsStatus status  = compile_path(path, options, &request, &scene);
    krs_scene_free(scene);
    return status;
}

void krs_scene_free(KrsScene *scene)
{
    if (!scene)
        return;
    Memory memory = scene->memory;
    arena_free(&scene->arena);
    if (memory.allocate)
        memory.release(memory.user, scene);
    else
        free(scene);
}

const KrsProgram *krs_scene_program(const KrsScene *scene) { return &scene->program; }
size_t      krs_camera_count(const KrsScene *scene) { return scene->camera_count; }
size_t      krs_zone_count(const KrsScene *scene) { return scene->zone_count; }
const char *krs_scene_hash(const KrsScene *scene) { return scene->hash; }
size_t      krs_parameter_count(const KrsScene *scene) { return scene->parameter_count; }
size_t      krs_parameter_slots(const KrsScene *scene) { return scene->program.parameter_slots; }
size_t      krs_frame_slope_count(const KrsScene *scene) { return scene->slope_count; }
size_t      krs_component_count(const KrsScene *scene) { return scene->component_count; }

const char *krs_camera_name(const KrsScene *scene, size_t index)
{
    return index < scene->camera_count ? scene->cameras[index].name : NULL;
}

KrsStatus krs_parameter(const KrsScene *scene, size_t index, KrsParameter *parameter)
{
    if (index >= scene->parameter_count)
        return KRS_BAD_ARGUMENT;
    const Parameter *from = &scene->parameters[index];
    *parameter            = (KrsParameter){.name = from->name, .components = from->components};
    memcpy(parameter->value, from->value, sizeof parameter->value);
    memcpy(parameter->low, from->low, sizeof parameter->low);
    memcpy(parameter->high, from->high, sizeof parameter->high);
    return KRS_OK;
}

KrsStatus krs_frame_slope(const KrsScene *scene, size_t index, KrsFrameSlope *slope)
{
    if (index >= scene->slope_count)
        return KRS_BAD_ARGUMENT;
    const KeptSlope *from = &scene->slopes[index];
    *slope                = (KrsFrameSlope){.slot = from->slot, .place = from->place};
    for (int i = 0; i < 3; i++) {
        slope->low[i]  = from->task.box.axis[i].low;
        slope->high[i] = from->task.box.axis[i].high;
    }
    return KRS_OK;
}

size_t krs_bound_count(const KrsScene *scene, size_t component, size_t *more)
{
    bool exists = component < scene->component_count;
    if (more)
        *more = exists ? scene->bounds[component].more : 0;
    return exists ? scene->bounds[component].count : 0;
}

KrsStatus krs_bound(const KrsScene *scene, size_t component, size_t index, KrsBound *bound)
{
    if (index >= krs_bound_count(scene, component, NULL))
        return KRS_BAD_ARGUMENT;
    *bound = scene->bounds[component].items[index];
    return KRS_OK;
}

KrsStatus krs_component(const KrsScene *scene, size_t index, KrsComponent *component)
{
    if (index >= scene->component_count)
        return KRS_BAD_ARGUMENT;
    *component = scene->components[index];
    return KRS_OK;
}
