/* flat_near.c: halves boxes until there is a proof in each. */
#include "mesh/flat/flat_near.h"

#include <string.h>

#include "compiler/base/vec.h"

enum {
    MAX_THIN                  = 100,
    MANY                      = 8,
    MAX_SEAMS                 = 50,
    MAX_HARD                  = 10000,
    MAX_CHECKS                = 600000,
    MAX_CHECKS_WHERE_UNPROVEN = 100, /* for each box; all will be checked again */
    ASK_EVERY                 = 256,
    HALVINGS_OF_REGION        = 3
};
/* Lengths in errors: sides of boxes that are not halved any more, first and after some have been
   left; and of those in which shifts are shorter than the error, and how long these are. */
static const double SMALLEST = 0.02, SMALLEST_OF_MANY = 0.1, SMALL = 1.5, SHORT_SHIFT = 0.6;

/* The findings of one thread. */
typedef struct NearPart {
    FlatPieces pieces;
    FlatWork   work;
    size_t     checks, hard, thin, seams, unproven;
    double     left_at[3]; /* the middle of one that is left */
} NearPart;

typedef struct NearWork {
    Mesher          *m;
    FlatRounds      *rounds;
    const FlatBoxes *boxes;
    bool            *is_unproven; /* of each box, whether planes are too coarse somewhere in it */
    Box             *unproven;    /* and where that is */
    double           error;
    NearPart        *parts;
} NearWork;

typedef struct Checking {
    const NearWork *w;
    NearPart       *part;
    MeshField      *field;
    size_t          number; /* of the box */
    bool            asks;   /* reports progress */
} Checking;

static Box wider_box(Box box, double by)
{
    for (int k = 0; k < 3; k++) {
        box.axis[k].low -= by;
        box.axis[k].high += by;
    }
    return box;
}

static void ask(Checking *l)
{
    Mesher *m = l->w->m;
    mesher_advance(m, (double)l->number / (double)l->w->boxes->count);
    if (!mesher_is_wanted(m))
        atomic_store(&m->stopped, true);
}

static bool may_check_more(Checking *l)
{
    Mesher   *m    = l->w->m;
    NearPart *part = l->part;
    if (++part->checks % ASK_EVERY == 0 && l->asks)
        ask(l);
    return !atomic_load(&m->stopped) && part->checks < MAX_CHECKS &&
           (part->unproven == 0 || part->checks < MAX_CHECKS_WHERE_UNPROVEN * l->w->boxes->count) &&
           part->hard < MAX_HARD && part->thin < MAX_THIN && part->seams < MAX_SEAMS;
}

static void note_location(NearPart *part, const Box *box)
{
    for (int k = 0; k < 3; k++)
        part->left_at[k] = 0.5 * (box->axis[k].low + box->axis[k].high);
}

static void leave(Checking *l, FlatNearness nearness, Box box, double shift)
{
    NearPart *part = l->part;
    note_location(part, &box);
    if (nearness == FLAT_UNPROVEN) {
        l->w->is_unproven[l->number] = true;
        l->w->unproven[l->number]    = wider_box(box, shift);
        part->unproven++;
    } else
        part->thin++;
    part->seams += nearness == FLAT_SEAM && !flat_rounds_has_curves(l->w->rounds);
}

static double smallest_of(const NearPart *part)
{
    return part->thin + part->unproven < MANY ? SMALLEST : SMALLEST_OF_MANY;
}

/* What shifts of one length tell of a box. */
typedef struct Shifted {
    FlatNearness nearness;
    int          axis;  /* along which it is halved */
    double       slack; /* the largest */
} Shifted;

static Shifted check_shift(Checking *l, const Box *box, double shift)
{
    NearPart *part = l->part;
    if (!flat_pieces(l->field, wider_box(*box, shift), l->w->m->side, l->w->rounds, FLAT_PROVING,
                     &part->work, &part->pieces))
        return (Shifted){FLAT_UNKNOWN, box_longest_axis(box), INFINITY};
    return (Shifted){flat_nearness(&part->pieces, box, shift), flat_widest_axis(&part->pieces, box),
                     flat_largest_slack(&part->pieces)};
}

static void check_box(Checking *l, Box box, int halvings, double slack);

static void check_halves(Checking *l, Box box, const Shifted *shifted, int halvings)
{
    int    axis               = shifted->axis;
    Box    halves[2]          = {box, box};
    double middle             = 0.5 * (box.axis[axis].low + box.axis[axis].high);
    halves[0].axis[axis].high = halves[1].axis[axis].low = middle;
    check_box(l, halves[0], halvings + 1, shifted->slack);
    check_box(l, halves[1], halvings + 1, shifted->slack);
}

/* Proves what is in a box, or halves it; `slack` is the largest in the box of which it is a half.
   A shift of little more than that is tried first: fewer planes are so near to the box. */
