/*
 * deform_bounds.c: what is left of the distance of deformed solids, and what else is known of them:
 * boxes, materials, normals and directions.  A bound that is right and useless would be noticed.
 */
#include "tests/oracle/deformed.h"

#include <stdio.h>

/* ---- how much of the distance is left ---- */

/* A piece of the surface of a solid, moved. */
typedef struct Piece {
    const Deformed *chain;
    int             number;
} Piece;

static Vec solid_point(const Solid *solid, int piece, double u, double v)
{
    Vec    h = solid->half, q = vec(0, 0, 0);
    double a = 2 * PI * u, s = 2 * u - 1, t = 2 * v - 1, side = piece % 2 ? 1 : -1;
    if (solid->kind == SOLID_BALL)
        q = vec(h.x * sin(PI * v) * cos(a), h.x * cos(PI * v), h.x * sin(PI * v) * sin(a));
    else if (solid->kind == SOLID_ROD && piece == 2)
        q = vec(h.x * cos(a), h.y * t, h.x * sin(a));
    else if (solid->kind == SOLID_ROD)
        q = vec(h.x * v * cos(a), h.y * side, h.x * v * sin(a));
    else if (piece / 2 == 0)
        q = vec(h.x * side, h.y * s, h.z * t);
    else if (piece / 2 == 1)
        q = vec(h.x * s, h.y * side, h.z * t);
    else
        q = vec(h.x * s, h.y * t, h.z * side);
    return vec_add(solid->centre, q);
}

static Vec piece_point(const void *user, double u, double v)
{
    const Piece *piece = user;
    Vec          p     = solid_point(&piece->chain->solid, piece->number, u, v);
    for (int i = 0; i < piece->chain->deed_count; i++)
        p = deed_forward(&piece->chain->deeds[i], p);
    return p;
}

static Cloud chain_cloud(const Deformed *chain)
{
    static const int pieces[] = {[SOLID_BOX] = 6, [SOLID_BALL] = 1, [SOLID_ROD] = 3};
    Cloud            cloud    = {0};
    for (int i = 0; i < pieces[chain->solid.kind]; i++) {
        Piece piece = {chain, i};
        cloud_patch(&cloud, piece_point, NULL, &piece, 0.03);
    }
    return cloud;
}

/* The scene's box holds all of it and, where no box had to be turned, is not much larger. */
static void check_box(const Product *product, const Cloud *cloud, const Deformed *chain,
                      const char *text)
{
    Vec    axis = chain->deeds[0].axis;
    double most = chain->deed_count == 1 && fmax(axis.x, fmax(axis.y, axis.z)) == 1 ? 1.7 : 100;
    KrsComponent component;
    Vec          low = vec(HUGE_VAL, HUGE_VAL, HUGE_VAL), high = vec_scale(-1, low);
    assert_int_equal(krs_component(product->scene, 0, &component), KRS_OK);
    for (size_t i = 0; i < cloud->count; i++) {
        Vec p = cloud->points[i];
        low   = vec(fmin(low.x, p.x), fmin(low.y, p.y), fmin(low.z, p.z));
        high  = vec(fmax(high.x, p.x), fmax(high.y, p.y), fmax(high.z, p.z));
    }
    const double *l = component.low, *h = component.high;
    bool          holds = l[0] <= low.x + 1e-9 && l[1] <= low.y + 1e-9 && l[2] <= low.z + 1e-9 &&
                 h[0] >= high.x - 1e-9 && h[1] >= high.y - 1e-9 && h[2] >= high.z - 1e-9;
    double size  = vec_distance(low, high),
           given = vec_distance(vec(l[0], l[1], l[2]), vec(h[0], h[1], h[2]));
    if (!holds || given > most * size)
        fail_msg("the box of %s from (%g, %g, %g) to (%g, %g, %g)%s", text, l[0], l[1], l[2], h[0],
                 h[1], h[2], holds ? " is too large" : " leaves something out");
}

/* Mean of bound over distance, for points within `half`, outside of the solid and not near it. */
static double mean_share(const Product *product, const Deformed *chain, Cloud *cloud, double half,
                         Random *random)
{
    double sum   = 0;
    int    count = 0;
    for (int i = 0; i < 400; i++) {
        Vec    p        = random_in_cube(random, half);
        double distance = cloud_nearest(cloud, p), bound = product_distance(product, p);
        if (fabs(bound) > distance + 1e-9)
            fail_msg("at (%g, %g, %g) %.9g, but a surface point is %.9g away", p.x, p.y, p.z, bound,
                     distance);
        if (deformed_contains(chain, p) || distance < 5 * cloud->spacing)
            continue;
        sum += bound / distance;
        count++;
    }
    return count ? sum / count : 1;
}

