/*
 * mesh_proofs.c: what proofs of meshes say of one tetrahedron, against points of it that are tried.
 *
 * Scenes are random; their surfaces have closed forms.  Space around them is cut into tetrahedra of random
 * sizes.  No point that the mesh has on the wrong side may be farther from the surface than the bound says.  Bounds
 * that are far too large would hold as well, so the nearest to the truth of all must be near.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/base/parallel.h"
#include "compiler/base/vec.h"
#include "mesh/proof/pieces.h"
#include "tests/unit/closed_forms.h"

static Random chance = {2026};

static double uniform(double low, double high) { return random_between(&chance, low, high); }

/* ---- a mesh as it is between two rounds ---- */

typedef struct Trial {
    const Subject *subject;
    KrsScene      *scene;
    KrsState      *state;
    Memory         memory;
    Arena          arena;
    Node          *roots;
    MeshSolid      solid;
    MeshField      fields[MAX_PARTS];
    Tets           tets;
    Contour        contour;
    double         error;
    double         length, focus[3]; /* around it edges are about so long */
} Trial;

/* Bisects what is near to a point, to sizes that differ. */
static void bisect_around(Tets *tets, const double point[3], double length)
{
    for (bool any = true; any;) {
        size_t count = tets->list.count;
        any          = false;
        for (size_t i = 0; i < count; i++) {
            double corners[4][3], longest = tets_longest_edge(tets, &tets->list.items[i]);
            tets_corners(tets, &tets->list.items[i], corners);
            if (longest < length * uniform(1, 2) ||
                distance3(corners[0], point) > 1.5 * longest + 2 * length)
                continue;
            tets_bisect(tets, i);
            any = true;
        }
        tets_close(tets);
    }
}

/* Moves all so that the surface is a little beyond the middle of an edge near the focus: where both ends are on one
   side of it, only bounds tell. */
static void poke_edge(Trial *t)
{
    double     corners[4][3], middle[3], gradient[3];
    const Tet *tet = &t->tets.list.items[0];
    for (size_t i = 1; i < t->tets.list.count; i++) {
        tets_corners(&t->tets, &t->tets.list.items[i], corners);
        if (distance3(corners[0], t->focus) < t->length && random_below(&chance, 4) == 0)
            tet = &t->tets.list.items[i];
    }
    tets_corners(&t->tets, tet, corners);
    int from = random_below(&chance, 4), to = (from + 1 + random_below(&chance, 3)) % 4;
    for (int k = 0; k < 3; k++)
        middle[k] = 0.5 * (corners[from][k] + corners[to][k]);
    subject_gradient(t->subject, middle, gradient);
    double square = pow(distance3(corners[from], corners[to]), 2);
    double value  = subject_value(t->subject, middle) + square * uniform(-0.1, 0.1);
    add_scaled3(t->tets.origin, t->tets.origin, -value, gradient);
    add_scaled3(t->focus, middle, -value, gradient);
}

static void open_trial(Trial *t, const Subject *subject, const double focus[3], bool poked)
{
    /* Bounds come near to the truth in small tetrahedra; where the surface is beyond an edge large ones are wanted. */
    double length   = poked ? uniform(0.1, 0.4) : exp(uniform(log(0.004), log(0.1))), origin[3];
    *t              = (Trial){.subject = subject};
    t->state        = state_of_subject(subject, &t->scene);
    t->arena.memory = &t->memory;
    t->roots        = malloc(solid_root_bytes(t->scene));
    t->solid.roots  = t->roots;
    t->length       = length;
    t->error        = length * length * uniform(0.1, 1);
    solid_of_components(t->scene, NULL, &t->solid);
    for (size_t i = 0; i < parallel_parts(); i++) {
        t->fields[i] = (MeshField){.solid = &t->solid};
        assert_int_equal(state_copy_of(t->state, &t->fields[i].state), KRS_OK);
        state_refresh(t->fields[i].state);
        field_open(&t->fields[i], &t->arena);
    }
    for (int k = 0; k < 3; k++)
        origin[k] = uniform(-2.1, -2);
    tets_new(&t->tets, origin, 4.2, &t->arena);
    /* What a contour of a larger error leaves straight is farther from the surface: bounds come nearer to the truth. */
    const double blunt = random_below(&chance, 2) ? 20 : 1;
    t->contour         = (Contour){.arena            = &t->arena,
                                   .tets             = &t->tets,
                                   .fields           = t->fields,
                                   .error            = t->error * blunt,
                                   .crossing_numbers = {.arena = &t->arena},
                                   .line_numbers     = {.arena = &t->arena}};
    memcpy(t->focus, focus, sizeof t->focus);
    bisect_around(&t->tets, t->focus, length);
    if (poked)
        poke_edge(t);
    contour_distances(&t->contour);
    contour_find_patches(&t->contour);
    contour_find(&t->contour);
}

