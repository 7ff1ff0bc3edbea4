/*
 * trial.c: what a window of `krs view` shows pictures of.
 */
#include "bench/view/trial.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "bench/fixture.h"

static const double TIMEOUT = 300;

double trial_now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

Trial trial_open(const char *path, KrsExecutor executor, KrsSpecialize specialize)
{
    const KrsOptions     with    = {.specialize = specialize, .studio = true};
    const PainterOptions options = {
        .renderer = {.device = getenv("KRS_DEVICE"), .cache = getenv("KRS_VIEW_CACHE")},
        .budget   = TRIAL_BUDGET,
        .executor = executor};
    Trial trial = {
        .path = path, .painter = painter_new(&options), .document = document_new(path, &with)};
    if (!trial.document || !trial.painter || document_read(trial.document) != KRS_OK)
        give_up(path, "it does not compile");
    trial.view = (View){.width      = TRIAL_WIDTH,
                        .height     = TRIAL_HEIGHT,
                        .samples    = 1,
                        .integrator = KRS_INTEGRATOR_PREVIEW};
    return trial;
}

void trial_close(Trial *trial)
{
    painter_free(trial->painter);
    view_free(&trial->view);
    document_free(trial->document);
}

void trial_take_version(Trial *trial)
{
    Version        *version = document_version(trial->document);
    const KrsScene *scene   = version_scene(version);
    const size_t    count   = krs_parameter_count(scene);
    view_free(&(View){.version = trial->view.version, .values = trial->view.values});
    trial->view.version = version;
    trial->view.values  = calloc(count + 1, sizeof *trial->view.values);
    for (size_t i = 0; i < count; i++) {
        KrsParameter parameter;
        krs_parameter(scene, i, &parameter);
        memcpy(trial->view.values[i], parameter.value, sizeof parameter.value);
    }
}

void trial_take_camera(Trial *trial)
{
    KrsState *state;
    if (krs_state_new(version_scene(trial->view.version), &state) != KRS_OK)
        give_up(trial->path, "it has no camera");
    krs_state_fit_camera(state);
    if (krs_state_camera(state, 0, &trial->view.camera) != KRS_OK)
        give_up(trial->path, "it has no camera");
    krs_state_free(state);
}

void trial_show(Trial *trial) { trial->number = painter_show(trial->painter, &trial->view); }

uint32_t trial_await(Trial *trial, bool whole)
{
    for (const double begun = trial_now(); trial_now() - begun < TIMEOUT; usleep(200)) {
        Shot               shot;
        const PainterState state = painter_state(trial->painter);
        if (state.status != KRS_OK)
            give_up(trial->path, state.message);
        if (!painter_take(trial->painter, &shot))
            continue;
        free(shot.pixels);
        trial->whole = shot.whole;
        if (shot.view == trial->number && (shot.whole || !whole) &&
            shot.version == version_number(trial->view.version))
            return shot.width;
    }
    give_up(trial->path, "there is no picture");
}

void trial_await_rest(Trial *trial)
{
    while (painter_state(trial->painter).busy)
        usleep(1000);
}

void trial_await_shaders(Trial *trial)
{
    while (painter_state(trial->painter).compiling)
        usleep(1000);
    trial_await_rest(trial);
}
