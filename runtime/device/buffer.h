/*
 * buffer.h: memory of the device.
 */
#ifndef KRS_BUFFER_H
#define KRS_BUFFER_H

#include "runtime/device/gpu.h"

typedef enum Where {
    ON_DEVICE, /* fastest for the device; not for the host */
    SHARED     /* mapped at `bytes`; writes need no flush */
} Where;

typedef struct Buffer {
    VkBuffer       buffer;
    VkDeviceMemory memory;
    VkDeviceSize   size;
    VkDeviceSize   held; /* what the device set aside for it */
    void          *bytes; /* SHARED only */
} Buffer;

/* A buffer of `size` bytes (at least 1) for every use a kernel has.  `name` stands in messages:
   "cannot make room for the <name>". */
bool buffer_create(Gpu *gpu, Buffer *buffer, VkDeviceSize size, Where where, const char *name);
void buffer_destroy(Gpu *gpu, Buffer *buffer);

#endif
