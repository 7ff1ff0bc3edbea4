/*
 * phases.c: from rays to light.
 *
 * For each ray of the pixels of a band the phases follow one another: beams, primary rays,
 * normals, occlusion, shadows, and the sum of all light.  march.c has the first two, what follows
 * a hit is here; dispatch.c runs them.
 */
#include "runtime/tracer/phases.h"

#include <math.h>
#include <string.h>

/* Rays from the pixels of a list. */
static LaneBudget secondary_budget(const Job *job, uint32_t count)
{
    LaneBudget budget = lane_budget(job);
    budget.steps      = rendering_steps_within(job->rendering, MOST_LANE_STEPS);
    bool loops        = job->rendering->program->loops > 0; /* which leave steps for few items */
    while (budget.lanes * budget.items_per_lane > 64 &&
           (loops || count / (budget.lanes * budget.items_per_lane) < 64))
        budget.items_per_lane /= 2; /* groups enough for every core of the device */
    return budget;
}

/* Where a list of pixels begins, */
static uint32_t list_at(const WorkBlock *work, uint32_t list)
{
    return list * work->extent[0] * work->extent[1];
}

/* and that of quarters of tiles. */
static uint32_t quarters_at(const WorkBlock *work)
{
    return list_at(work, LIST_SHARED) + SHARED_LISTS * TILE * TILE * (uint32_t)tiles_of_band(work);
}

/* Rays from the hits of the list that begins there, each of which takes the steps that it needs;
   `first`: none has been shared before. */
static bool send_rays(Job *job, KrsPhase phase, uint32_t rays, const WorkBlock *work,
                      uint32_t reading, Items items, bool first)
{
    ControlBlock *control = job->rendering->control.bytes;
    LaneBudget    budget  = secondary_budget(job, items_now(job, items));
    control->phase        = rays;
    control->source       = ITEMS_FRESH;
    control->reading      = reading;
    do { /* in a chain no item is left over */
        control->untaken       = 0;
        Dispatch dispatch      = dispatch_of(job, phase, job->secondary, work, items, budget);
        dispatch.clears_shared = first && control->source == ITEMS_FRESH;
        if (!dispatch_run(job, &dispatch))
            return false;
        control->source = ITEMS_UNTAKEN;
    } while (control->untaken > 0);
    return true;
}

/* What neighbours share, for the items of the list that begins there, by one of the kernels and a
   phase of it; `counter`: of those that it lists, 0 for none. */
static bool filter_pixels(Job *job, KrsPhase phase, PixelKernel kernel, uint32_t kernel_phase,
                          const WorkBlock *work, uint32_t reading, Items items, uint32_t counter)
{
    KrsRendering *r       = job->rendering;
    ControlBlock *control = r->control.bytes;
    control->phase        = kernel_phase;
    control->source       = ITEMS_FRESH;
    control->reading      = reading;
    Dispatch dispatch = dispatch_of(job, phase, &r->renderer->pixels[r->panoramic][kernel], work,
                                    items, pixel_budget(job));
    dispatch.clears   = counter;
    return dispatch_run(job, &dispatch);
}

/* The first light from this one on that has a disc in the sky. */
static uint32_t find_sun(const Job *job, uint32_t light)
{
    while (light < job->view.light_count &&
           (job->view.lights[light].positional || job->view.lights[light].softness <= 0))
        light++;
    return light;
}

/* The sky and the first sun, and the lists of what hits something; then each other sun. */
static bool resolve(Job *job, const WorkBlock *work)
{
    KrsRendering *r       = job->rendering;
    ControlBlock *control = r->control.bytes;
    uint32_t      sun     = find_sun(job, 0);
    control->hit_count = control->sparse = control->quarters = control->value = 0;
    control->by_march_group = job->group_march_count > 0 && job->group_marches[0].normals;
    control->phase          = BACKGROUND_FIRST;
    memset(control->of_march_group, 0, sizeof control->of_march_group);
    do {
        control->light = sun;
        if (!dispatch_pixels(job, KRS_PHASE_RESOLVE,
                             &r->renderer->pixels[r->panoramic][PIXELS_BACKGROUND], work,
                             ITEMS_KNOWN(tiles_of_band(work) * QUARTERS_OF_TILE)))
            return false;
        control->phase = BACKGROUND_SUN;
        sun            = find_sun(job, sun + 1);
    } while (sun < job->view.light_count);
    return true;
}

/* Where components were marched by themselves, so is the normal of each found: at the surface of
   one the others do not count. */
