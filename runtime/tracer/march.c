/*
 * march.c: beams and primary rays.
 */
#include <string.h>

#include "runtime/tracer/phases.h"
#include "runtime/tracer/view.h"

#define MOST_BEAM_STEPS 256  /* of a beam, as in trace.comp */
#define MOST_PASS_STEPS 2048 /* of rays that are left over, in one more pass */

uint32_t tiles_of_band(const WorkBlock *work)
{
    return ((work->extent[0] + TILE - 1) / TILE) * ((work->extent[1] + TILE - 1) / TILE);
}

/* Until a ray is found to hit something it misses. */
static bool clear_ends(Job *job)
{
    Gpu *gpu = job->gpu;
    if (!gpu_begin(gpu))
        return false;
    vkCmdFillBuffer(gpu->commands, job->rendering->band.ends.buffer, 0, VK_WHOLE_SIZE, STATE_MISS);
    return gpu_finish(gpu, &job->picture->stats.phase_ms[KRS_PHASE_BEAMS]);
}

/* The pixels of tiles whose rays may hit something. */
static Items pixels_of_rays(const Job *job, const WorkBlock *work)
{
    const ControlBlock *control = job->rendering->control.bytes;
    return control->listed ? ITEMS_COUNTED(TILE * TILE, tiles)
                           : ITEMS_KNOWN(tiles_of_band(work) * TILE * TILE);
}

/* The tiles that both the band and the job's window have a part of, as the control block has it;
   returns how many. */
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

/* At most so many beams for a lane, and steps enough for all, as none is saved: whichever lanes
   take them, the last is done after those of a lane and one more. */
static LaneBudget beam_budget(const Job *job, uint32_t most)
{
    LaneBudget budget     = lane_budget(job);
    budget.items_per_lane = budget.items_per_lane < most ? budget.items_per_lane : most;
    for (; budget.items_per_lane > 1; budget.items_per_lane /= 2) {
        uint32_t half = (budget.items_per_lane + 1) * MOST_BEAM_STEPS / 2; /* as in has_beams */
        if (rendering_steps_within(job->rendering, half) == half)
            break;
    }
    budget.steps = (budget.items_per_lane + 1) * MOST_BEAM_STEPS;
    return budget;
}

/* Where a distance costs less than this, beams of 4x4 pixels cost more than they gain. */
#define FLOPS_WORTH_QUARTERS 150

/* Beams of tiles, counted in the whole picture, that the band and the window have a part of.  Those
   of 8x8 pixels that find something are listed; the rays of all others miss.  The quarters of the
   listed ones may have beams, too. */
static bool march_beams(Job *job, const WorkBlock *work, double flops)
{
    static const struct {
        uint32_t phase, side;
    } sizes[]             = {{TRACE_BEAMS_32, 32}, {TRACE_BEAMS_8, 8}};
    ControlBlock *control = job->rendering->control.bytes;
    LaneBudget    budget  = beam_budget(job, 2); /* a slot each, of two that a lane keeps */
    Dispatch      beams[2];
    control->tiles  = 0;
    control->source = ITEMS_FRESH;
    for (uint32_t i = 0; i < 2; i++) {
        uint32_t tiles       = choose_tiles(job, work, sizes[i].side);
        control->phase       = sizes[i].phase;
        control->starts_from = i;
        beams[i] = dispatch_of(job, KRS_PHASE_BEAMS, job->beams, work, ITEMS_KNOWN(tiles), budget);
    }
    if (!dispatch_together(job, beams, 2))
        return false;
    control->starts_from = control->listed = 1;
    if (flops < FLOPS_WORTH_QUARTERS)
        return true;
    control->phase = TRACE_BEAMS_4;
    if (!dispatch_items(job, KRS_PHASE_BEAMS, job->beams, work, ITEMS_COUNTED(4, tiles),
                        beam_budget(job, 8))) /* four of a slot */
        return false;
    control->starts_from = 2;
    return true;
}

/* Each pass twice as long as the one before, so that they are few even for the longest rays: the
   first is of rays that have begun, all at the same time. */
static uint32_t next_steps(const Job *job, const ControlBlock *control, uint32_t steps)
{
    if (control->source != ITEMS_QUEUED)
        steps = job->options.steps_at_once;
    else if (steps < MOST_PASS_STEPS)
        steps *= 2;
    return rendering_steps_within(job->rendering, steps);
}

/* The next pass reads the queue that the last one has written, and writes the other one. */
static void turn_queue(ControlBlock *control, const WorkBlock *work)
{
    uint32_t pixels  = work->extent[0] * work->extent[1];
    control->source  = ITEMS_QUEUED;
    control->reading = control->writing;
    control->writing = pixels - control->reading;
}

/* Passes of a chain: none is left over by most of them, and those that have no rays cost little. */
#define PASSES_AT_ONCE 5

