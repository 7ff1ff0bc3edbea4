/*
 * mesh.c: krs_mesh: a coarse mesh, and a finer one where it is refuted, until it is proven.
 *
 * A proof about a tetrahedron holds until the mesh changes near to it.  So after each round those that were
 * bisected mark the cells of a coarse grid, and what touches no marked cell is not looked at again.
 */
#include <setjmp.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/base/parallel.h"
#include "compiler/base/vec.h"
#include "compiler/mesh/groups.h"
#include "compiler/mesh/verify.h"
#include "compiler/mesh/voids.h"
#include "compiler/program.h"

enum { MARKS = 64, PATIENCE = 16 }; /* cells along a side; groups between two questions */
static const size_t DEFAULT_LIMIT = (size_t)2 << 30;
static const double DEFAULT_ERROR = 1.0 / 200, LEAST_ERROR = 1.0 / 500000;
/* The cube is larger than the box, and its corner is nowhere in particular, so that planes of the
   scene seldom have points of the grid. */
static const double CUBE_SIDE = 1.0973, CUBE_CORNER[3] = {0.04417, 0.04731, 0.04553};
/* The rest of the error is for rounding: files may have single precision. */
static const double PROVEN_ERROR = 0.999;

typedef struct Mesher {
    Memory                memory;
    Arena                 arena;
    const KrsMeshOptions *options;
    const MeshSolid      *solid;
    double                low[3], high[3], error, side;
    MeshField             fields[MOST_PARTS];
    Verifier              verifiers[MOST_PARTS];
    Tets                  tets;
    Contour               contour;
    Bvh                   bvh;
    bool                  marked[MARKS][MARKS][MARKS];
    Groups                groups; /* of tetrahedra to be looked at */
    atomic_size_t         next_group;
    size_t                unresolved; /* tetrahedra */
    double                unresolved_at[3];
    double                fraction; /* of the work, as was last said */
    atomic_bool           stopped;
} Mesher;

/* ---- marks ---- */

static void find_cells(const Mesher *m, const Tet *tet, double margin, int low[3], int high[3])
{
    double corners[4][3];
    tets_corners(&m->tets, tet, corners);
    for (int k = 0; k < 3; k++) {
        double least = INFINITY, most = -INFINITY;
        for (int i = 0; i < 4; i++) {
            least = fmin(least, corners[i][k]);
            most  = fmax(most, corners[i][k]);
        }
        double scale = MARKS / m->side, origin = m->tets.origin[k];
        low[k]  = (int)fmax(0, floor((least - margin - origin) * scale));
        high[k] = (int)fmin(MARKS - 1, floor((most + margin - origin) * scale));
    }
}

static void mark(Mesher *m, const Tet *tet)
{
    int low[3], high[3];
    find_cells(m, tet, 0, low, high);
    for (int x = low[0]; x <= high[0]; x++)
        for (int y = low[1]; y <= high[1]; y++)
            for (int z = low[2]; z <= high[2]; z++)
                m->marked[x][y][z] = true;
}

static bool is_marked(const Mesher *m, const Tet *tet)
{
    int low[3], high[3];
    find_cells(m, tet, 2 * m->error, low, high);
    for (int x = low[0]; x <= high[0]; x++)
        for (int y = low[1]; y <= high[1]; y++)
            for (int z = low[2]; z <= high[2]; z++)
                if (m->marked[x][y][z])
                    return true;
    return false;
}

/* ---- one round ---- */

/* The first part of a round runs in the thread of the caller, so it may ask. */
static bool is_wanted(const Mesher *m)
{
    return !m->options->go_on || m->options->go_on(m->options->user, m->fraction);
}

static void add_to_groups(Mesher *m, size_t index)
{
    double corners[4][3], center[3];
    tets_corners(&m->tets, &m->tets.list.items[index], corners);
    corners_ball((const double(*)[3])corners, center);
    for (int k = 0; k < 3; k++)
        center[k] = (center[k] - m->tets.origin[k]) / m->side;
    groups_add(&m->groups, (uint32_t)index, center);
}

/* Tetrahedra without a proof, by where they are. */
static void find_groups(Mesher *m)
{
    groups_clear(&m->groups);
    for (size_t i = 0; i < m->tets.list.count; i++) {
        const Tet *tet = &m->tets.list.items[i];
        if (tet->state != TET_EMPTY && (tet->state != TET_PROVEN || is_marked(m, tet)))
            add_to_groups(m, i);
    }
    groups_finish(&m->groups);
    atomic_store(&m->next_group, 0);
}

static Box box_of_group(const Mesher *m, const Group *group)
{
    Box box = {{{INFINITY, -INFINITY}, {INFINITY, -INFINITY}, {INFINITY, -INFINITY}}};
    for (uint32_t i = 0; i < group->count; i++) {
        double corners[4][3];
        tets_corners(&m->tets, &m->tets.list.items[m->groups.order.items[group->first + i]],
                     corners);
        for (int k = 0; k < 12; k++) {
            Range *axis = &box.axis[k % 3];
            axis->low   = fmin(axis->low, corners[k / 3][k % 3] - m->error);
            axis->high  = fmax(axis->high, corners[k / 3][k % 3] + m->error);
        }
    }
    return box;
}

