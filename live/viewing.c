/*
 * viewing.c: what a window shows of a scene, and how that follows the scene's text.
 */
#include "live/viewing.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

double viewing_now(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

void viewing_show(Viewing *viewing) { viewing->view_changed = true; }

void viewing_set_time(Viewing *viewing, double time)
{
    viewing->view.time = fmax(time, 0);
    krs_frame_set_time(viewing->frame, viewing->view.time);
    if (!viewing->moved)
        viewing_take_camera(viewing, viewing->camera); /* it may move with the time */
    viewing_show(viewing);
}

/* Sets the frame to the values, as far as the scene permits them. */
static void set_frame(Viewing *viewing)
{
    const KrsScene *scene = version_scene(viewing->view.version);
    for (size_t i = 0; i < krs_parameter_count(scene); i++) {
        KrsParameter parameter;
        krs_parameter(scene, i, &parameter);
        krs_frame_set(viewing->frame, parameter.name, viewing->view.values[i],
                      parameter.components);
    }
    krs_frame_set_time(viewing->frame, viewing->view.time);
}

void viewing_take_camera(Viewing *viewing, size_t camera)
{
    KrsCamera found;
    set_frame(viewing);
    if (krs_frame_camera(viewing->frame, camera, &found) != KRS_OK)
        return;
    viewing->camera      = camera;
    viewing->view.camera = found;
    viewing->moved       = false;
    viewing_show(viewing);
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

/* Values that were set stay; others become the new defaults. */
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
    for (size_t i = 0; i < options->zone_count; i++)
        memcpy(viewing->view.zones[i], options->zones[i], sizeof options->zones[i]);
    viewing->view.zone_count = options->zone_count;
}

/* What the first version decides about. */
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
    KrsFrame       *frame  = NULL;
    double(*values)[4]     = calloc(krs_parameter_count(scene) + 1, sizeof *values);
    if (!values || krs_frame_new(scene, &frame) != KRS_OK) {
        free(values);
        return;
    }
    krs_frame_free(viewing->frame);
    viewing->frame        = frame;
    viewing->view.version = version_hold(version);
    viewing->view.values  = values;
    set_defaults(viewing);
    if (before.version)
        keep_values(viewing, &before);
    else
        begin_view(viewing);
    version_release(before.version);
    free(before.values);
    if (viewing->camera >= krs_camera_count(scene))
        viewing->camera = 0;
    if (!viewing->moved)
        viewing_take_camera(viewing, viewing->camera);
    set_frame(viewing);
    viewing_show(viewing);
}
