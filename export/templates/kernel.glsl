#version 450
layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 3) readonly buffer KrsPoints { vec4 at[]; } krs_points;
layout(std430, set = 0, binding = 4) writeonly buffer KrsFound { vec4 at[]; } krs_found;
@scene@
@normal@
void main()
{
    krs_prepare();
    uint  i = gl_GlobalInvocationID.x;
    vec3  p = krs_points.at[i].xyz;
    float footprint = krs_points.at[i].w, distance = krs_distance(p);
    vec3  normal = krs_normal_at(p, max(footprint, 1e-4));
    KrsSurface surface = krs_surface(p, normal, footprint);
    krs_found.at[3u * i] = vec4(distance, krs_distance_lod(p, footprint), surface.roughness, surface.metallic);
    krs_found.at[3u * i + 1u] = vec4(surface.color, float(surface.component));
    krs_found.at[3u * i + 2u] = vec4(surface.normal, 0.0);
}
