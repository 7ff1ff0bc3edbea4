/*
 * phase.glsl: into which directions media scatter light (Henyey and Greenstein 1941).
 */
// Returns how much light is scattered into a direction, in solid angle; `cosine`: of the angle by which.
float find_phase(float anisotropy, float cosine)
{
    float base = 1.0 + anisotropy * (anisotropy - 2.0 * cosine);
    return (1.0 - anisotropy * anisotropy) / (4.0 * PI * max(base * sqrt(base), 1e-9));
}