static void close_trial(Trial *t)
{
    for (size_t i = 0; i < parallel_parts(); i++)
        state_free(t->fields[i].state);
    arena_free(&t->arena);
    free(t->roots);
    krs_state_free(t->state);
    krs_scene_free(t->scene);
}

/* ---- what is true of a tetrahedron ---- */

static void random_weights(double weights[4])
{
    double sum = 0;
    for (int i = 0; i < 4; i++)
        sum += weights[i] = -log(uniform(1e-9, 1));
    for (int i = 0; i < 4; i++)
        weights[i] /= sum;
}

static void mean_of(const double (*corners)[3], const double *weights, int count, double p[3])
{
    p[0] = p[1] = p[2] = 0;
    for (int i = 0; i < count; i++)
        for (int k = 0; k < 3; k++)
            p[k] += weights[i] * corners[i][k];
}

static double volume(const double a[3], const double b[3], const double c[3], const double d[3])
{
    double u[3], v[3], w[3];
    for (int k = 0; k < 3; k++) {
        u[k] = b[k] - a[k];
        v[k] = c[k] - a[k];
        w[k] = d[k] - a[k];
    }
    return u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) +
           u[2] * (v[0] * w[1] - v[1] * w[0]);
}

/* Tells whether the segment between two points goes through a triangle. */
static bool goes_through(const double p[3], const double q[3], const double c[3][3])
{
    bool left = volume(p, q, c[0], c[1]) > 0;
    return (volume(p, c[0], c[1], c[2]) > 0) != (volume(q, c[0], c[1], c[2]) > 0) &&
           (volume(p, q, c[1], c[2]) > 0) == left && (volume(p, q, c[2], c[0]) > 0) == left;
}

static void corners_of_triangle(const Contour *contour, size_t number, double corners[3][3])
{
    for (int i = 0; i < 3; i++)
        memcpy(corners[i], contour->vertices.items[contour->triangles.items[number][i]],
               sizeof corners[i]);
}

/* Inside of the mesh is what as many of its triangles part from a corner as it takes. */
static bool mesh_has(const Trial *t, const Tet *tet, const double corner[3], const double p[3])
{
    bool inside = subject_value(t->subject, corner) < 0;
    for (uint32_t i = 0; i < tet->triangle_count; i++) {
        double corners[3][3];
        corners_of_triangle(&t->contour, tet->first_triangle + i, corners);
        inside ^= goes_through(p, corner, (const double(*)[3])corners);
    }
    return inside;
}

/* Returns the largest value of a point that the mesh has on the wrong side.  Its own points are on
   both. */
