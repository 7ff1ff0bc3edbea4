/*
 * plan.c: the passes of a plan, run one after the other.
 */
#include "runtime/tracer/plan.h"

#include <math.h>
#include <string.h>

#include "runtime/tracer/dispatch.h"
#include "runtime/tracer/lane_rays.h"
#include "runtime/tracer/lane_surfaces.h"
#include "runtime/tracer/march.h"
#include "runtime/tracer/methods.h"
#include "runtime/tracer/pixel_filter.h"

/* A lane takes so many short items; all loops of a lane together may have 32,768 iterations. */
#define SHORT_ITEMS_OF_LANE 64
#define MIN_GROUPS          64 /* enough for all cores of the device */

/* ---- making a plan ---- */

static bool make_room(Plan *plan)
{
    size_t room   = plan->room ? 2 * plan->room : 32;
    Pass  *passes = plan->count < plan->room
                        ? plan->passes
                        : gpu_alloc(plan->gpu, room, sizeof *passes, "plan the picture");
    if (!passes || passes == plan->passes)
        return passes != NULL;
    if (plan->count)
        memcpy(passes, plan->passes, plan->count * sizeof *passes);
    gpu_release(plan->gpu, plan->passes);
    plan->passes = passes;
    plan->room   = room;
    return true;
}

void plan_add(Plan *plan, Pass pass)
{
    plan->failed = plan->failed || !make_room(plan);
    if (plan->failed)
        return;
    plan->passes[plan->count++] = pass;
    plan->weight += (double)pass.weight;
}

void plan_add_march(Plan *plan, const March *march, float weight)
{
    March *added = &plan->marches[plan->march_count++];
    *added       = *march;
    plan_add(plan, (Pass){PASS_MARCH, march->phase, weight, .march = added});
}

void plan_add_march_again(Plan *plan, float weight)
{
    const March *march = &plan->marches[plan->march_count - 1];
    plan_add(plan, (Pass){PASS_MARCH, march->phase, weight, .march = march});
}

void plan_free(Plan *plan)
{
    gpu_release(plan->gpu, plan->passes);
    if (plan->before.free)
        plan->before.free(plan->gpu, plan->before.own);
}

uint32_t plan_path_rows(const Plan *plan)
{
    return (plan->has_paths ? PATH_ROWS : 0) + (plan->field ? LANE_ROWS : 0);
}

/* ---- lists ---- */

/* Returns the counter of a list: the index of its word, as in Items; 0: it has none. */
static uint32_t counter_of(ListId list)
{
    switch (list) {
    case LIST_ALL: return WORD_OF(hit_count);
    case LIST_SPARSE: return WORD_OF(sparse);
    case LIST_REMAINING: return WORD_OF(remaining);
    case LIST_WIDE: return WORD_OF(wide);
    case LIST_OF_QUARTERS: return WORD_OF(quarters);
    case LIST_OF_PATHS: return WORD_OF(tiles);
    case LIST_OF_BAND:
    case LIST_OF_PIXELS:
    case NO_LIST: return 0;
    default: return WORD_OF(of_march_group) + (list - LIST_OF_MARCH_GROUP);
    }
}

/* Returns where a list begins in the buffer of lists, in words. */
static uint32_t list_at(const WorkBlock *work, ListId list)
{
    const uint32_t pixels = work->extent[0] * work->extent[1];
    if (list < LIST_SHARED)
        return list * pixels;
    return list == LIST_OF_QUARTERS
               ? LIST_SHARED * pixels + SHARED_LISTS * TILE * TILE * tiles_of_band(work)
               : 0;
}

static Items items_of(const WorkBlock *work, ListId list)
{
    if (list == LIST_OF_BAND)
        return ITEMS_KNOWN(tiles_of_band(work) * QUARTERS_OF_TILE);
    if (list == LIST_OF_PIXELS)
        return ITEMS_KNOWN(tiles_of_band(work) * TILE * TILE);
    return list == NO_LIST ? ITEMS_KNOWN(0) : (Items){1, counter_of(list), false};
}

/* ---- running a plan ---- */

/* Returns the budget of a pass of rays from the `count` pixels of a list. */
static LaneBudget budget_of_rays(const Job *job, uint32_t count)
{
    LaneBudget budget = lane_budget(job);
    budget.steps      = rendering_steps_within(job->rendering, MAX_LANE_STEPS);
    /* Loops in the distance leave a lane steps for few items. */
    bool loops = job->rendering->program->loops > 0;
    while (budget.lanes * budget.items_per_lane > 64 &&
           (loops || count / (budget.lanes * budget.items_per_lane) < MIN_GROUPS))
        budget.items_per_lane /= 2;
    return budget;
}

