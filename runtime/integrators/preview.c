/*
 * preview.c: an integrator of direct light: that of the sky, less what is occluded, and that of
 * each light, less what is in shadow.
 *
 * Rays for occlusion and shadows start at the hits of primary rays.  Neighbouring pixels share what
 * these rays find (shared.glsl).
 *
 * What smooth surfaces mirror, and what glass lets through, is followed for a few surfaces: one ray
 * goes on from each (mirrors.glsl).  There light is the same, less what is occluded.
 */
#include "runtime/integrators/integrators.h"
#include "runtime/tracer/shaders.h"
#include "runtime/tracer/lane_surfaces.h"
#include "runtime/tracer/methods.h"
#include "runtime/tracer/primary.h"
#include "runtime/tracer/renderer.h"

/* The fractions of the time that passes take, about. */
#define WEIGHT_MARCH      0.5f
#define WEIGHT_BACKGROUND 0.02f
#define WEIGHT_NORMALS    0.1f
#define WEIGHT_OCCLUSION  0.1f
#define WEIGHT_LIGHTS     0.28f
#define WEIGHT_SURFACES   0.05f /* where the host finds them */
#define WEIGHT_MIRRORS    0.3f  /* where there are any */

#define MIRRORED_SURFACES 6 /* that a ray is followed to: into glass, out, and what is behind */

typedef struct Preview {
    Job  *job;
    Plan *plan;
    const Shader *
        arrive; /* lanes of the host march rays of hits: this comes behind, `secondary` before; or NULL */
    const Shader *secondary;       /* NULL: there is neither occlusion nor a light with shadows */
    Shader       *occluders;       /* NULL: there is no occlusion */
    bool          by_roots;        /* secondary rays go from root to root */
    bool          filters_shadows; /* neighbouring pixels share what rays to lights find */
} Preview;

/* ---- passes ---- */

/* Adds a pass of a shader over a list; `out`: the list that it writes. */
static void add_items(Preview *p, KrsPhase phase, const Shader *shader, ListId in, ListId out,
                      PassConstants constants, float weight)
{
    plan_add(p->plan, (Pass){.kind      = PASS_ITEMS,
                             .phase     = phase,
                             .weight    = weight,
                             .shader    = shader,
                             .in        = in,
                             .out       = out,
                             .constants = constants});
}

/* Does the same by a shader without a scene. */
static void add_pixels(Preview *p, KrsPhase phase, PixelShader shader, ListId in, ListId out,
                       PassConstants constants, float weight)
{
    add_items(p, phase, job_pixel_shader(p->job, shader), in, out, constants, weight);
}

/* Adds a pass of rays from the hits of a list, which may write a list; `clears_shared`: no word of
   shared.glsl is known before. */
static void add_rays(Preview *p, KrsPhase phase, ListId in, ListId out, bool clears_shared,
                     PassConstants constants, float weight)
{
    plan_add(p->plan, (Pass){.kind          = p->arrive ? PASS_LANE_RAYS : PASS_RAYS,
                             .arrive        = p->arrive,
                             .phase         = phase,
                             .weight        = weight,
                             .shader        = p->secondary,
                             .in            = in,
                             .out           = out,
                             .clears_shared = clears_shared,
                             .constants     = constants});
}

/* Returns the first light from number `light` on that has a disc in the sky. */
static uint32_t find_sun(const KrsView *view, uint32_t light)
{
    while (light < view->light_count &&
           (view->lights[light].positional || view->lights[light].softness <= 0))
        light++;
    return light;
}

/* Returns the row of results for the light of a light. */
static uint32_t row_of_light(const Preview *p, uint32_t light)
{
    return p->job->options.light_groups ? ROW_OF_LIGHTS + light : ROW_COLORS;
}

/* Adds the passes for pixels without a hit.  The first one adds the sky and, unless lights are
   separate, the first sun, and lists the hits; each further one adds another sun. */
static void add_background(Preview *p)
{
    const KrsView    *view     = &p->job->view;
    const uint32_t    count    = (uint32_t)view->light_count;
    uint32_t          sun      = find_sun(view, 0);
    const bool        separate = p->job->options.light_groups;
    const PixelShader shader   = renderer_background(p->job->rendering);
    add_pixels(p, KRS_PHASE_RESOLVE, shader, LIST_OF_BAND, NO_LIST,
               (PassConstants){BACKGROUND_FIRST, .light = separate ? count : sun},
               WEIGHT_BACKGROUND);
    for (sun = separate ? sun : find_sun(view, sun + 1); sun < count; sun = find_sun(view, sun + 1))
        add_pixels(p, KRS_PHASE_RESOLVE, shader, LIST_OF_BAND, NO_LIST,
                   (PassConstants){BACKGROUND_SUN, .light = sun, .color_row = row_of_light(p, sun)},
                   0);
}

