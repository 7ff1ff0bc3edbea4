/*
 * frame_paths.h: file names of frames: "ring-%04d.exr".
 */
#ifndef KRS_CLI_FRAME_PATHS_H
#define KRS_CLI_FRAME_PATHS_H

#include "cli/shell/commands.h"

/* Tells how many places for a number a name has: "%d", "%04d". */
int frame_places(const char *path);
/* Returns the name with a number in that place. */
const char *numbered_path(const Options *options, const char *path, uint32_t number);
/* Returns the name for a frame; without --frames, names are taken as they are. */
const char *frame_path(const Options *options, const char *path, uint32_t frame);
/* Tells whether two names are one file in some frame.  Names that differ in the number's width only are
   equal from some power of ten on. */
bool are_one_file(const Options *options, const char *a, const char *b);

#endif