/* Returns the budget of a pass of `count` items that cost the same.  Where items are short a lane
   takes more of them, as it loads the frame and the lights once. */
static LaneBudget budget_of_items(const Job *job, const Pass *pass, uint32_t count)
{
    LaneBudget     budget = pixel_budget(job);
    const uint32_t least  = budget.items_per_lane;
    if (least == 1 || !pass->short_items || job->rendering->program->loops > 0)
        return budget;
    budget.items_per_lane = SHORT_ITEMS_OF_LANE;
    while (budget.items_per_lane > least &&
           count / (budget.lanes * budget.items_per_lane) < MIN_GROUPS)
        budget.items_per_lane /= 2;
    return budget;
}

/* Writes the constants of a pass to the control block, and makes its dispatch. */
static Dispatch dispatch_of_pass(const Job *job, const Pass *pass, const WorkBlock *work)
{
    ControlBlock *control = job->rendering->control.bytes;
    Items         items   = items_of(work, pass->in);
    control->phase        = pass->constants.phase;
    control->light        = pass->constants.light;
    control->value        = pass->constants.value;
    control->filters      = pass->constants.filters;
    control->of_paths     = pass->constants.of_paths;
    control->color_row    = pass->constants.color_row;
    control->count        = pass->constants.count;
    control->reading      = list_at(work, pass->in);
    uint32_t   count      = items_now(job, items);
    LaneBudget budget     = pass->kind == PASS_RAYS ? budget_of_rays(job, count)
                                                    : budget_of_items(job, pass, count);
    Dispatch   dispatch   = dispatch_of(job, pass->phase, pass->shader, work, items, budget);
    dispatch.clears       = counter_of(pass->out);
    return dispatch;
}

static bool run_rays(Job *job, const Pass *pass, const WorkBlock *work)
{
    ControlBlock *control = job->rendering->control.bytes;
    control->source       = ITEMS_FRESH;
    do { /* in a chain no item is left over */
        control->untaken       = 0;
        Dispatch dispatch      = dispatch_of_pass(job, pass, work);
        dispatch.clears_shared = pass->clears_shared && control->source == ITEMS_FRESH;
        if (control->source != ITEMS_FRESH) /* the list goes on */
            dispatch.clears = 0;
        if (!dispatch_run(job, &dispatch))
            return false;
        control->source = ITEMS_UNTAKEN;
    } while (control->untaken > 0);
    return true;
}

/* Returns the numbers of a list. */
static const uint32_t *words_of(const Job *job, const WorkBlock *work, ListId list)
{
    const Band *band = &job->rendering->band;
    return list == LIST_OF_PATHS ? band->tiles.bytes
                                 : (const uint32_t *)band->queue.bytes + list_at(work, list);
}

/* Hits of paths are those that are listed; others are the camera's, all of the band. */
static bool run_lanes(Job *job, const Plan *plan, const Pass *pass, const WorkBlock *work)
{
    const LanePaths paths = {words_of(job, work, pass->in),
                             items_now(job, items_of(work, pass->in))};
    return lane_rays_march(job, plan->field, work, pass->constants.of_paths ? &paths : NULL);
}

static bool run_surfaces(Job *job, const Plan *plan, const Pass *pass, const WorkBlock *work)
{
    const LanePaths paths = {words_of(job, work, pass->in),
                             items_now(job, items_of(work, pass->in))};
    return lane_surfaces_find(job, plan->surfaces, work, pass->constants.of_paths ? &paths : NULL);
}

/* Runs rays by lanes; shaders begin them, and do what comes of them. */
static bool run_lane_rays(Job *job, const Plan *plan, const Pass *pass, const WorkBlock *work)
{
    ControlBlock *control = job->rendering->control.bytes;
    Pass          arrive  = *pass;
    arrive.shader         = pass->arrive;
    control->source       = ITEMS_FRESH;
    Dispatch before       = dispatch_of_pass(job, pass, work);
    before.clears_shared  = pass->clears_shared;
    if (!dispatch_run(job, &before) ||
        !lane_rays_march_secondary(job, plan->field, pass->phase, items_now(job, before.items),
                                   work))
        return false;
    Dispatch behind = dispatch_of_pass(job, &arrive, work);
    behind.clears   = 0;
    return dispatch_run(job, &behind);
}

