/*
 * profiler.c: a thread that finds what the parts of a scene cost.
 *
 * The file is compiled anew, without each part: nobody has the text of a version.  So what is found holds for the file
 * as it is by then.
 */
#include "live/pictures/profiler.h"

#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "profile/profile.h"

/* Seconds of an order: the picture is made as well meanwhile. */
static const double SECONDS = 20;

struct Profiler {
    KrsRendererOptions renderer;
    KrsOptions         scene;
    const char        *path;
    SuppliedText       supplied; /* in its place */
    void (*told)(void *user);
    void           *user;
    pthread_t       thread;
    atomic_bool     given_up;
    atomic_uint     permille;
    pthread_mutex_t lock; /* of what follows */
    pthread_cond_t  changed;
    bool            quit, ordered;
    View            next;
    ProfilerState   state;
    Costs           costs; /* not taken yet; without lines: none */
    /* of the thread alone */
    View      view;
    Memory    memory;
    Arena     arena; /* of an order */
    KrsScene *whole;
};

void costs_free(Costs *costs)
{
    free(costs->line_of);
    *costs = (Costs){0};
}

static bool report_progress(void *user, double done)
{
    Profiler      *profiler = user;
    const unsigned permille = (unsigned)(1000 * done);
    if (atomic_exchange(&profiler->permille, permille) != permille)
        profiler->told(profiler->user);
    return !atomic_load(&profiler->given_up);
}

/* Tells whether the profile is wanted still. */
static bool is_wanted(void *user, double done)
{
    Profiler *profiler = user;
    (void)done;
    return !atomic_load(&profiler->given_up);
}

static KrsStatus compile(void *user, const KrsLocation *without, KrsScene **scene)
{
    const Profiler     *profiler = user;
    const SuppliedText *text     = &profiler->supplied;
    KrsOptions          options  = profiler->scene;
    options.diagnostic           = NULL;
    options.opened               = NULL;
    options.specialize           = KRS_SPECIALIZE_NUMBERS;
    options.without              = without;
    return text->text ? krs_compile_text(text->text, text->length, text->name, &options, scene)
                      : krs_compile_file(profiler->path, &options, scene);
}

/* Makes a state.  Parameters that the file no longer has, or no longer so, have its defaults. */
static KrsStatus make_state(void *user, const KrsScene *scene, KrsState **state)
{
    const Profiler *profiler = user;
    const View     *view     = &profiler->view;
    const KrsScene *seen     = version_scene(view->version);
    KrsStatus       status   = krs_state_new(scene, state);
    for (size_t i = 0; status == KRS_OK && i < krs_parameter_count(seen); i++) {
        KrsParameter parameter;
        krs_parameter(seen, i, &parameter);
        krs_state_set(*state, parameter.name, view->values[i], parameter.components);
    }
    if (status == KRS_OK) {
        krs_state_set_time(*state, view->time);
        krs_state_set_zones(*state, (const double(*)[4])view->zones, view->zone_count);
    }
    return status;
}

/* ---- what is shown ---- */

static void find_color(const Profile *profile, size_t row, uint8_t color[3])
{
    uint8_t pixel[4];
    double  most = 1e-9;
    for (size_t i = 0; i < profile->row_count; i++)
        most = i == profile->others ? most : fmax(most, profile->rows[i].share);
    heat_color(row == profile->others ? 0 : profile->rows[row].share / most, pixel);
    memcpy(color, pixel, 3);
}

static void write_line(const Profile *profile, size_t row, Arena *arena, CostLine *line)
{
    enum { WORDS = 40 };
    const ProfileRow *from  = &profile->rows[row];
    const char       *words = from->part ? part_words(from->part, WORDS, arena) : "others";
    snprintf(line->words, sizeof line->words, "%5.1f %%  %s%.60s", 100 * from->share,
             from->rest ? "rest of " : "", words);
    if (from->part)
        snprintf(line->place, sizeof line->place, "%s:%u", from->part->location.source,
                 from->part->location.line);
    find_color(profile, row, line->color);
}

