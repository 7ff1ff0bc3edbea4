/*
 * flat.c: halves boxes until each has few planes.
 *
 * Ranges tell where no surface is, and planes where one is.  Circles are polygons, of as many sides
 * as the error needs: a first pass finds how large they are, and flat_near.c whether they are near
 * enough.  In the end each triangle is tested once: the surface must be in its middle, or within
 * the error of it.  Solids that are made of other things are given up after some boxes.
 */
#include "mesh/flat/flat.h"

#include "compiler/base/vec.h"
#include "mesh/common/crossing.h"
#include "mesh/flat/flat_near.h"

enum {
    MAX_BOXES          = 400000,
    MAX_BOXES_OF_DRAFT = 40000,
    MAX_HALVINGS       = 45,
    HALVINGS_OF_REGION = 3,
    ASK_EVERY          = 256
};
/* Boxes after which a part of them must have been flat. */
enum { FIRST_BOXES = 600 };
/* The attempts, at each of which planes are moved otherwise. */
enum { ATTEMPTS = 4 };
static const double MIN_KNOWN = 0.02;
/* Parts of the size: how far the surface may be from a face, the length of the shortest edges that
   stay, and how deep triangles that touch may cross. */
static const double ROUNDING_OF_FACES = 1e-6, MIN_SHORT = 1e-9, TOUCHING = 1e-8;

/* Parts of what is left to be done: to halve boxes, to check all of them, and some. */
static const double HALVING = 0.3, CHECKING_ALL = 0.5, CHECKING_SOME = 0.05;

typedef struct Halving {
    Mesher    *m;
    MeshField *field;
    FlatFaces  faces;
    FlatPieces pieces;
    FlatRounds rounds;
    FlatWork   work;
    FlatBoxes  round_boxes;
    size_t     boxes, known;
    double     halved; /* the part of the space that is done */
    uint32_t   attempt;
} Halving;

static bool halve(Halving *h, Box box, int halvings);

static bool halve_at(Halving *h, Box box, int halvings)
{
    static const double MIDDLE = 0.4873; /* planes of scenes are seldom there */
    int                 axis   = box_longest_axis(&box);
    Range              *along  = &box.axis[axis];
    double              low = along->low, high = along->high, middle = low + MIDDLE * (high - low);
    along->high = middle;
    if (!halve(h, box, halvings + 1))
        return false;
    along->low  = middle;
    along->high = high;
    return halve(h, box, halvings + 1);
}

static bool is_wanted(Mesher *m)
{
    if (!mesher_is_wanted(m))
        atomic_store(&m->stopped, true);
    return !atomic_load(&m->stopped);
}

static void count_box(Halving *h)
{
    if (++h->boxes % ASK_EVERY != 0)
        return;
    mesher_advance(h->m, h->halved);
    is_wanted(h->m);
}

static bool is_given_up(Halving *h, int halvings)
{
    count_box(h);
    return atomic_load(&h->m->stopped) || halvings > MAX_HALVINGS ||
           h->boxes > (h->m->options->draft ? MAX_BOXES_OF_DRAFT : MAX_BOXES) ||
           (h->boxes > FIRST_BOXES && (double)h->known < MIN_KNOWN * (double)h->boxes);
}

/* Tells whether this pass only finds circles; another will find faces. */
static bool is_first_pass(const Halving *h)
{
    return !h->rounds.counted && h->rounds.list.count > 0;
}

/* Finds the planes in a box; returns false if it should be halved: many planes take long, so they
   are cut only in small boxes, as at the tips of cones. */
static bool find_few_pieces(Halving *h, Box box, int halvings)
{
    enum { FEW = 40, SMALL_FROM = 20 };
    return flat_pieces(h->field, box, h->m->side, &h->rounds, FLAT_MAKING, &h->work, &h->pieces) &&
           (h->pieces.count <= FEW || halvings >= SMALL_FROM);
}

