/*
 * words.c: what is built in, as a list: names, parameters and meanings of the tables.
 */
#include "compiler/eval/elaborate.h"

const BuiltinWord builtin_words[] = {
#define MAP(name, arity, called, glsl, value, range, da, db, dc, norm, meaning) \
    {"function", #name, called, meaning},
#include "compiler/graph/ops.def"
#define FUNCTION(name, parameters, function, meaning) {"function", #name, parameters, meaning},
#include "compiler/eval/builtins/functions.def"
#define METHOD(name, parameters, function, meaning) {"method", #name, parameters, meaning},
#include "compiler/eval/builtins/methods.def"
#undef METHOD
#define CONSTANT(name, meaning) {"value", #name, "", meaning},
#include "compiler/eval/builtins/constants.def"
    {NULL, NULL, NULL, NULL}};
