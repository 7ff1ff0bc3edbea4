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

typedef struct Buffer {
    VkBuffer       buffer;
    VkDeviceMemory memory;
    VkDeviceSize   size;
    VkDeviceSize   held;   /* what the device set aside for it */
    void          *bytes;  /* but ON_DEVICE */
    VkBufferView   texels; /* what is in it, for shaders that read it so (buffer_view) */
} Buffer;

/* A buffer of `size` bytes (at least 1) for every use a shader has.  `name` stands in messages:
   "cannot make room for the <name>". */
bool buffer_create(Gpu *gpu, Buffer *buffer, VkDeviceSize size, Where where, const char *name);
/* Returns at least so many bytes, for a buffer that is read as texels: llvmpipe compiles a shader
   anew when the size of one becomes a power of two, or 256 times it a multiple of that; this is
   neither. */
VkDeviceSize buffer_texel_bytes(VkDeviceSize bytes);
/* Makes it readable as texels of so many bytes and that format, where it is not so far. */
bool buffer_view(Gpu *gpu, Buffer *buffer, VkFormat format, uint32_t texel_bytes, const char *name);
void buffer_destroy(Gpu *gpu, Buffer *buffer);

#endif
