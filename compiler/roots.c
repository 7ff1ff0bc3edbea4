/*
 * roots.c: what is asked of the graph: everything that a scene shows, lowered.
 *
 * Of each component its distance and material, and after these what only the march needs, so that
 * nothing else depends on it: guards, steps along a ray, planes, gradients, and the same again for
 * camera-relative points.
 */
#include <math.h>
#include <string.h>

#include "compiler/compilation.h"
#include "compiler/graph/rebase.h"
#include "compiler/graph/derive.h"

static size_t camera_relative_roots(const Scene *s)
{
    return s->components.count * ROOT_COUNT + PLANE_ROOTS;
}

/* Room for all roots, one kind behind the other; those for camera-relative points come last. */
static void allocate_roots(Compilation *c)
{
    const Scene *s     = &c->elaborated;
    Roots       *r     = &c->scene->roots;
    size_t       count = s->components.count;
    const struct {
        Node **nodes;
        size_t count;
    } kinds[] = {{&r->components, count * ROOT_COUNT},
                 {&r->zone, s->zone_count > 0},
                 {&r->cameras, s->cameras.count * CAMERA_ROOTS},
                 {&r->lights, s->lights.count * LIGHT_ROOTS},
                 {&r->sky, SKY_ROOTS},
                 {&r->guarded, count},
                 {&r->along, count * ALONG_COUNT},
                 {&r->planes, PLANE_ROOTS},
                 {&r->gradients, (count + 1) * GRADIENT_ROOTS},
                 {&r->slopes, s->slopes.count},
                 {&r->camera_relative, camera_relative_roots(s)}};
    enum { KINDS = sizeof kinds / sizeof *kinds };
    r->count = 0;
    for (size_t i = 0; i < KINDS; i++)
        r->count += kinds[i].count;
    Node *next = arena_new_array(&c->scene->arena, Node, r->count);
    for (size_t i = 0; i < KINDS; i++) {
        *kinds[i].nodes = next;
        next += kinds[i].count;
    }
}

static bool lower_components(Compilation *c, Graph *g)
{
    const Scene *s    = &c->elaborated;
    Node        *root = c->scene->roots.components;
    for (size_t i = 0; i < s->components.count; i++, root += ROOT_COUNT)
        if (!lower_component(g, s->components.items[i].shape, &c->scratch, root)) {
            refuse_component(c, i, 0);
            return false;
        }
    return true;
}

/* Zones, cameras, lights and the sky are nodes already. */
static void gather_view(const Scene *s, const Roots *roots)
{
    if (s->zone_count > 0)
        *roots->zone = s->zone;
    for (size_t i = 0; i < s->cameras.count; i++) {
        const SceneCamera *camera = &s->cameras.items[i];
        memcpy(roots->cameras + i * CAMERA_ROOTS,
               (Node[]){camera->eye, camera->target, camera->up, camera->fov, camera->height},
               CAMERA_ROOTS * sizeof(Node));
    }
    for (size_t i = 0; i < s->lights.count; i++) {
        const SceneLight *light = &s->lights.items[i];
        memcpy(roots->lights + i * LIGHT_ROOTS,
               (Node[]){light->vector, light->color, light->softness}, LIGHT_ROOTS * sizeof(Node));
    }
    memcpy(roots->sky, (Node[]){s->zenith, s->horizon, s->ground}, SKY_ROOTS * sizeof(Node));
}

static void lower_marches(Compilation *c, Graph *g)
{
    const Scene *s     = &c->elaborated;
    const Roots *roots = &c->scene->roots;
    size_t       count = s->components.count;
    for (size_t i = 0; i < count; i++) {
        const Shape *shape = s->components.items[i].shape;
        Node         plain = roots->components[i * ROOT_COUNT + ROOT_DISTANCE];
        roots->guarded[i]  = lower_guarded(g, shape, plain, &c->scratch);
        for (AlongMethod method = 0; method < ALONG_COUNT; method++)
            roots->along[method * count + i] = lower_along(g, shape, plain, method, &c->scratch);
    }
}

/*
 * Components that are half-spaces need no march: a ray from p along d enters the one with n.x <= w
 * at (w - n.p) / n.d, if n.d < 0.  The first root is the least of these, the second the least n.d.
 * Where there are zones, planes have holes, and are marched like the rest.
 */
