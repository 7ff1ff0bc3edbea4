/*
 * ask.h: the value of one expression of a scene, for editors.
 *
 * Only what the expression needs is evaluated, within a number of steps, and nothing is reported: files may have
 * mistakes.  What depends on how often a loop has run, or on arguments, is evaluated for an example: the first element,
 * the default of a parameter, or a value of its kind.
 */
#ifndef KRS_ASK_H
#define KRS_ASK_H

#include "compiler/base/loader.h"
#include "compiler/eval/value.h"
#include "compiler/front/files.h"

typedef struct Asking Asking;

/* Prepares questions about files whose names have been checked.  `values` is for values alone, and `scratch` is free to
   use. */
Asking *asking_new(Files *files, const Loader *loader, Arena *arena, Arena *values, Arena *scratch);

/* Returns the value of the last of some nodes, each a child of the one before it; the first is the
   tree of file number `file`.  VALUE_ERROR: it is not known. */
Value ask_value(Asking *asking, size_t file, const Syntax *const *nodes, size_t count);
/* Returns the same of a statement that defines a name, of the name. */
Value ask_definition(Asking *asking, size_t file, const Syntax *const *nodes, size_t count);
/* Runs the statements of the first file, and returns how many mistakes they have, as far as it comes within the steps;
   nothing else can be asked then. */
size_t ask_mistakes(Asking *asking);
/* Says what a value is: "1.5", "a shape, `sphere`, from [-1, -1, -1] to [1, 1, 1]"; nothing of VALUE_ERROR. */
void ask_text(Asking *asking, Value value, Text *out);
/* Returns the number of components of a vector; else 0 or 1. */
uint32_t ask_size(Asking *asking, Value value);

#endif
