/*
 * dispatch.c: long dispatches are cut into slices, short ones are joined into chains.
 *
 * A slice is so short that no watchdog of the driver ends it, and that an interruption takes effect
 * at once.  How many items that is, is learned from the time of former slices; the results do not
 * depend on it.  Workgroups would not do: those of small pictures have fewer items, so that there are
 * enough of them.  In a chain no dispatch has more items than a slice.  Where one would have more, the
 * chain stops, and the host runs that dispatch in slices.
 */
#include "runtime/tracer/dispatch.h"

#include <math.h>
#include <string.h>

#include "runtime/tracer/methods.h"
#include "runtime/tracer/rendering.h"

static_assert(WORD_OF(items) == ITEMS_WORD && WORD_OF(groups) == GROUPS_WORD &&
                  WORD_OF(stopped) == STOPPED_WORD && WORD_OF(ran) == RAN_WORD,
              "next_dispatch.comp");
static_assert((int)GROUP_LISTS == 1 + KRS_MAX_MARCH_GROUPS &&
                  (int)PERSPECTIVE == (int)KRS_PERSPECTIVE &&
                  (int)ORTHOGRAPHIC == (int)KRS_ORTHOGRAPHIC && (int)PANORAMA == (int)KRS_PANORAMA,
              "compile.h");

bool dispatch_chains(const Job *job)
{
    return !gpu_is_cpu(job->gpu) && job->options.methods.schedule != KRS_SCHEDULE_REFILL;
}

/* ---- Slices ---- */

/* Returns the items of the next slice, after `items` of them took `ms`. */
static double next_slice(double items, double ms, double target_ms)
{
    double factor = ms > 0 ? target_ms / ms : 4;
    return fmax(items * fmin(fmax(factor, 0.1), 4), 1);
}

/* Returns the workgroups that have so many items. */
static uint32_t groups_of_slice(double items, double in_group)
{
    return (uint32_t)fmin(fmax(items / in_group, 1), MAX_GROUPS);
}

/* A phase may turn out to have more passes than was expected, but reported progress never
   decreases. */
bool dispatch_report(Job *job, double within_phase)
{
    job->progress_shown = fmax(job->progress_shown,
                               fmin(job->progress_done + job->progress_share * within_phase, 1));
    if (job->options.progress && !job->options.progress(job->options.user, job->progress_shown)) {
        gpu_refuse(job->gpu, KRS_INTERRUPTED, "interrupted");
        return false;
    }
    return true;
}

static bool has_scene(const Job *job, const Shader *shader)
{
    bool is_pixels = shader == &job->rendering->renderer->clear_shared;
    for (int i = 0; i < PIXEL_SHADERS; i++)
        is_pixels = is_pixels || shader == job_pixel_shader(job, (PixelShader)i);
    return !is_pixels;
}

/* Tells how many items of this shader make a slice, as learned so far.  Shaders without the scene cost next
   to nothing, so they are counted separately from the others of a phase. */
static double *items_at_once(Job *job, KrsPhase phase, const Shader *shader)
{
    return &job->rendering->items_at_once[phase][has_scene(job, shader)];
}

static bool run_groups(Job *job, const Dispatch *dispatch, WorkBlock *work, uint32_t groups)
{
    double *at_once = items_at_once(job, dispatch->phase, dispatch->shader);
    for (uint32_t first = 0; first < groups;) {
        const uint32_t most  = groups_of_slice(*at_once, dispatch->in_group);
        const uint32_t count = most < groups - first ? most : groups - first;
        double         ms    = 0;
        work->first          = first;
        work->groups         = count;
        work->stride         = rendering_spread(job->rendering, count);
        if (!rendering_begin(job->rendering))
            return false;
        rendering_dispatch(job->rendering, dispatch->shader, job->rendering->band_set, work,
                           sizeof *work, count);
        if (!rendering_finish(job->rendering, &ms))
            return false;
        job->stats->phase_ms[dispatch->phase] += ms;
        /* The last slice may be too small to learn much from. */
        if (count == most || ms > job->options.slice_ms)
            *at_once = next_slice((double)count * dispatch->in_group, ms, job->options.slice_ms);
        first += count;
        if (!dispatch_report(job, (double)first / groups))
            return false;
    }
    return true;
}

/* ---- Dispatches ---- */

static uint32_t *word_of(const Job *job, uint32_t counter)
{
    return (uint32_t *)job->rendering->control.bytes + counter;
}

uint32_t items_now(const Job *job, Items items)
{
    return items.counter ? items.each * *word_of(job, items.counter) : items.each;
}

static uint32_t groups_of(const Dispatch *dispatch, uint32_t items)
{
    return (items + dispatch->in_group - 1) / dispatch->in_group;
}

Dispatch dispatch_of(const Job *job, KrsPhase phase, const Shader *shader, const WorkBlock *work,
                     Items items, LaneBudget budget)
{
    Dispatch dispatch               = {.phase    = phase,
                                       .shader   = shader,
                                       .work     = *work,
                                       .items    = items,
                                       .in_group = budget.lanes * budget.items_per_lane};
    dispatch.control                = *(const ControlBlock *)job->rendering->control.bytes;
    dispatch.control.items_per_lane = budget.items_per_lane;
    dispatch.work.steps             = budget.steps;
    return dispatch;
}