static bool halve(Halving *h, Box box, int halvings)
{
    Range  range = field_range(h->field, box);
    double whole = ldexp(1, -halvings), moved = FLAT_MOVED * h->m->side;
    if (range.low > moved || range.high < -moved) {
        h->halved += whole;
        return true;
    }
    bool entered = halvings % HALVINGS_OF_REGION == 0 &&
                   halvings < MAX_REGIONS * HALVINGS_OF_REGION;
    bool done;
    if (entered)
        field_focus(h->field, box);
    if (find_few_pieces(h, box, halvings) &&
        (is_first_pass(h) || flat_faces_add(&h->faces, box, &h->pieces))) {
        h->known++;
        h->halved += whole;
        count_box(h);
        done = true;
        if (h->pieces.round)
            array_push_large(&h->m->arena, &h->round_boxes, box);
    } else
        done = !is_given_up(h, halvings) && halve_at(h, box, halvings);
    if (entered)
        field_leave(h->field);
    return done;
}

/* Tells whether the surface is in the middle of each triangle, so that each face is one of the
   solid. */
static bool is_on_surface(Mesher *m, const FlatVertices *vertices, const Triangles *triangles,
                          double near)
{
    for (size_t i = 0; i < triangles->count; i++) {
        double middle[3] = {0, 0, 0};
        for (int k = 0; k < 3; k++)
            add_scaled3(middle, middle, 1.0 / 3, vertices->items[triangles->items[i][k]]);
        if (!(fabs(field_distance(&m->fields[0], middle)) <= near))
            return false;
    }
    return true;
}

/* Returns the part of the error for moved planes, and for edges that become points. */
static double reserve_of(const Mesher *m)
{
    static const double SHORT = 1e-5, PART = 0.2;
    return min2(SHORT * m->side, PART * m->error);
}

/* Finds the faces in all boxes. */
static bool halve_all(Halving *h)
{
    Mesher *m = h->m;
    Box     box;
    for (int k = 0; k < 3; k++) {
        double middle = 0.5 * (m->low[k] + m->high[k]);
        double half = 0.5 * (m->high[k] - m->low[k]) + m->error + 0.013 * m->side * (1 + 0.17 * k);
        box.axis[k] = (Range){middle - half, middle + half};
    }
    h->faces       = (FlatFaces){.arena = &m->arena, .size = m->side, .attempt = h->attempt};
    h->round_boxes = (FlatBoxes){NULL, 0, 0};
    h->boxes       = 0;
    h->known       = 0;
    h->halved      = 0;
    mesher_begin(m, HALVING);
    flat_rounds_open(&h->rounds, &h->field->ranges);
    bool done = is_wanted(m) && halve(h, box, 0);
    flat_rounds_close(&h->field->ranges);
    mesher_advance(m, 1);
    return done;
}

/* Proves what is in all boxes that are left, as `part` of what is left to be done. */
static FlatVerdict check(Halving *h, double error, double part)
{
    mesher_begin(h->m, part);
    FlatVerdict verdict = flat_near(h->m, &h->rounds, &h->round_boxes, error);
    mesher_advance(h->m, 1);
    return verdict;
}

/* Adds sides until no more than `enough` boxes are left, or else as few as leave the fewest;
   returns false if there were none to add.  Only instances in these boxes get more, or all that are
   kin. */
static bool refine(Halving *h, double error, bool kin, size_t enough, FlatVerdict *verdict)
{
    size_t fewest = h->round_boxes.count;
    bool   any    = false;
    *verdict      = FLAT_REFUTED;
    flat_rounds_save(&h->rounds);
    while (*verdict == FLAT_REFUTED && h->round_boxes.count > enough) {
        if (kin)
            flat_rounds_blame_kin(&h->rounds);
        if (!flat_rounds_refine(&h->rounds))
            break;
        *verdict = check(h, error, CHECKING_SOME);
        if (*verdict != FLAT_STOPPED && h->round_boxes.count < fewest) {
            fewest = h->round_boxes.count;
            flat_rounds_save(&h->rounds);
            any = true;
        }
    }
    flat_rounds_restore(&h->rounds);
    return any;
}

/* Refines by some of the boxes of the first pass, if these are many: they mostly need as many sides
   as all do.  What only some of them need is left to the instances there.  That is all that a draft
   of many boxes needs. */
