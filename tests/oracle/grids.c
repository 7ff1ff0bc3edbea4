/*
 * grids.c: grids against closed forms, and against distances point by point.
 */
#include "tests/oracle/known_solid.h"
#include "tests/oracle/product.h"
#include "tests/oracle/random_scene.h"
#include "tests/support/random.h"

#include <float.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The rounding of float32, and of the sums here. */
static const double ROUNDING = 1e-6;

/* ---- all samples of a grid ---- */

typedef struct Samples {
    KrsGridShape shape;
    size_t       side[3]; /* whole bricks */
    float       *values;
    float (*colors)[3];
    uint32_t *materials;
    bool     *near;
    size_t    near_bricks, last; /* number of the brick before, from 1 */
} Samples;

static size_t sample_at(const Samples *samples, size_t x, size_t y, size_t z)
{
    return (z * samples->side[1] + y) * samples->side[0] + x;
}

static Vec place_at(const Samples *samples, size_t x, size_t y, size_t z)
{
    const KrsGridShape *shape = &samples->shape;
    return vec((double)(shape->first[0] + (int64_t)x) * shape->cell,
               (double)(shape->first[1] + (int64_t)y) * shape->cell,
               (double)(shape->first[2] + (int64_t)z) * shape->cell);
}

static bool take_brick(void *user, const KrsGridBrick *brick)
{
    Samples     *samples = user;
    const size_t side    = KRS_BRICK_SIDE;
    size_t       number  = 1;
    for (int k = 2; k >= 0; k--) {
        assert_int_equal(brick->at[k] % side, 0);
        assert_true(brick->at[k] < samples->shape.count[k]);
        number = k == 2 ? brick->at[k] / side
                        : number * (samples->side[k] / side) + brick->at[k] / side;
    }
    assert_int_equal(number, samples->last); /* along x, then y, then z, each once */
    samples->last++;
    samples->near_bricks += brick->near;
    for (size_t i = 0; i < KRS_BRICK_SAMPLES; i++) {
        size_t to = sample_at(samples, brick->at[0] + i % side, brick->at[1] + i / side % side,
                              brick->at[2] + i / (side * side));
        samples->values[to] = brick->values[i];
        samples->near[to]   = brick->near;
        if (brick->colors)
            memcpy(samples->colors[to], brick->colors[i], sizeof samples->colors[to]);
        if (brick->materials)
            samples->materials[to] = brick->materials[i];
    }
    return true;
}

static Samples take_samples(const Product *product, const KrsGridOptions *options)
{
    KrsGrid       *grid;
    Samples        samples = {0};
    size_t         all     = 1, near;
    KrsGridOptions first   = *options;
    first.aligned          = false;
    first.band             = options->aligned ? 7 : options->band; /* set below */
    assert_int_equal(krs_grid_new(product->state, &first, &grid), KRS_OK);
    if (options->aligned)
        assert_int_equal(krs_grid_set_band(grid, options->band, true), KRS_OK);
    samples.shape = krs_grid_shape(grid);
    assert_true(samples.shape.count[0] > 0);
    for (int k = 0; k < 3; k++) {
        samples.side[k] = (samples.shape.count[k] + KRS_BRICK_SIDE - 1) / KRS_BRICK_SIDE *
                          KRS_BRICK_SIDE;
        all *= samples.side[k];
    }
    samples.values    = calloc(all, sizeof *samples.values);
    samples.colors    = calloc(all, sizeof *samples.colors);
    samples.materials = calloc(all, sizeof *samples.materials);
    samples.near      = calloc(all, sizeof *samples.near);
    assert_int_equal(krs_grid_visit(grid, take_brick, &samples), KRS_OK);
    assert_int_equal(samples.last * KRS_BRICK_SAMPLES, all);
    assert_int_equal(krs_grid_count_near(grid, &near), KRS_OK);
    assert_int_equal(near, samples.near_bricks);
    krs_grid_free(grid);
    return samples;
}

static void free_samples(Samples *samples)
{
    free(samples->values);
    free(samples->colors);
    free(samples->materials);
    free(samples->near);
}

typedef void VisitSample(const Samples *samples, size_t number, Vec place, void *user);

