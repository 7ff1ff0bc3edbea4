/*
 * primitives.c: every primitive of the library against its definition.
 *
 * The size of its distance is never above the distance to the nearest point of the surface, and for
 * those that are exact not below it either, outside.
 */
#include "tests/oracle/primitives.h"

enum { PRIMITIVES = SOLIDS + FIGURES, SETS = 3, POINTS = 700 };

static const Primitive *primitive_at(size_t number)
{
    return number < SOLIDS ? &solid_primitives[number] : &figure_primitives[number - SOLIDS];
}

/* `show` of the primitive's text with the arguments in place. */
static void write_call(SceneText *text, const char *call, const double *a)
{
    scene_write(text, "show ");
    for (; *call; call++)
        if (*call == '$')
            scene_write(text, "%.17g", a[*++call - 'a']);
        else
            scene_write(text, "%c", *call);
    scene_write(text, ";\n");
}

/* Arguments from their ranges, and the definition made from them. */
static Solid random_solid(const Primitive *primitive, Random *random)
{
    Solid solid = {0};
    for (int i = 0; i < ARGUMENTS; i++)
        solid.a[i] = random_between(random, primitive->range[i][0], primitive->range[i][1]);
    primitive->make(&solid);
    return solid;
}

static bool ball_has(const Primitive *primitive, const Solid *solid, Random *random, Vec centre,
                     double radius, bool side)
{
    for (int i = 0; i < 200; i++)
        if (primitive->inside(solid, random_in_ball(random, centre, radius)) == side)
            return true;
    return false;
}

/* The two definitions of a solid, its surface and its inside, are about the same thing: both
   sides meet at the surface, and nowhere else. */
static void definitions_agree(void **state)
{
    (void)state;
    for (size_t k = 0; k < PRIMITIVES; k++) {
        const Primitive *primitive = primitive_at(k);
        Random           random    = {k};
        Solid            solid     = random_solid(primitive, &random);
        Cloud            cloud     = {0};
        primitive->surface(&solid, &cloud, 0.05);
        for (int i = 0; i < 60; i++) {
            Vec on = cloud.points[random_below(&random, (int)cloud.count)];
            if (!ball_has(primitive, &solid, &random, on, 1e-3, true) ||
                !ball_has(primitive, &solid, &random, on, 1e-3, false))
                fail_msg("%s: (%g, %g, %g) is not on the surface", primitive->name, on.x, on.y,
                         on.z);
            Vec    off    = random_in_cube(&random, 1.5);
            double radius = cloud_nearest(&cloud, off) - cloud.spacing;
            bool   side   = primitive->inside(&solid, off);
            if (radius > 0 && ball_has(primitive, &solid, &random, off, radius, !side))
                fail_msg("%s: a surface near (%g, %g, %g) is missing", primitive->name, off.x,
                         off.y, off.z);
        }
        cloud_free(&cloud);
    }
}

/* |distance| <= nearest point, and, for exact ones and outside, no less than the spacing of the
   cloud allows. */
static void check_brackets(const Primitive *primitive, const Product *product, bool exact,
                           const Solid *solid, Random *random)
{
    Cloud cloud = {0};
    primitive->surface(solid, &cloud, 0.025);
    assert_true(cloud.count > 500 && cloud.spacing < 0.2);
    for (int i = 0; i < POINTS; i++) {
        Vec    point    = random_in_cube(random, i % 2 ? 1 : 2);
        double distance = product_distance(product, point), nearest = cloud_nearest(&cloud, point);
        if (!(fabs(distance) <= nearest + 1e-9))
            fail_msg("%s at (%g, %g, %g): %.9g, but a point of it is %.9g away", primitive->name,
                     point.x, point.y, point.z, distance, nearest);
        if (exact && distance > 0 && !(distance >= nearest - cloud.spacing))
            fail_msg("%s at (%g, %g, %g): %.9g is not exact: %.9g", primitive->name, point.x,
                     point.y, point.z, distance, nearest);
    }
    cloud_free(&cloud);
}

/* Outside of a union of balls the distance is known to more digits. */
static void check_sweep(const Primitive *primitive, const Product *product, bool exact,
                        const Solid *solid, Random *random)
{
    for (int i = 0; i < POINTS; i++) {
        Vec    point    = random_in_cube(random, 2);
        double distance = product_distance(product, point);
        double truth    = sweep_depth(&solid->sweep, point);
        if (truth > 0 && !(distance <= truth + 1e-7 && (!exact || distance >= truth - 1e-7)))
            fail_msg("%s at (%g, %g, %g): %.9g, truly %.9g", primitive->name, point.x, point.y,
                     point.z, distance, truth);
    }
}

