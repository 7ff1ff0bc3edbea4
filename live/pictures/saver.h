/*
 * saver.h: a thread that renders pictures of any size into files, while the window goes on.
 */
#ifndef KRS_SAVER_H
#define KRS_SAVER_H

#include "live/pictures/canvas.h"

/* The kinds of saves: one picture, an orbit of the target, or a range of time; a row of saves.def
   each. */
typedef enum SaveKind {
#define SAVE(id, name, about) SAVE_##id,
#include "live/pictures/saves.def"
#undef SAVE
    SAVE_COUNT
} SaveKind;
extern const char *const save_names[SAVE_COUNT];

typedef struct SaveOrder {
    View     view; /* with its size and samples */
    SaveKind kind;
    uint32_t frames; /* of a turn, or a range; a picture is one */
    double   fps;    /* of a range, which begins at the view's time */
    /* A camera of the scene, which may move with the time, or -1: that of the view. */
    int  camera;
    bool exr;       /* or PNG */
    char name[200]; /* without number and ending */
} SaveOrder;

typedef struct SaverState {
    bool      busy;
    double    done;         /* of all frames, from 0 to 1 */
    unsigned  orders;       /* that have ended, in whatever way */
    KrsStatus status;       /* of the last one */
    char      message[300]; /* what came of it: "saved view.png", or why not */
} SaverState;

typedef struct Saver Saver;

/* Makes a saver; `told` is called in its thread, when the state has changed.  NULL: without
   memory. */
Saver *saver_new(const KrsRendererOptions *options, void (*told)(void *user), void *user);
/* Frees the saver; what is not saved by then is given up. */
void saver_free(Saver *saver);

/* Saves copies of what the order has: NAME.png, or NAME-0000.png and so on.  False: it is busy, or
   there is no memory. */
bool       saver_start(Saver *saver, const SaveOrder *order);
void       saver_cancel(Saver *saver);
SaverState saver_state(Saver *saver);

#endif
