/*
 * judge.h: tries to refute that a field is a safe distance to a solid.
 *
 * The field is what the compiler computes, the solid a question answered from its definition:
 * is this point inside?  What is asked of the field: it is negative exactly inside; around a
 * point, no closer than its size, nothing changes from inside to outside; and it never rises
 * faster than distance.  Counts are returned, not asserted, so that a test can also show that
 * a wrong field is found out.
 */
#ifndef ORACLE_JUDGE_H
#define ORACLE_JUDGE_H

#include "tests/oracle/brute.h"

typedef double Field(const void *user, Vec point);
typedef bool   Inside(const void *user, Vec point);

typedef struct Trial {
    Field      *field;
    const void *field_user;
    Inside     *inside;
    const void *inside_user;
    Vec         centre; /* points are drawn from the cube around it, of this half size */
    double      half;
    int         points;
    uint64_t    seed;
} Trial;

typedef struct Verdict {
    int    sign_errors;  /* negative outside or positive inside */
    int    ball_errors;  /* points whose ball of 0.999 of the field holds both sides */
    int    slope_errors; /* pairs of points between which the field rises too fast */
    double steepest;     /* the greatest slope seen */
} Verdict;

Verdict judge(const Trial *trial);

/* A field times a factor: what a compiler would compute that is wrong by it. */
typedef struct Exaggeration {
    Field      *field;
    const void *user;
    double      factor;
} Exaggeration;
double exaggerated_field(const void *exaggeration, Vec point);

/* Fails the test, with the counts, unless nothing was found against the field. */
void judge_acquits(const Trial *trial, const char *what);
/* Fails the test unless the same points refute the field times a factor, by balls and by
   slopes: so much the judge would have noticed. */
void judge_refutes_larger(const Trial *trial, double factor, const char *what);
/* Likewise for fields that are only bounds, and so refutable by slopes alone. */
void judge_refutes_steeper(const Trial *trial, double factor, const char *what);

#endif
