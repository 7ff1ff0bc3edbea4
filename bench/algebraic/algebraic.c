/*
 * algebraic.c: algebraic surfaces: our ways to trace them beside each other, and the whole program
 * beside POV-Ray and surf; a tree of 2^28 branches beside one that is written out; a Julia set.
 *
 * Everything in turns, medians.  What pictures show is held against first roots (judge.c).  The
 * tables are printed, and written to bench/results/ when they are whole.  bench/algebraic/README.md says what
 * the columns mean.
 */
#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "bench/algebraic/judge.h"
#include "bench/algebraic/processes.h"
#include "krs/vulkan.h"

static const Subject subjects[] = {
#define SURFACE(name, call, oracle, degree, radius, text) \
    {name, call, oracle, degree, radius, text},
#include "bench/algebraic/surfaces.def"
#undef SURFACE
};
enum { SUBJECTS = sizeof subjects / sizeof *subjects };

const Definition definitions[] = {
    {"a1", "(-0.078528201496985033)"}, {"a2", "(-4.1583605922880173)"},
    {"a3", "(-4.1471434889655118)"},   {"a4", "(-1.1881659380714786)"},
    {"a5", "51.942614594814650"},      {"l1", "(x^4+y^4+z^4+1)"},
    {"l2", "(x^2*y^2+z^2)"},           {"l3", "(x^2*z^2+y^2)"},
    {"l4", "(y^2*z^2+x^2)"},           {NULL, NULL}};

/* Ours; all but the last with the normals that are the default. */
static const struct Variant {
    const char *name;
    KrsTrace    trace;
    KrsNormals  normals;
} variants[] = {{"plain", KRS_TRACE_PLAIN, 0},
                {"auto", KRS_TRACE_AUTO, 0},
                {"taylor", KRS_TRACE_TAYLOR, 0},
                {"root-free", KRS_TRACE_ROOT_FREE, 0},
                {"exact", KRS_TRACE_EXACT, 0},
                {"exact, octahedron", KRS_TRACE_EXACT, KRS_NORMALS_OCTAHEDRON}};
enum { VARIANTS = sizeof variants / sizeof *variants, CHOSEN = 4 };

static FILE *kept; /* all that has been said */

void say(const char *format, ...)
{
    va_list arguments, again;
    va_start(arguments, format);
    va_copy(again, arguments);
    vprintf(format, arguments);
    vfprintf(kept, format, again);
    va_end(again);
    va_end(arguments);
    fflush(stdout);
}

_Noreturn void give_up(const char *what, const char *why)
{
    fprintf(stderr, "algebraic: %s: %s\n", what, why);
    exit(1);
}