typedef struct Shares {
    const char *name;
    int         kind; /* of all deeds; -1: any */
    int         deeds;
    double      near, far; /* at least, on average */
} Shares;

static void bounds_are_of_use(void **state)
{
    const Shares *shares = *state;
    enum { CHAINS = 25 };
    Random random = {107};
    double near = 0, far = 0;
    int    count = 0;
    for (int i = 0; count < CHAINS; i++) {
        Deformed chain = deformed_random(&random, shares->deeds, 0);
        if (shares->kind >= 0 && (int)chain.deeds[0].kind != shares->kind)
            continue;
        SceneText text = {.length = 0};
        deformed_write(&text, &chain, NULL);
        Product product = product_compile(text.bytes);
        Cloud   cloud   = chain_cloud(&chain);
        check_box(&product, &cloud, &chain, text.bytes);
        near += mean_share(&product, &chain, &cloud, 1.5, &random) / CHAINS;
        far += mean_share(&product, &chain, &cloud, 20, &random) / CHAINS;
        count++;
        cloud_free(&cloud);
        product_free(&product);
    }
    printf("# %s: %.3f of the distance near, %.3f far\n", shares->name, near, far);
    assert_true(near >= shares->near && far >= shares->far);
}

/* ---- what a hit knows ---- */

/* Colours are the place and the normal in the space where the paint stands: those of the solid that
   was not deformed. */
static void check_face(const Product *places, const Product *normals, const Deformed *chain,
                       Vec face, Vec normal)
{
    Vec    p     = deed_forward(&chain->deeds[0], face);
    KrsHit place = product_probe(places, p), hit = product_probe(normals, p);
    Vec    seen  = vec(hit.color[0], hit.color[1], hit.color[2]);
    Vec    where = vec(place.color[0] - 0.5, place.color[1] - 0.5, place.color[2] - 0.5);
    assert_true(vec_distance(vec_scale(2, where), face) < 1e-6);
    assert_true(vec_distance(vec_sub(vec_scale(2, seen), vec(1, 1, 1)), normal) < 2e-3);
}

static void materials_see_the_solid(void **state)
{
    (void)state;
    Random random = {110};
    for (int i = 0; i < 40; i++) {
        Deformed chain     = {.deed_count = 1, .before = 1};
        chain.solid        = (Solid){SOLID_BOX, {0, 0, 0}, {0.3, 0.8, 0.4}};
        chain.deeds[0]     = deed_random(&random, &chain.solid, true);
        SceneText texts[2] = {{.length = 0}, {.length = 0}};
        for (int k = 0; k < 2; k++) {
            scene_write(&texts[k], "show box([0.6, 1.6, 0.8]).paint(%s)",
                        k ? "0.5 + 0.5 * normal" : "0.5 + 0.5 * p");
            deed_write(&texts[k], &chain.deeds[0], NULL);
            scene_write(&texts[k], ";");
        }
        Product places = product_compile(texts[0].bytes), normals = product_compile(texts[1].bytes);
        for (int face = 0; face < 6; face++) {
            double u = random_between(&random, -0.9, 0.9), v = random_between(&random, -0.9, 0.9);
            double side = face % 2 ? 1 : -1;
            Vec    h    = chain.solid.half;
            Vec    p    = face / 2 == 0   ? vec(h.x * side, h.y * u, h.z * v)
                          : face / 2 == 1 ? vec(h.x * u, h.y * side, h.z * v)
                                          : vec(h.x * u, h.y * v, h.z * side);
            Vec    n    = vec_scale(side, vec(face / 2 == 0, face / 2 == 1, face / 2 == 2));
            check_face(&places, &normals, &chain, p, n);
        }
        product_free(&places);
        product_free(&normals);
    }
}

/* Where smooth mirrors change nothing, light sees the normal that there is: it has gone into the
   space of the kernels and come out again. */
