/*
 * viewer.c: `krs view`: a window on a scene that is being written.
 *
 * Three threads: this one has the window and never waits for the others; one reads and compiles the
 * scene when it is saved (document.h); one makes pictures (painter.h).
 */
#include "live/viewer.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "live/actions.h"
#include "live/panels.h"

/* Milliseconds of a frame while something moves. */
#define BUDGET_MS 40
/* The window is not drawn more often. */
#define FRAME_SECONDS (1.0 / 60)
/* After an event, panels are drawn for so long: some answer in the next frame only. */
#define SETTLE_SECONDS 0.1
/* A text that takes longer to compile is said to be slow. */
#define SLOW_SECONDS 3.0
/* The time that a signal may go unnoticed. */
#define LONGEST_WAIT 1.0

static void tell_reading(const Viewing *viewing, bool begins)
{
    if (viewing->options->reads)
        viewing->options->reads(viewing->options->user, begins);
}

/* ---- the thread that reads the scene ---- */

static void *read_scene(void *user)
{
    Viewing *viewing = user;
    while (!atomic_load(&viewing->closing)) {
        if (!document_wait(viewing->document, INFINITY)) {
            if (!atomic_exchange(&viewing->prepares, false))
                continue;
            document_prepare(viewing->document);
            viewing_wake(viewing);
            continue;
        }
        atomic_store(&viewing->reading_since, viewing_now());
        const KrsStatus status = document_read(viewing->document);
        atomic_store(&viewing->reading_since, 0);
        if (status == KRS_CANNOT_CREATE)
            atomic_store(&viewing->read_status, status);
        viewing_wake(viewing);
    }
    return NULL;
}

/* ---- the loop ---- */

static void take_document(Viewing *viewing)
{
    const unsigned readings = document_readings(viewing->document);
    if (readings == viewing->readings)
        return;
    viewing->readings = readings;
    diagnostics_free(&viewing->diagnostics);
    viewing->diagnostics = document_diagnostics(viewing->document);
    Version *version     = document_version(viewing->document);
    if (version && version != viewing->view.version)
        viewing_adopt(viewing, version);
    version_release(version);
}

/* Takes the costs, unless they are of a text that has changed since. */
static void take_costs(Viewing *viewing)
{
    const ProfilerState state = profiler_state(viewing->profiler);
    const bool          ended = state.orders != viewing->costing.orders;
    const bool          same  = viewing->costs_version == version_number(viewing->view.version);
    viewing->costing          = state;
    if (!same)
        costs_free(&viewing->costs);
    if (!ended)
        return;
    costs_free(&viewing->costs);
    if (!profiler_take(viewing->profiler, &viewing->costs))
        viewing_notice(viewing, "what parts cost: %s", state.message);
    else if (!same) {
        viewing_notice(viewing, "what parts cost: the text has changed");
        costs_free(&viewing->costs);
    } else
        viewing_show_costs(viewing);
}

static void take_shot(Viewing *viewing)
{
    Shot shot;
    take_costs(viewing);
    if (painter_take(viewing->painter, &shot) && viewing->costs_shown)
        free(shot.pixels); /* of the same view */
    else if (shot.pixels) {
        if (viewing->window)
            window_set_picture(viewing->window, shot.pixels, shot.width, shot.height);
        free(viewing->pixels);
        viewing->pixels = shot.pixels;
        shot.pixels     = NULL;
        viewing->shot   = shot;
    }
    viewing->painting       = painter_state(viewing->painter);
    const SaverState saving = saver_state(viewing->saver);
    if (saving.orders != viewing->saved)
        viewing_notice(viewing, "%s", saving.message);
    viewing->saved = saving.orders;
}

