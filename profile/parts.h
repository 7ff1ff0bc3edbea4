/*
 * parts.h: the parts of a scene that its author can point at.
 *
 * A part is what one expression of the author's texts makes: what a `show` shows, and operands of unions and other
 * joints.  What only moves or paints a part is the same part.  Iterations of a loop are one part.
 */
#ifndef KRS_PROFILE_PARTS_H
#define KRS_PROFILE_PARTS_H

#include "compiler/base/arena.h"
#include "krs/krs.h"

#define NO_PART SIZE_MAX

typedef struct Part {
    const char *name; /* "gear", "torus" */
    KrsLocation location;
    size_t      parent; /* index of the part that it is in first; NO_PART: it is shown */
    size_t      count;  /* shapes that the expression makes */
    bool        shared; /* it is in several parts, as by a function that is called by each */
} Part;

typedef struct Parts {
    Part  *items;
    size_t count, capacity;
} Parts;

/* Returns the text of a part in one line, cut off where it is longer than `length`; its name where
   the text cannot be read. */
const char *part_words(const Part *part, size_t length, Arena *arena);

/* Lists all parts of a scene, each behind the one that it is in.  Strings are the scene's. */
Parts parts_of(const KrsScene *scene, Arena *arena);

#endif
