// untested in Unity: glslang has compiled it.  Functions of @name@, which @stem@.shader includes.
// Made by krs @version@ of a scene of implicit surfaces, and spirv-cross.
#ifndef KRS_SCENE_INCLUDED
#define KRS_SCENE_INCLUDED

@scene@
#endif
