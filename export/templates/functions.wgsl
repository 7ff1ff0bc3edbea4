// @name@, as functions in WGSL.  Made by krs @version@ of a scene of implicit surfaces.
//
// Call krs_prepare() first.  krs_distance(p) is the distance, negative inside; krs_distance_lod(p, footprint) is what to march
// by: what is smaller than the footprint, the radius of a pixel's cone at p, counts as the box around it.
// krs_surface(p, normal, footprint) has colour and roughness there.  Numbers in krs_parameter, of which KRS_DEFAULTS are those
// that the scene was exported with:
@parameter_lines@
// The box around it; a number of 3.4e38: it has no end.
const KRS_LOW = @low_vector@;
const KRS_HIGH = @high_vector@;

const KRS_DEFAULTS = array<vec4f, @slots@>(@defaults@);

@scene@
