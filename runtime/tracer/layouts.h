/*
 * layouts.h: what every kernel of a renderer needs, whatever the scene: layouts of what it reads
 * and writes, and a scene and a frame of zeros, in which a kernel finds nothing to do.
 */
#ifndef KRS_LAYOUTS_H
#define KRS_LAYOUTS_H

#include "runtime/tracer/handles.h"

/* Bindings of the frame's set (frame.glsl): a uniform buffer, storage buffers, texels of lights,
   and more storage buffers; then those once more as texels.  Where the device reads too few texels
   (Gpu.texels) none of these is bound, and lights are a storage buffer. */
enum {
    FRAME_BINDING = 0,
    ENDS_BINDING,
    HITS_BINDING,
    RESULTS_BINDING,
    CONTROL_BINDING,
    INPUT_ROWS_BINDING,
    QUEUE_BINDING,
    TAKEN_BINDING,
    INPUTS_BINDING,
    TILES_BINDING,
    END_TEXELS,
    HIT_TEXELS,
    PIXEL_LIST_TEXELS,
    RESULT_TEXELS,
    BINDING_COUNT,
    TEXEL_BINDINGS  = 1 + BINDING_COUNT - END_TEXELS,
    BUFFER_BINDINGS = BINDING_COUNT - TEXEL_BINDINGS - 1
};

/* For a renderer whose device is open.  What was made on failure goes with layouts_destroy. */
bool layouts_create(KrsRenderer *renderer);
/* After the kernels; for a renderer without a device nothing. */
void layouts_destroy(KrsRenderer *renderer);

/* Makes a buffer readable at a binding of texels, where there are some; `name` as in
   buffer_create. */
bool layouts_view_texels(Gpu *gpu, uint32_t binding, Buffer *buffer, const char *name);
/* Points a binding of a set at a buffer; one of texels, where there are none, at nothing. */
void layouts_bind(Gpu *gpu, VkDescriptorSet set, uint32_t binding, const Buffer *buffer);

#endif
