/*
 * refute.c: the attempt to refute the distance of every shape of a scene, and whom to blame.
 *
 * Every shape of the trees is lowered by itself and searched (search.h): as it is where something
 * above moves its surface, which needs the slope, and as it is where nothing does.  Components
 * come first, and have half of the time; then their parts, parts of parts before the whole.
 *
 * Who is to blame: all shapes that the lowering of a refuted one meets are looked at in the very
 * points in which it is refuted, each in its own space.  The smallest of them that is refuted too
 * is next, and so on; where none is, the parts of the last are searched from these points on.
 */
#include "compiler/refute.h"

#include <math.h>
#include <string.h>

#include "compiler/base/vec.h"
#include "compiler/geometry/claims.h"
#include "compiler/geometry/lowering.h"
#include "compiler/search.h"

/* Of the machine whose seconds are counted; most of today's are as fast, or faster. */
static const double OPERATIONS_PER_SECOND = 1e8;
/* After so many somebody is asked whether to go on. */
static const uint64_t SLICE = 10000000;
enum { MOST_SHAPES = 4096, MOST_TRIALS = 6, SETTING_ATTEMPTS = 8 };

/* A shape that is looked at, and where in the trees it was met first. */
typedef struct Suspect {
    const Shape *shape;
    uint32_t     component;
    size_t       parent; /* index of a suspect; SIZE_MAX of a component's whole shape */
} Suspect;

/* What is searched of a shape: its distance, and of a whole component what marches instead. */
typedef enum Claim {
    CLAIM_DISTANCE,
    CLAIM_GUARDED, /* the distance that leaves out what is far */
    CLAIM_ALONG    /* the step along a ray, by AlongMethod from here on */
} Claim;

/* Points that refute a shape, at these parameters. */
typedef struct Finding {
    size_t     suspect;
    Claim      claim;
    ShapeClaim pair;   /* `property` is NULL, or what is claimed beside the distance */
    bool       steady; /* of the distance that has to be 1-Lipschitz, else of the other */
    Witness    witness;
    NodeValue *parameters;
} Finding;

typedef struct Refuter {
    const Inspected        *in;
    const KrsRefuteOptions *how;
    KrsRefutation          *result;
    Graph                  *graph;
    uint64_t                random, total, done;
    SlopeTask              *slopes; /* of the scene's, in its order */
    void                   *room;
    Tape                    frames; /* all components: what frames are refused by */
    NodeValue              *frame_values;
    struct {
        Suspect *items;
        size_t   count, capacity;
    } suspects;
    bool stopped;
} Refuter;

/* ---- shapes ---- */

/* These add nothing to the distance of what they hold. */
static bool is_wrapper(const Shape *shape)
{
    return shape->kind == SHAPE_PAINT || shape->kind == SHAPE_SMOOTH || shape->kind == SHAPE_EMPTY;
}

static bool is_known(const Refuter *r, const Shape *shape)
{
    for (size_t i = 0; i < r->suspects.count; i++)
        if (r->suspects.items[i].shape == shape)
            return true;
    return false;
}

static void add_suspects(Refuter *r, const Shape *shape, uint32_t component, size_t parent)
{
    if (r->suspects.count >= MOST_SHAPES || is_known(r, shape))
        return;
    size_t own = r->suspects.count;
    array_push(r->in->arena, &r->suspects, ((Suspect){shape, component, parent}));
    for (uint32_t i = 0; i < shape->child_count; i++)
        add_suspects(r, shape->children[i], component, own);
}

static Lowering lowering_of(Refuter *r, Visits *visits)
{
    return (Lowering){.graph   = r->graph,
                      .scratch = r->in->scratch,
                      .visits  = visits,
                      .most    = r->graph->count + MOST_LOWERED};
}

/* The distance of a shape in its own space; NODE_NONE: of nothing, or of too much. */
static Node lower_alone(Refuter *r, const Shape *shape, bool steady, Visits *visits)
{
    Lowering l     = lowering_of(r, visits);
    Place    place = place_bare(graph_leaf(r->graph, OP_POINT), steady);
    Lowered  all   = lower_shape(&l, shape, place);
    r->result->skipped += l.overflow && !visits && !steady;
    if (l.overflow || all.distance == NODE_NONE)
        return NODE_NONE;
    return divide_by_slope(r->graph, all.distance, shape->slope);
}