static void visit_samples(const Samples *samples, VisitSample *visit, void *user)
{
    for (size_t z = 0; z < samples->side[2]; z++)
        for (size_t y = 0; y < samples->side[1]; y++)
            for (size_t x = 0; x < samples->side[0]; x++)
                visit(samples, sample_at(samples, x, y, z), place_at(samples, x, y, z), user);
}

/* ---- closed forms ---- */

typedef double Truth(Vec place);

static double of_ball(Vec p) { return vec_length(p) - 1; }

static double box_distance(Vec p, Vec half)
{
    Vec q = vec(fabs(p.x) - half.x, fabs(p.y) - half.y, fabs(p.z) - half.z);
    Vec o = vec(fmax(q.x, 0), fmax(q.y, 0), fmax(q.z, 0));
    return vec_length(o) + fmin(fmax(q.x, fmax(q.y, q.z)), 0);
}

static double of_box(Vec p) { return box_distance(p, vec(0.5, 1, 0.75)); }

static double of_plate(Vec p) { return box_distance(p, vec(1, 0.002, 1)); }

static double of_turned_box(Vec p)
{
    const double c = cos(0.5), s = sin(0.5); /* about z */
    return box_distance(vec(c * p.x + s * p.y, c * p.y - s * p.x, p.z), vec(0.5, 1, 0.75));
}

static double of_torus(Vec p) { return hypot(hypot(p.x, p.z) - 1, p.y) - 0.3; }

/* Solids of revolution about x, made of two balls with middles at +-0.6 on it: points of their profile are on either
   arc, if the other ball permits it, or at the corner where both meet. */
static double of_arcs(Vec p, double radii[2], bool sharp_out)
{
    const double x = p.x, r = hypot(p.y, p.z), at[2] = {-0.6, 0.6};
    double       least = INFINITY;
    for (int i = 0; i < 2; i++) {
        double from = hypot(x - at[i], r), part = from > 0 ? radii[i] / from : 0;
        double foot_x = from > 0 ? at[i] + part * (x - at[i]) : at[i],
               foot_r = from > 0 ? part * r : radii[i];
        bool in_other = hypot(foot_x - at[1 - i], foot_r) < radii[1 - i];
        if (in_other == sharp_out)
            least = fmin(least, fabs(from - radii[i]));
    }
    /* Where both circles meet. */
    double meet_x = (radii[0] * radii[0] - radii[1] * radii[1]) / (2 * (at[1] - at[0]));
    double meet_r = sqrt(radii[0] * radii[0] - (meet_x - at[0]) * (meet_x - at[0]));
    return fmin(least, hypot(x - meet_x, r - meet_r));
}

static double of_lens(Vec p)
{
    double radii[2] = {1, 0.9}, a = hypot(p.x + 0.6, hypot(p.y, p.z)) - 1,
           b = hypot(p.x - 0.6, hypot(p.y, p.z)) - 0.9;
    return copysign(of_arcs(p, radii, true), fmax(a, b));
}

static double of_two_balls(Vec p)
{
    double radii[2] = {1, 0.9}, a = hypot(p.x + 0.6, hypot(p.y, p.z)) - 1,
           b = hypot(p.x - 0.6, hypot(p.y, p.z)) - 0.9;
    return copysign(of_arcs(p, radii, false), fmin(a, b));
}

/* Returns a quadratic blend by its definition, and its profile as a polygon, by brute force. */
static double blend_value(double x, double r)
{
    const double k = 0.5, a = hypot(x + 0.6, r) - 0.8, b = hypot(x - 0.6, r) - 0.7;
    const double h = fmax(k - fabs(a - b), 0) / k;
    return fmin(a, b) - h * h * k / 4;
}

enum { PROFILE = 4000 };
static double profile[PROFILE][2];

static void find_profile(void)
{
    for (int i = 0; i < PROFILE; i++) {
        double angle = 3.14159265358979 * i / (PROFILE - 1), low = 0, high = 3;
        for (int n = 0; n < 60; n++) {
            double middle = 0.5 * (low + high);
            if (blend_value(middle * cos(angle), middle * sin(angle)) < 0)
                low = middle;
            else
                high = middle;
        }
        profile[i][0] = low * cos(angle);
        profile[i][1] = low * sin(angle);
    }
}

