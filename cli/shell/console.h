/*
 * console.h: what the command says to people, always on standard error.
 */
#ifndef KRS_CONSOLE_H
#define KRS_CONSOLE_H

#include <stdio.h>

#include "cli/options/options.h"

/* Prints "krs: " and the words on a line of their own. */
void say(const char *format, ...) __attribute__((format(printf, 1, 2)));
/* Prints as say does, and then where to look it up; returns KRS_BAD_ARGUMENT. */
KrsStatus say_usage(const Options *options, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Says that there is no such command, and which one may be meant; returns KRS_BAD_ARGUMENT. */
KrsStatus say_no_command(const char *word);

/* Empties the line of a terminal that shows what is being done. */
void console_clear(void);
/* Shows on a terminal what is being done, until a line is printed, or this is called with NULL. */
void console_doing(const Options *options, const char *what);
/* Tells whether colours are wanted on standard error. */
bool console_color(const Options *options);

/* Writes standard output to the last byte; KRS_IO_ERROR and a line when that fails. */
KrsStatus console_finish(void);

/* Returns a name of a file as it is printed: a terminal gets no control characters of it. */
const char *console_name(const Options *options, const char *path);

/* Prints the shortest decimal that reads back as the same double. */
void print_number(FILE *out, double number);

/* Returns the seconds of a clock that only goes forward. */
double clock_now(void);

/* The progress of the work: a bar on a terminal; else, at most once a second, "Progress: 42%". */
typedef struct Progress {
    bool   off, terminal;
    double shown_at;      /* when something was last shown; 0: never */
    int    percent;       /* last shown */
    size_t frame, frames; /* of several frames, the one being made */
} Progress;

void progress_start(Progress *progress, const Options *options, size_t frames);
void progress_show(Progress *progress, double fraction); /* of the current frame */
/* Takes the bar away, so that other words can be said. */
void progress_end(Progress *progress);

#endif
