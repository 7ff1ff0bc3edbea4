/*
 * `krs validate` refutes a distance that is too large, one that is not a number, and a device
 * that disagrees, and lets an honest scene pass.
 *
 * The scene, a unit ball, and the device are played by this file, so that they can lie.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "cli/shell/console.c"
#include "cli/options/choices.c"
#include "cli/options/options.c"
#include "cli/parse_options.c"
#include "cli/options/values.c"
#include "cli/validate.c"

/* How the ball's distance is falsified. */
static double exaggeration;   /* the distance outside is this much too large */
static double inside_factor;  /* the same inside */
static bool   not_a_number;   /* in one half of space */
static double device_error;   /* added to what the device says */
static bool   an_estimate;    /* it claims to be no more */
static bool   search_refutes; /* what the directed search says */

/* Settings are numbers here, not expressions. */
bool read_expression(Arena *arena, const char *text, Setting *setting)
{
    (void)arena, (void)text, (void)setting;
    return false;
}

static double ball(const double point[3])
{
    double square   = point[0] * point[0] + point[1] * point[1] + point[2] * point[2];
    double distance = sqrt(square) - 1;
    if (not_a_number && point[0] > 0)
        return NAN;
    return distance * (distance > 0 ? exaggeration : inside_factor);
}

KrsStatus krs_distance(KrsState *state, const double (*points)[3], size_t count, double *distances)
{
    (void)state;
    for (size_t i = 0; i < count; i++)
        distances[i] = ball(points[i]);
    return KRS_OK;
}

/* There is no instance group, so a distance of the device has no excuse. */
size_t krs_table_cells(const KrsScene *scene)
{
    (void)scene;
    return 0;
}

KrsStatus krs_distance_bound(KrsState *state, const double (*points)[3], size_t count,
                             double *distances)
{
    return krs_distance(state, points, count, distances);
}

KrsStatus krs_probe(KrsState *state, const double (*points)[3], size_t count, KrsHit *hits)
{
    (void)state;
    for (size_t i = 0; i < count; i++) {
        double size = fabs(sqrt(points[i][0] * points[i][0] + points[i][1] * points[i][1] +
                                points[i][2] * points[i][2]));
        hits[i]     = (KrsHit){.hit = true, .component = 1, .distance = ball(points[i])};
        for (int axis = 0; axis < 3; axis++) {
            hits[i].point[axis]  = points[i][axis];
            hits[i].normal[axis] = points[i][axis] / size;
        }
    }
    return KRS_OK;
}

KrsStatus krs_device_distance(KrsRendering *rendering, KrsState *state, const float (*points)[3],
                              size_t count, float *distances)
{
    (void)rendering, (void)state;
    for (size_t i = 0; i < count; i++) {
        double point[3] = {points[i][0], points[i][1], points[i][2]};
        distances[i]    = (float)(ball(point) + device_error);
    }
    return KRS_OK;
}

const KrsProgram *krs_scene_program(const KrsScene *scene)
{
    static const KrsProgram program = {.low = {-1, -1, -1}, .high = {1, 1, 1}};
    (void)scene;
    return &program;
}

const KrsDiagnostic *krs_scene_too_large(const KrsScene *scene)
{
    (void)scene;
    return NULL;
}

KrsStatus krs_component(const KrsScene *scene, size_t index, KrsComponent *component)
{
    (void)scene;
    *component = (KrsComponent){.name = "ball", .estimate = an_estimate};
    return index == 0 ? KRS_OK : KRS_BAD_ARGUMENT;
}

/* What else validate.c calls, with nothing behind it. */

static char something; /* whose address stands for scenes, states and devices */

KrsStatus scene_open(const Options *options, const char *path, KrsScene **scene)
{
    (void)options, (void)path;
    *scene = (KrsScene *)&something;
    return KRS_OK;
}

KrsStatus scene_state(const Options *options, const KrsScene *scene, KrsState **state)
{
    (void)options, (void)scene;
    *state = (KrsState *)&something;
    return KRS_OK;
}

KrsStatus open_renderer(const Options *options, KrsRenderer **renderer)
{
    (void)options;
    *renderer = (KrsRenderer *)&something;
    return KRS_OK;
}

KrsStatus krs_rendering_new(KrsRenderer *renderer, const KrsScene *scene, KrsPurpose purpose,
                            KrsRendering **rendering)
{
    (void)renderer, (void)scene, (void)purpose;
    *rendering = (KrsRendering *)&something;
    return KRS_OK;
}

const char *scene_input(const Options *options, const char *path)
{
    (void)options, (void)path;
    return NULL;
}

KrsStatus modules_compile(const Options *options, const KrsScene *scene, Modules *modules)
{
    (void)options, (void)scene;
    *modules = (Modules){0};
    return KRS_OK;
}

/* The search has tests of its own, search.c and refute.c. */
KrsStatus krs_refute(const char *text, size_t length, const char *name, const KrsOptions *options,
                     const KrsRefuteOptions *how, KrsRefutation *result)
{
    (void)text, (void)length, (void)name, (void)options, (void)how;
    *result = (KrsRefutation){.refuted = search_refutes};
    return search_refutes ? KRS_BAD_SCENE : KRS_OK;
}

