/*
 * tracer_stage.h: a renderer that the validation layers watch, and a scene on it.
 */
#ifndef UNIT_TRACER_STAGE_H
#define UNIT_TRACER_STAGE_H

#include "krs/vulkan.h"

#define assert_near(value, expected, within) assert_true(fabs((value) - (expected)) <= (within))

/* A sphere around CENTRE, seen by several cameras. */
extern const char scene_text[];

/* A ball and a box on a plane. */
extern const char landscape_text[];

enum { FIRST, FLAT, ROUND, INNER, CAMERA_COUNT };

enum { WIDTH = 97, HEIGHT = 61 };

extern const double CENTRE[3];

/* What most tests need: a renderer with validation, and the sphere on it. */
typedef struct Stage {
    KrsRenderer  *renderer;
    KrsScene     *scene;
    KrsFrame     *frame;
    KrsRendering *rendering;
    unsigned      complaints;
    char          complaint[2048]; /* the last */
} Stage;

void note_complaint(void *user, const char *message);
void stage_open(Stage *stage, const char *text, const KrsAllocator *allocator);
/* The same of another device, as far as that can be pretended: KRS_PRETEND_... */
void stage_open_as(Stage *stage, const char *text, unsigned pretence);
void stage_close(Stage *stage);
/* The same; the test fails if the layers have complained. */
void        stage_close_watched(Stage *stage);
KrsPicture *stage_render(Stage *stage, KrsRenderOptions options);

/* For cmocka: *state is a Stage with scene_text, until stage_tear_down, which hears the layers. */
int stage_set_up(void **state);
int stage_tear_down(void **state);

#endif
