// @name@, as functions in @language@.  Made by krs @version@ of a scene of implicit surfaces.
//
// Call krs_prepare() first.  krs_distance(p) is the distance, negative inside; krs_distance_lod(p, footprint) is what to march
// by: what is smaller than the footprint, the radius of a pixel's cone at p, counts as the box around it.
// krs_surface(p, normal, footprint) has colour and roughness there.  Numbers in krs_parameter, of which KRS_DEFAULTS are those
// that the scene was exported with:
@parameter_lines@
#if !defined(GL_ES)
#ifdef VULKAN
#define KRS_SET set = 0,
#else
#define KRS_SET
#endif
#endif

// The box around it; a number of 3.4e38: it has no end.
const vec3 KRS_LOW = @low_vector@, KRS_HIGH = @high_vector@;

const vec4 KRS_DEFAULTS[@slots@] = vec4[@slots@](@defaults@);

@scene@