/* Records that the words which neighbours share are cleared (shared.glsl). */
static void record_unshared(const Job *job, const WorkBlock *work)
{
    const uint64_t list  = (uint64_t)work->extent[0] * work->extent[1];
    const uint64_t tiles = (uint64_t)((work->extent[0] + TILE - 1) / TILE) *
                           ((work->extent[1] + TILE - 1) / TILE);
    const uint64_t words = SHARED_LISTS * tiles * TILE * TILE;
    gpu_fill(job->gpu, &job->rendering->band.queue, LIST_SHARED * list * sizeof(uint32_t),
             words * sizeof(uint32_t), 0);
}

static bool clear_shared(Job *job, const Dispatch *dispatch)
{
    double ms = 0;
    if (!rendering_begin(job->rendering))
        return false;
    record_unshared(job, &dispatch->work);
    if (!rendering_finish(job->rendering, &ms))
        return false;
    job->stats->phase_ms[dispatch->phase] += ms;
    return true;
}

/* Runs a dispatch in slices.  The host has waited for all dispatches before it, so it knows the
   counters. */
static bool run_in_slices(Job *job, const Dispatch *dispatch)
{
    ControlBlock *control = job->rendering->control.bytes;
    WorkBlock     work    = dispatch->work;
    uint32_t      items   = items_now(job, dispatch->items);
    memcpy(control, &dispatch->control, offsetof(ControlBlock, queued));
    control->items = items;
    if (dispatch->items.resets)
        *word_of(job, dispatch->items.counter) = 0;
    if (dispatch->clears)
        *word_of(job, dispatch->clears) = 0;
    if (dispatch->clears_shared && !clear_shared(job, dispatch))
        return false;
    return run_groups(job, dispatch, &work, groups_of(dispatch, items));
}

/* ---- Chains ---- */

/* Returns the cost of a workgroup, in items: later passes of rays have more steps. */
static double weight_of(const Job *job, const Dispatch *dispatch)
{
    double steps = job->options.methods.steps_at_once;
    return dispatch->in_group *
           (dispatch->phase == KRS_PHASE_PRIMARY ? fmax(dispatch->work.steps / steps, 1) : 1);
}

static uint32_t max_groups(Job *job, const Dispatch *dispatch)
{
    const double at_once = *items_at_once(job, dispatch->phase, dispatch->shader);
    return groups_of_slice(at_once, weight_of(job, dispatch));
}

static void record(Job *job, uint32_t i)
{
    KrsRendering           *r        = job->rendering;
    const Dispatch         *dispatch = &job->chain.list[i];
    const Items            *items    = &dispatch->items;
    const NextDispatchBlock next     = {items->counter,
                                        items->each,
                                        items->resets,
                                        dispatch->in_group,
                                        max_groups(job, dispatch),
                                        i + 1,
                                        dispatch->clears};
    WorkBlock               work     = dispatch->work;
    work.first                       = 0;
    work.groups                      = INT32_MAX; /* all groups, in their order (find_cell) */
    work.stride                      = 1;
    gpu_write(job->gpu, rendering_control(r), 0, &dispatch->control,
              offsetof(ControlBlock, queued));
    gpu_barrier(job->gpu);
    rendering_dispatch(r, &r->renderer->next_dispatch, r->band_set, &next, sizeof next, 1);
    gpu_barrier(job->gpu);
    rendering_dispatch_counted(r, dispatch->shader, r->band_set, &work, sizeof work);
    gpu_barrier(job->gpu);
}

/* Learns from dispatches [first, end) of the chain, all of one phase, which took `ms` together. */
static void learn(Job *job, uint32_t first, uint32_t end, double ms)
{
    const ControlBlock *control = job->rendering->control.bytes;
    const Dispatch     *list = job->chain.list, *measured = &list[first];
    double              items = 0, target_ms = job->options.slice_ms;
    for (uint32_t i = first; i < end; i++)
        if (has_scene(job, list[i].shader))
            measured = &list[i];
    for (uint32_t i = first; i < end; i++)
        if (has_scene(job, list[i].shader) == has_scene(job, measured->shader))
            items += control->ran[i] * weight_of(job, &list[i]);
    double      *at_once = items_at_once(job, measured->phase, measured->shader);
    const double next    = next_slice(items, ms, target_ms);
    if (items > 0 && (ms > target_ms || next > *at_once))
        *at_once = next;
    job->stats->phase_ms[measured->phase] += ms;
}

/* Submits the dispatches of the chain from `first` on.  Consecutive dispatches of one phase are
   timed together. */
