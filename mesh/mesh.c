/* mesh.c: krs_mesh checks what is asked for, runs the mesher and copies its mesh. */
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/base/allocator.h"
#include "compiler/scene/program.h"
#include "mesh/borders.h"
#include "mesh/contour/handles.h"
#include "mesh/contour/voids.h"
#include "mesh/flat/flat.h"
#include "mesh/mesh.h"
#include "mesh/rounds.h"

static const double DEFAULT_ERROR = 1.0 / 200, MIN_ERROR = 1.0 / 500000;
static const double CUBE_SIDE = 1.0973; /* in longest sides of the box */
/* Errors that the side of the cube is longer at each attempt, so that tetrahedra lie otherwise. */
enum { ATTEMPTS = 3 };
static const double MORE_SIDE[ATTEMPTS] = {4, 6, 9.5};
/* The part of the error that is reserved for simplification. */
static const double RESERVED = 0.5;

/* ---- options and memory ---- */

/* Finds the box of what is meshed; returns false where it is unbounded. */
static bool find_box(Mesher *m)
{
    const KrsMeshOptions *options = m->options;
    for (int k = 0; k < 3; k++) {
        Range range = m->solid->box.axis[k];
        m->low[k]   = options->within ? fmax(range.low, options->low[k]) : range.low;
        m->high[k]  = options->within ? fmin(range.high, options->high[k]) : range.high;
        if (!isfinite(m->low[k]) || !isfinite(m->high[k])) {
            bool empty = m->low[k] > m->high[k];
            if (!empty)
                return false;
        }
    }
    return true;
}

static bool is_nothing(const Mesher *m)
{
    return m->low[0] >= m->high[0] || m->low[1] >= m->high[1] || m->low[2] >= m->high[2];
}

static KrsStatus open_fields(Mesher *m, KrsState *state)
{
    KrsStatus status = KRS_OK;
    for (size_t i = 0; i < parallel_parts() && status == KRS_OK; i++) {
        MeshField *field = &m->fields[i];
        *field           = (MeshField){.solid = m->solid, .cut = m->options->within};
        memcpy(field->low, m->low, sizeof field->low);
        memcpy(field->high, m->high, sizeof field->high);
        status = state_copy_of(state, &field->state);
        if (status == KRS_OK) {
            state_refresh_points(field->state);
            field_open(field, &m->arena);
            field->ranges.unroll = true;
        }
    }
    return status;
}

static void close_mesher(Mesher *m)
{
    for (int i = 0; i < MAX_PARTS; i++)
        state_free(m->fields[i].state);
    arena_free(&m->arena);
    free(m);
}

static KrsStatus copy_mesh(const Mesher *m, const KrsAllocator *allocator, KrsMesh **result)
{
    const Contour *contour = &m->contour;
    KrsMesh       *mesh    = allocator_new(allocator, 1, sizeof *mesh);
    if (!mesh)
        return KRS_OUT_OF_MEMORY;
    mesh->allocator      = *allocator;
    mesh->error          = m->error;
    mesh->unresolved     = m->unresolved;
    mesh->vertex_count   = contour->vertices.count;
    mesh->triangle_count = contour->triangles.count;
    mesh->vertices       = allocator_new(allocator, mesh->vertex_count, sizeof *mesh->vertices);
    mesh->triangles      = allocator_new(allocator, mesh->triangle_count, sizeof *mesh->triangles);
    memcpy(mesh->unresolved_at, m->unresolved_at, sizeof mesh->unresolved_at);
    if (!mesh->vertices || !mesh->triangles) {
        krs_mesh_free(mesh);
        return KRS_OUT_OF_MEMORY;
    }
    if (mesh->triangle_count > 0) {
        memcpy(mesh->vertices, contour->vertices.items,
               mesh->vertex_count * sizeof *mesh->vertices);
        memcpy(mesh->triangles, contour->triangles.items,
               mesh->triangle_count * sizeof *mesh->triangles);
    }
    *result = mesh;
    return KRS_OK;
}

static void close_voids(Mesher *m)
{
    double at[3];
    size_t closed = voids_close(&m->contour, at);
    if (closed > 0 && m->unresolved == 0)
        memcpy(m->unresolved_at, at, sizeof m->unresolved_at);
    m->unresolved += closed;
}

/* Counts rods and holes that are thinner than the error, if nothing else is unresolved. */
static void count_handles(Mesher *m)
{
    double at[3];
    size_t count = m->unresolved == 0 ? handles_count(&m->contour, m->error, at) : 0;
    if (count > 0)
        memcpy(m->unresolved_at, at, sizeof m->unresolved_at);
    m->unresolved += count;
    m->handles = count;
}

