/*
 * along_method.h: ways to tell how far a ray may go.
 */
#ifndef KRS_ALONG_METHOD_H
#define KRS_ALONG_METHOD_H

/* How to tell how far a ray may go; all are safe. */
typedef enum AlongMethod {
    ALONG_EXACT,       /* by Bernstein coefficients: ray_step.c */
    ALONG_TAYLOR,      /* by the slope that a Taylor series permits (Ban and Valasek): the r with
                        r sum n |P_n| r^(n-1) = |P_0| */
    ALONG_ROOT_FREE,   /* by what keeps a Taylor series from 0: the r with sum |P_n| r^n = |P_0| */
    ALONG_POLYNOMIALS, /* so many for polynomials; for sequences with maps that invert: */
    ALONG_DIRECTIONAL = ALONG_POLYNOMIALS, /* by where the ray leaves empty balls: ray_images.c */
    ALONG_PROBE, /* by whether a ball around OP_POINT, of radius OP_FOOTPRINT, is empty: when
                        what is computed is more than the radius; no distance, but about what the
                        radius could be */
    ALONG_COUNT
} AlongMethod;

#endif
