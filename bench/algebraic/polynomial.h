/*
 * polynomial.h: polynomials of x, y and z, multiplied out: what POV-Ray's `poly` wants.
 */
#ifndef KRS_BENCH_POLYNOMIAL_H
#define KRS_BENCH_POLYNOMIAL_H

enum { LARGEST_DEGREE = 14, SIDE = LARGEST_DEGREE + 1 };

/* c[i][j][k] of x^i y^j z^k; what is beyond the degree is 0. */
typedef struct Polynomial {
    double c[SIDE][SIDE][SIDE];
} Polynomial;

/* A name that a text may use. */
typedef struct Definition {
    const char *name, *text; /* a NULL name ends a list */
} Definition;

/* Reads +, -, *, ^, parentheses, numbers, x, y, z and names defined before; ends the process with a
   message where a text is nothing of that. */
Polynomial polynomial_read(const char *text, const Definition *definitions);
double     polynomial_value(const Polynomial *p, const double at[3]);

#endif
