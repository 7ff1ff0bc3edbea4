/*
 * thin_film.c: the colours of thin films, held against the sum of all waves that a plane film sends
 * back, as Airy found it.
 *
 * The reference has that sum in closed form, for one wave number at a time, and adds it up over the
 * bands of red, green and blue.  A sky of 1 shows the reflectance of a smooth surface.
 */
#include <complex.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "compiler/passes/compile.h"
#include "tests/oracle/path_fixture.h"
#include "tests/support/renderer.h"

#define DEGREE (M_PI / 180)

/* The ground is black, and is seen through glass alone. */
static const char slab[] =
    "param angle = 0 in [0, 1.5]; param thick = 0 in [0, 99]; param film = 1.4 in [1, 4];\n"
    "param index = 1.5 in [1, 4]; param metal = 0 in [0, 1]; param glass = 0 in [0, 1];\n"
    "param much = 1 in [0, 1]; param shade = [0, 0, 0];\n"
    "camera { eye: [5 * sin(angle), 5 * cos(angle), 0], up: [0, 0, 1],\n"
    "         projection: \"orthographic\", height: 1 }\n"
    "sky { zenith: [1, 1, 1], horizon: [1, 1, 1], ground: black }\n"
    "light none { direction: [0, 1, 0], color: black }\n"
    "material m { color: shade, roughness: 0, ior: index, metallic: metal, transmission: glass,\n"
    "             thin_film_weight: much, thin_film_thickness: thick, thin_film_ior: film }\n"
    "show box([90, 1, 90]).move([0, -0.5, 0]).paint(m);\n";

/* ---- The sum of all waves ---- */

/* Waves in a micrometre. */
static const double middles[]    = {1 / 0.611, 1 / 0.549, 1 / 0.465},
                    deviations[] = {0.08, 0.11, 0.12};

/* What is on a base. */
typedef struct Film {
    double thickness, index, base;
} Film;

/* How much larger a wave is that a boundary sends back, by the indices and cosines of both sides. */
static double ratio(double from, double from_cosine, double to, double to_cosine, bool along)
{
    const double a = along ? to * from_cosine : from * from_cosine,
                 b = along ? from * to_cosine : to * to_cosine;
    return (a - b) / (a + b);
}

static double cosine_in(double index, double angle) { return sqrt(1 - pow(sin(angle) / index, 2)); }

static double reflect_wave(Film film, double angle, double waves)
{
    const double inside = cosine_in(film.index, angle), beyond = cosine_in(film.base, angle);
    const double complex turn = cexp(I * 4 * M_PI * film.index * film.thickness * inside * waves);
    double               sum  = 0;
    for (int along = 0; along < 2; along++) {
        const double outer = ratio(1, cos(angle), film.index, inside, along);
        const double inner = ratio(film.index, inside, film.base, beyond, along);
        const double all   = cabs((outer + inner * turn) / (1 + outer * inner * turn));
        sum += 0.5 * all * all;
    }
    return sum;
}

/* The mean over a band. */
static double reflect(Film film, double angle, int color)
{
    enum { PARTS = 4000 };
    double sum = 0, weights = 0;
    for (int i = 0; i <= PARTS; i++) {
        const double at = -5 + 10.0 * i / PARTS, weight = exp(-0.5 * at * at);
        sum += weight * reflect_wave(film, angle, middles[color] + at * deviations[color]);
        weights += weight;
    }
    return sum / weights;
}

/* Returns the index of refraction with this reflectance head on. */
static double index_of(double head_on) { return (1 + sqrt(head_on)) / (1 - sqrt(head_on)); }

/* ---- What pictures show ---- */

static const double thicknesses[] = {0, 0.08, 0.3, 0.55, 1.1, 3, 30}, indices[] = {1.33, 2.2},
                    angles[] = {0, 40 * DEGREE, 72 * DEGREE};
static const double metal[]  = {0.9, 0.5, 0.2};
#define MAX_WRONG 0.004

static PathFixture fixture;

static int open_slab(void **state)
{
    if (renderer_open(state) != 0)
        return 1;
    fixture = path_fixture_open(slab);
    return 0;
}

static int close_slab(void **state)
{
    path_fixture_close(&fixture);
    return renderer_close(state);
}

static void cover(Film film, double angle)
{
    path_fixture_set(&fixture, "angle", angle);
    path_fixture_set(&fixture, "thick", film.thickness);
    path_fixture_set(&fixture, "film", film.index);
}

/* What a color of a picture shows, by one integrator. */
static void look(KrsIntegrator integrator, uint32_t samples, double found[3])
{
    KrsPicture *picture = path_fixture_render(&fixture,
                                              &(KrsRenderOptions){.width        = 16,
                                                                  .height       = 16,
                                                                  .samples      = samples,
                                                                  .bounces      = 16,
                                                                  .no_occlusion = true,
                                                                  .aovs         = KRS_AOV_COLOR,
                                                                  .integrator   = integrator});
    for (int i = 0; i < 3; i++)
        found[i] = mean_of_region(picture, everywhere, i);
    krs_picture_free(picture);
}

