/*
 * sized.c: structs of a program that was compiled with other headers than the library.
 */
#include "api/sized.h"

#include <stdlib.h>
#include <string.h>

static size_t shorter(size_t a, size_t b) { return a < b ? a : b; }

bool sized_take(void *own, size_t own_size, const void *given, size_t size)
{
    memset(own, 0, own_size);
    if (given)
        memcpy(own, given, shorter(size, own_size));
    for (size_t i = own_size; given && i < size; i++)
        if (((const unsigned char *)given)[i] != 0)
            return false;
    return true;
}

void sized_give(void *given, size_t size, const void *own, size_t own_size)
{
    if (!given)
        return;
    memset(given, 0, size);
    memcpy(given, own, shorter(size, own_size));
}

bool sized_open(SizedArray *array, void *given, size_t size, size_t own_size, size_t count)
{
    const bool same = !given || size == own_size;
    *array          = (SizedArray){given, same ? given : calloc(count ? count : 1, own_size), size,
                                   own_size};
    return same || array->own;
}

void sized_close(SizedArray *array, size_t count)
{
    if (array->own == array->given)
        return;
    for (size_t i = 0; i < count; i++)
        sized_give((char *)array->given + i * array->size, array->size,
                   (const char *)array->own + i * array->own_size, array->own_size);
    free(array->own);
}
