/*
 * read_exr.h: depths and plates of other renderers, from EXR files.
 */
#ifndef KRS_CLI_READ_EXR_H
#define KRS_CLI_READ_EXR_H

#include "cli/shell/commands.h"

/* Reads the channel Z of a picture of this size; outside of its data window depths are infinite.
   *depth is for free(), NULL on any status but KRS_OK, which is said. */
KrsStatus read_depth(const Options *options, const char *path, uint32_t width, uint32_t height,
                     float **depth);
/* Does the same of R, G, B and A, four numbers a pixel; without A it is 1, and all is 0 outside. */
KrsStatus read_plate(const Options *options, const char *path, uint32_t width, uint32_t height,
                     float (**plate)[4]);

#endif
