/*
 * viewing.c: what a window shows of a scene, and how that follows the scene's text.
 */
#include "live/viewing.h"

#include <math.h>
#include <spawn.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "compiler/base/clock.h"

double viewing_now(void) { return clock_seconds(CLOCK_MONOTONIC); }

void viewing_show(Viewing *viewing) { viewing->view_changed = true; }

void viewing_set_time(Viewing *viewing, double time)
{
    viewing->view.time = fmax(time, 0);
    krs_state_set_time(viewing->state, viewing->view.time);
    if (!viewing->moved)
        viewing_take_camera(viewing, viewing->camera); /* it may move with the time */
    viewing_show(viewing);
}

void viewing_notice(Viewing *viewing, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(viewing->notice, sizeof viewing->notice, format, arguments);
    va_end(arguments);
    viewing->noticed_at = viewing_now();
}

void viewing_wake(Viewing *viewing)
{
    if (viewing->terminal)
        terminal_wake(viewing->terminal);
    else
        window_wake();
}

Found viewing_find(Viewing *viewing)
{
    double x = 0.5, y = 0.5;
    if (viewing->window)
        window_mouse(viewing->window, &x, &y);
    if (x < 0 || x >= 1 || y < 0 || y >= 1) /* who has keys alone means the middle */
        x = y = 0.5;
    return painter_find(viewing->painter, x, y);
}

const char *viewing_place(const Viewing *viewing, uint32_t component, char place[300])
{
    KrsBound bound;
    if (component == 0 ||
        krs_bound(version_scene(viewing->view.version), component - 1, 0, &bound) != KRS_OK ||
        bound.line == 0)
        return NULL;
    snprintf(place, 300, "%s:%u", bound.source, bound.line);
    return place;
}

/* Returns the shape of a component, from entries that come before their parts. */
const char *viewing_shape(const Viewing *viewing, uint32_t component)
{
    const KrsScene *scene = version_scene(viewing->view.version);
    const char     *name  = "";
    KrsBound        bound, part, other;
    for (size_t i = 0; krs_bound(scene, component - 1, i, &bound) == KRS_OK; i++) {
        name = bound.name;
        if (krs_bound(scene, component - 1, i + 1, &part) != KRS_OK || part.depth <= bound.depth)
            break;
        size_t next = i + 2; /* after the first part */
        while (krs_bound(scene, component - 1, next, &other) == KRS_OK && other.depth > part.depth)
            next++;
        if (part.similar > 0 ||
            (krs_bound(scene, component - 1, next, &other) == KRS_OK && other.depth == part.depth))
            break; /* several parts */
    }
    return name;
}

/* The place is an argument of its own, so that no name of a file is taken for a command. */
void viewing_open_editor(Viewing *viewing, const char *place)
{
    static char shell[] = "sh", option[] = "-c", command[] = "$KRS_EDITOR \"$0\" &";
    char       *argument = strdup(place);
    char       *words[]  = {shell, option, command, argument, NULL};
    pid_t       child;
    const char *editor = getenv("KRS_EDITOR");
    if (!editor || !*editor)
        viewing_notice(viewing, "%s   (KRS_EDITOR names no editor)", place);
    else if (argument && posix_spawnp(&child, shell, NULL, NULL, words, environ) == 0) {
        waitpid(child, NULL, 0); /* the shell does not wait for the editor */
        viewing_notice(viewing, "opened %s", place);
    }
    free(argument);
}

/* Sets the state to the values, as far as the scene permits them. */
static void set_state(Viewing *viewing)
{
    const KrsScene *scene = version_scene(viewing->view.version);
    for (size_t i = 0; i < krs_parameter_count(scene); i++) {
        KrsParameter parameter;
        krs_parameter(scene, i, &parameter);
        krs_state_set(viewing->state, parameter.name, viewing->view.values[i],
                      parameter.components);
    }
    krs_state_set_time(viewing->state, viewing->view.time);
}

void viewing_take_camera(Viewing *viewing, size_t camera)
{
    KrsCamera found;
    set_state(viewing);
    if (krs_state_camera(viewing->state, camera, &found) != KRS_OK)
        return;
    viewing->camera      = camera;
    viewing->view.camera = found;
    viewing->moved       = false;
    viewing_show(viewing);
}

KrsState *viewing_state(Viewing *viewing)
{
    set_state(viewing);
    return viewing->state;
}

static void set_defaults(Viewing *viewing)
{
    const KrsScene *scene = version_scene(viewing->view.version);
    for (size_t i = 0; i < krs_parameter_count(scene); i++) {
        KrsParameter parameter;
        krs_parameter(scene, i, &parameter);
        memcpy(viewing->view.values[i], parameter.value, sizeof parameter.value);
    }
}

void viewing_reset_values(Viewing *viewing)
{
    set_defaults(viewing);
    viewing_show(viewing);
}

static bool is_permitted(const KrsParameter *parameter, const double *value)
{
    bool permitted = true;
    for (uint32_t i = 0; i < parameter->components; i++)
        permitted = permitted && value[i] >= parameter->low[i] && value[i] <= parameter->high[i];
    return permitted;
}

/* Gives a parameter of this name a value, if there is one that permits it. */
static bool set_value(Viewing *viewing, const char *name, const double *value, size_t count)
{
    const KrsScene *scene = version_scene(viewing->view.version);
    for (size_t i = 0; i < krs_parameter_count(scene); i++) {
        KrsParameter parameter;
        krs_parameter(scene, i, &parameter);
        if (strcmp(parameter.name, name) != 0 || parameter.components != count ||
            !is_permitted(&parameter, value))
            continue;
        memcpy(viewing->view.values[i], value, count * sizeof *value);
        return true;
    }
    return false;
}

