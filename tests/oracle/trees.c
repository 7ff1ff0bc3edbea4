/*
 * trees.c: the families of the library (compiler/library/std/).
 *
 * Every function compiles with its defaults and makes as many copies in as many mirrors as it says.
 * A tree is held against its branches: the circle through three points, found here in a way of its
 * own, mirrored one by one, is inside of the wood all along, so that no branch hangs in the air.
 */
#include "tests/oracle/product.h"

/* ---- what each function makes ---- */

typedef struct Family {
    const char *file, *shape;
    uint32_t    levels;
    double      instances; /* 0: not counted */
} Family;

static const Family families[] = {
    /* n branches on the path: n - 1 mirrors, 2^n - 1 branches; four leaves at two forks each. */
    {"trees", "branches()", 10, 2047},
    {"trees", "leaves()", 10, 4 * (1024 + 512)},
    {"trees", "leaves(leaf: sphere(0.1), leafy: 1)", 10, 1024},
    {"trees", "tree()", 10, 2047 + 4 * (1024 + 512)},
    {"trees", "tree_of(growth(levels: 7))", 6, 127 + 4 * (64 + 32)},
    {"trees", "spray(3)", 3, 8},
    {"trees", "forest(sphere(1), levels: 7)", 7, 128},
    {"trees", "forest(sphere(1), levels: 3, dense: 0.5, lean: 4deg)", 3, 8},
    {"trees", "forest()", 6, 64 * (2047 + 4 * (1024 + 512))},
    {"nature", "tuft()", 0, 0},
    {"nature", "grass(levels: 9)", 9, 512},
    {"nature", "palm_leaf()", 0, 0},
    {"nature", "rosette(sphere(1), levels: 3)", 3, 16},
    {"nature", "palm()", 3, 16},
    {"nature", "fern_leaf()", 11, 65 * 64 + 1},
    {"nature", "fern()", 3, 16 * (65 * 64 + 1)},
    {"nature", "coral(levels: 6)", 5, 63},
    {"nature", "sea_fan(levels: 6)", 5, 63},
    {"nature", "fish()", 0, 0},
    {"nature", "school(levels: 8)", 8, 256},
    {"nature", "rock()", 12, 4096},
    {"terrain", "terrain()", 0, 0},
};

static void families_make_what_they_say(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof families / sizeof *families; i++) {
        const Family *family  = &families[i];
        Product       product = product_format("use \"std/%s.krs\"; show %s;", family->file,
                                               family->shape);
        KrsComponent  component;
        assert_int_equal(krs_component_count(product.scene), 1);
        assert_int_equal(krs_component(product.scene, 0, &component), KRS_OK);
        print_message("# %s: %u levels, %.0f instances\n", family->shape, component.levels,
                      component.instances);
        assert_int_equal(component.levels, family->levels);
        if (family->instances > 0)
            assert_true(component.instances == family->instances);
        /* All of them are bounded: they can be framed, and copied on. */
        for (int axis = 0; axis < 3; axis++)
            assert_true(isfinite(component.low[axis]) && isfinite(component.high[axis]));
        product_free(&product);
    }
}

/* ---- branches meet ---- */

enum { BRANCHES = 4, STEPS = 64 };

static const Vec forks[BRANCHES + 1] = {
    {0, 0, 0}, {0, 2, 0.1}, {0.5, 3, 0.3}, {0.9, 3.6, 0.2}, {1.1, 3.9, 0.4}};
static const Vec    bends[BRANCHES]  = {{0.1, 1, 0}, {0.1, 2.4, 0}, {0.8, 3.2, 0.4}, {1, 3.8, 0.2}};
static const double widths[BRANCHES] = {0.3, 0.16, 0.09, 0.05};
static const Vec    normals[BRANCHES - 1] = {{1, 0.1, 0.3}, {0.2, 1, 0.4}, {-1, 0.3, 0.2}};

static void write_points(SceneText *text, const char *name, const Vec *points, int count)
{
    scene_write(text, "%s: [", name);
    for (int i = 0; i < count; i++)
        scene_write(text, "[%.17g, %.17g, %.17g],", points[i].x, points[i].y, points[i].z);
    scene_write(text, "], ");
}

static Product compile_tree(void)
{
    static SceneText text;
    text.length = 0;
    scene_write(&text, "use \"std/trees.krs\"; show branches(");
    write_points(&text, "forks", forks, BRANCHES + 1);
    write_points(&text, "bend", bends, BRANCHES);
    write_points(&text, "normals", normals, BRANCHES - 1);
    scene_write(&text, "width: [%g, %g, %g, %g]);", widths[0], widths[1], widths[2], widths[3]);
    return product_compile(text.bytes);
}

