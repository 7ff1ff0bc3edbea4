/*
 * tracer_fixture.h: a renderer that the validation layers watch, and a scene on it.
 */
#ifndef UNIT_TRACER_FIXTURE_H
#define UNIT_TRACER_FIXTURE_H

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
typedef struct Fixture {
    KrsRenderer  *renderer;
    KrsScene     *scene;
    KrsState     *state;
    KrsRendering *rendering;
    unsigned      validation_messages;
    char          validation_message[2048]; /* the last */
} Fixture;

void note_validation_message(void *user, const char *message);
void fixture_open(Fixture *fixture, const char *text, const KrsAllocator *allocator);
/* Does the same of another device, as far as it can be emulated: EMULATE_... */
void fixture_open_as(Fixture *fixture, const char *text, unsigned emulation);
void fixture_close(Fixture *fixture);
/* Does the same; the test fails if the layers have complained. */
void        fixture_close_watched(Fixture *fixture);
KrsPicture *fixture_render(Fixture *fixture, KrsRenderOptions options);

/* For cmocka: *state is a Fixture with scene_text, until fixture_tear_down, which hears the layers. */
int fixture_set_up(void **state);
int fixture_tear_down(void **state);

#endif