/* Hands the view to the painter, if it is another one. */
static void send_view(Viewing *viewing)
{
    uint32_t width, height;
    if (viewing->terminal)
        terminal_size(viewing->terminal, &width, &height);
    else {
        window_reserve(viewing->window, panels_width(viewing));
        window_size(viewing->window, &width, &height);
    }
    if (width == 0 || height == 0)
        return; /* minimised */
    if (width != viewing->view.width || height != viewing->view.height)
        viewing->view_changed = true;
    viewing->view.width  = width < KRS_MAX_SIDE ? width : KRS_MAX_SIDE;
    viewing->view.height = height < KRS_MAX_SIDE ? height : KRS_MAX_SIDE;
    if (viewing->view_changed) {
        viewing->costs_shown = false;
        viewing->views++;
        painter_show(viewing->painter, &viewing->view);
        if (!viewing->playing && !viewing->undoing)
            history_note(viewing->history, &viewing->view, viewing_now());
    }
    viewing->undoing      = false;
    viewing->view_changed = false;
}

static void wake_viewer(void *user) { viewing_wake(user); }

static void draw(Viewing *viewing)
{
    window_begin(viewing->window);
    panels_draw(viewing);
    window_end(viewing->window);
}

/* Makes ready, while nothing happens, what the first edit of a number will need. */
static void prepare_edits(Viewing *viewing)
{
    if (viewing->painting.busy || viewing->painting.compiling ||
        version_number(viewing->view.version) > 1)
        return;
    Version *spare = document_spare(viewing->document);
    View     later = viewing->view;
    if (spare) {
        later.version = spare;
        painter_prepare(viewing->painter, &later);
    } else if (!viewing->asked) {
        viewing->asked = true;
        atomic_store(&viewing->prepares, true);
        document_wake(viewing->document);
    }
    version_release(spare);
}

/* Says that a saved text takes long, so that nobody waits for it in vain. */
static bool notice_slow_reading(Viewing *viewing)
{
    const double since    = atomic_load(&viewing->reading_since);
    viewing->reads_slowly = since != 0 && viewing_now() - since >= SLOW_SECONDS;
    if (viewing->reads_slowly)
        viewing_notice(viewing, "the saved text has been compiling for %.0f s",
                       viewing_now() - since);
    return viewing->reads_slowly;
}

/* Tells how long the window may wait for the next event. */
static double choose_wait(const Viewing *viewing, bool running)
{
    if (running)
        return 0;
    return viewing_now() < viewing->redraw_until ? FRAME_SECONDS : LONGEST_WAIT;
}

static void limit_rate(double begun)
{
    const double left = begun + FRAME_SECONDS - viewing_now();
    if (left > 0)
        nanosleep(&(struct timespec){0, (long)(left * 1e9)}, NULL);
}

/* Waits for events.  False: the window is to be closed.  *quiet: nothing has happened. */
static bool wait_for_events(Viewing *viewing, bool running, bool *quiet)
{
    const double limit = choose_wait(viewing, running), begun = viewing_now();
    const bool   open = window_wait(viewing->window, limit);
    const double now  = viewing_now();
    *quiet            = limit >= LONGEST_WAIT && now - begun >= limit;
    if (now - begun < limit)
        viewing->redraw_until = now + SETTLE_SECONDS;
    return open;
}

static KrsStatus loop(Viewing *viewing)
{
    bool running = false, quiet = false;
    while (wait_for_events(viewing, running, &quiet)) {
        const double begun = viewing_now();
        if (viewing->options->stopped && viewing->options->stopped(viewing->options->user))
            return KRS_OK;
        if (!notice_slow_reading(viewing) && quiet) {
            prepare_edits(viewing);
            continue;
        }
        take_document(viewing);
        running = act_run(viewing);
        take_shot(viewing);
        if (viewing->painting.status != KRS_OK)
            return viewing->painting.status;
        draw(viewing);
        send_view(viewing); /* panels may have changed it */
        limit_rate(begun);
    }
    return KRS_OK;
}

/* ---- the same in a terminal ---- */

