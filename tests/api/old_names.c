/*
 * old_names.c: a program for 0.2: it has each old name (krs/deprecated.h), and is told the right things.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <krs/camera.h>
#include <krs/vulkan.h>

static int failures;

static void check(bool good, const char *what)
{
    if (!good)
        printf("FAILED: %s\n", what);
    failures += !good;
}

static bool near(double a, double b) { return fabs(a - b) < 1e-6; }

/* The slope of the field depends on the time: no constant bounds it. */
static const char text[] = "param r = 1 in [0.5, 2];\n"
                           "let ball = sphere(r);\n"
                           "show ball;\n"
                           "show field(y + 9 - sin(x * time));\n";

static void use_values(const KrsScene *scene, KrsFrame *frame)
{
    check(krs_frame_set(frame, "r", (double[]){1.5}, 1) == KRS_OK, "a parameter");
    check(krs_frame_set_time(frame, 0.5) == KRS_OK && krs_frame_time(frame) == 0.5, "the time");
    float block[32][4] = {{0}}, rows[8][4] = {{0}};
    check(krs_parameter_slots(scene) <= 16 && krs_value_slots(scene) <= 16, "few slots");
    krs_frame_parameters(frame, block);
    check(block[0][0] == 0.5F && block[1][0] == 1.5F, "the parameters");
    krs_frame_values(frame, block + krs_parameter_slots(scene));
    check(krs_table_rows(scene) == 0, "no tables");
    krs_frame_tables(frame, rows, NULL);
    KrsFrameSlope slope;
    check(krs_frame_slope_count(scene) == 1 && krs_frame_slope(scene, 0, &slope) == KRS_OK &&
              slope.slot == 2 && strcmp(slope.place, "a.krs:4:6") == 0,
          "a slope");
    check(!krs_frame_unbounded(frame), "slopes are bounded");
}

static void use_places(KrsFrame *frame)
{
    double       low[3], high[3];
    double       distance;
    const double point[1][3] = {{0, 0, 3}}, zone[1][4] = {{0, 0, 2, 1}};
    KrsCamera    camera;
    check(krs_frame_place_camera(frame) == KRS_OK, "a place of the camera");
    check(krs_frame_camera(frame, 0, &camera) == KRS_OK, "a camera");
    const double eye = camera.eye[0];
    krs_camera_turn(&camera, 0.5, 0);
    check(camera.eye[0] != eye, "an orbit");
    check(krs_frame_component_box(frame, 0, low, high) && near(high[2], 1.5), "a box");
    check(krs_frame_box(frame, low, high) && near(high[0], 1.5), "a box around all");
    check(krs_frame_set_zones(frame, zone, 1) == KRS_OK, "zones");
    check(krs_distance(frame, point, 1, &distance) == KRS_OK && distance > 0.5 + 1e-6,
          "a distance");
}

static void use_limits(void)
{
    check(KRS_MOST_ZONES == 16 && KRS_MOST_STEPS == 100000, "limits of questions");
    check(KRS_MOST_COORDINATE == 1e18, "the farthest coordinate");
    check(KRS_MOST_SIDE == 16384 && KRS_MOST_SAMPLES == 65536 && KRS_MOST_ERROR == 1000,
          "limits of pictures");
    check(KRS_MOST_BOUNCES == 1000 && KRS_MOST_EVEN_HITS == 16, "limits of paths");
    check(KRS_MOST_REFLECTANCE == 0.99 && KRS_MOST_LIGHT_GROUPS == 240, "limits of light");
    check(KRS_LEAST_NOISY_SAMPLES == 16, "samples at least");
}

static void hear(void *user, const char *message)
{
    (void)user;
    (void)message;
}

static bool wait(void *user, double done)
{
    (void)user;
    return done <= 1;
}

static KrsCompilingCallback *const waits = wait;

