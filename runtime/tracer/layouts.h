/*
 * layouts.h: what all shaders of a renderer share, whatever the scene.  These are the layouts of
 * sets and of shaders, and sets of zeros, in which a shader finds no items.
 */
#ifndef KRS_LAYOUTS_H
#define KRS_LAYOUTS_H

#include "runtime/tracer/handles.h"

/* Bindings of the scene's set, as the compiler prints them: the parameter block and the tables; and
   the table of the sky (blocks.h).  Those of the frame's set are in blocks.h. */
enum {
    PARAMETERS_BINDING,
    ROWS_BINDING,
    CELLS_BINDING,
    SKY_TABLE_BINDING,
    SCENE_BINDINGS,
    TABLE_BINDINGS = SCENE_BINDINGS - ROWS_BINDING /* texels, or storage buffers without them */
};

/* The bindings of the frame's set (blocks.h) that are texels, and those that are storage buffers:
   all others but the uniform buffer of the frame. */
enum {
    TEXEL_BINDINGS  = 1 + WORK_BINDING - END_TEXELS_BINDING,
    BUFFER_BINDINGS = FRAME_BINDINGS - TEXEL_BINDINGS - 2
};

/* The renderer's device must be open.  On failure layouts_destroy frees what was made. */
bool layouts_create(KrsRenderer *renderer);
/* Destroys the layouts after the shaders.  It does nothing for a renderer without a device. */
void layouts_destroy(KrsRenderer *renderer);

/* Copies a block of a dispatch that is about to be recorded to where the shader finds it, and returns
   where that is. */
uint32_t layouts_write_work(KrsRenderer *renderer, const void *work, uint32_t bytes);

/* Makes a buffer readable at a binding of texels, on devices that read texels.  `name` is that of
   the buffer, as in buffer_create. */
bool layouts_view_texels(Gpu *gpu, uint32_t binding, Buffer *buffer, const char *name);
/* Points a binding of a frame's set at a buffer.  It does nothing for texels on devices that read none. */
void layouts_bind(Gpu *gpu, Handle set, uint32_t binding, const Buffer *buffer);

/* Does the same for a scene's set. */
bool layouts_view_table(Gpu *gpu, uint32_t binding, Buffer *buffer, const char *name);
void layouts_bind_scene(Gpu *gpu, Handle set, uint32_t binding, const Buffer *buffer);
/* Returns what a scene without tables binds in their place. */
const Buffer *layouts_idle_table(const KrsRenderer *renderer, uint32_t binding);

#endif