static void verify_group(Mesher *m, Verifier *verifier, const Group *group)
{
    bool entered = field_enter(verifier->field, box_of_group(m, group));
    for (uint32_t i = group->first; i < group->first + group->count; i++) {
        Tet *tet   = &m->tets.list.items[m->groups.order.items[i]];
        tet->state = (uint8_t)verify_tet(verifier, tet);
    }
    if (entered)
        field_leave(verifier->field);
}

static void verify_part(void *task, size_t part, size_t parts)
{
    Mesher   *m        = task;
    Verifier *verifier = &m->verifiers[part];
    size_t    asked    = 0;
    (void)parts;
    *verifier = (Verifier){.field = &m->fields[part],
                           .tets  = &m->tets,
                           .mesh  = &m->bvh,
                           .error = PROVEN_ERROR * m->error};
    while (!atomic_load(&m->stopped)) {
        size_t next = atomic_fetch_add(&m->next_group, 1);
        if (next >= m->groups.list.count)
            return;
        if (part == 0 && asked++ % PATIENCE == 0 && !is_wanted(m))
            atomic_store(&m->stopped, true);
        verify_group(m, verifier, &m->groups.list.items[next]);
    }
}

/* Bisects what is refuted; false: there is nothing. */
static bool refine(Mesher *m)
{
    size_t count = m->tets.list.count, refuted = 0;
    memset(m->marked, 0, sizeof m->marked);
    for (size_t i = 0; i < count; i++) {
        if (m->tets.list.items[i].state != TET_REFUTED || !tets_can_bisect(&m->tets, i))
            continue;
        refuted++;
        tets_bisect(&m->tets, i);
    }
    if (refuted == 0)
        return false;
    tets_close(&m->tets);
    for (size_t i = 0; i < m->tets.list.count; i++)
        if (m->tets.list.items[i].state == TET_NEW)
            mark(m, &m->tets.list.items[i]);
    contour_distances(&m->contour);
    return true;
}

/* First tetrahedra: about as large as they will be where the surface is as curved as a ball that fills
   the box. */
static void bisect_evenly(Mesher *m)
{
    Verifier verifier = {.field = &m->fields[0], .tets = &m->tets, .error = m->error};
    double   length   = fmin(fmax(sqrt(m->error * m->side), m->side / 32), m->side / 4);
    bool     any      = true;
    while (any) {
        any          = false;
        size_t count = m->tets.list.count;
        contour_distances(&m->contour);
        for (size_t i = 0; i < count; i++) {
            if (tets_longest_edge(&m->tets, &m->tets.list.items[i]) < length ||
                verify_is_empty(&verifier, &m->tets.list.items[i]))
                continue;
            tets_bisect(&m->tets, i);
            any = true;
        }
        tets_close(&m->tets);
    }
    contour_distances(&m->contour);
}

static void find_mesh(Mesher *m)
{
    size_t before = m->contour.triangles.count;
    bvh_free(&m->bvh, before, &m->arena);
    contour_find(&m->contour);
    bvh_new(&m->bvh, (const double(*)[3])m->contour.vertices.items,
            (const uint32_t(*)[3])m->contour.triangles.items, m->contour.triangles.count,
            &m->arena);
}

/* Counts what is decided. */
static void count_proven(Mesher *m)
{
    size_t near = 0, proven = 0;
    m->unresolved = 0;
    for (size_t i = 0; i < m->tets.list.count; i++) {
        int state = m->tets.list.items[i].state;
        if (state == TET_UNRESOLVED && m->unresolved == 0)
            tets_position(&m->tets, m->tets.list.items[i].points[0], m->unresolved_at);
        near += state != TET_EMPTY;
        proven += state == TET_PROVEN || state == TET_UNRESOLVED;
        m->unresolved += state == TET_UNRESOLVED;
    }
    if (near > 0)
        m->fraction = fmax(m->fraction, (double)proven / (double)near);
}

static void close_voids(Mesher *m)
{
    double at[3];
    size_t closed = voids_close(&m->contour, at);
    if (closed > 0 && m->unresolved == 0)
        memcpy(m->unresolved_at, at, sizeof m->unresolved_at);
    m->unresolved += closed;
}

static KrsStatus make_mesh(Mesher *m)
{
    double origin[3];
    for (int k = 0; k < 3; k++)
        origin[k] = 0.5 * (m->low[k] + m->high[k]) -
                    (0.5 + 0.1 * (CUBE_CORNER[k] - 0.045)) * m->side;
    tets_new(&m->tets, origin, m->side, &m->arena);
    m->contour      = (Contour){.arena            = &m->arena,
                                .tets             = &m->tets,
                                .fields           = m->fields,
                                .error            = m->error,
                                .crossing_numbers = {.arena = &m->arena},
                                .line_numbers     = {.arena = &m->arena}};
    m->groups.arena = &m->arena;
    bisect_evenly(m);
    do {
        find_mesh(m);
        find_groups(m);
        run_in_parallel(verify_part, m);
        if (atomic_load(&m->stopped) || !is_wanted(m))
            return KRS_INTERRUPTED;
        count_proven(m);
    } while (refine(m));
    close_voids(m);
    return KRS_OK;
}

