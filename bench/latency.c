/*
 * latency.c: runs the command with caches in fresh folders: the driver's, ours, and whatever else
 * goes by XDG.
 */
#include "bench/latency.h"

#include <ftw.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "bench/measure.h"

extern char **environ;

enum { MAX_RUNS = 5 };

/* What says where caches are, or that there are none. */
static const char *const cache_variables[] = {
    "XDG_CACHE_HOME",         "MESA_SHADER_CACHE_DIR",       "MESA_SHADER_CACHE_DISABLE",
    "__GL_SHADER_DISK_CACHE", "__GL_SHADER_DISK_CACHE_PATH",
};

static bool is_about_caches(const char *setting)
{
    for (size_t i = 0; i < sizeof cache_variables / sizeof cache_variables[0]; i++) {
        size_t length = strlen(cache_variables[i]);
        if (strncmp(setting, cache_variables[i], length) == 0 && setting[length] == '=')
            return true;
    }
    return false;
}

/* Our environment, with all caches in this folder. */
static char **environment(Bench *bench, const char *folder)
{
    size_t count = 0, kept = 0;
    while (environ[count])
        count++;
    char **settings = arena_new_array(bench->arena, char *, count + 4);
    for (size_t i = 0; i < count; i++)
        if (!is_about_caches(environ[i]))
            settings[kept++] = environ[i];
    static const char *const folders[] = {"XDG_CACHE_HOME", "MESA_SHADER_CACHE_DIR",
                                          "__GL_SHADER_DISK_CACHE_PATH"};
    for (size_t i = 0; i < sizeof folders / sizeof folders[0]; i++) {
        Text setting = {.arena = bench->arena};
        text_format(&setting, "%s=%s", folders[i], folder);
        settings[kept++] = setting.bytes;
    }
    return settings;
}

static double first_picture_ms(Bench *bench, const char *folder, char **settings)
{
    Text picture = {.arena = bench->arena};
    text_format(&picture, "%s/picture.exr", folder);
    char  *arguments[] = {(char *)bench->krs,
                          "render",
                          "examples/01-hello.krs",
                          "--size",
                          "640x360",
                          "--quiet",
                          "-o",
                          picture.bytes,
                         bench->device ? "--device" : NULL,
                          (char *)bench->device,
                          NULL};
    pid_t  child;
    int    status;
    double start = clock_ms();
    if (posix_spawn(&child, bench->krs, NULL, NULL, arguments, settings) != 0)
        fail("cannot run %s", bench->krs);
    if (waitpid(child, &status, 0) != child || status != 0)
        fail("%s failed to render examples/01-hello.krs", bench->krs);
    double ms = clock_ms() - start;
    if (remove(picture.bytes) != 0)
        fail("%s wrote no picture", bench->krs);
    return ms;
}

static int remove_entry(const char *path, const struct stat *info, int kind, struct FTW *place)
{
    (void)info;
    (void)kind;
    (void)place;
    return remove(path);
}

void latency_run(Bench *bench, Latency *latency)
{
    size_t count = bench->repeats < MAX_RUNS ? bench->repeats : MAX_RUNS;
    double cold[MAX_RUNS], warm[MAX_RUNS];
    tell("first picture, %zu times", count);
    for (size_t i = 0; i < count; i++) {
        const char *base   = getenv("TMPDIR");
        Text        folder = {.arena = bench->arena};
        text_format(&folder, "%s/krs-bench-XXXXXX", base ? base : "/tmp");
        if (!mkdtemp(folder.bytes))
            fail("cannot make a temporary folder");
        char **settings = environment(bench, folder.bytes);
        cold[i]         = first_picture_ms(bench, folder.bytes, settings);
        warm[i]         = first_picture_ms(bench, folder.bytes, settings);
        nftw(folder.bytes, remove_entry, 16, FTW_DEPTH | FTW_PHYS);
    }
    *latency = (Latency){median(cold, count), median(warm, count)};
}
