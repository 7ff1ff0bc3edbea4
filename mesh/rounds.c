/*
 * rounds.c: refines a coarse mesh where it is refuted, until it is proven.
 *
 * Where the surface is smooth a proof takes no more than values that are known (smooth.h), so a
 * mesh is refined there first.  Then parts that have edges are proven by cells (verify.h).  Such a
 * proof holds until the mesh changes where the proof has used it: tetrahedra that were bisected
 * mark cells of a grid.  What is refuted is bisected and proven first.  When nothing is refuted any
 * more, proofs that have become stale are found again.
 */
#include "mesh/rounds.h"

#include <string.h>

#include "compiler/base/vec.h"
#include "mesh/contour/handles.h"
#include "mesh/contour/sides.h"
#include "mesh/proof/bounds.h"
#include "mesh/proof/draft.h"

enum { ASK_EVERY = 16 }; /* groups between two reports of progress */
/* The cube's corner has arbitrary coordinates, so that points of the grid are seldom on planes of
   the scene. */
static const double CUBE_CORNER[3] = {0.04417, 0.04731, 0.04553};

/* ---- marks ---- */

/* Adds the box of a tetrahedron, `around` wider on all sides, to a box of marks. */
static void add_tet_box(const Mesher *m, const Tet *tet, double around, MarkBox *box)
{
    double low[3], high[3];
    tet_box(m, tet, low, high);
    for (int k = 0; k < 3; k++) {
        low[k] -= around;
        high[k] += around;
    }
    mark_box_add(&m->tets, low, high, box);
}

/* Marks fresh tetrahedra that have triangles now, or had some before they were bisected.  Until
   there are proofs none can become stale. */
static void mark_fresh(Mesher *m)
{
    for (size_t i = 0; i < m->tets.fresh.count; i++) {
        Tet    *tet = &m->tets.list.items[m->tets.fresh.items[i]];
        MarkBox box = mark_box_none();
        if (m->has_proofs && (tet->replaced || tet->triangle_count > 0)) {
            add_tet_box(m, tet, 0, &box);
            marks_set(&m->marks, &box);
        }
        tet->replaced = false;
    }
}

/* ---- progress ---- */

/* The parts of the work that are done when bounds refute nothing more, and when cells have verified
   all.  After that each round of cells does about half of what is left. */
static const double BOUNDS_DONE = 0.65, CELLS_DONE = 0.85;
/* Tetrahedra that will be bounded for each that is refuted now. */
static const double FOLLOWING = 8;

/* Returns the part that is done when so many have been bounded and so many are refuted. */
static double fraction_by_bounds(double bounded, double refuted)
{
    return bounded > 0 ? BOUNDS_DONE * bounded / (bounded + FOLLOWING * refuted) : 0;
}

static double fraction_by_cells(const Mesher *m)
{
    return m->fraction <= BOUNDS_DONE ? CELLS_DONE : 0.5 * (1 + m->fraction);
}

/* ---- groups ---- */

static void add_to_groups(Mesher *m, size_t index)
{
    double corners[4][3], center[3];
    tets_corners(&m->tets, &m->tets.list.items[index], corners);
    corners_ball((const double(*)[3])corners, center);
    for (int k = 0; k < 3; k++)
        center[k] = (center[k] - m->tets.origin[k]) / m->side;
    groups_add(&m->groups, (uint32_t)index, center);
}

static void find_fresh_groups(Mesher *m)
{
    groups_clear(&m->groups);
    for (size_t i = 0; i < m->tets.fresh.count; i++)
        if (m->tets.list.items[m->tets.fresh.items[i]].state == TET_NEW)
            add_to_groups(m, m->tets.fresh.items[i]);
    groups_finish(&m->groups);
    atomic_store(&m->next_group, 0);
}

/* Groups tetrahedra whose states are in this range, by their locations. */
static void find_groups(Mesher *m, TetState first, TetState last)
{
    groups_clear(&m->groups);
    for (size_t i = 0; i < m->tets.list.count; i++)
        if (m->tets.list.items[i].state >= first && m->tets.list.items[i].state <= last)
            add_to_groups(m, i);
    groups_finish(&m->groups);
    atomic_store(&m->next_group, 0);
}

