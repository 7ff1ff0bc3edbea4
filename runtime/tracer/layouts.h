/*
 * layouts.h: what all kernels of a renderer share, whatever the scene.  These are the layouts of
 * descriptor sets and of the pipeline, and descriptor sets of zeros, in which a kernel finds no
 * items.
 */
#ifndef KRS_LAYOUTS_H
#define KRS_LAYOUTS_H

#include "runtime/tracer/handles.h"

/* Bindings of the frame's set (frame.glsl).  They are a uniform buffer and storage buffers, and
   among these the texels of the inputs: lights and listed rays.  Behind them are some of the
   buffers once more, as texels.  Where the device reads too few texels (Gpu.texels) no texels are
   bound, and inputs are a storage buffer. */
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

/* The renderer's device must be open.  On failure layouts_destroy frees what was made. */
bool layouts_create(KrsRenderer *renderer);
/* Call it after the kernels are destroyed.  It does nothing for a renderer without a device. */
void layouts_destroy(KrsRenderer *renderer);

/* Makes a buffer readable at a binding of texels, on devices that read texels.  `name` is that of
   the buffer, as in buffer_create. */
bool layouts_view_texels(Gpu *gpu, uint32_t binding, Buffer *buffer, const char *name);
/* Points a binding of a set at a buffer.  It does nothing for texels on devices that read none. */
void layouts_bind(Gpu *gpu, VkDescriptorSet set, uint32_t binding, const Buffer *buffer);

#endif