static bool find_normals(Job *job, const WorkBlock *work)
{
    ControlBlock *control = job->rendering->control.bytes;
    Dispatch      dispatches[1 + KRS_MOST_MARCH_GROUPS];
    control->reading = list_at(work, LIST_ALL);
    if (!control->by_march_group)
        return dispatch_pixels(job, KRS_PHASE_NORMALS, job->normals, work,
                               ITEMS_COUNTED(1, hit_count));
    control->source = ITEMS_FRESH;
    for (uint32_t i = 0; i <= job->group_march_count; i++) {
        bool     is_march    = i < job->group_march_count; /* else what belongs to none: planes */
        uint32_t march_group = is_march ? job->group_marches[i].march_group + 1 : 0;
        Items    items       = {1, WORD_OF(of_march_group) + march_group, false};
        control->reading     = list_at(work, LIST_OF_MARCH_GROUP + march_group);
        dispatches[i]        = dispatch_of(job, KRS_PHASE_NORMALS,
                                    is_march ? job->group_marches[i].normals : job->normals, work,
                                           items, pixel_budget(job));
    }
    return dispatch_together(job, dispatches, 1 + job->group_march_count);
}

/* A ray over the hemisphere of each pixel, and always the means of neighbours: what a surface gives
   back of the light that it closes off is no linear function of how open it is (shade.comp), so the
   mean of noise would be too dark. */
static bool find_occlusion(Job *job, const WorkBlock *work)
{
    const KrsPhase phase = KRS_PHASE_OCCLUSION;
    const Items    all = ITEMS_COUNTED(1, hit_count), sparse = ITEMS_COUNTED(1, sparse);
    const Items    remaining = ITEMS_COUNTED(1, remaining);
    ControlBlock  *control   = job->rendering->control.bytes;
    control->value           = VALUE_OCCLUSION;
    control->filters         = 1;
    if (control->no_occlusion)
        return true;
    const PixelKernel kernel = PIXELS_OCCLUSION;
    return send_rays(job, phase, RAYS_OVER_HEMISPHERE, work, list_at(work, LIST_ALL), all, true) &&
           filter_pixels(job, phase, kernel, OCCLUSION_AT_SPARSE_PIXELS, work,
                         list_at(work, LIST_SPARSE), sparse, 0) &&
           filter_pixels(job, phase, kernel, OCCLUSION_WIDER, work, list_at(work, LIST_SPARSE),
                         sparse, 0) &&
           filter_pixels(job, phase, kernel, OCCLUSION_UPSAMPLED, work, list_at(work, LIST_ALL),
                         all, WORD_OF(remaining)) &&
           filter_pixels(job, phase, kernel, OCCLUSION_OF_REMAINING, work,
                         list_at(work, LIST_REMAINING), remaining, 0);
}

/* Cones first: where they are empty all of the light is seen.  Rays that go from root to root know
   of no clearance around them, so there are no cones, and nothing is proven. */
static bool list_unproven(Job *job, const WorkBlock *work)
{
    const KrsPhase phase    = KRS_PHASE_SHADOWS;
    const Items    quarters = ITEMS_COUNTED(1, quarters);
    const Items    cones    = job->by_roots ? ITEMS_KNOWN(0) : quarters;
    return send_rays(job, phase, RAYS_CONES, work, quarters_at(work), cones, true) &&
           filter_pixels(job, phase, PIXELS_UNPROVEN, 0, work, quarters_at(work), quarters,
                         WORD_OF(remaining));
}

/* The means of what rays to a light have found. */
static bool find_means(Job *job, const WorkBlock *work)
{
    const KrsPhase phase    = KRS_PHASE_SHADOWS;
    const uint32_t unproven = list_at(work, LIST_REMAINING), wide = list_at(work, LIST_WIDE);
    return filter_pixels(job, phase, PIXELS_PENUMBRAE, 0, work, quarters_at(work),
                         ITEMS_COUNTED(1, quarters), 0) &&
           filter_pixels(job, phase, PIXELS_SHADOW, SHADOW_NEAR, work, unproven,
                         ITEMS_COUNTED(1, remaining), WORD_OF(wide)) &&
           filter_pixels(job, phase, PIXELS_SHADOW, SHADOW_WIDE, work, wide, ITEMS_COUNTED(1, wide),
                         0);
}

