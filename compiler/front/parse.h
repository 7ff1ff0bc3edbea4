/*
 * parse.h: recursive descent from tokens to the syntax tree.
 */
#ifndef KRS_PARSE_H
#define KRS_PARSE_H

#include "compiler/front/syntax.h"

/* Returns the whole file as a SYNTAX_BLOCK, never NULL.  After an error, which is reported, parsing
   continues at the next statement.  A SYNTAX_ERROR stands in place of what could not be read. */
Syntax *parse(const Tokens *tokens, Diags *diags, Arena *arena);

#endif
