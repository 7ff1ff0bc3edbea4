/* flat_near.c: boxes are halved until there is a proof in each. */
#include "compiler/mesh/flat_near.h"

#include <string.h>

#include "compiler/base/vec.h"

enum {
    MOST_BLAMED        = 4,
    MOST_THIN          = 100,
    MOST_HARD          = 10000,
    MOST_LOOKS         = 600000,
    PATIENCE           = 256,
    HALVINGS_OF_REGION = 3
};
/* In errors: boxes that are not halved any more, and those in which ways may be shorter than the error. */
static const double SMALLEST = 0.1, SMALL = 1.5, SHORT_WAY = 0.6;

/* What one thread finds. */
typedef struct NearPart {
    FlatPieces pieces;
    FlatWork   work;
    size_t     looks, hard, thin, blamed_count;
    double     left_at[3]; /* where one is */
    Box        blamed[MOST_BLAMED];
} NearPart;

typedef struct NearWork {
    Mesher          *m;
    FlatRounds      *rounds;
    const FlatBoxes *boxes;
    double           error;
    NearPart        *parts;
} NearWork;

typedef struct Looking {
    const NearWork *w;
    NearPart       *part;
    MeshField      *field;
    bool            asks; /* whether the mesh is still wanted */
} Looking;

static Box wider_box(Box box, double by)
{
    for (int k = 0; k < 3; k++) {
        box.axis[k].low -= by;
        box.axis[k].high += by;
    }
    return box;
}

static bool goes_on(Looking *l)
{
    Mesher   *m    = l->w->m;
    NearPart *part = l->part;
    if (++part->looks % PATIENCE == 0 && l->asks && m->options->go_on &&
        !m->options->go_on(m->options->user, 0))
        atomic_store(&m->stopped, true);
    return !atomic_load(&m->stopped) && part->looks < MOST_LOOKS && part->hard < MOST_HARD &&
           part->blamed_count < MOST_BLAMED && part->thin < MOST_THIN;
}

static void note_place(NearPart *part, const Box *box)
{
    for (int k = 0; k < 3; k++)
        part->left_at[k] = 0.5 * (box->axis[k].low + box->axis[k].high);
}

static void leave(Looking *l, FlatNearness nearness, Box box, double way)
{
    NearPart *part = l->part;
    note_place(part, &box);
    if (nearness == FLAT_ROUGH)
        part->blamed[part->blamed_count++] = wider_box(box, way);
    else
        part->thin++;
}

static void look(Looking *l, Box box, int halvings);

static void look_at_halves(Looking *l, Box box, int axis, int halvings)
{
    Box    halves[2]          = {box, box};
    double middle             = 0.5 * (box.axis[axis].low + box.axis[axis].high);
    halves[0].axis[axis].high = halves[1].axis[axis].low = middle;
    look(l, halves[0], halvings + 1);
    look(l, halves[1], halvings + 1);
}

static void look(Looking *l, Box box, int halvings)
{
    NearPart *part  = l->part;
    double    error = l->w->error;
    Range     range = field_range(l->field, box);
    if (range.low > 0 || range.high < 0)
        return;
    if (!goes_on(l)) {
        if (part->looks == MOST_LOOKS || part->hard == MOST_HARD)
            note_place(part, &box);
        return;
    }
    int    axis    = box_longest_axis(&box);
    double size    = box.axis[axis].high - box.axis[axis].low;
    double way     = size < SMALL * error ? SHORT_WAY * error : error;
    bool   entered = halvings % HALVINGS_OF_REGION == 0 && l->field->region_count < MOST_REGIONS;
    if (entered)
        field_focus(l->field, wider_box(box, error));
    FlatNearness nearness = FLAT_UNKNOWN;
    if (flat_pieces(l->field, wider_box(box, way), l->w->m->side, l->w->rounds, FLAT_PROVING,
                    &part->work, &part->pieces)) {
        nearness = flat_nearness(&part->pieces, &box, way);
        axis     = flat_widest_axis(&part->pieces, &box);
    }
    part->hard += nearness == FLAT_HARD;
    if (nearness > FLAT_HARD && size > SMALLEST * error)
        look_at_halves(l, box, axis, halvings);
    else if (nearness > FLAT_HARD)
        leave(l, nearness, box, way);
    if (entered)
        field_leave(l->field);
}

static void look_at_part(void *task, size_t part, size_t parts)
{
    const NearWork *w = task;
    Looking         l = {w, &w->parts[part], &w->m->fields[part], part == 0};
    for (size_t i = part; i < w->boxes->count; i += parts)
        look(&l, w->boxes->items[i], 0);
}

/* In boxes in which the sides are too far. */
static void blame(const NearWork *w, NearPart *part)
{
    MeshField *field = &w->m->fields[0];
    w->rounds->blame = true;
    for (size_t i = 0; i < part->blamed_count; i++) {
        field_focus(field, part->blamed[i]);
        flat_pieces(field, part->blamed[i], w->m->side, w->rounds, FLAT_PROVING, &part->work,
                    &part->pieces);
        field_leave(field);
    }
    w->rounds->blame = false;
}

/* More sides are of no use where much is thin anyway. */
static FlatVerdict judge(const NearWork *w, size_t parts)
{
    FlatVerdict verdict = FLAT_PROVEN;
    Mesher     *m       = w->m;
    bool        in_vain = false;
    m->unresolved       = 0;
    for (size_t i = 0; i < parts; i++) {
        NearPart *part = &w->parts[i];
        size_t    left = part->thin + part->blamed_count +
                      (part->looks >= MOST_LOOKS || part->hard >= MOST_HARD);
        in_vain |= part->thin >= MOST_THIN;
        m->unresolved += left;
        if (left > 0)
            memcpy(m->unresolved_at, part->left_at, sizeof m->unresolved_at);
        blame(w, part);
        if (part->blamed_count > 0 && verdict == FLAT_PROVEN)
            verdict = FLAT_REFUTED;
    }
    if (in_vain)
        verdict = FLAT_PROVEN;
    return atomic_load(&m->stopped) ? FLAT_STOPPED : verdict;
}

FlatVerdict flat_near(Mesher *m, FlatRounds *rounds, const FlatBoxes *boxes, double error)
{
    size_t    parts = parallel_parts();
    ArenaMark mark  = arena_mark(&m->arena);
    NearWork  w     = {m, rounds, boxes, error, arena_new_array(&m->arena, NearPart, parts)};
    memset(w.parts, 0, parts * sizeof *w.parts);
    for (size_t i = 0; i < parts; i++) {
        w.parts[i].work = flat_work_new(&m->fields[i], &m->arena);
        flat_rounds_open(rounds, &m->fields[i].ranges);
    }
    run_in_parallel(look_at_part, &w);
    FlatVerdict verdict = judge(&w, parts);
    for (size_t i = 0; i < parts; i++)
        flat_rounds_close(&m->fields[i].ranges);
    arena_rewind(&m->arena, mark);
    return verdict;
}
