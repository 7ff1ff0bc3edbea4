/*
 * parse_options.h: the command line, understood.
 */
#ifndef KRS_PARSE_OPTIONS_H
#define KRS_PARSE_OPTIONS_H

#include "cli/options/options.h"

/* Understands the words behind `krs`.  KRS_OK, or KRS_BAD_ARGUMENT after one line on standard
   error that says what is wrong.  `options->arena` must be set. */
KrsStatus options_parse(Options *options, int argc, char **argv);

#endif
