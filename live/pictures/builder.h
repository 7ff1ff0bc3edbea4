/*
 * builder.h: a thread that compiles the shaders of a view, while another canvas is shown.
 */
#ifndef KRS_BUILDER_H
#define KRS_BUILDER_H

#include "live/pictures/canvas.h"

typedef struct BuilderState {
    bool      building;
    double    done;         /* of the shaders that are compiled together, from 0 to 1 */
    KrsStatus status;       /* why the last build failed, unless it was given up */
    char      message[256]; /* one line about that */
} BuilderState;

typedef struct Builder Builder;

/* Makes a builder; `told` is called in its thread, when the state has changed.  NULL: without
   memory. */
Builder *builder_new(const KrsRendererOptions *options, void (*told)(void *user), void *user);
void     builder_free(Builder *builder);

/* Compiles what the view needs, unless it is being compiled, or was and failed.  A build of another
   structure is given up; one of the same goes on. */
void builder_start(Builder *builder, const View *view);
/* Tells whether a canvas was built that has these needs. */
bool builder_has(Builder *builder, const Needs *needs);
/* Gives up what is being compiled. */
void builder_cancel(Builder *builder);
/* Takes the canvas that was built if it meets these needs, or with `some` if it is of their structure,
   and leaves another in its place, which may be NULL.  NULL: there is none. */
Canvas *builder_exchange(Builder *builder, const Needs *needs, bool some, Canvas *other);

BuilderState builder_state(Builder *builder);

#endif