/* Members and choices are those of the new names. */
static void use_members(void)
{
    const KrsRenderOptions options = {
        .most_radiance = 2, .most_steps = 99, .planes = KRS_PLANE_COLOR | KRS_PLANE_DEPTH};
    const KrsPlane color = KRS_PLANE_COLOR;
    check(options.aovs == (KRS_AOV_COLOR | KRS_AOV_DEPTH) && color == KRS_AOV_COLOR, "AOVs");
    check(options.max_radiance == 2 && options.methods.max_steps == 99, "options of pictures");
    const KrsRenderOptions methods = {.steps_at_once = 7,
                                      .trace         = KRS_TRACE_PLAIN,
                                      .schedule      = KRS_SCHEDULE_QUEUE,
                                      .components    = KRS_COMPONENTS_TOGETHER,
                                      .normals       = KRS_NORMALS_FORWARD,
                                      .starts        = KRS_STARTS_DISTANCE,
                                      .even_hits     = 3,
                                      .no_beams      = true,
                                      .no_upsampling = true,
                                      .no_filter     = true};
    const KrsMethods       same    = {.steps_at_once = 7,
                                      .trace         = KRS_TRACE_PLAIN,
                                      .schedule      = KRS_SCHEDULE_QUEUE,
                                      .components    = KRS_COMPONENTS_TOGETHER,
                                      .normals       = KRS_NORMALS_FORWARD,
                                      .starts        = KRS_STARTS_DISTANCE,
                                      .even_hits     = 3,
                                      .no_beams      = true,
                                      .no_upsampling = true,
                                      .no_filter     = true};
    check(methods.methods.steps_at_once == same.steps_at_once &&
              methods.methods.trace == same.trace && methods.methods.schedule == same.schedule &&
              methods.methods.components == same.components &&
              methods.methods.normals == same.normals && methods.methods.starts == same.starts &&
              methods.methods.even_hits == same.even_hits && methods.methods.no_beams &&
              methods.methods.no_upsampling && methods.methods.no_filter,
          "methods");
    const KrsRenderStats stats = {.most_evaluations_per_ray = 5, .kernels = 7};
    check(stats.max_evaluations_per_ray == 5 && stats.shaders == 7, "statistics");
    const KrsRendererOptions renderer = {.complaint      = hear,
                                         .compiling      = waits,
                                         .compiling_user = &failures,
                                         .pictures_ahead = true,
                                         .patience       = 9};
    check(renderer.validation_message == hear && renderer.progress == wait &&
              renderer.progress_user == &failures && renderer.prewarm && renderer.timeout == 9,
          "options of a device");
    const KrsComponent component = {.per_frame = true};
    check(component.per_state, "a component");
    const KrsBound bound = {.alike = 3};
    check(bound.similar == 3, "a bound");
    const KrsMeshOptions mesh = {.go_on = wait};
    check(mesh.progress == wait, "options of meshes");
    KrsPlacing        placing  = {.item = 3};
    const KrsAssembly assembly = {.placings = &placing, .placing_count = 1};
    check(assembly.transforms->item == 3 && assembly.transform_count == 1, "an assembly");
}

static void use_texts(const KrsScene *scene, KrsFrame *frame)
{
    KrsPlace     place;
    double       uv[1][2];
    const double point[1][3] = {{0, 0, 1}};
    check(krs_camera_place(scene, 0, &place) == KRS_BAD_ARGUMENT, "the scene has no camera");
    check(krs_texture_places(frame, point, 1, uv) == KRS_OK && isnan(uv[0][0]),
          "there is no texture");
}

static void use_device(const KrsScene *scene, KrsFrame *frame)
{
    KrsRenderer       *renderer;
    KrsRendering      *rendering;
    KrsKernelStats     kernels[2];
    KrsRendererOptions options = {.device = getenv("KRS_DEVICE")};
    if (krs_renderer_new(&options, &renderer) != KRS_OK) {
        check(false, "a renderer");
        return;
    }
    check(krs_rendering_new(renderer, scene, &rendering) == KRS_OK, "a rendering");
    check(krs_rendering_kernels(rendering, kernels, 2) > 2, "kernels");
    check(krs_renderer_complaints(renderer) == 0, "no complaints");
    krs_rendering_free(rendering);
    check(krs_rendering_new_for(renderer, scene, KRS_FOR_QUESTIONS, &rendering) == KRS_OK,
          "a rendering for questions");
    const float     points[2][3] = {{0, 0, 3}, {0, 2, 0}};
    float           distances[2];
    KrsSurfacePoint surfaces[2];
    check(krs_sample(rendering, frame, points, 2, distances, surfaces) == KRS_OK &&
              fabs(distances[0] - 1.5) < 1e-4 && surfaces[1].component == 1 &&
              fabs(surfaces[1].distance - 0.5) < 1e-4 && surfaces[1].normal[1] > 0.99F &&
              surfaces[1].color[0] > 0,
          "samples");
    krs_rendering_free(rendering);
    krs_renderer_free(renderer);
}

/* A file that is none: its text is in the options. */
static void use_files(void)
{
    const KrsOptions options = {.text = "show  sphere(1);\n", .text_length = 17};
    KrsScene        *scene;
    char            *formatted;
    bool             same;
    check(krs_compile_file("no-such.krs", &options, &scene) == KRS_OK, "a text of the options");
    krs_scene_free(scene);
    check(krs_format("no-such.krs", &options, &formatted, &same) == KRS_OK && !same &&
              strcmp(formatted, "show sphere(1);\n") == 0,
          "the layout of a text");
    free(formatted);
}

int main(void)
{
    use_limits();
    use_members();
    use_files();
    KrsScene *scene;
    KrsFrame *frame;
    if (krs_compile_text(text, strlen(text), "a.krs", NULL, &scene) != KRS_OK ||
        krs_frame_new(scene, &frame) != KRS_OK)
        return 2;
    check(krs_frame_update(frame, scene) == KRS_OK, "an update");
    use_values(scene, frame);
    use_places(frame);
    use_texts(scene, frame);
    use_device(scene, frame);
    krs_frame_free(frame);
    krs_scene_free(scene);
    return failures > 0;
}
