/*
 * albedo_tables.c: writes tables of how much light microfacets and sheen reflect, where they mirror all of it.
 *
 * Microfacets are those of GGX with the masking of Smith: means over the normals that are visible (Heitz 2018).
 * Sheen is that of Estevez and Kulla (2017), with the visibility of Neubelt and Pettineo.  The build runs this;
 * tests/oracle/albedo.c and anisotropy.c integrate over all normals instead, and compare.
 */
#include <math.h>
#include <stdio.h>

#include "runtime/tracer/albedos.h"

static double square(double x) { return x * x; }

static double fifth_power(double x) { return square(square(x)) * x; }

/* Returns the cosine of a column: columns are square roots of cosines, in equal steps. */
static double cosine_of(uint32_t column, uint32_t columns, double least)
{
    return fmin(fmax(square(column / (columns - 1.0)), least), 0.999999);
}

/* ---- microfacets as wide along both tangents, and sheen ---- */

enum { POINTS = 192 }; /* along each side of the domain of a mean */

/* A direction of the eye, by its cosine, and the points of both means that it leaves as they are for all
   roughnesses. */
typedef struct Eye {
    double cosine, sine;
    double log_squared_sine[POINTS][POINTS]; /* of halfway vectors, */
    double weight[POINTS];                   /* by heights of the light */
} Eye;

/* Returns the cosine of an azimuth.  Half of the azimuths are enough: the others are the same. */
static double cosine_of_azimuth(int i) { return cos(M_PI * (i + 0.5) / POINTS); }

static void look_from(double cosine, Eye *eye)
{
    eye->cosine = cosine;
    eye->sine   = sqrt(1 - square(cosine));
    for (int i = 0; i < POINTS; i++) {
        const double z = (i + 0.5) / POINTS, ring = sqrt(1 - square(z));
        eye->weight[i] = z / (4 * (z + cosine - z * cosine));
        for (int k = 0; k < POINTS; k++) {
            const double along          = eye->sine * ring * cosine_of_azimuth(k);
            const double size           = 2 + 2 * (along + cosine * z);
            eye->log_squared_sine[i][k] = log(fmax(1 - square(cosine + z) / size, 1e-300));
        }
    }
}

/* Returns Smith's function: what is hidden of a direction, for one that is seen. */
static double hidden(double cosine, double alpha)
{
    const double squared = square(cosine), tangent = fmax(1 - squared, 0) / fmax(squared, 1e-20);
    return 0.5 * (sqrt(1 + square(alpha) * tangent) - 1);
}

/* Finds the share of light that is mirrored, and what Schlick's factor weights of it. */
static void find_mirrored(const Eye *eye, double alpha, const double azimuths[POINTS],
                          double shares[2])
{
    const double length = hypot(alpha * eye->sine, eye->cosine);
    const double tall[] = {alpha * eye->sine / length, eye->cosine / length};
    const double here   = 1 + hidden(eye->cosine, alpha);
    shares[0] = shares[1] = 0;
    for (int k = 0; k < POINTS; k++) {
        /* The third power of the part is even, so that steep facets count right. */
        const double part = (k + 0.5) / POINTS, weight = 3 * square(part);
        const double rise = square(part) * part * (1 + tall[1]), z = fmax(rise, 1e-9);
        const double ring    = sqrt(fmax(1 - square(rise - tall[1]), 0));
        double       sums[2] = {0, 0};
        for (int i = 0; i < POINTS; i++) {
            const double x      = alpha * (ring * azimuths[i] + tall[0]);
            const double y2     = square(alpha * ring) * (1 - square(azimuths[i]));
            const double size   = sqrt(square(x) + y2 + square(z));
            const double facing = (x * eye->sine + z * eye->cosine) / size;
            const double leaves = 2 * facing * z / size - eye->cosine;
            const double share  = leaves > 0 ? here / (here + hidden(leaves, alpha)) : 0;
            sums[0] += share;
            sums[1] += share * fifth_power(fmax(1 - facing, 0));
        }
        shares[0] += weight * sums[0] / square(POINTS);
        shares[1] += weight * sums[1] / square(POINTS);
    }
}

static double find_sheen(const Eye *eye, double alpha)
{
    double total = 0;
    for (int i = 0; i < POINTS; i++) {
        double sum = 0;
        for (int k = 0; k < POINTS; k++)
            sum += exp(0.5 / alpha * eye->log_squared_sine[i][k]);
        total += eye->weight[i] * sum;
    }
    return (2 + 1 / alpha) * total / square(POINTS);
}

/* Prints albedos.  Rows are roughnesses, from 0 to 1; those of sheen begin at MIN_SHEEN_ROUGHNESS
   (bsdf.glsl). */
