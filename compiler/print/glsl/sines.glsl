/*
 * sines.glsl: sine, cosine and tangent in single precision, the same on every device.
 *
 * Vulkan guarantees 2^-11 of the built-in ones, and only within +-pi.  These are good to 2^-22 up
 * to 51,000 = 2^14 pi.  Beyond, they are those of an argument that is off by its last digit.
 *
 * An argument is reduced by the nearest multiple of pi (Cody and Waite 1980): n times the first two
 * parts of pi is exact, so the differences must stay as they are written.  sin(a) is then sin(r),
 * with its sign changed where n is odd; cos(a) = sin(a + pi / 2).  Operations of
 * ops.def call these, and shaders without a scene include this file.
 */
#ifndef KRS_SINES
#define KRS_SINES

float krs_reduce(float a, float n)
{
    precise float r = a - n * 3.140625;
    r = r - n * 9.67025756836e-4;
    r = r - n * 6.27832947e-7;
    return min(max(r, -1.6), 1.6); // what is left of large arguments may be anything
}

float krs_sine_small(float r, int n)
{
    float z = r * r;
    float p = 2.60831598e-6 * z - 1.98106907e-4;
    p = p * z + 8.33307859e-3;
    p = p * z - 1.66666597e-1;
    float s = r + r * z * p;
    return uintBitsToFloat(floatBitsToUint(s) ^ (uint(n) << 31));
}

float krs_sin(float a)
{
    float n = floor(a * 0.318309886184 + 0.5);
    return krs_sine_small(krs_reduce(a, n), int(n));
}

float krs_cos(float a)
{
    float n = floor(a * 0.318309886184);
    return krs_sine_small(krs_reduce(a, n + 0.5), int(n) + 1);
}

float krs_tan(float a) { return krs_sin(a) / krs_cos(a); }

#endif
