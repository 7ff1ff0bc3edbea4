/*
 * properties.h: a .jsurf file as its properties.
 */
#ifndef KRS_IMPORT_PROPERTIES_H
#define KRS_IMPORT_PROPERTIES_H

#include "import/common/text.h"

enum { MAX_PARAMETERS = 64 };

typedef struct JsurfProperty {
    const char *key, *value;
    unsigned    line;
} JsurfProperty;

typedef struct JsurfSurface {
    Import *import;
    struct {
        JsurfProperty *items;
        size_t         count, capacity;
    } properties;
    const JsurfProperty *used[MAX_PARAMETERS]; /* parameters of the equation, as it names them */
    size_t               used_count;
    double               scale; /* radius of the ball in the space of the equation */
} JsurfSurface;

/* Reads a file; false after words about what cannot be read. */
bool jsurf_read(JsurfSurface *surface);
/* The last one of a name counts; NULL when there is none. */
const JsurfProperty *jsurf_property(const JsurfSurface *surface, const char *key);
/* Returns the line of the property; 1 when there is none. */
unsigned jsurf_line(const JsurfSurface *surface, const char *key);
/* Reads `count` numbers; those given stay as they are when there is no such property. */
bool jsurf_numbers(const JsurfSurface *surface, const char *key, double *numbers, int count);

#endif