/* A search of one of the distances of a shape, or of a step beside the distance that tells on which
   side points are; false: there is nothing to search. */
static bool search_step(Refuter *r, const Shape *shape, Node step, Node side, bool steady,
                        Search *search)
{
    Arena *scratch  = r->in->scratch;
    Node   roots[2] = {step, side};
    Graph *simple   = graph_simplify(r->graph, roots, 2, scratch);
    if (!search_new(search, simple, roots[0], roots[1], shape->box, scratch))
        return false;
    search->steep  = steady;
    search->figure = shape->figure;
    search->random = r->random;
    r->random += 0x9e3779b97f4a7c15;
    return true;
}

static bool search_of(Refuter *r, const Shape *shape, Node distance, bool steady, Search *search)
{
    return search_step(r, shape, distance, distance, steady, search);
}

/* ---- parameters ---- */

static const struct KrsFixed *fixed_value(const Refuter *r, const char *name)
{
    for (size_t i = 0; i < r->how->fixed_count; i++)
        if (strcmp(r->how->fixed[i].name, name) == 0)
            return &r->how->fixed[i];
    return NULL;
}

static double random_value(Refuter *r, double usual, double low, double high)
{
    double choice = random_unit(&r->random), t = random_unit(&r->random);
    if (!isfinite(low))
        low = fmin(usual, isfinite(high) ? high : usual) - 1 - fabs(usual);
    if (!isfinite(high))
        high = fmax(usual, low) + 1 + fabs(usual);
    return choice < 0.2 ? low : choice < 0.4 ? high : low + t * (high - low);
}

/* Defaults in the first trial, then anything that is permitted. */
static void choose_parameters(Refuter *r, uint32_t trial, NodeValue *values)
{
    const Scene *scene = r->in->scene;
    values[0].v[0]     = trial ? 10 * random_unit(&r->random) : r->how->time;
    for (size_t i = 0; i < scene->parameters.count; i++) {
        const Parameter       *parameter = &scene->parameters.items[i];
        const struct KrsFixed *fixed     = fixed_value(r, parameter->name);
        double                *to        = values[parameter->slot].v;
        memcpy(to, fixed ? fixed->values : parameter->value, sizeof parameter->value);
        for (uint32_t k = 0; trial && !fixed && k < parameter->components; k++)
            to[k] = random_value(r, parameter->value[k], parameter->low[k], parameter->high[k]);
    }
}

/* Into the slots; false: one has no bound, and the frame is refused. */
static bool find_slopes(const Refuter *r, NodeValue *values)
{
    const Scene *scene = r->in->scene;
    for (size_t i = 0; i < scene->slopes.count; i++) {
        const double(*parameters)[4] = (const double(*)[4])values;
        double slope = frame_slope_upward(slope_task_run(&r->slopes[i], parameters, r->room, NULL));
        values[scene->slopes.items[i].slot].v[0] = slope;
        if (!isfinite(slope))
            return false;
    }
    return true;
}

/* Simplified, as compiled scenes have them. */
static void prepare_slopes(Refuter *r)
{
    const Scene *scene = r->in->scene;
    size_t       most  = 0;
    r->slopes          = arena_new_array(r->in->arena, SlopeTask, scene->slopes.count + 1);
    for (size_t i = 0; i < scene->slopes.count; i++) {
        const FrameSlope *slope = &scene->slopes.items[i];
        Node              root  = slope->formula;
        Graph            *plain = graph_simplify(r->graph, &root, 1, r->in->arena);
        uint32_t          cells = frame_slope_cells(slope->region);
        r->slopes[i]            = slope_task(plain, root, slope->region, cells, r->in->arena);
        size_t room             = slope_task_room(&r->slopes[i]);
        most                    = room > most ? room : most;
    }
    r->room = arena_alloc(r->in->arena, most, 1);
}