static void print_albedos(void)
{
    static Eye    eye;
    static double numbers[ALBEDO_SIDE][ALBEDO_SIDE][3];
    double        azimuths[POINTS];
    for (int i = 0; i < POINTS; i++)
        azimuths[i] = cosine_of_azimuth(i);
    for (uint32_t column = 0; column < ALBEDO_SIDE; column++) {
        look_from(cosine_of(column, ALBEDO_SIDE, 1e-4), &eye);
        for (uint32_t row = 0; row < ALBEDO_SIDE; row++) {
            const double roughness = row / (ALBEDO_SIDE - 1.0);
            find_mirrored(&eye, fmax(square(roughness), 1e-3), azimuths, numbers[row][column]);
            numbers[row][column][2] = find_sheen(&eye, square(0.3 + 0.7 * roughness));
        }
    }
    puts("const float albedos[ALBEDO_ROWS][RESULT_NUMBERS] = {");
    for (uint32_t i = 0; i < ALBEDO_ROWS; i++) {
        const double *n = numbers[i / ALBEDO_SIDE][i % ALBEDO_SIDE];
        printf("{%.5f, %.5f, %.5f},\n", n[0], n[1], n[2]);
    }
    puts("};");
}

/* ---- microfacets that are wider along a tangent ---- */

enum {
    LATTICE      = 10946,
    LATTICE_STEP = 6765
}; /* points by Fibonacci's numbers, which make no rows */

static void set_unit(double x, double y, double z, double v[3])
{
    const double size = sqrt(square(x) + square(y) + square(z));
    v[0]              = x / size;
    v[1]              = y / size;
    v[2]              = z / size;
}

static double hidden_of(const double v[3], const double alpha[2])
{
    const double slope = square(alpha[0] * v[0]) + square(alpha[1] * v[1]);
    return 0.5 * (sqrt(1 + slope / fmax(square(v[2]), 1e-20)) - 1);
}

/* Computes as find_mirrored does, with a roughness along each tangent. */
static void find_wide(const double eye[3], const double alpha[2], double shares[2])
{
    double tall[3];
    set_unit(alpha[0] * eye[0], alpha[1] * eye[1], eye[2], tall);
    const double here = 1 + hidden_of(eye, alpha);
    shares[0] = shares[1] = 0;
    for (int i = 0; i < LATTICE; i++) {
        const double phi  = 2 * M_PI * (i * LATTICE_STEP % LATTICE + 0.5) / LATTICE;
        const double z    = (1 - (i + 0.5) / LATTICE) * (1 + tall[2]) - tall[2];
        const double ring = sqrt(fmax(1 - square(z), 0));
        double       m[3], light[3];
        set_unit(alpha[0] * (ring * cos(phi) + tall[0]), alpha[1] * (ring * sin(phi) + tall[1]),
                 fmax(z + tall[2], 1e-9), m);
        const double facing = m[0] * eye[0] + m[1] * eye[1] + m[2] * eye[2];
        for (int k = 0; k < 3; k++)
            light[k] = 2 * facing * m[k] - eye[k];
        if (light[2] <= 0)
            continue;
        const double share = here / (here + hidden_of(light, alpha));
        shares[0] += share / LATTICE;
        shares[1] += share * fifth_power(fmax(1 - facing, 0)) / LATTICE;
    }
}

/* The widths are those of OpenPBR. */
static void print_wide_cell(double anisotropy, double roughness, double cosine)
{
    const double across = 1 - anisotropy, sine = sqrt(1 - square(cosine));
    const double along   = square(roughness) * sqrt(2 / (1 + square(across)));
    const double alpha[] = {fmax(along, 1e-3), fmax(across * along, 1e-3)};
    double       shares[WIDE_AZIMUTHS][2];
    for (int i = 0; i < WIDE_AZIMUTHS; i++) {
        const double part  = i / (WIDE_AZIMUTHS - 1.0); /* the squared cosine of the azimuth */
        const double eye[] = {sine * sqrt(part), sine * sqrt(1 - part), cosine};
        find_wide(eye, alpha, shares[i]);
    }
    printf("{");
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < WIDE_AZIMUTHS; i++)
            printf("%.0f, ", nearbyint(1000 * shares[i][k]));
    printf("},\n");
}

static void print_wide_albedos(void)
{
    puts("const uint16_t wide_albedos[WIDE_ALBEDO_ROWS][2 * WIDE_AZIMUTHS] = {");
    for (uint32_t i = 0; i < WIDE_ALBEDO_ROWS; i++) {
        const uint32_t row = i / WIDE_COSINES;
        print_wide_cell(row / WIDE_ROUGHNESSES / (WIDE_ANISOTROPIES - 1.0),
                        row % WIDE_ROUGHNESSES / (WIDE_ROUGHNESSES - 1.0),
                        cosine_of(i % WIDE_COSINES, WIDE_COSINES, 1e-3));
    }
    puts("};");
}

int main(void)
{
    puts("#include \"runtime/tracer/albedos.h\"");
    print_albedos();
    print_wide_albedos();
}
