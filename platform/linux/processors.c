/*
 * processors.c: work that is shared by all processors.
 */
#include "compiler/base/parallel.h"

#include <pthread.h>
#include <sched.h>
#include <stdbool.h>

typedef struct Part {
    void (*work)(void *task, size_t part, size_t parts);
    void     *task;
    size_t    number, parts;
    pthread_t thread;
    bool      started;
} Part;

static void *run_part(void *data)
{
    const Part *part = data;
    part->work(part->task, part->number, part->parts);
    return NULL;
}

size_t parallel_parts(void)
{
    cpu_set_t processors;
    if (sched_getaffinity(0, sizeof processors, &processors) != 0)
        return 1;
    size_t count = (size_t)CPU_COUNT(&processors);
    return count < MAX_PARTS ? count : MAX_PARTS;
}

void run_in_parallel(void (*work)(void *task, size_t part, size_t parts), void *task)
{
    Part   all[MAX_PARTS];
    size_t parts = parallel_parts();
    for (size_t i = 0; i < parts; i++)
        all[i] = (Part){.work = work, .task = task, .number = i, .parts = parts};
    for (size_t i = 1; i < parts; i++)
        all[i].started = pthread_create(&all[i].thread, NULL, run_part, &all[i]) == 0;
    for (size_t i = 0; i < parts; i++)
        if (!all[i].started)
            run_part(&all[i]);
    for (size_t i = 1; i < parts; i++)
        if (all[i].started)
            pthread_join(all[i].thread, NULL);
}
