/*
 * render.h: the steps of `krs render`, which `krs watch` takes again and again.
 */
#ifndef KRS_RENDER_H
#define KRS_RENDER_H

#include "cli/picture/checkpoint.h"
#include "cli/picture/sample_sums.h"
#include "cli/shell/commands.h"
#include "cli/shell/console.h"
#include "cli/picture/render_faults.h"

typedef struct Render {
    const Options   *options;
    const char     **outputs;
    size_t           output_count;
    KrsScene        *scene;
    KrsState        *state;
    KrsRenderer     *renderer;
    KrsRendering    *rendering;
    KrsRenderOptions how;
    float           *depth; /* of another renderer, for the frame at hand; NULL: none */
    float (*plate)[4];
    uint32_t     samples; /* of a pixel, also where `how` leaves it to the scene */
    double       noise;   /* at which its samples end; 0: none */
    Progress     progress;
    RenderFaults faults;
    Checkpoint   checkpoint;
    SampleSums   sums; /* of the frame at hand, if its samples are divided */
    bool (*outdated)(
        void *user); /* asked while a picture is made: true ends it; NULL: it never is */
    void *user;      /* handed to `outdated` */
} Render;

/* Finds which files are written, and whether they can be. */
KrsStatus render_begin(Render *render, const Options *options);
/* Chooses the frame of the scene, and how it is rendered: what options and scene say together. */
KrsStatus render_choose(Render *render);
/* Compiles the shaders, after the scene and how it is rendered are known. */
KrsStatus render_compile(Render *render);
/* Renders and writes all frames.  KRS_INTERRUPTED also where a picture is outdated. */
KrsStatus render_frames(Render *render);
/* Returns a list such as "`a.exr`, `b.exr` and `a.png`". */
const char *output_names(Arena *arena, const char *const *outputs, size_t count);
/* Says "wrote `a.exr` and `a.png` in 0.4 s"; `seconds` 0: not how long it took. */
void render_say_written(const Render *render, double seconds);
void render_free(Render *render);

#endif
