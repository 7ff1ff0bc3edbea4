/*
 * shader.h: compute shaders of runtime/shaders, made ready to run.
 */
#ifndef KRS_SHADER_H
#define KRS_SHADER_H

#include "compiler/passes/compile.h"
#include "runtime/device/gpu.h"

typedef struct Shader {
    Handle        pipeline; /* 0: it is not made */
    const char   *file;     /* of runtime/shaders */
    uint32_t      march_group;
    size_t        glsl_bytes; /* 0: the program carries it as SPIR-V */
    bool          cached;     /* its SPIR-V was not compiled */
    double        spirv_ms, pipeline_ms;
    bool          prewarmed;
    uint32_t      prewarm; /* its number (gpu_prewarm_ms) */
    SharedShader *shared;  /* whose pipeline it is, if others may use it as well */
} Shader;

/* The scene of a shader: its text takes the place of "scene.glsl". */
typedef struct ShaderScene {
    const KrsScene *scene;
    KrsVariant      variant;
    KrsFunction     wanted[KRS_FUNCTION_COUNT];
    size_t          wanted_count;
} ShaderScene;

/* The source of a shader. */
typedef struct ShaderSource {
    const char        *file;    /* of runtime/shaders */
    const ShaderScene *scene;   /* NULL for a shader without one */
    const char        *defines; /* lines of `#define NAME VALUE` that choose a variant, or NULL */
} ShaderSource;

/* Returns the text of a shader: its includes in place, its defines after the `#version` line, and
   without comments, so that the cache knows a scene again that differs in them, in its name or
   folder.  The caller's to release; NULL with the failure noted. */
char *shader_text(Gpu *gpu, const ShaderSource *source);
/* Takes comments and blank lines out of a text in GLSL. */
void shader_strip(char *text);

/* Compiles a shader, or takes it from the cache, and adds the time it took. */
bool shader_create(Gpu *gpu, Shader *shader, const ShaderSource *source, Handle layout,
                   double *spirv_ms, double *pipeline_ms);

/* A shader on its way to the device: SPIR-V, unless the device has it already. */
typedef struct ShaderCode {
    const char   *file;
    uint32_t     *words;
    size_t        bytes;
    bool          compiled; /* just now: it was in no cache */
    uint32_t      march_group;
    size_t        glsl_bytes;
    double        ms;       /* processor time */
    SharedShader *shared;   /* what the device has already: then there are no words */
    bool          to_share; /* others may use it */
    CacheKey      key;      /* of its text, then */
} ShaderCode;

/* The part of the making of shaders that is done when all are SPIR-V. */
#define COMPILED_PART 0.5

typedef struct ShaderRequest {
    Shader      *shader; /* to be made */
    ShaderSource source;
} ShaderRequest;

/* Tells whether a shader of this text is in the cache, or was made by this process, and its key there. */
bool shader_is_known(Gpu *gpu, const ShaderSource *source, CacheKey *key);
/* These compile several shaders at the same time, and make them pipelines of a device.  Codes are
   the caller's to release, in either case; a shader that was not made is zero. */
bool shader_compile_all(Gpu *gpu, const ShaderRequest *requests, size_t count, ShaderCode *codes,
                        double *spirv_ms);
bool shader_load(Gpu *gpu, Shader *shader, const ShaderCode *code, Handle layout,
                 double *pipeline_ms);
bool shader_load_all(Gpu *gpu, const ShaderRequest *requests, const ShaderCode *codes, size_t count,
                     Handle layout);
/* Returns what the driver has taken for a shader so far. */
double shader_driver_ms(const Gpu *gpu, const Shader *shader);
void   shader_code_release(Gpu *gpu, ShaderCode *code);

/* Does the same for several shaders, which are compiled at the same time.  On failure some may have
   been made: shader_destroy in either case. */
bool shader_create_all(Gpu *gpu, const ShaderRequest *requests, size_t count, Handle layout,
                       double *spirv_ms, double *pipeline_ms);
void shader_destroy(Gpu *gpu, Shader *shader);

#endif
