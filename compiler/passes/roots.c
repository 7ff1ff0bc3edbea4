/*
 * roots.c: the pass `lower`: lowers the components of a scene, and collects the roots of the graph.
 *
 * First come the distances and materials of components, and the view.  Behind them are the roots
 * for the march only: guards, steps along rays, planes, gradients, and roots for camera-relative
 * points.  They come last so that the nodes of the others do not depend on them.
 */
#include <math.h>
#include <string.h>

#include "compiler/base/far.h"
#include "compiler/passes/compilation.h"
#include "compiler/graph/build.h"
#include "compiler/graph/bounds/facts.h"
#include "compiler/graph/rewrite/rebase.h"
#include "compiler/graph/symbolic/derive.h"
#include "compiler/lower/instance_groups.h"

/* Allocates all roots, ordered by kind.  Those for camera-relative points are last, so that they
   can be left out. */
static void allocate_roots(Compilation *c, RootRange assembly)
{
    const Scene *s                  = &c->elaborated;
    Roots       *roots              = &c->scene->roots;
    size_t       components         = s->components.count;
    const size_t counts[ROOT_KINDS] = {
        [ROOTS_SURFACE]         = components * ROOT_COUNT,
        [ROOTS_ZONE]            = s->zone_count > 0,
        [ROOTS_VOLUME]          = s->volumes.count * NODES_OF(VolumeRoots),
        [ROOTS_CAMERA]          = s->cameras.count * NODES_OF(CameraNodes),
        [ROOTS_LIGHT]           = s->lights.count * NODES_OF(LightNodes),
        [ROOTS_SKY]             = NODES_OF(SkyRoots),
        [ROOTS_GUARDED]         = components,
        [ROOTS_ALONG]           = components,
        [ROOTS_RESEARCH]        = c->options->research ? components * RESEARCH_COUNT : 0,
        [ROOTS_PLANE]           = NODES_OF(PlaneRoots),
        [ROOTS_GRADIENT]        = (components + 1) * NODES_OF(GradientRoots),
        [ROOTS_SLOPE]           = s->slopes.count,
        [ROOTS_BOX]             = s->boxes.nodes.count,
        [ROOTS_ASSEMBLY]        = assembly.count,
        [ROOTS_PLACE]           = c->options->assembly ? components : 0,
        [ROOTS_CAMERA_RELATIVE] = components * ROOT_COUNT + NODES_OF(PlaneRoots) +
                                  (s->zone_count > 0)};
    for (RootKind kind = 0; kind < ROOT_KINDS; kind++)
        roots->first[kind + 1] = roots->first[kind] + counts[kind];
    roots->all = arena_new_array(&c->scene->arena, Node, roots->first[ROOT_KINDS]);
    if (assembly.count > 0)
        memcpy(roots_of(roots, ROOTS_ASSEMBLY).items, assembly.items,
               assembly.count * sizeof(Node));
}

static bool lower_components(Compilation *c, Graph *g, LoweredGroups *groups)
{
    const Scene *s      = &c->elaborated;
    RootRange    places = roots_of(&c->scene->roots, ROOTS_PLACE);
    for (size_t i = 0; i < s->components.count; i++) {
        Node *place = places.count > 0 ? &places.items[i] : NULL;
        if (!lower_component(g, s->components.items[i].shape,
                             (uint32_t)s->components.items[i].first + 1, groups, &c->scratch,
                             surface_roots(&c->scene->roots, i), place)) {
            refuse_component(c, i);
            return false;
        }
        if (place && *place == NODE_NONE)
            *place = graph_number(g, 0);
    }
    return true;
}

/* Returns a vector with each component within [0, 1]. */
static Node within_one(Graph *g, Node vector)
{
    static const double none[3] = {0, 0, 0}, all[3] = {1, 1, 1};
    return graph_op3(g, OP_clamp, vector, graph_constant(g, TYPE_VEC3, none),
                     graph_constant(g, TYPE_VEC3, all));
}

