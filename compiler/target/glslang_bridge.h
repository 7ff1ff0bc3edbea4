/*
 * glslang_bridge.h: glslang and SPIRV-Tools, for C.  They are written in C++ and throw exceptions
 * when memory runs out.  These functions catch all exceptions.
 */
#ifndef KRS_GLSLANG_BRIDGE_H
#define KRS_GLSLANG_BRIDGE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum BridgeResult { BRIDGE_OK, BRIDGE_REFUSED, BRIDGE_NO_MEMORY } BridgeResult;

/* Compiles a GLSL compute shader to SPIR-V for Vulkan 1.1, as one function or, not `flat`, as those
   that it has.  On BRIDGE_OK *words is malloc'ed; on BRIDGE_REFUSED *log is malloc'ed or, if memory
   ran out, NULL.  After BRIDGE_NO_MEMORY glslang must be stopped and started again, while no other
   thread compiles. */
BridgeResult bridge_compile(const char *glsl, int flat, uint32_t **words, size_t *word_count,
                            char **log);
/* These start and stop glslang, before and after all calls of bridge_compile.  A start that failed
   needs no stop; with glslang from 14 on no later one succeeds. */
BridgeResult bridge_start(void);
void         bridge_stop(void);
/* Validates SPIR-V.  On BRIDGE_REFUSED *log has the validator's message, malloc'ed, or is NULL. */
BridgeResult bridge_validate(const uint32_t *words, size_t word_count, char **log);
/* Returns the version of SPIRV-Tools. */
const char *bridge_tools_version(void);
/* Returns SPIR-V as assembly text, malloc'ed; NULL if it is no SPIR-V, or without memory. */
char *bridge_disassemble(const uint32_t *words, size_t word_count);

#ifdef __cplusplus
}
#endif
#endif
