/*
 * instance_table.h: instance groups: parts that are alike but for numbers, as one body and a table of numbers.
 *
 * A table has a row for each part, its instance, and a grid, which knows which instances are near a point.
 * A column holds numbers that are known now, or nodes of the frame, which are FLOAT: its numbers are
 * then found anew for each frame.
 * An instance function is a loop over the instances that are near.  It keeps states, which begin as
 * constants.  For each instance every state becomes what its body says; all change at once.  The result is
 * the last value of the first state, or what `sums` or `joins` make of all.
 *
 * Shaders loop over the list of one cell, of which a distance is at most the clearance.  On the host the
 * loop is over all instances that may count, as far as the state `distance` tells (evaluate.h).
 *
 * Bodies are nodes of the graph.  Their leaves are of the instance group (ops.def): OP_INSTANCE_POINT,
 * OP_INSTANCE_NORMAL, OP_INSTANCE_FOOTPRINT, OP_INSTANCE_THRESHOLD stand for the operands of the call, OP_INSTANCE_ROW is the number of the
 * instance, and OP_STATE that of a state.  OP_row reads a number of the table.  No other leaf of point
 * time may be in a body.  So bodies have no node of point time in common with anything but functions of
 * the same table, and share the values[] of a tape: each run finds all that it needs anew.  A body may
 * call functions with smaller numbers, if they are of other tables.
 *
 * Each graph has Instances of its own, whose bodies and frame numbers are nodes of that graph.  A pass
 * that makes a graph of a graph copies them beside its roots (roots_with_bodies); tables and
 * functions are shared.  These know their nodes by an index, so that passes may renumber nodes.
 */
#ifndef KRS_INSTANCE_TABLE_H
#define KRS_INSTANCE_TABLE_H

#include "compiler/graph/graph.h"
#include "compiler/graph/grid.h"

enum { MAX_INSTANCE_STATES = 8, MAX_TABLE_COLUMNS = 64, NO_DISTANCE = MAX_INSTANCE_STATES };
enum { NOT_LISTED = MAX_INSTANCE_STATES };

/* A column whose numbers are known. */
#define KNOWN_COLUMN UINT32_MAX

/* The place of an instance in a frame: a box, moved by nodes of the frame. */
typedef enum PlaceKind {
    PLACE_FIXED,   /* not at all: it is around the instance in all frames */
    PLACE_SHIFT,   /* by a shift */
    PLACE_ROTATED, /* by a similarity: its scale, three rows and shift (shape.h: Map) */
} PlaceKind;
typedef struct InstancePlace {
    Box       box;
    PlaceKind kind;
} InstancePlace;

/* An instance of an outline: the curve start + 2 tangent t + bend t^2, 0 <= t <= 1, in the plane z
   = 0.  The inside is on its left; it turns only one way, and has no apex between its ends. */
typedef struct InstanceArc {
    double start[2], tangent[2], bend[2];
} InstanceArc;

/* A table. */
typedef struct InstanceTable {
    Arena    *arena; /* of its numbers and its grid */
    uint32_t  rows, columns;
    double   *numbers;       /* rows x columns, row by row; 0 in columns of the frame */
    uint32_t *frame_columns; /* of each column: KNOWN_COLUMN, or where its nodes begin in
                                Instances.frame_numbers, one for each row; NULL: all are known */
    Grid      grid;          /* its instances are the rows */
    Grid      cells; /* the same, or refined (grid_refine.h): what shaders read; right as far as
                                the clearance is */
    InstancePlace *places;      /* NULL: no instance is known to move.  Else the grid is one for all
                                 frames, and instance_frame.h builds those of a frame */
    uint32_t       first_place; /* where nodes of the places begin in Instances.frame_numbers */
    double         reach, margin; /* of these grids */
    Box           *boxes;  /* of instances of which only the nearest counts; NULL: not known */
    Box           *bounds; /* of instances, in all frames; NULL: not known */
    double         widest; /* the longest diagonal of `bounds` */
    InstanceArc   *arcs;   /* of instances of an outline; NULL: it is none */
    double fades, slope;   /* of a blend with tails, its width, and the slope of all distances */
    double stretch; /* the distance of an instance, times this, is at least that to its box */
    /* Functions use nothing of the point of a call but its difference from numbers of the row.  Columns of these
       have 1 + the number of the axis in `axes`, others have 0; along axes without a column the numbers are near 0.
       So point and rows may be relative to another origin.  In camera-relative shaders that is the VEC3 of which
       `origin` is 1 + the place in Instances.frame_numbers; 0: it is that of the table in all shaders. */
    bool     relocates;
    uint8_t  axes[MAX_TABLE_COLUMNS];
    uint32_t origin;
    Span     span; /* of the join */
} InstanceTable;

/* Tells how many nodes a place has. */
static inline uint32_t place_nodes(PlaceKind kind)
{
    return kind == PLACE_ROTATED ? 5 : kind == PLACE_SHIFT;
}

/* The texels of krs_cells in the header of a table for shaders. */
enum { GRID_HEADER = 10 };
/* Tells how many texels, of four numbers each, a row has for shaders.  Tails are one more column. */
static inline size_t row_texels(const InstanceTable *table)
{
    return (table->columns + (table->cells.tails ? 1 : 0) + 3) / 4;
}

typedef struct InstanceState {
    GraphType type;
    double    first[4];
} InstanceState;

