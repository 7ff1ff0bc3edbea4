/*
 * letters.h: texts as contours, in a module of their own: a page fetches the readers of fonts when a scene
 * has a text.
 */
#ifndef KRS_WEB_LETTERS_H
#define KRS_WEB_LETTERS_H

#include "compiler/outline/letters.h"

/* What the numbers of contours begin with: a function of path.h, whose points follow. */
typedef enum LetterStep {
    STEP_MOVE,
    STEP_LINE,
    STEP_QUADRATIC,
    STEP_CUBIC,
    STEP_CLOSE,
    STEP_COUNT
} LetterStep;

/* The points of each step. */
static const unsigned char letter_points[STEP_COUNT] = {
    [STEP_MOVE] = 1, [STEP_LINE] = 1, [STEP_QUADRATIC] = 2, [STEP_CUBIC] = 3};

/* Why there are no contours. */
typedef enum LetterFault { LETTERS_NO_FONT, LETTERS_NO_MEMORY } LetterFault;

/* Returns the contours that letters_draw draws: `missing` and then *count - 1 numbers of steps, for
   free().  NULL: *count is a LetterFault. */
double *letters_of(const unsigned char *font, size_t length, int face, const char *text,
                   const Lettering *lettering, size_t *count);

#endif
