/*
 * crowd_texts.h: scenes with parts that are alike but for numbers, in all surroundings.
 */
#ifndef SUPPORT_CROWD_TEXTS_H
#define SUPPORT_CROWD_TEXTS_H

#include <stddef.h>

typedef struct CrowdText {
    const char *name, *show;
    double width; /* of a blend of the crowd: the order counts in which more than two are blended */
} CrowdText;

/* Pictures of the first ones have all ways to join, and a crowd of crowds: others take long to compile. */
enum { PICTURED_CROWDS = 9 };
extern const CrowdText crowd_texts[];
extern const size_t    crowd_text_count;

/* A text with some of them side by side, for free(); `seed` is of all random numbers. */
char *crowd_text(const CrowdText *scenes, size_t count, int seed);

#endif
