/*
 * import_jsurf.h: a .jsurf file in parts: its properties, its equation, and what is made of them.
 */
#ifndef KRS_IMPORT_JSURF_H
#define KRS_IMPORT_JSURF_H

#include "cli/import.h"

enum { MOST_PARAMETERS = 64 };

typedef struct Property {
    const char *key, *value;
    unsigned    line;
} Property;

typedef struct Surface {
    Import *import;
    struct {
        Property *items;
        size_t    count, capacity;
    } properties;
    const Property *used[MOST_PARAMETERS]; /* parameters of the equation, as it names them */
    size_t          used_count;
    double          scale; /* radius of the ball in the space of the equation */
} Surface;

/* import_properties.c; false after words, as in import.h. */
bool jsurf_read(Surface *surface);
/* The last one of a name counts; NULL when there is none. */
const Property *jsurf_property(const Surface *surface, const char *key);
/* `count` numbers; those given stay as they are when there is no such property. */
bool jsurf_numbers(const Surface *surface, const char *key, double *numbers, int count);

/* import_equation.c: the equation in the language of scenes, and the parameters that it uses. */
bool jsurf_equation(Surface *surface, Text *equation);
bool jsurf_write_parameters(const Surface *surface);

#endif
