/*
 * resolution.h: how large pictures of what moves may be, to be in time.
 *
 * What a picture costs is learned from those that were made.  Each costs something even if it has few
 * pixels, since passes wait for each other, and each pixel costs something.
 */
#ifndef KRS_RESOLUTION_H
#define KRS_RESOLUTION_H

typedef struct Resolution {
    double pixel_ms, fixed_ms; /* of coarse pictures; 0: not known yet */
    double coarse_pixels;      /* of the last coarse picture */
    double coarse_ms;          /* what it took */
    double whole_ms;           /* of a sample of a whole picture; 0: not known yet */
    double divisor;            /* of the sides of coarse pictures; 0: none was made yet */
} Resolution;

/* The most that the sides of coarse pictures are divided by. */
#define MAX_DIVISOR 32

/* Learns that a coarse picture of so many pixels took `ms`. */
void resolution_learn_coarse(Resolution *resolution, double ms, double pixels);
/* Learns that a sample of a whole picture took `ms`, behind a coarse one of the same view. */
void resolution_learn_whole(Resolution *resolution, double ms, double pixels);
/* Tells how many times fewer pixels each side of a coarse picture has, for it to take `budget` ms; `pixels`
   are those of a whole one.  1: whole ones are in time. */
double resolution_divide(Resolution *resolution, double pixels, double budget);

#endif
