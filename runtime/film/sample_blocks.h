/*
 * sample_blocks.h: sums over blocks of samples, which are added exactly.
 *
 * Sums of floats depend on their order.  So each pixel's colours are summed as floats within a block of samples, which begins with 0, and
 * the sums of blocks are added exactly.  Machines that render other blocks of a picture thus have the sums of one that
 * renders all.  A film of one block is as if there were none.
 *
 * Films that end samples by noise, or keep the light of lights or of a plate, have no blocks.
 */
#ifndef KRS_SAMPLE_BLOCKS_H
#define KRS_SAMPLE_BLOCKS_H

#include "runtime/film/doublings.h"
#include "runtime/tracer/handles.h"

/* Tells whether a film has blocks. */
bool film_has_blocks(const KrsFilm *film);
/* Makes `first`, a multiple of SAMPLES_OF_BLOCK, the number of the film's first sample.  If it is not 0 the film has colours
   alone. */
void film_begin_at(KrsFilm *film, uint32_t first);
/* Returns how many of so many further samples belong to the block at hand. */
uint32_t blocks_room(const KrsFilm *film, uint32_t samples);
/* Makes room for the sums of blocks.  False with the failure noted. */
bool blocks_make_room(KrsFilm *film);
/* Adds the sums of a block that is full to those before.  False with the failure noted. */
bool blocks_close(KrsFilm *film);
/* Forgets all. */
void blocks_clear(KrsFilm *film);
void blocks_free(KrsFilm *film);
/* Gives a picture of a film the sums over all blocks, and the errors that were estimated by them. */
void blocks_finish(const KrsFilm *film, KrsPicture *picture);

typedef struct SampleSums {
    uint32_t (*numbers)[SUM_AND_NOISE_NUMBERS]; /* of each pixel of the window, malloc'ed */
    bool  noise;
    float noise_floor;
} SampleSums;
/* Returns the sums of all samples of a film that has been read; NULL numbers: no memory is left. */
SampleSums film_sums(const KrsFilm *film);

#endif