/* Tells whether triangles may be as few as the shape permits. */
static bool may_be_few(const Mesher *m)
{
    return !m->options->even && (m->solid->plain || m->solid->steps || m->options->shape);
}

/* Meshes a solid between planes; returns false if that is not wanted, or the solid is not flat. */
static bool find_flat(Mesher *m)
{
    FlatVertices vertices  = {0};
    Triangles    triangles = {0};
    if (!may_be_few(m))
        return false;
    ArenaMark mark = arena_mark(&m->arena);
    if (!find_flat_mesh(m, &vertices, &triangles)) {
        arena_rewind(&m->arena, mark);
        m->flat     = m->fraction;
        m->fraction = 0;
        return false;
    }
    m->contour.vertices.items  = vertices.items;
    m->contour.vertices.count  = vertices.count;
    m->contour.triangles.items = triangles.items;
    m->contour.triangles.count = triangles.count;
    return true;
}

static KrsStatus run(Mesher *m, KrsState *state, KrsMesh **mesh)
{
    jmp_buf exhausted;
    m->memory.exhausted = &exhausted;
    if (setjmp(exhausted) != 0)
        return KRS_OUT_OF_MEMORY;
    KrsStatus status = is_nothing(m) ? KRS_OK : open_fields(m, state);
    if (status == KRS_OK && !is_nothing(m) && !find_flat(m)) {
        m->drafted = m->options->draft;
        m->error -= m->reserved;
        status = find_proven_mesh(m) ? KRS_OK : KRS_INTERRUPTED;
        if (status == KRS_OK) {
            close_voids(m);
            count_handles(m);
        }
    } else
        m->reserved = 0;
    if (status == KRS_OK)
        status = copy_mesh(m, &state->scene->options.allocator, mesh);
    if (status == KRS_OK)
        (*mesh)->estimate = m->solid->estimate || m->drafted;
    m->memory.exhausted = NULL;
    return status;
}

static bool options_are_valid(Mesher *m, int attempt)
{
    const KrsMeshOptions *options = m->options;
    double                longest = 0;
    if (!find_box(m) || !(options->error >= 0) || isinf(options->error))
        return false;
    for (int k = 0; k < 3; k++)
        longest = fmax(longest, m->high[k] - m->low[k]);
    m->error    = options->error > 0 ? options->error : DEFAULT_ERROR * longest;
    m->side     = CUBE_SIDE * longest + MORE_SIDE[attempt] * m->error;
    m->reserved = options->simplify && may_be_few(m) ? RESERVED * m->error : 0;
    return is_nothing(m) || m->error >= MIN_ERROR * m->side;
}

static const KrsMeshOptions no_options = {0};

/* The part of the work that is done when there is a mesh that is not simplified. */
static const double MESHED = 0.5;
/* The part that is done when it is simplified, and triangles are still to be split where materials
   change. */
static const double ALL_MESHED = 0.8;

/* One of two steps of the work. */
typedef struct Step {
    const KrsMeshOptions *options;
    double                begun, part, said; /* `said` is what was reported last, and never falls */
} Step;

static bool report_progress(void *user, double fraction)
{
    Step *step = user;
    step->said = fmax(step->said, step->begun + fraction * step->part);
    return step->options->progress(step->options->user, step->said);
}

static KrsMeshOptions options_of_step(Step *step)
{
    KrsMeshOptions options = *step->options;
    options.progress       = options.progress ? report_progress : NULL;
    options.user           = step;
    return options;
}

/* Simplifies the mesh within the reserved part of the error. */
static KrsStatus simplify_mesh(const KrsMeshOptions *options, double reserved, KrsMesh **mesh)
{
    Step           step  = {options, MESHED, 1 - MESHED, 0};
    KrsMeshOptions these = options_of_step(&step);
    KrsMesh       *all   = *mesh;
    these.error          = reserved;
    KrsStatus status     = krs_mesh_simplify(all, &these, mesh);
    krs_mesh_free(all);
    if (status != KRS_OK)
        *mesh = NULL;
    return status;
}

/* Makes one mesh; `*reserved` becomes the error that is left for simplification, `*handles` as in
   Mesher. */
static KrsStatus mesh_attempt(KrsState *state, const KrsMeshOptions *options,
                              const MeshSolid *solid, int attempt, KrsMesh **mesh, double *reserved,
                              size_t *handles)
{
    Mesher *m = calloc(1, sizeof *m);
    if (!m)
        return KRS_OUT_OF_MEMORY;
    m->options       = options;
    m->solid         = solid;
    m->memory        = state->scene->memory;
    m->memory.used   = 0;
    m->memory.limit  = options->memory_limit ? options->memory_limit : KRS_USUAL_MEMORY;
    m->arena.memory  = &m->memory;
    KrsStatus status = options_are_valid(m, attempt) ? run(m, state, mesh) : KRS_BAD_ARGUMENT;
    *reserved        = m->reserved;
    *handles         = m->handles;
    close_mesher(m);
    return status;
}

