/*
 * program.c: what a program sees of the library, as text: api.sh compiles it with headers of before and
 * of later, which must change nothing.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <krs/camera.h>
#include <krs/vulkan.h>

/* Structs of this program, with bytes behind them that nobody may write to. */
enum { GUARD = 256 };
#define GUARDED(type, name, many)   \
    struct {                        \
        type          is[many];     \
        unsigned char guard[GUARD]; \
    } name;                         \
    memset(&name, 0xa5, sizeof name)

static int failures;

static void check(bool good, const char *what)
{
    if (!good)
        printf("FAILED: %s\n", what);
    failures += !good;
}

static void check_guard(const unsigned char *guard, const char *what)
{
    int same = 0;
    while (same < GUARD && guard[same] == 0xa5)
        same++;
    check(same == GUARD, what);
}

static void print_hit(const KrsHit *hit)
{
    printf("hit %d %d t %.3f at %.3f %.3f %.3f distance %.3f normal %.3f %.3f %.3f shading %.3f\n",
           hit->hit, hit->unresolved, hit->t, hit->point[0], hit->point[1], hit->point[2],
           hit->distance, hit->normal[0], hit->normal[1], hit->normal[2], hit->shading[2]);
    printf(
        "    part %u %u %u material %u color %.3f %.3f %.3f roughness %.3f subsurface %.3f %.3f\n",
        hit->component, hit->level, hit->instance, hit->material, hit->color[0], hit->color[1],
        hit->color[2], hit->roughness, hit->subsurface_weight, hit->subsurface_color[1]);
}

static const double points[3][3]     = {{0, 0, 2}, {3, 0, 1}, {0, 3, 0}};
static const double origins[3][3]    = {{0, 0, 9}, {3, 0, 9}, {0, 9, 9}};
static const double directions[3][3] = {{0, 0, -1}, {0, 0, -1}, {0, 1, 0}};

static void tell_scene(const KrsScene *scene, KrsState *state)
{
    GUARDED(KrsParameter, parameter, 1);
    check(krs_parameter(scene, 0, parameter.is) == KRS_OK, "a parameter");
    printf("parameter %s %.2f in %.2f %.2f from %u\n", parameter.is->name, parameter.is->value[0],
           parameter.is->low[0], parameter.is->high[0], parameter.is->start);
    check_guard(parameter.guard, "a parameter is too long");
    GUARDED(KrsComponent, component, 1);
    for (size_t i = 0; i < krs_component_count(scene); i++) {
        check(krs_component(scene, i, component.is) == KRS_OK, "a component");
        printf("component %s to %.2f slope %.2f\n", component.is->name, component.is->high[0],
               component.is->slope);
        check_guard(component.guard, "a component is too long");
    }
    GUARDED(KrsBound, bound, 1);
    check(krs_bound(scene, 0, 0, bound.is) == KRS_OK, "a bound");
    printf("bound %s line %u\n", bound.is->name, bound.is->line);
    check_guard(bound.guard, "a bound is too long");
    GUARDED(KrsCamera, camera, 1);
    check(krs_state_camera(state, 0, camera.is) == KRS_OK, "a camera");
    krs_camera_orbit(camera.is, 0.1, 0.2);
    printf("camera %.3f %.3f %.3f fov %.3f\n", camera.is->eye[0], camera.is->eye[1],
           camera.is->eye[2], camera.is->fov);
    check_guard(camera.guard, "a camera is too long");
    GUARDED(KrsLight, light, 1);
    check(krs_state_light(state, 0, light.is) == KRS_OK, "a light");
    printf("light %d %.3f %.3f %.3f color %.3f\n", light.is->positional, light.is->vector[0],
           light.is->vector[1], light.is->vector[2], light.is->color[1]);
    check_guard(light.guard, "a light is too long");
    GUARDED(KrsSky, sky, 1);
    check(krs_state_sky(state, sky.is) == KRS_OK, "the sky");
    printf("sky %.3f %d\n", sky.is->zenith[2], sky.is->map != NULL);
    check_guard(sky.guard, "a sky is too long");
    GUARDED(KrsFog, fog, 1);
    check(krs_state_fog(state, fog.is) == KRS_OK, "the fog");
    printf("fog %.3f\n", fog.is->color[0]);
    check_guard(fog.guard, "a fog is too long");
    char *text;
    GUARDED(KrsTextOptions, how, 1);
    how.is[0] = (KrsTextOptions){.state_values = true};
    check(krs_text(scene, KRS_TARGET_GLSL, how.is, &text) == KRS_OK, "a text");
    printf("text of %zu bytes\n", text ? strlen(text) : 0);
    free(text);
    const KrsImage image = krs_scene_image(scene);
    printf("image %u x %u, %u\n", image.width, image.height, image.samples);
}

