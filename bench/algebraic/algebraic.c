/*
 * algebraic.c: algebraic surfaces: our ways to trace them beside each other, and the whole program
 * beside POV-Ray and surf.
 *
 * Everything in turns, medians.  What our pictures show is held against first roots in long double
 * precision (tests/oracle/formulas.h), one pixel in sixteen.  bench/README.md says what the columns
 * mean.
 */
#include <ftw.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>
#include <cmocka.h>

#include "bench/algebraic/contest.h"
#include "runtime/krs_vulkan.h"
#include "tests/oracle/formulas.h"

enum { MOST_REPEATS = 15, STRIDE = 4 };

static const Subject subjects[] = {
#define SURFACE(name, call, oracle, degree, radius, text) {name, call, oracle, degree, radius, text},
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

static const KrsTrace traces[] = {KRS_TRACE_PLAIN, KRS_TRACE_AUTO, KRS_TRACE_EXACT,
                                  KRS_TRACE_TAYLOR, KRS_TRACE_ROOT_FREE};
enum { TRACES = sizeof traces / sizeof *traces };

void give_up(const char *what, const char *why)
{
    fprintf(stderr, "algebraic: %s: %s\n", what, why);
    exit(1);
}

static int compare_numbers(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double middle(double *numbers, size_t count)
{
    qsort(numbers, count, sizeof *numbers, compare_numbers);
    return count % 2 ? numbers[count / 2] : 0.5 * (numbers[count / 2 - 1] + numbers[count / 2]);
}

static View view_of(const Subject *subject)
{
    View   view = {.back = {0.42, 0.31, 0.853}, .height = 1.4 * subject->radius,
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

/* ---- what is right ---- */

typedef struct Judgement {
    size_t asked, missed, extra; /* of the pixels that are looked at */
    size_t apart;                /* of the latter two, not at an outline */
} Judgement;

static Fate fate_of(const Subject *subject, const View *view, int x, int y)
{
    const Surface *surface = surface_named(subject->oracle);
    double u = ((x + 0.5) / WIDTH - 0.5) * view->height * WIDTH / HEIGHT;
    double v = (0.5 - (y + 0.5) / HEIGHT) * view->height, at[3];
    for (int i = 0; i < 3; i++)
        at[i] = view->distance * view->back[i] + u * view->right[i] + v * view->up[i];
    return surface_entry(surface->formula, subject->radius, vec(at[0], at[1], at[2]),
                            vec(-view->back[0], -view->back[1], -view->back[2])).fate;
}

/* Whether a pixel next to this one should be seen so. */
static bool is_at_outline(const Subject *subject, const View *view, int x, int y, bool seen)
{
    for (int k = 0; k < 9; k++) {
        Fate fate = fate_of(subject, view, x + k % 3 - 1, y + k / 3 - 1);
        if (fate == RAY_DOUBTFUL || (fate == RAY_HITS) == seen)
            return true;
    }
    return false;
}

static Judgement judge(const Subject *subject, const View *view, const Fate *fates,
                       const KrsPicture *picture)
{
    Judgement j = {0};
    for (int y = 0; y < HEIGHT; y += STRIDE)
        for (int x = 0; x < WIDTH; x += STRIDE) {
            Fate fate = fates[y / STRIDE * (WIDTH / STRIDE) + x / STRIDE];
            bool seen = picture->color[4 * ((size_t)y * WIDTH + x) + 3] > 0.5f;
            if (fate == RAY_DOUBTFUL)
                continue;
            j.asked++;
            if (seen == (fate == RAY_HITS))
                continue;
            j.missed += !seen;
            j.extra += seen;
            j.apart += !is_at_outline(subject, view, x, y, seen);
        }
    return j;
}

static const Fate *find_fates(const Subject *subject, const View *view)
{
    static Fate fates[(WIDTH / STRIDE) * (HEIGHT / STRIDE)];
    for (int y = 0; y < HEIGHT; y += STRIDE)
        for (int x = 0; x < WIDTH; x += STRIDE)
            fates[y / STRIDE * (WIDTH / STRIDE) + x / STRIDE] = fate_of(subject, view, x, y);
    return fates;
}

/* The text for the other programs is that of the same surface. */
static void check_text(const Subject *subject)
{
    const Surface *surface = surface_named(subject->oracle);
    Polynomial     p = polynomial_read(subject->text, definitions);
    double         ratio = 0;
    for (int i = 0; i < 20; i++) {
        double at[3] = {sin(3.1 * i + 0.4), sin(1.7 * i + 1), sin(2.3 * i + 2)};
        Real   same[3] = {at[0], at[1], at[2]};
        double next = polynomial_value(&p, at) / (double)surface->formula(same);
        if (i > 0 && fabs(next / ratio - 1) > 1e-6)
            give_up(subject->name, "the text is another polynomial than the library's");
        ratio = next;
    }
}

/* ---- our tracers ---- */

typedef struct Method {
    double    frame[MOST_REPEATS], primary[MOST_REPEATS], cpu[MOST_REPEATS];
    double    evaluations;
    uint64_t  unresolved;
    Judgement judgement;
} Method;

typedef struct Stage {
    KrsRenderer  *renderer;
    KrsScene     *scene;
    KrsFrame     *frame;
    KrsRendering *rendering;
} Stage;

static Stage stage_open(KrsRenderer *renderer, const char *name, const char *text)
{
    Stage stage = {.renderer = renderer};
    if (krs_compile_text(text, strlen(text), name, NULL, &stage.scene) != KRS_OK ||
        krs_frame_new(stage.scene, &stage.frame) != KRS_OK)
        give_up(name, "it does not compile");
    if (krs_rendering_new(renderer, stage.scene, &stage.rendering) != KRS_OK)
        give_up(name, krs_renderer_message(renderer));
    return stage;
}

static void stage_close(Stage *stage)
{
    krs_rendering_free(stage->rendering);
    krs_frame_free(stage->frame);
    krs_scene_free(stage->scene);
}

static KrsPicture *shoot(const Stage *stage, KrsTrace trace)
{
    KrsPicture      *picture;
    KrsRenderOptions options = {.width = WIDTH, .height = HEIGHT, .trace = trace,
                                .planes = KRS_PLANE_COLOR};
    if (krs_render(stage->rendering, stage->frame, &options, &picture) != KRS_OK)
        give_up(krs_trace_names[trace], krs_renderer_message(stage->renderer));
    return picture;
}

/* What all threads of this process have computed. */
static double cpu_ms(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

/* What programs without occlusion do as well. */
static double frame_ms(const KrsRenderStats *stats)
{
    return stats->total_ms - stats->phase_ms[KRS_PHASE_OCCLUSION];
}

/* Returns what all threads compute for a frame by the default, whose march are exact steps. */
static double print_tracers(KrsRenderer *renderer, const Subject *subject, const View *view,
                            size_t repeats, double *coverage)
{
    static Method methods[TRACES];
    char          text[1024];
    write_scene(subject, view, text, sizeof text);
    Stage       stage = stage_open(renderer, subject->name, text);
    const Fate *fates = find_fates(subject, view);
    for (int m = 0; m < TRACES; m++) {
        KrsPicture *picture    = shoot(&stage, traces[m]);
        methods[m].judgement   = judge(subject, view, fates, picture);
        methods[m].evaluations = picture->stats.evaluations_per_ray;
        methods[m].unresolved  = picture->stats.unresolved;
        if (traces[m] == KRS_TRACE_EXACT) {
            *coverage = 0;
            for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; i++)
                *coverage += picture->color[4 * i + 3] / (WIDTH * HEIGHT);
        }
        krs_picture_free(picture);
    }
    for (size_t turn = 0; turn < repeats; turn++)
        for (int m = 0; m < TRACES; m++) {
            double        before  = cpu_ms();
            KrsPicture   *picture = shoot(&stage, traces[m]);
            const double *phase   = picture->stats.phase_ms;
            methods[m].cpu[turn]  = cpu_ms() - before;
            methods[m].frame[turn]   = frame_ms(&picture->stats);
            methods[m].primary[turn] = phase[KRS_PHASE_BEAMS] + phase[KRS_PHASE_PRIMARY];
            krs_picture_free(picture);
        }
    double chosen = 0;
    for (int m = 0; m < TRACES; m++) {
        Method *method  = &methods[m];
        double  frame   = middle(method->frame, repeats);
        double  cpu     = middle(method->cpu, repeats);
        double  primary = middle(method->primary, repeats);
        printf("| %s | %d | %s | %.1f | %.1f | %.1f | %.1f | %.1f | %zu / %zu / %zu | %llu |\n",
               subject->name, subject->degree, krs_trace_names[traces[m]], cpu, frame, primary,
               primary * 1e6 / (WIDTH * HEIGHT), method->evaluations, method->judgement.missed,
               method->judgement.extra, method->judgement.apart,
               (unsigned long long)method->unresolved);
        chosen = traces[m] == KRS_TRACE_EXACT ? cpu : chosen;
    }
    fflush(stdout);
    stage_close(&stage);
    return chosen;
}

/* ---- whole programs ---- */

typedef struct Runs {
    Run    median;
    size_t count;
    double wall[MOST_REPEATS], cpu[MOST_REPEATS], frame[MOST_REPEATS];
} Runs;

static void take(Runs *runs, const Run *run)
{
    runs->wall[runs->count]  = run->wall;
    runs->cpu[runs->count]   = run->cpu;
    runs->frame[runs->count] = run->frame;
    runs->median             = *run;
    runs->count++;
}

static void settle(Runs *runs)
{
    runs->median.wall  = middle(runs->wall, runs->count);
    runs->median.cpu   = middle(runs->cpu, runs->count);
    runs->median.frame = middle(runs->frame, runs->count);
}

static bool run_krs(const char *krs, const char *folder, const Subject *subject, const View *view,
                    Run *run)
{
    char scene[512], picture[512], said[512], text[1024];
    snprintf(scene, sizeof scene, "%s/scene.krs", folder);
    snprintf(picture, sizeof picture, "%s/krs.png", folder);
    snprintf(said, sizeof said, "%s/krs.txt", folder);
    FILE *file = fopen(scene, "wb");
    if (!file)
        give_up(scene, "cannot write it");
    write_scene(subject, view, text, sizeof text);
    fputs(text, file);
    fclose(file);
    char *const arguments[] = {(char *)krs, "render", scene, "-o", picture, "--quiet", NULL};
    return run_command(arguments, said, run);
}

static int remove_entry(const char *path, const struct stat *info, int kind, struct FTW *place)
{
    (void)info, (void)kind, (void)place;
    return remove(path);
}

/* All caches in this folder, or a fresh one. */
static void point_caches(const char *folder)
{
    setenv("XDG_CACHE_HOME", folder, 1);
    setenv("MESA_SHADER_CACHE_DIR", folder, 1);
}

static void print_run(const Subject *subject, const char *name, const Run *run, double frame,
                      double krs_cpu)
{
    printf("| %s | %d | %s | %.0f | %.0f |", subject->name, subject->degree, name, run->wall,
           run->cpu);
    if (run->frame > 0)
        printf(" %.0f | %.1f |", run->frame, run->frame / frame);
    else
        printf(" | |");
    printf(" %.2f | %.1f %% |\n", run->cpu / krs_cpu, 100 * run->coverage);
    fflush(stdout);
}

static void print_programs(const char *krs, const Subject *subject, const View *view, double frame,
                           double coverage, size_t repeats, bool slow)
{
    static Runs all[8], cold, warm;
    char        folder[] = "/tmp/krs-algebraic-XXXXXX", cache[64];
    memset(all, 0, sizeof all);
    cold = warm = (Runs){0};
    if (!mkdtemp(folder))
        give_up(folder, "cannot make it");
    for (size_t turn = 0; turn < repeats; turn++) {
        Run run = {.coverage = coverage, .frame = frame};
        snprintf(cache, sizeof cache, "%s/cache%zu", folder, turn);
        point_caches(cache);
        if (!run_krs(krs, folder, subject, view, &run))
            give_up(krs, "it failed");
        take(&cold, &run);
        if (!run_krs(krs, folder, subject, view, &run))
            give_up(krs, "it failed");
        take(&warm, &run);
        for (size_t i = 0; i < program_count; i++) {
            const Program *program = &programs[i];
            if (!program_is_installed(program->command) ||
                subject->degree > program->largest_degree ||
                subject->degree < program->least_degree || (program->slow && (!slow || turn > 0)))
                continue;
            run      = (Run){0};
            run.done = program->run(program, folder, subject, view, &run);
            if (!run.done)
                give_up(program->name, "it failed");
            take(&all[i], &run);
        }
    }
    settle(&cold);
    settle(&warm);
    print_run(subject, "krs, caches warm", &warm.median, frame, warm.median.cpu);
    print_run(subject, "krs, nothing cached", &cold.median, frame, warm.median.cpu);
    for (size_t i = 0; i < program_count; i++)
        if (all[i].count > 0) {
            settle(&all[i]);
            print_run(subject, programs[i].name, &all[i].median, frame, warm.median.cpu);
        }
    nftw(folder, remove_entry, 16, FTW_DEPTH | FTW_PHYS);
}

static void print_heads(size_t repeats, const char *device)
{
    double load[3] = {0};
    getloadavg(load, 3);
    printf("# Algebraic surfaces on %s\n\n%dx%d, parallel rays, medians of %zu in turns; "
           "%ld processors, load %.1f at the start.\n\n", device, WIDTH, HEIGHT, repeats,
           sysconf(_SC_NPROCESSORS_ONLN), load[0]);
    for (size_t i = 0; i < program_count; i++)
        if (!program_is_installed(programs[i].command))
            printf("%s is left out: `%s` is not installed.\n", programs[i].name,
                   programs[i].command);
}

/* algebraic KRS [REPEATS [SURFACE [slow]]]: with `slow` what takes minutes as well. */
int main(int count, char **arguments)
{
    KrsRenderer *renderer;
    static double frames[SUBJECTS], coverages[SUBJECTS];
    if (count < 2)
        give_up("usage", "algebraic KRS [REPEATS [SURFACE [slow]]]");
    size_t repeats = count > 2 ? strtoul(arguments[2], NULL, 10) : 5;
    repeats = repeats < 1 ? 1 : repeats > MOST_REPEATS ? MOST_REPEATS : repeats;
    if (krs_renderer_new(NULL, &renderer) != KRS_OK)
        give_up("cannot open the device", renderer ? krs_renderer_message(renderer) : "no memory");
    print_heads(repeats, krs_renderer_device(renderer).name);
    printf("\n| surface | degree | trace | cpu ms | frame ms | primary ms | ns/ray | evals/ray "
           "| missed / extra / apart | unresolved |\n"
           "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
    for (int i = 0; i < SUBJECTS; i++) {
        if (count > 3 && strcmp(subjects[i].name, arguments[3]) != 0)
            continue;
        View view = view_of(&subjects[i]);
        check_text(&subjects[i]);
        frames[i] = print_tracers(renderer, &subjects[i], &view, repeats, &coverages[i]);
    }
    krs_renderer_free(renderer);
    printf("\n| surface | degree | program | wall ms | cpu ms | frame, cpu ms | of ours | cpu, of ours | "
           "coverage |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
    for (int i = 0; i < SUBJECTS; i++) {
        if (count > 3 && strcmp(subjects[i].name, arguments[3]) != 0)
            continue;
        View view = view_of(&subjects[i]);
        print_programs(arguments[1], &subjects[i], &view, frames[i], coverages[i], repeats,
                       count > 4);
    }
    return 0;
}