static KrsStatus describe(const Profile *profile, Arena *arena, Costs *costs)
{
    const size_t count = (size_t)profile->width * profile->height;
    costs->untimed     = profile->untimed;
    costs->width       = profile->width;
    costs->height      = profile->height;
    for (size_t i = 0; i < profile->row_count && costs->count < MAX_COST_LINES; i++)
        write_line(profile, i, arena, &costs->lines[costs->count++]);
    costs->line_of = malloc(count);
    for (size_t i = 0; costs->line_of && i < count; i++)
        costs->line_of[i] = (uint8_t)(profile->row_of[i] <= costs->count ? profile->row_of[i] : 0);
    return costs->line_of ? KRS_OK : KRS_OUT_OF_MEMORY;
}

void costs_tint(const Costs *costs, uint8_t *pixels, uint32_t width, uint32_t height)
{
    static const uint8_t gray[3] = {60, 60, 60};
    for (size_t y = 0; y < height; y++)
        for (size_t x = 0; x < width; x++) {
            uint8_t       *pixel = &pixels[4 * (y * width + x)];
            const unsigned light = (2u * pixel[0] + 5u * pixel[1] + pixel[2]) / 8u;
            const size_t   line  = costs->line_of[y * costs->height / height * costs->width +
                                               x * costs->width / width];
            const uint8_t *color = line > 0 ? costs->lines[line - 1].color : gray;
            for (int k = 0; k < 3; k++)
                pixel[k] = (uint8_t)(color[k] * (110u + light * 145u / 255u) / 255u);
        }
}

/* ---- the thread ---- */

static KrsStatus profile_scene(Profiler *profiler, KrsRenderer *renderer, Costs *costs)
{
    const View          *view = &profiler->view;
    Profile              profile;
    const ProfileOptions how = {
        .renderer = renderer,
        .purpose  = KRS_FOR_PICTURES,
        .how      = {.integrator = KRS_INTEGRATOR_PREVIEW, .progress = is_wanted, .user = profiler},
        .aspect   = (double)view->width / view->height,
        .camera   = &view->camera,
        .seconds  = SECONDS,
        .compile  = compile,
        .state    = make_state,
        .progress = report_progress,
        .user     = profiler};
    KrsStatus status = compile(profiler, NULL, &profiler->whole);
    if (status == KRS_OK)
        status = profile_make(&how, profiler->whole, &profiler->arena, &profile);
    if (status == KRS_OK) {
        status = describe(&profile, &profiler->arena, costs);
        profile_free(&profile);
    }
    return status;
}

/* Profiles a scene; where memory runs out, longjmp returns here. */
static KrsStatus profile_guarded(Profiler *profiler, KrsRenderer *renderer, Costs *costs)
{
    jmp_buf exhausted;
    profiler->memory          = (Memory){.exhausted = &exhausted};
    profiler->arena           = (Arena){.memory = &profiler->memory};
    volatile KrsStatus status = KRS_OUT_OF_MEMORY;
    if (setjmp(exhausted) == 0)
        status = profile_scene(profiler, renderer, costs);
    arena_free(&profiler->arena);
    krs_scene_free(profiler->whole);
    profiler->whole = NULL;
    return status;
}

static KrsStatus carry_out(Profiler *profiler, char message[300], Costs *costs)
{
    KrsRendererOptions with     = profiler->renderer;
    KrsRenderer       *renderer = NULL;
    with.progress               = is_wanted;
    with.progress_user          = profiler;
    KrsStatus status            = krs_renderer_new(&with, &renderer);
    if (status == KRS_OK)
        status = profile_guarded(profiler, renderer, costs);
    const char *why = status == KRS_INTERRUPTED ? "given up"
                      : status == KRS_BAD_SCENE ? "the text has a mistake"
                      : renderer                ? krs_renderer_message(renderer)
                                                : "out of memory";
    if (status != KRS_OK)
        snprintf(message, 300, "%.299s", why);
    krs_renderer_free(renderer);
    return status;
}

