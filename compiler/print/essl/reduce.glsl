/*
 * reduce.glsl: krs_reduce of sines.glsl.  There is no `precise` in ESSL 3.00.  A difference whose bits are looked at
 * stays as it is written.
 */

float krs_reduce(float a, float n)
{
    float r = uintBitsToFloat(floatBitsToUint(a - n * 3.140625));
    r = uintBitsToFloat(floatBitsToUint(r - n * 9.67025756836e-4));
    r = r - n * 6.27832947e-7;
    return min(max(r, -1.6), 1.6); // what is left of large arguments may be anything
}
