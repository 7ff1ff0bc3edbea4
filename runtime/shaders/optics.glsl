/*
 * optics.glsl: what shaders share that know of light.
 */
#ifndef OPTICS // another file may have it already
#define OPTICS

float square(float x) { return x * x; }

float luminance(vec3 color) { return dot(color, vec3(0.2126, 0.7152, 0.0722)); }

float luminance(float gray) { return gray; }

// Replaces components that are negative, infinite or NaN by 0.
vec3 finite_or_black(vec3 radiance)
{
    bvec3 finite = bvec3(radiance.x < INFINITE, radiance.y < INFINITE, radiance.z < INFINITE);
    return mix(vec3(0.0), max(radiance, 0.0), finite);
}

// Returns the reflectance of a boundary between two media.
float fresnel(float cosine, float eta)
{
    float beyond = 1.0 - (1.0 - cosine * cosine) / (eta * eta);
    float through = sqrt(max(beyond, 0.0));
    float across = (cosine - eta * through) / (cosine + eta * through);
    float along = (eta * cosine - through) / (eta * cosine + through);
    return beyond > 0.0 ? 0.5 * (across * across + along * along) : 1.0;
}
#endif
