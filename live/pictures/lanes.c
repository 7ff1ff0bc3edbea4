/*
 * lanes.c: a canvas whose rays lanes of the host march.
 *
 * Its shaders contain no scene, so they are made once; a new structure costs no more than its tapes (rays/README.md).
 */
#include "live/pictures/lanes.h"

#include "live/pictures/resolution.h"

void lanes_open(Lanes *lanes, const KrsRendererOptions *options)
{
    KrsRendererOptions with   = *options;
    with.prewarm              = true;
    const KrsStatus status    = canvas_new(&with, KRS_EXECUTOR_LANES, &lanes->canvas);
    const bool      processor = status == KRS_OK && canvas_is_of_cpu(lanes->canvas);
    if (!processor)
        lanes_close(lanes);
}

void lanes_close(Lanes *lanes)
{
    canvas_free(lanes->canvas);
    *lanes = (Lanes){0};
}

bool lanes_meet(const Needs *needs) { return !needs->paths && needs->zones == 0 && !needs->points; }

static KrsStatus prepare(Lanes *lanes, const View *view, double budget,
                         KrsProgressCallback *compiling, void *user)
{
    const KrsStatus status = canvas_try_lanes(lanes->canvas, view, &lanes->estimate);
    if (status == KRS_OK && lanes->estimate.lanes_ms > budget * MAX_DIVISOR * MAX_DIVISOR)
        return KRS_BAD_ARGUMENT;
    if (status != KRS_OK || lanes->prepared)
        return status;
    const KrsStatus prepared = canvas_prepare(lanes->canvas, view, compiling, user);
    lanes->prepared          = prepared == KRS_OK;
    return prepared;
}

bool lanes_take(Lanes *lanes, const View *view, double budget, KrsProgressCallback *compiling,
                void *user, bool *fresh)
{
    const Needs needs = view_needs(view);
    *fresh            = needs.structure != lanes->structure;
    if (!lanes->canvas || !lanes_meet(&needs) || needs.structure == lanes->refused)
        return false;
    if (!*fresh)
        return true;
    const KrsStatus status = prepare(lanes, view, budget, compiling, user);
    lanes->structure       = status == KRS_OK ? needs.structure : 0;
    if (status != KRS_OK && status != KRS_INTERRUPTED) {
        lanes->structure = needs.structure;
        lanes_give_up(lanes, status);
    }
    return status == KRS_OK;
}

/* A device that has failed is not used again. */
void lanes_give_up(Lanes *lanes, KrsStatus status)
{
    if (status != KRS_BAD_ARGUMENT)
        lanes_close(lanes);
    else
        *lanes = (Lanes){
            .canvas = lanes->canvas, .prepared = lanes->prepared, .refused = lanes->structure};
}
