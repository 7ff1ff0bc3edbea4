/*
 * quaternions.h: quaternions, and 2x2 matrices of them that stand for conformal maps of space.
 */
#ifndef ORACLE_QUATERNIONS_H
#define ORACLE_QUATERNIONS_H

#include "tests/oracle/brute.h"

typedef struct Quat {
    double w;
    Vec    v;
} Quat;

typedef struct Matrix {
    Quat a, b, c, d;
} Matrix;

Quat quat(double w, Vec v);
/* Returns a vector alone, and a number alone. */
Quat   pure(Vec v);
Quat   real(double w);
Quat   quat_mul(Quat p, Quat q);
Matrix matrix_mul(Matrix m, Matrix n);
/* (a q + b) (c q + d)^-1 */
Quat matrix_apply(const Matrix *m, Vec p);

#endif
