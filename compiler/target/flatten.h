/*
 * flatten.h: makes one function of a module.
 */
#ifndef KRS_FLATTEN_H
#define KRS_FLATTEN_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum Flattening { FLATTEN_OK, FLATTEN_REFUSED, FLATTEN_NO_MEMORY } Flattening;

/* Copies all functions to where they are called, makes private globals local variables of the entry
   point, replaces loads of variables by what is stored where that is known, and leaves out what
   nothing depends on, with the names of values.  FLATTEN_REFUSED: a function that is called returns
   anywhere but at its end, or the module is none that glslang makes.  The words are changed; on
   FLATTEN_OK *made is malloc'ed. */
Flattening flatten_module(uint32_t *words, size_t count, uint32_t **made, size_t *made_count);

#ifdef __cplusplus
}
#endif
#endif
