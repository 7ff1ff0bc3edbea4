/*
 * confine.h: what a command needs that works on a stranger's scene.
 */
#ifndef KRS_CONFINE_H
#define KRS_CONFINE_H

#include "cli/options/options.h"
#include "cli/sandbox/sandbox.h"

/* Prepares for the sandbox, if the command line asks for one: options->needs says then what the child may do.
   KRS_NO_DEVICE, with a line: this system has none; KRS_BAD_ARGUMENT: the command cannot be confined. */
KrsStatus confine_prepare(Options *options);

/* Enters the sandbox, if there is to be one; called by the child when it has opened what lies outside. */
KrsStatus confine_enter(const Options *options);

#endif