/* A ray of each pixel to a point of the light; the mean of neighbours, where it has a size. */
static bool find_visible(Job *job, const KrsLight *light, const WorkBlock *work)
{
    const uint32_t list    = list_at(work, job->filters_shadows ? LIST_REMAINING : LIST_ALL);
    const Items    items   = job->filters_shadows ? ITEMS_COUNTED(1, remaining)
                                                  : ITEMS_COUNTED(1, hit_count);
    ControlBlock  *control = job->rendering->control.bytes;
    control->filters       = job->filters_shadows && light->softness > 0;
    return (!job->filters_shadows || list_unproven(job, work)) &&
           send_rays(job, KRS_PHASE_SHADOWS, RAYS_TO_LIGHT, work, list, items,
                     !job->filters_shadows) &&
           (!control->filters || find_means(job, work));
}

/* How much is visible of each of the lights from `first` on that are shaded at once. */
static bool find_lights(Job *job, uint32_t first, const WorkBlock *work)
{
    ControlBlock *control = job->rendering->control.bytes;
    for (uint32_t i = 0; i < LIGHTS_AT_ONCE && first + i < job->view.light_count; i++) {
        const KrsLight *light = &job->view.lights[first + i];
        control->light        = first + i;
        control->value        = VALUE_VISIBLE + i;
        if (light->shadow && !find_visible(job, light, work))
            return false;
        job->progress_done += job->progress_share;
    }
    return true;
}

/* Some lights at a time; all else with the first, of which there may be none. */
static bool light_up(Job *job, const WorkBlock *work)
{
    ControlBlock *control = job->rendering->control.bytes;
    uint32_t      count = (uint32_t)job->view.light_count, first = 0;
    job->progress_share /= count ? count : 1;
    do {
        if (!find_lights(job, first, work))
            return false;
        control->light        = first;
        control->reading      = 0;
        double progress_share = job->progress_share;
        job->progress_share   = 0;
        if (!dispatch_pixels(job, KRS_PHASE_SHADING, job->shade, work, ITEMS_COUNTED(1, hit_count)))
            return false;
        job->progress_share = progress_share;
        first += LIGHTS_AT_ONCE;
    } while (first < count);
    return true;
}

/* The place of ray `index` within its pixel.  Ray 0 goes through the centre; the others follow
   the R2 sequence (multiples of the powers of the plastic number, modulo 1), which fills the
   pixel evenly however many there are, moved by the seed. */
static void place_ray(uint32_t index, uint64_t seed, float offset[2])
{
    static const double increment[2] = {0.75487766624669276, 0.56984029099805327};
    for (int i = 0; i < 2; i++) {
        uint64_t hash = seed * 2 + (uint64_t)i; /* splitmix64 */
        hash          = (hash ^ hash >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
        hash          = (hash ^ hash >> 27) * UINT64_C(0x94d049bb133111eb);
        hash ^= hash >> 31;
        double moved = seed && index ? (double)(hash >> 11) / 9007199254740992.0 : 0;
        double place = 0.5 + increment[i] * index + moved;
        offset[i]    = (float)(place - floor(place));
    }
}

/* The stages from rays to light, and their fractions of the time, about. */
typedef enum RenderStage {
    STAGE_TRACE,
    STAGE_RESOLVE,
    STAGE_NORMALS,
    STAGE_OCCLUSION,
    STAGE_LIGHTS,
    STAGE_COUNT
} RenderStage;
static const double stage_share[STAGE_COUNT] = {0.5, 0.02, 0.1, 0.1, 0.28};

static bool run_stage(Job *job, RenderStage stage, const WorkBlock *work)
{
    switch (stage) {
    case STAGE_TRACE: return march_all(job, work);
    case STAGE_RESOLVE: return resolve(job, work);
    case STAGE_NORMALS: return find_normals(job, work);
    case STAGE_OCCLUSION: return find_occlusion(job, work);
    case STAGE_LIGHTS: return light_up(job, work);
    case STAGE_COUNT: break;
    }
    return false;
}

bool phases_run(Job *job, WorkBlock *work, uint32_t index)
{
    const double  whole   = job->progress_share;
    ControlBlock *control = job->rendering->control.bytes;
    place_ray(index, job->options.seed, work->offset);
    control->ray       = index;
    control->rays      = job->options.samples;
    control->first_ray = index == 0;
    double done        = job->progress_done;
    for (RenderStage stage = 0; stage < STAGE_COUNT; done += whole * stage_share[stage], stage++) {
        job->progress_done  = done;
        job->progress_share = whole * stage_share[stage];
        if (!run_stage(job, stage, work))
            return false;
    }
    return dispatch_finish(job);
}
