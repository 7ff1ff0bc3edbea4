// untested in Unreal: glslang has compiled it as HLSL.  Code of a Custom node, for a material of a box around the scene.
//
// @name@, made by krs @version@ of a scene of implicit surfaces, and spirv-cross.  The material: Masked, Two Sided; seen from inside of the box it has no depth of its own.  The box: its
// middle is at the scene's @center_numbers@, its sides are @size_numbers@.  A length of 1 is a metre, 100 units; the scene's y is up.
//
// Output: CMOT Float 3, base colour.  Additional outputs: Normal3 and Emission (Float 3; tangent space normals off), Rough, Metal,
// Opacity (mask) and Away (pixel depth offset), Float 1.  Inputs:
//   Place: absolute world position minus the box's, in units;   Eye: camera position minus the box's;   Ahead: camera direction;
//   Pixel: height of a pixel at distance 1, 2 * tan(half the field of view) / lines;   Seconds: the time
@if_baked@//   Baked: a Texture Object of @stem@.dds as a Volume Texture, without mipmaps, not sRGB, uncompressed (HDR)
@end@@unreal_inputs@
@scene@
// ---- the node ----
Krs krs;
krs.krs_parameter[0] = float4(Seconds, 0.0, 0.0, 0.0);
@if_baked@krs.krs_baked = Baked;
krs.samplerkrs_baked = BakedSampler;
@end@@unreal_parameters@krs.krs_prepare();
float3 krs_middle = @center@;
float3 krs_end = float3(Place.y, Place.z, -Place.x) / 100.0 + krs_middle, krs_eye = float3(Eye.y, Eye.z, -Eye.x) / 100.0 + krs_middle;
float3 krs_way = normalize(krs_end - krs_eye), krs_forward = float3(Ahead.y, Ahead.z, -Ahead.x);
float2 krs_sides = krs.krs_inside(krs_eye, krs_way);
float krs_t = 0.0;
Opacity = krs.krs_trace(krs_eye, krs_way, max(krs_sides.x, 0.0), krs_sides.y, Pixel, krs_t) ? 1.0 : 0.0;
KrsSurface krs_surface = krs.krs_seen(krs_eye, krs_way, krs_t, Pixel);
Normal3 = float3(-krs_surface.normal.z, krs_surface.normal.x, krs_surface.normal.y);
Emission = krs_surface.emission;
Rough = krs_surface.roughness;
Metal = krs_surface.metallic;
// The box is drawn where it ends if its front faces are left out, and else where it begins: the offset brings either to the surface.
Away = 100.0 * dot(krs_eye + krs_t * krs_way - krs_end, krs_forward);
return krs_surface.color;