static double of_blend(Vec p)
{
    const double x = p.x, r = hypot(p.y, p.z);
    double       least = INFINITY;
    if (profile[0][0] == 0)
        find_profile();
    for (int i = 0; i + 1 < PROFILE; i++) {
        double ax = profile[i + 1][0] - profile[i][0], ar = profile[i + 1][1] - profile[i][1];
        double ox = x - profile[i][0], or = r - profile[i][1];
        double t = fmin(fmax((ox * ax + or *ar) / (ax * ax + ar * ar), 0), 1);
        ox -= t * ax, or -= t * ar;
        least = fmin(least, ox * ox + or * or);
    }
    return copysign(sqrt(least), blend_value(x, r));
}

static const struct {
    const char *text;
    Truth      *truth;
    bool        exact;   /* distances of the scene are the true ones */
    double      unknown; /* error of the truth */
    double      cell;
} forms[] = {
    {"show sphere(1);", of_ball, true, 1e-12, 0.0913},
    {"show box([1, 2, 1.5]);", of_box, true, 1e-12, 0.07},
    {"show box([1, 2, 1.5]).rotate([0, 0, 1], 0.5);", of_turned_box, true, 1e-12, 0.1},
    {"show box([2, 0.004, 2]);", of_plate, true, 1e-12, 0.1},
    {"show torus(1, 0.3);", of_torus, true, 1e-12, 0.08},
    {"show sphere(1).move([-0.6, 0, 0]) & sphere(0.9).move([0.6, 0, 0]);", of_lens, false, 1e-12,
     0.0917},
    {"show sphere(1).move([-0.6, 0, 0]) | sphere(0.9).move([0.6, 0, 0]);", of_two_balls, false,
     1e-12, 0.11},
    {"show union(sphere(0.8).move([-0.6, 0, 0]), sphere(0.7).move([0.6, 0, 0]), blend: 0.5);",
     of_blend, false, 2e-6, 0.17},
};
enum { FORMS = sizeof forms / sizeof *forms };

typedef struct Judged {
    size_t form, count, inside;
    double error;    /* that distances may be below the truth */
    double band;     /* or 0 */
    double farthest; /* below the truth, of all */
} Judged;

static void judge_sample(const Samples *samples, size_t number, Vec place, void *user)
{
    Judged *judged = user;
    double  value = samples->values[number], truth = forms[judged->form].truth(place);
    double  unknown = forms[judged->form].unknown + ROUNDING;
    if (fabs(truth) > unknown)
        assert_int_equal(value < 0, truth < 0);
    assert_true(fabs(value) <= fabs(truth) + unknown);
    if (judged->band > 0)
        truth = copysign(fmin(fabs(truth), judged->band), truth);
    assert_true(fabs(value) >= fabs(truth) - judged->error - unknown);
    judged->farthest = fmax(judged->farthest, fabs(truth) - fabs(value));
    judged->inside += value < 0;
    judged->count++;
}

static void judge_form(size_t form, KrsGridOptions options, double error)
{
    Product product = product_compile(forms[form].text);
    options.cell    = forms[form].cell;
    Samples samples = take_samples(&product, &options);
    Judged  judged  = {form, 0, 0, error, samples.shape.band, 0};
    if (options.exact) {
        assert_int_equal(samples.shape.unresolved, 0);
        judged.error = samples.shape.error;
    }
    visit_samples(&samples, judge_sample, &judged);
    print_message("# %s: %zu samples, %zu inside, at most %.3g cells too short\n", forms[form].text,
                  judged.count, judged.inside, judged.farthest / options.cell);
    assert_true(samples.shape.outside == (forms[form].exact || strchr(forms[form].text, '|')));
    free_samples(&samples);
    product_free(&product);
}

static void distances_are_those_of_closed_forms(void **state)
{
    (void)state;
    for (size_t i = 0; i < FORMS; i++)
        judge_form(i, (KrsGridOptions){0}, forms[i].exact ? 0 : INFINITY);
}

