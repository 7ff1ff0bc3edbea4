/*
 * white_balance.c: the colour of a black body, and Bradford's adaptation from it to D65.
 */
#include "runtime/display/white_balance.h"

#include <math.h>

static ColorMatrix multiply(ColorMatrix a, ColorMatrix b)
{
    ColorMatrix product;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            product.m[i][j] = a.m[i][0] * b.m[0][j] + a.m[i][1] * b.m[1][j] + a.m[i][2] * b.m[2][j];
    return product;
}

/* Inverts by the cofactors; the matrices here are far from singular. */
static ColorMatrix invert(ColorMatrix of)
{
    ColorMatrix out;
    double      determinant = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            int a = (j + 1) % 3, b = (j + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
            out.m[i][j] = of.m[a][c] * of.m[b][d] - of.m[a][d] * of.m[b][c];
        }
    for (int j = 0; j < 3; j++)
        determinant += of.m[0][j] * out.m[j][0];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            out.m[i][j] /= determinant;
    return out;
}

/* Computes u, v (CIE 1960) of a black body, within 1e-4 from 1000 to 15000 kelvins (Krystek 1985). */
static void black_body(double t, double uv[2])
{
    uv[0] = (0.860117757 + 1.54118254e-4 * t + 1.28641212e-7 * t * t) /
            (1 + 8.42420235e-4 * t + 7.08145163e-7 * t * t);
    uv[1] = (0.317398726 + 4.22806245e-5 * t + 4.20481691e-8 * t * t) /
            (1 - 2.89741816e-5 * t + 1.61456053e-7 * t * t);
}

/* Finds the white of the light as X, Y, Z with Y = 1. */
static void white_of(WhiteBalance balance, double xyz[3])
{
    const double step = 1e-3 * balance.kelvins, distance = balance.tint / 3000;
    double       uv[2], hotter[2];
    black_body(balance.kelvins, uv);
    black_body(balance.kelvins + step, hotter);
    /* Across the curve of black bodies: to its green side. */
    double along[2] = {hotter[0] - uv[0], hotter[1] - uv[1]}, length = hypot(along[0], along[1]);
    uv[0] += distance * along[1] / length;
    uv[1] -= distance * along[0] / length;
    xyz[0] = 1.5 * uv[0] / uv[1];
    xyz[1] = 1;
    xyz[2] = (2 - 0.5 * uv[0]) / uv[1] - 5;
}

ColorMatrix white_balance_matrix(WhiteBalance balance)
{
    static const ColorMatrix xyz_of_rgb = {{{0.4123907993, 0.3575843394, 0.1804807884},
                                            {0.2126390059, 0.7151686788, 0.0721923154},
                                            {0.0193308187, 0.1191947798, 0.9505321522}}};
    static const ColorMatrix bradford   = {
          {{0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}}};
    static const double one[3] = {1, 1, 1};
    ColorMatrix         adapt  = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    double              light[3], daylight[3], from[3], to[3];
    if (!(balance.kelvins > 0))
        return adapt;
    white_of(balance, light);
    color_multiply(xyz_of_rgb.m, one, daylight);
    color_multiply(bradford.m, light, from);
    color_multiply(bradford.m, daylight, to);
    for (int i = 0; i < 3; i++)
        adapt.m[i][i] = to[i] / from[i];
    ColorMatrix cones = multiply(bradford, xyz_of_rgb); /* of colours */
    return multiply(invert(cones), multiply(adapt, cones));
}
