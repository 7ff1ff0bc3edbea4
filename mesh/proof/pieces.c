/* pieces.c: bounds how far inside and outside of the mesh are from those of the surface, where it
   has edges. */
#include "mesh/proof/pieces.h"

#include <string.h>

#include "compiler/base/vec.h"

static const double ROUNDING = 1 + 1e-9;

/* ---- cells ---- */

void pieces_bound(MeshField *field, Box box, PieceCell *cell)
{
    cell->known = field_pieces(field, box, &cell->pieces);
    if (!cell->known || cell->pieces.side != 0)
        return;
    cell->growth = (Growth){.count = 0};
    cell->slope  = facing_find(&cell->pieces, cell->growth.direction, &cell->facing);
    cell->known  = cell->slope > 0;
    cell->steep  = 0;
    for (size_t i = 0; i < cell->pieces.count && cell->known; i++) {
        bool   negated = cell->pieces.signs[i] < 0;
        double square  = 0;
        for (int k = 0; k < 3; k++) {
            double most = range_largest(cell->pieces.slopes[i].by[k]);
            square += most * most;
        }
        cell->steep = max2(cell->steep, ROUNDING * sqrt(square));
        if (cell->facing.operand_count == 0)
            growth_add(&cell->growth, cell->pieces.slopes[i].by, cell->pieces.signs[i]);
        smooth_forms(&cell->pieces.hessians[i], negated ? cell->below[i] : cell->above[i],
                     negated ? cell->above[i] : cell->below[i]);
    }
}

/* ---- parts ---- */

/* A tetrahedron with the values of pieces at its corners, times the sign of the side, so that bounds
   are sought above 0.  `forms` are what the piece permits between pairs of corners, below 0 or
   above, and `most` bounds each piece in it. */
typedef struct Part {
    double at[4][3];
    double values[MAX_PIECES][4], forms[MAX_PIECES][6], most[MAX_PIECES];
} Part;

/* The pair of two corners in `forms`. */
static const int PAIR[4][4] = {{-1, 0, 1, 2}, {0, -1, 3, 4}, {1, 3, -1, 5}, {2, 4, 5, -1}};

typedef struct Measure {
    const PieceCell *cell;
    double           side; /* 1: values, -1: their negatives */
    double           enough;
    double           slack[MAX_PIECES]; /* for the rounding of forms, of one whole tetrahedron */
    int              budget;
} Measure;

/* Returns what a piece permits between two corners, not below 0. */
static double bend(const Measure *m, size_t piece, const Part *part, int pair)
{
    return max2(part->forms[piece][pair], 0) * ROUNDING + m->slack[piece];
}

/* Finds the forms between all corners. */
static void find_forms(Measure *m, Part *part)
{
    for (size_t i = 0; i < m->cell->pieces.count; i++) {
        const double *form = m->side > 0 ? m->cell->below[i] : m->cell->above[i];
        double        most = 0;
        for (int a = 0; a < 4; a++)
            for (int b = 0; b < a; b++) {
                double between             = smooth_form(form, part->at[a], part->at[b]);
                part->forms[i][PAIR[a][b]] = between;
                most                       = max2(most, fabs(between));
            }
        m->slack[i]   = 1e-12 * most;
        part->most[i] = INFINITY;
    }
}

/* Returns a bound of a piece in a part.  Points are taken in the order of their values: those so
   low that pairs with them add nothing leave what the others permit. */
static double max_of_piece(const Measure *m, size_t piece, const Part *part)
{
    const double *at = part->values[piece];
    double        q[4][4], values[4], least = INFINITY, low = -INFINITY;
    int           order[4] = {0, 1, 2, 3};
    for (int i = 0; i < 4; i++)
        for (int k = i; k > 0 && at[order[k]] > at[order[k - 1]]; k--) {
            int swap     = order[k];
            order[k]     = order[k - 1];
            order[k - 1] = swap;
        }
    for (int i = 0; i < 4; i++) {
        values[i] = at[order[i]];
        for (int j = 0; j < i; j++)
            q[i][j] = q[j][i] = bend(m, piece, part, PAIR[order[i]][order[j]]);
        q[i][i] = 0;
    }
    for (int count = 4; count > 0; count--) {
        double pairs = 0;
        for (int i = 0; i < count; i++)
            for (int j = 0; j < i; j++)
                pairs = max2(pairs, q[i][j]);
        double rest    = count == 3   ? smooth_max_of_three(q[0][1], q[1][2], q[2][0])
                         : count == 4 ? 0.375 * pairs
                                      : 0.25 * pairs;
        least          = min2(least, max2(low, values[0] + 0.5 * rest));
        double longest = 0;
        for (int j = 0; j < 4; j++)
            longest = max2(longest, q[count - 1][j]);
        low = max2(low, values[count - 1] + 0.5 * longest);
    }
    return least;
}