static void exact_distances_are_within_their_error(void **state)
{
    (void)state;
    for (size_t i = 0; i < FORMS; i++) {
        /* The usual error, one below the thickness of the plate, and a fifth of a cell. */
        double error = i < 2 ? 0 : forms[i].truth == of_plate ? 0.001 : 0.2 * forms[i].cell;
        judge_form(i, (KrsGridOptions){.exact = true, .error = error}, 0);
        judge_form(i, (KrsGridOptions){.exact = true, .error = 0.03, .band = 2}, 0);
    }
}

static void bands_lose_nothing(void **state)
{
    (void)state;
    for (size_t i = 0; i < FORMS; i++)
        judge_form(i, (KrsGridOptions){.band = 1.5 + (double)i, .aligned = i % 2},
                   forms[i].exact ? 0 : INFINITY);
}

/* ---- against distances point by point ---- */

static void judge_by_product(const Samples *samples, size_t number, Vec place, void *user)
{
    const Product *product = user;
    double         value = samples->values[number], distance = product_distance(product, place);
    double         band = samples->shape.band;
    double         told = band > 0 ? fmin(fmax(distance, -band), band) : distance;
    assert_true(fabs(value) <= fabs(told));
    assert_true(fabs(value - told) <= FLT_EPSILON * fabs(told) + FLT_MIN);
    if (!samples->near[number])
        assert_true(fabs(distance) >= band);
}

/* Random solids are compared, whose insides are known by the meaning of their words alone. */
static void all_samples_are_those_of_single_points(void **state)
{
    Random random = {7};
    size_t near = 0, all = 0;
    (void)state;
    for (int i = 0; i < 40; i++) {
        SceneText   text  = {0};
        KnownSolid *solid = known_solid_random(&random, 0.05);
        scene_write(&text, "show ");
        known_solid_write(solid, &text);
        scene_write(&text, ";");
        Product        product = product_compile(text.bytes);
        KrsGridOptions options = {.cell = random_between(&random, 0.05, 0.12),
                                  .band = i % 4 ? random_between(&random, 1, 4) : 0};
        Samples        samples = take_samples(&product, &options);
        visit_samples(&samples, judge_by_product, &product);
        for (size_t z = 0; z < samples.side[2]; z++)
            for (size_t y = 0; y < samples.side[1]; y++)
                for (size_t x = 0; x < samples.side[0]; x++) {
                    double known = known_solid_value(solid, place_at(&samples, x, y, z));
                    double value = samples.values[sample_at(&samples, x, y, z)];
                    if (fabs(known) > 1e-9)
                        assert_int_equal(value < 0, known < 0);
                    all++;
                    near += samples.near[sample_at(&samples, x, y, z)];
                }
        free_samples(&samples);
        product_free(&product);
        known_solid_free(solid);
    }
    print_message("# %zu of %zu samples are near\n", near, all);
    assert_true(near < all);
}

static void thin_plates_are_in_bands(void **state)
{
    (void)state;
    Random random = {11};
    for (int i = 0; i < 12; i++) {
        double thin            = pow(10, random_between(&random, -6, -2)),
               turn            = random_between(&random, 0, 3);
        Product        product = product_format("show box([4, %.9f, 4]).rotate([1, 2, 0], %.6f) | "
                                                       "sphere(%.9f).move([1, 1.5, 0]);",
                                                thin, turn, thin);
        KrsGridOptions options = {.cell = 0.11, .band = 1};
        Samples        samples = take_samples(&product, &options);
        visit_samples(&samples, judge_by_product, &product);
        free_samples(&samples);
        product_free(&product);
    }
}

/* ---- fog ---- */

static double covered(double from, double to, double low, double high)
{
    return fmax(0, fmin(to, high) - fmax(from, low)) / (to - from);
}

typedef struct Fog {
    double sum, most; /* the largest error of a density */
    Vec    half;      /* of a box; 0: none */
} Fog;

static void judge_fog(const Samples *samples, size_t number, Vec place, void *user)
{
    Fog         *fog   = user;
    const double value = samples->values[number], half = 0.5 * samples->shape.cell;
    assert_true(value >= 0 && value <= 1);
    fog->sum += value * pow(samples->shape.cell, 3);
    if (fog->half.x == 0)
        return;
    double truth = covered(place.x - half, place.x + half, -fog->half.x, fog->half.x) *
                   covered(place.y - half, place.y + half, -fog->half.y, fog->half.y) *
                   covered(place.z - half, place.z + half, -fog->half.z, fog->half.z);
    fog->most = fmax(fog->most, fabs(value - truth));
}