/* Makes a mesh, by other tetrahedra as long as it has handles: these mostly come of tetrahedra at a
   sharp edge.  Progress goes on from where the attempt before has ended. */
static KrsStatus mesh_once(KrsState *state, const KrsMeshOptions *options, const MeshSolid *solid,
                           KrsMesh **mesh)
{
    double         end      = options->simplify ? MESHED : 1;
    Step           step     = {options, 0, end, 0};
    KrsMeshOptions these    = options_of_step(&step);
    KrsStatus      status   = KRS_OK;
    double         reserved = 0;
    size_t         handles  = 1;
    *mesh                   = NULL;
    for (int attempt = 0; attempt < ATTEMPTS && status == KRS_OK && handles > 0; attempt++) {
        krs_mesh_free(*mesh);
        *mesh      = NULL;
        status     = mesh_attempt(state, &these, solid, attempt, mesh, &reserved, &handles);
        step.begun = step.said;
        step.part  = end - step.said;
    }
    return status == KRS_OK && reserved > 0 ? simplify_mesh(options, reserved, mesh) : status;
}

/* Makes a mesh, which is not simplified if memory runs out: half of the error needs several times
   the memory. */
static KrsStatus mesh_all(KrsState *state, const KrsMeshOptions *options, const MeshSolid *solid,
                          KrsMesh **mesh)
{
    KrsMeshOptions all    = *options;
    KrsStatus      status = mesh_once(state, options, solid, mesh);
    all.simplify          = false;
    if (status == KRS_OUT_OF_MEMORY && options->simplify)
        status = mesh_once(state, &all, solid, mesh);
    return status;
}

/* Splits triangles until each has one material. */
static KrsStatus split_at_borders(KrsState *state, const KrsMeshOptions *options,
                                  const MeshSolid *solid, KrsMesh **mesh)
{
    Step           step   = {options, ALL_MESHED, 1 - ALL_MESHED, 0};
    KrsMeshOptions these  = options_of_step(&step);
    KrsStatus      status = mesh_split_at_borders(state, &these, solid->copy, *mesh);
    if (status == KRS_OK)
        return KRS_OK;
    krs_mesh_free(*mesh);
    *mesh = NULL;
    return status;
}

KrsStatus mesh_solid(KrsState *state, const KrsMeshOptions *options, const MeshSolid *solid,
                     KrsMesh **mesh)
{
    bool           steps  = solid->steps && !solid->plain && !options->even;
    bool           split  = steps && !options->shape;
    Step           step   = {options, 0, split ? ALL_MESHED : 1, 0};
    KrsMeshOptions these  = options_of_step(&step);
    KrsStatus      status = mesh_all(state, &these, solid, mesh);
    if (status == KRS_OK && split)
        status = split_at_borders(state, options, solid, mesh);
    if (status == KRS_OK) {
        (*mesh)->steps   = steps;
        (*mesh)->colored = options->simplify && !options->even && !solid->plain && !steps &&
                           !options->shape;
    }
    return status;
}

KrsStatus krs_mesh(KrsState *state, const KrsMeshOptions *options, KrsMesh **mesh)
{
    const KrsScene *scene  = state->scene;
    size_t          number = options ? options->component : 0;
    MeshSolid       solid  = {.roots = malloc(solid_root_bytes(scene))};
    bool           *wanted = number ? calloc(scene->component_count + 1, sizeof *wanted) : NULL;
    KrsStatus       status = KRS_OUT_OF_MEMORY;
    *mesh                  = NULL;
    if (number > scene->shown_count || scene->program.open_surfaces)
        status = KRS_BAD_ARGUMENT;
    else if (solid.roots && (wanted || !number)) {
        if (wanted)
            wanted[scene->lowered[number - 1]] = true;
        solid_of_components(scene, wanted, &solid);
        status = mesh_solid(state, options ? options : &no_options, &solid, mesh);
    }
    free(wanted);
    free(solid.roots);
    return status;
}

void krs_mesh_free(KrsMesh *mesh)
{
    if (!mesh)
        return;
    const KrsAllocator allocator = mesh->allocator;
    allocator_release(&allocator, mesh->vertices);
    allocator_release(&allocator, mesh->triangles);
    allocator_release(&allocator, mesh);
}