/* Returns the box of a group, wider by twice the error on all sides. */
static Box box_of_group(Mesher *m, const Group *group)
{
    double low[3], high[3], least[3], most[3];
    tet_box(m, tet_of_group(m, group, 0), low, high);
    for (uint32_t i = 1; i < group->count; i++) {
        tet_box(m, tet_of_group(m, group, i), least, most);
        for (int k = 0; k < 3; k++) {
            low[k]  = min2(low[k], least[k]);
            high[k] = max2(high[k], most[k]);
        }
    }
    return box_and_margin(2 * m->error, low, high);
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
    *verifier = (Verifier){.field = &m->fields[part],
                           .tets  = &m->tets,
                           .mesh  = &m->bvh,
                           .error = proven_error(m),
                           .sharp = m->sharp};
    while (!atomic_load(&m->stopped)) {
        size_t next = atomic_fetch_add(&m->next_group, 1);
        if (next >= m->groups.list.count)
            return;
        if (part == 0 && asked++ % ASK_EVERY == 0) {
            mesher_advance(m, (double)next / (double)m->groups.list.count);
            if (!mesher_is_wanted(m))
                atomic_store(&m->stopped, true);
        }
        const Group *group   = &m->groups.list.items[next];
        bool         entered = field_enter(verifier->field, box_of_group(m, group));
        w->work(m, verifier, group);
        if (entered)
            field_leave(verifier->field);
    }
}

/* Does work on all groups; returns false if stopped.  `goal` is the part of all work that is done
   afterwards. */
static bool for_groups(Mesher *m, WorkOnGroup *work, double goal)
{
    GroupWork w = {m, work};
    m->begun    = m->fraction;
    m->goal     = goal;
    run_in_parallel(work_on_groups, &w);
    return !atomic_load(&m->stopped);
}

/* ---- proofs by bounds ---- */

/* Edges, in errors, of the smallest tetrahedra that are bisected because their mesh is off the
   surface, though within the error. */
static const double MIN_OFF_SURFACE = 1;
/* Parts of the error by which middles may be off: beyond them the surface passes a tetrahedron or a
   face more often than corners tell.  It does so less often at edges that pieces prove. */
static const double OFF_SURFACE = 0.15, OFF_PIECES = 0.3;

/* Tells whether the mesh in a tetrahedron is near the surface, or the tetrahedron is too small to
   be bisected. */
static bool is_near_surface(const Mesher *m, const Tet *tet)
{
    double off = tet->state == TET_FITS && tet->steep > 0 ? OFF_PIECES : OFF_SURFACE;
    return tet->triangle_count == 0 ||
           patch_off(&m->contour, &m->contour.patches.items[tet->patch]) <= off * m->error ||
           tets_longest_edge(&m->tets, tet) <= MIN_OFF_SURFACE * m->error;
}

/* Finds states by bounds; also refutes tetrahedra whose mesh is off the surface. */
static void judge_group(Mesher *m, Verifier *verifier, const Group *group)
{
    bound_group(m, verifier, group);
    for (uint32_t i = 0; i < group->count; i++) {
        Tet *tet = tet_of_group(m, group, i);
        if ((tet->state == TET_FITS || tet->state == TET_UNPROVEN) && !is_near_surface(m, tet))
            tet->state = TET_REFUTED;
    }
}

/* Marks as proven what bounds alone prove. */
static void judge_smooth(Mesher *m)
{
    Sure sure;
    arounds_find(&m->around, &m->tets, &m->arena);
    for (size_t i = 0; i < m->tets.list.count; i++) {
        Tet *tet = &m->tets.list.items[i];
        if (tet->state != TET_FITS)
            continue;
        sure_find(&m->around, &m->tets, tet, proven_error(m), &sure);
        if (sure.everywhere) {
            tet->state = TET_PROVEN;
            tet->needs = mark_box_none();
            add_tet_box(m, tet, m->error, &tet->needs);
        }
    }
}

/* ---- proofs by cells ---- */

