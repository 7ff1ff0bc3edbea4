/*
 * rounds.c: a coarse mesh, and a finer one where it is refuted, until it is proven.
 *
 * Where the surface is smooth a proof takes no more than values that are known (smooth.h), so a mesh is
 * refined there first.  Then parts that have edges are proven by cells (verify.h).  Such a proof holds
 * until the mesh changes near to it: after each round those that were bisected mark the cells of a
 * coarse grid, and what touches no marked cell is not looked at again.
 */
#include <stdio.h>
#include <time.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/base/vec.h"
#include "compiler/mesh/mesher.h"
#include "compiler/mesh/smooth.h"

enum { PATIENCE = 16 }; /* groups between two questions */
/* The cube's corner is nowhere in particular, so that planes of the scene seldom have points of the
   grid. */
static const double CUBE_CORNER[3] = {0.04417, 0.04731, 0.04553};
/* The rest of the error is for rounding: files may have single precision. */
static const double PROVEN_ERROR = 0.999;
/* Edges, in errors, below which what curves too much for second derivatives is left to cells. */
static const double LEAST_SMOOTH = 12;

static double proven_error(const Mesher *m) { return PROVEN_ERROR * m->error; }

static void find_box(const Mesher *m, const Tet *tet, double low[3], double high[3])
{
    double corners[4][3];
    tets_corners(&m->tets, tet, corners);
    for (int k = 0; k < 3; k++) {
        low[k]  = fmin(fmin(corners[0][k], corners[1][k]), fmin(corners[2][k], corners[3][k]));
        high[k] = fmax(fmax(corners[0][k], corners[1][k]), fmax(corners[2][k], corners[3][k]));
    }
}

/* ---- marks ---- */

