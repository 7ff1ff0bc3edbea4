/*
 * triangles.c: a tree and a terrain of ever more triangle equivalents, in turns.
 */
#include "bench/triangles.h"

#include <math.h>

#include "bench/krs.h"
#include "bench/subject.h"

const char *const growing_names[GROWING_COUNT] = {"tree", "terrain"};

/* The paper's table. */
const TriangleRow triangle_rows[] = {
    {6, {21, NAN}},  {12, {37, NAN}}, {18, {50, 47}},  {20, {54, 93}},  {22, {58, 146}},
    {24, {61, 191}}, {26, {64, 250}}, {28, {65, 300}}, {30, {68, 355}}, {32, {71, 397}},
};
enum { ROWS = sizeof triangle_rows / sizeof *triangle_rows };

static const struct GrowingRow {
    const char *path;
    uint32_t    doublings; /* of one shader, or one facet */
} growing_rows[GROWING_COUNT] = {
    {"bench/scenes/tree28.krs", BRANCH_DOUBLINGS},
    {"bench/scenes/terrain.krs", FACET_DOUBLINGS},
};

/* What the paper has no figure for, and what is less than one shader, is left out. */
static bool is_there(const TriangleRow *row, int scene)
{
    return !isnan(row->paper_us[scene]) && row->doublings > growing_rows[scene].doublings;
}

static Line line_of(const double *times, size_t count)
{
    double doublings[MAX_EQUIVALENTS], there[MAX_EQUIVALENTS];
    size_t kept = 0;
    for (size_t i = 0; i < count; i++)
        if (!isnan(times[i])) {
            doublings[kept] = triangle_rows[i].doublings;
            there[kept++]   = times[i];
        }
    return line_through(doublings, there, kept);
}

static void run_row(Bench *bench, Triangles *triangles, size_t at)
{
    Subject                subjects[GROWING_COUNT];
    Times                 *runs[GROWING_COUNT];
    const KrsRenderOptions options = {.error = PERMITTED_ERROR};
    const TriangleRow     *row     = &triangle_rows[at];
    for (int i = 0; i < GROWING_COUNT; i++) {
        KrsRenderStats stats;
        runs[i] = arena_new_array(bench->arena, Times, bench->repeats);
        if (!is_there(row, i))
            continue;
        subject_open(bench, &subjects[i], growing_rows[i].path,
                     row->doublings - growing_rows[i].doublings);
        subject_prewarm(bench, &subjects[i], &options, &stats);
    }
    for (size_t repeat = 0; repeat < bench->repeats; repeat++)
        for (int i = 0; i < GROWING_COUNT; i++)
            if (is_there(row, i))
                runs[i][repeat] = subject_render(bench, &subjects[i], &options, NULL, NULL);
    for (int i = 0; i < GROWING_COUNT; i++) {
        triangles->ns_per_ray[i][at] = NAN;
        if (!is_there(row, i))
            continue;
        Times times                  = times_median(runs[i], bench->repeats);
        triangles->ns_per_ray[i][at] = march_ms(&times) * 1e6 /
                                       ((double)bench->width * bench->height);
        subject_close(&subjects[i]);
    }
}

void triangles_run(Bench *bench, Triangles *triangles)
{
    *triangles = (Triangles){.count = bench->quick ? 2 : ROWS};
    tell("rays by triangle equivalents");
    for (size_t i = 0; i < triangles->count; i++)
        run_row(bench, triangles, i);
    for (int k = 0; k < GROWING_COUNT; k++) {
        double theirs[ROWS];
        for (size_t i = 0; i < ROWS; i++)
            theirs[i] = triangle_rows[i].paper_us[k];
        triangles->lines[k]       = line_of(triangles->ns_per_ray[k], triangles->count);
        triangles->paper_lines[k] = line_of(theirs, ROWS);
    }
}
