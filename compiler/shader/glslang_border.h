/*
 * glslang_border.h: glslang, seen from C.  It is C++ and throws when memory runs out; nothing
 * that it throws passes this border.
 */
#ifndef KRS_GLSLANG_BORDER_H
#define KRS_GLSLANG_BORDER_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum BorderResult { BORDER_OK, BORDER_REFUSED, BORDER_NO_MEMORY } BorderResult;

/* A GLSL compute shader to SPIR-V for Vulkan 1.1.  On BORDER_OK *words is malloc'ed; on
   BORDER_REFUSED *log is (either may be NULL when memory ran out). */
BorderResult border_compile(const char *glsl, uint32_t **words, size_t *word_count, char **log);
/* Once per process, around all calls. */
void border_start(void);
void border_stop(void);

#ifdef __cplusplus
}
#endif
#endif
