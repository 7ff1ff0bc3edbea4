/*
 * vocabulary.h: the words of the language that no file defines, with what they mean.
 */
#ifndef KRS_VOCABULARY_H
#define KRS_VOCABULARY_H

#include "compiler/front/syntax.h"

/* A word that is built in: a row of functions.def, methods.def, constants.def or ops.def each.  The
   last has no name. */
typedef struct BuiltinWord {
    const char *kind, *name; /* "function", "method" or "value" */
    const char *parameters;  /* as the tables have them; NULL: scenes do not call it */
    const char *meaning;
} BuiltinWord;
extern const BuiltinWord builtin_words[];

/* Returns property `index`, from 0, of blocks of a kind, or of declarations of shapes; NULL: there
   are not so many. */
const char *property_of_block(SyntaxKind block, size_t index);

#endif