/* As frames have them: all components outside of everything. */
static void prepare_frames(Refuter *r)
{
    Arena *arena = r->in->arena;
    size_t count = 0;
    Node  *roots = arena_new_array(arena, Node, r->in->scene->components.count + 1);
    for (size_t i = 0; i < r->in->scene->components.count; i++) {
        Node plain = lower_alone(r, r->in->scene->components.items[i].shape, false, NULL);
        if (plain != NODE_NONE)
            roots[count++] = plain;
    }
    r->result->skipped = 0; /* they are lowered once more */
    Graph *simple      = graph_simplify(r->graph, roots, count, arena);
    r->frames          = tape_new(simple, roots, count, arena);
    r->frame_values    = arena_new_array(arena, NodeValue, simple->count);
}

/* Whether a frame can have these parameters; finds its slopes. */
static bool is_possible(const Refuter *r, NodeValue *parameters)
{
    if (!find_slopes(r, parameters))
        return false;
    tape_run_frame(&r->frames, parameters, r->frame_values);
    return tape_frame_infinite(&r->frames, r->frame_values) == NODE_NONE;
}

static bool needs_parameters(const Tape *tape)
{
    for (size_t i = 0; i < tape->frame_count; i++)
        if (tape->graph->items[tape->nodes[i]].op == OP_PARAMETER)
            return true;
    return false;
}

/* ---- looking at a shape ---- */

static void report_progress(Refuter *r, uint64_t operations)
{
    r->done += operations;
    double part = fmin(1, (double)r->done / (double)r->total);
    if (r->how->go_on && !r->how->go_on(r->how->user, part))
        r->stopped = true;
}

static void count_search(Refuter *r, const Search *search, const Shape *shape, double ratio)
{
    r->result->evaluations += search->evaluations;
    if (shape->estimate)
        r->result->longest = fmax(r->result->longest, ratio);
    else if (search->steep)
        r->result->steepest = fmax(r->result->steepest, ratio);
}

static void find(Finding *finding, bool steady, Witness witness, const NodeValue *parameters,
                 size_t slots)
{
    finding->steady  = steady;
    finding->witness = witness;
    memcpy(finding->parameters, parameters, slots * sizeof *parameters);
}

/* Chooses parameters that a frame can have, as good as any others but for the first; false: there
   are none to be found, or those of the first trial cannot be had, which is a finding. */
static bool choose_possible(Refuter *r, uint32_t trial, NodeValue *parameters)
{
    for (int i = 0; i < (trial ? SETTING_ATTEMPTS : 1); i++) {
        choose_parameters(r, trial, parameters);
        if (is_possible(r, parameters))
            return true;
    }
    return false;
}

/* Tries one distance at several settings; the worst that refutes it goes to *finding. */
static bool try_settings(Refuter *r, const Shape *shape, Search *search, uint64_t operations,
                         Finding *finding)
{
    uint32_t   trials     = needs_parameters(&search->tape) ? MOST_TRIALS : 1;
    size_t     slots      = r->graph->parameters.count;
    NodeValue *parameters = arena_new_array(r->in->scratch, NodeValue, slots);
    bool       refuted    = false;
    for (uint32_t trial = 0; trial < trials && !r->stopped; trial++) {
        bool possible = choose_possible(r, trial, parameters);
        if (!possible && trial > 0) {
            r->result->refused++;
            continue;
        }
        if (!possible || !search_start(search, parameters)) {
            find(finding, search->steep, (Witness){.fault = FAULT_CONSTANT}, parameters, slots);
            return true;
        }
        search->worst = (Witness){0};
        for (uint64_t left = operations / trials; left > 0 && !r->stopped;) {
            uint64_t slice = left < SLICE ? left : SLICE;
            search_run(search, slice);
            report_progress(r, slice);
            left -= slice;
        }
        count_search(r, search, shape, search->worst.ratio);
        search->evaluations = 0;
        if (r->result->settings < trial + 1)
            r->result->settings = trial + 1;
        if (!search_refuted(search) || (refuted && search->worst.ratio <= finding->witness.ratio))
            continue;
        refuted = true;
        find(finding, search->steep, search->worst, parameters, slots);
    }
    return refuted;
}

static bool box_has_numbers(Box box)
{
    for (int i = 0; i < 3; i++)
        if (isnan(box.axis[i].low) || isnan(box.axis[i].high))
            return false;
    return true;
}