/* ---- what is asked for ---- */

/* The box of what is meshed; false: it has no end. */
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

static KrsStatus open_fields(Mesher *m, KrsFrame *frame)
{
    KrsStatus status = KRS_OK;
    for (size_t i = 0; i < parallel_parts() && status == KRS_OK; i++) {
        MeshField *field = &m->fields[i];
        *field           = (MeshField){.solid = m->solid, .cut = m->options->within};
        memcpy(field->low, m->low, sizeof field->low);
        memcpy(field->high, m->high, sizeof field->high);
        status = frame_copy_of(frame, &field->frame);
        if (status == KRS_OK) {
            frame_refresh(field->frame);
            field_open(field, &m->arena);
        }
    }
    return status;
}

static void close_mesher(Mesher *m)
{
    for (int i = 0; i < MOST_PARTS; i++)
        frame_free(m->fields[i].frame);
    arena_free(&m->arena);
    free(m);
}

static KrsStatus copy_mesh(const Mesher *m, KrsMesh **result)
{
    const Contour *contour = &m->contour;
    KrsMesh       *mesh    = calloc(1, sizeof *mesh);
    if (!mesh)
        return KRS_OUT_OF_MEMORY;
    mesh->error          = m->error;
    mesh->unresolved     = m->unresolved;
    mesh->vertex_count   = contour->vertices.count;
    mesh->triangle_count = contour->triangles.count;
    mesh->vertices       = malloc((mesh->vertex_count + 1) * sizeof *mesh->vertices);
    mesh->triangles      = malloc((mesh->triangle_count + 1) * sizeof *mesh->triangles);
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

static KrsStatus run(Mesher *m, KrsFrame *frame, KrsMesh **mesh)
{
    jmp_buf exhausted;
    m->memory.exhausted = &exhausted;
    if (setjmp(exhausted) != 0)
        return KRS_OUT_OF_MEMORY;
    KrsStatus status = is_nothing(m) ? KRS_OK : open_fields(m, frame);
    if (status == KRS_OK && !is_nothing(m))
        status = make_mesh(m);
    if (status == KRS_OK)
        status = copy_mesh(m, mesh);
    if (status == KRS_OK)
        (*mesh)->estimate = m->solid->estimate;
    m->memory.exhausted = NULL;
    return status;
}

static bool options_are_valid(Mesher *m)
{
    const KrsMeshOptions *options = m->options;
    double                longest = 0;
    if (!find_box(m) || !(options->error >= 0) || isinf(options->error))
        return false;
    for (int k = 0; k < 3; k++)
        longest = fmax(longest, m->high[k] - m->low[k]);
    m->error = options->error > 0 ? options->error : DEFAULT_ERROR * longest;
    m->side  = CUBE_SIDE * longest + 4 * m->error;
    return is_nothing(m) || m->error >= LEAST_ERROR * m->side;
}

static const KrsMeshOptions no_options = {0};

KrsStatus mesh_solid(KrsFrame *frame, const KrsMeshOptions *options, const MeshSolid *solid,
                     KrsMesh **mesh)
{
    *mesh     = NULL;
    Mesher *m = calloc(1, sizeof *m);
    if (!m)
        return KRS_OUT_OF_MEMORY;
    m->options       = options;
    m->solid         = solid;
    m->memory        = frame->scene->memory;
    m->memory.used   = 0;
    m->memory.limit  = m->options->memory_limit ? m->options->memory_limit : DEFAULT_LIMIT;
    m->arena.memory  = &m->memory;
    KrsStatus status = options_are_valid(m) ? run(m, frame, mesh) : KRS_BAD_ARGUMENT;
    close_mesher(m);
    return status;
}

KrsStatus krs_mesh(KrsFrame *frame, const KrsMeshOptions *options, KrsMesh **mesh)
{
    const KrsScene *scene  = frame->scene;
    size_t          number = options ? options->component : 0;
    MeshSolid       solid  = {.roots = malloc(solid_root_bytes(scene))};
    bool           *wanted = number ? calloc(scene->component_count + 1, sizeof *wanted) : NULL;
    KrsStatus       status = KRS_OUT_OF_MEMORY;
    *mesh                  = NULL;
    if (number > scene->shown_count || scene->program.sheets)
        status = KRS_BAD_ARGUMENT;
    else if (solid.roots && (wanted || !number)) {
        if (wanted)
            wanted[scene->lowered[number - 1]] = true;
        solid_of_components(scene, wanted, &solid);
        status = mesh_solid(frame, options ? options : &no_options, &solid, mesh);
    }
    free(wanted);
    free(solid.roots);
    return status;
}

void krs_mesh_free(KrsMesh *mesh)
{
    if (!mesh)
        return;
    free(mesh->vertices);
    free(mesh->triangles);
    free(mesh);
}
