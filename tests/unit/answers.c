/*
 * answers.c: whoever asks about a point or a ray hears of every row of surface.def, from the
 * processor and from the device.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <cmocka.h>

#include "compiler/scene/compiled.h"
#include "runtime/tracer/query.h"
#include "tests/unit/tracer_fixture.h"

/* ---- The rows ---- */

#define LIMITED   true
#define UNLIMITED false
#define FLOAT     1
#define VEC3      3

static const struct {
    const char *name;
    int         count;
    double      low, high;
    bool        limited;
} properties[] = {
#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) \
    {#name, type, low, high, asked},
#include "krs/surface.def"
};
enum { PROPERTIES = sizeof properties / sizeof *properties };

static const double otherwise_of[PROPERTIES] = {
#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) otherwise,
#include "krs/surface.def"
};

/* What an answer says of the properties. */
typedef double Material[PROPERTIES][3];

static void take_hit(const KrsHit *hit, Material material)
{
    int i = 0;
#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) \
    memcpy(material[i++], &hit->name, type * sizeof(double));
#include "krs/surface.def"
}

static void take_surface(const SurfacePoint *surface, Material material)
{
    int          i = 0;
    const float *from;
#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) \
    from = (const float *)&surface->name;                                      \
    for (int k = 0; k < type; k++)                                             \
        material[i][k] = from[k];                                              \
    i++;
#include "krs/surface.def"
}

/* ---- A material with something else in each of its numbers ---- */

/* Below 0 at some points, above 1 at others. */
static double number_at(int property, const double point[3], int axis)
{
    return 0.5 + 0.05 * property + 1.5 * point[axis];
}

/* Tangents are given with any length, and answered as unit vectors. */
static double length_at(int property, const double point[3])
{
    double square = 0;
    for (int k = 0; k < 3; k++)
        square += number_at(property, point, k) * number_at(property, point, k);
    return strcmp(properties[property].name, "tangent") == 0 ? sqrt(square) : 1;
}

static void write_scene(char *text, size_t size)
{
    static const char axes[] = "xyz";
    size_t            length = (size_t)snprintf(text, size, "material m { ");
    for (int i = 0; i < PROPERTIES; i++) {
        bool vector = properties[i].count == 3;
        length += (size_t)snprintf(text + length, size - length, "%s%s: %s", i ? ", " : "",
                                   properties[i].name, vector ? "[" : "");
        for (int k = 0; k < properties[i].count; k++)
            length += (size_t)snprintf(text + length, size - length, "%s%.17g + 1.5 * %c",
                                       k ? ", " : "", 0.5 + 0.05 * i, axes[k]);
        length += (size_t)snprintf(text + length, size - length, "%s", vector ? "]" : "");
    }
    snprintf(text + length, size - length, " } show sphere(1).paint(m);");
}

static void assert_material(Material found, const double point[3])
{
    for (int i = 0; i < PROPERTIES; i++)
        for (int k = 0; k < properties[i].count; k++) {
            double number = number_at(i, point, k) / length_at(i, point);
            if (properties[i].limited)
                number = fmin(fmax(number, properties[i].low), properties[i].high);
            if (!(fabs(found[i][k] - number) < 1e-5))
                print_message("%s[%d] is %g, not %g\n", properties[i].name, k, found[i][k], number);
            assert_near(found[i][k], number, 1e-5);
        }
}

static void assert_hit(const KrsHit *hit)
{
    Material material;
    take_hit(hit, material);
    assert_true(hit->hit);
    assert_material(material, hit->point);
    assert_int_equal(hit->component, 1);
    assert_int_equal(hit->level, 0);
    assert_int_equal(hit->instance, 1);
}

/* ---- Questions ---- */

enum { COUNT = 100 };

static double points[COUNT][3], inwards[COUNT][3];
static float  single_points[COUNT][3];

static void choose_points(void)
{
    for (int i = 0; i < COUNT; i++) {
        double size = 0;
        for (int k = 0; k < 3; k++) {
            single_points[i][k] = (float)sin(i * (k + 1.7) + 1);
            points[i][k]        = (double)single_points[i][k];
            size += points[i][k] * points[i][k];
        }
        for (int k = 0; k < 3; k++)
            inwards[i][k] = (size < 1 ? 1 : -1) * points[i][k];
    }
}

static void points_have_materials(void **state)
{
    static KrsHit       hits[COUNT], device_hits[COUNT];
    static SurfacePoint surfaces[COUNT];
    const Fixture      *fixture    = *state;
    const double(*places)[3]       = (const double(*)[3])points;
    const float(*single_places)[3] = (const float(*)[3])single_points;
    assert_int_equal(krs_probe(fixture->state, places, COUNT, hits), KRS_OK);
    assert_int_equal(
        krs_device_probe(fixture->rendering, fixture->state, places, COUNT, device_hits), KRS_OK);
    assert_int_equal(point_query_sample(fixture->rendering, fixture->state, single_places, COUNT,
                                        NULL, surfaces),
                     KRS_OK);
    for (int i = 0; i < COUNT; i++) {
        Material material;
        take_surface(&surfaces[i], material);
        assert_material(material, points[i]);
        assert_int_equal(surfaces[i].component, 1);
        assert_int_equal(surfaces[i].level, 0);
        assert_int_equal(surfaces[i].instance, 1);
        assert_hit(&hits[i]);
        assert_hit(&device_hits[i]);
    }
}

static void rays_end_at_materials(void **state)
{
    static KrsHit  hits[COUNT], device_hits[COUNT];
    const Fixture *fixture       = *state;
    const double(*origins)[3]    = (const double(*)[3])points;
    const double(*directions)[3] = (const double(*)[3])inwards;
    assert_int_equal(krs_raycast(fixture->state, origins, directions, COUNT, 10, 0, hits), KRS_OK);
    assert_int_equal(krs_device_raycast(fixture->rendering, fixture->state, origins, directions,
                                        COUNT, 10, 0, device_hits),
                     KRS_OK);
    for (int i = 0; i < COUNT; i++) {
        assert_hit(&hits[i]);
        assert_hit(&device_hits[i]);
    }
}

/* What no material says is as the table has it. */
static void the_rest_is_as_the_table_says(void **state)
{
    const double point[1][3] = {{0.25, 0.5, 0.75}};
    KrsHit       hits[2];
    Fixture      fixture = {0};
    (void)state;
    fixture_open(&fixture, "show sphere(1);", NULL);
    assert_int_equal(krs_probe(fixture.state, point, 1, &hits[0]), KRS_OK);
    assert_int_equal(krs_device_probe(fixture.rendering, fixture.state, point, 1, &hits[1]),
                     KRS_OK);
    for (int each = 0; each < 2; each++) {
        Material material;
        take_hit(&hits[each], material);
        for (int i = 0; i < PROPERTIES; i++)
            for (int k = 0; k < properties[i].count; k++)
                assert_near(material[i][k], otherwise_of[i], 1e-6);
    }
    fixture_close(&fixture);
}

/* Each iteration of a loop is a component, although many turns become one function of the shaders: balls
   at x = 0, 3, 6, ..., behind another ball and before a last one. */
static void turns_of_a_loop_are_components(void **state)
{
    enum { TURNS = 100, ALL = TURNS + 2 };
    static double places[ALL][3];
    static KrsHit hits[2][ALL];
    Fixture       fixture = {0};
    (void)state;
    fixture_open(
        &fixture,
        "show sphere(1).move([-3, 0, 0]);"
        "for i in 0..100 { show sphere(1).move([3 * i, 0, 0]).paint([i / 200, 0.5, 0.5]); }"
        "let last = sphere(1).move([300, 0, 0]); show last;",
        NULL);
    for (int i = 0; i < ALL; i++)
        places[i][0] = 3 * (i - 1) + 0.5;
    const double(*centres)[3] = (const double(*)[3])places;
    assert_int_equal(krs_component_count(fixture.scene), ALL);
    assert_int_equal(krs_probe(fixture.state, centres, ALL, hits[0]), KRS_OK);
    assert_int_equal(krs_device_probe(fixture.rendering, fixture.state, centres, ALL, hits[1]),
                     KRS_OK);
    for (int each = 0; each < 2; each++)
        for (uint32_t i = 0; i < ALL; i++) {
            assert_int_equal(hits[each][i].component, i + 1);
            assert_near(hits[each][i].distance, -0.5, 1e-4);
            if (i > 0 && i <= TURNS)
                assert_near(hits[each][i].color[0], (i - 1) / 200.0, 1e-6);
        }
    KrsComponent component;
    assert_int_equal(krs_component(fixture.scene, 41, &component), KRS_OK);
    assert_string_equal(component.name, "component 42");
    assert_near(component.low[0], 3 * 40 - 1, 1e-9);
    assert_int_equal(krs_component(fixture.scene, ALL - 1, &component), KRS_OK);
    assert_string_equal(component.name, "last");
    fixture_close(&fixture);
}

/* Balls and boxes in turn, as a loop shows them and one by one, with another shape between them: each is a
   component of its own, and both kinds are tables of the shaders. */
static void alike_components_are_components(void **state)
{
    enum { PAIRS = 100, BEFORE = 37, ALL = 2 * PAIRS + 1 };
    static double places[ALL][3];
    static KrsHit hits[2][ALL];
    static char   texts[2][32768];
    (void)state;
    for (int i = 0; i < ALL; i++)
        places[i][0] = 3 * i;
    snprintf(texts[0], sizeof texts[0],
             "for i in 0..100 { show sphere(1).move([6 * i, 0, 0]);"
             "  show box([2, 2, 2]).move([6 * i + 3, 0, 0]); }"
             "let last = torus(2, 0.5).move([602, 0, 0]); show last;");
    for (int i = 0, used = 0; i < PAIRS; i++) {
        if (i == BEFORE)
            used += snprintf(texts[1] + used, sizeof texts[1] - (size_t)used,
                             "let last = torus(2, 0.5).move([602, 0, 0]); show last;");
        used += snprintf(texts[1] + used, sizeof texts[1] - (size_t)used,
                         "show sphere(1).move([%d, 0, 0]); show box([2, 2, 2]).move([%d, 0, 0]);",
                         6 * i, 6 * i + 3);
    }
    for (int each = 0; each < 2; each++) {
        Fixture fixture = {0};
        fixture_open(&fixture, texts[each], NULL);
        uint32_t last             = each ? 2 * BEFORE : ALL - 1;
        const double(*centres)[3] = (const double(*)[3])places;
        assert_int_equal(krs_component_count(fixture.scene), ALL);
        assert_int_equal(krs_scene_program(fixture.scene)->table_count, 2);
        assert_int_equal(krs_probe(fixture.state, centres, ALL, hits[0]), KRS_OK);
        assert_int_equal(krs_device_probe(fixture.rendering, fixture.state, centres, ALL, hits[1]),
                         KRS_OK);
        for (int on = 0; on < 2; on++)
            for (uint32_t i = 0; i < ALL; i++) {
                uint32_t number = i == ALL - 1 ? last : i + (i >= last);
                assert_int_equal(hits[on][i].component, number + 1);
                assert_near(hits[on][i].distance, i == ALL - 1 ? -0.5 : -1, 1e-4);
            }
        KrsComponent component;
        assert_int_equal(krs_component(fixture.scene, last, &component), KRS_OK);
        assert_string_equal(component.name, "last");
        fixture_close(&fixture);
    }
}

static int set_up(void **state)
{
    static Fixture fixture;
    char           text[2048];
    choose_points();
    write_scene(text, sizeof text);
    fixture_open(&fixture, text, NULL);
    *state = &fixture;
    return 0;
}

static int tear_down(void **state)
{
    Fixture *fixture = *state;
    int      wrong   = krs_renderer_validation_messages(fixture->renderer) != 0;
    fixture_close(fixture);
    return wrong;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(points_have_materials),
        cmocka_unit_test(rays_end_at_materials),
        cmocka_unit_test(the_rest_is_as_the_table_says),
        cmocka_unit_test(turns_of_a_loop_are_components),
        cmocka_unit_test(alike_components_are_components),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
