/*
 * spirv.h: compiles GLSL to SPIR-V.
 */
#ifndef KRS_SPIRV_H
#define KRS_SPIRV_H

#include "krs/krs.h"

/* Compiles GLSL to SPIR-V by glslang, and validates the result.  `entry` names the compute shader
   in messages.  On KRS_OK *words is malloc'ed, and the caller frees it.  KRS_INTERNAL: glslang or
   the validator refused it, which is a bug of krs; *log, malloc'ed, has their message.
   Thread-safe. */
KrsStatus spirv_compile(const char *glsl, const char *entry, uint32_t **words, size_t *word_count,
                        char **log);
/* Does the same, where functions stay what they are, with their names. */
KrsStatus spirv_compile_functions(const char *glsl, const char *entry, uint32_t **words,
                                  size_t *word_count, char **log);
/* Returns SPIR-V as assembly text, malloc'ed; NULL if it is no SPIR-V, or without memory. */
char *spirv_disassemble(const uint32_t *words, size_t word_count);
/* These must be called before and after every spirv_compile.  Pairs may nest, and may be called in
   different threads.  Between them glslang keeps the tables that the first spirv_compile makes,
   which takes longer than to compile a shader.  spirv_start itself takes no time. */
void spirv_start(void);
void spirv_stop(void);
/* Makes these tables now.  It may fail silently: the first spirv_compile tries again. */
void spirv_prepare(void);
/* Versions of glslang and SPIRV-Tools. */
const char *spirv_glslang_version(void);
const char *spirv_tools_version(void);

#endif
