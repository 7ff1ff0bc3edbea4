/*
 * tables.c: the results as tables that can be read as they are and as Markdown.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "bench/results.h"

/* One column of numbers; what a row has there is told by its index in an array of values. */
typedef struct Column {
    const char *title, *format;
    int         width;
} Column;

static const char dashes[] = "--------------------------------------------------";

/* `first` is the title of the column of names. */
static void add_titles(Text *text, const char *first, int name_width, const Column *columns,
                       size_t count)
{
    text_format(text, "| %-*s |", name_width, first);
    for (size_t i = 0; i < count; i++)
        text_format(text, " %*s |", columns[i].width, columns[i].title);
    text_format(text, "\n|%.*s|", name_width + 2, dashes);
    for (size_t i = 0; i < count; i++)
        text_format(text, "%.*s:|", columns[i].width + 1, dashes);
    text_add(text, "\n");
}

/* What is not a number is left blank. */
static void add_row(Text *text, const char *name, int name_width, const Column *columns,
                    const double *values, size_t count)
{
    text_format(text, "| %-*s |", name_width, name);
    for (size_t i = 0; i < count; i++) {
        Text cell = {.arena = text->arena};
        if (!isnan(values[i]))
            text_format(&cell, columns[i].format, values[i]);
        text_format(text, " %*s |", columns[i].width, cell.length > 0 ? cell.bytes : "");
    }
    text_add(text, "\n");
}

static void tell_machine(const Bench *bench, const Results *results, Text *text)
{
    text_format(text, "# %s on %s\n\n", results->date, results->machine.slug);
    for (size_t i = 0; i < results->machine.count; i++)
        text_format(text, "- %s: %s\n", results->machine.facts[i].name,
                    results->machine.facts[i].text);
    text_format(text, "- peak: %.1f GFLOP/s of multiply-adds, measured\n", results->peak.gflops);
    text_format(text, "\nPictures of %ux%u, medians of %u%s, milliseconds.\n", bench->width,
                bench->height, bench->repeats,
                bench->quick ? " (a quick run: no figures to quote)" : "");
}

enum { NAME_WIDTH = 20, STAND_WIDTH = 24, BESIDE_WIDTH = 48 };

static const Column entry_columns[] = {
    {"beams", "%.0f", 5},
    {"primary", "%.0f", 7},
    {"normals", "%.0f", 7},
    {"shading", "%.0f", 7},
    {"resolve", "%.0f", 7},
    {"**sum**", "%.0f", 7},
    {"shadows", "%.0f", 7},
    {"occl.", "%.0f", 5},
    {"total", "%.0f", 6},
    {"wall", "%.0f", 6},
    {"cpu", "%.0f", 6},
    {"evals/ray", "%.2f", 9},
    {"ns/ray", "%.0f", 7},
    {"GFLOP/s", "%.1f", 7},
    {"of peak", "%.0f%%", 7},
    {"coverage", "%.5f", 8},
    {"error", "%+.2f%%", 8},
    {"unresolved", "%.0f", 10},
    {"differs inside", "%.3f%%", 14},
};
enum { ENTRY_COLUMNS = sizeof entry_columns / sizeof entry_columns[0] };

static void tell_entry(const Results *results, const Contest *contest, const Entry *entry,
                       Text *text)
{
    const Times *t    = &entry->median;
    const double none = NAN, *phase = t->phase;
    const bool   ours = !entry->written;
    const double sum = times_without_secondary(t), gflops = ours ? entry->gflops : none;
    double       values[ENTRY_COLUMNS] = {
              ours ? phase[KRS_PHASE_BEAMS] : none,
        ours ? phase[KRS_PHASE_PRIMARY] : none,
        ours ? phase[KRS_PHASE_NORMALS] : none,
        ours ? phase[KRS_PHASE_SHADING] : none,
        ours ? phase[KRS_PHASE_RESOLVE] : none,
        sum,
        ours ? phase[KRS_PHASE_SHADOWS] : none,
        ours ? phase[KRS_PHASE_OCCLUSION] : none,
        t->total,
        t->wall,
        t->cpu,
        entry->evaluations_per_ray,
        entry->ns_per_ray,
        gflops,
        100 * gflops / results->peak.gflops,
        entry->coverage,
        100 * coverage_error(contest, entry->coverage),
        entry->unresolved,
        100 * entry->agreement.inside_differs,
    };
    add_row(text, entry->name, NAME_WIDTH, entry_columns, values, ENTRY_COLUMNS);
}