static void ask_host(KrsState *state)
{
    GUARDED(KrsHit, hits, 3);
    check(krs_probe(state, points, 3, hits.is) == KRS_OK, "probes");
    for (int i = 0; i < 3; i++)
        print_hit(&hits.is[i]);
    check_guard(hits.guard, "probes are too long");
    check(krs_raycast(state, origins, directions, 3, 100, 0, hits.is) == KRS_OK, "rays");
    for (int i = 0; i < 3; i++)
        print_hit(&hits.is[i]);
    check_guard(hits.guard, "rays are too long");
}

static void make_shapes(KrsState *state)
{
    KrsMesh *mesh;
    GUARDED(KrsMeshOptions, how, 1);
    how.is[0] = (KrsMeshOptions){.error = 0.05, .component = 2};
    check(krs_mesh(state, how.is, &mesh) == KRS_OK, "a mesh");
    printf("mesh of %zu triangles\n", mesh ? mesh->triangle_count : 0);
    krs_mesh_free(mesh);
    KrsGrid *grid;
    GUARDED(KrsGridOptions, cells, 1);
    cells.is[0] = (KrsGridOptions){.cell = 0.25};
    check(krs_grid_new(state, cells.is, &grid) == KRS_OK, "a grid");
    const KrsGridShape shape = krs_grid_shape(grid);
    printf("grid of %zu x %zu x %zu, %d\n", shape.count[0], shape.count[1], shape.count[2],
           (int)shape.first[2]);
    krs_grid_free(grid);
    KrsSlicer  *slicer;
    KrsSection *section = NULL;
    GUARDED(KrsSliceOptions, planes, 1);
    planes.is[0] = (KrsSliceOptions){.component = 2};
    check(krs_slicer_new(state, planes.is, &slicer) == KRS_OK, "a slicer");
    check(krs_slice(slicer, &(KrsSectionPlane){.normal = {0, 0, 1}}, 1, &section) == KRS_OK,
          "a section");
    printf("section of %.3f\n", section ? section->contours[0].area : 0);
    krs_section_free(section);
    krs_slicer_free(slicer);
    KrsMeasures *measures;
    check(krs_measure(state, &(KrsMeasureOptions){.component = 2, .up = {0, 0, 1}}, &measures) ==
              KRS_OK,
          "figures");
    printf("volume %.2f\n", measures ? measures->volume : 0);
    krs_measures_free(measures);
}

static void edit(const KrsScene *scene)
{
    static const char text[] = "param r = 1 in [0.5, 2]; show sphere(r);";
    KrsScene         *updated;
    GUARDED(KrsChanges, changes, 1);
    check(krs_scene_update(scene, text, strlen(text), &updated, changes.is) == KRS_OK, "an edit");
    printf("edit %d %d %d\n", changes.is->kind, changes.is->components, changes.is->parameters);
    check_guard(changes.guard, "changes are too long");
    krs_scene_free(updated);
}

static double sum_of(const KrsPicture *picture)
{
    double sum = 0;
    for (size_t i = 0; picture && i < (size_t)4 * picture->width * picture->height; i++)
        sum += picture->color[i];
    return sum;
}

static void render(KrsRendering *rendering, KrsState *state)
{
    KrsPicture *picture;
    GUARDED(KrsRenderOptions, options, 1);
    options.is[0] = (KrsRenderOptions){
        .width = 32, .height = 24, .aovs = KRS_AOV_COLOR | KRS_AOV_STEPS};
    check(krs_render(rendering, state, options.is, &picture) == KRS_OK, "a picture");
    printf("picture %u x %u %.4f, steps %d, rays %d, %s %s\n", picture->width, picture->height,
           sum_of(picture), picture->steps != NULL, (int)picture->stats.rays,
           krs_phase_names[KRS_PHASE_PRIMARY], krs_trace_names[KRS_TRACE_RELAXED]);
    krs_picture_free(picture);
    KrsFilm  *film;
    KrsCamera camera;
    check(krs_state_camera(state, 0, &camera) == KRS_OK, "a camera again");
    check(krs_film_new(rendering, options.is, &film) == KRS_OK, "a film");
    check(krs_film_add(film, state, &camera, 2) == KRS_OK, "samples");
    check(krs_film_read(film, 0, &picture) == KRS_OK, "the film's picture");
    printf("film %.4f\n", sum_of(picture));
    krs_picture_free(picture);
    krs_film_free(film);
    GUARDED(KrsShaderStats, shaders, 2);
    printf("shaders %d", krs_rendering_shaders(rendering, shaders.is, 2) > 2);
    printf(" %s, %s\n", shaders.is[0].name, shaders.is[1].name);
    check_guard(shaders.guard, "shaders are too long");
}

