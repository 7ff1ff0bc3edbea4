/*
 * input.h: scenes that are no files of their own: standard input, which is called `-`, and packs.
 */
#ifndef KRS_INPUT_H
#define KRS_INPUT_H

#include "cli/options/options.h"
#include "cli/pack/pack.h"

/* Reads standard input if `-` is one of the scenes. */
KrsStatus input_open(Options *options);
/* Tells whether a path stands for the scene that was read by input_open. */
bool is_input(const Options *options, const char *path);

/* Reads the packs among the scenes, in the child: they may come from strangers. */
KrsStatus packs_open(Options *options);
/* Returns the pack of that path; NULL: it is none. */
Pack *pack_of(const Options *options, const char *path);

#endif
