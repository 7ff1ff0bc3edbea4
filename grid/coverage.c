/* coverage.c: estimates which part of a cube is solid, for fog.  The distance is evaluated in 64
   parts of a cube, and at 26 points around it.  Where it is linear inside and outside, each part is
   covered as by a flat face at the distance of its middle.  Else parts that the surface may meet
   are divided in the same way. */
#include "grid/grid.h"

#include <string.h>

#include "compiler/base/vec.h"

enum { SIDE = 4, PARTS = SIDE * SIDE * SIDE, AROUND = 26, POINTS = PARTS + AROUND };
/* The limits of dividing: how often parts of a cube are divided at most; how many parts are few, so
   that their parts are divided, too, as along rods; and how many of these are divided. */
enum { DEEPEST = 2, FEW = 20, MAX_DIVIDED = 150 };
/* Half the diagonal of a part, and how far from linear its distance may be, in its sides. */
static const double HALF_DIAGONAL = 0.8661, STRAIGHT = 0.3;
/* Slopes below this are those of something thin. */
static const double MIN_SLOPE = 0.25;

typedef struct Cube {
    double middle[3], part; /* the side of its parts */
    double distances[POINTS];
} Cube;

/* Finds the middle of a part, or a point around the cube, in parts from the middle. */
static void cube_point(int i, double at[3])
{
    const double beyond = 0.5 * (SIDE + 1);
    const bool   part   = i < PARTS;
    int          number = i - PARTS < AROUND / 2 ? i - PARTS : i - PARTS + 1; /* not the middle */
    for (int k = 0; k < 3; k++, number /= 3, i /= SIDE)
        at[k] = part ? i % SIDE - 0.5 * (SIDE - 1) : beyond * (number % 3 - 1);
}

static void sample_cube(const MeshField *field, Cube *cube)
{
    for (int first = 0; first < POINTS; first += MAX_FIELD_POINTS) {
        double points[MAX_FIELD_POINTS][3];
        int    count = POINTS - first < MAX_FIELD_POINTS ? POINTS - first : MAX_FIELD_POINTS;
        for (int i = 0; i < count; i++) {
            double at[3];
            cube_point(first + i, at);
            add_scaled3(points[i], cube->middle, cube->part, at);
        }
        field_distances(field, (const double(*)[3])points, (size_t)count, cube->distances + first);
    }
}

/* Finds the direction of the gradient by least squares; the sum of all points is 0. */
static bool find_direction(const Cube *cube, double direction[3])
{
    double at[3];
    for (int k = 0; k < 3; k++)
        direction[k] = 0;
    for (int i = 0; i < POINTS; i++) {
        cube_point(i, at);
        add_scaled3(direction, direction, cube->distances[i], at);
    }
    return normalize3(direction);
}

/* Tells whether distances inside, or those outside, are linear along a direction, and finds their
   slope: a bound may have another one on each side. */
static bool is_side_straight(const Cube *cube, const double direction[3], bool inside,
                             double *slope)
{
    double along[POINTS], count = 0, mean = 0, middle = 0, squares = 0, products = 0, at[3];
    for (int i = 0; i < POINTS; i++) {
        cube_point(i, at);
        along[i] = cube->part * dot3(at, direction);
        if ((cube->distances[i] <= 0) != inside)
            continue;
        count++;
        mean += cube->distances[i];
        middle += along[i];
    }
    if (count == 0)
        return true;
    mean /= count;
    middle /= count;
    for (int i = 0; i < POINTS; i++)
        if ((cube->distances[i] <= 0) == inside) {
            squares += (along[i] - middle) * (along[i] - middle);
            products += (along[i] - middle) * (cube->distances[i] - mean);
        }
    const double steep = squares > 1e-6 * cube->part * cube->part ? products / squares : 1;
    if (steep < MIN_SLOPE)
        return false;
    for (int i = 0; i < POINTS; i++)
        if ((cube->distances[i] <= 0) == inside &&
            !(fabs(cube->distances[i] - mean - steep * (along[i] - middle)) <
              STRAIGHT * cube->part))
            return false;
    *slope = steep;
    return true;
}

/* Finds the slopes outside and inside; returns false, and does not set them, if distances are not
   linear. */
static bool is_straight(const Cube *cube, double slopes[2])
{
    double direction[3], found[2] = {1, 1};
    if (!find_direction(cube, direction) || !is_side_straight(cube, direction, false, &found[0]) ||
        !is_side_straight(cube, direction, true, &found[1]))
        return false;
    memcpy(slopes, found, sizeof found);
    return true;
}

/* Returns how many parts the surface may meet. */
static int count_met(const Cube *cube)
{
    int count = 0;
    for (int i = 0; i < PARTS; i++)
        count += fabs(cube->distances[i]) <= HALF_DIAGONAL * cube->part;
    return count;
}

static double divide(const MeshField *field, const double middle[3], double side, int depth,
                     int *left)
{
    Cube   cube      = {.part = side / SIDE};
    double slopes[2] = {1, 1}, sum = 0;
    memcpy(cube.middle, middle, sizeof cube.middle);
    sample_cube(field, &cube);
    const bool straight = is_straight(&cube, slopes), last = depth == DEEPEST;
    if (depth == 0)
        *left = count_met(&cube) > FEW ? 0 : MAX_DIVIDED;
    for (int i = 0; i < PARTS; i++) {
        double slope    = slopes[cube.distances[i] <= 0], at[3];
        double distance = cube.distances[i] / (cube.part * slope);
        if (straight || last || fabs(cube.distances[i]) > HALF_DIAGONAL * cube.part ||
            (depth > 0 && *left == 0)) {
            sum += min2(max2(0.5 - distance, 0), 1);
            continue;
        }
        *left -= depth > 0;
        cube_point(i, at);
        add_scaled3(at, middle, cube.part, at);
        sum += divide(field, at, cube.part, depth + 1, left);
    }
    return sum / PARTS;
}

double coverage(const MeshField *field, const double point[3], double side)
{
    int left;
    return divide(field, point, side, 0, &left);
}