static void tell_contest(const Results *results, const Contest *contest, Text *text)
{
    text_format(text, "\n## %s\n\n", contest->row->name);
    const Entry *ours = &contest->entries[0], *by_hand = contest->same_error;
    text_format(text,
                "%.0f flops an evaluation.  To SPIR-V and by the driver, cold: ours %.0f +"
                " %.0f ms, by hand %.0f + %.0f ms.\n",
                contest->flops_per_evaluation, ours->spirv_ms, ours->pipeline_ms, by_hand->spirv_ms,
                by_hand->pipeline_ms);
    text_format(text,
                "Reference: error %g pixels, coverage %.5f, %.1f evaluations a ray,"
                " %.0f rays unresolved; %.1f%% of the picture is away from edges.\n",
                REFERENCE_ERROR, contest->reference_coverage,
                contest->reference_evaluations_per_ray, (double)contest->reference_unresolved,
                100 * contest->geometry.inside);
    text_format(text,
                "By hand, at that error: %.3f%% of the pixels have another fate, %.3f%%"
                " another depth, away from edges %.4f%%; there depth differs by %.1e"
                " of a pixel's width (median).\n\n",
                100 * contest->geometry.hit_differs, 100 * contest->geometry.depth_differs,
                100 * contest->geometry.inside_differs, contest->geometry.depth_error);
    add_titles(text, "method", NAME_WIDTH, entry_columns, ENTRY_COLUMNS);
    for (size_t i = 0; i < contest->count; i++)
        tell_entry(results, contest, &contest->entries[i], text);
}

static void tell_ratios(const Results *results, Text *text)
{
    static const Column columns[] = {
        {"ours: sum", "%.0f", 9}, {"by hand", "%.0f", 8}, {"times", "%.2f", 6},
        {"least", "%.2f", 6},     {"its error", "%g", 9}, {"by hand, right", "%.0f", 14},
        {"times", "%.2f", 6},     {"least", "%.2f", 6},   {"coverage of ours", "%+.2f%%", 16},
    };
    enum { COLUMNS = sizeof columns / sizeof columns[0] };
    text_format(text,
                "\n## Ours (the default) and by hand\n\nBy hand at the same permitted error,"
                " and at the largest one at which its coverage is within %g%% of the"
                " reference's; how many times as long it takes, by the medians and by the"
                " least of the runs.\n\n",
                100 * COVERAGE_TOLERANCE);
    add_titles(text, "scene", NAME_WIDTH, columns, COLUMNS);
    for (size_t i = 0; i < results->contest_count; i++) {
        const Contest *c               = &results->contests[i];
        const Entry   *right           = c->same_coverage;
        double         values[COLUMNS] = {
                    times_without_secondary(&c->entries[0].median),
                    c->same_error->median.total,
                    contest_ratio(c, c->same_error),
                    contest_min_ratio(c, c->same_error),
            right ? right->error : NAN,
            right ? right->median.total : NAN,
            right ? contest_ratio(c, right) : NAN,
            right ? contest_min_ratio(c, right) : NAN,
                    100 * coverage_error(c, c->entries[0].coverage),
        };
        add_row(text, c->row->name, NAME_WIDTH, columns, values, COLUMNS);
    }
}

static void tell_line(Text *text, const char *what, const Line *line, const char *unit)
{
    text_format(text, "- %s: %.4g %+.4g n %s, R2 %.4f\n", what, line->intercept, line->slope, unit,
                line->r2);
}