/* Both distances of a shape, where there are two. */
static bool try_shape(Refuter *r, size_t suspect, uint64_t operations, Finding *finding)
{
    const Shape *shape  = r->suspects.items[suspect].shape;
    Node         steady = NODE_NONE, plain = NODE_NONE;
    bool         refuted = false;
    Search       search;
    finding->suspect = suspect;
    r->result->shapes++;
    r->result->estimates += shape->estimate;
    if (!box_has_numbers(shape->box)) {
        finding->witness = (Witness){.fault = FAULT_BOX};
        choose_parameters(r, 0, finding->parameters);
        return true;
    }
    if (!shape->estimate)
        steady = lower_alone(r, shape, true, NULL);
    plain     = lower_alone(r, shape, false, NULL);
    bool both = steady != NODE_NONE && plain != steady;
    if (steady != NODE_NONE && search_of(r, shape, steady, true, &search))
        refuted = try_settings(r, shape, &search, both ? operations / 2 : operations, finding);
    if (!refuted && plain != steady && plain != NODE_NONE &&
        search_of(r, shape, plain, false, &search))
        refuted = try_settings(r, shape, &search, both ? operations / 2 : operations, finding);
    arena_free(r->in->scratch);
    return refuted;
}

/* What a declaration claims beside its distance. */
static bool try_claims(Refuter *r, size_t suspect, uint64_t operations, Finding *finding)
{
    const Shape *shape   = r->suspects.items[suspect].shape;
    Arena       *scratch = r->in->scratch;
    bool         refuted = false;
    ShapeClaims  claims  = claims_of(r->graph, shape, scratch);
    for (uint32_t i = 0; i < claims.count && !refuted && !r->stopped; i++) {
        const ShapeClaim *pair = &claims.items[i];
        Search            search;
        if (!search_new_claim(&search, r->graph, pair->a, pair->b, shape->box, scratch))
            continue;
        search.figure = shape->figure && strcmp(pair->property, "figure") != 0;
        search.random = r->random;
        r->random += 0x9e3779b97f4a7c15;
        finding->suspect = suspect;
        refuted          = try_settings(r, shape, &search, operations / claims.count, finding);
        if (refuted)
            finding->pair = *pair;
    }
    arena_free(scratch);
    return refuted;
}

/* What marches instead of a component's distance; `plain` where that is the distance itself. */
static Node lower_claim(Refuter *r, const Shape *shape, Claim claim, Node plain)
{
    Arena *scratch = r->in->scratch;
    return claim == CLAIM_GUARDED
               ? lower_guarded(r->graph, shape, plain, scratch)
               : lower_along(r->graph, shape, plain, (AlongMethod)(claim - CLAIM_ALONG), scratch);
}

/* The guarded distance of a component, and its steps along rays, where there are such. */
static bool try_steps(Refuter *r, size_t suspect, uint64_t operations, Finding *finding)
{
    const Shape *shape   = r->suspects.items[suspect].shape;
    const Claim  end     = CLAIM_ALONG + ALONG_PROBE; /* which is no distance */
    bool         refuted = false;
    Search       search;
    for (Claim claim = CLAIM_GUARDED; claim < end && !refuted && !r->stopped; claim++) {
        Node plain = lower_alone(r, shape, false, NULL);
        Node step  = plain == NODE_NONE ? plain : lower_claim(r, shape, claim, plain);
        if (step != plain && !shape->estimate && !shape->figure &&
            search_step(r, shape, step, plain, false, &search)) {
            search.aimed     = claim >= CLAIM_ALONG;
            finding->claim   = claim;
            finding->suspect = suspect;
            refuted          = try_settings(r, shape, &search, operations, finding);
        }
        arena_free(r->in->scratch);
    }
    return refuted;
}

/* ---- whom to blame ---- */

/* How far a shape that was met on the way is from its claim in two points; below 1: it is not. */
static double visit_ratio(const Visit *visit, bool steady, const NodeValue *at_p,
                          const NodeValue *at_q)
{
    const double *p = at_p[visit->point].v, *q = at_q[visit->point].v;
    double a = at_p[visit->distance].v[0], b = at_q[visit->distance].v[0], square = 0, size = 1;
    if (isnan(a) || isnan(b))
        return isfinite(p[0] + p[1] + p[2]) ? INFINITY : 0;
    for (int i = 0; i < 3; i++) {
        square += (p[i] - q[i]) * (p[i] - q[i]);
        size += fabs(p[i]);
    }
    double rise = steady && !visit->shape->estimate ? fabs(a - b)
                  : (a > 0) != (b > 0)              ? fmax(fabs(a), fabs(b))
                                                    : 0;
    return fmax(0, rise / visit->shape->slope - 1e-9 * size) / fmax(sqrt(square), 1e-9 * size);
}

