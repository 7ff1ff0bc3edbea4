/* coverage.c: which part of a cube is solid, for fog.
 *
 * A cube is looked at in 64 parts, and in 26 places around it.  Where the distance is linear in it, each part has that of a
 * flat face at the distance of its middle.  Else parts that the surface may meet are divided in the same way.
 */
#include "compiler/grid/grid.h"

#include <string.h>

#include "compiler/base/vec.h"

enum { SIDE = 4, PARTS = SIDE * SIDE * SIDE, AROUND = 26, PLACES = PARTS + AROUND };
/* How often parts of a cube are divided, and how many parts of parts are at most: those along edges and rods are few. */
enum { DEEPEST = 2, MOST_DIVIDED = 150 };
/* Half the diagonal of a part, in its sides; and how far from linear its distance may be. */
static const double HALF_DIAGONAL = 0.8661, STRAIGHT = 0.3;
/* Below that gradients tell no distance. */
static const double LEAST_SLOPE = 0.1;

typedef struct Cube {
    double middle[3], part; /* the side of its parts */
    double distances[PLACES];
} Cube;

/* Of a part or a place around all, in parts from the middle. */
static void place_of(int i, double at[3])
{
    const double beyond = 0.5 * (SIDE + 1);
    const bool   part   = i < PARTS;
    int          turn   = i - PARTS < AROUND / 2 ? i - PARTS : i - PARTS + 1; /* not the middle */
    for (int k = 0; k < 3; k++, turn /= 3, i /= SIDE)
        at[k] = part ? i % SIDE - 0.5 * (SIDE - 1) : beyond * (turn % 3 - 1);
}

static void look(const MeshField *field, Cube *cube)
{
    for (int first = 0; first < PLACES; first += MOST_FIELD_POINTS) {
        double points[MOST_FIELD_POINTS][3];
        int    count = PLACES - first < MOST_FIELD_POINTS ? PLACES - first : MOST_FIELD_POINTS;
        for (int i = 0; i < count; i++) {
            double at[3];
            place_of(first + i, at);
            add_scaled3(points[i], cube->middle, cube->part, at);
        }
        field_distances(field, (const double(*)[3])points, (size_t)count, cube->distances + first);
    }
}

/* The slope of the plane that fits best; false: the distance is not linear, and the slope stays.  The sums of places are 0. */
static bool is_straight(const Cube *cube, double *slope)
{
    double mean = 0, gradient[3] = {0}, squares = 0, at[3];
    for (int i = 0; i < PLACES; i++) {
        place_of(i, at);
        mean += cube->distances[i] / PLACES;
        squares += at[0] * at[0];
        add_scaled3(gradient, gradient, cube->distances[i], at);
    }
    for (int k = 0; k < 3; k++)
        gradient[k] /= squares;
    for (int i = 0; i < PLACES; i++) {
        place_of(i, at);
        if (!(fabs(cube->distances[i] - mean - dot3(gradient, at)) < STRAIGHT * cube->part))
            return false;
    }
    *slope = length3(gradient) / cube->part;
    return true;
}

static double divide(const MeshField *field, const double middle[3], double side, int depth,
                     int *left)
{
    Cube   cube  = {.part = side / SIDE};
    double slope = 1, sum = 0;
    memcpy(cube.middle, middle, sizeof cube.middle);
    look(field, &cube);
    const bool straight = is_straight(&cube, &slope), last = depth == DEEPEST;
    for (int i = 0; i < PARTS; i++) {
        double distance = cube.distances[i] / (cube.part * max2(slope, LEAST_SLOPE)), at[3];
        if (straight || last || fabs(cube.distances[i]) > HALF_DIAGONAL * cube.part ||
            (depth > 0 && *left == 0)) {
            sum += min2(max2(0.5 - distance, 0), 1);
            continue;
        }
        *left -= depth > 0;
        place_of(i, at);
        add_scaled3(at, middle, cube.part, at);
        sum += divide(field, at, cube.part, depth + 1, left);
    }
    return sum / PARTS;
}

double coverage(const MeshField *field, const double point[3], double side)
{
    int left = MOST_DIVIDED;
    return divide(field, point, side, 0, &left);
}
