/*
 * kinds.h: what the parameters of a function take, and whom mistakes inside of it are told to.
 *
 * It is for the files of this folder.
 */
#ifndef KRS_KINDS_H
#define KRS_KINDS_H

#include "compiler/eval/elaborate.h"

/* ---- kinds.c ---- */
/* A path of points becomes one of curves, straight from each to the next; one radius a list. */
Value value_as_kind(Elaboration *e, ParameterKind kind, Value value, const Syntax *origin);
/* Tells whether a parameter takes a value of this type, which may become another; false: reported. */
bool fits_type(Elaboration *e, const Environment *env, const Function *function, const Syntax *call,
               const Syntax *parameter, Value *value, const Syntax *origin);
/* Tells whether a number is in the range of its parameter, if that has one; `origin` is the argument, or
   where the default or the call is, if none is `given`.  False: reported. */
bool fits_range(Elaboration *e, const Environment *env, const Function *function,
                const Syntax *parameter, Value value, const Syntax *origin, bool given);

/* ---- functions.c ---- */
uint32_t parameter_count(const Syntax *definition);
/* Adds a note with the names of all parameters. */
void note_signature(Elaboration *e, Diag *diag, const Syntax *definition);
/* Says how a function of the library is called; how others are, only their author knows. */
void explain_library(Elaboration *e, Diag *diag, const Syntax *call, const Syntax *definition);

/* ---- blame.c ---- */
/* Turns mistakes since `first` inside of the library into mistakes of this call, if it is the
   scene's. */
void blame_caller(Elaboration *e, size_t first, const Syntax *call, const Function *function,
                  const Value *values, const Syntax *const *origins);

#endif