/* All that is met on the way into a refuted shape, with the values at its two points. */
typedef struct Trail {
    Visits     visits; /* those with a distance; nodes are of `graph` */
    Graph     *graph;
    NodeValue *at_p, *at_q;
} Trail;

static void run_at(const Tape *tape, const NodeValue *parameters, const double point[3],
                   NodeValue *values)
{
    tape_run_frame(tape, parameters, values);
    tape_run_point(tape, point, values);
}

static Trail trail_of(Refuter *r, const Finding *finding)
{
    const Shape *shape = r->suspects.items[finding->suspect].shape;
    Arena       *arena = r->in->scratch;
    Trail        trail = {0};
    Visits       all   = {0};
    (void)lower_alone(r, shape, finding->steady, &all);
    for (size_t i = 0; i < all.count; i++)
        if (all.items[i].distance != NODE_NONE && all.items[i].shape != shape)
            array_push(arena, &trail.visits, all.items[i]);
    size_t count = trail.visits.count;
    Node  *roots = arena_new_array(arena, Node, 2 * count + 1);
    for (size_t i = 0; i < count; i++) {
        roots[2 * i]     = trail.visits.items[i].point;
        roots[2 * i + 1] = trail.visits.items[i].distance;
    }
    trail.graph = r->graph;
    trail.at_p  = arena_new_array(arena, NodeValue, r->graph->count);
    trail.at_q  = arena_new_array(arena, NodeValue, r->graph->count);
    Tape tape   = tape_new(r->graph, roots, 2 * count, arena);
    run_at(&tape, finding->parameters, finding->witness.p, trail.at_p);
    run_at(&tape, finding->parameters, finding->witness.q, trail.at_q);
    return trail;
}

static size_t suspect_of(const Refuter *r, const Shape *shape)
{
    for (size_t i = 0; i < r->suspects.count; i++)
        if (r->suspects.items[i].shape == shape)
            return i;
    return SIZE_MAX;
}

/* Searches a shape from two points on, at the parameters of a finding, which it replaces when the
   shape is refuted as well. */
static bool refute_from(Refuter *r, size_t suspect, const double p[3], const double q[3],
                        uint64_t operations, Finding *finding)
{
    const Shape *shape    = r->suspects.items[suspect].shape;
    bool         steady   = finding->steady && !shape->estimate;
    Node         distance = lower_alone(r, shape, steady, NULL);
    Search       search;
    if (distance == NODE_NONE || !search_of(r, shape, distance, steady, &search))
        return false;
    bool constant = finding->witness.fault == FAULT_CONSTANT;
    if (search_start(&search, finding->parameters) == constant)
        return false; /* this one is finite, or for another reason not to be searched */
    if (constant)
        search.worst.fault = FAULT_CONSTANT;
    else if (p)
        search_from(&search, p, q, operations / 4);
    if (!constant)
        search_run(&search, operations - (p ? operations / 4 : 0));
    if (!constant && !search_refuted(&search))
        return false;
    finding->suspect = suspect;
    finding->steady  = steady;
    finding->witness = search.worst;
    return true;
}

/* From a refuted shape to a smaller one that is refuted; false: there is none. */
static bool descend(Refuter *r, Finding *finding, uint64_t operations)
{
    Trail        trail = trail_of(r, finding);
    const Visit *best  = NULL;
    double       worst = 0;
    for (size_t i = 0; i < trail.visits.count; i++) {
        const Visit *visit = &trail.visits.items[i];
        double       ratio = visit_ratio(visit, finding->steady, trail.at_p, trail.at_q);
        bool         less  = !best || visit->shape->depth < best->shape->depth ||
                    (visit->shape->depth == best->shape->depth && ratio > worst);
        if (is_wrapper(visit->shape) || !(ratio > 1 + 1e-6) || !less)
            continue;
        best  = visit;
        worst = ratio;
    }
    size_t suspect = best ? suspect_of(r, best->shape) : SIZE_MAX;
    return suspect != SIZE_MAX && refute_from(r, suspect, trail.at_p[best->point].v,
                                              trail.at_q[best->point].v, operations, finding);
}

