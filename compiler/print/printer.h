/*
 * printer.h: what of a text depends on its language.
 *
 * A shading language is a Printer: its types, operations and templates, and files with the functions
 * that operations call.  One that is nearly another has that for a base.
 */
#ifndef KRS_PRINTER_H
#define KRS_PRINTER_H

#include "compiler/base/embedded.h"
#include "compiler/graph/graph.h"
#include "compiler/print/variant.h"

/*
 * Something that is written in one of two ways.  Texts name it as a function, while they are put
 * together, and each line is written out at its end: an expression is as long, and stands where it
 * stands, whichever way that is.
 */
typedef struct Alternative {
    const char *name;
    const char *threads, *few; /* for many threads, or for few; with $a and $b */
} Alternative;

enum { TYPES = TYPE_UINT + 1 }; /* of the graph; 0 is none */

typedef enum TextTemplate {
#define TEMPLATE(NAME, operands, meaning) TEMPLATE_##NAME,
#include "compiler/print/templates.def"
    TEMPLATE_COUNT
} TextTemplate;

typedef struct Printer {
    const char *name;
    /* Another language, whose words stand wherever this one has none (NULL); its helpers are behind
       those of this one. */
    const struct Printer *base;
    const char *const    *types; /* by GraphType */
    /* An expression of operands $a to $d, by the type of its result; $A is $a without parentheses
       around it.  What is before a semicolon is a statement, which sets $t.  NULL: the base's. */
    const char *(*operation)(Op op, GraphType type);
    /* Functions that operations call, with blank lines between; and krs_box_distance,
       krs_mirror_excess, krs_sin, krs_cos, krs_tan and krs_gradient_N, which texts call themselves:
       the last is the gradient of component N by differences. */
    const EmbeddedFile *helpers;
    /* Adds a helper or an operation of the base in words of this language; of helpers the type does not
       matter.  NULL: they have the same words. */
    void (*spell)(const char *text, size_t length, GraphType type, Text *out);
    const Alternative *alternatives; /* the last has no name */
    const char *const *templates;    /* by TextTemplate */
    /* A value that the host has found of a state is a macro that reads its slot, not a global that
       krs_prepare sets: drivers that follow each global through all functions take several times as
       long to compile. */
    bool macros;
} Printer;

#define KRS_TARGET(id, name, about) extern const Printer name##_printer;
#include "krs/targets.def"
/* A printer for each KrsTarget. */
extern const Printer *const printers[];

/* Returns a printer with its base's words; they are in memory of the arena. */
Printer printer_with_base(const Printer *printer, Arena *arena);

/* Returns an operation in words of the printer. */
const char *printer_operation(const Printer *printer, Op op, GraphType type, Arena *arena);

/* Adds the functions that the text of one operation calls, where its first operand has this type;
   false: it cannot have it. */
bool module_print_helpers(const Printer *printer, Op op, GraphType type, uint32_t operands,
                          Text *out);

#endif
