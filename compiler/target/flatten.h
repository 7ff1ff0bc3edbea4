/*
 * flatten.h: leaves of a module what its entry point needs, once all calls are inlined.
 */
#ifndef KRS_FLATTEN_H
#define KRS_FLATTEN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Drops all functions but the entry point, with what names or decorates their values, and makes
   private globals its local variables.  A module whose entry point still calls functions stays as it
   is.  The words are changed in place; *count becomes smaller.  Returns false without memory, or if
   these are no SPIR-V. */
bool flatten_module(uint32_t *words, size_t *count);

#ifdef __cplusplus
}
#endif
#endif
