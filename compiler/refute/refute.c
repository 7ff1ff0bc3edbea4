/*
 * refute.c: the attempt to refute the distance of every shape of a scene.
 *
 * Every shape of the trees is lowered by itself and searched (search.h): as it is where something
 * above moves its surface, which needs the slope, and as it is where nothing does.  Components
 * come first, and have half of the time; then their parts, parts of parts before the whole.
 */
#include "compiler/refute/refute.h"

#include <math.h>
#include <string.h>

#include "compiler/base/splitmix.h"
#include "compiler/lower/lower.h"
#include "compiler/lower/research/research.h"
#include "compiler/refute/refute_blame.h"
#include "compiler/refute/refute_report.h"
#include "compiler/refute/refute_settings.h"
#include "compiler/refute/refuter.h"
#include "compiler/refute/search.h"

/* The speed of the machine whose seconds are counted; most of today's are as fast, or faster. */
static const double OPERATIONS_PER_SECOND = 1e8;

/* After so many operations somebody is asked whether to go on. */
static const uint64_t SLICE = 10000000;

enum { MAX_SHAPES = 4096, MAX_TRIALS = 6 };

/* ---- shapes ---- */

static bool is_known(const Refuter *r, const Shape *shape)
{
    for (size_t i = 0; i < r->suspects.count; i++)
        if (r->suspects.items[i].shape == shape)
            return true;
    return false;
}

static void add_suspects(Refuter *r, const Shape *shape, uint32_t component, size_t parent)
{
    if (r->suspects.count >= MAX_SHAPES || is_known(r, shape))
        return;
    size_t own = r->suspects.count;
    array_push(r->in->arena, &r->suspects, ((Suspect){shape, component, parent}));
    for (uint32_t i = 0; i < shape->child_count; i++)
        add_suspects(r, shape->children[i], component, own);
}

/* ---- looking at a shape ---- */

static void report_progress(Refuter *r, uint64_t operations)
{
    r->done += operations;
    double fraction = fmin(1, (double)r->done / (double)r->total);
    if (r->how->progress && !r->how->progress(r->how->user, fraction))
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

static void record(Finding *finding, bool lipschitz, Witness witness, const NodeValue *parameters,
                   size_t slots)
{
    finding->lipschitz = lipschitz;
    finding->witness   = witness;
    memcpy(finding->parameters, parameters, slots * sizeof *parameters);
}

/* Tries one distance at several settings; the worst that refutes it goes to *finding. */
static bool try_settings(Refuter *r, const Shape *shape, Search *search, uint64_t operations,
                         Finding *finding)
{
    uint32_t   trials     = needs_parameters(&search->tape) ? MAX_TRIALS : 1;
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
            record(finding, search->steep, (Witness){.fault = FAULT_CONSTANT}, parameters, slots);
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
        record(finding, search->steep, search->worst, parameters, slots);
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

/* Tries both distances of a shape, if there are two. */
static bool try_shape(Refuter *r, size_t suspect, uint64_t operations, Finding *finding)
{
    const Shape *shape     = r->suspects.items[suspect].shape;
    Node         lipschitz = NODE_NONE, plain = NODE_NONE;
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
        lipschitz = lower_alone(r, shape, true, NULL);
    plain     = lower_alone(r, shape, false, NULL);
    bool both = lipschitz != NODE_NONE && plain != lipschitz;
    if (lipschitz != NODE_NONE && search_of(r, shape, lipschitz, true, &search))
        refuted = try_settings(r, shape, &search, both ? operations / 2 : operations, finding);
    if (!refuted && plain != lipschitz && plain != NODE_NONE &&
        search_of(r, shape, plain, false, &search))
        refuted = try_settings(r, shape, &search, both ? operations / 2 : operations, finding);
    arena_free(r->in->scratch);
    return refuted;
}

/* Tries what a declaration claims beside its distance. */
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
        (void)splitmix_next(&r->random);
        finding->suspect = suspect;
        refuted          = try_settings(r, shape, &search, operations / claims.count, finding);
        if (refuted)
            finding->pair = *pair;
    }
    arena_free(scratch);
    return refuted;
}

/* Lowers what marches instead of a component's distance; `plain` if that is the distance itself. */
static Node lower_claim(Refuter *r, const Shape *shape, Claim claim, Node plain)
{
    Arena *scratch = r->in->scratch;
    return claim == CLAIM_GUARDED ? lower_guarded(r->graph, shape, plain, NULL, scratch)
           : claim == CLAIM_ALONG
               ? lower_along(r->graph, shape, plain, NULL, scratch)
               : lower_research(r->graph, shape, plain, (ResearchMethod)(claim - CLAIM_RESEARCH),
                                NULL, scratch);
}

/* Tries the guarded distance of a component, and its steps along rays, where there are such. */
static bool try_steps(Refuter *r, size_t suspect, uint64_t operations, Finding *finding)
{
    const Shape *shape   = r->suspects.items[suspect].shape;
    const Claim  end     = CLAIM_RESEARCH + RESEARCH_PROBE; /* which is no distance */
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
    if (!refuted)
        finding->claim = CLAIM_DISTANCE;
    return refuted;
}

/* ---- the whole ---- */

static KrsStatus conclude(Refuter *r, Finding *finding)
{
    Finding whole = *finding;
    if (finding->claim == CLAIM_DISTANCE && !finding->pair.property)
        find_culprit(r, finding);
    if (finding->pair.property)
        report_claim(r, finding);
    else
        report_finding(r, &whole, finding);
    r->result->refuted = true;
    return KRS_BAD_SCENE;
}

static bool is_whole(const Refuter *r, size_t i) { return r->suspects.items[i].parent == SIZE_MAX; }

/* Tries all components, or all others, from the last, whose trees are smallest. */
static KrsStatus try_all(Refuter *r, bool whole, Finding *finding)
{
    size_t count = 0;
    for (size_t i = 0; i < r->suspects.count; i++)
        count += is_whole(r, i) == whole && !is_wrapper(r->suspects.items[i].shape);
    for (size_t i = r->suspects.count; i-- > 0 && !r->stopped;) {
        if (is_whole(r, i) != whole || is_wrapper(r->suspects.items[i].shape))
            continue;
        /* Thousands of shapes would have too many nodes. */
        GraphMark mark = graph_mark(r->graph);
        if (try_shape(r, i, r->total / 2 / count, finding) ||
            try_claims(r, i, r->total / 8 / count, finding) ||
            (whole && try_steps(r, i, r->total / 8 / count, finding))) {
            graph_keep(r->graph);
            return conclude(r, finding);
        }
        graph_release(r->graph, mark);
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

KrsStatus krs_refute(const char *text, size_t length, const char *name, const KrsOptions *options,
                     const KrsRefuteOptions *how, KrsRefutation *result)
{
    Attempt attempt = {how, result};
    *result         = (KrsRefutation){0};
    return inspect_text(text, length, name, options, refute, &attempt);
}