/* Returns what choices make of bounds from above of the pieces, in some of the steps. */
static double choose(const Measure *m, size_t begin, size_t end, const double most[MAX_PIECES])
{
    double stack[MAX_PIECE_STEPS];
    int    depth = 0;
    for (size_t i = begin; i < end; i++) {
        int step = m->cell->pieces.steps[i];
        if (step >= 0) {
            stack[depth++] = most[step];
            continue;
        }
        double b = stack[--depth], a = stack[depth - 1];
        bool   greater   = (step == PIECE_MAX) == (m->side > 0);
        stack[depth - 1] = greater ? max2(a, b) : min2(a, b);
    }
    return stack[0];
}

/* Bounds a part.  A piece that is low enough by far in the whole is not bounded again in parts of
   it. */
static double max_of_part(const Measure *m, Part *part)
{
    static const double FAR    = 0.3;
    const FieldPieces  *pieces = &m->cell->pieces;
    for (size_t i = 0; i < pieces->count; i++)
        if (part->most[i] > FAR * m->enough)
            part->most[i] = min2(part->most[i], max_of_piece(m, i, part));
    return choose(m, 0, pieces->step_count, part->most);
}

/* Sets what forms permit between the middle of corners a and b, which takes the place of b, and the
   others: they are quadratic. */
static void move_to_middle(double forms[6], int a, int b)
{
    double whole = forms[PAIR[a][b]];
    for (int c = 0; c < 4; c++)
        if (c != a && c != b)
            forms[PAIR[b][c]] = 0.5 * (forms[PAIR[a][c]] + forms[PAIR[b][c]]) - 0.25 * whole;
    forms[PAIR[a][b]] = 0.25 * whole;
}

/* Halves a part at its longest edge; pieces in its middle are no more than the mean plus what they
   bend. */
static void halve_part(const Measure *m, const Part *part, Part halves[2])
{
    int    from = 0, to = 1;
    double longest = 0;
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < i; j++) {
            double length = distance3(part->at[i], part->at[j]);
            if (length > longest) {
                longest = length;
                from    = i;
                to      = j;
            }
        }
    halves[0] = halves[1] = *part;
    for (int k = 0; k < 3; k++)
        halves[0].at[from][k] = halves[1].at[to][k] = 0.5 * (part->at[from][k] + part->at[to][k]);
    for (size_t i = 0; i < m->cell->pieces.count; i++) {
        double middle = 0.5 * (part->values[i][from] + part->values[i][to]) +
                        0.125 * bend(m, i, part, PAIR[from][to]);
        halves[0].values[i][from] = halves[1].values[i][to] = middle;
        move_to_middle(halves[0].forms[i], to, from);
        move_to_middle(halves[1].forms[i], from, to);
    }
}

static double measure_part(Measure *m, Part *part, int halvings)
{
    enum { MAX_HALVINGS = 9 };
    double most = max_of_part(m, part);
    if (most <= m->enough || halvings == MAX_HALVINGS || --m->budget < 0)
        return most;
    Part   halves[2];
    double parts;
    halve_part(m, part, halves);
    parts = measure_part(m, &halves[0], halvings + 1);
    if (parts <= m->enough)
        parts = max2(parts, measure_part(m, &halves[1], halvings + 1));
    return min2(most, parts > m->enough ? INFINITY : parts);
}

/* ---- cones ---- */

/* Numbers of points of a tetrahedron: its corners, then the mesh's vertices there. */
enum { CROSSINGS = 4, BENDS = 8, APEX = 12, POINTS = 13, NONE = -1 };

typedef struct Points {
    double at[POINTS][3], values[POINTS][MAX_PIECES];
    bool   inside[4];
} Points;

typedef struct Cones {
    Measure       m;
    const Points *points;
    int           apex;
    double        most;
} Cones;

static void add_cone(Cones *c, int p, int q, int r)
{
    Part part;
    int  numbers[4] = {c->apex, p, q, r};
    if (p == c->apex || q == c->apex || r == c->apex || c->most > c->m.enough)
        return;
    for (int i = 0; i < 4; i++) {
        memcpy(part.at[i], c->points->at[numbers[i]], sizeof part.at[i]);
        for (size_t k = 0; k < c->m.cell->pieces.count; k++)
            part.values[k][i] = c->m.side * c->points->values[numbers[i]][k];
    }
    find_forms(&c->m, &part);
    c->most = max2(c->most, measure_part(&c->m, &part, 0));
}

