/*
 * along_method.h: methods that compute how far a ray may go.
 */
#ifndef KRS_ALONG_METHOD_H
#define KRS_ALONG_METHOD_H

/* Methods that compute how far a ray may go; all are safe. */
typedef enum AlongMethod {
    /* Polynomials (ray_step.c). */
    ALONG_EXACT,       /* by Bernstein coefficients */
    ALONG_TAYLOR,      /* by the slope of a Taylor series (Ban and Valasek): the r with
                        r sum n |P_n| r^(n-1) = |P_0| */
    ALONG_ROOT_FREE,   /* by a radius in which a Taylor series has no root: the r with
                        sum |P_n| r^n = |P_0| */
    ALONG_POLYNOMIALS, /* number of the methods above */
    /* Sequences with maps that invert (ray_images.c). */
    ALONG_DIRECTIONAL = ALONG_POLYNOMIALS, /* by where the ray leaves empty balls */
    ALONG_PROBE, /* tests a ball around OP_POINT of radius OP_FOOTPRINT: it is empty when the result
                    exceeds the radius.  The result is no distance, but about the radius that an
                    empty ball could have. */
    ALONG_COUNT
} AlongMethod;

#endif
