/*
 * sets.h: what shaders bind: layouts, and sets of buffers.
 */
#ifndef KRS_SETS_H
#define KRS_SETS_H

#include "runtime/device/buffer.h"

enum { WORK_BYTES = 64 };

typedef enum BindingKind {
    BINDS_NOTHING,
    BINDS_UNIFORM, /* a buffer that all lanes read alike */
    BINDS_WORK,    /* the same, of which a shader reads WORK_BYTES from work_at on (gpu.h) */
    BINDS_STORAGE,
    BINDS_TEXELS, /* a buffer with a view (buffer_view) */
    BINDING_KINDS
} BindingKind;

typedef struct SetLayout {
    Handle   layout;
    uint32_t of_kind[BINDING_KINDS]; /* how many bindings */
} SetLayout;

/* Makes the layout of a set whose bindings are of these kinds. */
bool set_layout_create(Gpu *gpu, SetLayout *layout, const BindingKind *kinds, uint32_t count);
void set_layout_destroy(Gpu *gpu, SetLayout *layout);

/* Makes the layout of a shader with two sets, of which the second has one binding of BINDS_WORK. */
bool run_layout_create(Gpu *gpu, const SetLayout *const sets[2], Handle *layout);
void run_layout_destroy(Gpu *gpu, Handle layout);

/* Makes sets of these layouts, at most four, and the pool with which they end. */
bool sets_create(Gpu *gpu, const SetLayout *const *layouts, uint32_t count, Handle *sets,
                 Handle *pool);
void sets_destroy(Gpu *gpu, Handle pool);

/* Points a binding, which is of that kind, at a buffer.  Nothing that runs may use the set. */
void set_bind(Gpu *gpu, Handle set, uint32_t binding, BindingKind kind, const Buffer *buffer);

#endif
