// What a shader for Unity asks of the Universal Render Pipeline: a stand-in, to compile it by.
#define CBUFFER_START(name) cbuffer name {
#define CBUFFER_END };
cbuffer Engine { float4x4 UNITY_MATRIX_P, UNITY_MATRIX_V, world, unworld, clip; float4 unity_OrthoParams, _ScreenParams; };
struct SurfaceData { float3 albedo, specular; float metallic, smoothness; float3 normalTS, emission; float occlusion, alpha, clearCoatMask, clearCoatSmoothness; };
struct InputData { float3 positionWS; float4 positionCS; float3 normalWS, viewDirectionWS; float4 shadowCoord; float fogCoord; float3 vertexLighting, bakedGI; float2 normalizedScreenSpaceUV; float4 shadowMask; };
float3 TransformObjectToWorld(float3 p) { return mul(world, float4(p, 1.0)).xyz; }
float3 TransformWorldToObject(float3 p) { return mul(unworld, float4(p, 1.0)).xyz; }
float3 TransformWorldToObjectDir(float3 d, bool unit) { return mul((float3x3)unworld, d); }
float3 TransformObjectToWorldNormal(float3 n) { return normalize(mul((float3x3)world, n)); }
float4 TransformWorldToHClip(float3 p) { return mul(clip, float4(p, 1.0)); }
float4 TransformWorldToShadowCoord(float3 p) { return float4(p, 1.0); }
float3 ApplyShadowBias(float3 p, float3 normal, float3 toward) { return p + normal + toward; }
float3 GetCameraPositionWS() { return float3(0.0, 0.0, 0.0); }
float3 GetWorldSpaceNormalizeViewDir(float3 p) { return normalize(p); }
float2 GetNormalizedScreenSpaceUV(float4 clip) { return clip.xy; }
float3 SampleSH(float3 normal) { return normal; }
float4 UniversalFragmentPBR(InputData seen, SurfaceData surface) { return float4(surface.albedo * seen.bakedGI + surface.emission, 1.0); }
