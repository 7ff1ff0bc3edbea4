@scene@
@normal@
// Roughness, colour and all else of the surface near p, and the point of the surface that so many steps from p reach.
void evaluate_scene(@osl_given@, vec3 p, float footprint, int steps, out KrsSurface met, out float away, out vec3 nearest)
{
    KrsFrame krs = krs_prepare(@osl_passed@);
    float reach = max(footprint, 1e-4 * max(max(abs(p.x), abs(p.y)), max(abs(p.z), 1e-3)));
    met = krs_surface(p, krs_normal_at(p, reach), footprint);
    away = krs_distance(p);
    nearest = p;
    for (int i = 0; i < steps; i++)
        nearest -= krs_distance(nearest) * krs_normal_at(nearest, reach);
}
