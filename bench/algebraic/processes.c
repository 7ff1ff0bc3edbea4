/*
 * processes.c: krs and the other programs on a surface, in turns: wall and CPU time of all threads,
 * and the most memory that was resident.
 */
#include "bench/algebraic/processes.h"

#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void runs_take(Runs *runs, const Run *run)
{
    runs->wall[runs->count]   = run->wall;
    runs->cpu[runs->count]    = run->cpu;
    runs->frame[runs->count]  = run->frame;
    runs->memory[runs->count] = run->memory;
    runs->median              = *run;
    runs->count++;
}

void runs_settle(Runs *runs)
{
    runs->median.wall   = middle(runs->wall, runs->count);
    runs->median.cpu    = middle(runs->cpu, runs->count);
    runs->median.frame  = middle(runs->frame, runs->count);
    runs->median.memory = middle(runs->memory, runs->count);
}

/* ---- folders ---- */

void folder_make(char path[FOLDER_ROOM])
{
    snprintf(path, FOLDER_ROOM, "/tmp/krs-algebraic-XXXXXX");
    if (!mkdtemp(path))
        give_up(path, "cannot make it");
}

static int remove_entry(const char *path, const struct stat *info, int kind, struct FTW *place)
{
    (void)info, (void)kind, (void)place;
    return remove(path);
}

/* The caches in it are no longer there either. */
void folder_remove(const char *path)
{
    nftw(path, remove_entry, 16, FTW_DEPTH | FTW_PHYS);
    unsetenv("XDG_CACHE_HOME");
    unsetenv("MESA_SHADER_CACHE_DIR");
}

/* ---- krs ---- */

enum { MAX_OPTIONS = 4 };

void run_krs(const char *krs, const char *folder, const char *cache, const char *text,
             char *const *options, Run *run)
{
    char scene[512], picture[512], said[512], caches[512];
    snprintf(scene, sizeof scene, "%s/scene.krs", folder);
    snprintf(picture, sizeof picture, "%s/krs.png", folder);
    snprintf(said, sizeof said, "%s/krs.txt", folder);
    snprintf(caches, sizeof caches, "%s/%s", folder, cache);
    setenv("XDG_CACHE_HOME", caches, 1);
    setenv("MESA_SHADER_CACHE_DIR", caches, 1);
    FILE *file = fopen(scene, "wb");
    if (!file || fputs(text, file) == EOF || fclose(file) != 0)
        give_up(scene, "cannot write it");
    char *arguments[9 + MAX_OPTIONS] = {(char *)krs, "render",  scene,         "-o",
                                        picture,     "--quiet", "--occlusion", "off"};
    for (size_t i = 0; options && options[i] && i < MAX_OPTIONS; i++)
        arguments[8 + i] = options[i];
    if (!run_command(arguments, said, run))
        give_up(krs, "it failed");
}

/* ---- a surface ---- */

static const char *const names_of_ours[OURS] = {"krs, nothing cached", "krs",
                                                "krs, octahedron normals"};

static void run_ours(const char *krs, const char *folder, size_t repeat, const char *text,
                     Runs ours[OURS])
{
    static char *const stencil[] = {"--normals", "octahedron", NULL};
    Run                run       = {0};
    char               cache[32];
    snprintf(cache, sizeof cache, "cache%zu", repeat);
    run_krs(krs, folder, cache, text, NULL, &run);
    runs_take(&ours[COLD], &run);
    run_krs(krs, folder, cache, text, NULL, &run);
    runs_take(&ours[WARM], &run);
    run_krs(krs, folder, "stencil", text, stencil, &run);
    if (repeat == 0) /* that has only filled the cache */
        run_krs(krs, folder, "stencil", text, stencil, &run);
    runs_take(&ours[STENCIL], &run);
}

static bool takes_part(const Program *program, const Subject *subject, size_t repeat)
{
    return program_is_installed(program->command) && subject->degree <= program->largest_degree &&
           subject->degree >= program->min_degree && (!program->slow || repeat == 0);
}

void processes_run(Processes *processes, const char *krs, const Subject *subject, const View *view,
                   const char *text, size_t repeats)
{
    char folder[FOLDER_ROOM];
    folder_make(folder);
    for (size_t repeat = 0; repeat < repeats; repeat++) {
        run_ours(krs, folder, repeat, text, processes->ours);
        for (size_t i = 0; i < program_count; i++) {
            Run run = {0};
            if (!takes_part(&programs[i], subject, repeat))
                continue;
            if (!programs[i].run(&programs[i], folder, subject, view, &run))
                give_up(programs[i].name, "it failed");
            runs_take(&processes->others[i], &run);
        }
    }
    folder_remove(folder);
}

static void print_run(const Subject *subject, const char *name, const Run *run, const Frame *frame,
                      double krs_cpu)
{
    say("| %s | %d | %s | %.0f | %.0f | %.0f |", subject->name, subject->degree, name, run->wall,
        run->cpu, run->memory);
    if (run->frame > 0)
        say(" %.0f | %.1f |", run->frame, run->frame / frame->cpu);
    else
        say(" | |");
    say(" %.2f | %.1f %% | %zu / %zu / %zu |\n", run->cpu / krs_cpu, 100 * run->coverage,
        run->judgement.missed, run->judgement.extra, run->judgement.apart);
}

void processes_print(Processes *processes, const Subject *subject, const Frame *frame)
{
    for (int i = 0; i < OURS; i++) {
        Run *run = &processes->ours[i].median;
        runs_settle(&processes->ours[i]);
        run->frame     = i == STENCIL ? frame->stencil_cpu : frame->cpu;
        run->coverage  = frame->coverage;
        run->judgement = frame->judgement;
    }
    double cpu = processes->ours[WARM].median.cpu;
    for (int i = 0; i < OURS; i++)
        print_run(subject, names_of_ours[i], &processes->ours[i].median, frame, cpu);
    for (size_t i = 0; i < program_count; i++)
        if (processes->others[i].count > 0) {
            runs_settle(&processes->others[i]);
            print_run(subject, programs[i].name, &processes->others[i].median, frame, cpu);
        }
}
