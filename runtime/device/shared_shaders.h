/*
 * shared_shaders.h: the shaders of a device that contain functions of scenes, by their text.
 *
 * Renderings whose shaders have the same text share them.  Some stay although no rendering uses them
 * any more, for scenes that are edited back and forth.
 */
#ifndef KRS_SHARED_SHADERS_H
#define KRS_SHARED_SHADERS_H

#include "runtime/device/gpu_state.h"

struct SharedShader {
    CacheKey      key;
    Handle        pipeline;
    uint32_t      users;
    SharedShader *next;
};

/* The shaders that stay though nobody uses them. */
enum { MAX_UNUSED_SHADERS = 64 };

/* Returns the shader with this key, for one more user; NULL: there is none. */
SharedShader *shared_shader_find(Gpu *gpu, CacheKey key);
/* Takes over a pipeline, which has one user then; NULL with the failure noted. */
SharedShader *shared_shader_add(Gpu *gpu, CacheKey key, Handle pipeline);
/* Ends the use by one user.  The device must have run all that uses the shader. */
void shared_shader_leave(Gpu *gpu, SharedShader *shared);
/* Destroys all; none may have a user. */
void shared_shaders_destroy(Gpu *gpu);

#endif
