/*
 * crowd.h: crowds: parts that are alike but for numbers, as one body and a table of numbers.
 *
 * A table has a row for each part, its member, and a grid, which knows which members are near a point.
 * A column holds numbers that are known now, or nodes of the frame, which are FLOAT: its numbers are
 * then found anew for each frame.
 * A crowd function is a loop over the members that are near.  It keeps states, which begin as
 * constants.  For each member every state becomes what its body says; all change at once.  The result is
 * the last value of the first state, or what `sums` or `joins` make of all.
 *
 * Kernels loop over the list of one cell, of which a distance is at most the clearance.  On the host the
 * loop is over all members that may count, as far as the state `distance` tells (evaluate.h).
 *
 * Bodies are nodes of the graph.  Their leaves are of the crowd (ops.def): OP_CROWD_POINT,
 * OP_CROWD_NORMAL, OP_CROWD_FOOTPRINT, OP_CROWD_THRESHOLD stand for the operands of the call, OP_MEMBER is the number of the
 * member, and OP_STATE that of a state.  OP_row reads a number of the table.  No other leaf of point
 * time may be in a body.  So bodies have no node of point time in common with anything but functions of
 * the same table, and share the values[] of a tape: each run finds all that it needs anew.  A body may
 * call functions with smaller numbers, if they are of other tables.
 *
 * Each graph has a Crowds of its own, whose bodies and frame numbers are nodes of that graph.  A pass
 * that makes a graph of a graph copies them beside its roots (roots_with_bodies); tables and
 * functions are shared.  These know their nodes by an index, so that passes may renumber nodes.
 */
#ifndef KRS_CROWD_H
#define KRS_CROWD_H

#include "compiler/graph/graph.h"
#include "compiler/graph/grid.h"

enum { MOST_CROWD_STATES = 8, MOST_TABLE_COLUMNS = 64, NO_DISTANCE = MOST_CROWD_STATES };
enum { NOT_LISTED = MOST_CROWD_STATES };

/* A column whose numbers are known. */
#define KNOWN_COLUMN UINT32_MAX

/* Where a member is in a frame: a box, moved by nodes of the frame. */
typedef enum PlaceKind {
    PLACE_FIXED,  /* not at all: it is around the member in all frames */
    PLACE_SHIFT,  /* by a shift */
    PLACE_TURNED, /* by a similarity: its scale, three rows and shift (shape.h: Map) */
} PlaceKind;
typedef struct MemberPlace {
    Box       box;
    PlaceKind kind;
} MemberPlace;

/* A member of an outline: the curve start + 2 way t + bend t^2, 0 <= t <= 1, in the plane z = 0.  The inside is
   on its left; it turns only one way, and has no apex between its ends. */
typedef struct CrowdArc {
    double start[2], way[2], bend[2];
} CrowdArc;

/* A table. */
typedef struct Crowd {
    Arena       *arena; /* of its numbers and its grid */
    uint32_t     rows, columns;
    double      *numbers;       /* rows x columns, row by row; 0 in columns of the frame */
    uint32_t    *frame_columns; /* of each column: KNOWN_COLUMN, or where its nodes begin in
                                Crowds.frame_numbers, one for each row; NULL: all are known */
    Grid         grid;          /* its members are the rows */
    Grid         cells;  /* the same, or refined (grid_refine.h): what kernels read; right as far as
                                the clearance is */
    MemberPlace *places; /* NULL: no member is known to move.  Else the grid is one for all
                                 frames, and crowd_frame.h builds those of a frame */
    uint32_t     first_place;   /* where nodes of the places begin in Crowds.frame_numbers */
    double       reach, margin; /* of these grids */
    Box         *boxes;         /* of members of which only the nearest counts; NULL: not known */
    Box         *bounds;        /* of members, in all frames; NULL: not known */
    double       widest;        /* the longest diagonal of `bounds` */
    CrowdArc    *arcs;          /* of members of an outline; NULL: it is none */
    double fades, slope; /* of a blend with tails, its width, and the slope of all distances */
    double stretch;      /* the distance of a member, times this, is at least that to its box */
    /* Functions use nothing of the point of a call but its difference from numbers of the row.  Columns of these
       have 1 + the number of the axis in `axes`, others have 0; along axes without a column the numbers are near 0.
       So point and rows may be relative to another origin.  In camera-relative kernels that is the VEC3 of which
       `origin` is 1 + the place in Crowds.frame_numbers; 0: it is that of the table in all kernels. */
    bool     relocates;
    uint8_t  axes[MOST_TABLE_COLUMNS];
    uint32_t origin;
    Span     span; /* of the join */
} Crowd;

/* How many nodes a place has. */
static inline uint32_t place_nodes(PlaceKind kind)
{
    return kind == PLACE_TURNED ? 5 : kind == PLACE_SHIFT;
}

/* How many texels of krs_cells the header of a table has for kernels. */
enum { GRID_HEADER = 10 };
/* How many texels, of four numbers each, a row has for kernels.  Tails are one more column. */
static inline size_t row_texels(const Crowd *table)
{
    return (table->columns + (table->cells.tails ? 1 : 0) + 3) / 4;
}

