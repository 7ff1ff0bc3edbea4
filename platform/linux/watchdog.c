/*
 * watchdog.c: how long a process has worked, and how long without progress.
 */
#include "compiler/base/watchdog.h"

#include <dirent.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "compiler/base/clock.h"
#include "compiler/base/minmax.h"

static double count_work(const ProcessSample *before, const ProcessSample *now)
{
    const double passed = min2(max2(now->now - before->now, 0), WATCHDOG_LONGEST_GAP);
    const double used   = max2(now->processor - before->processor, 0);
    if (now->idle || before->idle || now->stopped)
        return 0;
    return now->runnable ? min2(used, passed) : passed;
}

void watchdog_add(Watchdog *watchdog, const ProcessSample *sample)
{
    const double work = watchdog->begun ? count_work(&watchdog->last, sample) : 0;
    watchdog->worked += work;
    watchdog->fruitless += work;
    if (sample->progress != watchdog->last.progress)
        watchdog->fruitless = 0;
    watchdog->last  = *sample;
    watchdog->begun = true;
}

/* Returns the letter of proc(5) for what a thread does; 0: nobody knows. */
static char state_of_thread(int threads, const char *number)
{
    char    path[64], text[512];
    ssize_t length = -1;
    snprintf(path, sizeof path, "%.32s/stat", number);
    int file = openat(threads, path, O_RDONLY | O_CLOEXEC);
    if (file >= 0) {
        length = read(file, text, sizeof text - 1);
        close(file);
    }
    text[length > 0 ? length : 0] = '\0';
    /* "12 (name) S ...": a name may have brackets and blanks. */
    const char *behind = strrchr(text, ')');
    return behind && behind[1] == ' ' ? behind[2] : '\0';
}

/* Sees what the threads of a process do. */
static void look_at_threads(pid_t process, ProcessSample *sample)
{
    char path[64];
    snprintf(path, sizeof path, "/proc/%ld/task", (long)process);
    DIR        *listing = opendir(path);
    const pid_t own     = gettid();
    if (!listing)
        return;
    for (const struct dirent *found; (found = readdir(listing));) {
        if (found->d_name[0] == '.' || atol(found->d_name) == own)
            continue;
        const char state = state_of_thread(dirfd(listing), found->d_name);
        sample->runnable = sample->runnable || state == 'R';
        sample->stopped  = sample->stopped || state == 'T' || state == 't';
    }
    closedir(listing);
}

void watchdog_sample(pid_t process, const ProcessSample *before, ProcessSample *sample)
{
    clockid_t processor;
    sample->now       = clock_seconds(CLOCK_MONOTONIC);
    sample->processor = clock_getcpuclockid(process, &processor) == 0 ? clock_seconds(processor)
                                                                      : 0;
    sample->stopped   = false;
    sample->runnable  = sample->processor - before->processor >= sample->now - before->now;
    if (!sample->runnable)
        look_at_threads(process, sample);
}
