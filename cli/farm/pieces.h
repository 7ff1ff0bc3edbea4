/*
 * pieces.h: renders pieces of a job, and puts pictures together.
 */
#ifndef KRS_FARM_PIECES_H
#define KRS_FARM_PIECES_H

#include "cli/farm/job.h"

enum { MAX_TRIES = 3 }; /* of a piece, before it counts as failed */

typedef enum PieceState {
    PIECE_WAITS,
    PIECE_RUNS,
    PIECE_DONE,
    PIECE_FAILED,
    PIECE_STATES
} PieceState;

PieceState piece_state(const FarmJob *job, const Options *options, const FarmPiece *piece);
/* Returns how often a piece has failed. */
unsigned piece_failures(const FarmJob *job, Arena *arena, uint32_t piece);

/* Renders a piece, unless it is done or somebody is at it, and the pictures that are complete then.  Returns KRS_OK,
   the status of `krs render`, or 75: it was interrupted, and goes on from there when it is rendered again. */
int piece_render(const FarmJob *job, const Options *options, const FarmPiece *piece);
/* Writes the picture of a frame if all its parts are there and it is not. */
KrsStatus frame_finish(const FarmJob *job, const Options *options, uint32_t frame);
/* Tells whether the picture of a frame is there. */
bool frame_is_done(const FarmJob *job, const Options *options, uint32_t frame);

#endif
