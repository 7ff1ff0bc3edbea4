/*
 * view.c: a viewer of one's own: view SCENE.krs
 *
 * The left button turns, the wheel goes nearer, a click says what is there, Q ends.  When the file is
 * saved, another renderer compiles it in the background, and then the two change places.  This needs
 * the library, GLFW and OpenGL:
 *
 *     cc -I. -o view examples/c/view.c build/libkrs.a $(make libs) -lglfw -lGL
 */
#include <GLFW/glfw3.h>
#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "compiler/krs.h"
#include "runtime/krs_vulkan.h"

#define SAMPLES 8
#define COARSE  4 /* a side of a picture has so many times fewer pixels while something moves */

/* A scene on a device.  There are two: one is shown, one compiles. */
typedef struct Stage {
    KrsRenderer  *renderer;
    KrsScene     *scene;
    KrsRendering *rendering;
    KrsFrame     *frame;
    KrsFilm      *films[2]; /* coarse, whole */
    int           width, height;
} Stage;

static Stage       stages[2], *shown = &stages[0];
static const char *path;
static struct stat saved; /* the file, when it was read last */
static KrsCamera   camera;
static bool        moved = true; /* since the last picture */
static double      mouse_x, mouse_y, dragged;
static GLFWwindow *window;
static pthread_t   compiling;
static atomic_int  compiled = 1; /* 0: compiling; 1: nothing to do; 2: ready; 3: failed */

static void report(void *user, const KrsDiagnostic *diagnostic)
{
    (void)user;
    fputs(diagnostic->text, stderr);
}

/* ---- scenes on a device ---- */

static void clear(Stage *stage)
{
    for (int i = 0; i < 2; i++)
        krs_film_free(stage->films[i]);
    krs_rendering_free(stage->rendering);
    krs_frame_free(stage->frame);
    krs_scene_free(stage->scene);
    *stage = (Stage){.renderer = stage->renderer};
}

/* Reads the file and compiles its shaders; the renderer stays open, with the kernels it has made. */
static bool prepare(Stage *stage)
{
    const KrsOptions options = {
        .diagnostic = report, .specialize = KRS_SPECIALIZE_STRUCTURE, .studio = true};
    clear(stage);
    if (!stage->renderer && krs_renderer_new(NULL, &stage->renderer) != KRS_OK)
        return false;
    return krs_compile_file(path, &options, &stage->scene) == KRS_OK &&
           krs_frame_new(stage->scene, &stage->frame) == KRS_OK &&
           krs_rendering_new(stage->renderer, stage->scene, &stage->rendering) == KRS_OK;
}

static void *prepare_in_background(void *other)
{
    atomic_store(&compiled, prepare(other) ? 2 : 3);
    glfwPostEmptyEvent();
    return NULL;
}

/* Compiles a file that was saved, and shows what has been compiled. */
static void follow_file(void)
{
    struct stat now;
    Stage      *other = shown == &stages[0] ? &stages[1] : &stages[0];
    if (atomic_load(&compiled) > 1) {
        pthread_join(compiling, NULL);
        if (atomic_exchange(&compiled, 1) == 2) {
            shown = other;
            moved = true;
        }
    } else if (atomic_load(&compiled) == 1 && stat(path, &now) == 0 &&
               (now.st_mtim.tv_sec != saved.st_mtim.tv_sec ||
                now.st_mtim.tv_nsec != saved.st_mtim.tv_nsec)) {
        saved = now;
        atomic_store(&compiled, 0);
        if (pthread_create(&compiling, NULL, prepare_in_background, other) != 0)
            atomic_store(&compiled, 1);
    }
}

/* ---- pictures ---- */

/* Films are of one size. */
static bool make_films(int width, int height)
{
    if (shown->films[1] && shown->width == width && shown->height == height)
        return true;
    bool made = true;
    for (int i = 0; i < 2; i++) {
        const int              divisor = i == 0 ? COARSE : 1;
        const KrsRenderOptions options = {.width   = (uint32_t)fmax(width / divisor, 1),
                                          .height  = (uint32_t)fmax(height / divisor, 1),
                                          .samples = i == 0 ? 1 : SAMPLES};
        krs_film_free(shown->films[i]);
        made = krs_film_new(shown->rendering, &options, &shown->films[i]) == KRS_OK && made;
    }
    shown->width  = width;
    shown->height = height;
    return made;
}

/* Hands the picture of a film to OpenGL. */
static void upload(KrsFilm *film)
{
    KrsPicture *picture;
    if (krs_film_read(film, KRS_PLANE_COLOR, &picture) != KRS_OK)
        return;
    uint8_t *pixels = malloc((size_t)picture->width * picture->height * 4);
    if (pixels && krs_picture_to_srgb8(picture, shown->scene, 0, 4, pixels) == KRS_OK)
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, (GLsizei)picture->width, (GLsizei)picture->height,
                     0, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
    free(pixels);
    krs_picture_free(picture);
}

/* One step: a coarse picture of what has moved, or another sample of what has not.  Whether there
   is more to do. */