/* The cut of a face by the mesh: from the edge of `single` and `a` to that of `single` and `b`. */
typedef struct FaceCut {
    int single, a, b, at_a, at_b, bend; /* `single` is NONE where it does not */
} FaceCut;

static void add_face_side(Cones *c, const FaceCut *cut, const int corners[3], bool inside)
{
    if (cut->single == NONE) {
        if (c->points->inside[corners[0]] == inside)
            add_cone(c, corners[0], corners[1], corners[2]);
        return;
    }
    bool single = c->points->inside[cut->single] == inside;
    if (cut->bend == NONE && single)
        add_cone(c, cut->at_a, cut->at_b, cut->single);
    else if (cut->bend == NONE) {
        add_cone(c, cut->at_a, cut->a, cut->b);
        add_cone(c, cut->at_a, cut->b, cut->at_b);
    } else if (single) {
        add_cone(c, cut->bend, cut->at_a, cut->single);
        add_cone(c, cut->bend, cut->single, cut->at_b);
    } else {
        add_cone(c, cut->bend, cut->at_a, cut->a);
        add_cone(c, cut->bend, cut->a, cut->b);
        add_cone(c, cut->bend, cut->b, cut->at_b);
    }
}

static int crossing_between(const Contour *contour, const Patch *patch, uint32_t a, uint32_t b)
{
    for (uint32_t i = 0; i < patch->corner_count; i++) {
        const Crossing *crossing = &contour->crossings.items[patch->crossings[i]];
        if ((crossing->from == a && crossing->to == b) ||
            (crossing->from == b && crossing->to == a))
            return (int)i;
    }
    return NONE;
}

static FaceCut find_cut(const Contour *contour, const Tet *tet, const Points *points,
                        const int corners[3])
{
    FaceCut cut   = {.single = NONE, .bend = NONE};
    int     count = points->inside[corners[0]] + points->inside[corners[1]] +
                points->inside[corners[2]];
    if (count == 0 || count == 3)
        return cut;
    const Patch *patch = &contour->patches.items[tet->patch];
    int          i     = 0;
    while (points->inside[corners[i]] != (count == 1))
        i++;
    cut.single = corners[i];
    cut.a      = corners[(i + 1) % 3];
    cut.b      = corners[(i + 2) % 3];
    int a      = crossing_between(contour, patch, tet->points[cut.single], tet->points[cut.a]);
    int b      = crossing_between(contour, patch, tet->points[cut.single], tet->points[cut.b]);
    cut.at_a   = CROSSINGS + a;
    cut.at_b   = CROSSINGS + b;
    int before = (a + 1) % (int)patch->corner_count == b ? a : b; /* the line follows it */
    if (contour->lines.items[patch->lines[before]].bent)
        cut.bend = BENDS + before;
    return cut;
}

static void find_points(const Contour *contour, const MeshField *field, const PieceCell *cell,
                        const Tet *tet, Points *points)
{
    double at[POINTS][3], values[POINTS * MAX_PIECES];
    tets_corners(contour->tets, tet, at);
    for (int i = 4; i < POINTS; i++)
        memcpy(at[i], at[0], sizeof at[i]);
    for (int i = 0; i < 4; i++)
        points->inside[i] = point_is_inside(contour->tets, tet->points[i]);
    if (tet->triangle_count > 0) {
        const Patch *patch = &contour->patches.items[tet->patch];
        for (uint32_t i = 0; i < patch->corner_count; i++) {
            memcpy(at[CROSSINGS + i], contour->crossings.items[patch->crossings[i]].at, sizeof *at);
            memcpy(at[BENDS + i], contour->lines.items[patch->lines[i]].at, sizeof *at);
        }
        if (patch->fan)
            memcpy(at[APEX], patch->apex, sizeof *at);
    }
    field_piece_values(field, &cell->pieces, (const double(*)[3])at, POINTS, values);
    memcpy(points->at, at, sizeof at);
    for (size_t i = 0; i < POINTS * cell->pieces.count; i++)
        points->values[i / cell->pieces.count][i % cell->pieces.count] = values[i];
}

