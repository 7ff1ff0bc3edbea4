/*
 * equation.h: the equation of a .jsurf file.
 */
#ifndef KRS_IMPORT_EQUATION_H
#define KRS_IMPORT_EQUATION_H

#include "import/surfer/properties.h"

/* Finds the equation in the language of scenes, and the parameters that it uses. */
bool jsurf_equation(JsurfSurface *surface, Text *equation);
bool jsurf_write_parameters(const JsurfSurface *surface);

#endif
