/*
 * Repetition with variation against the union of what stands in each cell, written in C.
 *
 * The distance is never above the true one, negative exactly inside, and equal to the true one near
 * surfaces.  In many cells neither the cell of a point nor the one on its side is nearest: what looks
 * at these two alone exceeds the distance, so a wrong rule for the others would be seen.
 */
#include "tests/oracle/judge.h"
#include "tests/oracle/product.h"

#include <stdio.h>

typedef struct Cell {
    int i[3];
} Cell;

/* Signed distance of the content of a cell, in the cell's own space: exact outside. */
typedef double Part(Vec p, Cell cell);

/* In scenes `wave(cell)`: from 0 to 1, another in each cell. */
static double wave(Cell c) { return 0.5 + 0.5 * sin(1.3 * c.i[0] + 2.1 * c.i[1] + 0.7 * c.i[2]); }
#define WAVE "def wave(cell) = 0.5 + 0.5 * sin(dot(cell, [1.3, 2.1, 0.7]));\n"

static double ball(Vec p, double radius) { return vec_length(p) - radius; }

static double bar(Vec p, Vec half)
{
    Vec    q       = vec(fabs(p.x) - half.x, fabs(p.y) - half.y, fabs(p.z) - half.z);
    Vec    outside = vec(fmax(q.x, 0), fmax(q.y, 0), fmax(q.z, 0));
    double inside  = fmin(fmax(fmax(q.x, q.y), q.z), 0);
    return vec_length(outside) + inside;
}

static double small_balls(Vec p, Cell c) { return ball(p, 0.15 + 0.15 * wave(c)); }
static double all_balls(Vec p, Cell c) { return ball(p, 0.02 + 0.46 * pow(wave(c), 6)); }
static double grown(Vec p, Cell c) { return all_balls(p, c) - 0.05; }
static double one_of_three(Vec p, Cell c) { return ball(p, c.i[0] % 3 == 0 ? 0.48 : 0.02); }
static double moved(Vec p, Cell c) { return ball(vec(p.x - 0.3 * (wave(c) - 0.5), p.y, p.z), 0.3); }

static double turned(Vec p, Cell c)
{
    double angle = 3 * wave(c), s = sin(angle), k = cos(angle);
    return bar(vec(k * p.x - s * p.z, p.y, s * p.x + k * p.z), vec(0.4, 0.1, 0.05));
}

static double one_of_two(Vec p, Cell c)
{
    return wave(c) < 0.5 ? ball(p, 0.4) : bar(p, vec(0.15, 0.3, 0.1));
}

/* Three balls in a row, of the size of the cell. */
static double rows(Vec p, Cell c)
{
    double least = HUGE_VAL;
    for (int i = -1; i <= 1; i++)
        least = fmin(least, ball(vec(p.x - 0.3 * i, p.y, p.z), 0.05 + 0.09 * wave(c)));
    return least;
}

/* Twenty balls in a ring, of alike parts. */
static double ring(Vec p, Cell c)
{
    double least = HUGE_VAL;
    for (int i = 0; i < 20; i++) {
        double angle = M_PI / 10 * i, r = 0.2 + 0.2 * wave(c);
        least = fmin(least, ball(vec(p.x - r * cos(angle), p.y, p.z - r * sin(angle)), 0.05));
    }
    return least;
}

typedef struct Solid {
    const char *name, *text;
    Part       *part;
    double      period[3];
    int         first[3], last[3]; /* cells that there are; 0 to 0 does not repeat */
    double      shift;             /* along x, of cell 0 */
    double      near;              /* true distances up to this are found */
    bool        far_is_nearest;    /* neither of two cells may be the nearest */
} Solid;

#define ENDLESS 1000000
#define ON_ALL \
    {-ENDLESS, -ENDLESS, -ENDLESS}, { ENDLESS, ENDLESS, ENDLESS }
#define ON_X \
    {-ENDLESS, 0, 0}, { ENDLESS, 0, 0 }
#define ON_XZ \
    {-ENDLESS, 0, -ENDLESS}, { ENDLESS, 0, ENDLESS }
#define BALLS WAVE "def part(cell) = sphere(0.02 + 0.46 * wave(cell) ^ 6);\n"