/* Lowers media.  Where densities and what scatters would be out of bounds, they are at the bounds. */
static bool lower_volumes(Compilation *c, Graph *g, LoweredGroups *groups)
{
    const Scene *s = &c->elaborated;
    for (size_t i = 0; i < s->volumes.count; i++) {
        const SceneVolume *volume  = &s->volumes.items[i];
        VolumeRoots       *roots   = volume_roots(&c->scene->roots, i);
        const MediumNodes *nodes   = &volume->nodes;
        const double       none[3] = {0, 0, 0};
        Node               zero    = graph_number(g, 0), distance;
        g->here                    = volume->span;
        if (!lower_solid(g, volume->within, groups, &c->scratch, &distance)) {
            Diag *diag = diag_add(&c->diags, DIAG_TOO_LARGE, volume->span,
                                  "the shape of the medium needs too many operations");
            diag->help = "a simpler `within`: what is outside may have a density of 0 as well";
            return false;
        }
        roots->density    = graph_op3(g, OP_select, graph_op2(g, OP_less, distance, zero),
                                      graph_op2(g, OP_max, nodes->density, zero), zero);
        roots->albedo     = within_one(g, graph_op2(g, OP_scale, nodes->color, nodes->scatter));
        roots->anisotropy = graph_op3(g, OP_clamp, nodes->anisotropy, graph_number(g, -0.99),
                                      graph_number(g, 0.99));
        roots->emission = graph_op2(g, OP_max, nodes->emission, graph_constant(g, TYPE_VEC3, none));
    }
    return true;
}

/* Copies the nodes of zones, cameras, lights, the sky and fog, which elaboration has made. */
static void gather_view(const Scene *s, const Roots *roots)
{
    if (s->zone_count > 0)
        roots_of(roots, ROOTS_ZONE).items[0] = s->zone;
    for (size_t i = 0; i < s->cameras.count; i++)
        *camera_roots(roots, i) = s->cameras.items[i].nodes;
    for (size_t i = 0; i < s->lights.count; i++)
        *light_roots(roots, i) = s->lights.items[i].nodes;
    const SceneFog *fog = &s->fog;
    const SceneSky *sky = &s->sky;
    *sky_roots(roots)   = (SkyRoots){sky->zenith,    sky->horizon,   sky->ground, sky->rotation,
                                     sky->intensity, sky->turbidity, fog->color,  fog->density,
                                     fog->fall,      fog->base};
}

static void lower_marches(Compilation *c, Graph *g, LoweredGroups *groups)
{
    const Scene *s     = &c->elaborated;
    const Roots *roots = &c->scene->roots;
    size_t       count = s->components.count;
    for (size_t i = 0; i < count; i++) {
        const Shape *shape                      = s->components.items[i].shape;
        Node         plain                      = distance_root(roots, i);
        roots_of(roots, ROOTS_GUARDED).items[i] = lower_guarded(g, shape, plain, groups,
                                                                &c->scratch);
        roots_of(roots, ROOTS_ALONG).items[i]   = lower_along(g, shape, plain, groups, &c->scratch);
        for (ResearchMethod method = 0; c->options->research && method < RESEARCH_COUNT; method++)
            research_roots(roots, method)[i] = lower_research(g, shape, plain, method, groups,
                                                              &c->scratch);
    }
}

/* Tells whether a property may be above 0.  At points it may be anything that pictures permit. */
static bool may_exceed_zero(const Graph *g, Node property, Arena *scratch)
{
    if (is_number(g, property, 0))
        return false;
    return g->items[property].time == TIME_POINT ||
           graph_frame_range(g, property, 0, scratch).high > 0;
}

/* Finds the components that may let light through.  Rays go on inside of them, so half-spaces are
   marched like all else.  Open surfaces have no inside. */