static void find_cells(const Mesher *m, const Tet *tet, double margin, int low[3], int high[3])
{
    double least[3], most[3];
    find_box(m, tet, least, most);
    for (int k = 0; k < 3; k++) {
        double scale = MARKS / m->side, origin = m->tets.origin[k];
        low[k]  = (int)fmax(0, floor((least[k] - margin - origin) * scale));
        high[k] = (int)fmin(MARKS - 1, floor((most[k] + margin - origin) * scale));
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

/* ---- groups ---- */

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

/* Tetrahedra of these states, by where they are. */
static void find_groups(Mesher *m, TetState first, TetState last)
{
    groups_clear(&m->groups);
    for (size_t i = 0; i < m->tets.list.count; i++)
        if (m->tets.list.items[i].state >= first && m->tets.list.items[i].state <= last)
            add_to_groups(m, i);
    groups_finish(&m->groups);
    atomic_store(&m->next_group, 0);
}

static Tet *tet_of_group(Mesher *m, const Group *group, uint32_t i)
{
    return &m->tets.list.items[m->groups.order.items[group->first + i]];
}

static Box box_and_margin(const Mesher *m, const double low[3], const double high[3])
{
    Box box;
    for (int k = 0; k < 3; k++)
        box.axis[k] = (Range){low[k] - m->error, high[k] + m->error};
    return box;
}

/* The error around is within it. */
static Box box_of_group(Mesher *m, const Group *group)
{
    double low[3], high[3], least[3], most[3];
    find_box(m, tet_of_group(m, group, 0), low, high);
    for (uint32_t i = 1; i < group->count; i++) {
        find_box(m, tet_of_group(m, group, i), least, most);
        for (int k = 0; k < 3; k++) {
            low[k]  = fmin(low[k], least[k]);
            high[k] = fmax(high[k], most[k]);
        }
    }
    return box_and_margin(m, low, high);
}

typedef void WorkOnGroup(Mesher *m, Verifier *verifier, const Group *group);

typedef struct GroupWork {
    Mesher      *m;
    WorkOnGroup *work;
} GroupWork;

static void work_on_groups(void *task, size_t part, size_t parts)
{
    GroupWork *w        = task;
    Mesher    *m        = w->m;
    Verifier  *verifier = &m->verifiers[part];
    size_t     asked    = 0;
    (void)parts;
    *verifier = (Verifier){
        .field = &m->fields[part], .tets = &m->tets, .mesh = &m->bvh, .error = proven_error(m)};
    while (!atomic_load(&m->stopped)) {
        size_t next = atomic_fetch_add(&m->next_group, 1);
        if (next >= m->groups.list.count)
            return;
        if (part == 0 && asked++ % PATIENCE == 0 && !is_wanted(m))
            atomic_store(&m->stopped, true);
        const Group *group   = &m->groups.list.items[next];
        bool         entered = field_enter(verifier->field, box_of_group(m, group));
        w->work(m, verifier, group);
        if (entered)
            field_leave(verifier->field);
    }
}

static bool for_groups(Mesher *m, WorkOnGroup *work)
{
    GroupWork w = {m, work};
    run_in_parallel(work_on_groups, &w);
    return !atomic_load(&m->stopped);
}

/* ---- where the surface is smooth ---- */

/* A tetrahedron, and the cell of a grid that has it: the finest one whose cells are no smaller. */
typedef struct Placed {
    uint64_t cell;
    uint32_t tet;
} Placed;

static uint64_t cell_of(const Tets *tets, const Tet *tet)
{
    uint32_t low[3], most = 0;
    uint64_t cell = 1, size = 1, bits = 20; /* the first bit tells sizes apart */
    for (int k = 0; k < 3; k++) {
        uint32_t high = 0;
        low[k]        = UINT32_MAX;
        for (int i = 0; i < 4; i++) {
            uint32_t at = tets->points.items[tet->points[i]].at[k];
            low[k]      = at < low[k] ? at : low[k];
            high        = at > high ? at : high;
        }
        most = high - low[k] > most ? high - low[k] : most;
    }
    for (; size < most; size *= 2)
        bits--;
    for (int k = 0; k < 3; k++)
        cell = cell << bits | low[k] / size;
    return cell;
}

static int compare_placed(const void *a, const void *b)
{
    const Placed *first = a, *second = b;
    return first->cell != second->cell ? (first->cell > second->cell) - (first->cell < second->cell)
                                       : (first->tet > second->tet) - (first->tet < second->tet);
}

static TetState state_of_smooth(const Mesher *m, const Tet *tet)
{
    if (tet->miss <= tet->slope * proven_error(m))
        return TET_FITS;
    return tet->miss < INFINITY && tets_longest_edge(&m->tets, tet) > LEAST_SMOOTH * m->error
               ? TET_REFUTED
               : TET_ROUGH;
}

static void measure_in_cell(Mesher *m, const Verifier *verifier, const SmoothCell *cell,
                            const Placed *placed, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        Tet *tet = &m->tets.list.items[placed[i].tet];
        if (cell->empty || smooth_measure(&m->contour, cell, tet) ||
            (!cell->known && verify_is_empty(verifier, tet)))
            tet->state = TET_EMPTY;
        else
            tet->state = (uint8_t)state_of_smooth(m, tet);
    }
}

/* Whether one that does not fit would by a share of the error, were bounds what they are at best. */
static bool one_may_fit(Mesher *m, const SmoothCell *middle, double share, const Placed *placed,
                        size_t count)
{
    for (size_t i = 0; i < count; i++) {
        Tet tet = m->tets.list.items[placed[i].tet];
        if ((tet.state == TET_REFUTED || tet.state == TET_ROUGH) && tet.miss < INFINITY) {
            smooth_measure(&m->contour, middle, &tet);
            if (tet.miss <= share * tet.slope * proven_error(m))
                return true;
        }
    }
    return false;
}

/* Narrower bounds cost more, so they are found only where they may tell. */
static void look_closer(Mesher *m, Verifier *verifier, SmoothCell *cell, const Placed *placed,
                        size_t count)
{
    static const double AT_BEST = 0.85;
    enum { HALVINGS = 3 };
    SmoothCell middle;
    if (cell->known && !cell->empty && smooth_look_at_middle(verifier->field, cell, &middle) &&
        one_may_fit(m, &middle, AT_BEST, placed, count)) {
        smooth_look_closer(verifier->field, m->error, HALVINGS, cell);
        measure_in_cell(m, verifier, cell, placed, count);
    }
}

static void look_at_cell(Mesher *m, Verifier *verifier, const Placed *placed, size_t count)
{
    double     low[3], high[3], least[3], most[3];
    SmoothCell cell = {0};
    find_box(m, &m->tets.list.items[placed[0].tet], low, high);
    for (size_t i = 1; i < count; i++) {
        find_box(m, &m->tets.list.items[placed[i].tet], least, most);
        for (int k = 0; k < 3; k++) {
            low[k]  = fmin(low[k], least[k]);
            high[k] = fmax(high[k], most[k]);
        }
    }
    Box  box     = box_and_margin(m, low, high);
    bool entered = field_enter(verifier->field, box);
    if (!entered) {
        for (size_t i = 0; i < count; i++)
            m->tets.list.items[placed[i].tet].state = TET_EMPTY;
        return;
    }
    smooth_look(verifier->field, box, m->error, &cell);
    measure_in_cell(m, verifier, &cell, placed, count);
    look_closer(m, verifier, &cell, placed, count);
    field_leave(verifier->field);
}

static void look_at_group(Mesher *m, Verifier *verifier, const Group *group)
{
    Placed placed[LARGEST_GROUP];
    size_t count = 0, end;
    for (uint32_t i = 0; i < group->count; i++) {
        Tet *tet = tet_of_group(m, group, i);
        if (verify_is_far(&m->tets, tet))
            tet->state = TET_EMPTY;
        else
            placed[count++] = (Placed){cell_of(&m->tets, tet),
                                       m->groups.order.items[group->first + i]};
    }
    qsort(placed, count, sizeof *placed, compare_placed);
    for (size_t i = 0; i < count; i = end) {
        for (end = i + 1; end < count && placed[end].cell == placed[i].cell;)
            end++;
        look_at_cell(m, verifier, &placed[i], end - i);
    }
}

/* What points know of all tetrahedra that have them. */
static void look_around(Mesher *m)
{
    static const Around nothing = {0, INFINITY};
    while (m->around.count < m->tets.points.count)
        array_push_large(&m->arena, &m->around, nothing);
    for (size_t i = 0; i < m->around.count; i++)
        m->around.items[i] = nothing;
    for (size_t i = 0; i < m->tets.list.count; i++) {
        const Tet *tet  = &m->tets.list.items[i];
        float      miss = tet->state == TET_EMPTY ? 0 : tet->miss;
        for (int k = 0; k < 4; k++) {
            Around *around = &m->around.items[tet->points[k]];
            around->miss   = miss > around->miss ? miss : around->miss;
            around->width  = tet->width < around->width ? tet->width : around->width;
        }
    }
}

/* Whether no point of those around a tetrahedron is on the wrong side of the mesh by more than grows along the
   error; and from none of its points one leaves them within that. */
static bool all_fit_around(const Mesher *m, const Tet *tet)
{
    float miss = 0, width = INFINITY;
    for (int k = 0; k < 4; k++) {
        const Around *around = &m->around.items[tet->points[k]];
        miss                 = around->miss > miss ? around->miss : miss;
        width                = around->width < width ? around->width : width;
    }
    return miss <= tet->slope * fmin(proven_error(m), width);
}

/* What needs no cells. */
static size_t judge_smooth(Mesher *m)
{
    size_t refuted = 0;
    look_around(m);
    for (size_t i = 0; i < m->tets.list.count; i++) {
        Tet *tet = &m->tets.list.items[i];
        if (tet->state == TET_FITS && all_fit_around(m, tet))
            tet->state = TET_PROVEN;
        refuted += tet->state == TET_REFUTED && tets_can_bisect(&m->tets, i);
    }
    return refuted;
}

/* ---- where it has edges ---- */

static void verify_group(Mesher *m, Verifier *verifier, const Group *group)
{
    for (uint32_t i = 0; i < group->count; i++) {
        Tet *tet   = tet_of_group(m, group, i);
        tet->state = (uint8_t)verify_tet(verifier, tet);
    }
}

/* ---- rounds ---- */

/* Proofs end where the mesh is new. */
static void forget_marked(Mesher *m)
{
    for (size_t i = 0; i < m->tets.list.count; i++) {
        Tet *tet = &m->tets.list.items[i];
        if ((tet->state == TET_PROVEN || tet->state == TET_UNRESOLVED) && is_marked(m, tet))
            tet->state = (uint8_t)state_of_smooth(m, tet);
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
    forget_marked(m);
    contour_distances(&m->contour);
    return true;
}

/* First tetrahedra: about as large as they will be where the surface is as curved as a ball that fills the box,
   and half of that where there are few. */
static void bisect_evenly(Mesher *m)
{
    Verifier verifier = {.field = &m->fields[0], .tets = &m->tets, .error = m->error};
    double   even     = sqrt(m->error * m->side);
    double   length   = fmin(2 * even, fmax(even, m->side / 8));
    length            = fmin(fmax(length, m->side / 32), m->side / 4);
    bool any          = true;
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

static void find_tree(Mesher *m)
{
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

/* False: it was stopped. */
static bool prove(Mesher *m)
{
    find_groups(m, TET_NEW, TET_NEW);
    if (!for_groups(m, look_at_group))
        return false;
    if (judge_smooth(m) == 0) {
        find_tree(m);
        find_groups(m, TET_FITS, TET_ROUGH);
        if (!for_groups(m, verify_group))
            return false;
        bvh_free(&m->bvh, m->contour.triangles.count, &m->arena);
    }
    count_proven(m);
    if (getenv("MDBG")) {
        size_t n[8] = {0}, fin = 0, low = 0;
        double sl = 0;
        for (size_t i = 0; i < m->tets.list.count; i++) {
            const Tet *t = &m->tets.list.items[i];
            n[t->state]++;
            if (t->state != TET_EMPTY) {
                fin += t->miss < INFINITY;
                low += t->miss < INFINITY && t->slope <= 0;
                if (t->miss < INFINITY)
                    sl += t->slope;
            }
        }
        fprintf(stderr,
                "tets %zu new %zu empty %zu fits %zu rough %zu proven %zu refuted %zu unres %zu; "
                "smooth %zu noslope %zu mean slope %g tris %zu t %.2f\n",
                m->tets.list.count, n[0], n[1], n[2], n[3], n[4], n[5], n[6], fin, low,
                sl / (double)fin, m->contour.triangles.count, (double)clock() / CLOCKS_PER_SEC);
    }
    return is_wanted(m);
}

bool find_proven_mesh(Mesher *m)
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
        contour_find(&m->contour);
        if (!prove(m))
            return false;
    } while (refine(m));
    return true;
}
