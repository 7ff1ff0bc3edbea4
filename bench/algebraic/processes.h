/*
 * processes.h: whole programs, from their start to their end.
 */
#ifndef KRS_BENCH_ALGEBRAIC_PROCESSES_H
#define KRS_BENCH_ALGEBRAIC_PROCESSES_H

#include "bench/algebraic/contest.h"

/* What a frame of ours takes by the default, and shows. */
typedef struct Frame {
    double    cpu, stencil_cpu, coverage;
    Judgement judgement;
} Frame;

typedef struct Runs {
    Run    median; /* once they are settled */
    size_t count;
    double wall[MAX_REPEATS], cpu[MAX_REPEATS], frame[MAX_REPEATS], memory[MAX_REPEATS];
} Runs;

void runs_take(Runs *runs, const Run *run);
void runs_settle(Runs *runs);

/* A fresh folder, where also all caches are from now on; and away with it. */
void folder_make(char path[FOLDER_ROOM]);
void folder_remove(const char *path);

/* Has krs render a text; with caches in the folder's subfolder of this name. */
void run_krs(const char *krs, const char *folder, const char *cache, const char *text,
             char *const *options, Run *run);

/* Ours: with nothing cached, with all that leaves, and with normals by differences. */
enum { COLD, WARM, STENCIL, OURS };

/* What a surface has taken. */
typedef struct Processes {
    Runs ours[OURS], others[MAX_PROGRAMS];
} Processes;

/*
 * A surface by krs and by all other programs, in turns.  A process counts as its own what its
 * parent had in memory when it began, so this comes before all that needs much.
 */
void processes_run(Processes *processes, const char *krs, const Subject *subject, const View *view,
                   const char *text, size_t repeats);
void processes_print(Processes *processes, const Subject *subject, const Frame *frame);

/* ---- trees.c ---- */
/* A tree by krs, with 28 levels and fewer, and one that is written out, by POV-Ray. */
typedef struct Trees {
    size_t branches; /* of the latter; 0: nothing has run */
    Runs   ours[2], written;
} Trees;

void trees_run(Trees *trees, const char *krs, size_t repeats);
void trees_print(Trees *trees);

/* ---- julias.c ---- */
/* A Julia set by krs and by POV-Ray, and what their pictures get wrong. */
typedef struct Julias {
    Runs      ours, pov;
    Judgement judged[2];
} Julias;

void julias_run(Julias *julias, const char *krs, size_t repeats);
void julias_print(Julias *julias);

#endif
