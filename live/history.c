/*
 * history.c: what was seen before, for undo and redo.
 */
#include "live/history.h"

#include <stdlib.h>
#include <string.h>

#define MAX_STEPS 200
/* Seconds without a change that end a step. */
#define PAUSE 0.6

struct History {
    View   steps[MAX_STEPS];
    size_t count, at; /* number of steps; of the one that is seen */
    double noted;     /* when the last change came */
};

History *history_new(void) { return calloc(1, sizeof(History)); }

void history_free(History *history)
{
    for (size_t i = 0; history && i < history->count; i++)
        view_free(&history->steps[i]);
    free(history);
}

/* Forgets what was undone, and the oldest step where there is no room. */
static void make_room(History *history)
{
    while (history->count > history->at + 1)
        view_free(&history->steps[--history->count]);
    if (history->count < MAX_STEPS)
        return;
    view_free(&history->steps[0]);
    memmove(history->steps, history->steps + 1, (MAX_STEPS - 1) * sizeof *history->steps);
    history->count--;
    history->at--;
}

void history_note(History *history, const View *view, double now)
{
    const bool joins = history->count > 1 && history->at + 1 == history->count &&
                       now - history->noted < PAUSE;
    View step;
    history->noted = now;
    if (!view_copy(view, &step))
        return;
    if (joins) {
        view_free(&history->steps[history->at]);
        history->steps[history->at] = step;
        return;
    }
    if (history->count > 0)
        make_room(history);
    history->at                      = history->count;
    history->steps[history->count++] = step;
}

static void restore(History *history, View *view)
{
    const View *step = &history->steps[history->at];
    view->camera     = step->camera;
    view->time       = step->time;
    if (view->version && step->version == view->version)
        memcpy(view->values, step->values,
               krs_parameter_count(version_scene(view->version)) * sizeof *view->values);
    history->noted = 0; /* the next change is a step of its own */
}

bool history_undo(History *history, View *view)
{
    if (history->count == 0 || history->at == 0)
        return false;
    history->at--;
    restore(history, view);
    return true;
}

bool history_redo(History *history, View *view)
{
    if (history->at + 1 >= history->count)
        return false;
    history->at++;
    restore(history, view);
    return true;
}