/* Adds the pass that finds occluders, by the host or by a shader. */
static void add_occluders(Preview *p, PassConstants constants)
{
    plan_add(p->plan, (Pass){.kind      = p->plan->surfaces ? PASS_OCCLUDERS : PASS_ITEMS,
                             .phase     = KRS_PHASE_OCCLUSION,
                             .weight    = 0.1f * WEIGHT_OCCLUSION,
                             .shader    = p->occluders,
                             .in        = LIST_REMAINING,
                             .out       = NO_LIST,
                             .constants = constants});
}

/* Adds a ray over the hemisphere of each hit, what is known of its occluder, and means over neighbouring
   pixels.  The means are needed however many rays there are: the light between a surface and its
   occluders is no linear function of openness (openness.glsl).  So the mean of noisy pixels would be
   too dark. */
static void add_occlusion(Preview *p)
{
    static const struct {
        uint32_t phase;
        ListId   in, out;
    } means[] = {
        {OCCLUSION_AT_SPARSE_PIXELS, LIST_SPARSE, NO_LIST},
        {OCCLUSION_WIDER, LIST_SPARSE, NO_LIST},
        {OCCLUSION_UPSAMPLED, LIST_ALL, LIST_REMAINING},
        {OCCLUSION_OF_REMAINING, LIST_REMAINING, NO_LIST},
    };
    PassConstants constants = {
        .phase = RAYS_OVER_HEMISPHERE, .value = VALUE_OCCLUSION, .filters = 1};
    if (p->job->options.no_occlusion)
        return;
    add_rays(p, KRS_PHASE_OCCLUSION, LIST_ALL, LIST_REMAINING, true, constants,
             0.6f * WEIGHT_OCCLUSION);
    add_occluders(p, constants);
    for (size_t i = 0; i < sizeof means / sizeof means[0]; i++) {
        constants.phase = means[i].phase;
        add_pixels(p, KRS_PHASE_OCCLUSION, PIXELS_OCCLUSION, means[i].in, means[i].out, constants,
                   0.1f * WEIGHT_OCCLUSION);
    }
}

/* Adds cones to the light: where one is empty, all of the light is visible and no ray is needed.
   Rays that go from root to root know no clearance around them.  Then there are no cones, and every
   pixel has its ray. */
static void add_unproven(Preview *p, PassConstants constants, float weight)
{
    constants.phase = RAYS_CONES;
    add_rays(p, KRS_PHASE_SHADOWS, p->by_roots ? NO_LIST : LIST_OF_QUARTERS, NO_LIST, true,
             constants, 0.5f * weight);
    constants.phase = 0;
    add_pixels(p, KRS_PHASE_SHADOWS, PIXELS_UNPROVEN, LIST_OF_QUARTERS, LIST_REMAINING, constants,
               0.5f * weight);
}

/* Adds means, over neighbouring pixels, of what rays to a light have found. */
static void add_means(Preview *p, PassConstants constants, float weight)
{
    const KrsPhase phase = KRS_PHASE_SHADOWS;
    constants.phase      = PENUMBRAE_COUNTED;
    add_pixels(p, phase, PIXELS_PENUMBRAE, LIST_OF_QUARTERS, NO_LIST, constants, weight / 6);
    constants.phase = PENUMBRAE_SPREAD;
    add_pixels(p, phase, PIXELS_PENUMBRAE, LIST_OF_QUARTERS, NO_LIST, constants, weight / 6);
    constants.phase = SHADOW_NEAR;
    add_pixels(p, phase, PIXELS_SHADOW, LIST_REMAINING, LIST_WIDE, constants, weight / 3);
    constants.phase = SHADOW_WIDE;
    add_pixels(p, phase, PIXELS_SHADOW, LIST_WIDE, NO_LIST, constants, weight / 3);
}

/* Adds a ray from each hit to a point of the light, and means over neighbours if the light has a
   size. */
static void add_visibility(Preview *p, uint32_t light, uint32_t value, float weight)
{
    const bool    shares    = p->filters_shadows;
    const bool    filters   = shares && p->job->view.lights[light].softness > 0;
    PassConstants constants = {
        .phase = RAYS_TO_LIGHT, .light = light, .value = value, .filters = filters};
    if (shares)
        add_unproven(p, constants, 0.2f * weight);
    add_rays(p, KRS_PHASE_SHADOWS, shares ? LIST_REMAINING : LIST_ALL, NO_LIST, !shares, constants,
             0.6f * weight);
    if (filters)
        add_means(p, constants, 0.2f * weight);
}

/* The lights of a pass of shading: LIGHTS_AT_ONCE, or one where they are separate; then the first
   of all passes has none. */
typedef struct LightPass {
    uint32_t first, count;
    bool     none; /* it adds all other light, and no lights */
} LightPass;