static double worst_in(const Trial *t, const Tet *tet)
{
    enum { POINTS = 40, STEPS = 8 };
    static const int EDGES[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
    double           corners[4][3], weights[4], p[3], worst = 0;
    tets_corners(&t->tets, tet, corners);
    for (int i = 0; i < POINTS; i++) {
        random_weights(weights);
        if (i < 6 && tet->triangle_count == 0) /* in the middle of an edge */
            for (int k = 0; k < 4; k++)
                weights[k] = k == EDGES[i][0] || k == EDGES[i][1] ? 0.5 : 0;
        mean_of((const double(*)[3])corners, weights, 4, p);
        double value = subject_value(t->subject, p);
        if ((value < 0) != mesh_has(t, tet, corners[0], p))
            worst = fmax(worst, fabs(value));
    }
    for (uint32_t i = 0; i < tet->triangle_count; i++) {
        corners_of_triangle(&t->contour, tet->first_triangle + i, corners);
        for (int a = 0; a <= STEPS; a++)
            for (int b = 0; a + b <= STEPS; b++) {
                double at[3] = {(double)a / STEPS, (double)b / STEPS,
                                (double)(STEPS - a - b) / STEPS};
                mean_of((const double(*)[3])corners, at, 3, p);
                worst = fmax(worst, fabs(subject_value(t->subject, p)));
            }
    }
    return worst;
}

/* ---- what bounds say ---- */

/* How near the true numbers came to the bounds: the largest share of all. */
typedef struct Shares {
    double way, slope, bend, steep;
    size_t cells, empty;
} Shares;

static void random_point(Box box, double p[3])
{
    for (int k = 0; k < 3; k++)
        p[k] = uniform(box.axis[k].low, box.axis[k].high);
}

/* A value grows by at least a slope along one direction everywhere only if no mean of gradients is
   shorter than that.  The shortest is found by Gilbert's algorithm. */
static double shortest_mean(const double (*gradients)[3], int count)
{
    double x[3] = {gradients[0][0], gradients[0][1], gradients[0][2]};
    for (int turn = 0; turn < 100; turn++) {
        int    best = 0;
        double step[3];
        for (int i = 1; i < count; i++)
            best = dot3(gradients[i], x) < dot3(gradients[best], x) ? i : best;
        for (int k = 0; k < 3; k++)
            step[k] = x[k] - gradients[best][k];
        double square = dot3(step, step), share = square > 0 ? dot3(x, step) / square : 0;
        for (int k = 0; k < 3; k++)
            x[k] -= fmin(fmax(share, 0), 1) * step[k];
    }
    return length3(x);
}

enum { SLOPE_POINTS = 30 };

static void check_slope_at(const Subject *subject, const double (*points)[3], int count,
                           double slope, Shares *shares)
{
    double gradients[SLOPE_POINTS][3];
    for (int i = 0; i < count; i++)
        subject_gradient(subject, points[i], gradients[i]);
    double most = shortest_mean((const double(*)[3])gradients, count);
    assert_true(slope <= most + 1e-7);
    shares->slope = fmax(shares->slope, slope / most);
}

/* Deep inside, where no surface is, a CSG node may have left out a part: the number is another one there. */
static bool is_closed_form(const Trial *t, const double p[3])
{
    return fabs(subject_value(t->subject, p) - field_distance(&t->fields[0], p)) < 1e-9;
}

/* Compares with random points, and with corners: gradients are differences, so these are a little within the
   box. */
static void check_slope(const Trial *t, Box box, double slope, Shares *shares)
{
    static const double WITHIN = 1e-5;
    double              points[SLOPE_POINTS][3];
    int                 count = 0;
    for (int i = 0; i < SLOPE_POINTS; i++) {
        random_point(box, points[count]);
        for (int k = 0; i < 8 && k < 3; k++)
            points[count][k] = i >> k & 1 ? box.axis[k].high - WITHIN : box.axis[k].low + WITHIN;
        count += is_closed_form(t, points[count]);
    }
    if (count > 0)
        check_slope_at(t->subject, (const double(*)[3])points, count, slope, shares);
}

/* Compares with ways along the gradient in the middle, from points of a box that are near to the surface. */
static void check_slope_of_ways(const Trial *t, Box box, double slope, Shares *shares)
{
    enum { TRIES = 200 };
    double points[SLOPE_POINTS][3], middle[3], normal[3];
    int    count = 0;
    for (int k = 0; k < 3; k++)
        middle[k] = 0.5 * (box.axis[k].low + box.axis[k].high);
    subject_gradient(t->subject, middle, normal);
    for (int i = 0; i < TRIES && count < SLOPE_POINTS; i++) {
        random_point(box, points[count]);
        if (fabs(subject_value(t->subject, points[count])) > t->error)
            continue;
        double way = i % 3 ? uniform(-1, 1) : i % 2 ? 1 : -1;
        add_scaled3(points[count], points[count], way * t->error, normal);
        count++;
    }
    if (count > 4)
        check_slope_at(t->subject, (const double(*)[3])points, count, slope, shares);
}

static void check_bends(const Subject *subject, const SmoothCell *cell, Box box, Shares *shares)
{
    enum { POINTS = 20 };
    static const double STEP = 1e-4, zero[3] = {0, 0, 0};
    for (int i = 0; i < POINTS; i++) {
        double p[3], d[3], low[3], high[3], length;
        random_point(box, p);
        random_vector(&chance, 1, d);
        length = length3(d);
        for (int k = 0; k < 3; k++) {
            d[k] /= length;
            low[k]  = p[k] - STEP * d[k];
            high[k] = p[k] + STEP * d[k];
        }
        double bend = (subject_value(subject, low) - 2 * subject_value(subject, p) +
                       subject_value(subject, high)) /
                      (STEP * STEP);
        double up = smooth_bend(cell->above, d, zero), down = smooth_bend(cell->below, d, zero);
        assert_true(bend <= up + 1e-4 && -bend <= down + 1e-4);
        if (fabs(bend) > 0.3)
            shares->bend = fmax(shares->bend, bend > 0 ? bend / up : -bend / down);
    }
}

/* What no surface is said to be in, has none.  A way that leaves the box of the cell says nothing. */
static void check_tet(const Trial *t, const Tet *tet, bool empty, bool exact, Shares *shares)
{
    double worst = worst_in(t, tet), way = tet->deviation / tet->slope;
    shares->cells++;
    shares->empty += empty;
    if (empty && (tet->triangle_count > 0 || worst > 0))
        fail_msg("a surface, %g deep, where none is said to be", worst);
    if (exact && worst > max2(tet->deviation, 0) + 1e-12)
        fail_msg("a value of %g on the wrong side, not %g", worst, tet->deviation);
    if (empty || !(tet->slope > 0) || way > t->error)
        return;
    if (worst > way + 1e-12)
        fail_msg("a point is %g away, not %g", worst, way);
    if (way > 1e-3 * t->error)
        shares->way = fmax(shares->way, worst / way);
}

typedef struct Bounds {
    Shares smooth, closer, pieces;
} Bounds;

static Box wider(Box box, double margin)
{
    for (int k = 0; k < 3; k++) {
        box.axis[k].low -= margin;
        box.axis[k].high += margin;
    }
    return box;
}

static void try_smooth(const Trial *t, SmoothCell *cell, Box own, Tet *tet, Bounds *bounds)
{
    bool exact = t->subject->bodies[0].form != EQUATION && t->subject->bodies[1].form != EQUATION;
    for (int closer = 0; closer < 2; closer++) {
        Shares *shares = closer ? &bounds->closer : &bounds->smooth;
        if (closer)
            smooth_narrow(&t->fields[0], t->error, cell);
        if (exact) {
            if (closer)
                check_slope_of_ways(t, own, cell->slope, shares);
            else
                check_slope(t, cell->box, cell->slope, shares);
            check_bends(t->subject, cell, closer ? own : cell->box, shares);
        }
        bool empty = smooth_measure(&t->contour, cell, tet);
        check_tet(t, tet, empty, exact, shares);
    }
}

/* No piece changes faster than is said, between points of the box. */
static void check_steep(const Trial *t, const PieceCell *cell, Box wide, Shares *shares)
{
    enum { POINTS = 12 };
    double points[POINTS][3], values[POINTS * MAX_PIECES];
    size_t count = cell->pieces.count;
    for (int i = 0; i < POINTS; i++)
        random_point(wide, points[i]);
    field_piece_values(&t->fields[0], &cell->pieces, (const double(*)[3])points, POINTS, values);
    for (size_t i = count; i < POINTS * count; i++) {
        double length = distance3(points[i / count], points[i / count - 1]);
        double change = fabs(values[i] - values[i - count]);
        assert_true(change <= cell->steep * length + 1e-12);
        if (length > 1e-4)
            shares->steep = fmax(shares->steep, change / (cell->steep * length));
    }
}

/* A deviation that fits is not looked at closely, so less and less is asked for. */
static void try_pieces(Trial *t, Box wide, Tet *tet, Bounds *bounds)
{
    PieceCell cell;
    pieces_bound(&t->fields[0], wide, &cell);
    for (double error = t->error; cell.known && error > 1e-3 * t->error;) {
        bool empty = pieces_measure(&t->contour, &t->fields[0], &cell, error, tet);
        check_tet(t, tet, empty, false, &bounds->pieces);
        if (empty || !(tet->deviation < INFINITY))
            break;
        error = 0.98 * tet->deviation / tet->slope;
    }
    if (cell.known) {
        assert_true(cell.slope <= cell.steep && tet->steep >= cell.steep);
        check_steep(t, &cell, wide, &bounds->pieces);
    }
}

static bool is_near_focus(const Trial *t, const Tet *tet)
{
    double corners[4][3];
    tets_corners(&t->tets, tet, corners);
    return distance3(corners[0], t->focus) < 2 * t->length;
}

/* ---- parts that face each other ---- */

typedef struct Rooms {
    Shares ways;
    size_t found;
    double nearest; /* to the true one: the largest share */
} Rooms;

/* Finds a point of the surface between two of a tetrahedron; false: both are on one side. */
static bool surface_point_in(const Trial *t, const double corners[4][3], double p[3])
{
    double weights[4], ends[2][3];
    for (int i = 0; i < 2; i++) {
        random_weights(weights);
        mean_of(corners, weights, 4, ends[i]);
    }
    bool inside = subject_value(t->subject, ends[0]) < 0;
    if (inside == (subject_value(t->subject, ends[1]) < 0))
        return false;
    for (int i = 0; i < 50; i++) {
        for (int k = 0; k < 3; k++)
            p[k] = 0.5 * (ends[0][k] + ends[1][k]);
        memcpy(ends[(subject_value(t->subject, p) < 0) != inside], p, sizeof ends[0]);
    }
    return true;
}

/* From a point of one body's surface, the other one is no nearer than the room. */
static void check_room(const Trial *t, const Tet *tet, Rooms *rooms)
{
    enum { TRIES = 20 };
    Subject bodies[2] = {*t->subject, *t->subject};
    double  corners[4][3], p[3], nearest = INFINITY;
    bodies[1].bodies[0] = bodies[1].bodies[1];
    bodies[0].csg_node = bodies[1].csg_node = ALONE;
    tets_corners(&t->tets, tet, corners);
    for (int i = 0; i < TRIES; i++)
        if (surface_point_in(t, (const double(*)[3])corners, p))
            nearest = fmin(nearest, fmax(fabs(subject_value(&bodies[0], p)),
                                         fabs(subject_value(&bodies[1], p))));
    if (tet->room > nearest + 1e-9)
        fail_msg("the other body is %g away, not %g", nearest, tet->room);
    rooms->found++;
    if (nearest < INFINITY)
        rooms->nearest = fmax(rooms->nearest, tet->room / nearest);
}

static void try_room(Trial *t, size_t number, Rooms *rooms)
{
    Tet       tet = t->tets.list.items[number];
    double    corners[4][3];
    PieceCell cell;
    tets_corners(&t->tets, &tet, corners);
    Box wide = corners_box((const double(*)[3])corners, 4, 2 * t->error);
    if (!field_enter(&t->fields[0], wide))
        return;
    pieces_bound(&t->fields[0], wide, &cell);
    if (cell.known && cell.facing.operand_count > 0 &&
        !pieces_measure(&t->contour, &t->fields[0], &cell, t->error, &tet) &&
        tet.deviation < INFINITY) {
        check_tet(t, &tet, false, false, &rooms->ways);
        check_room(t, &tet, rooms);
    }
    field_leave(&t->fields[0]);
}

/* Two balls beside each other, or one within the other, at most so far apart. */
static Subject balls_apart(double gap, bool within)
{
    static const Form    forms[]     = {BALL};
    static const CsgNode csg_nodes[] = {UNION};
    const Kind           kind        = {forms, 1, csg_nodes, 1};
    Subject              subject     = random_subject(&chance, &kind);
    Body                *balls       = subject.bodies;
    double               way[3];
    random_vector(&chance, 1, way);
    normalize3(way);
    if (within) {
        subject.csg_node = DIFFERENCE;
        balls[1].size[0] = balls[0].size[0] - gap;
        add_scaled3(balls[1].move, balls[0].move, 0.7 * gap, way);
    } else
        add_scaled3(balls[1].move, balls[0].move, balls[0].size[0] + balls[1].size[0] + gap, way);
    return subject;
}

/* A point between both, where they are nearest to each other. */
static void point_between(const Subject *subject, double p[3])
{
    const Body *balls = subject->bodies;
    double      way[3];
    add_scaled3(way, balls[1].move, -1, balls[0].move);
    normalize3(way);
    add_scaled3(p, balls[0].move, balls[0].size[0], way);
}

static void parts_stay_apart(void **context)
{
    enum { SHAPES = 24 };
    Rooms rooms[2] = {0};
    (void)context;
    for (int i = 0; i < SHAPES; i++) {
        Trial   t;
        double  focus[3];
        Subject subject = balls_apart(exp(uniform(log(1e-3), log(0.05))), i % 2);
        point_between(&subject, focus);
        open_trial(&t, &subject, focus, false);
        for (size_t k = 0; k < t.tets.list.count; k++)
            if (is_near_focus(&t, &t.tets.list.items[k]))
                try_room(&t, k, &rooms[i % 2]);
        close_trial(&t);
    }
    for (int i = 0; i < 2; i++) {
        print_message("# %s: %zu of them, nearest room %.3f, nearest way %.3f\n",
                      i ? "walls" : "gaps", rooms[i].found, rooms[i].nearest, rooms[i].ways.way);
        assert_true(rooms[i].found > 100 && rooms[i].nearest > 0.9 && rooms[i].ways.way > 0.5);
    }
}

static void try_tet(Trial *t, size_t number, Bounds *bounds)
{
    Tet        tet = t->tets.list.items[number];
    double     corners[4][3];
    SmoothCell cell;
    tets_corners(&t->tets, &tet, corners);
    Box own  = corners_box((const double(*)[3])corners, 4, 0);
    Box wide = wider(own, 2 * t->error);
    if (!field_enter(&t->fields[0], wide)) {
        assert_true(tet.triangle_count == 0 && worst_in(t, &tet) == 0);
        return;
    }
    smooth_bound(&t->fields[0], wider(own, t->error), t->error, &cell);
    if (cell.known && !cell.empty)
        try_smooth(t, &cell, own, &tet, bounds);
    else if (!cell.empty)
        try_pieces(t, wide, &tet, bounds);
    else
        assert_true(tet.triangle_count == 0 && worst_in(t, &tet) == 0);
    field_leave(&t->fields[0]);
}

static void try_kind(const Kind *kind, int shapes, Bounds *bounds)
{
    enum { APART = 3 };
    for (int i = 0; i < shapes;) {
        Trial   t;
        Subject subject = random_subject(&chance, kind);
        double  focus[3];
        if (!random_surface_point(&chance, &subject, focus))
            continue;
        open_trial(&t, &subject, focus, i % 4 == 0);
        for (size_t k = 0; k < t.tets.list.count; k++)
            if (is_near_focus(&t, &t.tets.list.items[k]) && random_below(&chance, APART) == 0)
                try_tet(&t, k, bounds);
        close_trial(&t);
        i++;
    }
}

static void say(const char *name, const Shares *s)
{
    print_message("# %s: %zu bounds, %zu without a surface; nearest way %.3f, slope %.3f, "
                  "bend %.3f, steep %.3f\n",
                  name, s->cells, s->empty, s->way, s->slope, s->bend, s->steep);
}

static void smooth_bounds_hold(void **context)
{
    static const Form    forms[]     = {BALL, RING, EQUATION};
    static const CsgNode csg_nodes[] = {ALONE, BLEND};
    const Kind blends = {forms, 2, csg_nodes, 2}, equations = {&forms[2], 1, csg_nodes, 1};
    Bounds     bounds = {0};
    (void)context;
    try_kind(&blends, 80, &bounds);
    try_kind(&equations, 80, &bounds);
    say("smooth", &bounds.smooth);
    say("closer", &bounds.closer);
    for (int i = 0; i < 2; i++) {
        const Shares *s = i ? &bounds.closer : &bounds.smooth;
        assert_true(s->cells > 1000 && s->empty > 100);
        assert_true(s->way > 0.9 && s->slope > 0.95 && s->bend > 0.95);
    }
}

static void bounds_of_pieces_hold(void **context)
{
    static const Form    forms[]     = {BALL, RING, CAN, CONE, BLOCK};
    static const CsgNode csg_nodes[] = {ALONE, UNION, INTERSECTION, DIFFERENCE};
    const Kind           kind        = {forms, 5, csg_nodes, 4};
    Bounds               bounds      = {0};
    (void)context;
    try_kind(&kind, 200, &bounds);
    say("pieces", &bounds.pieces);
    assert_true(bounds.pieces.cells > 1000 && bounds.pieces.empty > 10);
    assert_true(bounds.pieces.way > 0.9 && bounds.pieces.steep > 0.95);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(smooth_bounds_hold),
        cmocka_unit_test(bounds_of_pieces_hold),
        cmocka_unit_test(parts_stay_apart),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
