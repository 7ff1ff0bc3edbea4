/*
 * input.h: a scene on standard input, which is called `-`.
 */
#ifndef KRS_INPUT_H
#define KRS_INPUT_H

#include "cli/options/options.h"

/* Reads standard input if `-` is one of the scenes. */
KrsStatus input_open(Options *options);
/* Tells whether a path stands for the scene that was read by input_open. */
bool is_input(const Options *options, const char *path);

#endif
