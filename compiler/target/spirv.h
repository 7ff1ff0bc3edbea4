/*
 * spirv.h: GLSL to SPIR-V.
 */
#ifndef KRS_SPIRV_H
#define KRS_SPIRV_H

#include "compiler/krs.h"

/* GLSL to SPIR-V by glslang, then through the SPIR-V validator.  `entry` names the compute
   shader in messages.  On KRS_OK *words is malloc'ed and the caller's.  KRS_INTERNAL: refused by
   glslang or the validator, a bug of ours: *log (malloc'ed) has their words.  Thread-safe. */
KrsStatus spirv_compile(const char *glsl, const char *entry, uint32_t **words, size_t *word_count,
                        char **log);
/* SPIR-V as assembly text (malloc'ed), or NULL when it is none or there is no memory. */
char *spirv_disassemble(const uint32_t *words, size_t word_count);
/* Around every spirv_compile, in pairs that may nest and may stand in different threads: between
   them glslang keeps the tables that the first spirv_compile sets up, which takes it longer than
   a kernel does.  spirv_start itself costs nothing. */
void spirv_start(void);
void spirv_stop(void);
/* Versions of the tools: what a shader is made by. */
const char *spirv_glslang_version(void);
const char *spirv_tools_version(void);

#endif
