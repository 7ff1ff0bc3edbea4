/*
 * hulls.c: hulls against what defines them.  The signed distance to a convex set is the greatest
 * height of a point above a plane that touches the set, over all directions.  Here directions are tried,
 * thousands of them, and those that are best are improved; nothing is known of faces and edges.
 */
#include <stdio.h>

#include "tests/oracle/product.h"

static const double PI = 3.14159265358979323846, TOLERANCE = 2e-5;

enum { MAX_ITEMS = 12, DIRECTIONS = 600, BEST = 6, POINTS = 24 };

typedef enum ItemKind {
    BALL,
    BOX,
    CAPSULE,
    OCTAHEDRON,
    SPATIAL_KINDS,
    CYLINDER = SPATIAL_KINDS,
    RING
} ItemKind;

/* One part of a hull, turned and then moved. */
typedef struct Item {
    ItemKind kind;
    Vec      size, axis, shift;
    double   angle;
    Vec      x, y, z; /* its own axes, see item_turn */
} Item;

typedef struct Items {
    Item   items[MAX_ITEMS];
    int    count;
    double grown;
    bool   plane; /* discs and rectangles, seen from above */
} Items;

/* ---- the truth ---- */

static void item_turn(Item *item)
{
    item->x = vec_rotate(vec(1, 0, 0), item->axis, item->angle);
    item->y = vec_rotate(vec(0, 1, 0), item->axis, item->angle);
    item->z = vec_rotate(vec(0, 0, 1), item->axis, item->angle);
}

static double item_support(const Item *item, Vec u)
{
    Vec    v = vec(vec_dot(u, item->x), vec_dot(u, item->y), vec_dot(u, item->z)), s = item->size;
    double around = hypot(v.x, v.z), most = 0;
    switch (item->kind) {
    case BALL: most = s.x; break;
    case BOX: most = (fabs(v.x) * s.x + fabs(v.y) * s.y + fabs(v.z) * s.z) / 2; break;
    case CAPSULE: most = fabs(v.y) * s.y + s.x; break;
    case OCTAHEDRON: most = s.x * fmax(fabs(v.x), fmax(fabs(v.y), fabs(v.z))); break;
    case CYLINDER: most = s.x * around + fabs(v.y) * s.y / 2; break;
    case RING: most = s.x * around + s.y; break;
    }
    return most + vec_dot(u, item->shift);
}

static double height_above(const Items *all, Vec point, Vec u)
{
    double most = -HUGE_VAL;
    for (int i = 0; i < all->count; i++)
        most = fmax(most, item_support(&all->items[i], u));
    return vec_dot(u, point) - most - all->grown;
}

static Vec direction(const Items *all, int i)
{
    double turn = PI * (1 + sqrt(5)) * i, z = 1 - (2 * i + 1.0) / DIRECTIONS;
    if (all->plane)
        return vec(cos(2 * PI * i / DIRECTIONS), sin(2 * PI * i / DIRECTIONS), 0);
    return vec(sqrt(1 - z * z) * cos(turn), sqrt(1 - z * z) * sin(turn), z);
}

/* Small turns, as long as some are better; then smaller ones.  They go in all directions, because
   heights have ridges. */
static double improved(const Items *all, Vec point, Vec u, Random *random)
{
    double best = height_above(all, point, u);
    for (double step = 0.08; step > 1e-6;) {
        Vec    found  = u;
        double before = best;
        for (int k = 0; k < 60; k++) {
            Vec turn = random_unit(random);
            if (all->plane)
                turn = vec(-u.y * (k % 2 ? 1 : -1), u.x * (k % 2 ? 1 : -1), 0);
            Vec    tried  = vec_unit(vec_add(u, vec_scale(step, turn)));
            double height = height_above(all, point, tried);
            if (height > best) {
                best  = height;
                found = tried;
            }
        }
        u = found;
        if (best == before)
            step *= 0.7;
    }
    return best;
}

