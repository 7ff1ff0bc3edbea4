/*
 * import_jsurf.h: a .jsurf file: its properties, its equation, and what is made of them.
 */
#ifndef KRS_IMPORT_JSURF_H
#define KRS_IMPORT_JSURF_H

#include "cli/import.h"

enum { MOST_PARAMETERS = 64 };

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
    const JsurfProperty *used[MOST_PARAMETERS]; /* parameters of the equation, as it names them */
    size_t               used_count;
    double               scale; /* radius of the ball in the space of the equation */
} JsurfSurface;

/* import_properties.c; false after words, as in import.h. */
bool jsurf_read(JsurfSurface *surface);
/* The last one of a name counts; NULL when there is none. */
const JsurfProperty *jsurf_property(const JsurfSurface *surface, const char *key);
/* `count` numbers; those given stay as they are when there is no such property. */
bool jsurf_numbers(const JsurfSurface *surface, const char *key, double *numbers, int count);

/* import_equation.c: the equation in the language of scenes, and the parameters that it uses. */
bool jsurf_equation(JsurfSurface *surface, Text *equation);
bool jsurf_write_parameters(const JsurfSurface *surface);

#endif
