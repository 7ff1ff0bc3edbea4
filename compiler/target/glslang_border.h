/*
 * glslang_border.h: glslang and SPIRV-Tools, seen from C.  They are C++ and throw when memory runs
 * out; nothing that they throw passes this border.
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
   BORDER_REFUSED *log is (either may be NULL when memory ran out).  After BORDER_NO_MEMORY glslang
   must be stopped, and started anew, once no other thread is in here. */
BorderResult border_compile(const char *glsl, uint32_t **words, size_t *word_count, char **log);
/* Around all calls of border_compile; a start that failed needs no stop. */
BorderResult border_start(void);
void         border_stop(void);
/* On BORDER_REFUSED *log has the validator's words, malloc'ed, or is NULL. */
BorderResult border_validate(const uint32_t *words, size_t word_count, char **log);
/* Assembly text, malloc'ed, or NULL. */
char *border_disassemble(const uint32_t *words, size_t word_count);

#ifdef __cplusplus
}
#endif
#endif
