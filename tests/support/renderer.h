/*
 * renderer.h: the renderer that all tests of a program share.
 */
#ifndef SUPPORT_RENDERER_H
#define SUPPORT_RENDERER_H

#include "krs/vulkan.h"

extern KrsRenderer *renderer;

/* For cmocka's groups: opens the device of the tests, or says why not and fails.  The shader compiler is
   held as long, so that it is not started anew by each rendering. */
int renderer_open(void **state);
int renderer_close(void **state);

/* Returns a picture of a scene's text by that renderer, which the caller frees; what fails, fails
   the test. */
KrsPicture *picture_of(const char *text, const KrsRenderOptions *options);

#endif
