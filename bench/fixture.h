/*
 * fixture.h: a scene on the device, for the benches that are programs of their own.
 */
#ifndef KRS_BENCH_FIXTURE_H
#define KRS_BENCH_FIXTURE_H

#include <stdbool.h>

#include "krs/vulkan.h"

typedef struct Fixture {
    const char   *name;
    KrsRenderer  *renderer;
    KrsScene     *scene;
    KrsState     *state;
    KrsRendering *rendering;
} Fixture;

/* Prints what went wrong, and ends the process: so does all else here that fails. */
_Noreturn void give_up(const char *what, const char *why);

/* Returns the device that KRS_DEVICE names, in the words of `krs --device`, else that which krs
   takes. */
KrsRenderer *device_open(void);

/* Compiles a text, or the file of this name where that is NULL.  `gradients`: normals by
   derivatives are wanted.  `name` must live as long as the fixture. */
Fixture fixture_open(KrsRenderer *renderer, const char *name, const char *text, bool gradients);
void    fixture_close(Fixture *fixture);

/* The picture is the caller's to free. */
KrsPicture *fixture_render(const Fixture *fixture, const KrsRenderOptions *options);

#endif
