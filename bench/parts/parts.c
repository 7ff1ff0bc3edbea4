/*
 * parts.c: how long each pass of the compiler takes for scenes of 1,000, 10,000 and 100,000 parts.
 *
 * Where the whole compiler refuses a scene, its passes up to `elaborate` are timed alone.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/passes/compile.h"
#include "compiler/passes/inspect.h"

static const int counts[] = {1000, 10000, 100000};

/* A formula has the number of parts as its only argument; a line is repeated for each part. */
static const struct {
    const char *name, *formula, *line;
} scenes[] = {
    {"spheres",
     "show union([sphere(0.2 + 0.1 * random(4 * i)).move([100 * random(4 * i + 1), "
     "100 * random(4 * i + 2), 100 * random(4 * i + 3)]) for i in 0..%d]);",
     NULL},
    {"boxes, turned and painted",
     "show union([box([0.2 + 0.1 * random(i), 0.1, 0.3]).rotate([0, 1, 0], 6 * random(i + 0.5))"
     ".move([i, 0, 0]).paint([#aa3322, #225599][i %% 2]) for i in 0..%d]);",
     NULL},
    {"blended spheres",
     "show union([sphere(0.2 + 0.1 * random(i)).move([0.2 * i, 0, 0]) for i in 0..%d], "
     "blend: 0.1);",
     NULL},
    {"components", "for i in 0..%d { show sphere(0.3).move([i, 0, 0]); }", NULL},
    {"spheres, written one by one", NULL, "    sphere(0.25).move([%d.125, %d.5, 1]),\n"},
};
enum { SCENES = sizeof scenes / sizeof *scenes, COUNTS = sizeof counts / sizeof *counts };

static void give_up(const char *what)
{
    fprintf(stderr, "parts: %s\n", what);
    exit(EXIT_FAILURE);
}

static char *scene_text(size_t scene, int count)
{
    enum { LONGEST = 512 };
    size_t lines = scenes[scene].line ? (size_t)count : 0, most = LONGEST + 64 * lines;
    char  *text = malloc(most);
    if (!text)
        give_up("no memory");
    if (!scenes[scene].line) {
        snprintf(text, most, scenes[scene].formula, count);
        return text;
    }
    size_t length = (size_t)snprintf(text, most, "show union([\n");
    for (int i = 0; i < count; i++)
        length += (size_t)snprintf(text + length, most - length, scenes[scene].line, i % 100,
                                   i / 100);
    snprintf(text + length, most - length, "]);\n");
    return text;
}

static void print_times(const double *ms, size_t passes)
{
    double sum = 0;
    for (size_t i = 0; krs_pass(i); i++) {
        if (i < passes)
            printf(" %.1f |", ms[i]);
        else
            printf(" - |");
        sum += i < passes ? ms[i] : 0;
    }
    printf(" %.0f |\n", sum);
}

static size_t passes_up_to(const char *name)
{
    size_t i = 0;
    while (strcmp(krs_pass(i)->name, name) != 0)
        i++;
    return i + 1;
}

static KrsStatus print_elaborated(void *user, const Inspected *what)
{
    (void)user;
    print_times(what->pass_ms, passes_up_to("elaborate"));
    return KRS_OK;
}

static void measure(size_t scene, int count)
{
    char     *text = scene_text(scene, count);
    KrsScene *compiled;
    printf("| %s | %d |", scenes[scene].name, count);
    if (krs_compile_text(text, strlen(text), "parts.krs", NULL, &compiled) == KRS_OK) {
        print_times(krs_scene_program(compiled)->pass_ms, passes_up_to("frame"));
        krs_scene_free(compiled);
    } else if (inspect_elaborated(text, strlen(text), NULL, print_elaborated, NULL) != KRS_OK)
        give_up("a scene is refused");
    fflush(stdout);
    free(text);
}

int main(void)
{
    printf("Milliseconds of each pass; -: the pass was not reached.\n\n| parts | number |");
    for (size_t i = 0; krs_pass(i); i++)
        printf(" %s |", krs_pass(i)->name);
    printf(" sum |\n| --- | ---: |");
    for (size_t i = 0; krs_pass(i); i++)
        printf(" ---: |");
    printf(" ---: |\n");
    for (size_t scene = 0; scene < SCENES; scene++)
        for (size_t i = 0; i < COUNTS; i++)
            measure(scene, counts[i]);
    return 0;
}
