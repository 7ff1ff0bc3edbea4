/*
 * contest.h: all ways to render one scene, against each other.
 */
#ifndef KRS_BENCH_CONTEST_H
#define KRS_BENCH_CONTEST_H

#include "bench/handwritten.h"
#include "bench/peak.h"
#include "bench/subject.h"

typedef struct SceneRow {
    const char *name, *path;
    uint32_t    levels;
    bool        quick;
    const char *handwritten;
} SceneRow;
extern const SceneRow scene_rows[];
extern const size_t   scene_count;

/* One way to render the scene, and what came of it. */
typedef struct Entry {
    char             name[48];
    KrsRenderOptions options; /* ours */
    Handwritten     *written; /* or a shader by hand */
    double           error;   /* permitted, in pixels */
    Times           *runs, median;
    double           least; /* of the runs, without shadows and occlusion */
    KrsRenderStats   stats; /* of ours: of the last run */
    double           evaluations_per_ray, unresolved;
    double           ns_per_ray; /* without shadows and occlusion */
    double           gflops;     /* of ours: of beams and primary rays */
    double           coverage;
    Agreement        agreement;             /* with the reference */
    double           spirv_ms, pipeline_ms; /* to the first picture, cold; of ours: the first */
} Entry;

typedef struct Contest {
    const SceneRow *row;
    Entry          *entries;
    size_t          count, methods; /* ours come first */
    double          flops_per_evaluation;
    double          reference_coverage, reference_evaluations_per_ray;
    uint64_t        reference_unresolved;
    const Entry    *same_error;    /* by hand, with the permitted error of ours */
    const Entry    *same_coverage; /* by hand, with the largest error that covers what the
                                      reference does within COVERAGE_TOLERANCE; or NULL */
    Agreement       geometry;      /* of the shader by hand at the reference's error with it */
} Contest;

/* What a picture may differ from the reference by, to be right. */
#define COVERAGE_TOLERANCE 0.01 /* of the reference's coverage, for a shader by hand */
#define METHOD_TOLERANCE   0.01 /* the same for ours, at the permitted error */
#define QUICK_TOLERANCE    0.02 /* the same in a quick run, whose pixels are four times as wide */
#define INSIDE_TOLERANCE   1e-3 /* share of the pixels, away from edges */
#define DEPTH_TOLERANCE    0.01 /* of a pixel's width, by hand at the reference's error */

void contest_run(Bench *bench, const SceneRow *row, Contest *contest);

/* What is not as it should be, a line each; none when all is right. */
void contest_judge(const Bench *bench, const Contest *contest, Text *faults);

/* Returns how many times longer the shader by hand takes for what both do: by medians, and by the
   least. */
double contest_ratio(const Contest *contest, const Entry *written);
double contest_min_ratio(const Contest *contest, const Entry *written);
/* Returns by how much of the reference's coverage this one is above it. */
double coverage_error(const Contest *contest, double coverage);

#endif