/* The same where no part is refuted in these points: each part is searched by itself. */
static bool search_parts(Refuter *r, Finding *finding, uint64_t operations)
{
    const Shape *shape = r->suspects.items[finding->suspect].shape;
    for (uint32_t i = 0; i < shape->child_count; i++) {
        size_t suspect = suspect_of(r, shape->children[i]);
        if (suspect != SIZE_MAX &&
            refute_from(r, suspect, NULL, NULL, operations / shape->child_count, finding))
            return true;
        arena_free(r->in->scratch);
    }
    return false;
}

static void find_culprit(Refuter *r, Finding *finding)
{
    uint64_t operations = r->total / 20;
    while (!r->stopped && finding->witness.fault != FAULT_BOX) {
        bool placed  = finding->witness.fault != FAULT_CONSTANT;
        bool smaller = placed && descend(r, finding, operations);
        arena_free(r->in->scratch);
        if (!smaller && !search_parts(r, finding, operations))
            return;
        arena_free(r->in->scratch);
    }
}

/* ---- the report ---- */

static const char *point_text(Refuter *r, const double p[3])
{
    return diag_text(r->in->diags, "[%.6g, %.6g, %.6g]", p[0], p[1], p[2]);
}

static const char *fault_text(Refuter *r, const Witness *w)
{
    switch (w->fault) {
    case FAULT_STEEP:
        return diag_text(r->in->diags, "it rises %.6g times as fast as it may", w->ratio);
    case FAULT_LONG:
        return diag_text(r->in->diags, "it is %.6g times as long as the way to the surface",
                         w->ratio);
    case FAULT_OUTSIDE: return "something of it is outside of its box";
    case FAULT_CONSTANT: return "a number in it that is the same at all points is not finite";
    case FAULT_BOX: return "a side of its box is not a number";
    case FAULT_CLAIM: /* report_claim */
    case FAULT_NAN:
    case FAULT_NONE: break;
    }
    return "it is not a number somewhere";
}

static bool has_place(const Witness *w)
{
    return w->fault != FAULT_CONSTANT && w->fault != FAULT_BOX;
}

static void note_points(Refuter *r, Diag *diag, const Witness *w)
{
    Diags      *diags = r->in->diags;
    const char *p     = point_text(r, w->p);
    if (w->fault == FAULT_STEEP || w->fault == FAULT_LONG)
        diag_note(diags, diag,
                  diag_text(diags, "the distance is %.6g at %s and %.6g at %s, %.6g apart", w->at_p,
                            p, w->at_q, point_text(r, w->q), distance3(w->p, w->q)));
    else if (has_place(w))
        diag_note(diags, diag, diag_text(diags, "the distance is %.6g at %s", w->at_p, p));
}

/* "with r = 0.5, time = 2"; what has no parameter says nothing. */
static void note_parameters(Refuter *r, Diag *diag, const NodeValue *parameters)
{
    const Scene *scene = r->in->scene;
    Text         text  = {.arena = r->in->arena};
    for (size_t i = 0; i < scene->parameters.count; i++) {
        const Parameter *parameter = &scene->parameters.items[i];
        text_format(&text, "%s%s = ", i ? ", " : "with ", parameter->name);
        for (uint32_t k = 0; k < parameter->components; k++)
            text_format(&text, "%s%.6g",
                        k                           ? ", "
                        : parameter->components > 1 ? "["
                                                    : "",
                        parameters[parameter->slot].v[k]);
        text_add(&text, parameter->components > 1 ? "]" : "");
    }
    text_format(&text, "%stime = %.6g", scene->parameters.count ? ", " : "at ", parameters[0].v[0]);
    diag_note(r->in->diags, diag, text.bytes);
}