static const Solid solids[] = {
    {"balls that keep a margin",
     WAVE "def part(cell) = sphere(0.15 + 0.15 * wave(cell)); show part.repeat(1);",
     small_balls,
     {1, 1, 1},
     ON_ALL,
     0,
     0.19,
     false},
    {"balls of all sizes",
     BALLS "show part.repeat(1);",
     all_balls,
     {1, 1, 1},
     ON_ALL,
     0,
     0.4,
     false},
    {"balls that are offset",
     BALLS "show part.repeat(1).offset(0.05);",
     grown,
     {1, 1, 1},
     ON_ALL,
     0,
     0.4,
     false},
    {"one large ball of three",
     "def part(cell) = sphere(if cell.x % 3 == 0 then 0.48 else 0.02);\n"
     "show part.repeat([1, 0, 0]);",
     one_of_three,
     {1, 0, 0},
     ON_X,
     0,
     0.4,
     true},
    {"the same below a blend",
     "def part(cell) = sphere(if cell.x % 3 == 0 then 0.48 else 0.02);\n"
     "show union(part.repeat([1, 0, 0]), sphere(0.1).move([0, 90, 0]), blend: 0.01);",
     one_of_three,
     {1, 0, 0},
     ON_X,
     0,
     0.4,
     true},
    {"moved balls",
     WAVE "def part(cell) = sphere(0.3).move([0.3 * (wave(cell) - 0.5), 0, 0]);\n"
          "show part.repeat([0.92, 0, 0]);",
     moved,
     {0.92, 0, 0},
     ON_X,
     0,
     0.3,
     false},
    {"turned bars",
     WAVE "def part(cell) = box([0.8, 0.2, 0.1]).rotate([0, 1, 0], 3 * wave(cell));\n"
          "show part.repeat([0.92, 0, 0.92]);",
     turned,
     {0.92, 0, 0.92},
     ON_XZ,
     0,
     0.3,
     false},
    {"one of two",
     WAVE "def part(cell) = if wave(cell) < 0.5 then sphere(0.4) else box([0.3, 0.6, 0.2]);\n"
          "show part.repeat([0.9, 0, 0.9]);",
     one_of_two,
     {0.9, 0, 0.9},
     ON_XZ,
     0,
     0.045,
     false},
    {"counted on one axis",
     BALLS "show part.repeat([1, 0, 1], [4, 1, 0]);",
     all_balls,
     {1, 0, 1},
     {0, 0, -ENDLESS},
     {3, 0, ENDLESS},
     -1.5,
     0.4,
     true},
    {"rows in cells",
     WAVE "def part(cell) = sphere(0.05 + 0.09 * wave(cell)).repeat([0.3, 0, 0], [3, 1, 1]);\n"
          "show part.repeat([1, 0, 0]);",
     rows,
     {1, 0, 0},
     ON_X,
     0,
     0.055,
     false},
    {"rings of many",
     WAVE "def part(cell) = union([sphere(0.05).move((0.2 + 0.2 * wave(cell)) *\n"
          "    [cos(18deg * i), 0, sin(18deg * i)]) for i in 0..20]);\n"
          "show part.repeat([0.92, 0, 0.92]);",
     ring,
     {0.92, 0, 0.92},
     ON_XZ,
     0,
     0.3,
     false},
    {"each cell by itself",
     WAVE "def part(cell) = let c = cell - [3, 0, 3] in\n"
          "    if true then sphere(0.02 + 0.46 * pow(wave(c), 6)) else box([1, 1, 1]);\n"
          "show part.repeat([1, 0, 1], [7, 1, 7]);",
     all_balls,
     {1, 0, 1},
     {-3, 0, -3},
     {3, 0, 3},
     0,
     10,
     false},
};
enum { SOLIDS = sizeof solids / sizeof *solids };

/* ---- the truth ---- */

static int clamp_to(int number, int low, int high)
{
    return number < low ? low : number > high ? high : number;
}

static double at_cell(const Solid *solid, Vec p, Cell cell)
{
    return solid->part(vec(p.x - solid->period[0] * cell.i[0] - solid->shift,
                           p.y - solid->period[1] * cell.i[1], p.z - solid->period[2] * cell.i[2]),
                       cell);
}

