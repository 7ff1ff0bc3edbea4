/*
 * view.c: a viewer of one's own: view SCENE.krs
 *
 * The left button turns, the wheel goes nearer, a click says what is there, Q ends.  A file that was
 * saved is compiled in the background.  This needs the library, GLFW and OpenGL:
 *
 *     cc -Iinclude -o view examples/c/view.c build/libkrs.a $(make libs) -lglfw -lGL
 */
#include <GLFW/glfw3.h>
#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include <krs/camera.h>
#include <krs/vulkan.h>

/* While something moves, each side of a picture has fewer pixels by the factor COARSE. */
enum { SAMPLES = 8, COARSE = 4 };

/* A scene on a device.  There are two: one is shown, one compiles; then they change places. */
typedef struct Stage {
    KrsRenderer     *renderer;
    KrsScene        *scene;
    KrsState        *state;
    KrsRendering    *rendering; /* NULL: the scene does not compile */
    KrsFilm         *film;
    KrsRenderOptions size; /* of the film */
} Stage;

static Stage       stages[2], *shown = &stages[0];
static const char *path;
static struct stat saved; /* the file, when it was read last */
static pthread_t   compiler;
static bool        compiles; /* there is such a thread */
static atomic_bool ends;     /* its work is done */
static KrsCamera   camera;
static double      mouse_x, mouse_y;
static bool        moved, dragged; /* since the last picture; since the button is down */

/* ---- scenes on a device ---- */

static void report(void *user, const KrsDiagnostic *diagnostic)
{
    (void)user;
    fputs(diagnostic->text, stderr);
}

static void clear(Stage *stage)
{
    krs_film_free(stage->film);
    krs_rendering_free(stage->rendering);
    krs_state_free(stage->state);
    krs_scene_free(stage->scene);
    *stage = (Stage){.renderer = stage->renderer};
}

/* Reads the file and compiles its shaders; the renderer stays open, with the kernels it has made. */
static void *prepare(void *at)
{
    const KrsOptions options = {
        .diagnostic = report, .specialize = KRS_SPECIALIZE_STRUCTURE, .studio = true};
    Stage *stage = at;
    clear(stage);
    if ((stage->renderer || krs_renderer_new(NULL, &stage->renderer) == KRS_OK) &&
        krs_compile_file(path, &options, &stage->scene) == KRS_OK &&
        krs_state_new(stage->scene, &stage->state) == KRS_OK)
        krs_rendering_new(stage->renderer, stage->scene, KRS_FOR_PICTURES, &stage->rendering);
    atomic_store(&ends, true);
    glfwPostEmptyEvent();
    return NULL;
}

/* Compiles the file when it was saved, and shows what has been compiled. */
static void follow_file(void)
{
    Stage      *hidden = &stages[shown == &stages[0]];
    struct stat now;
    if (!compiles && stat(path, &now) == 0 &&
        memcmp(&now.st_mtim, &saved.st_mtim, sizeof now.st_mtim) != 0) {
        saved = now;
        atomic_store(&ends, false);
        compiles = pthread_create(&compiler, NULL, prepare, hidden) == 0;
    } else if (compiles && atomic_load(&ends)) {
        compiles = pthread_join(compiler, NULL) != 0;
        if (!shown->rendering && hidden->rendering)
            krs_state_camera(hidden->state, 0, &camera); /* to begin with */
        shown = hidden->rendering ? hidden : shown;
        moved = true;
    }
}

/* ---- pictures ---- */