/* What the distance says is empty, and where the surface is all the same. */
static void note_surface(Refuter *r, Diag *diag, const Finding *finding)
{
    const Shape   *shape = r->suspects.items[finding->suspect].shape;
    const Witness *w     = &finding->witness;
    Search         search;
    double         surface[3];
    if (w->fault != FAULT_STEEP && w->fault != FAULT_LONG)
        return;
    Node          distance = lower_alone(r, shape, finding->steady, NULL);
    const double *from     = fabs(w->at_p) >= fabs(w->at_q) ? w->p : w->q;
    double        said     = fmax(fabs(w->at_p), fabs(w->at_q));
    if (distance != NODE_NONE && search_of(r, shape, distance, false, &search) &&
        search_start(&search, finding->parameters) && search_surface(&search, from, surface))
        diag_note(r->in->diags, diag,
                  diag_text(r->in->diags,
                            "nothing is to be within %.6g of %s, but the surface is "
                            "at %s, %.6g away",
                            said, point_text(r, from), point_text(r, surface),
                            distance3(from, surface)));
    arena_free(r->in->scratch);
}

/* The component that the shape is a part of, and the place in that where it shows. */
static void note_component(Refuter *r, Diag *diag, const Finding *whole, const Finding *finding)
{
    const Suspect   *suspect   = &r->suspects.items[finding->suspect];
    const Component *component = &r->in->scene->components.items[suspect->component];
    if (whole->suspect == finding->suspect && suspect->parent == SIZE_MAX)
        return;
    const char *text = diag_text(r->in->diags, "it is part of `%s`%s", component->name,
                                 has_place(&finding->witness) ? "; points are in its own space"
                                                              : "");
    if (r->suspects.items[whole->suspect].parent == SIZE_MAX && has_place(&whole->witness))
        text = diag_text(r->in->diags, "%s; there, %s is where it shows", text,
                         point_text(r, whole->witness.p));
    diag_note(r->in->diags, diag, text);
}

/* The text where the author can do something: what is made in the library was asked for there. */
static void place_caller(Refuter *r, Diag *diag, const Finding *finding)
{
    const Sources *sources = r->in->diags->sources;
    size_t         i       = finding->suspect;
    if (!sources->items[diag->span.source].library)
        return;
    while (i != SIZE_MAX && sources->items[r->suspects.items[i].shape->span.source].library)
        i = r->suspects.items[i].parent;
    if (i != SIZE_MAX)
        diag_place(r->in->diags, diag, r->suspects.items[i].shape->span, "for this");
}

static const char *const claim_texts[] = {
    [CLAIM_DISTANCE]                  = "distance",
    [CLAIM_GUARDED]                   = "distance that leaves out what is far",
    [CLAIM_ALONG + ALONG_EXACT]       = "step along a ray (exact)",
    [CLAIM_ALONG + ALONG_TAYLOR]      = "step along a ray (taylor)",
    [CLAIM_ALONG + ALONG_ROOT_FREE]   = "step along a ray (root-free)",
    [CLAIM_ALONG + ALONG_DIRECTIONAL] = "step along a ray (directional)",
};

static void report(Refuter *r, const Finding *whole, const Finding *finding)
{
    const Shape *shape = r->suspects.items[finding->suspect].shape;
    Diags       *diags = r->in->diags;
    bool         claim = shape->kind == SHAPE_PRIMITIVE && (shape->exact || shape->claimed) &&
                 finding->claim == CLAIM_DISTANCE;
    Diag *diag  = diag_add(diags, DIAG_REFUTED, shape->span, "the %s of `%s` is refuted: %s",
                           claim_texts[finding->claim], shape->name,
                           fault_text(r, &finding->witness));
    diag->label = "this shape is to blame";
    if (claim && shape->distance != NODE_NONE)
        diag_place(diags, diag, r->graph->items[shape->distance].span,
                   shape->exact ? "`exact` is claimed of this" : "a `slope` is claimed of this");
    place_caller(r, diag, finding);
    note_points(r, diag, &finding->witness);
    if (finding->claim == CLAIM_DISTANCE)
        note_surface(r, diag, finding);
    note_parameters(r, diag, finding->parameters);
    note_component(r, diag, whole, finding);
    if (finding->witness.fault == FAULT_OUTSIDE && shape->kind == SHAPE_PRIMITIVE)
        diag->help = "make its `within` larger";
    else if (claim)
        diag->help = shape->exact ? "leave `exact` out: the compiler then derives a safe slope"
                                  : "leave `slope` out: the compiler then derives one";
    else if (shape->estimate)
        diag->help = "nothing is proven of an estimate, but none was ever found to be too long: "
                     "please report it";
    else
        diag->help = "nobody claimed this: it is a bug of krs, please report it";
}

