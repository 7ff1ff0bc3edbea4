// untested in Unity: glslang has compiled its functions, with a stand-in for those of Unity.
//
// @name@, for the Universal Render Pipeline of Unity 2022.3 and later: material of a box around the scene, which @stem@.cs makes.
// Made by krs @version@ of a scene of implicit surfaces.  It hides and is hidden, and casts and receives shadows.
Shader "krs/@stem@"
{
    Properties
    {
@unity_properties@        [HideInInspector] _KrsTime("time", Float) = 0
@if_baked@        [HideInInspector] krs_baked("samples", 3D) = "" {}
@end@    }
    SubShader
    {
        Tags { "RenderType" = "Opaque" "RenderPipeline" = "UniversalPipeline" "Queue" = "AlphaTest" }
        Cull Front

        HLSLINCLUDE
        #pragma target 5.0
        #include "Packages/com.unity.render-pipelines.universal/ShaderLibrary/Core.hlsl"
        #include "Packages/com.unity.render-pipelines.universal/ShaderLibrary/Lighting.hlsl"
        #include "Packages/com.unity.render-pipelines.universal/ShaderLibrary/Shadows.hlsl"
// ---- functions ----
        CBUFFER_START(UnityPerMaterial)
@unity_uniforms@            float _KrsTime;
        CBUFFER_END
        #include "@stem@.hlsl"

        float3 _LightDirection, _LightPosition; // of the pass for shadows

        struct KrsVertex { float4 position : POSITION; };
        struct KrsCorner { float4 clip : SV_POSITION; float3 place : TEXCOORD0; };
        struct KrsMet { float3 place, normal; KrsSurface surface; };

        KrsCorner KrsBox(KrsVertex vertex)
        {
            KrsCorner corner;
            corner.place = TransformObjectToWorld(vertex.position.xyz);
            corner.clip = TransformWorldToHClip(corner.place);
            return corner;
        }

        // Unity's z goes the other way.
        float3 KrsTurned(float3 v) { return float3(v.x, v.y, -v.z); }

        // What a ray meets that ends at a place of the box; parallel rays begin before it.  A pixel is so wide at distance 1, or anywhere
        // for those.
        KrsMet KrsMeet(float3 place, float3 eye, float3 along, bool parallel, float pixel)
        {
            float3 end = KrsTurned(TransformWorldToObject(place)), t_end = KrsTurned(TransformWorldToObjectDir(along, false));
            float3 direction = normalize(parallel ? t_end : end - KrsTurned(TransformWorldToObject(eye)));
            float3 origin = parallel ? end : KrsTurned(TransformWorldToObject(eye));
            krs_parameter[0] = float4(_KrsTime, 0.0, 0.0, 0.0);
@unity_parameters@            krs_prepare();
            float2 inside = krs_inside(origin, direction);
            if (parallel) {
                origin += inside.x * direction;
                inside = float2(0.0, inside.y - inside.x);
                pixel /= max(inside.y, 1e-6);
            }
            float t = 0.0;
            if (!krs_trace(origin, direction, max(inside.x, 0.0), inside.y, pixel, t))
                discard;
            KrsMet met;
            met.surface = krs_seen(origin, direction, t, pixel);
            met.place = TransformObjectToWorld(KrsTurned(origin + t * direction));
            met.normal = TransformObjectToWorldNormal(KrsTurned(met.surface.normal));
            return met;
        }

        KrsMet KrsSeenByCamera(float3 place)
        {
            bool  parallel = unity_OrthoParams.w > 0.0;
            float pixel = 2.0 / (abs(UNITY_MATRIX_P[1][1]) * _ScreenParams.y);
            return KrsMeet(place, GetCameraPositionWS(), -UNITY_MATRIX_V[2].xyz, parallel, pixel);
        }

        float KrsDepth(float4 clip)
        {
        #if defined(SHADER_API_GLCORE) || defined(SHADER_API_GLES3)
            return 0.5 * clip.z / clip.w + 0.5;
        #else
            return clip.z / clip.w;
        #endif
        }

        float4 KrsLit(KrsCorner corner, out float depth : SV_Depth) : SV_Target
        {
            KrsMet met = KrsSeenByCamera(corner.place);
            depth = KrsDepth(TransformWorldToHClip(met.place));
            SurfaceData surface = (SurfaceData)0;
            surface.albedo = met.surface.color;
            surface.metallic = met.surface.metallic;
            surface.smoothness = 1.0 - met.surface.roughness;
            surface.emission = met.surface.emission;
            surface.occlusion = 1.0;
            surface.alpha = 1.0;
            InputData seen = (InputData)0;
            seen.positionWS = met.place;
            seen.normalWS = met.normal;
            seen.viewDirectionWS = GetWorldSpaceNormalizeViewDir(met.place);
            seen.shadowCoord = TransformWorldToShadowCoord(met.place);
            seen.bakedGI = SampleSH(met.normal);
            seen.normalizedScreenSpaceUV = GetNormalizedScreenSpaceUV(corner.clip);
            seen.shadowMask = float4(1.0, 1.0, 1.0, 1.0);
            return UniversalFragmentPBR(seen, surface);
        }

        float4 KrsDepthOnly(KrsCorner corner, out float depth : SV_Depth) : SV_Target
        {
            depth = KrsDepth(TransformWorldToHClip(KrsSeenByCamera(corner.place).place));
            return depth;
        }

        // For occlusion in the space of the screen.
        float4 KrsNormals(KrsCorner corner, out float depth : SV_Depth) : SV_Target
        {
            KrsMet met = KrsSeenByCamera(corner.place);
            depth = KrsDepth(TransformWorldToHClip(met.place));
            return float4(met.normal, 0.0);
        }

        float4 KrsShadow(KrsCorner corner, out float depth : SV_Depth) : SV_Target
        {
        #if defined(_CASTING_PUNCTUAL_LIGHT_SHADOW)
            KrsMet met = KrsMeet(corner.place, _LightPosition, -_LightDirection, false, 0.001);
            float3 toward = normalize(_LightPosition - met.place);
        #else
            KrsMet met = KrsMeet(corner.place, _LightPosition, -_LightDirection, true, 0.001 * length(@half@));
            float3 toward = _LightDirection;
        #endif
            depth = KrsDepth(TransformWorldToHClip(ApplyShadowBias(met.place, met.normal, toward)));
            return 0.0;
        }
// ---- passes ----
        ENDHLSL

        Pass
        {
            Tags { "LightMode" = "UniversalForwardOnly" } // in forward and deferred rendering
            HLSLPROGRAM
            #pragma vertex KrsBox
            #pragma fragment KrsLit
            #pragma multi_compile _ _MAIN_LIGHT_SHADOWS _MAIN_LIGHT_SHADOWS_CASCADE
            #pragma multi_compile _ _ADDITIONAL_LIGHTS
            #pragma multi_compile _ _FORWARD_PLUS
            #pragma multi_compile_fragment _ _SHADOWS_SOFT
            ENDHLSL
        }
        Pass
        {
            Tags { "LightMode" = "ShadowCaster" }
            ColorMask 0
            HLSLPROGRAM
            #pragma vertex KrsBox
            #pragma fragment KrsShadow
            #pragma multi_compile_vertex _ _CASTING_PUNCTUAL_LIGHT_SHADOW
            #pragma multi_compile_fragment _ _CASTING_PUNCTUAL_LIGHT_SHADOW
            ENDHLSL
        }
        Pass
        {
            Tags { "LightMode" = "DepthOnly" }
            HLSLPROGRAM
            #pragma vertex KrsBox
            #pragma fragment KrsDepthOnly
            ENDHLSL
        }
        Pass
        {
            Tags { "LightMode" = "DepthNormalsOnly" }
            HLSLPROGRAM
            #pragma vertex KrsBox
            #pragma fragment KrsNormals
            ENDHLSL
        }
    }
}
