/*
 * viewing.h: what the parts of the viewer share: the state of a window.
 */
#ifndef KRS_VIEWING_H
#define KRS_VIEWING_H

#include <pthread.h>
#include <stdatomic.h>

#include "live/cut.h"
#include "live/history.h"
#include "live/pictures/painter.h"
#include "live/pictures/profiler.h"
#include "live/pictures/saver.h"
#include "live/text/document.h"
#include "live/text/presets.h"
#include "live/viewer_options.h"
#include "live/window/terminal.h"
#include "live/window/window.h"

typedef struct Viewing {
    const ViewerOptions *options;
    Document            *document;
    Painter             *painter;
    Window              *window; /* or */
    Terminal            *terminal;
    bool                 ended; /* by a key of the terminal */
    pthread_t            reader;
    atomic_bool          closing;
    atomic_bool          prepares; /* the reader is to prepare edits */
    _Atomic double
               reading_since; /* viewing_now, when a saved text began to be compiled; 0: none is */
    atomic_int read_status;   /* of the document, where no edit will mend it */

    KrsState    *state; /* of the view's version: cameras, and whether values fit */
    View         view;
    bool         view_changed;
    size_t       camera;         /* of the scene's */
    bool         moved;          /* the camera is not the scene's any more */
    bool         camera_written; /* but will be in the next version */
    Diagnostics  diagnostics;
    unsigned     readings;
    bool         asked; /* the reader, to prepare edits */
    Shot         shot;  /* the last one; its pixels are in the window */
    PainterState painting;

    bool     playing;
    double   played_at; /* when the time was last moved on */
    double   flown_at;
    bool     grounded; /* a key of flying was pressed for something else, and is not released yet */
    double   budget;   /* milliseconds of a frame while something moves */
    double   loop;     /* seconds after which time begins again; 0: never */
    History *history;
    bool     undoing;     /* the view changes by undo or redo */
    uint8_t *pixels;      /* of the shot */
    char     notice[160]; /* what was done last */
    double   noticed_at;
    bool     reads_slowly; /* a saved text takes long, which `notice` says */
    bool     panels, help, numbers;
    int      scrolled; /* lines of the help, since it was drawn */
    struct {
        float status, controls, found, diagnostics, costs; /* 0: it is not there */
    } heights; /* of panels in the last frame, with a margin */
    Cut      cut;
    Presets  presets;
    char     preset[64]; /* the name of the next one */
    Saver   *saver;
    unsigned saved; /* orders whose end was noticed */
    struct {
        uint32_t width, height, samples; /* 0: as the window */
        uint32_t frames;
        SaveKind kind;
        bool     exr;
    } save; /* what the next order will be */
    Profiler     *profiler;
    ProfilerState costing;
    Costs         costs;         /* of the last order, until it is dropped; without lines: none */
    unsigned      costs_version; /* that was ordered */
    bool          costs_shown;   /* the picture has their colours */
    unsigned views, costs_view;  /* how often the view has changed; then, when they were ordered */
    double   redraw_until;       /* panels need some frames to settle */
} Viewing;

/* Says for a moment what was done. */
void viewing_notice(Viewing *viewing, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
/* Says that there is something new to show; for any thread. */
void viewing_wake(Viewing *viewing);
/* Finds what is under the mouse; in the middle, if there is none over the picture. */
Found viewing_find(Viewing *viewing);
/* Finds where the text has the component of this number, from 1; NULL: nowhere.  "a.krs:3" */
const char *viewing_place(const Viewing *viewing, uint32_t component, char place[300]);
/* Tells what the component of this number is, without what moves or paints it: "torus", "union"; or
   "". */
const char *viewing_shape(const Viewing *viewing, uint32_t component);
/* Opens $KRS_EDITOR at a place. */
void viewing_open_editor(Viewing *viewing, const char *place);
/* Returns the seconds of a clock that only goes forward. */
double viewing_now(void);
/* Says that what is to be seen has changed. */
void viewing_show(Viewing *viewing);
void viewing_set_time(Viewing *viewing, double time);
/* Returns the state, set to the values of the view as far as the scene permits them. */
KrsState *viewing_state(Viewing *viewing);
/* Takes the camera to that of the scene. */
void viewing_take_camera(Viewing *viewing, size_t camera);
/* Takes a new version of the document. */
void viewing_adopt(Viewing *viewing, Version *version);
/* Says that what is cut away has changed. */
void viewing_set_cut(Viewing *viewing);
/* These take the values of a preset, add a preset of the values, or remove one. */
void viewing_take_preset(Viewing *viewing, const Preset *preset);
void viewing_make_preset(Viewing *viewing, const char *name);
void viewing_drop_preset(Viewing *viewing, size_t number);
/* Colours the picture by what parts cost, until the view changes; the other no longer tells what
   they cost. */
void viewing_show_costs(Viewing *viewing);
void viewing_drop_costs(Viewing *viewing);
/* Sets all parameters to the scene's defaults. */
void viewing_reset_values(Viewing *viewing);

#endif