void viewing_take_preset(Viewing *viewing, const Preset *preset)
{
    for (size_t i = 0; i < preset->count; i++)
        set_value(viewing, preset->values[i].name, preset->values[i].value,
                  preset->values[i].count);
    viewing_notice(viewing, "%s", preset->name);
    viewing_show(viewing);
}

void viewing_make_preset(Viewing *viewing, const char *name)
{
    if (!presets_set(&viewing->presets, name, version_scene(viewing->view.version),
                     (const double(*)[4])viewing->view.values) ||
        !presets_write(&viewing->presets, viewing->options->path))
        viewing_notice(viewing, "%s.presets cannot be written", viewing->options->path);
    else
        viewing_notice(viewing, "kept as %s", name);
}

void viewing_drop_preset(Viewing *viewing, size_t number)
{
    presets_remove(&viewing->presets, number);
    if (!presets_write(&viewing->presets, viewing->options->path))
        viewing_notice(viewing, "%s.presets cannot be written", viewing->options->path);
}

void viewing_set_cut(Viewing *viewing)
{
    const ViewerOptions *options = viewing->options;
    for (size_t i = 0; i < options->zone_count; i++)
        memcpy(viewing->view.zones[i], options->zones[i], sizeof options->zones[i]);
    viewing->view.zone_count = cut_zones(&viewing->cut, viewing->view.zones, options->zone_count);
    viewing_show(viewing);
}

void viewing_show_costs(Viewing *viewing)
{
    const Shot *shot = &viewing->shot;
    if (!viewing->pixels || viewing->costs_view != viewing->views)
        return; /* they are of what was seen before */
    costs_tint(&viewing->costs, viewing->pixels, shot->width, shot->height);
    if (viewing->window)
        window_set_picture(viewing->window, viewing->pixels, shot->width, shot->height);
    viewing->costs_shown = true;
}

void viewing_drop_costs(Viewing *viewing)
{
    costs_free(&viewing->costs);
    viewing_show(viewing);
}

/* Keeps values that were set; others become the new defaults. */
static void keep_values(Viewing *viewing, const View *before)
{
    const KrsScene *scene = version_scene(before->version);
    for (size_t i = 0; i < krs_parameter_count(scene); i++) {
        KrsParameter parameter;
        krs_parameter(scene, i, &parameter);
        if (memcmp(before->values[i], parameter.value,
                   parameter.components * sizeof *parameter.value) != 0)
            set_value(viewing, parameter.name, before->values[i], parameter.components);
    }
}

static void take_settings(Viewing *viewing)
{
    const ViewerOptions *options = viewing->options;
    for (size_t i = 0; i < options->setting_count; i++)
        set_value(viewing, options->settings[i].name, options->settings[i].values,
                  options->settings[i].count);
    viewing_set_cut(viewing);
    viewing->presets = presets_read(options->path, options->scene.root);
}

/* Sets what the first version decides about. */
static void begin_view(Viewing *viewing)
{
    const ViewerOptions *options = viewing->options;
    const KrsScene      *scene   = version_scene(viewing->view.version);
    const KrsImage       image   = krs_scene_image(scene);
    View                *view    = &viewing->view;
    view->time                   = options->time;
    view->samples                = options->samples ? options->samples
                                   : image.samples  ? image.samples
                                                    : VIEWER_SAMPLES;
    view->integrator             = options->integrator;
    for (int i = 0; image.integrator && i < KRS_INTEGRATOR_COUNT; i++)
        if (view->integrator == KRS_INTEGRATOR_DEFAULT &&
            strcmp(krs_integrator_names[i], image.integrator) == 0)
            view->integrator = (KrsIntegrator)i;
    if (view->integrator == KRS_INTEGRATOR_DEFAULT)
        view->integrator = KRS_INTEGRATOR_PREVIEW;
    for (size_t i = 0; options->camera && i < krs_camera_count(scene); i++) {
        const char *name = krs_camera_name(scene, i);
        if (name && strcmp(name, options->camera) == 0)
            viewing->camera = i;
    }
    take_settings(viewing);
}

void viewing_adopt(Viewing *viewing, Version *version)
{
    const KrsScene *scene  = version_scene(version);
    View            before = viewing->view;
    KrsState       *state  = NULL;
    double(*values)[4]     = calloc(krs_parameter_count(scene) + 1, sizeof *values);
    if (!values || krs_state_new(scene, &state) != KRS_OK) {
        free(values);
        return;
    }
    krs_state_free(viewing->state);
    viewing->state        = state;
    viewing->view.version = version_hold(version);
    viewing->view.values  = values;
    set_defaults(viewing);
    if (before.version)
        keep_values(viewing, &before);
    else {
        begin_view(viewing);
        krs_state_fit_camera(viewing_state(viewing));
    }
    version_release(before.version);
    free(before.values);
    if (viewing->camera >= krs_camera_count(scene))
        viewing->camera = 0;
    if (viewing->camera_written)
        viewing->moved = viewing->camera_written = false;
    if (!viewing->moved)
        viewing_take_camera(viewing, viewing->camera);
    set_state(viewing);
    viewing_show(viewing);
}
