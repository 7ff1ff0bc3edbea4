/*
 * checkpoint.h: `krs render --resume`: what has been rendered stays when the command ends too early.
 */
#ifndef KRS_CHECKPOINT_H
#define KRS_CHECKPOINT_H

#include "cli/picture/sample_sums.h"
#include "cli/shell/commands.h"

typedef struct Checkpoint {
    const Options *options;
    const char    *path;
    uint64_t       key;    /* of the options, the scene and the device */
    bool           found;  /* there is one, which has not been read */
    bool           failed; /* it cannot be written, which has been said */
    double done, share;    /* of the samples: before those that are added at present, and these */
} Checkpoint;

/* The properties that the samples of a frame depend on. */
typedef struct CheckpointFrame {
    KrsRendering           *rendering;
    KrsState               *state;
    const KrsRenderOptions *how;
    uint32_t                end, number; /* behind its last sample; of the frame */
    SampleSums             *sums;        /* what becomes of them, if they are divided */
} CheckpointFrame;

/* Begins the checkpoint of a command whose first output has this name, or that has none: NULL.
   KRS_OK, or wrong usage, which is said: there is no place for a checkpoint, or what is asked for
   has none. */
KrsStatus checkpoint_begin(Checkpoint *checkpoint, const Options *options, const char *output);
/* Looks for the checkpoint of this command line, scene and device.  Returns the number of the frame
   from which on it goes on; that of the first one where there is none. */
uint32_t checkpoint_find(Checkpoint *checkpoint, const KrsScene *scene,
                         const KrsRenderer *renderer);
/* Does what krs_render does, from where the checkpoint has the frame, and writes new ones with --resume. */
KrsStatus checkpoint_render(Checkpoint *checkpoint, const CheckpointFrame *frame,
                            KrsPicture **picture);
/* The frame of this number has been written: the next one is what remains, or nothing is. */
KrsStatus checkpoint_advance(Checkpoint *checkpoint, uint32_t frame);

#endif
