#version 450
#extension GL_GOOGLE_include_directive : enable
/*
 * bulb.comp: ../scenes/bulb.krs by hand: the eighth power as polynomials, and the usual estimate of
 * the distance (Quilez), of the same solid: what is no farther than 2^(1/7) after six iterations.
 */
#include "view.glsl"

// A ball of radius 2^(1/7) holds it.
#define LOW      vec3(-1.105)
#define HIGH     vec3(1.105)
#define METALLIC 0.0

float map(vec3 p)
{
    vec3  w = p;
    float m = dot(w, w), dz = 1.0;
    for (int i = 0; i < 6; i++) {
        float m2 = m * m;
        dz = 8.0 * sqrt(m2 * m2 * m2 * m) * dz + 1.0;
        float x = w.x, x2 = x * x, x4 = x2 * x2;
        float y = w.y, y2 = y * y, y4 = y2 * y2;
        float z = w.z, z2 = z * z, z4 = z2 * z2;
        float k3 = x2 + z2;
        float k2 = inversesqrt(k3 * k3 * k3 * k3 * k3 * k3 * k3);
        float k1 = x4 + y4 + z4 - 6.0 * y2 * z2 - 6.0 * x2 * y2 + 2.0 * z2 * x2;
        float k4 = x2 - y2 + z2;
        w = p + vec3(64.0 * x * y * z * (x2 - z2) * k4 * (x4 - 6.0 * x2 * z2 + z4) * k1 * k2,
                     -16.0 * y2 * k3 * k4 * k4 + k1 * k1,
                     -8.0 * y * k4 * (x4 * x4 - 28.0 * x4 * x2 * z2 + 70.0 * x4 * z4 -
                                      28.0 * x2 * z2 * z4 + z4 * z4) * k1 * k2);
        m = dot(w, w);
        if (m > 256.0)
            break;
    }
    return 0.25 * log(m / 1.2190137) * sqrt(m) / dz;
}

vec4 material(vec3 p) { return vec4(0.58407842, 0.39157249, 0.18782077, 0.6); }

#include "tracer.glsl"
