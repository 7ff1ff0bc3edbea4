/*
 * march.c: beams and primary rays.
 */
#include "runtime/tracer/march.h"

#include <string.h>

#include "runtime/tracer/dispatch.h"
#include "runtime/tracer/methods.h"
#include "runtime/tracer/pixel_filter.h"
#include "runtime/tracer/view.h"

#define MAX_PASS_STEPS 2048 /* the steps of a pass double up to this */

bool march_clear(Job *job)
{
    Gpu *gpu = job->gpu;
    if (!gpu_begin(gpu))
        return false;
    gpu_fill(gpu, &job->rendering->band.ends, 0, job->rendering->band.ends.size, STATE_MISS);
    return gpu_finish(gpu, &job->stats->phase_ms[KRS_PHASE_BEAMS]);
}

/* Returns the pixels that need rays: those of the listed tiles, or all pixels of the band. */
static Items pixels_of_rays(const Job *job, const March *march, const WorkBlock *work)
{
    const ControlBlock *control = job->rendering->control.bytes;
    if (march->of_paths)
        return ITEMS_COUNTED(1, tiles);
    return control->listed ? ITEMS_COUNTED(TILE * TILE, tiles)
                           : ITEMS_KNOWN(tiles_of_band(work) * TILE * TILE);
}

/* Writes to the control block which tiles overlap both the band and the job's window.  Returns
   their number. */
static uint32_t choose_tiles(const Job *job, const WorkBlock *work, uint32_t side)
{
    ControlBlock  *control      = job->rendering->control.bytes;
    const uint32_t window[2][2] = {{job->window.x, job->window.x + job->window.width},
                                   {job->window.y, job->window.y + job->window.height}};
    uint32_t       first[2], count[2];
    for (int i = 0; i < 2; i++) {
        uint32_t corner = work->corner[i], end = corner + work->extent[i];
        uint32_t low  = corner > window[i][0] ? corner : window[i][0];
        uint32_t high = end < window[i][1] ? end : window[i][1];
        if (high <= low)
            return 0;
        first[i] = low / side - corner / side;
        count[i] = (high - 1) / side - low / side + 1;
    }
    control->window = first[0] | first[1] << 16;
    control->across = count[0];
    return count[0] * count[1];
}

/* Returns the budget of beams: at most `most` for a lane, and steps enough to end them all, as
   beams are not saved.  However lanes share the beams, a lane's last one ends within the steps of
   one more than `items_per_lane`. */
static LaneBudget beam_budget(const Job *job, uint32_t most)
{
    LaneBudget budget     = lane_budget(job);
    budget.items_per_lane = budget.items_per_lane < most ? budget.items_per_lane : most;
    for (; budget.items_per_lane > 1; budget.items_per_lane /= 2) {
        uint32_t half = (budget.items_per_lane + 1) * MAX_BEAM_STEPS / 2; /* as in job_has_beams */
        if (rendering_steps_within(job->rendering, half) == half)
            break;
    }
    budget.steps = (budget.items_per_lane + 1) * MAX_BEAM_STEPS;
    return budget;
}

/* The operations of a distance below which beams of 4x4 pixels cost more than they gain. */
#define FLOPS_WORTH_QUARTERS 150

/* Marches the beams of tiles that overlap the band and the window; tiles are counted in the whole
   picture.  Tiles of 8x8 pixels whose beams find something are listed, and the rays of all others
   miss.  The quarters of the listed tiles may have beams, too. */
static bool run_beams(Job *job, const March *march, const WorkBlock *work)
{
    static const struct {
        uint32_t phase, side;
    } sizes[]             = {{TRACE_BEAMS_32, 32}, {TRACE_BEAMS_8, 8}};
    ControlBlock *control = job->rendering->control.bytes;
    LaneBudget    budget  = beam_budget(job, 2); /* one for each tile that a lane keeps */
    Dispatch      beams[2];
    control->tiles  = 0;
    control->source = ITEMS_FRESH;
    for (uint32_t i = 0; i < 2; i++) {
        uint32_t tiles       = choose_tiles(job, work, sizes[i].side);
        control->phase       = sizes[i].phase;
        control->starts_from = i;
        beams[i] = dispatch_of(job, KRS_PHASE_BEAMS, march->beams, work, ITEMS_KNOWN(tiles),
                               budget);
    }
    if (!dispatch_fused(job, beams, 2))
        return false;
    control->starts_from = control->listed = 1;
    if (march->flops < FLOPS_WORTH_QUARTERS)
        return true;
    control->phase = TRACE_BEAMS_4;
    beams[0]       = dispatch_of(job, KRS_PHASE_BEAMS, march->beams, work, ITEMS_COUNTED(4, tiles),
                                 beam_budget(job, 8)); /* four for each of these */
    if (!dispatch_run(job, &beams[0]))
        return false;
    control->starts_from = 2;
    return true;
}

/* Returns the steps of the next pass.  Each pass over the queue has twice as many as the one
   before, so that even the longest rays need few passes.  The first has `steps_at_once`: its rays
   all began together. */