static void densities_are_what_is_solid(void **state)
{
    (void)state;
    Product        product = product_compile("show sphere(1);");
    KrsGridOptions options = {.cell = 0.07, .fog = true};
    Samples        samples = take_samples(&product, &options);
    Fog            fog     = {0};
    visit_samples(&samples, judge_fog, &fog);
    print_message("# volume %.6f\n", fog.sum);
    assert_true(fabs(fog.sum / 4.18879020478639 - 1) < 0.0005);
    free_samples(&samples);
    product_free(&product);
    product = product_compile("show box([1.3, 0.9, 0.714]);");
    samples = take_samples(&product, &options);
    fog     = (Fog){.half = vec(0.65, 0.45, 0.357)};
    visit_samples(&samples, judge_fog, &fog);
    print_message("# densities within %.4f\n", fog.most);
    assert_true(fog.most < 0.02 && fabs(fog.sum / (1.3 * 0.9 * 0.714) - 1) < 0.001);
    free_samples(&samples);
    product_free(&product);
}

/* ---- materials ---- */

/* Rods, bars, plates and balls between a 25th of a cell and one thick, and slots, wherever they are. */
static void densities_add_up_to_what_is_thin(void **state)
{
    enum { SCENES = 60 };
    static const double pi = 3.14159265358979323846, cell = 0.1;
    Random              random = {17};
    (void)state;
    for (int i = 0; i < SCENES; i++) {
        const double r = cell * 0.02 * pow(25, random_between(&random, 0, 1)), w = 2 * r;
        const struct {
            const char *text;
            double      volume, most; /* the largest error of its part */
        } kinds[]      = {{"cylinder(%.17g, 2)", 2 * pi * r * r, 0.1},
                          {"box([2, %.17g, %.17g])", 2 * w * w, 0.1},
                          {"box([1, %.17g, 1])", w, 0.05},
                          {"sphere(%.17g)", 4 * pi / 3 * pow(r, 3), 0.25},
                          {"box([1, 1, 1]) - box([2, %.17g, 2])", 1 - w, 0.003}};
        const int kind = i % 5;
        SceneText text = {.length = 0};
        double    axis[3], at[3];
        char      solid[128];
        random_vector(&random, 1, axis);
        random_vector(&random, 1, at);
        snprintf(solid, sizeof solid, kinds[kind].text, kind == 0 || kind == 3 ? r : w, w);
        scene_write(&text, "show (%s)", solid);
        if (i % 10 > 4) /* others are between the parts of cells, as it happens */
            scene_write(&text, ".rotate([%.17g, %.17g, %.17g], 1).move([%.17g, %.17g, %.17g])",
                        axis[0], axis[1], axis[2], at[0], at[1], at[2]);
        scene_write(&text, ";");
        Product        product = product_compile(text.bytes);
        KrsGridOptions options = {.cell = cell, .fog = true};
        Samples        samples = take_samples(&product, &options);
        Fog            fog     = {0};
        visit_samples(&samples, judge_fog, &fog);
        print_message("# %.3f cells thick: volume %.5f of the true one: %s\n", w / cell,
                      fog.sum / kinds[kind].volume, text.bytes);
        assert_true(fabs(fog.sum / kinds[kind].volume - 1) < kinds[kind].most);
        free_samples(&samples);
        product_free(&product);
    }
}

static void judge_color(const Samples *samples, size_t number, Vec place, void *user)
{
    const float   *color  = samples->colors[number];
    const uint32_t wanted = *(const uint32_t *)user;
    uint32_t       part   = wanted ? wanted : place.x < 0 ? 1 : 2;
    if (!samples->near[number] || (!wanted && fabs(place.x) < 1e-9))
        return;
    assert_true(color[0] == (part == 1) && color[1] == 0 && color[2] == (part == 2));
    assert_int_equal(samples->materials[number], part);
}

