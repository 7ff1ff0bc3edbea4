/*
 * first.c: how soon `krs view` shows a scene, and an edit of its structure.
 *
 * usage: first SCENE auto|kernels|lanes
 *
 * It prints a part of a row: seconds until the first picture, until the one with all pixels and until there are shaders, from the
 * start and from an edit that adds a ball.  view.sh sees to it that caches are empty.
 */
#include <stdio.h>
#include <string.h>

#include "bench/fixture.h"
#include "bench/view/trial.h"

typedef struct Times {
    double first, whole, shaders;
} Times;

static Times time_pictures(Trial *trial, double begun)
{
    Times times;
    trial_show(trial);
    trial_await(trial, false);
    times.first = trial_now() - begun;
    if (!trial->whole)
        trial_await(trial, true);
    times.whole = trial_now() - begun;
    trial_await_shaders(trial);
    times.shaders = trial_now() - begun;
    return times;
}

static void print_times(const Times *times)
{
    printf(" %.2f | %.2f | %.1f |", times->first, times->whole, times->shaders);
}

static KrsExecutor executor_named(const char *name)
{
    for (int i = 0; i < KRS_EXECUTOR_COUNT; i++)
        if (strcmp(name, krs_executor_names[i]) == 0)
            return (KrsExecutor)i;
    give_up(name, "there is no such executor");
}

static void add_ball(const char *path)
{
    FILE *file = fopen(path, "a");
    if (!file || fputs("\nshow sphere(0.0123);\n", file) < 0 || fclose(file) != 0)
        give_up(path, "it cannot be written");
}

int main(int argc, char **argv)
{
    if (argc != 3)
        give_up("first", "it takes a scene, and who marches its rays");
    const double begun = trial_now();
    Trial        trial = trial_open(argv[1], executor_named(argv[2]), KRS_SPECIALIZE_AUTO);
    trial_take_version(&trial);
    trial_take_camera(&trial);
    const Times started = time_pictures(&trial, begun);
    print_times(&started);
    add_ball(argv[1]);
    const double saved = trial_now();
    if (document_read(trial.document) != KRS_OK)
        give_up(argv[1], "the edited text does not compile");
    trial_take_version(&trial);
    const Times edited = time_pictures(&trial, saved);
    print_times(&edited);
    trial_close(&trial);
    return 0;
}