/* Runs passes that may share a submission. */
static bool run_items(Job *job, const Pass *passes, size_t count, const WorkBlock *work)
{
    ControlBlock *control = job->rendering->control.bytes;
    Dispatch      dispatches[MAX_FUSED];
    control->source = ITEMS_FRESH;
    for (size_t i = 0; i < count; i++)
        dispatches[i] = dispatch_of_pass(job, &passes[i], work);
    return count == 1 ? dispatch_run(job, dispatches) : dispatch_fused(job, dispatches, count);
}

static bool run_passes(Job *job, const Plan *plan, const Pass *passes, size_t count,
                       const WorkBlock *work)
{
    switch (passes[0].kind) {
    case PASS_CLEAR: return march_clear(job);
    case PASS_LANES: return run_lanes(job, plan, passes, work);
    case PASS_SURFACES: return run_surfaces(job, plan, passes, work);
    case PASS_OCCLUDERS:
        return lane_surfaces_find_occluders(job, plan->surfaces, list_at(work, LIST_REMAINING),
                                            work);
    case PASS_MARCH: return march_run(job, passes[0].march, work);
    case PASS_ITEMS: return run_items(job, passes, count, work);
    case PASS_LANE_RAYS: return run_lane_rays(job, plan, passes, work);
    case PASS_RAYS: return run_rays(job, passes, work);
    }
    return false;
}

/* Returns the number of passes from `first` on that may share a submission. */
static size_t count_fused(const Plan *plan, size_t first)
{
    size_t count = 1;
    while (first + count < plan->count && plan->passes[first + count].with_previous &&
           count < MAX_FUSED)
        count++;
    return count;
}

/* Finds the position of ray `index` within its pixel.  Ray 0 goes through the centre.  The others
   follow the R2 sequence: multiples of the powers of the plastic number, modulo 1.  It fills the
   pixel evenly, however many rays there are.  The seed moves all of them but ray 0.  The filter
   spreads them by its weight. */
static void place_ray(uint32_t index, uint64_t seed, KrsPixelFilter filter, float offset[2])
{
    static const double increment[2] = {0.75487766624669276, 0.56984029099805327};
    for (int i = 0; i < 2; i++) {
        uint64_t hash = seed * 2 + (uint64_t)i; /* splitmix64 */
        hash          = (hash ^ hash >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
        hash          = (hash ^ hash >> 27) * UINT64_C(0x94d049bb133111eb);
        hash ^= hash >> 31;
        double moved = seed && index ? (double)(hash >> 11) / 9007199254740992.0 : 0;
        double place = 0.5 + increment[i] * index + moved;
        offset[i]    = (float)pixel_filter_place(filter, place - floor(place));
    }
}

/* Returns the filter.  Rays of a list are those of their own pixels: there is nothing to place. */
static KrsPixelFilter filter_of(const Job *job)
{
    return job->rays ? KRS_PIXEL_FILTER_BOX : job->options.pixel_filter;
}

/* Writes to the control block what all passes of this ray need, and empties the lists. */
static void begin_ray(Job *job, const Plan *plan, uint32_t index)
{
    ControlBlock *control   = job->rendering->control.bytes;
    control->ray            = index;
    control->rays           = job->options.samples;
    control->first_ray      = index == 0;
    control->rows           = index == 0 ? job->first_rows : job->later_rows;
    control->by_march_group = plan->by_march_group;
    control->hit_count = control->sparse = control->quarters = 0;
    memset(control->of_march_group, 0, sizeof control->of_march_group);
}

bool plan_run(Job *job, const Plan *plan, WorkBlock *work, uint32_t index)
{
    const double whole = job->progress_share, start = job->progress_done;
    double       done = 0;
    place_ray(index, job->options.seed, filter_of(job), work->offset);
    begin_ray(job, plan, index);
    if (plan->before.run && !plan->before.run(job, plan->before.own, index))
        return false;
    for (size_t i = 0, count; i < plan->count; i += count) {
        double weight = 0;
        count         = count_fused(plan, i);
        for (size_t k = 0; k < count; k++)
            weight += (double)plan->passes[i + k].weight;
        job->progress_done  = start + whole * done / plan->weight;
        job->progress_share = whole * weight / plan->weight;
        if (!run_passes(job, plan, &plan->passes[i], count, work))
            return false;
        done += weight;
    }
    return dispatch_finish(job);
}