static void colors_are_of_the_nearest_part(void **state)
{
    (void)state;
    Product product = product_compile(
        "material one { color: [1, 0, 0] } material two { color: [0, 0, 1] }\n"
        "let a = sphere(1).move([-1, 0, 0]).paint(one); show a;\n"
        "let b = sphere(1).move([1, 0, 0]).paint(two); show b;");
    for (uint32_t part = 0; part < 3; part++) {
        KrsGridOptions options = {.cell = 0.13, .band = 2, .materials = true, .component = part};
        Samples        samples = take_samples(&product, &options);
        visit_samples(&samples, judge_color, &part);
        free_samples(&samples);
    }
    product_free(&product);
}

/* ---- the rest ---- */

static void grids_are_around_what_is_solid(void **state)
{
    Random random = {5};
    (void)state;
    for (int i = 0; i < 20; i++) {
        SceneText   text  = {0};
        KnownSolid *solid = known_solid_random(&random, 0.05);
        scene_write(&text, "show ");
        known_solid_write(solid, &text);
        scene_write(&text, ";");
        Product        product = product_compile(text.bytes);
        KrsGridOptions options = {.cell = random_between(&random, 0.02, 0.3), .band = 1};
        Samples        samples = take_samples(&product, &options);
        for (size_t z = 0; z < samples.shape.count[2]; z++)
            for (size_t y = 0; y < samples.shape.count[1]; y++)
                for (size_t x = 0; x < samples.shape.count[0]; x++)
                    if (x == 0 || y == 0 || z == 0 || x + 1 == samples.shape.count[0] ||
                        y + 1 == samples.shape.count[1] || z + 1 == samples.shape.count[2])
                        assert_true(samples.values[sample_at(&samples, x, y, z)] >= 0);
        free_samples(&samples);
        product_free(&product);
        known_solid_free(solid);
    }
}

static void nonsense_is_refused(void **state)
{
    (void)state;
    Product        product   = product_compile("show sphere(1);");
    Product        endless   = product_compile("show half_space([0, 1, 0], 0);");
    KrsGridOptions options[] = {{.cell = 0},
                                {.cell = -1},
                                {.cell = NAN},
                                {.cell = INFINITY},
                                {.cell = 1e-12},
                                {.cell = 0.1, .band = -1},
                                {.cell = 0.1, .band = NAN},
                                {.cell = 0.1, .error = -1},
                                {.cell = 0.1, .component = 2},
                                {.cell = 0.1, .exact = true, .error = 1e-12}};
    KrsGrid       *grid;
    for (size_t i = 0; i < sizeof options / sizeof *options; i++) {
        assert_int_equal(krs_grid_new(product.state, &options[i], &grid), KRS_BAD_ARGUMENT);
        assert_null(grid);
    }
    KrsGridOptions usual = {.cell = 0.1};
    assert_int_equal(krs_grid_new(endless.state, &usual, &grid), KRS_BAD_ARGUMENT);
    usual = (KrsGridOptions){.cell = 0.1, .within = true, .low = {-1, -1, -1}, .high = {1, 1, 1}};
    assert_int_equal(krs_grid_new(endless.state, &usual, &grid), KRS_OK);
    assert_int_equal(krs_grid_set_band(grid, NAN, false), KRS_BAD_ARGUMENT);
    krs_grid_free(grid);
    usual = (KrsGridOptions){.cell = 0.001, .memory_limit = 100000};
    assert_int_equal(krs_grid_new(product.state, &usual, &grid), KRS_OUT_OF_MEMORY);
    usual.cell         = 100;
    usual.memory_limit = 0;
    assert_int_equal(krs_grid_new(product.state, &usual, &grid), KRS_OK);
    krs_grid_free(grid);
    krs_grid_free(NULL);
    product_free(&product);
    product_free(&endless);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(distances_are_those_of_closed_forms),
        cmocka_unit_test(exact_distances_are_within_their_error),
        cmocka_unit_test(bands_lose_nothing),
        cmocka_unit_test(all_samples_are_those_of_single_points),
        cmocka_unit_test(thin_plates_are_in_bands),
        cmocka_unit_test(densities_are_what_is_solid),
        cmocka_unit_test(densities_add_up_to_what_is_thin),
        cmocka_unit_test(colors_are_of_the_nearest_part),
        cmocka_unit_test(grids_are_around_what_is_solid),
        cmocka_unit_test(nonsense_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