static bool refine(void)
{
    int width, height;
    glfwGetFramebufferSize(window, &width, &height);
    if (width == 0 || height == 0)
        return false; /* minimised */
    moved = moved || width != shown->width || height != shown->height;
    if (!make_films(width, height))
        return false;
    KrsFilm *film = shown->films[moved ? 0 : 1];
    if (moved) {
        krs_film_clear(shown->films[0]);
        krs_film_clear(shown->films[1]);
    }
    moved = false;
    if (krs_film_samples(film) < SAMPLES && krs_film_add(film, shown->frame, &camera, 1) == KRS_OK)
        upload(film);
    return krs_film_samples(shown->films[1]) < SAMPLES;
}

/* OpenGL 1.1 is enough for a texture over the whole window. */
static void draw(void)
{
    static const int corners[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    int              width, height;
    glfwGetFramebufferSize(window, &width, &height);
    glViewport(0, 0, width, height);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glEnable(GL_TEXTURE_2D);
    glBegin(GL_QUADS);
    for (int i = 0; i < 4; i++) {
        glTexCoord2i(corners[i][0], 1 - corners[i][1]);
        glVertex2i(2 * corners[i][0] - 1, 2 * corners[i][1] - 1);
    }
    glEnd();
    glfwSwapBuffers(window);
}

/* ---- the mouse ---- */

/* Turns the eye around the target. */
static void on_move(GLFWwindow *from, double x, double y)
{
    const double right = (x - mouse_x) / 150, up = (y - mouse_y) / 150;
    mouse_x = x;
    mouse_y = y;
    if (glfwGetMouseButton(from, GLFW_MOUSE_BUTTON_LEFT) != GLFW_PRESS)
        return;
    double sight[3];
    for (int i = 0; i < 3; i++)
        sight[i] = camera.eye[i] - camera.target[i];
    const double distance = sqrt(sight[0] * sight[0] + sight[1] * sight[1] + sight[2] * sight[2]);
    const double around   = atan2(sight[0], sight[2]) - right;
    const double above    = fmin(fmax(asin(sight[1] / distance) + up, -1.5), 1.5);
    camera.eye[0]         = camera.target[0] + distance * cos(above) * sin(around);
    camera.eye[1]         = camera.target[1] + distance * sin(above);
    camera.eye[2]         = camera.target[2] + distance * cos(above) * cos(around);
    dragged += fabs(right) + fabs(up);
    moved = true;
}

static void on_scroll(GLFWwindow *from, double aside, double steps)
{
    (void)from, (void)aside;
    for (int i = 0; i < 3; i++)
        camera.eye[i] = camera.target[i] + (camera.eye[i] - camera.target[i]) * pow(0.9, steps);
    moved = true;
}

/* What is behind this point of the window: the picture of a pixel knows. */
static void on_button(GLFWwindow *from, int button, int action, int modifiers)
{
    KrsPicture *picture;
    (void)from, (void)button, (void)modifiers;
    if (action == GLFW_PRESS)
        dragged = 0;
    if (action == GLFW_PRESS || dragged > 0 || !shown->films[1] ||
        krs_film_read(shown->films[1], KRS_PLANE_IDS | KRS_PLANE_POSITION, &picture) != KRS_OK)
        return;
    const size_t at = (size_t)mouse_y * picture->width + (size_t)mouse_x;
    KrsComponent component;
    if (at < (size_t)picture->width * picture->height && picture->component[at] > 0 &&
        krs_component(shown->scene, picture->component[at] - 1, &component) == KRS_OK)
        printf("%s at %.3f, %.3f, %.3f\n", component.name, (double)picture->position[3 * at],
               (double)picture->position[3 * at + 1], (double)picture->position[3 * at + 2]);
    fflush(stdout);
    krs_picture_free(picture);
}

static void on_key(GLFWwindow *from, int key, int code, int action, int modifiers)
{
    (void)code, (void)action, (void)modifiers;
    glfwSetWindowShouldClose(from, key == GLFW_KEY_Q);
}

int main(int argc, char **argv)
{
    path = argc == 2 ? argv[1] : "examples/01-hello.krs";
    stat(path, &saved);
    if (!prepare(shown) || !glfwInit())
        return 1;
    krs_frame_camera(shown->frame, 0, &camera);
    window = glfwCreateWindow(640, 360, path, NULL, NULL);
    if (!window)
        return 1;
    glfwMakeContextCurrent(window);
    glfwSetCursorPosCallback(window, on_move);
    glfwSetScrollCallback(window, on_scroll);
    glfwSetMouseButtonCallback(window, on_button);
    glfwSetKeyCallback(window, on_key);
    for (bool more = true; !glfwWindowShouldClose(window);) {
        if (more)
            glfwPollEvents();
        else
            glfwWaitEventsTimeout(0.2);
        follow_file();
        more = refine();
        draw();
    }
    if (atomic_load(&compiled) != 1)
        pthread_join(compiling, NULL);
    for (int i = 0; i < 2; i++) {
        clear(&stages[i]);
        krs_renderer_free(stages[i].renderer);
    }
    glfwTerminate();
    return 0;
}
