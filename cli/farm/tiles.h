/*
 * tiles.h: EXR files of `krs render` that are parts of one picture, as one picture.
 */
#ifndef KRS_TILES_H
#define KRS_TILES_H

#include "cli/shell/commands.h"
#include "runtime/writer/picture.h"

/* The picture that the files make together.  Its samples are malloc'ed, the rest is in the arena. */
typedef struct Tiles {
    Picture         picture;
    PictureChannel *channels;
    PictureText    *texts;
    PictureMatrix   matrices[2];
    bool            has[2]; /* these matrices */
    float         **planes; /* the samples of each channel */
} Tiles;

/* Reads them.  They must be of the same render but for their part of it, no two may have a pixel, and together they
   must fill a rectangle.  Otherwise KRS_IO_ERROR, and what is wrong has been said. */
KrsStatus tiles_read(const Options *options, const char *const *paths, size_t count, Tiles *tiles);
/* Writes the picture as an EXR file, and says why if it cannot. */
KrsStatus tiles_write(const Tiles *tiles, const char *path);
void      tiles_free(Tiles *tiles);

#endif