static LightPass first_lights(const Preview *p)
{
    const uint32_t count = (uint32_t)p->job->view.light_count;
    if (p->job->options.light_groups)
        return (LightPass){0, 0, true};
    return (LightPass){0, count < LIGHTS_AT_ONCE ? count : LIGHTS_AT_ONCE, false};
}

/* Finds the lights of the next pass; false: there are no more. */
static bool next_lights(const Preview *p, LightPass *lights)
{
    const uint32_t count = (uint32_t)p->job->view.light_count;
    const uint32_t most  = p->job->options.light_groups ? 1 : LIGHTS_AT_ONCE;
    const uint32_t first = lights->first + lights->count, left = count - first;
    *lights = (LightPass){first, left < most ? left : most, false};
    return left > 0;
}

static PassConstants constants_of(const Preview *p, const LightPass *lights, uint32_t phase)
{
    return (PassConstants){.phase     = phase,
                           .light     = lights->first,
                           .count     = lights->count,
                           .color_row = lights->none ? ROW_COLORS : row_of_light(p, lights->first)};
}

/* Adds the passes for lights.  The first shading pass also adds all other light, so there is one even
   without lights. */
static void add_lights(Preview *p, const Shader *shade)
{
    const KrsView *view   = &p->job->view;
    const uint32_t count  = (uint32_t)view->light_count;
    const float    each   = WEIGHT_LIGHTS / (float)(count ? count : 1);
    LightPass      lights = first_lights(p);
    do {
        for (uint32_t i = 0; i < lights.count; i++)
            if (view->lights[lights.first + i].shadow)
                add_visibility(p, lights.first + i, VALUE_VISIBLE + i, 0.8f * each);
        plan_add(p->plan, (Pass){.kind        = PASS_ITEMS,
                                 .phase       = KRS_PHASE_SHADING,
                                 .weight      = 0.2f * each,
                                 .shader      = shade,
                                 .in          = LIST_ALL,
                                 .out         = p->plan->has_paths ? LIST_OF_PATHS : NO_LIST,
                                 .short_items = !p->plan->has_paths,
                                 .constants   = constants_of(p, &lights, PATHS_GO_ON)});
    } while (next_lights(p, &lights));
}

/* ---- mirrors and glass ---- */

/* Tells whether lanes of the host follow the rays, and find all that is known of their hits. */
static bool lanes_follow_mirrors(const Preview *p)
{
    return p->plan->surfaces && lane_rays_find_normals(p->job);
}

/* Adds the light of the surfaces that rays have been followed to.  `ends`: no ray goes on. */
static void add_mirrored_lights(Preview *p, const Shader *shadows, const Shader *scatter, bool ends,
                                float weight)
{
    const KrsView *view     = &p->job->view;
    const bool     by_lanes = lanes_follow_mirrors(p);
    LightPass      lights   = first_lights(p);
    do {
        PassConstants constants = constants_of(p, &lights, ends ? PATHS_END : PATHS_GO_ON);
        constants.of_paths      = 1;
        for (uint32_t i = 0; i < lights.count; i++)
            if (view->lights[lights.first + i].shadow)
                plan_add(p->plan, (Pass){.kind      = by_lanes ? PASS_LANE_RAYS : PASS_RAYS,
                                         .phase     = KRS_PHASE_BOUNCES,
                                         .weight    = weight,
                                         .shader    = by_lanes ? p->secondary : shadows,
                                         .arrive    = p->arrive,
                                         .in        = LIST_ALL,
                                         .out       = NO_LIST,
                                         .constants = {.phase    = RAYS_TO_LIGHT,
                                                       .light    = lights.first + i,
                                                       .value    = VALUE_VISIBLE + i,
                                                       .of_paths = 1}});
        add_items(p, KRS_PHASE_BOUNCES, scatter, LIST_ALL, LIST_OF_PATHS, constants, weight);
    } while (next_lights(p, &lights));
}

/* Adds a pass by lanes of the host over a list of pixels whose paths go on. */
static void add_lanes_of_paths(Preview *p, PassKind kind, ListId in, float weight)
{
    plan_add(p->plan, (Pass){.kind      = kind,
                             .phase     = KRS_PHASE_BOUNCES,
                             .weight    = weight,
                             .in        = in,
                             .constants = {.of_paths = 1}});
}

/* Adds the passes that follow rays from the surfaces that are shaded, one after the other.  Hits of these are shaded by
   the shader of the camera's, where lanes find what is there. */