/* Returns the cell of a point; on axes that do not repeat 0. */
static Cell cell_of(const Solid *solid, Vec p)
{
    const double at[3] = {p.x - solid->shift, p.y, p.z};
    Cell         cell;
    for (int k = 0; k < 3; k++) {
        double ratio = solid->period[k] > 0 ? floor(at[k] / solid->period[k] + 0.5) : 0;
        cell.i[k]    = clamp_to((int)ratio, solid->first[k], solid->last[k]);
    }
    return cell;
}

/* Returns the least of the cells up to so many away; `side`: of these only those on the side of the
   point. */
static double min_around(const Solid *solid, Vec p, int away, bool side)
{
    const double at[3] = {p.x - solid->shift, p.y, p.z};
    Cell         own = cell_of(solid, p), low = own, high = own;
    double       least = HUGE_VAL;
    for (int k = 0; k < 3; k++) {
        double local = at[k] - solid->period[k] * own.i[k];
        low.i[k]     = clamp_to(own.i[k] - (side && local >= 0 ? 0 : away), solid->first[k],
                                solid->last[k]);
        high.i[k]    = clamp_to(own.i[k] + (side && local < 0 ? 0 : away), solid->first[k],
                                solid->last[k]);
    }
    for (int i = low.i[0]; i <= high.i[0]; i++)
        for (int j = low.i[1]; j <= high.i[1]; j++)
            for (int k = low.i[2]; k <= high.i[2]; k++)
                least = fmin(least, at_cell(solid, p, (Cell){{i, j, k}}));
    return least;
}

static double truth(const Solid *solid, Vec p) { return min_around(solid, p, 3, false); }

static bool inside(const void *user, Vec p) { return truth(user, p) <= 0; }

/* ---- tests ---- */

enum { HALF = 4, POINTS = 4000 };

/* Near the cells, which lie along one axis, in a plane or everywhere. */
static Vec random_point(const Solid *solid, Random *random)
{
    Vec p = random_in_cube(random, HALF);
    return vec(p.x, p.y * (solid->period[1] > 0 ? 1 : 0.2), p.z * (solid->period[2] > 0 ? 1 : 0.2));
}

static void is_safe(void **state)
{
    const Solid *solid   = *state;
    Product      product = product_compile(solid->text);
    Trial        trial = {product_field, &product, inside, solid, vec(0.2, 0, 0.1), HALF, 300, 17};
    judge_acquits(&trial, solid->name);
    product_free(&product);
}

static void is_the_union(void **state)
{
    const Solid *solid   = *state;
    Product      product = product_compile(solid->text);
    Random       random  = {23};
    int          near = 0, beyond = 0;
    for (int i = 0; i < POINTS; i++) {
        Vec    p             = random_point(solid, &random);
        double true_distance = truth(solid, p), found = product_distance(&product, p);
        bool   right = found <= true_distance + 1e-9;
        if (true_distance > 0 && true_distance < solid->near) {
            near++;
            right = right && found >= true_distance - 1e-9;
        }
        if (!right)
            fail_msg("%s: %.9g at %g %g %g, where the union has %.9g", solid->name, found, p.x, p.y,
                     p.z, true_distance);
        beyond += min_around(solid, p, 1, true) > true_distance + 1e-3;
    }
    assert_true(near > 50);
    if (solid->far_is_nearest && beyond == 0)
        fail_msg("%s: two cells are always enough", solid->name);
    product_free(&product);
}

