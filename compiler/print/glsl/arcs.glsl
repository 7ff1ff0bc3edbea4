/*
 * arcs.glsl: arc sine, cosine and tangent in single precision.
 *
 * Built-in ones are accurate to 1e-4 only on some devices; these are good to a few units in the last
 * place.  Beyond 1/2 the half-angle formula brings the argument of an arc sine back to where the
 * polynomial is good.  Arguments of the arc tangent above tan(pi / 8) are rotated back by pi / 4.
 *
 * Operations of ops.def call these, and shaders without a scene include this file.
 */
#ifndef KRS_ARCS
#define KRS_ARCS

float krs_asin_small(float x)
{
    float z = x * x;
    float p = 4.2163199048e-2 * z + 2.4181311049e-2;
    p = p * z + 4.5470025998e-2;
    p = p * z + 7.4953002686e-2;
    p = p * z + 1.6666752422e-1;
    return x + x * z * p;
}

float krs_asin(float a)
{
    float x = min(abs(a), 1.0);
    float s = krs_asin_small(mix(x, sqrt(0.5 - 0.5 * x), x > 0.5));
    s = mix(s, 1.57079632679 - 2.0 * s, x > 0.5);
    return mix(s, -s, a < 0.0);
}

float krs_acos(float a)
{
    float x = min(abs(a), 1.0);
    float s = krs_asin_small(mix(x, sqrt(0.5 - 0.5 * x), x > 0.5));
    float near = mix(2.0 * s, 3.14159265359 - 2.0 * s, a < 0.0);
    return mix(1.57079632679 - mix(s, -s, a < 0.0), near, x > 0.5);
}

float krs_atan_unit(float x)
{
    bool far = x > 0.414213562373;
    float y = mix(x, (x - 1.0) / (x + 1.0), far);
    float z = y * y;
    float p = 8.05374449538e-2 * z - 1.38776856032e-1;
    p = p * z + 1.99777106478e-1;
    p = p * z - 3.33329491539e-1;
    y += y * z * p;
    return mix(y, 0.785398163397 + y, far);
}

float krs_atan(float a)
{
    float x = abs(a);
    float s = krs_atan_unit(mix(x, 1.0 / x, x > 1.0));
    s = mix(s, 1.57079632679 - s, x > 1.0);
    return mix(s, -s, a < 0.0);
}

float krs_atan2(float a, float b)
{
    float x = abs(b), y = abs(a), most = max(x, y);
    float s = krs_atan_unit(mix(0.0, min(x, y) / most, most > 0.0));
    s = mix(s, 1.57079632679 - s, y > x);
    s = mix(s, 3.14159265359 - s, b < 0.0);
    return mix(s, -s, a < 0.0);
}

#endif
