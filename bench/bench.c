/*
 * bench.c: `make bench`: what is measured, in order.  README.md says why and how to read it.
 */
#include "bench/bench.h"

#include <errno.h>
#include <getopt.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "bench/results.h"
#include "bench/sheet.h"

typedef enum Part {
    PART_GROWTH,
    PART_KRS,
    PART_TRIANGLES,
    PART_QUESTIONS,
    PART_FIRST_PICTURE,
    PART_COUNT
} Part;
static const char *const part_names[PART_COUNT] = {"growth", "krs", "triangles", "questions",
                                                   "first-picture"};

static const char usage[] =
    "usage: bench [--quick] [--repeats N] [--only NAME] [--krs COMMAND] [--folder FOLDER]\n"
    "             [--device INDEX|NAME|cpu] [--revision NAME]\n"
    "Run it from the root of the source.  It writes FOLDER/DATE-bench-DEVICE.json and .md, and\n"
    "fails when a picture is not as it should be.  Only one scene, or one of growth, krs,\n"
    "triangles, questions and first-picture, is printed and not written.\n";

void fail(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fputs("bench: ", stderr);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    va_end(arguments);
    exit(1);
}

void tell(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fputs("bench: ", stderr);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    va_end(arguments);
}

char *read_file(Arena *arena, const char *path)
{
    FILE *file = fopen(path, "rb");
    if (!file)
        fail("cannot read %s: %s", path, strerror(errno));
    Text   text = {.arena = arena};
    char   piece[4096];
    size_t length;
    while ((length = fread(piece, 1, sizeof piece, file)) > 0)
        text_add_bytes(&text, piece, length);
    if (ferror(file) || text.length == 0)
        fail("cannot read %s", path);
    fclose(file);
    return text.bytes;
}

static void write_file(const char *path, const Text *text)
{
    FILE *file = fopen(path, "wb");
    if (!file || fwrite(text->bytes, 1, text->length, file) != text->length || fclose(file) != 0)
        fail("cannot write %s: %s", path, strerror(errno));
    tell("wrote %s", path);
}

/* ---- What is asked for ---- */

static bool is_scene(const char *name)
{
    for (size_t i = 0; i < scene_count; i++)
        if (strcmp(name, scene_rows[i].name) == 0)
            return true;
    return false;
}

static bool is_part(const char *name)
{
    for (Part part = 0; part < PART_COUNT; part++)
        if (strcmp(name, part_names[part]) == 0)
            return true;
    return false;
}

static void read_options(Bench *bench, int argc, char **argv)
{
    static const struct option options[] = {
        {"quick", no_argument, NULL, 'q'},          {"repeats", required_argument, NULL, 'n'},
        {"only", required_argument, NULL, 's'},     {"krs", required_argument, NULL, 'k'},
        {"folder", required_argument, NULL, 'f'},   {"device", required_argument, NULL, 'd'},
        {"revision", required_argument, NULL, 'r'}, {0},
    };
    uint32_t repeats = 0;
    for (int letter; (letter = getopt_long(argc, argv, "", options, NULL)) != -1;) {
        switch (letter) {
        case 'q': bench->quick = true; break;
        case 'n': repeats = (uint32_t)strtoul(optarg, NULL, 10); break;
        case 's': bench->only = optarg; break;
        case 'k': bench->krs = optarg; break;
        case 'f': bench->folder = optarg; break;
        case 'd': bench->device = optarg; break;
        case 'r': bench->revision = optarg; break;
        default: fputs(usage, stderr); exit(2);
        }
    }
    if (optind != argc || repeats > 50) {
        fputs(usage, stderr);
        exit(2);
    }
    if (bench->only && !is_scene(bench->only) && !is_part(bench->only))
        fail("there is no scene or part called %s", bench->only);
    bench->repeats = repeats ? repeats : bench->quick ? 1 : 5;
    bench->width   = bench->quick ? 320 : 1280;
    bench->height  = bench->quick ? 180 : 720;
}

/* Shaders are compiled as if for the first time: what is kept from earlier runs would make the
   times of compiling depend on the past. */
static void forget_caches(void)
{
    setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
    setenv("__GL_SHADER_DISK_CACHE", "0", 1);
}

static void open_device(Bench *bench)
{
    KrsRendererOptions options = {.device = bench->device};
    if (krs_renderer_new(&options, &bench->renderer) != KRS_OK)
        fail("%s", krs_renderer_message(bench->renderer));
    if (!gpu_open(&bench->gpu, &options, 0))
        fail("%s", bench->gpu.message);
}

static void close_device(Bench *bench)
{
    gpu_close(&bench->gpu);
    krs_renderer_free(bench->renderer);
}

/* ---- What is done ---- */

static bool is_wanted(const Bench *bench, Part part)
{
    return !bench->only || strcmp(bench->only, part_names[part]) == 0;
}

static void run_contests(Bench *bench, Results *results)
{
    results->contests = arena_new_array(bench->arena, Contest, scene_count);
    for (size_t i = 0; i < scene_count; i++) {
        const SceneRow *row = &scene_rows[i];
        if (bench->only ? strcmp(bench->only, row->name) != 0 : bench->quick && !row->quick)
            continue;
        Contest *contest = &results->contests[results->contest_count++];
        contest_run(bench, row, contest);
        contest_judge(bench, contest, &results->faults);
        peak_measure(bench, &results->peak);
    }
}

static void run_all(Bench *bench, Results *results)
{
    machine_describe(bench, &results->machine);
    tell("peak of the device");
    peak_open(bench, &results->peak);
    run_contests(bench, results);
    if (is_wanted(bench, PART_GROWTH))
        growth_run(bench, &results->growth);
    if (is_wanted(bench, PART_KRS)) {
        sequences_run(bench, &results->sequences);
        sequences_judge(&results->sequences, &results->faults);
    }
    if (is_wanted(bench, PART_TRIANGLES))
        triangles_run(bench, &results->triangles);
    if (is_wanted(bench, PART_QUESTIONS)) {
        questions_run(bench, &results->questions);
        questions_judge(&results->questions, &results->faults);
    }
    if (is_wanted(bench, PART_FIRST_PICTURE))
        latency_run(bench, &results->latency);
    peak_measure(bench, &results->peak);
    peak_close(bench, &results->peak);
}

static void write_results(const Bench *bench, const Results *results)
{
    Text json = {.arena = bench->arena}, text = json, path = json;
    results_json(bench, results, &json);
    results_tables(bench, results, &text);
    fputs(text.bytes, stdout);
    if (bench->only)
        return;
    mkdir(bench->folder, 0777); /* it may be there; if it cannot be made, writing will tell */
    text_format(&path, "%s/%s-bench-%s.json", bench->folder, results->date, results->machine.slug);
    write_file(path.bytes, &json);
    memcpy(path.bytes + path.length - 4, "md", 3);
    write_file(path.bytes, &text);
}

int main(int argc, char **argv)
{
    jmp_buf exhausted;
    Memory  memory = {.exhausted = &exhausted};
    Arena   arena  = {.memory = &memory};
    if (setjmp(exhausted) != 0)
        fail("out of memory");
    Bench bench = {
        .arena = &arena, .krs = "build/krs", .folder = "bench/results", .revision = "unknown"};
    read_options(&bench, argc, argv);
    forget_caches();
    open_device(&bench);

    char date[16];
    date_today(date, sizeof date);
    Results results = {.date = date, .faults = {.arena = &arena}};
    run_all(&bench, &results);
    write_results(&bench, &results);
    close_device(&bench);
    bool right = results.faults.length == 0;
    arena_free(&arena);
    return right ? 0 : 1;
}
