/*
 * nothing.c: unions without parts, among figures and among solids, against a disc that is known.
 */
#include "tests/oracle/product.h"

/* What has no parts goes with figures as well as with solids, and changes nothing. */
static void nothing_is_a_figure_and_a_solid(void **state)
{
    static const char *const of_nothing[] = {
        "(union([]) | circle(0.6)).extrude(0.8)",
        "(circle(0.6) | union([])).extrude(0.8)",
        "(circle(0.6) - union([])).extrude(0.8)",
        "union([union([]), circle(0.6), union([], union([]))]).extrude(0.8)",
        "union(union([]).move([1, 2]).rotate(0.3).scale([2, 3]), circle(0.6)).extrude(0.8)",
        "circle(0.6).extrude(0.8) | union([]).extrude(3)",
        "circle(0.6).extrude(0.8) - union([]).offset(0.1).revolve(2)",
        "union([circle(0.6).extrude(0.8), union([circle(1) for i in 0..0]).extrude(1)])",
        "(if 1 > 2 then circle(2) else union([]) | circle(0.6)).extrude(0.8)",
        "union(circle(0.6).extrude(0.8), (union([]) & circle(0.6)).extrude(1), blend: 0)",
        "hull(union([]), circle(0.6).extrude(0.8))",
        "hull(circle(0.6), union([])).extrude(0.8)",
        "circle(0.6).extrude(0.8) - union(union([]), union([]), blend: 0.1).extrude(1)",
    };
    Random random = {8};
    (void)state;
    for (size_t i = 0; i < sizeof of_nothing / sizeof *of_nothing; i++) {
        Product product = product_format("show %s;", of_nothing[i]);
        for (int k = 0; k < 100; k++) {
            Vec    p    = random_in_cube(&random, 1);
            double side = hypot(p.x, p.y) - 0.6, end = fabs(p.z) - 0.4;
            if ((product_distance(&product, p) < 0) != (fmax(side, end) < 0))
                fail_msg("%s at (%g, %g, %g)", of_nothing[i], p.x, p.y, p.z);
        }
        product_free(&product);
    }
    Product alone = product_compile("show union([]).extrude(1); show sphere(0.5);");
    if (!(fabs(product_distance(&alone, vec(0, 0, 2)) - 1.5) < 1e-6))
        fail_msg("an extrusion of nothing changes the distance of a ball");
    product_free(&alone);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(nothing_is_a_figure_and_a_solid)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
