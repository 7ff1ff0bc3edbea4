/*
 * contest.h: what the files of the contest of algebraic surfaces share.
 */
#ifndef KRS_BENCH_ALGEBRAIC_H
#define KRS_BENCH_ALGEBRAIC_H

#include <stdbool.h>
#include <stddef.h>

#include "bench/algebraic/polynomial.h"

enum {
    WIDTH        = 1280,
    HEIGHT       = 720,
    MAX_REPEATS  = 15,
    MAX_PROGRAMS = 8,
    MAX_SUBJECTS = 16,
    FOLDER_ROOM  = 64
};

typedef struct Subject {
    const char *name, *call, *oracle;
    int         degree;
    double      radius;
    const char *text; /* of the polynomial */
} Subject;

extern const Definition definitions[]; /* what the texts may use */

/* The view: parallel rays, a window of this height, the axes of the picture. */
typedef struct View {
    double right[3], up[3], back[3], height, distance;
} View;

/* Pixels that are not what they should be. */
typedef struct Judgement {
    size_t asked, missed, extra; /* of the pixels that are looked at */
    size_t apart;                /* of the latter two, not at an outline */
} Judgement;

_Noreturn void give_up(const char *what, const char *why);

/* Prints, and keeps it for the results. */
void say(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* Returns the median of numbers, which are put into order. */
double middle(double *numbers, size_t count);

/* ---- programs.c ---- */
/* A run of a program, from its start to its end. */
typedef struct Run {
    double    wall, cpu; /* ms */
    double    frame;     /* ms of all threads, by its own statistics; 0: it tells none */
    double    memory;    /* MB, the most that was resident */
    double    coverage;  /* share of the pixels that are not background */
    Judgement judgement;
} Run;

typedef struct Program {
    const char *name, *command; /* in PATH */
    bool (*run)(const struct Program *program, const char *folder, const Subject *subject,
                const View *view, Run *run);
    int  largest_degree, min_degree;
    bool slow; /* once is enough */
} Program;

extern const Program programs[];
extern const size_t  program_count;

bool program_is_installed(const char *command);
/* Runs a command and waits; false when it fails. */
bool run_command(char *const *arguments, const char *output, Run *run);
/* The share of the pixels of a PPM that are not black; which, of one in sixteen, if asked for. */
bool read_picture(const char *path, double *coverage, bool *seen);
/* The same of a PNG. */
void read_png(const char *path, double *coverage, bool *seen);

#endif