static double deviation_of_side(const Contour *contour, const Tet *tet, const Points *points,
                                const Measure *m)
{
    static const int FACES[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
    Cones            c           = {.m = *m, .points = points, .apex = 0, .most = -INFINITY};
    bool             inside      = m->side > 0;
    if (tet->triangle_count > 0) {
        const Patch *patch = &contour->patches.items[tet->patch];
        c.apex             = patch->fan ? APEX : CROSSINGS + (int)patch_diagonal(contour, patch);
    }
    for (int i = 0; i < 4; i++) {
        FaceCut cut = find_cut(contour, tet, points, FACES[i]);
        if (cut.single == NONE || (cut.at_a != c.apex && cut.at_b != c.apex))
            add_face_side(&c, &cut, FACES[i], inside);
    }
    return c.most;
}

/* ---- parts that face each other ---- */

/* Bounds the sum of two pieces in a tetrahedron, times the side of the measure. */
static double max_of_sum(Measure *m, const Points *points, size_t i, size_t k)
{
    const double(*forms)[6] = m->side > 0 ? m->cell->below : m->cell->above;
    double form[6], most = 0;
    Part   sum;
    for (int j = 0; j < 6; j++)
        form[j] = forms[i][j] + forms[k][j];
    for (int a = 0; a < 4; a++) {
        sum.values[0][a] = m->side * (points->values[a][i] + points->values[a][k]);
        for (int b = 0; b < a; b++) {
            double between           = smooth_form(form, points->at[a], points->at[b]);
            sum.forms[0][PAIR[a][b]] = between;
            most                     = max2(most, fabs(between));
        }
    }
    m->slack[0] = 1e-12 * most;
    return max_of_piece(m, 0, &sum);
}

/* Bounds the sum of two operands, from bounds of sums of pieces, times the side of the measure. */
static double max_of_operands(const Measure *m, const double sums[MAX_PIECES][MAX_PIECES], size_t a,
                              size_t b)
{
    const Facing *facing = &m->cell->facing;
    double        most[MAX_PIECES];
    for (size_t i = 0; i < m->cell->pieces.count; i++)
        most[i] = choose(m, facing->begins[b], facing->ends[b], sums[i]);
    return choose(m, facing->begins[a], facing->ends[a], most);
}

/* Returns a bound of how far parts are apart: where one is 0, the others are as much above it, or
   below it at a wall. */
static double find_gap(const PieceCell *cell, const Points *points)
{
    const Facing *facing = &cell->facing;
    Measure       m      = {.cell = cell, .side = facing->choice == PIECE_MIN ? -1 : 1};
    double        sums[MAX_PIECES][MAX_PIECES], least = INFINITY;
    for (size_t i = 0; i < cell->pieces.count; i++)
        for (size_t k = 0; k < cell->pieces.count; k++)
            sums[i][k] = k < i ? sums[k][i] : max_of_sum(&m, points, i, k);
    for (size_t a = 0; a < facing->operand_count; a++)
        for (size_t b = 0; b < a; b++)
            if (facing->parts[a] != facing->parts[b])
                least = min2(least, -max_of_operands(&m, (const double(*)[MAX_PIECES])sums, a, b));
    return least;
}

/* Finds how far ways may lead from a part before they come to the next one; false: what is on the
   wrong side may be near to no surface. */
static bool find_room(const PieceCell *cell, const Points *points, Tet *tet)
{
    if (cell->facing.operand_count == 0 || tet->deviation == INFINITY)
        return true;
    tet->room = (float)(find_gap(cell, points) / cell->steep * (1 - 1e-6));
    return tet->room > tet->deviation / tet->slope * (1 + 1e-6);
}

bool pieces_measure(const Contour *contour, const MeshField *field, const PieceCell *cell,
                    double error, Tet *tet)
{
    enum { BUDGET = 200 };
    Points points;
    tet->slope  = (float)(cell->slope * (1 - 1e-6));
    tet->steep  = (float)(cell->steep * (1 + 1e-6));
    tet->origin = cell->pieces.origin;
    tet->room   = 0;
    find_points(contour, field, cell, tet, &points);
    Measure m         = {.cell = cell, .budget = BUDGET, .enough = tet->slope * error};
    double  deviation = -INFINITY;
    if (tet->triangle_count > 0 || points.inside[0]) {
        m.side    = 1;
        deviation = max2(deviation, deviation_of_side(contour, tet, &points, &m));
    }
    if (tet->triangle_count > 0 || !points.inside[0]) {
        m.side    = -1;
        deviation = max2(deviation, deviation_of_side(contour, tet, &points, &m));
    }
    /* A larger deviation was not bounded to the end. */
    tet->deviation = deviation > m.enough ? INFINITY
                                          : (float)(deviation * (1 + copysign(1e-6, deviation)));
    if (deviation >= 0 && !find_room(cell, &points, tet))
        tet->deviation = INFINITY;
    return deviation < 0;
}