typedef struct CrowdState {
    GraphType type;
    double    first[4];
} CrowdState;

typedef struct CrowdFunction {
    uint32_t  crowd;  /* index of the table */
    GraphType type;   /* of the result */
    bool      clear;  /* the result is at most the clearance: it is a distance */
    bool      either; /* the member nearest to 0 decides, the first of several, and the result is at
                          most as far from 0 as the clearance, which has a sign: where no
                          member is in a cell, that of all points in it */
    bool
        joins; /* behind the bodies is an operation on all states, in their order: the result, or, of
                   a VEC4 and with `listed`, what is at most the clearance.  Then the
                   result is state `listed`, which is what it began as where that is not so,
                   but for a first number of state 0: the clearance */
    bool sums; /* the result is the first state less the third times the logarithm of the second */
    bool
        ends; /* and kernels add up the fourth state along lists with tails, as far as that counts */
    CrowdState states[MOST_CROWD_STATES];
    uint32_t   state_count;
    uint32_t   listed;   /* of `joins`; NOT_LISTED: the operation is the result */
    uint32_t   distance; /* the state that is a distance; NO_DISTANCE: there is none */
    double     slope;    /* the result changes no faster than the point, times this; 0: not known */
    uint32_t   first_body; /* the body of state i is Crowds.bodies[first_body + i] */
} CrowdFunction;

/* Functions and tables in the order in which they were made; inner ones come first. */
typedef struct Crowds {
    Arena *arena;
    struct {
        Crowd *items;
        size_t count, capacity;
    } tables;
    struct {
        CrowdFunction *items;
        size_t         count, capacity;
    } functions;
    /* Nodes of the graph that has this Crowds. */
    struct {
        Node  *items;
        size_t count, capacity;
    } bodies, frame_numbers;
} Crowds;

/* Those of a graph, which are made when there are none. */
Crowds *graph_crowds(Graph *graph);
/* Adds a function, whose member first_body is set here, with a body for each of its states, and what joins
   them, if it does.  Returns its number. */
uint32_t graph_add_crowd_function(Graph *graph, CrowdFunction function, const Node *bodies);
/* For a pass that makes a graph: the roots, and behind them the bodies and frame numbers of the
   graph. */
Node *roots_with_bodies(const Graph *graph, const Node *roots, size_t root_count, size_t *count,
                        Arena *arena);
/* When the pass has made `to` of `from`, and all these nodes are of `to`: copies the roots back, and
   gives `to` the crowds of `from` with its own bodies and frame numbers, and its textures. */
void hand_on_crowds(Graph *to, const Graph *from, const Node *all, Node *roots, size_t root_count);
/* Copies tables and functions into an arena as well, when that of the original is to be freed. */
void crowds_keep(Crowds *crowds, Arena *arena);
/* Whether numbers or grids of tables depend on parameters or the time. */
bool crowds_vary(const Crowds *crowds);
/* Whether there is a column for what is taken from the point along this axis. */
bool relocates_along(const Crowd *table, int axis);
/* The nodes of a column, one for each row; NULL: its numbers are known. */
const Node *column_nodes(const Crowds *crowds, const Crowd *table, uint32_t column);

/* ---- Leaves and calls; `crowd` is the index of the table, `function` that of the function ---- */

Node graph_crowd_leaf(Graph *graph, Op op, uint32_t crowd); /* but OP_STATE */
/* State `state` of a function, which is made with these types. */
Node graph_state(Graph *graph, GraphType type, uint32_t function, uint32_t state);
/* A number of the row `member`, a UINT node: FLOAT. */
Node graph_row(Graph *graph, uint32_t crowd, uint32_t column, Node member);
/* Calls.  OP_crowd_distance, FLOAT, OP_crowd_list, VEC4, and OP_crowd_member, UINT, have the point alone;
   OP_crowd_number, FLOAT, and OP_crowd_vector, VEC3, also the normal, the footprint and the threshold. */
Node graph_crowd(Graph *graph, Op op, uint32_t function, Node point);
Node graph_crowd_surface(Graph *graph, Op op, uint32_t function, Node point, Node normal,
                         Node footprint, Node threshold);

/* The table and the column behind the first operand of OP_row. */
static inline uint32_t row_crowd(uint32_t id) { return id / MOST_TABLE_COLUMNS; }
static inline uint32_t row_column(uint32_t id) { return id % MOST_TABLE_COLUMNS; }
/* The function and its state behind the index of OP_STATE. */
static inline uint32_t function_of(uint32_t index) { return index / MOST_CROWD_STATES; }
static inline uint32_t state_of(uint32_t index) { return index % MOST_CROWD_STATES; }
/* How many bodies a function has. */
static inline uint32_t body_count(const CrowdFunction *function)
{
    return function->state_count + function->joins;
}
/* Whether it calls a function. */
static inline bool is_call(Op op) { return op >= OP_crowd_distance && op <= OP_crowd_vector; }
/* Whether it is a leaf that bodies alone have. */
static inline bool is_of_crowd(Op op) { return op >= OP_CROWD_POINT && op <= OP_STATE; }

#endif