static void tell_growth(const Growth *growth, Text *text)
{
    static const Column columns[] = {
        {"ns/distance", "%.2f", 11}, {"ns/evaluation", "%.2f", 13}, {"**sum**", "%.0f", 7}};
    text_add(text, "\n## Growth with the levels n of the tree\n\n");
    add_titles(text, "levels", NAME_WIDTH, columns, 3);
    for (size_t i = 0; i < growth->count; i++) {
        Text name = {.arena = text->arena};
        text_format(&name, "%.0f", growth->levels[i]);
        add_row(text, name.bytes, NAME_WIDTH, columns,
                (double[]){growth->ns_per_distance[i], growth->ns_per_evaluation[i],
                           growth->total_ms[i]},
                3);
    }
    text_add(text, "\n");
    tell_line(text, "distance", &growth->distance_line, "ns");
    tell_line(text, "evaluation", &growth->evaluation_line, "ns");
    tell_line(text, "sum", &growth->total_line, "ms");
}

/* One number of levels; of what was left out with so many there is no row. */
static void tell_levels(const Bench *bench, const Results *results, size_t i, Text *text)
{
    static const Column columns[] = {
        {"flops", "%.0f", 6},  {"evals/ray", "%.2f", 9}, {"coverage", "%.5f", 8},
        {"beams", "%.0f", 5},  {"**sum**", "%.0f", 7},   {"cpu", "%.0f", 6},
        {"ns/ray", "%.0f", 7}, {"kflop/ray", "%.1f", 9},
    };
    enum { COLUMNS = sizeof columns / sizeof columns[0] };
    const Sequences *s = &results->sequences;
    text_format(text, "\n%.0f levels\n\n", s->levels[i]);
    add_titles(text, "scene", STAND_WIDTH, columns, COLUMNS);
    for (int k = 0; k < STAND_COUNT; k++) {
        double ns = s->ms[k][i] * 1e6 / ((double)bench->width * bench->height);
        if (!isnan(ns))
            add_row(text, stand_rows[k].name, STAND_WIDTH, columns,
                    (double[]){s->flops[k][i], s->evaluations[k][i], s->coverage[k][i],
                               s->beams_ms[k][i], s->ms[k][i], s->cpu_ms[k][i], ns,
                               ns * results->peak.gflops / 1e3},
                    COLUMNS);
    }
}

/* The time of each beside that of what it is measured by, a column for each number of levels. */
static void tell_beside(const Sequences *s, Text *text)
{
    char   titles[MAX_LEVELS][24];
    Column columns[MAX_LEVELS];
    for (size_t i = 0; i < s->count; i++) {
        snprintf(titles[i], sizeof titles[i], "%.0f levels", s->levels[i]);
        columns[i] = (Column){titles[i], "%.2f", 9};
    }
    text_add(text, "\nHow many times as long as what it is measured by.  Aims: the Moebius sequence"
                   " within 2 times the similarities, eight trees or the thicket within 1.15 times"
                   " one sequence with as many kernels (the 2016 paper: \"negligible overhead\","
                   " section 11).\n\n");
    add_titles(text, "scene", BESIDE_WIDTH, columns, s->count);
    for (int k = 0; k < STAND_COUNT; k++) {
        double      times[MAX_LEVELS];
        const Stand by   = stand_rows[k].yardstick;
        Text        name = {.arena = text->arena};
        if ((int)by == k)
            continue;
        for (size_t i = 0; i < s->count; i++)
            times[i] = s->ms[k][i] / s->ms[by][i];
        text_format(&name, "%s / %s", stand_rows[k].name, stand_rows[by].name);
        add_row(text, name.bytes, BESIDE_WIDTH, columns, times, s->count);
    }
}