KrsOptions scene_options(DiagnosticSink *sink, const char *path)
{
    (void)sink, (void)path;
    return (KrsOptions){0};
}

/* Returns what `krs watch` is asked to write. */
const MeshFormat *mesh_format(const char *path)
{
    (void)path;
    return NULL;
}

FileForm file_form(const char *path)
{
    (void)path;
    return FORM_UNKNOWN;
}

void scene_print_counts(const DiagnosticSink *sink) { (void)sink; }
void modules_free(Modules *modules) { (void)modules; }
void krs_rendering_free(KrsRendering *rendering) { (void)rendering; }
void krs_renderer_free(KrsRenderer *renderer) { (void)renderer; }
void krs_state_free(KrsState *state) { (void)state; }
void krs_scene_free(KrsScene *scene) { (void)scene; }
void stage_enter(RunStage stage) { (void)stage; }

const char *krs_renderer_message(const KrsRenderer *renderer)
{
    (void)renderer;
    return "";
}

KrsDevice krs_renderer_device(const KrsRenderer *renderer)
{
    (void)renderer;
    return (KrsDevice){.name = "a device"};
}

const volatile sig_atomic_t *interrupted(void)
{
    static volatile sig_atomic_t never;
    return &never;
}

/* The tests. */

static KrsStatus validate(void)
{
    jmp_buf exhausted;
    if (setjmp(exhausted) != 0)
        return KRS_OUT_OF_MEMORY;
    Memory  memory  = {.exhausted = &exhausted};
    Arena   arena   = {.memory = &memory};
    Options options = {.arena = &arena};
    char   *words[] = {"krs", "validate", "--quiet", "--points", "4000", "ball.krs"};
    assert_int_equal(options_parse(&options, 6, words), KRS_OK);
    KrsStatus status = command_validate(&options);
    arena_free(&arena);
    return status;
}

static int be_honest(void **state)
{
    (void)state;
    exaggeration = inside_factor = 1;
    not_a_number                 = false;
    device_error                 = 0;
    an_estimate = search_refutes = false;
    return 0;
}

static void an_honest_scene_passes(void **state)
{
    (void)state;
    assert_int_equal(validate(), KRS_OK);
}

static void what_the_search_refutes_is_refuted(void **state)
{
    (void)state;
    search_refutes = true;
    assert_int_equal(validate(), KRS_BAD_SCENE);
}

static void a_cautious_scene_passes(void **state)
{
    (void)state;
    exaggeration = inside_factor = 0.3;
    assert_int_equal(validate(), KRS_OK);
}

static void two_per_cent_too_much_is_refuted(void **state)
{
    (void)state;
    exaggeration = 1.02;
    assert_int_equal(validate(), KRS_BAD_SCENE);
}

static void too_much_inside_is_refuted(void **state)
{
    (void)state;
    inside_factor = 1.02;
    assert_int_equal(validate(), KRS_BAD_SCENE);
}

static void what_is_not_a_number_is_refuted(void **state)
{
    (void)state;
    not_a_number = true;
    assert_int_equal(validate(), KRS_BAD_SCENE);
}

static void a_device_that_disagrees_is_refuted(void **state)
{
    (void)state;
    device_error = 1e-3;
    assert_int_equal(validate(), KRS_BAD_SCENE);
    device_error = NAN;
    assert_int_equal(validate(), KRS_BAD_SCENE);
}

static void rounding_of_a_device_passes(void **state)
{
    (void)state;
    device_error = 1e-6;
    assert_int_equal(validate(), KRS_OK);
}

/* Returns the largest part of the way to the surface that validate finds the distance to be. */
static double measured(KrsStatus expected)
{
    static Validation v;
    v = (Validation){.random = 1, .state = (KrsState *)&something, .scene = (KrsScene *)&something};
    choose_box(&v);
    choose_points(&v);
    assert_int_equal(try_balls(&v), expected);
    assert_true(v.estimates > 500);
    assert_int_equal(v.balls, 0);
    return v.reached;
}

static void an_estimate_is_measured(void **state)
{
    (void)state;
    an_estimate = true;
    assert_float_equal(measured(KRS_OK), 1, 0.01);
    exaggeration = inside_factor = 0.6;
    assert_float_equal(measured(KRS_OK), 0.6, 0.01);
    assert_int_equal(validate(), KRS_OK);
    exaggeration = 1.3;
    assert_float_equal(measured(KRS_BAD_SCENE), 1.3, 0.02);
    assert_int_equal(validate(), KRS_BAD_SCENE);
}

int main(void)
{
#define HONEST(test) cmocka_unit_test_setup(test, be_honest)
    const struct CMUnitTest tests[] = {
        HONEST(an_honest_scene_passes),
        HONEST(what_the_search_refutes_is_refuted),
        HONEST(a_cautious_scene_passes),
        HONEST(two_per_cent_too_much_is_refuted),
        HONEST(too_much_inside_is_refuted),
        HONEST(what_is_not_a_number_is_refuted),
        HONEST(a_device_that_disagrees_is_refuted),
        HONEST(rounding_of_a_device_passes),
        HONEST(an_estimate_is_measured),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
