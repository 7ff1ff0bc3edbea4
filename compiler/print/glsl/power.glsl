/*
 * power.glsl: powers of any number.  The built-in pow is undefined for what is not above 0.
 *
 * Infinity and what is no number are bits that a compiler does not know: some refuse them as constants.
 */

float krs_pow(float a, float b)
{
    float size = exp2(b * log2(abs(a)));
    float of_zero = mix(uintBitsToFloat(0x7f800000u | floatBitsToUint(abs(a))), 0.0, b > 0.0);
    float of_negative = mix(size, -size, fract(b * 0.5) != 0.0);
    of_negative = mix(of_negative, uintBitsToFloat(0x7fc00000u | floatBitsToUint(a)), b != floor(b));
    float power = mix(mix(of_negative, size, a > 0.0), of_zero, a == 0.0);
    return mix(power, 1.0, b == 0.0);
}