static void ask_device(KrsRendering *rendering, KrsState *state)
{
    static const float at[3][3] = {{0, 0, 2}, {3, 0, 1}, {0, 3, 0}};
    float              distances[3];
    check(krs_device_distance(rendering, state, at, 3, distances) == KRS_OK, "distances");
    for (int i = 0; i < 3; i++)
        printf("distance %.3f\n", distances[i]);
    GUARDED(KrsHit, hits, 3);
    check(krs_device_probe(rendering, state, points, 3, hits.is) == KRS_OK, "probes of the device");
    for (int i = 0; i < 3; i++)
        print_hit(&hits.is[i]);
    check(krs_device_raycast(rendering, state, origins, directions, 3, 100, 0.001, hits.is) ==
              KRS_OK,
          "rays of the device");
    for (int i = 0; i < 3; i++)
        print_hit(&hits.is[i]);
    check_guard(hits.guard, "answers of the device are too long");
}

static void use_device(const KrsScene *scene, KrsState *state)
{
    size_t        count;
    KrsRenderer  *renderer;
    KrsRendering *rendering;
    GUARDED(KrsDevice, devices, 2);
    check(krs_devices(devices.is, 2, &count) == KRS_OK && count > 0, "devices");
    printf("device %s\n", devices.is[count > 1].name);
    check_guard(devices.guard, "devices are too long");
    KrsRendererOptions options = {.device = getenv("KRS_DEVICE")};
    if (krs_renderer_new(&options, &renderer) != KRS_OK) {
        check(false, "a renderer");
        return;
    }
    const KrsDevice device = krs_renderer_device(renderer);
    printf("it is %s, usable %d\n", device.name, device.usable);
    check(krs_rendering_new(renderer, scene, KRS_FOR_PICTURES, &rendering) == KRS_OK,
          "a rendering");
    render(rendering, state);
    ask_device(rendering, state);
    krs_rendering_free(rendering);
    krs_renderer_free(renderer);
}

#ifdef LATER
/* What the library does not know may not be asked for. */
static void ask_for_more(KrsState *state)
{
    KrsMesh  *mesh;
    KrsScene *scene;
    check(krs_mesh(state, &(KrsMeshOptions){.error = 0.05, .later = 1}, &mesh) ==
                  KRS_BAD_ARGUMENT &&
              !mesh,
          "a mesh by an option of later");
    check(krs_compile_text("", 0, "b", &(KrsOptions){.later = 1}, &scene) == KRS_BAD_ARGUMENT &&
              !scene,
          "a scene by an option of later");
    KrsHit hits[2];
    memset(hits, 0xa5, sizeof hits);
    check(krs_probe(state, points, 2, hits) == KRS_OK && hits[0].later == 0 && hits[1].later == 0,
          "a property of later is 0");
}
#endif

int main(void)
{
    static const char text[] = "camera { eye: [0, 0, 12], target: [0, 0, 0] }\n"
                               "param r = 1 in [0.5, 2];\n"
                               "material clay { color: [0.5, 0.25, 0.125], roughness: 0.75 }\n"
                               "let ball = sphere(r).paint(clay);\n"
                               "let block = box([2, 2, 2]).move([3, 0, 0]);\n"
                               "show ball; show block;\n";
    KrsScene         *scene;
    KrsState         *state;
    GUARDED(KrsOptions, options, 1);
    options.is[0] = (KrsOptions){.studio = true};
    if (krs_compile_text(text, strlen(text), "a.krs", NULL, &scene) != KRS_OK ||
        krs_state_new(scene, &state) != KRS_OK)
        return 2;
    tell_scene(scene, state);
    ask_host(state);
    make_shapes(state);
    edit(scene);
    use_device(scene, state);
#ifdef LATER
    ask_for_more(state);
#endif
    krs_state_free(state);
    krs_scene_free(scene);
    check(krs_compile_text(text, strlen(text), "a.krs", options.is, &scene) == KRS_OK, "options");
    printf("%zu components in a studio\n", krs_component_count(scene));
    krs_scene_free(scene);
    return failures > 0;
}