static int compare_numbers(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double middle(double *numbers, size_t count)
{
    qsort(numbers, count, sizeof *numbers, compare_numbers);
    return count % 2 ? numbers[count / 2] : 0.5 * (numbers[count / 2 - 1] + numbers[count / 2]);
}

static View view_of(const Subject *subject)
{
    View   view = {.back     = {0.42, 0.31, 0.853},
                   .height   = 1.4 * subject->radius,
                   .distance = 3 * subject->radius};
    double size = sqrt(0.42 * 0.42 + 0.31 * 0.31 + 0.853 * 0.853), across;
    for (int i = 0; i < 3; i++)
        view.back[i] /= size;
    across        = hypot(view.back[0], view.back[2]);
    view.right[0] = view.back[2] / across; /* up x back */
    view.right[2] = -view.back[0] / across;
    for (int i = 0; i < 3; i++) {
        int k = (i + 1) % 3, m = (i + 2) % 3;
        view.up[i] = view.back[k] * view.right[m] - view.back[m] * view.right[k];
    }
    return view;
}

static void write_scene(const Subject *subject, const View *view, char *text, size_t room)
{
    const double *b = view->back;
    snprintf(text, room,
             "use \"std/surfaces.krs\";\nshow %s;\n"
             "camera { eye: [%.17g, %.17g, %.17g], projection: \"orthographic\", height: %.17g }\n"
             "light sun { direction: [%.17g, %.17g, %.17g], shadow: false }\n"
             "image { size: [%d, %d] }\n",
             subject->call, view->distance * b[0], view->distance * b[1], view->distance * b[2],
             view->height, b[0], b[1], b[2], WIDTH, HEIGHT);
}

/* ---- our tracers ---- */

typedef struct Method {
    double    frame[MAX_REPEATS], rays[MAX_REPEATS], cpu[MAX_REPEATS];
    double    evaluations;
    uint64_t  unresolved;
    Judgement judgement;
} Method;

typedef struct Fixture {
    KrsRenderer  *renderer;
    KrsScene     *scene;
    KrsState     *state;
    KrsRendering *rendering;
} Fixture;

static Fixture fixture_open(KrsRenderer *renderer, const char *name, const char *text)
{
    Fixture    fixture = {.renderer = renderer};
    KrsOptions options = {.gradients = true, .research = true};
    if (krs_compile_text(text, strlen(text), name, &options, &fixture.scene) != KRS_OK ||
        krs_state_new(fixture.scene, &fixture.state) != KRS_OK)
        give_up(name, "it does not compile");
    if (krs_rendering_new(renderer, fixture.scene, KRS_FOR_PICTURES, &fixture.rendering) != KRS_OK)
        give_up(name, krs_renderer_message(renderer));
    return fixture;
}

static void fixture_close(Fixture *fixture)
{
    krs_rendering_free(fixture->rendering);
    krs_state_free(fixture->state);
    krs_scene_free(fixture->scene);
}

/* Renders without occlusion, which the other programs do not have either. */
static KrsPicture *shoot(const Fixture *fixture, const struct Variant *variant)
{
    KrsPicture      *picture;
    KrsRenderOptions options = {.width           = WIDTH,
                                .height          = HEIGHT,
                                .methods.trace   = variant->trace,
                                .methods.normals = variant->normals,
                                .no_occlusion    = true,
                                .aovs            = KRS_AOV_COLOR};
    if (krs_render(fixture->rendering, fixture->state, &options, &picture) != KRS_OK)
        give_up(variant->name, krs_renderer_message(fixture->renderer));
    return picture;
}

/* Returns what all threads of this process have computed. */
static double cpu_ms(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

static Judgement judge_picture(const Subject *subject, const View *view, const KrsPicture *picture,
                               double *coverage)
{
    static bool seen[SEEN_ROWS][SEEN_COLUMNS];
    *coverage = 0;
    for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; i++)
        *coverage += picture->color[4 * i + 3] / (WIDTH * HEIGHT);
    for (size_t y = 0; y < SEEN_ROWS; y++)
        for (size_t x = 0; x < SEEN_COLUMNS; x++)
            seen[y][x] = picture->color[4 * (y * STRIDE * WIDTH + x * STRIDE) + 3] > 0.5f;
    return judge(subject, view, CUT_SOLID, seen);
}

/* One picture that is judged, and then all in turns. */
static void run_methods(const Fixture *fixture, const Subject *subject, const View *view,
                        size_t repeats, Method methods[VARIANTS], double *coverage)
{
    for (int m = 0; m < VARIANTS; m++) {
        KrsPicture *picture    = shoot(fixture, &variants[m]);
        methods[m].judgement   = judge_picture(subject, view, picture, coverage);
        methods[m].evaluations = picture->stats.evaluations_per_ray;
        methods[m].unresolved  = picture->stats.unresolved;
        krs_picture_free(picture);
    }
    for (size_t repeat = 0; repeat < repeats; repeat++)
        for (int m = 0; m < VARIANTS; m++) {
            double      before       = cpu_ms();
            KrsPicture *picture      = shoot(fixture, &variants[m]);
            methods[m].cpu[repeat]   = cpu_ms() - before;
            methods[m].frame[repeat] = picture->stats.total_ms;
            methods[m].rays[repeat]  = picture->stats.phase_ms[KRS_PHASE_BEAMS] +
                                      picture->stats.phase_ms[KRS_PHASE_PRIMARY];
            krs_picture_free(picture);
        }
}

/* Returns what all threads compute for a frame by the default, whose march are exact steps. */
static Frame print_tracers(KrsRenderer *renderer, const Subject *subject, const View *view,
                           size_t repeats)
{
    static Method methods[VARIANTS];
    char          text[1024];
    Frame         frame = {0};
    write_scene(subject, view, text, sizeof text);
    Fixture fixture = fixture_open(renderer, subject->name, text);
    run_methods(&fixture, subject, view, repeats, methods, &frame.coverage);
    for (int m = 0; m < VARIANTS; m++) {
        Method *method = &methods[m];
        double  cpu = middle(method->cpu, repeats), rays = middle(method->rays, repeats);
        say("| %s | %d | %s | %.0f | %.0f | %.1f | %.1f | %.1f | %zu / %zu / %zu | %llu |\n",
            subject->name, subject->degree, variants[m].name, cpu, middle(method->frame, repeats),
            rays, rays * 1e6 / (WIDTH * HEIGHT), method->evaluations, method->judgement.missed,
            method->judgement.extra, method->judgement.apart,
            (unsigned long long)method->unresolved);
    }
    frame.cpu         = middle(methods[CHOSEN].cpu, repeats);
    frame.stencil_cpu = middle(methods[CHOSEN + 1].cpu, repeats);
    frame.judgement   = methods[CHOSEN].judgement;
    fixture_close(&fixture);
    return frame;
}

/* ---- all of it ---- */

/* "llvmpipe (LLVM 15.0.6, 256 bits)" is called llvmpipe. */
static void name_results(const char *device, char *path, size_t room)
{
    char      date[16], slug[64] = "";
    time_t    now = time(NULL);
    struct tm parts;
    gmtime_r(&now, &parts);
    strftime(date, sizeof date, "%Y-%m-%d", &parts);
    for (size_t i = 0; isalnum((unsigned char)device[i]) && i + 1 < sizeof slug; i++)
        slug[i] = (char)tolower((unsigned char)device[i]);
    snprintf(path, room, "bench/results/%s-algebraic-%s.md", date, slug);
}

static void write_results(const char *path, const char *text)
{
    FILE *file = fopen(path, "wb");
    if (!file || fputs(text, file) == EOF || fclose(file) != 0)
        give_up(path, "cannot write it");
    fprintf(stderr, "algebraic: wrote %s\n", path);
}

static void print_heads(size_t repeats, const char *device, double load)
{
    say("# Algebraic surfaces on %s\n\n%dx%d, medians of %zu in turns, without shadows and "
        "occlusion; %ld processors, load %.1f at the start. bench/algebraic/README.md says what "
        "the columns mean.\n\n",
        device, WIDTH, HEIGHT, repeats, sysconf(_SC_NPROCESSORS_ONLN), load);
    for (size_t i = 0; i < program_count; i++)
        if (!program_is_installed(programs[i].command))
            say("%s is left out: `%s` is not installed.\n", programs[i].name, programs[i].command);
}

static bool is_wanted(const char *name, const char *only)
{
    return !only || strcmp(name, only) == 0;
}

static void run_processes(const char *krs, size_t repeats, const char *only,
                          Processes processes[SUBJECTS], Trees *trees, Julias *julias)
{
    char text[1024];
    for (int i = 0; i < SUBJECTS; i++) {
        if (!is_wanted(subjects[i].name, only))
            continue;
        fprintf(stderr, "algebraic: %s by whole programs\n", subjects[i].name);
        View view = view_of(&subjects[i]);
        check_text(&subjects[i]);
        write_scene(&subjects[i], &view, text, sizeof text);
        processes_run(&processes[i], krs, &subjects[i], &view, text, repeats);
    }
    if (is_wanted("trees", only) && program_is_installed("povray"))
        trees_run(trees, krs, repeats);
    if (is_wanted("julias", only) && program_is_installed("povray"))
        julias_run(julias, krs, repeats);
}

/* Prints what is measured in this process. */
static void print_all_tracers(KrsRenderer *renderer, size_t repeats, const char *only,
                              Frame frames[SUBJECTS])
{
    say("| surface | degree | trace | cpu ms | frame ms | rays ms | ns/ray | evals/ray "
        "| missed / extra / apart | unresolved |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
    for (int i = 0; i < SUBJECTS; i++) {
        if (!is_wanted(subjects[i].name, only))
            continue;
        View view = view_of(&subjects[i]);
        estimates_print(&subjects[i], &view);
        frames[i] = print_tracers(renderer, &subjects[i], &view, repeats);
    }
}

static void print_processes(const char *only, Processes processes[SUBJECTS],
                            const Frame frames[SUBJECTS], Trees *trees, Julias *julias)
{
    say("\n| surface | degree | program | wall ms | cpu ms | MB | frame, cpu ms | of ours "
        "| cpu, of ours | coverage | missed / extra / apart |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
    for (int i = 0; i < SUBJECTS; i++)
        if (is_wanted(subjects[i].name, only))
            processes_print(&processes[i], &subjects[i], &frames[i]);
    if (trees->branches > 0)
        trees_print(trees);
    if (julias->ours.count > 0)
        julias_print(julias);
}

/* algebraic KRS [REPEATS [SURFACE|trees|julias]] */
int main(int count, char **arguments)
{
    KrsRenderer     *renderer;
    static Frame     frames[SUBJECTS];
    static Processes processes[SUBJECTS];
    static Trees     trees;
    static Julias    julias;
    char             path[128], *text;
    size_t           length;
    const char      *only = count > 3 ? arguments[3] : NULL;
    if (count < 2)
        give_up("usage", "algebraic KRS [REPEATS [SURFACE|trees|julias]]");
    size_t repeats = count > 2 ? strtoul(arguments[2], NULL, 10) : 3;
    repeats        = repeats < 1 ? 1 : repeats > MAX_REPEATS ? MAX_REPEATS : repeats;
    kept           = open_memstream(&text, &length);
    if (!kept)
        give_up("cannot begin", "no memory");
    double load = 0;
    getloadavg(&load, 1);
    run_processes(arguments[1], repeats, only, processes, &trees, &julias);
    if (krs_renderer_new(NULL, &renderer) != KRS_OK)
        give_up("cannot open the device", renderer ? krs_renderer_message(renderer) : "no memory");
    const char *device = krs_renderer_device(renderer).name;
    print_heads(repeats, device, load);
    name_results(device, path, sizeof path);
    print_all_tracers(renderer, repeats, only, frames);
    krs_renderer_free(renderer);
    print_processes(only, processes, frames, &trees, &julias);
    fclose(kept);
    if (!only)
        write_results(path, text);
    free(text);
    return 0;
}
