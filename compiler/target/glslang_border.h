/*
 * glslang_border.h: glslang and SPIRV-Tools, for C.  They are written in C++ and throw exceptions
 * when memory runs out.  These functions catch all exceptions.
 */
#ifndef KRS_GLSLANG_BORDER_H
#define KRS_GLSLANG_BORDER_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum BorderResult { BORDER_OK, BORDER_REFUSED, BORDER_NO_MEMORY } BorderResult;

/* Compiles a GLSL compute shader to SPIR-V for Vulkan 1.1.  On BORDER_OK *words is malloc'ed; on
   BORDER_REFUSED *log is malloc'ed or, if memory ran out, NULL.  After BORDER_NO_MEMORY glslang
   must be stopped and started again, while no other thread compiles. */
BorderResult border_compile(const char *glsl, uint32_t **words, size_t *word_count, char **log);
/* Start and stop glslang, before and after all calls of border_compile.  A start that failed needs
   no stop; with glslang from 14 on no later one succeeds. */
BorderResult border_start(void);
void         border_stop(void);
/* Validates SPIR-V.  On BORDER_REFUSED *log has the validator's message, malloc'ed, or is NULL. */
BorderResult border_validate(const uint32_t *words, size_t word_count, char **log);
/* The version of SPIRV-Tools. */
const char *border_tools_version(void);
/* SPIR-V as assembly text, malloc'ed; NULL if it is no SPIR-V, or without memory. */
char *border_disassemble(const uint32_t *words, size_t word_count);

#ifdef __cplusplus
}
#endif
#endif
