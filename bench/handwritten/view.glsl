/*
 * view.glsl: a stand-in for the view of a picture, as literals.
 *
 * The bench puts the scene's own in its place, so that the pictures are of the same view, and
 * with it the permitted error.  With this one the shaders can be checked by themselves:
 *     glslangValidator -V --target-env vulkan1.1 -Ibench/handwritten -Iruntime/shaders \
 *         -Icompiler/print/glsl FILE
 */
#define WIDTH      1280
#define HEIGHT     720
#define ERROR      0.25 // permitted, in pixels
#define MAX_STEPS 1024

#define EYE    vec3(0.0, 1.0, 5.0)
#define TARGET vec3(0.0)
#define FOV    0.6

#define SUN_DIRECTION vec3(0.0, 1.0, 0.0) // towards it, unit
#define SUN_COLOR     vec3(3.0)
#define SUN_SOFTNESS  0.02

#define ZENITH  vec3(0.2, 0.3, 0.6)
#define HORIZON vec3(0.6)
#define GROUND  vec3(0.3)
