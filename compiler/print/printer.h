/*
 * printer.h: what of a text depends on its language.
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

typedef struct Printer {
    const char        *name;
    const char *const *types;         /* by GraphType */
    const char *(*operation)(Op op);  /* with $a to $d; what is before a semicolon sets $t first */
    const EmbeddedFile *helpers;      /* functions that operations call, with blank lines between */
    const Alternative  *alternatives; /* the last has no name */
    const char *signatures[KRS_FUNCTION_COUNT]; /* by KrsFunction; NULL: it has none of its own */
    const char *promises[KRS_FUNCTION_COUNT];   /* comments above them */
} Printer;

extern const Printer glsl_printer;

/* Adds the functions that the text of one operation calls, where its first operand has this type;
   false: it cannot have it. */
bool module_print_helpers(const Printer *printer, Op op, GraphType type, uint32_t operands,
                          Text *out);

#endif
