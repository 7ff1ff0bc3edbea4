/*
 * renderer.c: the renderer that all tests of a program share.
 */
#include "tests/support/renderer.h"

#include <stdio.h>

KrsRenderer *renderer;

int renderer_open(void **state)
{
    (void)state;
    KrsStatus status = krs_renderer_new(NULL, &renderer);
    if (status != KRS_OK && renderer)
        fprintf(stderr, "%s\n", krs_renderer_message(renderer));
    return status != KRS_OK;
}

int renderer_close(void **state)
{
    (void)state;
    krs_renderer_free(renderer);
    renderer = NULL;
    return 0;
}
