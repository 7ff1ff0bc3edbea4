/*
 * patience.c: how long a process has worked, and how long without progress.
 */
#include "compiler/base/patience.h"

#include <dirent.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "compiler/base/minmax.h"

static double count_work(const Look *before, const Look *now)
{
    const double passed = min2(max2(now->now - before->now, 0), PATIENCE_LONGEST_LOOK);
    const double used   = max2(now->processor - before->processor, 0);
    if (now->idle || before->idle || now->stopped)
        return 0;
    return now->runnable ? min2(used, passed) : passed;
}

void patience_add(Patience *patience, const Look *look)
{
    const double work = patience->begun ? count_work(&patience->last, look) : 0;
    patience->worked += work;
    patience->fruitless += work;
    if (look->progress != patience->last.progress)
        patience->fruitless = 0;
    patience->last  = *look;
    patience->begun = true;
}

static double seconds_of(clockid_t clock)
{
    struct timespec now = {0};
    clock_gettime(clock, &now);
    return (double)now.tv_sec + (double)now.tv_nsec * 1e-9;
}

/* The letter of proc(5) for what a thread does; 0: nobody knows. */
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
static void look_at_threads(pid_t process, Look *look)
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
        look->runnable   = look->runnable || state == 'R';
        look->stopped    = look->stopped || state == 'T' || state == 't';
    }
    closedir(listing);
}

void patience_look(pid_t process, const Look *before, Look *look)
{
    clockid_t processor;
    look->now       = seconds_of(CLOCK_MONOTONIC);
    look->processor = clock_getcpuclockid(process, &processor) == 0 ? seconds_of(processor) : 0;
    look->stopped   = false;
    look->runnable  = look->processor - before->processor >= look->now - before->now;
    if (!look->runnable)
        look_at_threads(process, look);
}