static void verify_group(Mesher *m, Verifier *verifier, const Group *group)
{
    for (uint32_t i = 0; i < group->count; i++) {
        Tet *tet       = tet_of_group(m, group, i);
        verifier->sure = (Sure){.anywhere = false};
        if (tet->state == TET_FITS)
            sure_find(&m->around, &m->tets, tet, proven_error(m), &verifier->sure);
        tet->state = (uint8_t)verify_tet(verifier, tet);
    }
}

/* ---- rounds ---- */

static bool has_proof(const Tet *tet)
{
    return tet->state == TET_PROVEN || tet->state == TET_UNRESOLVED;
}

/* Marks proofs as stale where the mesh has changed since they were found. */
static void find_stale(Mesher *m)
{
    for (size_t i = 0; i < m->tets.list.count; i++) {
        Tet *tet   = &m->tets.list.items[i];
        tet->stale = has_proof(tet) && (tet->stale || marks_touch(&m->marks, &tet->needs));
    }
    marks_clear(&m->marks);
}

/* Forgets stale proofs; returns false if there are none. */
static bool forget_stale(Mesher *m)
{
    bool any = false;
    for (size_t i = 0; i < m->tets.list.count; i++) {
        Tet *tet = &m->tets.list.items[i];
        if (has_proof(tet) && tet->stale) {
            tet->state = (uint8_t)state_by_bounds(m, tet);
            any        = true;
        }
    }
    return any;
}

static bool bisect_refuted(Mesher *m, size_t i)
{
    if (m->tets.list.items[i].state != TET_REFUTED || !tets_can_bisect(&m->tets, i))
        return false;
    tets_bisect(&m->tets, i);
    return true;
}

/* Bisects what is refuted among tetrahedra that were fresh, or among all; returns how many. */
static size_t bisect_all_refuted(Mesher *m, bool fresh)
{
    size_t count = fresh ? m->last.count : m->tets.list.count, refuted = 0;
    for (size_t i = 0; i < count; i++)
        refuted += bisect_refuted(m, fresh ? m->last.items[i] : i);
    return refuted;
}

/* Bisects parts that are refuted from the beginning, but not where there is clearly no surface. */
static void bisect_hopeless(Mesher *m)
{
    bool any;
    do {
        any = false;
        contour_distances(&m->contour);
        for (size_t i = 0, count = m->tets.fresh.count; i < count; i++) {
            size_t number = m->tets.fresh.items[i];
            Tet   *tet    = &m->tets.list.items[number];
            if (tet->hopeless && !tets_is_moved(&m->tets, tet) && verify_is_far(&m->tets, tet))
                tet->state = TET_EMPTY;
            else if (tet->hopeless && bisect_refuted(m, number))
                any = true;
        }
    } while (any);
}

/* Bisects what is refuted, and what then no longer meets its neighbours; returns false if nothing
   is refuted. */
static bool refine(Mesher *m, bool fresh)
{
    m->last.count = 0;
    for (size_t i = 0; i < m->tets.fresh.count; i++)
        array_push_large(&m->arena, &m->last, m->tets.fresh.items[i]);
    tets_forget_fresh(&m->tets);
    if (bisect_all_refuted(m, fresh) == 0)
        return false;
    bisect_hopeless(m);
    tets_close(&m->tets);
    contour_distances(&m->contour);
    return true;
}

/* Makes the first tetrahedra: about as large as a ball that fills the box needs, and half of that
   where these are few. */
