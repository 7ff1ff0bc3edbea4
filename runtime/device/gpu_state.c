/*
 * gpu_state.c: memory of the host, and failures.
 */
#include "runtime/device/gpu_state.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/base/allocator.h"
#include "compiler/base/clock.h"

double clock_ms(void) { return 1e3 * clock_seconds(CLOCK_MONOTONIC); }

void *gpu_alloc(Gpu *gpu, size_t count, size_t size, const char *attempt)
{
    const KrsAllocator *allocator = &gpu->allocator;
    void               *block     = NULL;
    if (size == 0 || count <= SIZE_MAX / size) {
        size_t bytes = count * size > 0 ? count * size : 1;
        if (!allocator->allocate)
            block = calloc(1, bytes); /* knows what is zero already: pages fresh from the system */
        else if ((block = allocator->allocate(allocator->user, bytes)))
            memset(block, 0, bytes);
    }
    if (!block)
        gpu_refuse(gpu, KRS_OUT_OF_MEMORY, "cannot %s: out of memory", attempt);
    return block;
}

void gpu_release(Gpu *gpu, void *block) { allocator_release(&gpu->allocator, block); }

void gpu_refuse(Gpu *gpu, KrsStatus status, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(gpu->message, sizeof gpu->message, format, arguments);
    va_end(arguments);
    gpu->status = status;
}

bool gpu_tell_compiled(Gpu *gpu, double done)
{
    if (!gpu->compiling || gpu->compiling(gpu->compiling_user, done))
        return true;
    gpu_refuse(gpu, KRS_INTERRUPTED, "interrupted");
    return false;
}
