/*
 * job.h: a render that is divided into pieces, for any number of processes on any number of machines.
 *
 * A job is a folder that all of them see:
 *
 *     job.json        what is rendered (job.c)
 *     scene.krsz      the scene and all that it reads
 *     parts/          of frames that are not complete: T-FFFFFF.exr, part T of frame F
 *     pieces/         N.lock while piece N is rendered, N.log what was said, N.failed a line for each failure
 *     probes/         a small picture of each machine (probe.h)
 *     cancelled       nobody takes another piece
 *
 * A part is a tile, or some of its samples, and a piece is a part of some frames.  Who has rendered the last part of a
 * frame writes its picture, and removes the parts.  Files appear whole or not at all, and a part depends on nothing but
 * the job: what is rendered twice is the same, and what is lost is rendered again.
 */
#ifndef KRS_FARM_JOB_H
#define KRS_FARM_JOB_H

#include "cli/shell/commands.h"

enum { MAX_PIECES = 10000000 };

typedef struct FarmJob {
    const char *folder;
    const char          *
        output; /* the whole path of pictures: with a place for the number of a frame if there are several */
    bool         animated;
    uint32_t     first, last; /* frames; 0 and 0 if it is not animated */
    uint32_t     width, height;
    uint32_t     across, down; /* tiles */
    uint32_t     samples;      /* of a pixel */
    uint32_t     ranges;       /* into which they are divided */
    uint32_t     chunk;        /* frames of a piece */
    const char **words;        /* options of `krs render` */
    size_t       word_count;
} FarmJob;

/* A part of frames [first, last]. */
typedef struct FarmPiece {
    uint32_t number, part, first, last;
} FarmPiece;

/* These make the folders of a job, and write job.json, which makes it one; they say why if they cannot. */
KrsStatus job_make_folders(const FarmJob *job, Arena *arena);
KrsStatus job_write(const FarmJob *job, Arena *arena);
/* Reads that; KRS_IO_ERROR and words if there is no job. */
KrsStatus job_read(Arena *arena, const char *folder, FarmJob *job);

/* Tells whether the job has MAX_PIECES pieces at most: others are neither submitted nor read. */
bool job_fits(const FarmJob *job);

uint32_t  job_frames(const FarmJob *job);
uint32_t  job_parts(const FarmJob *job);
uint32_t  job_pieces(const FarmJob *job);
FarmPiece job_piece(const FarmJob *job, uint32_t number);
/* Returns the window of a part, and "0..63/256" of its samples. */
KrsWindow   job_window(const FarmJob *job, uint32_t part);
const char *job_samples(const FarmJob *job, Arena *arena, uint32_t part);

/* Returns the path of a file of the folder. */
const char *job_path(const FarmJob *job, Arena *arena, const char *name);
/* Returns the path of a part, of the picture of a frame, and of a file of a piece. */
const char *job_part(const FarmJob *job, Arena *arena, uint32_t part, uint32_t frame);
const char *job_picture(const FarmJob *job, const Options *options, uint32_t frame);
const char *job_file(const FarmJob *job, Arena *arena, uint32_t piece, const char *ending);

#endif