/* Draws what the film has, as large as the window.  OpenGL 1.1 is enough for that. */
static void draw(GLFWwindow *window, int width, int height)
{
    const KrsRenderOptions *size   = &shown->size;
    uint8_t                *pixels = malloc((size_t)size->width * size->height * 4);
    KrsPicture             *picture;
    if (pixels && krs_film_read(shown->film, KRS_AOV_COLOR, &picture) == KRS_OK) {
        krs_picture_to_srgb8(picture, shown->scene, 0, 4, pixels);
        krs_picture_free(picture);
        glViewport(0, 0, width, height);
        glRasterPos2i(-1, 1); /* the first row is at the top */
        glPixelZoom((float)width / size->width, -(float)height / size->height);
        glDrawPixels(size->width, size->height, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
        glfwSwapBuffers(window);
    }
    free(pixels);
}

/* Draws a coarse picture of what has moved, or adds a sample.  Whether there is more to do. */
static bool refine(GLFWwindow *window)
{
    int width, height;
    glfwGetFramebufferSize(window, &width, &height);
    const bool             coarse  = moved;
    const int              divisor = coarse ? COARSE : 1;
    const KrsRenderOptions size    = {
           .width = width / divisor, .height = height / divisor, .samples = SAMPLES};
    if (!shown->rendering || size.width == 0 || size.height == 0)
        return false; /* not compiled yet, or minimised */
    if (coarse || shown->size.width != size.width || shown->size.height != size.height) {
        krs_film_free(shown->film);
        if (krs_film_new(shown->rendering, &size, &shown->film) != KRS_OK)
            exit(1);
        shown->size = size;
        moved       = false;
    }
    if (krs_film_samples(shown->film) < SAMPLES)
        krs_film_add(shown->film, shown->state, &camera, 1);
    draw(window, width, height);
    return coarse || krs_film_samples(shown->film) < SAMPLES;
}

/* ---- the mouse and keys ---- */

static void on_move(GLFWwindow *window, double x, double y)
{
    if (glfwGetMouseButton(window, GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS) {
        krs_camera_orbit(&camera, (mouse_x - x) / 150, (y - mouse_y) / 150);
        dragged = moved = true;
    }
    mouse_x = x;
    mouse_y = y;
}

static void on_scroll(GLFWwindow *window, double aside, double steps)
{
    (void)window, (void)aside;
    krs_camera_dolly(&camera, NULL, pow(0.9, steps));
    moved = true;
}

/* A click says what is under the mouse: the picture of a pixel knows. */
static void on_button(GLFWwindow *window, int button, int action, int modifiers)
{
    KrsPicture  *picture;
    KrsComponent component;
    (void)window, (void)button, (void)modifiers;
    dragged = dragged && action != GLFW_PRESS;
    if (action == GLFW_PRESS || dragged || !shown->film ||
        krs_film_read(shown->film, KRS_AOV_IDS | KRS_AOV_POSITION, &picture) != KRS_OK)
        return;
    const size_t pixel = (size_t)mouse_y * picture->width + (size_t)mouse_x;
    const float *at    = &picture->position[3 * pixel];
    if (pixel < (size_t)picture->width * picture->height &&
        krs_component(shown->scene, picture->component[pixel] - 1, &component) == KRS_OK)
        printf("%s at %.3f, %.3f, %.3f\n", component.name, at[0], at[1], at[2]);
    fflush(stdout);
    krs_picture_free(picture);
}

int main(int argc, char **argv)
{
    path               = argc == 2 ? argv[1] : "examples/01-hello.krs";
    GLFWwindow *window = glfwInit() ? glfwCreateWindow(640, 360, path, NULL, NULL) : NULL;
    if (!window)
        return 1;
    glfwMakeContextCurrent(window);
    glfwSetCursorPosCallback(window, on_move);
    glfwSetScrollCallback(window, on_scroll);
    glfwSetMouseButtonCallback(window, on_button);
    glfwSetInputMode(window, GLFW_STICKY_KEYS, GLFW_TRUE); /* short strokes are not missed */
    while (!glfwWindowShouldClose(window) && !glfwGetKey(window, GLFW_KEY_Q)) {
        follow_file();
        glfwWaitEventsTimeout(refine(window) ? 0 : 0.2);
    }
    if (compiles)
        pthread_join(compiler, NULL);
    for (int i = 0; i < 2; i++) {
        clear(&stages[i]);
        krs_renderer_free(stages[i].renderer);
    }
    glfwTerminate();
}