typedef struct InstanceFunction {
    uint32_t  table_number; /* index of the table */
    GraphType type;         /* of the result */
    bool      clear;        /* the result is at most the clearance: it is a distance */
    /* The instance nearest to 0 decides, the first of several.  The result is at most as far from 0
       as the clearance, which has a sign: where no instance is in a cell, that of all its points. */
    bool either;
    /* Behind the bodies is an operation on all states, in their order: the result, or, of a VEC4 and
       with `listed`, what is at most the clearance.  Then the result is state `listed`, which is
       what it began as where that is not so, but for a first number of state 0: the clearance. */
    bool joins;
    /* The result is the first state less the third times the logarithm of the second. */
    bool sums;
    /* Of `sums`: shaders add up the fourth state along lists with tails, as far as that counts. */
    bool          ends;
    InstanceState states[MAX_INSTANCE_STATES];
    uint32_t      state_count;
    uint32_t      listed;   /* of `joins`; NOT_LISTED: the operation is the result */
    uint32_t      distance; /* the state that is a distance; NO_DISTANCE: there is none */
    double        slope; /* the result changes no faster than the point, times this; 0: not known */
    uint32_t      first_body; /* the body of state i is Instances.bodies[first_body + i] */
} InstanceFunction;

/* Functions and tables in the order in which they were made; inner ones come first. */
typedef struct Instances {
    Arena *arena;
    struct {
        InstanceTable *items;
        size_t         count, capacity;
    } tables;
    struct {
        InstanceFunction *items;
        size_t            count, capacity;
    } functions;
    /* Nodes of the graph that has these Instances. */
    struct {
        Node  *items;
        size_t count, capacity;
    } bodies, frame_numbers;
} Instances;

/* Returns the instances of a graph, which are made when there are none. */
Instances *graph_instances(Graph *graph);
/* Adds a function, whose member first_body is set here, with a body for each of its states, and what joins
   them, if it does.  Returns its number. */
uint32_t graph_add_instance_function(Graph *graph, InstanceFunction function, const Node *bodies);
/* Lists, for a pass that makes a graph, the roots, and behind them the bodies and frame numbers of
   the graph. */
Node *roots_with_bodies(const Graph *graph, const Node *roots, size_t root_count, size_t *count,
                        Arena *arena);
/* Ends a pass that has made `to` of `from`, where all these nodes are of `to`: copies the roots
   back, and gives `to` the instance groups of `from` with its own bodies and frame numbers, and its
   textures. */
void hand_on_instances(Graph *to, const Graph *from, const Node *all, Node *roots,
                       size_t root_count);
/* Copies tables and functions into an arena as well, when that of the original is to be freed. */
void instances_keep(Instances *instances, Arena *arena);
/* Tells whether numbers or grids of tables depend on parameters or the time. */
bool instances_vary(const Instances *instances);
/* Tells whether there is a column for what is taken from the point along this axis. */
bool relocates_along(const InstanceTable *table, int axis);
/* Returns the nodes of a column, one for each row; NULL: its numbers are known. */
const Node *column_nodes(const Instances *instances, const InstanceTable *table, uint32_t column);

/* Returns the nodes of the frame that OP_row may read, *count of them. */
const Node *row_nodes(const Graph *graph, const Expr *row, uint32_t *count);

/* ---- Leaves and calls; `table_number` is the index of the table, `function` that of the function ---- */

Node graph_instance_leaf(Graph *graph, Op op, uint32_t table_number); /* but OP_STATE */
/* Returns state `state` of a function, which is made with these types. */
Node graph_state(Graph *graph, GraphType type, uint32_t function, uint32_t state);
/* Returns a number of the row `row`, a UINT node: FLOAT. */
Node graph_row(Graph *graph, uint32_t table_number, uint32_t column, Node instance);
/* Calls.  OP_instance_distance, FLOAT, OP_instance_list, VEC4, and OP_instance_index, UINT, have the point alone;
   OP_instance_number, FLOAT, and OP_instance_vector, VEC3, also the normal, the footprint and the threshold. */
Node graph_instance_call(Graph *graph, Op op, uint32_t function, Node point);
Node graph_instance_surface(Graph *graph, Op op, uint32_t function, Node point, Node normal,
                            Node footprint, Node threshold);

/* Returns the table and the column behind the first operand of OP_row. */
static inline uint32_t row_table(uint32_t id) { return id / MAX_TABLE_COLUMNS; }
static inline uint32_t row_column(uint32_t id) { return id % MAX_TABLE_COLUMNS; }
/* Returns the function and its state behind the index of OP_STATE. */
static inline uint32_t function_of(uint32_t index) { return index / MAX_INSTANCE_STATES; }
static inline uint32_t state_of(uint32_t index) { return index % MAX_INSTANCE_STATES; }
/* Returns the number of the function that a call names. */
static inline uint32_t called_function(const Graph *graph, const Expr *call)
{
    return (uint32_t)graph->items[call->operands[0]].number[0];
}
/* Tells how many bodies a function has. */
static inline uint32_t body_count(const InstanceFunction *function)
{
    return function->state_count + function->joins;
}
/* Tells whether it calls a function. */
static inline bool is_call(Op op) { return op >= OP_instance_distance && op <= OP_instance_vector; }
/* Tells whether it is a leaf that bodies alone have. */
static inline bool is_of_instances(Op op) { return op >= OP_INSTANCE_POINT && op <= OP_STATE; }

#endif
