// untested: no compiler has seen this file.
//
// @name@, as a kernel in MSL 2.1.  Made by krs @version@ of a scene of implicit surfaces, and spirv-cross.
//
// For each point of krs_points, place and footprint, main0 writes distance, distance to march by, roughness, metallic; colour and
// component; the normal.  What is smaller than the footprint, the radius of a pixel's cone, counts as the box around it where the
// distance to march by is asked for.  Functions can be called from other kernels as main0 does.
//
// Numbers in krs_parameter, of which KRS_DEFAULTS are those that the scene was exported with:
@parameter_lines@
@scene@
// The box around it; a number of 3.4e38: it has no end.
constant float3 KRS_LOW = @low_vector@, KRS_HIGH = @high_vector@;

constant float4 KRS_DEFAULTS[@slots@] = {@defaults@};
