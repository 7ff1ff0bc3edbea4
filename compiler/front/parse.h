/*
 * parse.h: recursive descent from tokens to the syntax tree.
 */
#ifndef KRS_PARSE_H
#define KRS_PARSE_H

#include "compiler/front/syntax.h"

/* The whole file as a SYNTAX_BLOCK; never NULL.  Errors are reported, the parser recovers at
   the next statement, and what could not be read stands in the tree as SYNTAX_ERROR. */
Syntax *parse(const Tokens *tokens, Diags *diags, Arena *arena);

#endif