static uint32_t next_steps(const Job *job, const ControlBlock *control, uint32_t steps)
{
    if (control->source != ITEMS_QUEUED)
        steps = job->options.methods.steps_at_once;
    else if (steps < MAX_PASS_STEPS)
        steps *= 2;
    return rendering_steps_within(job->rendering, steps);
}

/* Swaps the two queues: the next pass reads the one that the last pass has written. */
static void swap_queues(ControlBlock *control, const WorkBlock *work)
{
    uint32_t pixels  = work->extent[0] * work->extent[1];
    control->source  = ITEMS_QUEUED;
    control->reading = control->writing;
    control->writing = pixels - control->reading;
}

static bool run_rays(Job *job, const March *march, const WorkBlock *work, Items items,
                     LaneBudget budget)
{
    Dispatch dispatch = dispatch_of(job, march->phase, march->rays, work, items, budget);
    return dispatch_run(job, &dispatch);
}

/* Passes over the queue in a chain.  Most chains leave no ray over, and passes without rays cost
   little. */
#define PASSES_AT_ONCE 5

/* Traces rays in a chain: the host does not read after each pass how many rays are left. */
static bool trace_in_chain(Job *job, const March *march, const WorkBlock *work, LaneBudget budget)
{
    ControlBlock *control = job->rendering->control.bytes;
    Items         items   = pixels_of_rays(job, march, work);
    do {
        for (int pass = 0; pass <= PASSES_AT_ONCE; pass++) {
            if (!run_rays(job, march, work, items, budget))
                return false;
            budget.steps = next_steps(job, control, budget.steps);
            swap_queues(control, work);
            items = (Items){1, WORD_OF(queued), .resets = true};
        }
        if (!dispatch_finish(job))
            return false;
    } while (control->queued > 0);
    return true;
}

/* Returns the budget of rays.  Where they are not saved, a lane's last one may take all steps of a
   ray beyond those of the dispatch. */
static LaneBudget ray_budget(const Job *job)
{
    LaneBudget     budget = lane_budget(job);
    const uint32_t most   = rendering_steps_within(job->rendering, UINT32_MAX);
    if (!rendering_saves_rays(job->rendering, job->schedule) &&
        budget.steps > most - job->options.methods.max_steps)
        budget.steps = most - job->options.methods.max_steps;
    return budget;
}

/* Traces rays.  The first passes begin the rays of all pixels of the band, or of the listed tiles.
   Each further pass goes on with the rays that have not ended. */
static bool trace(Job *job, const March *march, const WorkBlock *work)
{
    ControlBlock *control = job->rendering->control.bytes;
    LaneBudget    budget  = ray_budget(job);
    Items         items   = pixels_of_rays(job, march, work);
    control->phase        = TRACE_RAYS;
    control->source       = ITEMS_FRESH;
    control->queued = control->writing = 0;
    if (dispatch_chains(job))
        return trace_in_chain(job, march, work, budget);
    while (budget.lanes * budget.items_per_lane > 128 &&
           items_now(job, items) / (budget.lanes * budget.items_per_lane) < 64)
        budget.items_per_lane /= 2; /* enough groups for all cores of the device */
    for (double left = job->progress_share;; left -= job->progress_share) {
        control->untaken    = 0;
        job->progress_share = 0.9 * left; /* few rays need a second pass */
        if (!run_rays(job, march, work, items, budget))
            return false;
        job->progress_done += job->progress_share;
        if (control->untaken > 0) {
            control->source = ITEMS_UNTAKEN;
            continue;
        }
        if (control->queued == 0)
            return true;
        budget.steps = next_steps(job, control, budget.steps);
        swap_queues(control, work);
        items                 = ITEMS_KNOWN(control->queued);
        control->queued       = 0;
        budget.items_per_lane = 1;
    }
}

/* Sets the box of the march, and the window of pixels whose rays may meet it. */
static void choose_window(Job *job, const March *march)
{
    FrameBlock *frame = job->rendering->frame.bytes;
    if (march->boxed)
        view_place_box(&job->view, march->low, march->high, frame);
    job->window = march->windowed ? view_window(frame, &job->view.camera,
                                                pixel_filter_reach(job->options.pixel_filter))
                                  : (KrsWindow){0, 0, job->options.width, job->options.height};
}

bool march_run(Job *job, const March *march, const WorkBlock *work)
{
    FrameBlock   *frame          = job->rendering->frame.bytes;
    ControlBlock *control        = job->rendering->control.bytes;
    const double  progress_share = job->progress_share;
    choose_window(job, march);
    job->schedule        = march->schedule;
    control->starts_from = control->listed = 0;
    control->of_paths                      = march->of_paths;
    job->progress_share                    = 0; /* beams are too short to show progress */
    bool good                              = !march->beams || run_beams(job, march, work);
    job->progress_share                    = progress_share;
    good                                   = good && trace(job, march, work);
    job->schedule                          = job->options.methods.schedule;
    memcpy(frame->low, job->frame.low, sizeof frame->low);
    memcpy(frame->high, job->frame.high, sizeof frame->high);
    return good;
}
