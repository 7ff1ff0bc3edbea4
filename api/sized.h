/*
 * sized.h: structs of a program that was compiled with other headers than the library.
 *
 * New members stand behind the others, so what both know is the shorter of the two structs.
 */
#ifndef KRS_API_SIZED_H
#define KRS_API_SIZED_H

#include <stdbool.h>
#include <stddef.h>

/* Copies a struct of the program, or 0 where `given` is NULL.  Members that the program does not know become 0.
   False: one that the library does not know is not 0. */
bool sized_take(void *own, size_t own_size, const void *given, size_t size);
/* Copies a struct to the program, unless `given` is NULL; members that the library does not know become 0. */
void sized_give(void *given, size_t size, const void *own, size_t own_size);

/* A function that makes something of another by options. */
#define MADE_BY_OPTIONS(function, Owner, Options, Made)                                        \
    KrsStatus function##_sized(Owner *owner, const Options *options, size_t size, Made **made) \
    {                                                                                          \
        Options own;                                                                           \
        *made = NULL;                                                                          \
        if (!sized_take(&own, sizeof own, options, size))                                      \
            return KRS_BAD_ARGUMENT;                                                           \
        return function(owner, options ? &own : NULL, made);                                   \
    }

/* An array of the program, and one of the library to be filled in its stead. */
typedef struct SizedArray {
    void  *given, *own; /* the same where both know the same members, or there is none */
    size_t size, own_size;
} SizedArray;

/* Returns false if memory has run out. */
bool sized_open(SizedArray *array, void *given, size_t size, size_t own_size, size_t count);
/* Hands out as many elements as there are now, and frees the library's array. */
void sized_close(SizedArray *array, size_t count);

#endif