static void find_media(Compilation *c, const Graph *g)
{
    const size_t count = c->elaborated.components.count;
    c->is_medium       = arena_new_array(&c->scene->arena, bool, count + 1);
    for (size_t i = 0; i < count; i++) {
        Component *component    = &c->elaborated.components.items[i];
        Node       transmission = surface_roots(&c->scene->roots, i)[ROOT_transmission];
        if (!may_exceed_zero(g, transmission, &c->scratch))
            continue;
        component->plane_normal = component->plane_offset = NODE_NONE;
        c->is_medium[i] = !has_thin_open_surfaces(component->shape);
        c->scene->program.media |= c->is_medium[i];
    }
}

/* Finds the components below whose surface light may go on (krs_subsurface).  Open surfaces have no inside. */
static void find_subsurface(Compilation *c, const Graph *g)
{
    const size_t count = c->elaborated.components.count;
    c->is_subsurface   = arena_new_array(&c->scene->arena, bool, count + 1);
    for (size_t i = 0; i < count; i++) {
        Node weight         = surface_roots(&c->scene->roots, i)[ROOT_subsurface_weight];
        c->is_subsurface[i] = may_exceed_zero(g, weight, &c->scratch) &&
                              !has_thin_open_surfaces(c->elaborated.components.items[i].shape);
        c->scene->program.subsurface |= c->is_subsurface[i];
    }
}

/*
 * Lowers components that are half-spaces, which need no march.  A ray from p along d enters the
 * half-space n.x <= w at (w - n.p) / n.d, if n.d < 0.  The first root is the least of these
 * lengths, the second the least n.d.  Zones cut holes into planes, so with zones planes are
 * marched, too.
 */
static void lower_planes(Compilation *c, Graph *g)
{
    const Scene *s     = &c->elaborated;
    PlaneRoots  *plane = plane_roots(&c->scene->roots);
    Node         point = graph_leaf(g, OP_POINT), direction = graph_leaf(g, OP_DIRECTION);
    Node         far = graph_number(g, NOWHERE), zero = graph_number(g, 0);
    plane->step   = far;
    plane->cosine = graph_number(g, 1);
    for (size_t i = 0; i < s->components.count && s->zone_count == 0; i++) {
        const Component *component = &s->components.items[i];
        if (!component_is_plane(component))
            continue;
        c->additions.planes = true;
        Node cosine         = graph_op2(g, OP_dot, component->plane_normal, direction);
        Node depth          = graph_op2(g, OP_dot, component->plane_normal, point);
        Node clearance      = graph_op2(g, OP_sub, component->plane_offset, depth);
        Node falls          = graph_op2(g, OP_less, cosine, zero);
        Node step   = graph_op3(g, OP_select, falls, graph_op2(g, OP_div, clearance, cosine), far);
        plane->step = graph_op2(g, OP_min, plane->step, step);
        plane->cosine = graph_op2(g, OP_min, plane->cosine, cosine);
    }
}

/* Tells whether rays march by the roots of polynomials and there are no mirrors or inversions.  Then
   derivatives cost less than differences of the distance, and a polynomial's distance is only a
   bound, which is no more accurate than its series. */
static bool is_algebraic(const Scene *s, const Roots *roots)
{
    const Node *exact = roots_of(roots, ROOTS_ALONG).items;
    bool        found = false;
    for (size_t i = 0; i < s->components.count; i++) {
        const Shape *shape = s->components.items[i].shape;
        if (shape->levels > 0 || shape->inversions > 0)
            return false;
        found = found || exact[i] != distance_root(roots, i);
    }
    return found;
}