static bool submit(Job *job, uint32_t first)
{
    const Chain *chain = &job->chain;
    double       whole = 0, ms;
    if (!rendering_begin(job->rendering))
        return false;
    for (uint32_t i = first; i < chain->count; i++) {
        record(job, i);
        if (i + 1 == chain->count || chain->list[i + 1].phase != chain->list[i].phase)
            gpu_mark(job->gpu);
    }
    if (!rendering_finish(job->rendering, &whole))
        return false;
    for (uint32_t mark = 0, i = first; i < chain->count; mark++) {
        uint32_t from = i++;
        while (i < chain->count && chain->list[i].phase == chain->list[from].phase)
            i++;
        if (!gpu_marked(job->gpu, mark, &ms))
            return false;
        learn(job, from, i, job->gpu->has_clock ? ms : mark == 0 ? whole : 0);
    }
    return true;
}

bool dispatch_finish(Job *job)
{
    ControlBlock *control = job->rendering->control.bytes;
    Chain        *chain   = &job->chain;
    for (uint32_t first = 0; first < chain->count;) {
        control->stopped = 0;
        if (!submit(job, first) || !dispatch_report(job, 1))
            return false;
        if (control->stopped == 0)
            break;
        first = control->stopped;
        /* The host has already written values for dispatches after the chain. */
        ControlBlock next = *control;
        if (!run_in_slices(job, &chain->list[first - 1]))
            return false;
        memcpy(control, &next, offsetof(ControlBlock, queued));
    }
    chain->count = 0;
    return true;
}

static bool add_to_chain(Job *job, const Dispatch *dispatch)
{
    Chain *chain = &job->chain;
    if (chain->count == MAX_CHAINED && !dispatch_finish(job))
        return false;
    chain->list[chain->count++] = *dispatch;
    return true;
}

/* Returns the dispatch that clears in a chain what neighbours share, before another one. */
static Dispatch clearing_before(const Job *job, const Dispatch *dispatch)
{
    Dispatch         clearing = *dispatch;
    const LaneBudget budget   = pixel_budget(job);
    clearing.shader           = &job->rendering->renderer->clear_shared;
    clearing.items            = ITEMS_KNOWN(tiles_of_band(&dispatch->work) * QUARTERS_OF_TILE);
    clearing.in_group         = budget.lanes * budget.items_per_lane;
    clearing.control.items_per_lane = budget.items_per_lane;
    clearing.clears                 = 0;
    return clearing;
}

bool dispatch_run(Job *job, const Dispatch *dispatch)
{
    if (!dispatch_chains(job))
        return run_in_slices(job, dispatch);
    Dispatch chained      = *dispatch;
    chained.clears_shared = false;
    if (dispatch->clears_shared) {
        const Dispatch clearing = clearing_before(job, &chained);
        if (!add_to_chain(job, &clearing))
            return false;
    }
    return add_to_chain(job, &chained);
}

bool dispatch_fused(Job *job, const Dispatch *dispatches, size_t count)
{
    KrsPhase phase   = dispatches[0].phase;
    double  *at_once = items_at_once(job, phase, dispatches[0].shader), items = 0, ms = 0;
    bool     good = true;
    for (size_t i = 0; i < count; i++)
        items += items_now(job, dispatches[i].items);
    if (dispatch_chains(job) || items == 0 || items > *at_once) {
        for (size_t i = 0; i < count && good; i++)
            good = dispatch_run(job, &dispatches[i]);
        return good;
    }
    if (!rendering_begin(job->rendering))
        return false;
    for (size_t i = 0; i < count; i++) {
        Dispatch dispatch = dispatches[i];
        uint32_t own      = groups_of(&dispatch, items_now(job, dispatch.items));
        if (own == 0)
            continue;
        dispatch.control.items = items_now(job, dispatch.items);
        dispatch.work.first    = 0;
        dispatch.work.groups   = own;
        dispatch.work.stride   = rendering_spread(job->rendering, own);
        gpu_write(job->gpu, rendering_control(job->rendering), 0, &dispatch.control,
                  offsetof(ControlBlock, queued));
        gpu_barrier(job->gpu);
        rendering_dispatch(job->rendering, dispatch.shader, job->rendering->band_set,
                           &dispatch.work, sizeof dispatch.work, own);
        gpu_barrier(job->gpu);
    }
    if (!rendering_finish(job->rendering, &ms))
        return false;
    job->stats->phase_ms[phase] += ms;
    if (ms > job->options.slice_ms)
        *at_once = next_slice(items, ms, job->options.slice_ms);
    return dispatch_report(job, 1);
}

/* Items of a lane on lavapipe, where all items cost the same. */
#define ITEMS_OF_LANE 8

LaneBudget pixel_budget(const Job *job)
{
    return (LaneBudget){64, gpu_is_cpu(job->gpu) ? ITEMS_OF_LANE : 1, 0};
}

LaneBudget lane_budget(const Job *job)
{
    uint32_t steps = job->options.methods.steps_at_once;
    if (job->schedule == KRS_SCHEDULE_REFILL)
        steps = 8 * steps < MAX_LANE_STEPS ? 8 * steps : MAX_LANE_STEPS;
    steps = rendering_steps_within(job->rendering, steps);
    if (job->schedule == KRS_SCHEDULE_REFILL)
        return (LaneBudget){job->gpu->refill_lanes, 128, steps};
    return (LaneBudget){64, 1, steps};
}
