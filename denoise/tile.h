/*
 * tile.h: a square of a picture, with the pixels around it that its own depend on.
 *
 * 1.  Colours, their variances and guides are loaded (load.c).  2.  Each row of filters.def makes a candidate for the
 * result, and estimates its error (filter.c).  3.  Each pixel takes the candidates that are best around it (choose.c).
 */
#ifndef KRS_DENOISE_TILE_H
#define KRS_DENOISE_TILE_H

#include "denoise/denoise.h"

enum {
    TILE_SIDE = 64,                  /* pixels of the result */
    CHOICE    = 2,                   /* candidates are compared this far around a pixel */
    REACH     = 9,                   /* how far a pixel looks for others that are alike */
    PATCH     = 3,                   /* pixels are alike if those this far around them are */
    SMOOTH    = 2,                   /* variances are means this far around a pixel */
    RIM       = 2 * CHOICE,          /* of a tile, where there are candidates, too */
    MADE      = TILE_SIDE + 2 * RIM, /* side of the square of candidates */
    MARGIN    = RIM + REACH + PATCH + SMOOTH + 1, /* of a tile, where pixels are loaded */
    SIDE      = TILE_SIDE + 2 * MARGIN,           /* side of the square of loaded pixels */
    FIRST     = MARGIN - RIM,                     /* where candidates begin in it */
    PIXELS    = SIDE * SIDE
};

typedef float Square[PIXELS];

/* Three numbers of each pixel, and 1 over the squared difference that counts as small. */
typedef struct Guide {
    Square at[3], scale;
} Guide;

enum {
#define FILTER(id, color, patch, guides) FILTER_##id,
#include "denoise/filters.def"
#undef FILTER
    FILTERS
};

/* What a filter makes, with sums that its estimated error is of. */
typedef struct Candidate {
    Square color[3], error;
    Square weight, slope[3], slope_square; /* sums over the pixels that count */
} Candidate;

typedef struct Tile {
    const DenoisePicture *picture;
    size_t                x, y; /* of its first pixel in the picture */
    size_t begin[2], end[2];    /* of the candidates, of which some may be outside of the picture */
    bool   by_depth;            /* places are told by depths */

    Square color[3],
        known; /* known: 1, or 0 outside of the picture and for colours that are not finite */
    Square variance;
    Guide  normal, albedo, place; /* of places, positions or, third, depths */
    Square slope[2];              /* of depths; without positions */

    Square    distance, share, rows, patches[PATCH + 1], guides; /* of one offset */
    Candidate candidates[FILTERS];
} Tile;

/* Loads the pixels of the tile and around it. */
void tile_load(Tile *tile);
/* Makes all candidates. */
void tile_filter(Tile *tile);
/* Writes the colours of the tile. */
void tile_choose(Tile *tile, float (*result)[3]);

#endif
