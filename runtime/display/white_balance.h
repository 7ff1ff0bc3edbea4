/*
 * white_balance.h: makes light of a given colour temperature white.
 */
#ifndef KRS_WHITE_BALANCE_H
#define KRS_WHITE_BALANCE_H

/* Kelvins of a black body; and how much greener its light is than that, in 3000ths of the
   distance in CIE 1960 u, v.  Daylight (D65) is about 6504, 9.6. */
typedef struct WhiteBalance {
    double kelvins, tint;
} WhiteBalance;

typedef struct ColorMatrix {
    double m[3][3];
} ColorMatrix;

static inline void color_multiply(const double matrix[3][3], const double v[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = matrix[i][0] * v[0] + matrix[i][1] * v[1] + matrix[i][2] * v[2];
}

/* Returns the matrix for linear Rec.709 colours, by which such light becomes white: an adaptation
   in Bradford's space of cones.  Kelvins that are 0 make the identity. */
ColorMatrix white_balance_matrix(WhiteBalance balance);

#endif