/* Lowers the gradients of all components and of the zones, if the additions include gradients. */
static void lower_gradients(Compilation *c, Graph *g, LoweredGroups *groups)
{
    const Scene *s     = &c->elaborated;
    const Roots *roots = &c->scene->roots;
    bool         wants = c->additions.gradients;
    for (size_t i = 0; i <= s->components.count; i++) {
        bool zones = i == s->components.count, known = false;
        Node near = s->zone_count > 0 ? s->zone : graph_number(g, 0), gradient = NODE_NONE;
        if (zones && wants)
            known = graph_gradient(g, near, &gradient, NULL, &c->scratch) != DERIVED_NOT;
        else if (wants)
            known = lower_gradient(g, s->components.items[i].shape, &gradient, &near, groups,
                                   &c->scratch);
        Node distance             = zones ? near : distance_root(roots, i);
        *gradient_roots(roots, i) = known ? (GradientRoots){gradient, near}
                                          : (GradientRoots){distance, distance};
        arena_free(&c->scratch);
    }
}

/* Copies the roots of components, planes and zones, and rebases the copies to camera-relative points. */
static void lower_camera_relative(Compilation *c, Graph *g)
{
    static const RootKind copied[] = {ROOTS_SURFACE, ROOTS_PLANE, ROOTS_ZONE};
    const Roots          *roots    = &c->scene->roots;
    RootRange             near     = roots_of(roots, ROOTS_CAMERA_RELATIVE);
    Node                 *to       = near.items;
    GraphParameter anywhere = {{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}, {HUGE_VAL, HUGE_VAL, HUGE_VAL}};
    Node           rebase_origin = graph_parameter(g, (uint32_t)g->parameters.count, TYPE_VEC3);
    array_push(&c->scene->arena, &g->parameters, anywhere);
    for (size_t i = 0; i < sizeof copied / sizeof *copied; i++) {
        const RootRange from = roots_of(roots, copied[i]);
        memcpy(to, from.items, from.count * sizeof(Node));
        to += from.count;
    }
    graph_rebase(g, near.items, near.count, rebase_origin, &c->scratch);
    arena_free(&c->scratch);
}

static bool any_thin_open_surfaces(const Scene *s)
{
    bool found = false;
    for (size_t i = 0; i < s->components.count; i++)
        found = found || has_thin_open_surfaces(s->components.items[i].shape);
    return found;
}

KrsStatus pass_lower(Compilation *c)
{
    const Scene   *s      = &c->elaborated;
    Roots         *roots  = &c->scene->roots;
    Additions     *more   = &c->additions;
    LoweredGroups *groups = lowered_groups_new(s->graph, &c->work, &c->scene->arena,
                                               min_instances(c));
    if (c->options->pictures && !c->request->min_instances)
        lowered_groups_take_few(groups);
    allocate_roots(c, find_assembly(c, groups));
    if (!lower_components(c, s->graph, groups) || !lower_volumes(c, s->graph, groups))
        return KRS_BAD_SCENE;
    find_motions(c);
    more->open_surfaces   = any_thin_open_surfaces(s);
    more->camera_relative = !more->open_surfaces && s->volumes.count == 0 &&
                            may_need_rebase(s, s->graph, roots, c->options->pictures, &c->scratch);
    gather_view(s, roots);
    lower_marches(c, s->graph, groups);
    find_media(c, s->graph);
    find_subsurface(c, s->graph);
    lower_planes(c, s->graph);
    arena_free(&c->scratch);
    more->algebraic = is_algebraic(s, roots);
    more->gradients = more->algebraic || more->open_surfaces || c->options->gradients;
    lower_gradients(c, s->graph, groups);
    for (size_t i = 0; i < s->slopes.count; i++)
        roots_of(roots, ROOTS_SLOPE).items[i] = s->slopes.items[i].formula;
    for (size_t i = 0; i < s->boxes.nodes.count; i++)
        roots_of(roots, ROOTS_BOX).items[i] = s->boxes.nodes.items[i];
    if (more->camera_relative)
        lower_camera_relative(c, s->graph);
    else
        roots->first[ROOT_KINDS] = roots->first[ROOTS_CAMERA_RELATIVE];
    return KRS_OK;
}

void validate_lowered(const Compilation *c) { graph_validate(c->elaborated.graph, "lower"); }