/* What the 2016 paper says of figure 12. */
static void tell_paper(const Bench *bench, const Results *results, Text *text)
{
    static const Column columns[] = {{"levels", "%.0f", 6},
                                     {"paper, kflop/ray", "%.0f", 16},
                                     {"ours, kflop/ray", "%.0f", 15},
                                     {"paper / ours", "%.2f", 12}};
    text_format(text,
                "\nPer TFLOP/s.  A ray's time times the peak of the device: there 15 pictures"
                " of 1920x1200 a second on 6.1 TFLOP/s, 28.9 ns a ray, which a single"
                " sequence keeps up to 28 levels and binary tracing up to 14 (section 11,"
                " figure 12, whose cases are numbered); case 4 is that by %g, the most that"
                " the low-resolution phase is said to gain.  Here the peak is the measured"
                " one.  Case 2, binary tracing of a linear sequence, is nothing that we need;"
                " case 5, the compound, is beside a single sequence above.\n\n",
                PAPER_SPEEDUP);
    add_titles(text, "case", BESIDE_WIDTH, columns, 4);
    for (int i = 0; i < PAPER_ROWS; i++) {
        const PaperRow *row = &paper_rows[i];
        const double ours   = paper_row_ours(bench, &results->sequences, row, results->peak.gflops);
        add_row(text, row->name, BESIDE_WIDTH, columns,
                (double[]){row->levels, row->kiloflops, ours, row->kiloflops / ours}, 4);
    }
}

/* Tells by how much beams shorten the time of two ways to trace the tree. */
static void tell_beams(const Sequences *s, Text *text)
{
    static const Column columns[] = {{"without", "%.0f", 7},
                                     {"with", "%.0f", 7},
                                     {"faster by", "%.0f%%", 9},
                                     {"less time", "%.0f%%", 9},
                                     {"beams of it", "%.0f%%", 11}};
    text_add(text, "\nBeams, our low-resolution phase, over straightforward tracing of the tree;"
                   " the 2016 paper has a speedup of 30 to 50 % (section 11), the 2014 paper 10 to"
                   " 30 % less time (section 4.1):\n\n");
    add_titles(text, "levels", STAND_WIDTH, columns, 5);
    for (size_t i = 0; i < s->count; i++) {
        Text   name    = {.arena = text->arena};
        double without = s->ms[STAND_TREE_STRAIGHTFORWARD][i], with = s->ms[STAND_TREE_BEAMS][i];
        text_format(&name, "%.0f", s->levels[i]);
        add_row(text, name.bytes, STAND_WIDTH, columns,
                (double[]){without, with, 100 * (without / with - 1), 100 * (1 - with / without),
                           100 * s->beams_ms[STAND_TREE_BEAMS][i] / with},
                5);
    }
}

/* Figure 12 of the KRS paper of 2016. */
static void tell_sequences(const Bench *bench, const Results *results, Text *text)
{
    const Sequences *s = &results->sequences;
    text_format(text,
                "\n## Sequences, Moebius sequences and compounds of eight\n\n**sum**: beams,"
                " primary rays and normals; cpu: of all threads, for the whole picture;"
                " kflop/ray: the time of a ray times the peak of the device, measured."
                "  Medians of %zu.\n",
                s->repeats);
    for (size_t i = 0; i < s->count; i++)
        tell_levels(bench, results, i, text);
    tell_beside(s, text);
    tell_beams(s, text);
    if (s->count < 3)
        return;
    tell_paper(bench, results, text);
    text_add(text, "\nAgainst the levels n (the paper's figure 12: linear growth):\n\n");
    for (int k = 0; k < STAND_COUNT; k++)
        tell_line(text, stand_rows[k].name, &s->lines[k], "ms");
}

