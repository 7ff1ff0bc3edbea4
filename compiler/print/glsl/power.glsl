/*
 * power.glsl: powers of any number.  The built-in pow is undefined for what is not above 0.
 */

float krs_pow(float a, float b)
{
    if (b == 0.0)
        return 1.0;
    if (a == 0.0)
        return b > 0.0 ? 0.0 : uintBitsToFloat(0x7f800000u);
    float size = exp2(b * log2(abs(a)));
    if (a > 0.0)
        return size;
    if (b != floor(b))
        return uintBitsToFloat(0x7fc00000u);
    return fract(b * 0.5) != 0.0 ? -size : size;
}
