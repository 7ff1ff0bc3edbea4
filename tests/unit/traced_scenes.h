/*
 * traced_scenes.h: scenes on a renderer that the validation layers watch, and pictures of them that
 * are compared bit by bit.
 */
#ifndef UNIT_TRACED_SCENES_H
#define UNIT_TRACED_SCENES_H

#include "krs/vulkan.h"

enum { WIDTH = 160, HEIGHT = 100, PIXELS = WIDTH * HEIGHT };

/* Where bits are compared: twelve tiles, of which some are not whole. */
enum { SMALL_WIDTH = 100, SMALL_HEIGHT = 70 };

/* ---- Scenes ---- */

#define FINE_ERROR    0.01 /* of the pictures to compare with, in pixels */
#define DEFAULT_ERROR 0.25 /* krs/vulkan.h */
typedef struct Scene {
    const char   *name, *text;
    double        fov; /* of its camera, which is perspective */
    KrsScene     *scene;
    KrsState     *state;
    KrsRendering *rendering;
} Scene;

enum { LANDSCAPE, PART, CLOUD, GRID, INSIDE, CORAL, LATTICE, SCENES };

extern Scene        traced_scenes[SCENES];
extern KrsRenderer *watched_renderer;

/* Methods that are plain steps where nothing is for them need not be tried on every scene. */
bool      is_spared(const Scene *scene, KrsTrace trace);
KrsStatus open_scene(Scene *scene);
void      close_scene(Scene *scene);

/* For cmocka's groups: the renderer; the same with all scenes. */
int open_watched(void **state);
int close_watched(void **state);
int open_scenes(void **state);
int close_scenes(void **state);
/* After every test. */
int hear_layers(void **state);

/* ---- Pictures ---- */

KrsPicture *render_scene(const Scene *scene, KrsRenderOptions options);
/* Tells whether `part` is, in all planes and bit by bit, what `whole` shows there; frees `part`. */
bool is_part_of(const Scene *scene, const KrsPicture *whole, KrsPicture *part, const char *what);
/* What a picture was asked for, in words. */
const char *words(const KrsRenderOptions *options);

#endif