static double true_distance(const Items *all, Vec point)
{
    double best[BEST], most = -HUGE_VAL;
    Vec    from[BEST];
    int    count  = 0;
    Random random = {1};
    for (int i = 0; i < DIRECTIONS; i++) {
        Vec    u      = direction(all, i);
        double height = height_above(all, point, u);
        int    at     = count;
        while (at > 0 && best[at - 1] < height)
            at--;
        if (at == BEST)
            continue;
        count += count < BEST;
        for (int k = count - 1; k > at; k--) {
            best[k] = best[k - 1];
            from[k] = from[k - 1];
        }
        best[at] = height;
        from[at] = u;
    }
    for (int k = 0; k < count; k++)
        most = fmax(most, improved(all, point, from[k], &random));
    return most;
}

/* ---- scenes ---- */

static void write_item(SceneText *text, const Items *all, const Item *item)
{
    static const char *const solids[] = {
        [BALL]       = "sphere(%.17g)",
        [BOX]        = "box([%.17g, %.17g, %.17g])",
        [CAPSULE]    = "capsule([0, -%2$.17g, 0], [0, %2$.17g, 0], %1$.17g)",
        [OCTAHEDRON] = "octahedron(%.17g)",
        [CYLINDER]   = "cylinder(%.17g, %.17g)",
        [RING]       = "torus(%.17g, %.17g)",
    };
    static const char *const figures[] = {"circle(%.17g)", "rectangle([%.17g, %.17g])"};
    char                     name[200];
    Vec                      s = item->size;
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wformat-nonliteral"
    snprintf(name, sizeof name, all->plane ? figures[item->kind] : solids[item->kind], s.x, s.y,
             s.z);
#pragma GCC diagnostic pop
    scene_write(text, "%s.rotate([%.17g, %.17g, %.17g], %.17g).move([%.17g, %.17g, %.17g])", name,
                item->axis.x, item->axis.y, item->axis.z, item->angle, item->shift.x, item->shift.y,
                item->shift.z);
}

static Product hull_product(const Items *all)
{
    SceneText text = {.length = 0};
    scene_write(&text, "show hull(");
    for (int i = 0; i < all->count; i++) {
        scene_write(&text, i ? ",\n    " : "");
        write_item(&text, all, &all->items[i]);
    }
    scene_write(&text, ", radius: %.17g)%s;", all->grown, all->plane ? ".extrude(100)" : "");
    return product_compile(text.bytes);
}

/* The distance is the true one; one that is larger by a hundredth would be found out. */
static void check_hull(Items *all, const char *what, uint64_t seed)
{
    for (int i = 0; i < all->count; i++)
        item_turn(&all->items[i]);
    Product product = hull_product(all);
    Random  random  = {seed};
    int     larger  = 0;
    for (int i = 0; i < POINTS; i++) {
        Vec point = random_in_cube(&random, 3);
        if (all->plane)
            point.z = 0;
        double found = product_distance(&product, point), truth = true_distance(all, point);
        larger += fabs(1.01 * found - truth) > TOLERANCE;
        if (!(fabs(found - truth) < TOLERANCE))
            fail_msg("%s, %d parts, at (%g, %g, %g): %.7g, truly %.7g", what, all->count, point.x,
                     point.y, point.z, found, truth);
    }
    assert_true(larger > POINTS / 2);
    product_free(&product);
}

static Item random_item(Random *random, ItemKind kind)
{
    return (Item){.kind  = kind,
                  .size  = vec(random_between(random, 0.1, 0.8), random_between(random, 0.1, 0.8),
                               random_between(random, 0.1, 0.8)),
                  .axis  = random_unit(random),
                  .shift = random_in_cube(random, 1.2),
                  .angle = random_between(random, 0, 6)};
}

static Item ball(double radius, Vec centre)
{
    return (Item){.kind = BALL, .size = vec(radius, 0, 0), .axis = vec(0, 1, 0), .shift = centre};
}

/* ---- tests ---- */

