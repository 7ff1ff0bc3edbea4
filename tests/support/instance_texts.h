/*
 * instance_texts.h: scenes with parts that are alike but for numbers, in all surroundings.
 */
#ifndef SUPPORT_INSTANCE_TEXTS_H
#define SUPPORT_INSTANCE_TEXTS_H

#include <stddef.h>

typedef struct InstanceText {
    const char *name, *show;
    double
        width; /* of a blend of the instance group: the order counts in which more than two are blended */
} InstanceText;

/* Pictures of the first ones have all ways to join, and an instance group of instance groups: others take long to compile. */
enum { PICTURED_GROUPS = 9 };
extern const InstanceText instance_texts[];
extern const size_t       instance_text_count;

/* Returns a text with some of them side by side, for free(); `seed` is of all random numbers. */
char *instance_text(const InstanceText *scenes, size_t count, int seed);

#endif