/* As `trace` does it where the host does not look at how many rays are left after each pass. */
static bool trace_in_chain(Job *job, const WorkBlock *work, LaneBudget budget)
{
    ControlBlock *control = job->rendering->control.bytes;
    Items         items   = pixels_of_rays(job, work);
    do {
        for (int pass = 0; pass <= PASSES_AT_ONCE; pass++) {
            if (!dispatch_items(job, KRS_PHASE_PRIMARY, job->trace, work, items, budget))
                return false;
            budget.steps = next_steps(job, control, budget.steps);
            turn_queue(control, work);
            items = (Items){1, WORD_OF(queued), .resets = true};
        }
        if (!dispatch_finish(job))
            return false;
    } while (control->queued > 0);
    return true;
}

/* First every pixel of the band, or of the listed tiles, until all have been begun; then, pass by
   pass, the rays that are not done. */
static bool trace(Job *job, const WorkBlock *work)
{
    ControlBlock *control = job->rendering->control.bytes;
    LaneBudget    budget  = lane_budget(job);
    Items         items   = pixels_of_rays(job, work);
    control->phase        = TRACE_RAYS;
    control->source       = ITEMS_FRESH;
    control->queued = control->writing = 0;
    if (dispatch_chains(job))
        return trace_in_chain(job, work, budget);
    while (budget.lanes * budget.items_per_lane > 128 &&
           items_now(job, items) / (budget.lanes * budget.items_per_lane) < 64)
        budget.items_per_lane /= 2; /* groups enough for every core of the device */
    for (double left = job->progress_share;; left -= job->progress_share) {
        control->untaken    = 0;
        job->progress_share = 0.9 * left; /* few rays need a second pass */
        if (!dispatch_items(job, KRS_PHASE_PRIMARY, job->trace, work, items, budget))
            return false;
        job->progress_done += job->progress_share;
        if (control->untaken > 0) {
            control->source = ITEMS_UNTAKEN;
            continue;
        }
        if (control->queued == 0)
            return true;
        budget.steps = next_steps(job, control, budget.steps);
        turn_queue(control, work);
        items                 = ITEMS_KNOWN(control->queued);
        control->queued       = 0;
        budget.items_per_lane = 1;
    }
}

static bool has_beams(const Job *job)
{
    return !job->options.no_beams && job->view.camera.projection != KRS_PANORAMA &&
           rendering_steps_within(job->rendering, MOST_BEAM_STEPS / 2) == MOST_BEAM_STEPS / 2;
}

/* Beams, then rays, of one kernel, whose distance costs so much. */
static bool march_kernel(Job *job, const WorkBlock *work, double flops)
{
    ControlBlock *control        = job->rendering->control.bytes;
    const double  progress_share = job->progress_share;
    control->starts_from = control->listed = 0;
    job->progress_share                    = 0; /* of beams: too short to be seen */
    if (has_beams(job) && !march_beams(job, work, flops))
        return false;
    job->progress_share = progress_share;
    return trace(job, work);
}

bool march_all(Job *job, const WorkBlock *work)
{
    FrameBlock       *frame   = job->rendering->frame.bytes;
    Kernel           *whole   = job->trace;
    bool              good    = (!has_beams(job) && job->group_march_count == 0) || clear_ends(job);
    const KrsProgram *program = job->rendering->program;
    if (job->knows_planes) {
        double low[3], high[3];
        for (int i = 0; i < 3; i++) {
            low[i]  = program->rest_low[i] - job->rebase_origin[i];
            high[i] = program->rest_high[i] - job->rebase_origin[i];
        }
        view_place_box(&job->view, low, high, frame);
    }
    job->window = (KrsWindow){0, 0, (uint32_t)frame->size[0], (uint32_t)frame->size[1]};
    if (job->group_march_count == 0)
        good = good && march_kernel(job, work, program->flops);
    job->progress_share /= job->group_march_count ? job->group_march_count : 1;
    for (uint32_t i = 0; i < job->group_march_count && good; i++) {
        const GroupMarch    *march = &job->group_marches[i];
        const KrsMarchGroup *march_group =
            &job->rendering->program->march_groups[march->march_group];
        view_place_box(&job->view, march_group->low, march_group->high, frame);
        /* The first one's rays find the planes, which are all around. */
        if (i > 0 || !rendering_knows_planes(job->rendering))
            job->window = view_window(frame, &job->view.camera);
        job->trace = job->beams = march->trace;
        job->schedule           = march->schedule;
        double progress_share   = job->progress_share;
        good                    = march_kernel(job, work, march_group->flops);
        job->progress_share     = progress_share;
    }
    job->schedule = job->options.schedule;
    memcpy(frame->low, job->frame.low, sizeof frame->low);
    memcpy(frame->high, job->frame.high, sizeof frame->high);
    job->trace = whole;
    return good;
}
