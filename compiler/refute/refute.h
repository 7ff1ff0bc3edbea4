/*
 * refute.h: the attempt to refute the distances of a scene whose shapes are there.
 */
#ifndef KRS_REFUTE_H
#define KRS_REFUTE_H

#include "compiler/passes/compile.h"
#include "compiler/passes/inspect.h"

/* Does what krs_refute does between compiling and the end; a finding is added to in->diags. */
KrsStatus refute_inspected(const Inspected *in, const KrsRefuteOptions *how, KrsRefutation *result);

#endif
