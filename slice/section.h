/*
 * section.h: the steps that make one section.
 *
 * - A quadtree is refined where the outline may be, down to cells in which a derivative is proven to keep its sign, and
 *   the other one as well, or what matters of it at two edges; or to cells of the error (tree.c).  In the former, signs at
 *   corners tell all of the topology.  In others what is thinner is looked for along gradients, and cells are refined
 *   there, or counted.
 * - Each edge of cells whose ends differ in sign has a crossing, an exact root.  Cells join their crossings by chords:
 *   next to each other along the cell's border, so that chords do not cross (chords.c).
 * - Chords are bent to the outline by exact roots across them; corners are where tangents of both ends meet (bend.c).
 * - Contours are followed from crossing to crossing, and lose the points that the error permits to leave out, or become
 *   lines and arcs (contours.c, fit.c).
 */
#ifndef KRS_SLICE_SECTION_H
#define KRS_SLICE_SECTION_H

#include <stdatomic.h>

#include "slice/plane.h"

/* Corners of cells have whole coordinates; the root is a square of the side WHOLE_SIDE. */
enum { DEEPEST = 28, WHOLE_SIDE = 1 << DEEPEST };

typedef struct Cell {
    uint32_t at[2]; /* its lowest corner */
    uint32_t side;
} Cell;

/* A corner of cells. */
typedef struct Corner {
    uint32_t at[2];
    uint32_t next; /* of its slot, + 1 */
    double   distance;
} Corner;

/* The crossing of the outline with an edge from a corner on along an axis. */
typedef struct Crossing {
    uint32_t at[2], side, next;
    uint8_t  axis;
    bool     inside_first; /* the corner at which the edge begins is inside */
    bool     corner;       /* of the outline */
    double   point[2];
    uint32_t chord; /* number + 1 of the chord that begins here */
} Crossing;

/* A chord from a crossing to the next, with bends in between. */
typedef struct Chord {
    uint32_t from, to, first, count;
    bool     bent;
} Chord;

typedef struct OutlinePoint {
    double at[2];
    bool   corner;
} OutlinePoint;

typedef struct Section {
    Memory     memory;
    Arena      arena;
    MeshField *field;
    SlicePlane plane;
    double     low[2], side; /* of the root */
    double     error, enough, skin;
    uint32_t finest, thinnest; /* side of the smallest cells, and of those around what is thinner */
    bool     arcs, lines;
    KrsProgressCallback *progress; /* NULL: another thread reports */
    double               fraction; /* of the sections, before this one */
    void                *user;
    atomic_bool         *stopped;
    size_t               visited;    /* cells */
    bool                 split_thin; /* cells were split for something thinner */
    size_t               lost;       /* cells with something that is thinner than the smallest */
    double               lost_at[2];

    struct {
        Corner *items;
        size_t  count, capacity;
    } corners;
    struct {
        Cell  *items;
        size_t count, capacity;
    } leaves;
    struct {
        Crossing *items;
        size_t    count, capacity;
    } crossings;
    struct {
        Chord *items;
        size_t count, capacity;
    } chords;
    struct {
        OutlinePoint *items;
        size_t        count, capacity;
    } bends;
    struct {
        uint32_t *items;
        size_t    count, capacity;
    } around,  /* crossings of the cell at hand */
        loose; /* chords that were bent before the next one */
    struct SlotTable {
        uint32_t *items;
        size_t    count;
    } corner_slots, crossing_slots;
} Section;

static inline double coordinate_of(const Section *s, int axis, uint32_t whole)
{
    return s->low[axis] + s->side * ((double)whole / WHOLE_SIDE);
}

static inline bool is_inside(double distance) { return distance <= 0; }

/* Makes the root cell around a box of the scene. */
void section_root(Section *s, const double low[3], const double high[3]);

/* Finds the leaves of the tree (tree.c); returns false if stopped. */
bool          find_leaves(Section *s);
const Corner *find_corner(const Section *s, const uint32_t at[2]);
uint64_t      hash_point(const uint32_t at[2], uint32_t more);
/* Prunes the field to a square, which field_leave ends; returns false, and does not, if it would
   gain little. */
bool enter_square(Section *s, const double low[2], const double high[2]);
/* Calls `work` for groups of few items that are next to each other, with the field pruned to their
   boxes. */
typedef void BoxOfItem(const Section *s, size_t item, double low[2], double high[2]);
typedef void WorkOnItems(Section *s, size_t first, size_t count);
void         in_groups(Section *s, size_t count, BoxOfItem *box, WorkOnItems *work);

/* Finds the crossings of all leaves, and joins them by chords (chords.c). */
void find_chords(Section *s);
/* Bends all chords to the outline (bend.c). */
void bend_chords(Section *s);

/* Makes the section (contours.c), which exists also if memory ends before it is complete; returns
   false if memory is exhausted. */
bool section_contours(Section *s, KrsSection **section);
/* Drops points, within a distance (fit.c); returns how many stay. */
size_t leave_out_points(OutlinePoint *points, size_t count, double error, Arena *scratch);
/* Makes lines and arcs of points, within a distance; returns how many there are. */
size_t fit_arcs(OutlinePoint *points, double *bulges, size_t count, double error, Arena *scratch);

#endif