/* Numbers and colours of cells without end are those of cells that are made one by one. */
static void cells_are_alike(void **state)
{
    (void)state;
    static const char part[] =
        "def part(c) = if random(c, 3) < 0.3 then sphere(0.4 * random(c)).paint([random(c), 0, "
        "0])\n"
        "    else box([0.3 + 0.3 * random(c), 0.5, 0.3]).rotate([0, 1, 0], random(c, 1))\n"
        "    .paint([random(c, 2), 0.5 + 0.5 * random_direction(c).z, random([c.x, c.z])]);\n";
    Product endless = product_format("%sshow part.repeat([1, 0, 1]);", part);
    Product counted = product_format("%sdef shifted(c) = part(c - [4, 0, 4]);\n"
                                     "show shifted.repeat([1, 0, 1], [9, 1, 9]);",
                                     part);
    Random  random  = {7};
    int     hits    = 0;
    for (int i = 0; i < 2000; i++) {
        Vec p     = random_in_cube(&random, 3.9);
        p.y       = 0.2 * p.y;
        KrsHit is = product_probe(&endless, p), wanted = product_probe(&counted, p);
        assert_true(is.distance <= wanted.distance + 1e-9);
        if (wanted.distance > 0.05)
            continue;
        hits++;
        assert_true(fabs(is.distance - wanted.distance) < 1e-9);
        for (int k = 0; k < 3; k++)
            assert_true(fabs(is.color[k] - wanted.color[k]) < 1e-6);
    }
    assert_true(hits > 50);
    product_free(&endless);
    product_free(&counted);
}

/* A choice of the state is one shape or the other, in distance and colour. */
static void choices_of_states(void **state)
{
    (void)state;
    Product             product  = product_compile("param big = 0.2 in [0, 1];\n"
                                                                "show if big > 0.5 then sphere(1).paint([1, 0, 0])\n"
                                                                "else if big > 0.1 then box([1, 2, 1]).paint([0, 1, 0])\n"
                                                                "else union([]);");
    static const double values[] = {0.8, 0.2, 0};
    Random              random   = {5};
    for (int i = 0; i < 300; i++) {
        double value = values[i % 3];
        Vec    p     = random_in_cube(&random, 3);
        assert_int_equal(krs_state_set(product.state, "big", &value, 1), KRS_OK);
        KrsHit is     = product_probe(&product, p);
        double wanted = i % 3 == 0 ? ball(p, 1) : bar(p, vec(0.5, 1, 0.5));
        if (i % 3 == 2)
            assert_true(is.distance > 1e6);
        else
            assert_true(fabs(is.distance - wanted) < 1e-12 && is.color[i % 3] == 1);
    }
    product_free(&product);
}

/* What only looks different is as cheap as what does not, and right. */
static void colors_of_cells(void **state)
{
    (void)state;
    Product product = product_compile(
        WAVE "def part(c) = sphere(0.3).paint([wave(c), 0.5, 0]); show part.repeat(1);");
    Product plain  = product_compile("show sphere(0.3).repeat(1);");
    Random  random = {3};
    for (int i = 0; i < 500; i++) {
        Vec    p    = random_in_cube(&random, 5);
        KrsHit is   = product_probe(&product, p);
        Cell   cell = {{(int)floor(p.x + 0.5), (int)floor(p.y + 0.5), (int)floor(p.z + 0.5)}};
        assert_true(is.distance == product_distance(&plain, p));
        assert_true(fabs(is.color[0] - wave(cell)) < 1e-6);
    }
    product_free(&product);
    product_free(&plain);
}

int main(void)
{
    static const struct {
        const char        *what;
        CMUnitTestFunction test;
    } kinds[] = {{"are safe", is_safe}, {"are a union", is_the_union}};
    enum { KINDS = sizeof kinds / sizeof *kinds };
    struct CMUnitTest tests[KINDS * SOLIDS + 3];
    static char       names[KINDS * SOLIDS][64];
    for (size_t i = 0; i < KINDS * SOLIDS; i++) {
        const Solid *solid = &solids[i / KINDS];
        snprintf(names[i], sizeof names[0], "%s %s", solid->name, kinds[i % KINDS].what);
        tests[i] = (struct CMUnitTest){names[i], kinds[i % KINDS].test, NULL, NULL,
                                       (void *)(uintptr_t)solid};
    }
    tests[KINDS * SOLIDS]     = (struct CMUnitTest)cmocka_unit_test(cells_are_alike);
    tests[KINDS * SOLIDS + 1] = (struct CMUnitTest)cmocka_unit_test(colors_of_cells);
    tests[KINDS * SOLIDS + 2] = (struct CMUnitTest)cmocka_unit_test(choices_of_states);
    return _cmocka_run_group_tests("cells", tests, KINDS * SOLIDS + 3, NULL, NULL);
}