static void draw_help_lines(Viewing *viewing)
{
    const char *lines[64];
    char        texts[64][120];
    size_t      count = 0;
    for (size_t i = 0; i < action_count && count < 63; i++)
        if (actions[i].keys) {
            snprintf(texts[count], sizeof texts[count], "%-10s %s", actions[i].keys,
                     actions[i].does);
            lines[count] = texts[count];
            count++;
        }
    lines[count++] = "W A S D E Q fly";
    terminal_show(viewing->terminal, NULL, 0, 0, lines, count);
}

/* Draws the line below the picture: what it is, and what goes on; the first mistake of the text
   comes first. */
static void draw_terminal(Viewing *viewing)
{
    const Shot          *shot     = &viewing->shot;
    const PainterState  *painting = &viewing->painting;
    const KrsDiagnostic *error    = diagnostics_first_error(&viewing->diagnostics);
    char                 first[400], second[600] = "";
    const char          *lines[] = {first, second};
    if (viewing->help) {
        draw_help_lines(viewing);
        return;
    }
    snprintf(first, sizeof first, "%s   %ux%u   %u/%u   %s   ? help", viewing->options->path,
             shot->width, shot->height, shot->samples, viewing->view.samples,
             shading_mode_names[viewing->view.shading]);
    if (viewing->reads_slowly)
        snprintf(second, sizeof second, "%s", viewing->notice);
    else if (error)
        snprintf(second, sizeof second, "%s:%u: %s", error->source, error->line, error->text);
    else if (painting->compiling)
        snprintf(second, sizeof second, "compiling the shaders: %.0f %%", 100 * painting->compiled);
    else if (viewing->costing.busy)
        snprintf(second, sizeof second, "timing frames without each part: %.0f %%",
                 100 * viewing->costing.done);
    else if (viewing->costs.count > 0)
        snprintf(second, sizeof second, "%s  %s   %s", viewing->costs.lines[0].words,
                 viewing->costs.lines[0].place, viewing->costs.lines[1].words);
    else if (viewing_now() - viewing->noticed_at < 4)
        snprintf(second, sizeof second, "%s", viewing->notice);
    terminal_show(viewing->terminal, viewing->pixels, shot->width, shot->height, lines, 2);
}

static KrsStatus terminal_loop(Viewing *viewing)
{
    bool running = false, closed = false;
    while (!viewing->ended && !closed) {
        int          key, modifiers;
        const double begun = viewing_now();
        terminal_wait(viewing->terminal, running ? FRAME_SECONDS : LONGEST_WAIT);
        if (!running && viewing_now() - begun >= LONGEST_WAIT)
            prepare_edits(viewing);
        if (viewing->options->stopped && viewing->options->stopped(viewing->options->user))
            return KRS_OK;
        notice_slow_reading(viewing);
        take_document(viewing);
        while (terminal_key(viewing->terminal, &key, &modifiers, &closed))
            if (modifiers != 0 || !act_fly_step(viewing, key))
                act_key(viewing, key, modifiers);
        running = act_run(viewing);
        take_shot(viewing);
        if (viewing->painting.status != KRS_OK)
            return viewing->painting.status;
        draw_terminal(viewing);
        send_view(viewing);
    }
    return KRS_OK;
}

/* ---- begin and end ---- */

static KrsStatus fail(char message[256], KrsStatus status, const char *what, const char *why)
{
    snprintf(message, 256, "%s%s", what, why);
    return status;
}

static KrsStatus open_window(Viewing *viewing, char message[256])
{
    const ViewerOptions *options = viewing->options;
    const KrsImage       image   = krs_scene_image(version_scene(viewing->view.version));
    const char          *why;
    char                 title[280];
    const WindowEvents   events = {act_key, act_scroll, act_drag, act_click, viewing};
    const uint32_t       width  = options->width ? options->width
                                  : image.width  ? image.width
                                                 : KRS_DEFAULT_WIDTH;
    const uint32_t       height = options->height ? options->height
                                  : image.height  ? image.height
                                                  : KRS_DEFAULT_HEIGHT;
    const char          *slash  = strrchr(options->path, '/');
    snprintf(title, sizeof title, "%.255s \u2014 krs", slash ? slash + 1 : options->path);
    viewing->window = window_open(title, width, height, &events, options->lost, &why);
    if (!viewing->window)
        return fail(message, KRS_NO_DEVICE, "no window can be opened: ", why);
    return KRS_OK;
}

