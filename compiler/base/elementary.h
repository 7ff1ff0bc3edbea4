/*
 * elementary.h: functions of numbers in double precision that give the same on every machine.
 *
 * Each C library rounds its own way, so a scene would have another text, and another key in caches, where another one is.
 * These consist of operations that IEEE 754 rounds, in an order that is written down.  They are good to three units in the
 * last place, and have the values of C at zeros, infinities and what is no number.  What is exact in every library is not
 * among them: roots, rounding, fmod, remainder, fma.
 */
#ifndef KRS_ELEMENTARY_H
#define KRS_ELEMENTARY_H

double real_sin(double x);
double real_cos(double x);
double real_tan(double x);
double real_asin(double x);
double real_acos(double x);
double real_atan(double x);
double real_atan2(double y, double x);
double real_sinh(double x);
double real_cosh(double x);
double real_tanh(double x);
double real_exp(double x);
double real_exp2(double x);
double real_log(double x);
double real_log2(double x);
double real_log1p(double x);
double real_pow(double x, double y);
double real_cbrt(double x);
double real_hypot(double x, double y);

#endif