static void bisect_evenly(Mesher *m)
{
    Verifier verifier = {.field = &m->fields[0], .tets = &m->tets, .error = m->error};
    double   even     = sqrt(m->error * m->side);
    double   length   = min2(2 * even, max2(even, m->side / 8));
    length            = min2(max2(length, m->side / 32), m->side / 4);
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

/* Finds where the first unresolved tetrahedron is so, by verifying it again. */
static void find_unresolved(Mesher *m)
{
    size_t i = 0;
    while (i < m->tets.list.count && m->tets.list.items[i].state != TET_UNRESOLVED)
        i++;
    if (i == m->tets.list.count)
        return;
    Tet tet = m->tets.list.items[i];
    verify_tet(&m->verifiers[0], &tet);
    memcpy(m->unresolved_at, m->verifiers[0].location, sizeof m->unresolved_at);
}

static void count_unresolved(Mesher *m)
{
    m->unresolved = 0;
    for (size_t i = 0; i < m->tets.list.count; i++)
        m->unresolved += m->tets.list.items[i].state == TET_UNRESOLVED;
}

static void count_refuted(Mesher *m)
{
    size_t count = m->tets.fresh.count, refuted = 0;
    for (size_t i = 0; i < count; i++)
        refuted += m->tets.list.items[m->tets.fresh.items[i]].state == TET_REFUTED;
    m->bounded += (double)count;
    m->fraction = max2(m->fraction, fraction_by_bounds(m->bounded, (double)refuted));
}

/* Refines until bounds refute nothing more; each round bounds what is fresh.  Returns false if
   stopped. */
static bool refine_by_bounds(Mesher *m)
{
    do {
        contour_find_patches(&m->contour);
        mark_fresh(m);
        find_fresh_groups(m);
        bounds_begin(m);
        double count = (double)m->tets.fresh.count, few = count / 3;
        if (!for_groups(m, m->options->draft ? draft_group : judge_group,
                        fraction_by_bounds(m->bounded + count, few)))
            return false;
        bounds_end(m);
        count_refuted(m);
    } while (refine(m, true));
    return true;
}

/* Proves what is left by cells; returns false if stopped. */
static bool prove(Mesher *m)
{
    find_stale(m);
    m->has_proofs = true;
    judge_smooth(m);
    find_tree(m);
    find_groups(m, TET_FITS, TET_UNPROVEN);
    double goal = fraction_by_cells(m);
    if (!for_groups(m, verify_group, goal))
        return false;
    m->fraction = goal;
    find_unresolved(m);
    bvh_free(&m->bvh, m->contour.triangles.count, &m->arena);
    count_unresolved(m);
    return mesher_is_wanted(m);
}

/* Has unresolved tetrahedra bisected further; returns false if nothing becomes finer.  A knife edge
   is thinner than tetrahedra at more than the error from its end, unless they are smaller still.
   Where solids touch none are small enough, and many stay unresolved. */
static bool sharpen(Mesher *m)
{
    enum { MAX_FIRST = 300, MAX_LATER = 1000 };
    static const double FIRST = 0.5, LAST = 0.05;
    double              sharp = m->sharp > 0 ? 0.5 * m->sharp : FIRST;
    if (m->unresolved == 0 || m->unresolved > (size_t)(m->sharp > 0 ? MAX_LATER : MAX_FIRST) ||
        sharp < LAST)
        return false;
    m->sharp = sharp;
    for (size_t i = 0; i < m->tets.list.count; i++)
        if (m->tets.list.items[i].state == TET_UNRESOLVED)
            m->tets.list.items[i].state = TET_REFUTED;
    return refine(m, false);
}

/* Removes handles and islands that the mesh has at edges, and the solid has not; returns false if
   there are none. */
static bool tidy(Mesher *m)
{
    enum { MAX_TIMES = 4, MAX_LOCATIONS = 256, FEW_LOCATIONS = 24 };
    static const double AROUND = 3, DEEP = 0.5; /* errors */
    double              locations[MAX_LOCATIONS][3];
    bool                any = false;
    if (m->tidied++ >= MAX_TIMES)
        return false;
    size_t count = handles_find(&m->contour, AROUND * m->error, locations, MAX_LOCATIONS);
    /* Few may become more at first, and are gone in the end; many take long, and stay. */
    if (m->tidied > 1 && count > m->untidy && count > FEW_LOCATIONS)
        return false;
    m->untidy = count;
    for (size_t i = 0; i < count; i++)
        any = sides_tidy(&m->contour, locations[i], AROUND * m->error, DEEP * m->error) || any;
    return any;
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
        if (!refine_by_bounds(m))
            return false;
        contour_find(&m->contour);
        if (m->options->draft)
            return true;
        if (!prove(m))
            return false;
    } while (refine(m, false) || forget_stale(m) || sharpen(m) || tidy(m));
    return true;
}
