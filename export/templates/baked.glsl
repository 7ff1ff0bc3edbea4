// The scene as samples: colour and, behind it, distance, @baked_cell@ apart.  A surface is within 1.8 of that from the scene's; what
// is thinner than that may be lost.  The roughness is 0.5, and parameters and the time are those of the export.
struct KrsSurface {
    vec3  color;
    float roughness;
    float metallic;
    vec3  emission;
    vec3  normal;
};

@baked_sampler@
void krs_prepare()
{
}

// Colour and distance at p; beyond the samples a distance that is not too long.
vec4 krs_sample(vec3 p)
{
    vec3  half_cell = vec3(0.5 * @baked_cell@), low = @baked_low@ + half_cell;
    vec3  q = clamp(p, low, low + @baked_size@ - 2.0 * half_cell);
    vec4  found = textureLod(krs_baked, (q - low + half_cell) / @baked_size@, 0.0);
    float away = length(p - q);
    return vec4(found.rgb, away > 0.0 ? away + half_cell.x : found.a);
}

// Between samples of distances they change by at most the square root of 3 of the way.
float krs_distance(vec3 p) { return krs_sample(p).a * 0.57735; }
float krs_distance_lod(vec3 p, float footprint) { return krs_distance(p); }

KrsSurface krs_surface(vec3 p, vec3 normal, float footprint)
{
    return KrsSurface(krs_sample(p).rgb, 0.5, 0.0, vec3(0.0), normal);
}