/* Section 8 of the KRS paper of 2014. */
static void tell_triangles(const Results *results, Text *text)
{
    static const Column columns[] = {
        {"tree, ns/ray", "%.0f", 13},    {"kflop/ray", "%.1f", 9}, {"paper, complex", "%.0f", 14},
        {"terrain, ns/ray", "%.0f", 15}, {"kflop/ray", "%.1f", 9}, {"paper, simple", "%.0f", 13},
    };
    enum { COLUMNS = sizeof columns / sizeof columns[0] };
    const Triangles *triangles = &results->triangles;
    const double     peak      = results->peak.gflops / 1e3;
    text_format(text,
                "\n## A ray against triangles\n\nBeams, primary rays and normals, and the"
                " table of the 2014 paper (section 8), in microseconds as it says.  It does"
                " not say on what: but by microseconds a picture of 1920x1200 would take"
                " minutes, and nanoseconds on 1 TFLOP/s, the least of its time, would be as"
                " many kflop/ray.  A branch of the tree counts as 2^%d triangles, a facet of"
                " the terrain as 2.\n\n",
                BRANCH_DOUBLINGS);
    add_titles(text, "triangles", NAME_WIDTH, columns, COLUMNS);
    for (size_t i = 0; i < triangles->count; i++) {
        const TriangleRow *row     = &triangle_rows[i];
        const double       tree    = triangles->ns_per_ray[GROWING_TREE][i];
        const double       terrain = triangles->ns_per_ray[GROWING_TERRAIN][i];
        Text               name    = {.arena = text->arena};
        text_format(&name, "2^%u", row->doublings);
        add_row(text, name.bytes, NAME_WIDTH, columns,
                (double[]){tree, tree * peak, row->paper_us[GROWING_TREE], terrain, terrain * peak,
                           row->paper_us[GROWING_TERRAIN]},
                COLUMNS);
    }
    if (triangles->count < 3)
        return;
    text_add(text, "\nAgainst the doublings n:\n\n");
    for (int k = 0; k < GROWING_COUNT; k++) {
        tell_line(text, growing_names[k], &triangles->lines[k], "ns");
        tell_line(text, k == GROWING_TREE ? "paper, complex" : "paper, simple",
                  &triangles->paper_lines[k], "us");
    }
}

static void tell_questions(const Questions *questions, Text *text)
{
    static const Column columns[] = {{"points/s", "%.0f", 9}, {"rays/s", "%.0f", 9}};
    text_format(text,
                "\n## Questions\n\nThe tree of 28 levels, %zu at once to the host, %zu to the"
                " device; one ray alone comes back from the device in %.2f ms.\n\n",
                questions->rays[ANSWERER_HOST], questions->rays[ANSWERER_DEVICE],
                questions->alone_ms);
    add_titles(text, "answered by", NAME_WIDTH, columns, 2);
    for (int i = 0; i < ANSWERER_COUNT; i++)
        add_row(text, answerer_names[i], NAME_WIDTH, columns,
                (double[]){questions->points_per_second[i], questions->rays_per_second[i]}, 2);
}

static void tell_latency(const Latency *latency, Text *text)
{
    text_format(text,
                "\n## First picture\n\nexamples/01-hello.krs at 640x360, from starting the"
                " command to its end: %.0f ms cold, %.0f ms with warm caches.\n",
                latency->cold_ms, latency->warm_ms);
}

void results_tables(const Bench *bench, const Results *results, Text *text)
{
    tell_machine(bench, results, text);
    for (size_t i = 0; i < results->contest_count; i++)
        tell_contest(results, &results->contests[i], text);
    if (results->contest_count > 0)
        tell_ratios(results, text);
    if (results->growth.count > 0)
        tell_growth(&results->growth, text);
    if (results->sequences.count > 0)
        tell_sequences(bench, results, text);
    if (results->triangles.count > 0)
        tell_triangles(results, text);
    if (results->questions.rays[ANSWERER_HOST] > 0)
        tell_questions(&results->questions, text);
    if (results->latency.cold_ms > 0)
        tell_latency(&results->latency, text);
    if (results->faults.length > 0)
        text_format(text, "\n## Wrong\n\n%s", results->faults.bytes);
}