static KrsStatus open_terminal(Viewing *viewing, char message[256])
{
    const char *why;
    viewing->terminal = terminal_open(&why);
    return viewing->terminal ? KRS_OK : fail(message, KRS_NO_DEVICE, "no terminal: ", why);
}

/* The painter opens its device while the scene is read. */
static KrsStatus begin(Viewing *viewing, char message[256])
{
    const ViewerOptions *options  = viewing->options;
    const PainterOptions painting = {.renderer = options->renderer,
                                     .wake     = wake_viewer,
                                     .user     = viewing,
                                     .budget   = viewing->budget,
                                     .executor = options->executor};
    viewing->painter              = painter_new(&painting);
    viewing->history              = history_new();
    if (!viewing->history)
        return fail(message, KRS_OUT_OF_MEMORY, "out of memory", "");
    viewing->document = document_new(options->path, &options->scene);
    if (!viewing->document)
        return fail(message, KRS_IO_ERROR, "the system does not let files be watched", "");
    document_supply(viewing->document, options->supplied);
    tell_reading(viewing, true);
    KrsStatus status = document_read(viewing->document);
    tell_reading(viewing, false);
    if (status != KRS_OK && status != KRS_BAD_SCENE)
        return fail(message, status, "", "");
    take_document(viewing);
    return status;
}

static KrsStatus run(Viewing *viewing, char message[256])
{
    const ViewerOptions *options = viewing->options;
    KrsStatus            status  = options->terminal ? open_terminal(viewing, message)
                                                     : open_window(viewing, message);
    if (status != KRS_OK)
        return status;
    viewing->saver    = saver_new(&options->renderer, wake_viewer, viewing);
    viewing->profiler = profiler_new(&options->renderer, &options->scene, options->path,
                                     options->supplied, wake_viewer, viewing);
    if (!viewing->painter || !viewing->saver || !viewing->profiler ||
        pthread_create(&viewing->reader, NULL, read_scene, viewing) != 0)
        return fail(message, KRS_OUT_OF_MEMORY, "out of memory", "");
    status = viewing->terminal ? terminal_loop(viewing) : loop(viewing);
    if (status != KRS_OK)
        fail(message, status, viewing->painting.message, "");
    atomic_store(&viewing->closing, true);
    document_wake(viewing->document);
    if (atomic_load(&viewing->reading_since) != 0)
        tell_reading(viewing, true);
    pthread_join(viewing->reader, NULL);
    return status;
}

KrsStatus viewer_run(const ViewerOptions *options, char message[256])
{
    Viewing viewing = {.options = options,
                       .panels  = true,
                       .budget  = options->budget > 0 ? options->budget : BUDGET_MS,
                       .loop    = 10,
                       .save    = {.frames = 36}};
    message[0]      = '\0';
    atomic_init(&viewing.closing, false);
    atomic_init(&viewing.prepares, false);
    atomic_init(&viewing.reading_since, 0);
    KrsStatus status = begin(&viewing, message);
    if (status == KRS_OK)
        status = run(&viewing, message);
    profiler_free(viewing.profiler);
    saver_free(viewing.saver);
    painter_free(viewing.painter);
    window_close(viewing.window);
    terminal_close(viewing.terminal);
    krs_state_free(viewing.state);
    view_free(&viewing.view);
    history_free(viewing.history);
    free(viewing.pixels);
    diagnostics_free(&viewing.diagnostics);
    presets_free(&viewing.presets);
    costs_free(&viewing.costs);
    document_free(viewing.document);
    return status;
}