static void check_box(Checking *l, Box box, int halvings, double slack)
{
    static const double BRIEF = 1.5, MUCH_LESS = 0.7;
    NearPart           *part  = l->part;
    double              error = l->w->error;
    if (l->w->is_unproven[l->number])
        return;
    Range range = field_range(l->field, box);
    if (range.low > 0 || range.high < 0)
        return;
    if (!may_check_more(l)) {
        if (part->checks == MAX_CHECKS || part->hard == MAX_HARD)
            note_location(part, &box);
        return;
    }
    int    longest = box_longest_axis(&box);
    double size    = box.axis[longest].high - box.axis[longest].low;
    double shift   = size < SMALL * error ? SHORT_SHIFT * error : error;
    bool   entered = halvings % HALVINGS_OF_REGION == 0 && l->field->region_count < MAX_REGIONS;
    if (entered)
        field_focus(l->field, wider_box(box, error));
    Shifted shifted = {FLAT_UNKNOWN, longest, slack};
    if (BRIEF * slack < MUCH_LESS * shift)
        shifted = check_shift(l, &box, BRIEF * slack);
    if (shifted.nearness > FLAT_HARD)
        shifted = check_shift(l, &box, shift);
    shifted.slack = min2(shifted.slack, slack);
    part->hard += shifted.nearness == FLAT_HARD;
    if (shifted.nearness > FLAT_HARD && size > smallest_of(part) * error)
        check_halves(l, box, &shifted, halvings);
    else if (shifted.nearness > FLAT_HARD)
        leave(l, shifted.nearness, box, shift);
    if (entered)
        field_leave(l->field);
}

static void check_part(void *task, size_t part, size_t parts)
{
    const NearWork *w = task;
    Checking        l = {w, &w->parts[part], &w->m->fields[part], 0, part == 0};
    for (l.number = part; l.number < w->boxes->count; l.number += parts)
        check_box(&l, w->boxes->items[l.number], 0, INFINITY);
}

/* Blames the rounds that are too coarse in unproven boxes, and drops the other boxes. */
static void blame(const NearWork *w, FlatBoxes *boxes)
{
    MeshField *field = &w->m->fields[0];
    NearPart  *part  = &w->parts[0];
    size_t     kept  = 0;
    w->rounds->blame = true;
    for (size_t i = 0; i < boxes->count; i++) {
        if (!w->is_unproven[i])
            continue;
        field_focus(field, w->unproven[i]);
        flat_pieces(field, w->unproven[i], w->m->side, w->rounds, FLAT_PROVING, &part->work,
                    &part->pieces);
        field_leave(field);
        boxes->items[kept++] = boxes->items[i];
    }
    boxes->count     = kept;
    w->rounds->blame = false;
}

/* Judges by what the threads found.  More sides are of no use where much is thin anyway.  Solids
   with seams of surfaces that are not exact, as hulls of balls, are better meshed by tetrahedra,
   but for those with curves. */
static FlatVerdict judge(const NearWork *w, size_t parts)
{
    FlatVerdict verdict = FLAT_PROVEN;
    Mesher     *m       = w->m;
    bool        in_vain = false, by_seams = false;
    m->unresolved = 0;
    for (size_t i = 0; i < parts; i++) {
        const NearPart *part      = &w->parts[i];
        bool            cut_short = part->checks >= MAX_CHECKS || part->hard >= MAX_HARD;
        size_t          left      = part->thin + part->unproven + cut_short;
        in_vain |= part->thin >= MAX_THIN;
        by_seams |= part->seams >= MAX_SEAMS;
        m->unresolved += left;
        if (left > 0)
            memcpy(m->unresolved_at, part->left_at, sizeof m->unresolved_at);
        if (part->unproven > 0)
            verdict = FLAT_REFUTED;
    }
    if (in_vain)
        verdict = FLAT_IN_VAIN;
    return by_seams || atomic_load(&m->stopped) ? FLAT_STOPPED : verdict;
}

FlatVerdict flat_near(Mesher *m, FlatRounds *rounds, FlatBoxes *boxes, double error)
{
    size_t    parts = parallel_parts();
    ArenaMark mark  = arena_mark(&m->arena);
    NearWork  w     = {.m           = m,
                       .rounds      = rounds,
                       .boxes       = boxes,
                       .unproven    = arena_new_array(&m->arena, Box, boxes->count + 1),
                       .is_unproven = arena_new_array(&m->arena, bool, boxes->count + 1),
                       .error       = error,
                       .parts       = arena_new_array(&m->arena, NearPart, parts)};
    memset(w.parts, 0, parts * sizeof *w.parts);
    for (size_t i = 0; i < parts; i++) {
        w.parts[i].work = flat_work_new(&m->fields[i], &m->arena);
        flat_rounds_open(rounds, &m->fields[i].ranges);
    }
    run_in_parallel(check_part, &w);
    FlatVerdict verdict = judge(&w, parts);
    blame(&w, boxes);
    for (size_t i = 0; i < parts; i++)
        flat_rounds_close(&m->fields[i].ranges);
    arena_rewind(&m->arena, mark);
    return verdict;
}