static void balls_have_their_hull(void **state)
{
    (void)state;
    Random random = {3};
    for (int count = 1; count <= 9; count++) {
        Items all = {.count = count};
        for (int i = 0; i < count; i++)
            all.items[i] = random_item(&random, BALL);
        check_hull(&all, "balls", 10 + (uint64_t)count);
    }
}

static void solids_have_their_hull(void **state)
{
    (void)state;
    Random random = {4};
    for (int trial = 0; trial < 8; trial++) {
        Items all = {.count = 2 + trial % 3, .grown = trial % 2 ? 0.2 : 0};
        for (int i = 0; i < all.count; i++)
            all.items[i] = random_item(&random, (ItemKind)((trial + i) % SPATIAL_KINDS));
        check_hull(&all, "solids", 30 + (uint64_t)trial);
    }
}

/* Many tangent planes are the same, or balls touch from inside. */
static void special_places_have_their_hull(void **state)
{
    (void)state;
    Items plate = {.count = 4}, row = {.count = 4}, nested = {.count = 4}, ring = {.count = 9};
    for (int i = 0; i < 4; i++) {
        plate.items[i]  = ball(0.2, vec(i / 2, i % 2, 0));
        row.items[i]    = ball(0.5 - 0.1 * i, vec(0.5 * i, 0, 0));
        nested.items[i] = ball(1 - 0.25 * i, vec(0.25 * i, 0, 0));
    }
    check_hull(&plate, "a plate", 50);
    check_hull(&row, "a row of balls", 51);
    check_hull(&nested, "balls that touch from inside", 52);
    for (int i = 0; i < 8; i++) /* a ball is seen on both sides of a ring of them */
        ring.items[i] = ball(0.1, vec(1.5 * cos(PI * i / 4), 0, 1.5 * sin(PI * i / 4)));
    ring.items[8] = ball(0.9, vec(0, 0, 0));
    check_hull(&ring, "a ball in a ring", 53);
}

/* One after the other on an axis, or side by side. */
static void round_solids_have_their_hull(void **state)
{
    (void)state;
    Random random = {6};
    for (int trial = 0; trial < 6; trial++) {
        Items all  = {.count = 3, .grown = trial % 2 ? 0.1 : 0};
        Vec   turn = random_unit(&random), up = vec_rotate(vec(0, 1, 0), turn, 1),
            side = vec_across(up);
        for (int i = 0; i < 3; i++) {
            Item item  = random_item(&random, i == 2 && trial < 3   ? BALL
                                              : i == 1 && trial < 3 ? RING
                                                                    : CYLINDER);
            item.axis  = turn;
            item.angle = 1;
            item.shift = vec_scale(random_between(&random, -1, 1), trial < 3 ? up : side);
            if (trial >= 3)
                item.size.y = 0.7;
            all.items[i] = item;
        }
        if (trial >= 3)
            all.items[2].kind = BOX; /* turned like the columns */
        check_hull(&all, trial < 3 ? "solids of one axis" : "columns", 60 + (uint64_t)trial);
    }
}

static void figures_have_their_hull(void **state)
{
    (void)state;
    Random random = {7};
    for (int trial = 0; trial < 6; trial++) {
        Items all = {.count = 1 + trial, .grown = trial % 2 ? 0.1 : 0, .plane = true};
        for (int i = 0; i < all.count; i++) {
            Item *item    = &all.items[i];
            *item         = random_item(&random, i % 2 ? BOX : BALL);
            item->axis    = vec(0, 0, 1);
            item->shift.z = 0;
            item->size.z  = 0;
        }
        check_hull(&all, "figures", 70 + (uint64_t)trial);
    }
}