static bool take(Profiler *profiler)
{
    pthread_mutex_lock(&profiler->lock);
    while (!profiler->quit && !profiler->ordered)
        pthread_cond_wait(&profiler->changed, &profiler->lock);
    const bool taken = !profiler->quit;
    if (taken) {
        profiler->view    = profiler->next;
        profiler->next    = (View){0};
        profiler->ordered = false;
    }
    pthread_mutex_unlock(&profiler->lock);
    return taken;
}

static void *work(void *user)
{
    Profiler *profiler = user;
    while (take(profiler)) {
        char            message[300] = "";
        Costs           costs        = {0};
        const KrsStatus status       = carry_out(profiler, message, &costs);
        view_free(&profiler->view);
        if (status != KRS_OK)
            costs_free(&costs);
        pthread_mutex_lock(&profiler->lock);
        costs_free(&profiler->costs);
        profiler->costs        = costs;
        profiler->state.busy   = false;
        profiler->state.status = status;
        profiler->state.orders++;
        memcpy(profiler->state.message, message, sizeof message);
        pthread_mutex_unlock(&profiler->lock);
        profiler->told(profiler->user);
    }
    return NULL;
}

Profiler *profiler_new(const KrsRendererOptions *renderer, const KrsOptions *scene,
                       const char *path, SuppliedText supplied, void (*told)(void *user),
                       void *user)
{
    Profiler *profiler = calloc(1, sizeof *profiler);
    if (!profiler)
        return NULL;
    profiler->renderer = *renderer;
    profiler->scene    = *scene;
    profiler->path     = path;
    profiler->supplied = supplied;
    profiler->told     = told;
    profiler->user     = user;
    atomic_init(&profiler->given_up, false);
    atomic_init(&profiler->permille, 0);
    pthread_mutex_init(&profiler->lock, NULL);
    pthread_cond_init(&profiler->changed, NULL);
    if (pthread_create(&profiler->thread, NULL, work, profiler) == 0)
        return profiler;
    free(profiler);
    return NULL;
}

void profiler_free(Profiler *profiler)
{
    if (!profiler)
        return;
    profiler_cancel(profiler);
    pthread_mutex_lock(&profiler->lock);
    profiler->quit = true;
    pthread_cond_signal(&profiler->changed);
    pthread_mutex_unlock(&profiler->lock);
    pthread_join(profiler->thread, NULL);
    view_free(&profiler->next);
    costs_free(&profiler->costs);
    pthread_mutex_destroy(&profiler->lock);
    pthread_cond_destroy(&profiler->changed);
    free(profiler);
}

bool profiler_start(Profiler *profiler, const View *view)
{
    View copy;
    if (!view_copy(view, &copy))
        return false;
    pthread_mutex_lock(&profiler->lock);
    const bool free_now = !profiler->state.busy;
    if (free_now) {
        profiler->next       = copy;
        profiler->ordered    = true;
        profiler->state.busy = true;
        atomic_store(&profiler->given_up, false);
        atomic_store(&profiler->permille, 0);
        pthread_cond_signal(&profiler->changed);
    }
    pthread_mutex_unlock(&profiler->lock);
    if (!free_now)
        view_free(&copy);
    return free_now;
}

void profiler_cancel(Profiler *profiler) { atomic_store(&profiler->given_up, true); }

ProfilerState profiler_state(Profiler *profiler)
{
    pthread_mutex_lock(&profiler->lock);
    ProfilerState state = profiler->state;
    pthread_mutex_unlock(&profiler->lock);
    state.done = atomic_load(&profiler->permille) / 1000.0;
    return state;
}

bool profiler_take(Profiler *profiler, Costs *costs)
{
    pthread_mutex_lock(&profiler->lock);
    *costs          = profiler->costs;
    profiler->costs = (Costs){0};
    pthread_mutex_unlock(&profiler->lock);
    return costs->line_of != NULL;
}