static void report_claim(Refuter *r, const Finding *finding)
{
    Diags            *diags = r->in->diags;
    const ShapeClaim *pair  = &finding->pair;
    Diag *diag  = diag_add(diags, DIAG_REFUTED, pair->shape->span, "`%s` of `%s` is refuted: %s",
                           pair->property, pair->shape->name, pair->wrong);
    diag->label = "this shape is to blame";
    diag_place(diags, diag, pair->span, "claimed here");
    place_caller(r, diag, finding);
    diag_note(diags, diag,
              diag_text(diags, "by %.6g at %s", finding->witness.at_p,
                        point_text(r, finding->witness.p)));
    note_parameters(r, diag, finding->parameters);
    note_component(r, diag, finding, finding);
}

/* ---- the whole ---- */

static KrsStatus settle(Refuter *r, Finding *finding)
{
    Finding whole = *finding;
    if (finding->claim == CLAIM_DISTANCE && !finding->pair.property)
        find_culprit(r, finding);
    if (finding->pair.property)
        report_claim(r, finding);
    else
        report(r, &whole, finding);
    r->result->refuted = true;
    return KRS_BAD_SCENE;
}

static bool is_whole(const Refuter *r, size_t i) { return r->suspects.items[i].parent == SIZE_MAX; }

/* Those of all components, or all others, from the last, whose parts are fewest. */
static KrsStatus try_all(Refuter *r, bool whole, Finding *finding)
{
    size_t count = 0;
    for (size_t i = 0; i < r->suspects.count; i++)
        count += is_whole(r, i) == whole && !is_wrapper(r->suspects.items[i].shape);
    for (size_t i = r->suspects.count; i-- > 0 && !r->stopped;) {
        if (is_whole(r, i) != whole || is_wrapper(r->suspects.items[i].shape))
            continue;
        if (try_shape(r, i, r->total / 2 / count, finding) ||
            try_claims(r, i, r->total / 8 / count, finding) ||
            (whole && try_steps(r, i, r->total / 8 / count, finding)))
            return settle(r, finding);
    }
    return r->stopped ? KRS_INTERRUPTED : KRS_OK;
}

static void start_refuter(Refuter *r)
{
    const Scene *scene = r->in->scene;
    prepare_slopes(r);
    prepare_frames(r);
    for (size_t i = 0; i < scene->components.count; i++) {
        const Shape *shape = scene->components.items[i].shape;
        while (is_wrapper(shape) && shape->child_count)
            shape = shape->children[0];
        add_suspects(r, shape, (uint32_t)i, SIZE_MAX);
    }
    for (size_t i = 0; i < scene->half_spaces.count; i++)
        add_suspects(r, scene->half_spaces.items[i], 0, SIZE_MAX);
}

KrsStatus refute_inspected(const Inspected *in, const KrsRefuteOptions *how, KrsRefutation *result)
{
    *result   = (KrsRefutation){0};
    Refuter r = {.in     = in,
                 .graph  = in->scene->graph,
                 .how    = how,
                 .result = result,
                 .random = how->seed,
                 .total  = (uint64_t)(fmin(how->seconds, 1e9) * OPERATIONS_PER_SECOND) + 1};
    start_refuter(&r);
    Finding finding = {
        .parameters = arena_new_array(in->arena, NodeValue, r.graph->parameters.count)};
    KrsStatus status = try_all(&r, true, &finding);
    return status == KRS_OK ? try_all(&r, false, &finding) : status;
}

typedef struct Attempt {
    const KrsRefuteOptions *how;
    KrsRefutation          *result;
} Attempt;

static KrsStatus refute(void *user, const Inspected *in)
{
    Attempt *attempt = user;
    return refute_inspected(in, attempt->how, attempt->result);
}

KrsStatus krs_refute(const char *path, const KrsOptions *options, const KrsRefuteOptions *how,
                     KrsRefutation *result)
{
    Attempt attempt = {how, result};
    *result         = (KrsRefutation){0};
    return inspect_file(path, options, refute, &attempt);
}
