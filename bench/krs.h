/*
 * krs.h: sequences, Moebius sequences and compounds of eight against their levels: figure 12 of the
 * KRS paper of 2016.
 */
#ifndef KRS_BENCH_KRS_H
#define KRS_BENCH_KRS_H

#include "bench/bench.h"
#include "bench/measure.h"

enum { MAX_LEVELS = 8, MAX_REPEATS = 3 };

typedef enum Stand {
    STAND_TREE_STRAIGHTFORWARD,
    STAND_TREE_BEAMS,
    STAND_TREE,
    STAND_STRAIGHT,
    STAND_BENT_STRAIGHTFORWARD,
    STAND_BENT_BINARY,
    STAND_BENT_PREDICTED,
    STAND_BENT_DIRECTIONAL,
    STAND_BENT_PLAIN,
    STAND_BENT,
    STAND_BUNDLE,
    STAND_COMPOUND_TOGETHER,
    STAND_COMPOUND_PACKED,
    STAND_COMPOUND,
    STAND_BUNDLE_NEAR,
    STAND_THICKET_TOGETHER,
    STAND_THICKET_PACKED,
    STAND_THICKET,
    STAND_COUNT
} Stand;

typedef struct StandRow {
    const char      *name, *path;
    uint32_t         max_levels; /* what has more is left out: it takes minutes */
    Stand            yardstick;  /* what its time is told beside; itself for none */
    KrsRenderOptions options;
} StandRow;
extern const StandRow stand_rows[STAND_COUNT];

/* What is not a number was left out. */
typedef struct Sequences {
    size_t count, repeats; /* numbers of levels; pictures of each */
    double levels[MAX_LEVELS];
    double ms[STAND_COUNT][MAX_LEVELS];     /* beams, primary rays and normals: the median */
    double cpu_ms[STAND_COUNT][MAX_LEVELS]; /* of all threads, for the whole picture */
    double beams_ms[STAND_COUNT][MAX_LEVELS];
    double coverage[STAND_COUNT][MAX_LEVELS];
    double flops[STAND_COUNT][MAX_LEVELS];       /* of a distance */
    double evaluations[STAND_COUNT][MAX_LEVELS]; /* for a ray */
    Line   lines[STAND_COUNT];                   /* of ms by the levels */
    double unresolved;
} Sequences;

void sequences_run(Bench *bench, Sequences *sequences);
/* Compounds cover what they should, however they are marched, and so do Moebius sequences. */
void sequences_judge(const Sequences *sequences, Text *faults);

/* Beams, primary rays and normals. */
double march_ms(const Times *times);

/* 15 pictures of 1920x1200 a second on 6.1 TFLOP/s (section 11): nanoseconds a ray times the peak
   of the device, which is what a ray may cost, in thousands of operations.  Its low-resolution
   phase makes that 1.3 to 1.5 times as fast; what is held against us is the faster end. */
#define PAPER_KILOFLOPS (1e9 / 15 / (1920.0 * 1200) * 6.1)
#define PAPER_SPEEDUP   1.5

/* What the paper says of figure 12, in the order of its five cases. */
typedef struct PaperRow {
    const char *name;  /* what was measured there */
    Stand       stand; /* of ours */
    double      levels;
    double      kiloflops; /* a ray, there */
} PaperRow;
enum { PAPER_ROWS = 4 };
extern const PaperRow paper_rows[PAPER_ROWS];

/* Returns the kiloflops that ours could do while it traces a ray; NAN when it did not run. */
double paper_row_ours(const Bench *bench, const Sequences *sequences, const PaperRow *row,
                      double peak_gflops);

#endif