static size_t compare(const double found[3], const double right[3], double most, const char *what,
                      Film film, double angle)
{
    size_t wrong = 0;
    for (int i = 0; i < 3; i++)
        wrong += !(fabs(found[i] - right[i]) <= most);
    if (wrong)
        print_message("# %s, %g thick, index %g, at %.0f degrees: %.4f %.4f %.4f instead of %.4f "
                      "%.4f %.4f\n",
                      what, film.thickness, film.index, angle / DEGREE, found[0], found[1],
                      found[2], right[0], right[1], right[2]);
    return wrong;
}

typedef size_t CompareFilm(Film film, double angle);

static size_t compare_all(CompareFilm *compare_film)
{
    size_t wrong = 0;
    for (size_t i = 0; i < sizeof thicknesses / sizeof *thicknesses; i++)
        for (size_t k = 0; k < sizeof indices / sizeof *indices; k++)
            for (size_t m = 0; m < sizeof angles / sizeof *angles; m++)
                wrong += compare_film((Film){thicknesses[i], indices[k], 1.5}, angles[m]);
    return wrong;
}

static size_t compare_dielectric(Film film, double angle)
{
    double found[3], right[3];
    cover(film, angle);
    look(KRS_INTEGRATOR_PREVIEW, 1, found);
    for (int i = 0; i < 3; i++)
        right[i] = reflect(film, angle, i);
    return compare(found, right, MAX_WRONG, "a film on a dielectric", film, angle);
}

static size_t compare_metal(Film film, double angle)
{
    double found[3], right[3];
    cover(film, angle);
    look(KRS_INTEGRATOR_PREVIEW, 1, found);
    for (int i = 0; i < 3; i++)
        right[i] = reflect((Film){film.thickness, film.index, index_of(metal[i])}, angle, i);
    return compare(found, right, MAX_WRONG, "a film on a metal", film, angle);
}

/* Both faces have a film, and light goes back and forth between them. */
static size_t compare_glass(Film film, double angle)
{
    double found[3], right[3];
    cover(film, angle);
    look(KRS_INTEGRATOR_PATH, 16, found);
    for (int i = 0; i < 3; i++) {
        const double face = reflect(film, angle, i);
        right[i]          = 2 * face / (1 + face);
    }
    return compare(found, right, 0.05, "a film on glass", film, angle);
}

static void films_on_dielectrics(void **state)
{
    (void)state;
    assert_int_equal(compare_all(compare_dielectric), 0);
}

static void films_on_metals(void **state)
{
    (void)state;
    path_fixture_set(&fixture, "metal", 1);
    path_fixture_set_all(&fixture, "shade", metal[0], metal[1], metal[2]);
    const size_t wrong = compare_all(compare_metal);
    path_fixture_set(&fixture, "metal", 0);
    path_fixture_set_all(&fixture, "shade", 0, 0, 0);
    assert_int_equal(wrong, 0);
}

static void films_on_glass(void **state)
{
    (void)state;
    path_fixture_set(&fixture, "glass", 1);
    path_fixture_set_all(&fixture, "shade", 1, 1, 1);
    const size_t wrong = compare_all(compare_glass);
    path_fixture_set(&fixture, "glass", 0);
    path_fixture_set_all(&fixture, "shade", 0, 0, 0);
    assert_int_equal(wrong, 0);
}

/* Paths and previews show the same; half a film is half of what a film does. */
static void paths_show_films_as_previews_do(void **state)
{
    (void)state;
    const Film film = {0.3, 2.2, 1.5};
    double     found[3], whole[3], none[3], half[3];
    cover(film, 0.7);
    look(KRS_INTEGRATOR_PREVIEW, 1, whole);
    look(KRS_INTEGRATOR_PATH, 64, found);
    assert_int_equal(compare(found, whole, 0.02, "by paths", film, 0.7), 0);
    path_fixture_set(&fixture, "much", 0);
    look(KRS_INTEGRATOR_PREVIEW, 1, none);
    path_fixture_set(&fixture, "much", 0.5);
    look(KRS_INTEGRATOR_PREVIEW, 1, half);
    path_fixture_set(&fixture, "much", 1);
    for (int i = 0; i < 3; i++)
        none[i] = 0.5 * (none[i] + whole[i]);
    assert_int_equal(compare(half, none, 1e-4, "half a film", film, 0.7), 0);
}

/* A tenth more or less of the thickness is seen. */
static void a_wrong_thickness_is_seen(void **state)
{
    (void)state;
    const Film film = {0.55, 2.2, 1.5}, thicker = {0.6, 2.2, 1.5};
    double     found[3], right[3];
    cover(thicker, 0);
    look(KRS_INTEGRATOR_PREVIEW, 1, found);
    for (int i = 0; i < 3; i++)
        right[i] = reflect(film, 0, i);
    assert_true(fabs(found[0] - right[0]) + fabs(found[1] - right[1]) > 10 * MAX_WRONG);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(films_on_dielectrics),
        cmocka_unit_test(films_on_metals),
        cmocka_unit_test(films_on_glass),
        cmocka_unit_test(paths_show_films_as_previews_do),
        cmocka_unit_test(a_wrong_thickness_is_seen),
    };
    return cmocka_run_group_tests_name("thin_film", tests, open_slab, close_slab);
}
