// @name@, as functions in HLSL, shader model 5.0.  Made by krs @version@ of a scene of implicit surfaces, and spirv-cross.
//
// Call krs_prepare() first.  krs_distance(p) is the distance, negative inside; krs_distance_lod(p, footprint) is what to march
// by: what is smaller than the footprint, the radius of a pixel's cone at p, counts as the box around it.
// krs_surface(p, normal, footprint) has colour and roughness there, krs_normal_at(p, reach) is the normal.
//
// With KRS_KERNEL defined there is a compute shader, too: for each point of krs_points, place and footprint, it writes distance,
// distance to march by, roughness, metallic; colour and component; the normal.
//
// Numbers in krs_parameter, of which KRS_DEFAULTS are those that the scene was exported with:
@parameter_lines@
// The box around it; a number of 3.4e38: it has no end.
static const float3 KRS_LOW = @low_vector@, KRS_HIGH = @high_vector@;

static const float4 KRS_DEFAULTS[@slots@] = {@defaults@};

@scene@