static void lower_planes(Compilation *c, Graph *g)
{
    const Scene *s     = &c->elaborated;
    Node        *roots = c->scene->roots.planes;
    Node         point = graph_leaf(g, OP_POINT), direction = graph_leaf(g, OP_DIRECTION);
    Node         far = graph_number(g, 1e30), zero = graph_number(g, 0);
    roots[0] = far;
    roots[1] = graph_number(g, 1);
    for (size_t i = 0; i < s->components.count && s->zone_count == 0; i++) {
        const Component *component = &s->components.items[i];
        if (!component_is_plane(component))
            continue;
        c->scene->program.planes = true;
        Node rise                = graph_op2(g, OP_dot, component->plane_normal, direction);
        Node depth               = graph_op2(g, OP_dot, component->plane_normal, point);
        Node clearance           = graph_op2(g, OP_sub, component->plane_offset, depth);
        Node falls               = graph_op2(g, OP_less, rise, zero);
        Node step = graph_op3(g, OP_select, falls, graph_op2(g, OP_div, clearance, rise), far);
        roots[0]  = graph_op2(g, OP_min, roots[0], step);
        roots[1]  = graph_op2(g, OP_min, roots[1], rise);
    }
}

/* Whether rays go by roots of polynomials and nothing has many levels: then derivatives cost less
   than the differences of a bound, which is no better than its series. */
static bool is_algebraic(const Scene *s, const Roots *roots)
{
    const Node *exact = roots->along + ALONG_EXACT * s->components.count;
    bool        found = false;
    for (size_t i = 0; i < s->components.count; i++) {
        const Shape *shape = s->components.items[i].shape;
        if (shape->levels > 0 || shape->inversions > 0)
            return false;
        found = found || exact[i] != roots->components[i * ROOT_COUNT + ROOT_DISTANCE];
    }
    return found;
}

/* Of components and of the zones, where they are asked for or the best there is. */
static void lower_gradients(Compilation *c, Graph *g)
{
    const Scene *s       = &c->elaborated;
    const Roots *roots   = &c->scene->roots;
    KrsProgram  *program = &c->scene->program;
    program->algebraic   = is_algebraic(s, roots);
    program->gradients   = program->algebraic || program->sheets || c->options->gradients;
    for (size_t i = 0; i <= s->components.count; i++) {
        bool zones = i == s->components.count, known = false;
        Node near = s->zone_count > 0 ? s->zone : graph_number(g, 0), gradient = NODE_NONE;
        if (zones && program->gradients)
            known = graph_gradient(g, near, &gradient, NULL, &c->scratch) != DERIVED_NOT;
        else if (program->gradients)
            known = lower_gradient(g, s->components.items[i].shape, &gradient, &near, &c->scratch);
        Node  distance = zones ? near : roots->components[i * ROOT_COUNT + ROOT_DISTANCE];
        Node *root     = roots->gradients + i * GRADIENT_ROOTS;
        root[0]        = known ? gradient : distance;
        root[1]        = known ? near : distance;
        arena_free(&c->scratch);
    }
}

/* The roots of the components, and those of planes, for camera-relative points. */
static void lower_camera_relative(Compilation *c, Graph *g)
{
    const Roots   *roots    = &c->scene->roots;
    size_t         count    = c->elaborated.components.count * ROOT_COUNT;
    GraphParameter anywhere = {{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}, {HUGE_VAL, HUGE_VAL, HUGE_VAL}};
    Node           rebase_origin = graph_parameter(g, (uint32_t)g->parameters.count, TYPE_VEC3);
    array_push(&c->scene->arena, &g->parameters, anywhere);
    memcpy(roots->camera_relative, roots->components, count * sizeof(Node));
    memcpy(roots->camera_relative + count, roots->planes, PLANE_ROOTS * sizeof(Node));
    graph_rebase(g, roots->camera_relative, count + PLANE_ROOTS, rebase_origin, &c->scratch);
    arena_free(&c->scratch);
}

bool lower_scene(Compilation *c, Graph *graph)
{
    const Scene *s     = &c->elaborated;
    Roots       *roots = &c->scene->roots;
    allocate_roots(c);
    if (!lower_components(c, graph))
        return false;
    for (size_t i = 0; i < s->components.count; i++)
        c->scene->program.sheets |= has_thin_sheets(s->components.items[i].shape);
    bool camera_relative = !c->scene->program.sheets &&
                           may_need_rebase(s, graph, roots->components, &c->scratch);
    gather_view(s, roots);
    lower_marches(c, graph);
    lower_planes(c, graph);
    arena_free(&c->scratch);
    lower_gradients(c, graph);
    for (size_t i = 0; i < s->slopes.count; i++)
        roots->slopes[i] = s->slopes.items[i].formula;
    c->scene->program.camera_relative = camera_relative;
    if (camera_relative)
        lower_camera_relative(c, graph);
    else
        roots->count -= camera_relative_roots(s); /* they are the last */
    return true;
}