static FlatVerdict refine_by_some(Halving *h, double error)
{
    enum { SOME = 100, FEW = 40 };
    FlatBoxes  *boxes = &h->round_boxes;
    size_t      step  = boxes->count / SOME;
    FlatVerdict verdict;
    if (step < 2)
        return FLAT_PROVEN;
    for (size_t i = 0; i < SOME; i++)
        boxes->items[i] = boxes->items[i * step];
    boxes->count = SOME;
    verdict      = check(h, error, CHECKING_SOME);
    if (verdict == FLAT_REFUTED)
        refine(h, error, true, FEW, &verdict);
    h->m->drafted = h->m->options->draft;
    return verdict;
}

/* Finds faces with as many sides as the error needs; where even many are not enough, boxes are left
   unresolved. */
static bool make_round(Halving *h)
{
    FlatVerdict refined = FLAT_PROVEN, verdict;
    double      error   = h->m->error - reserve_of(h->m);
    flat_rounds_count(&h->rounds);
    if (refine_by_some(h, error) == FLAT_STOPPED)
        return false;
    if (h->m->drafted) {
        h->m->unresolved = 0;
        return halve_all(h);
    }
    do {
        if (!halve_all(h))
            return false;
        verdict = check(h, error, CHECKING_ALL);
    } while (verdict != FLAT_STOPPED && h->round_boxes.count > 0 && refined == FLAT_PROVEN &&
             refine(h, error, false, 0, &refined));
    return verdict != FLAT_STOPPED && refined != FLAT_STOPPED;
}

static void note_open(void *user, uint32_t triangle)
{
    (void)triangle;
    *(bool *)user = true;
}

/* Tells whether the mesh is closed and does not cross itself; solids may touch.  Edges that become
   points may pull a face through another, unless they only came of moved planes, which are
   shorter. */
static bool is_sound(const Halving *h, const FlatVertices *vertices, const Triangles *triangles)
{
    Mesher *m = h->m;
    if (h->faces.joined < ROUNDING_OF_FACES * m->side)
        return true;
    ArenaMark mark = arena_mark(&m->arena);
    bool      open = false, crosses = false;
    Bvh       bvh;
    const uint32_t(*corners)[3] = (const uint32_t(*)[3])triangles->items;
    TriangleEdges edges         = sort_edges(corners, triangles->count, &m->arena);
    report_open(&edges, note_open, &open);
    bvh_new(&bvh, (const double(*)[3])vertices->items, corners, triangles->count, &m->arena);
    for (uint32_t i = 0; i < triangles->count && !crosses && !open; i++)
        crosses = triangle_crosses(&bvh, i, TOUCHING * m->side);
    arena_rewind(&m->arena, mark);
    return !open && !crosses;
}

/* Makes triangles of the faces, without edges that are shorter than `shortest`. */
static bool finish_once(Halving *h, double shortest, FlatVertices *vertices, Triangles *triangles)
{
    *vertices         = (FlatVertices){NULL, 0, 0};
    *triangles        = (Triangles){NULL, 0, 0};
    h->faces.shortest = shortest;
    h->faces.joined   = 0;
    return flat_faces_finish(&h->faces, vertices, triangles) && is_sound(h, vertices, triangles);
}

/* Makes triangles of the faces; where that fails short edges stay, so that solids that touch stay
   separate, or planes are moved otherwise, which mostly helps. */
static bool finish(Halving *h, FlatVertices *vertices, Triangles *triangles)
{
    while (!finish_once(h, reserve_of(h->m), vertices, triangles) &&
           !finish_once(h, MIN_SHORT * h->m->side, vertices, triangles))
        if (++h->attempt == ATTEMPTS || !halve_all(h))
            return false;
    return true;
}

bool find_flat_mesh(Mesher *m, FlatVertices *vertices, Triangles *triangles)
{
    Halving *h = arena_new(&m->arena, Halving);
    *h         = (Halving){.m = m, .field = &m->fields[0]};
    h->work    = flat_work_new(h->field, &m->arena);
    h->rounds  = flat_rounds_new(m->error, &m->arena);
    if (!halve_all(h) || (is_first_pass(h) && !make_round(h)) || !finish(h, vertices, triangles))
        return false;
    double near = h->rounds.list.count > 0 ? m->error : ROUNDING_OF_FACES * m->side;
    return is_on_surface(m, vertices, triangles, near);
}
