/*
 * buffer.h: memory of the device.
 */
#ifndef KRS_BUFFER_H
#define KRS_BUFFER_H

#include "runtime/device/gpu.h"

typedef enum Where {
    ON_DEVICE, /* fastest for the device; not for the host */
    SHARED,    /* mapped at `bytes`; writes need no flush */
    UPLOADED   /* as SHARED, for the host to write: nearer to the device where that can be */
} Where;

/* The numbers of a texel. */
typedef enum TexelKind {
    NO_TEXELS,
    ONE_NUMBER,
    TWO_NUMBERS,
    FOUR_NUMBERS,
    FOUR_FLOATS,
    TEXEL_KINDS
} TexelKind;

struct Buffer {
    Handle   buffer, memory;
    uint64_t size;
    uint64_t held;   /* what the device set aside for it */
    void    *bytes;  /* but ON_DEVICE */
    Handle   texels; /* what is in it, for shaders that read it so (buffer_view) */
};

/* Makes a buffer of `size` bytes (at least 1) for every use a shader has.  `name` stands in
   messages: "cannot make room for the <name>". */
bool buffer_create(Gpu *gpu, Buffer *buffer, uint64_t size, Where where, const char *name);
/* Returns at least so many bytes, for a buffer that is read as texels: llvmpipe compiles a shader
   anew when the size of one becomes a power of two, or 256 times it a multiple of that; this is
   neither. */
uint64_t buffer_texel_bytes(uint64_t bytes);
/* Makes it readable as texels of a kind, where it is not so far. */
bool buffer_view(Gpu *gpu, Buffer *buffer, TexelKind kind, const char *name);
void buffer_destroy(Gpu *gpu, Buffer *buffer);

#endif