/* What the library says that its convex shapes are the hull of. */
static void convex_shapes_are_their_own_hull(void **state)
{
    (void)state;
    static const char *const shapes[] = {
        "sphere(0.7)",
        "box([1, 0.5, 0.7])",
        "cylinder(0.6, 0.9)",
        "cone(0.7, 1.2)",
        "capped_cone(0.8, 0.3, 0.7)",
        "capsule([-0.3, 0, 0.1], [0.5, 0.2, 0], 0.3)",
        "round_cone([-0.3, 0, 0.1], [0.5, 0.2, 0], 0.4, 0.2)",
        "octahedron(0.8)",
        "tetrahedron(0.9)",
        "dodecahedron(0.8)",
        "icosahedron(0.8)",
        "prism(5, 0.7, 0.6)",
        "pyramid(0.9, 0.8)",
        "hull([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], 0.1)",
        "hull(sphere(0.4), sphere(0.2).move([0.5, 0, 0.3]))",
        "box([1, 0.5, 0.7]).round(0.1)",
        "box([1, 1, 1]).scale([0.5, 1, 0.7])",
        "circle(0.6).extrude(0.5)",
        "rectangle([0.5, 0.8]).extrude(0.5)",
        "regular(5, 0.7).extrude(0.5)",
        "polygon([[0, 0], [0.8, 0.1], [0.3, 0.7]]).extrude(0.5)",
        "segment([0, 0], [0.7, 0.3], 0.4).extrude(0.5)",
        "hull(circle(0.3), circle(0.5).move([0.6, 0])).extrude(0.5)"};
    Random random = {8};
    for (size_t k = 0; k < sizeof shapes / sizeof *shapes; k++) {
        Product shape = product_format("show %s;", shapes[k]);
        Product hull  = product_format("show hull(%s);", shapes[k]);
        for (int i = 0; i < 100; i++) {
            Vec    point = random_in_cube(&random, 1.3);
            double found = product_distance(&hull, point), own = product_distance(&shape, point);
            if (k == 16 ? (found > 1e-6) != (own > 1e-6) : !(fabs(found - own) < 1e-6))
                fail_msg("%s: its hull is %g away, itself %g", shapes[k], found, own);
        }
        product_free(&shape);
        product_free(&hull);
    }
}

/* The same by a method, of a union, of points with radii, and grown. */
static void hulls_are_written_in_many_ways(void **state)
{
    (void)state;
    static const char *const ways[] = {
        "sphere(0.5).hull(sphere(0.2).move([1, 0, 0]), sphere(0.3).move([0, 1, 0.2]))",
        "(sphere(0.5) | sphere(0.2).move([1, 0, 0]) | sphere(0.3).move([0, 1, 0.2])).hull()",
        "hull([sphere(0.5), sphere(0.2).move([1, 0, 0])], sphere(0.3).move([0, 1, 0.2]))",
        "hull([[0, 0, 0], [1, 0, 0], [0, 1, 0.2]], radius: [0.5, 0.2, 0.3])",
        "hull(sphere(0.4), sphere(0.1).move([1, 0, 0]), sphere(0.2).move([0, 1, 0.2]), radius: "
        "0.1)",
        "hull(sphere(5), sphere(2).move([10, 0, 0]), sphere(3).move([0, 10, 2])).scale(0.1)",
        "hull([[0, 0, 0], [1, 0, 0], [0, 1, 0.2]], radius: [0.4, 0.1, 0.2]).offset(0.1)"};
    Product first  = product_format("show %s;", ways[0]);
    Random  random = {9};
    for (size_t k = 1; k < sizeof ways / sizeof *ways; k++) {
        Product other = product_format("show %s;", ways[k]);
        for (int i = 0; i < 50; i++) {
            Vec point = random_in_cube(&random, 2);
            assert_float_equal(product_distance(&first, point), product_distance(&other, point),
                               1e-6);
        }
        product_free(&other);
    }
    product_free(&first);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(balls_have_their_hull),
        cmocka_unit_test(solids_have_their_hull),
        cmocka_unit_test(special_places_have_their_hull),
        cmocka_unit_test(round_solids_have_their_hull),
        cmocka_unit_test(figures_have_their_hull),
        cmocka_unit_test(convex_shapes_are_their_own_hull),
        cmocka_unit_test(hulls_are_written_in_many_ways),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