static void normals_come_out_again(void **state)
{
    static const char *const deeds[] = {
        ".twist([0, 1, 0], 0.9)",         ".bend([1, 0, 0], 0.5)",
        ".bend([0, 0, 1], 0.9)",          ".taper([0, 1, 0], 1, 0.4)",
        ".displace(sin(4 * x + y), 0.1)", ".taper([1, 0, 0], 0.5, 1.2).twist([1, 1, 0], 0.7)"};
    (void)state;
    Random random = {111};
    for (size_t i = 0; i < sizeof deeds / sizeof *deeds; i++) {
        Product product = product_format("let a = box([0.4, 1.5, 0.3]).move([-0.4, 0, 0.1]);"
                                         "show krs { kernel a; reflect plane([1, 0.1, 0], 0.05); }"
                                         ".smooth_mirrors(0.001)%s;",
                                         deeds[i]);
        int     seen = 0, wrong = 0;
        for (int k = 0; k < 3000; k++) {
            Vec    p   = random_in_cube(&random, 1);
            KrsHit hit = product_probe(&product, p);
            Vec    n   = vec(hit.normal[0], hit.normal[1], hit.normal[2]);
            if (fabs(hit.distance) > 0.05)
                continue;
            /* On the surface, inside of C, the normal is a gradient of the child's distance. */
            p   = vec_sub(p, vec_scale(1.2 * hit.distance + 1e-3, n));
            hit = product_probe(&product, p);
            if (hit.distance > 0 || hit.distance < -0.02)
                continue;
            n         = vec(hit.normal[0], hit.normal[1], hit.normal[2]);
            Vec light = vec(hit.shading[0], hit.shading[1], hit.shading[2]);
            seen++;
            wrong += vec_distance(n, light) > 0.01;
        }
        if (seen < 20 || wrong * 20 > seen)
            fail_msg("%s: %d of %d normals are not those of the surface", deeds[i], wrong, seen);
        product_free(&product);
    }
}

static void larger_bounds_are_refuted(void **state)
{
    (void)state;
    Random random  = {108};
    int    refuted = 0;
    enum { CHAINS = 30 };
    for (int i = 0; i < CHAINS; i++) {
        Deformed  chain = deformed_random(&random, 1, 0);
        SceneText text  = {.length = 0};
        deformed_write(&text, &chain, NULL);
        Product      product = product_compile(text.bytes);
        Exaggeration wrong   = {product_field, &product, 1.5};
        Trial        trial   = deformed_trial(&product, &chain, (uint64_t)i);
        trial.field          = exaggerated_field;
        trial.field_user     = &wrong;
        Verdict verdict      = judge(&trial);
        refuted += verdict.ball_errors > 0 && verdict.slope_errors > 0;
        product_free(&product);
    }
    assert_true(refuted >= CHAINS * 3 / 4);
}

/* The shape stands along y and bends about x, to z; a positive rate turns like a screw. */
static void directions_are_as_written(void **state)
{
    (void)state;
    Product bent = product_compile("show box([0.2, 2, 0.2]).move([0, 1, 0]).bend([1, 0, 0], 0.5);");
    assert_true(product_distance(&bent, vec(0, sin(1) / 0.5, (1 - cos(1)) / 0.5)) < 0.02);
    assert_true(product_distance(&bent, vec(0, sin(1) / 0.5, -(1 - cos(1)) / 0.5)) > 0.5);
    product_free(&bent);
    Product twisted = product_compile("show box([0.2, 4, 0.2]).move([1, 0, 0])"
                                      ".twist([0, 1, 0], 1);");
    assert_true(product_distance(&twisted, vec(cos(1.5), 1.5, -sin(1.5))) < 0);
    product_free(&twisted);
    Product tapered = product_compile("show box([2, 2, 2]).taper([0, 1, 0], from: 1, to: 0.5);");
    assert_true(product_distance(&tapered, vec(0.9, -0.99, 0)) < 0);
    assert_true(product_distance(&tapered, vec(0.6, 0.99, 0)) > 0);
    product_free(&tapered);
    Product grown = product_compile("show sphere(1).displace(1, 0.25);");
    assert_true(fabs(product_distance(&grown, vec(2, 0, 0)) - 0.75) < 1e-9);
    product_free(&grown);
}

int main(void)
{
    static Shares           shares[] = {{"twist", DEED_TWIST, 1, 0.7, 0.9},
                                        {"bend", DEED_BEND, 1, 0.75, 0.9},
                                        {"taper", DEED_TAPER, 1, 0.6, 0.9},
                                        {"three deformations", -1, 3, 0.55, 0.85}};
    const struct CMUnitTest tests[]  = {
         cmocka_unit_test(directions_are_as_written),
         {"twists are of use", bounds_are_of_use, NULL, NULL, &shares[0]},
         {"bends are of use", bounds_are_of_use, NULL, NULL, &shares[1]},
         {"tapers are of use", bounds_are_of_use, NULL, NULL, &shares[2]},
         {"chains are of use", bounds_are_of_use, NULL, NULL, &shares[3]},
         cmocka_unit_test(materials_see_the_solid),
         cmocka_unit_test(normals_come_out_again),
         cmocka_unit_test(larger_bounds_are_refuted),
    };
    return cmocka_run_group_tests_name("bounds of deformations", tests, NULL, NULL);
}