/* Returns the centre of the circle through three points, from its barycentric coordinates. */
static Vec circle_centre(Vec a, Vec b, Vec c)
{
    double along_a = pow(vec_distance(b, c), 2), along_b = pow(vec_distance(c, a), 2),
           along_c = pow(vec_distance(a, b), 2);
    double of_a    = along_a * (along_b + along_c - along_a),
           of_b    = along_b * (along_c + along_a - along_b),
           of_c    = along_c * (along_a + along_b - along_c);
    Vec sum        = vec_add(vec_add(vec_scale(of_a, a), vec_scale(of_b, b)), vec_scale(of_c, c));
    return vec_scale(1 / (of_a + of_b + of_c), sum);
}

/* The point at the share t of the way along the arc from a by b to c. */
static Vec arc_point(Vec a, Vec b, Vec c, double t)
{
    Vec    centre = circle_centre(a, b, c);
    Vec    from = vec_sub(a, centre), axis = vec_unit(vec_cross(vec_sub(b, a), vec_sub(c, b)));
    Vec    lateral = vec_cross(axis, from), to = vec_sub(c, centre);
    double angle = atan2(vec_dot(to, lateral), vec_dot(to, from));
    if (angle < 0)
        angle += 2 * acos(-1);
    return vec_add(centre, vec_rotate(from, axis, t * angle));
}

/* Returns the mirror through fork i, the next fork on the side that stays. */
static Half mirror_at(int i)
{
    Half half = {vec_unit(normals[i - 1]), 0};
    if (vec_dot(half.normal, vec_sub(forks[i + 1], forks[i])) > 0)
        half.normal = vec_scale(-1, half.normal);
    half.offset = vec_dot(half.normal, forks[i]);
    return half;
}

/* A point's image for a choice of mirrors, from fork i down; false: a mirror cuts it off. */
static bool image_of(Vec *point, int i, unsigned choice)
{
    for (; i >= 1; i--) {
        Half   half   = mirror_at(i);
        double excess = half_excess(half, *point);
        if (excess > 1e-12)
            return false;
        if (choice >> (i - 1) & 1)
            *point = vec_sub(*point, vec_scale(2 * excess, half.normal));
    }
    return true;
}

static void branches_are_inside_all_along(void **state)
{
    (void)state;
    Product tree  = compile_tree();
    int     there = 0, cut = 0;
    for (int branch = 0; branch < BRANCHES; branch++)
        for (unsigned choice = 0; choice < 1u << branch; choice++)
            for (int step = 0; step <= STEPS; step++) {
                Vec point = arc_point(forks[branch], bends[branch], forks[branch + 1],
                                      (double)step / STEPS);
                if (!image_of(&point, branch, choice)) {
                    cut++;
                    continue;
                }
                there++;
                /* As deep as the thinner end is wide, less what the bound of a taper costs. */
                double thin = widths[branch < BRANCHES - 1 ? branch + 1 : branch];
                assert_true(product_distance(&tree, point) <= -0.7 * thin);
            }
    print_message("# %d points on branches, %d cut off\n", there, cut);
    assert_true(there > 12 * STEPS && cut < there / 4);
    product_free(&tree);
}

/* The leaf's origin is the twig's tip: a small ball for a leaf is there, and at its images. */
static void leaves_are_at_the_tips(void **state)
{
    (void)state;
    Product leaf = product_format(
        "use \"std/trees.krs\"; show leaves(forks: [[0, 0, 0], [0, 1, 0], [0.3, 2, 0.1]],"
        "bend: [[0.1, 0.5, 0], [0.1, 1.5, 0]], normals: [[1, 0, 0]], leafy: 1,"
        "leaf: capsule([0, 0, 0], [0, 0.4, 0], radius: 0.01));");
    Vec tip = vec(0.3, 2, 0.1), twin = vec(-0.3, 2, 0.1);
    assert_true(fabs(product_distance(&leaf, tip) + 0.01) < 1e-9);
    assert_true(fabs(product_distance(&leaf, twin) + 0.01) < 1e-9);
    /* It goes on as the twig arrives: along the tangent of the circle. */
    Vec from = vec(0, 1, 0), via = vec(0.1, 1.5, 0);
    Vec before = arc_point(from, via, tip, 1 - 1e-6);
    Vec on     = vec_add(tip, vec_scale(0.4, vec_unit(vec_sub(tip, before))));
    assert_true(fabs(product_distance(&leaf, on) + 0.01) < 1e-5);
    product_free(&leaf);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(families_make_what_they_say),
        cmocka_unit_test(branches_are_inside_all_along),
        cmocka_unit_test(leaves_are_at_the_tips),
    };
    return cmocka_run_group_tests_name("families of the library", tests, NULL, NULL);
}