static void primitive_is_its_definition(void **state)
{
    size_t           number    = *(size_t *)*state;
    const Primitive *primitive = primitive_at(number);
    Random           random    = {number};
    for (int set = 0; set < SETS; set++) {
        Solid     solid = random_solid(primitive, &random);
        SceneText text  = {.length = 0};
        write_call(&text, primitive->text, solid.a);

        Product      product = product_compile(text.bytes);
        KrsComponent component;
        assert_int_equal(krs_component(product.scene, 0, &component), KRS_OK);
        bool exact = primitive->exact || component.exact;
        check_brackets(primitive, &product, exact, &solid, &random);
        if (solid.sweep.curve_count)
            check_sweep(primitive, &product, exact, &solid, &random);
        Trial trial = {product_field, &product, primitive->inside, &solid, vec(0, 0, 0), 1.8,
                       POINTS,        77};
        judge_acquits(&trial, text.bytes);
        if (exact)
            judge_refutes_larger(&trial, 1.15, text.bytes);
        product_free(&product);
    }
}

static bool negative(const void *product, Vec p) { return product_distance(product, p) <= 0; }

/* How a tapered arc goes from one radius to the other is its own affair, within limits: the
   surface is never farther than a third of the change from that of the linear one. */
static void tapered_arcs(void **state)
{
    (void)state;
    Random random = {78};
    for (int set = 0; set < 6; set++) {
        Vec from = random_in_cube(&random, 0.3), via = random_in_cube(&random, 0.3);
        Vec to = random_in_cube(&random, 0.3);
        from.y -= 0.7;
        to.y += 0.7;
        double radius = random_between(&random, 0.1, 0.3), end = random_between(&random, 0.02, 0.1);
        Sweep  sweep    = {.curves      = {curve_arc(from, via, to)},
                           .curve_count = 1,
                           .radius      = radius,
                           .radius_end  = end};
        Product product = product_format(
            "show arc_capsule([%.17g, %.17g, %.17g], [%.17g, %.17g, %.17g], [%.17g, %.17g, %.17g],"
            " %.17g, %.17g);",
            from.x, from.y, from.z, via.x, via.y, via.z, to.x, to.y, to.z, radius, end);
        Trial trial = {product_field, &product, negative, &product, vec(0, 0, 0), 1.5, POINTS, 79};
        judge_acquits(&trial, "tapered arc");
        product_keeps_claim(&product, "tapered arc", 1.5, 80);
        for (int i = 0; i < POINTS; i++) {
            Vec    point = random_in_cube(&random, 1.2);
            double depth = sweep_depth(&sweep, point), slack = (radius - end) / 3;
            double distance = product_distance(&product, point);
            assert_true(depth <= slack || distance > 0);
            assert_true(depth >= -slack || distance < 0);
        }
        product_free(&product);
    }
}

/* All names of the language reference, with nothing said about their sizes. */
static const char *const solids[] = {
    "sphere",      "box",          "cylinder",    "cone",           "capped_cone", "capsule",
    "round_cone",  "arc_capsule",  "torus",       "ellipsoid",      "link",        "octahedron",
    "tetrahedron", "dodecahedron", "icosahedron", "prism",          "pyramid",     "wedge",
    "plane",       "half_space",   "convex",      "bezier_capsule", "helix",       "thread",
};

static const char *const figures[] = {"circle", "rectangle", "polygon", "regular",
                                      "star",   "segment",   "arc",     "bezier"};

/* With its defaults a shape is somewhere solid, somewhere not, and no steeper than distance. */
static void check_default(const char *name, const char *rest)
{
    Product product = product_format("show %s()%s;", name, rest);
    Random  random  = {12};
    int     inside = 0, outside = 0;
    for (int i = 0; i < 4000; i++) {
        Vec    a = random_in_cube(&random, 1.5), b = random_in_ball(&random, a, 0.5);
        double at_a = product_distance(&product, a), at_b = product_distance(&product, b);
        inside += at_a < 0;
        outside += at_a > 0;
        if (!(fabs(at_a - at_b) <= vec_distance(a, b) * (1 + 1e-9) + 1e-12))
            fail_msg("%s()%s rises too fast", name, rest);
    }
    if (inside == 0 || outside == 0)
        fail_msg("%s()%s: %d points inside, %d outside", name, rest, inside, outside);
    product_free(&product);
}

static void defaults_are_shapes(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof solids / sizeof *solids; i++)
        check_default(solids[i], "");
    for (size_t i = 0; i < sizeof figures / sizeof *figures; i++) {
        check_default(figures[i], ".extrude(0.5)");
        check_default(figures[i], ".revolve(0.5)");
    }
}

int main(void)
{
    static size_t     numbers[PRIMITIVES];
    struct CMUnitTest tests[PRIMITIVES + 3];
    size_t            count = 0;
    tests[count++]          = (struct CMUnitTest)cmocka_unit_test(definitions_agree);
    for (size_t i = 0; i < PRIMITIVES; i++) {
        numbers[i]     = i;
        tests[count++] = (struct CMUnitTest){primitive_at(i)->name, primitive_is_its_definition,
                                             NULL, NULL, &numbers[i]};
    }
    tests[count++] = (struct CMUnitTest)cmocka_unit_test(tapered_arcs);
    tests[count++] = (struct CMUnitTest)cmocka_unit_test(defaults_are_shapes);
    return _cmocka_run_group_tests("primitives", tests, count, NULL, NULL);
}