static bool add_mirrors(Preview *p, const Shader *shade)
{
    Job          *job     = p->job;
    KrsRendering *r       = job->rendering;
    const float   each    = WEIGHT_MIRRORS / MIRRORED_SURFACES;
    const float   weight  = 0.2f * each;
    const bool    lanes   = lanes_follow_mirrors(p);
    PathShaders   shaders = {0};
    if (!renderer_create_escapes(r->renderer, RAYS_OF_PATHS, &r->spirv_ms, &r->pipeline_ms) ||
        (!lanes && !rendering_paths(r, &job->options, KRS_FOR_PICTURES, false, &shaders)))
        return false;
    const March   march  = primary_march_of_paths(job, shaders.march);
    const Shader *escape = renderer_escape_of_paths(r);
    for (int i = 0; i < MIRRORED_SURFACES; i++) {
        if (lanes)
            add_lanes_of_paths(p, PASS_LANES, LIST_OF_PATHS, 0.4f * each);
        else if (i == 0)
            plan_add_march(p->plan, &march, 0.4f * each);
        else
            plan_add_march_again(p->plan, 0.4f * each);
        add_items(p, KRS_PHASE_BOUNCES, escape, LIST_OF_PATHS, LIST_ALL,
                  (PassConstants){.phase = ESCAPE_TO_SKY}, weight);
        if (lanes)
            add_lanes_of_paths(p, PASS_SURFACES, LIST_ALL, weight);
        else
            add_items(p, KRS_PHASE_BOUNCES, shaders.normals, LIST_ALL, NO_LIST,
                      (PassConstants){.of_paths = 1}, weight);
        add_mirrored_lights(p, shaders.shadows, lanes ? shade : shaders.scatter,
                            i + 1 == MIRRORED_SURFACES, weight);
    }
    return escape != NULL;
}

/* ---- the plan ---- */

/* Tells whether there are secondary rays: for occlusion, or to a light that casts shadows. */
static bool needs_secondary(const Job *job)
{
    bool needed = !job->options.no_occlusion;
    for (size_t i = 0; i < job->view.light_count; i++)
        needed = needed || job->view.lights[i].shadow;
    return needed;
}

/* Finds the shader of secondary rays, if there are any; false with the failure noted. */
static bool find_secondary(Preview *p)
{
    const KrsRenderOptions *options = &p->job->options;
    if (!needs_secondary(p->job))
        return true;
    KrsRendering *r = p->job->rendering;
    p->by_roots     = rendering_has_roots(r, options->methods.trace);
    if (p->plan->field) {
        p->secondary = renderer_aim(r);
        p->arrive    = renderer_arrive(r);
        if (!p->arrive)
            return false;
    } else {
        p->secondary = rendering_secondary(r, options->methods.schedule, p->by_roots,
                                           job_light_meets_planes(p->job));
    }
    if (!options->no_occlusion && !p->plan->surfaces)
        p->occluders = rendering_occluders(p->job->rendering);
    return p->secondary && (options->no_occlusion || p->occluders || p->plan->surfaces);
}

/* Returns the shader that shades.  Where lanes march, the host finds surfaces for it; NULL with the
   failure noted. */
static const Shader *find_shade(Preview *p)
{
    Job *job = p->job;
    if (job->options.methods.executor != KRS_EXECUTOR_LANES ||
        !rendering_lanes_find_surfaces(job->rendering))
        return rendering_shade(job->rendering);
    p->plan->surfaces     = lane_surfaces_field(job);
    p->plan->surface_rows = lane_surfaces_rows(job->rendering);
    return p->plan->surfaces ? rendering_shade_found(job->rendering) : NULL;
}

bool preview_plan(Job *job, Plan *plan)
{
    const KrsRenderOptions *options = &job->options;
    Preview                 p       = {.job = job, .plan = plan};
    Primary                 primary;
    p.filters_shadows = !options->methods.no_upsampling && options->shadows == KRS_SHADOWS_SOFT;
    bool shares       = !options->no_occlusion || (p.filters_shadows && needs_secondary(job));
    plan->halo        = shares ? TILE : 0;
    plan->has_paths   = job->rendering->program->mirrors;
    KrsRendering *r   = job->rendering;
    if (!renderer_create_pixels(r) || !primary_add_marches(job, plan, WEIGHT_MARCH, &primary))
        return false;
    const Shader *shade = find_shade(&p), *plate;
    if (!shade || !find_secondary(&p))
        return false;
    add_background(&p);
    primary_add_normals(plan, WEIGHT_NORMALS, &primary);
    if (!primary_find_plate(job, &plate))
        return false;
    if (plate)
        add_items(&p, KRS_PHASE_NORMALS, plate, LIST_ALL, NO_LIST, (PassConstants){0}, 0);
    if (plan->surfaces)
        plan_add(
            plan,
            (Pass){.kind = PASS_SURFACES, .phase = KRS_PHASE_SHADING, .weight = WEIGHT_SURFACES});
    add_occlusion(&p);
    add_lights(&p, shade);
    return (!plan->has_paths || add_mirrors(&p, shade)) && !plan->failed;
}
