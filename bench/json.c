/*
 * json.c: the results as one JSON object.
 */
#include <math.h>

#include "bench/results.h"

/* ---- Members: each ends with a comma, which the end of its object takes back ---- */

static void begin(Text *json, const char *name, const char *bracket)
{
    if (name) {
        text_json(json, name);
        text_add(json, ": ");
    }
    text_add(json, bracket);
}

static void end(Text *json, const char *bracket)
{
    if (json->bytes[json->length - 2] == ',')
        json->bytes[json->length -= 2] = '\0';
    text_add(json, bracket);
    text_add(json, ", ");
}

static void add_text(Text *json, const char *name, const char *value)
{
    text_json(json, name);
    text_add(json, ": ");
    text_json(json, value);
    text_add(json, ", ");
}

/* Six digits, which no time has more of; what is not a number is null. */
static void add_number(Text *json, const char *name, double value)
{
    text_json(json, name);
    text_format(json, isfinite(value) ? ": %.6g, " : ": null, ", value);
}

static void add_truth(Text *json, const char *name, bool value)
{
    text_json(json, name);
    text_add(json, value ? ": true, " : ": false, ");
}

/* ---- Parts ---- */

static void add_times(Text *json, const Entry *entry)
{
    const Times *times = &entry->median;
    begin(json, "ms", "{");
    for (int phase = 0; phase < KRS_PHASE_COUNT && !entry->written; phase++)
        add_number(json, krs_phase_names[phase], times->phase[phase]);
    add_number(json, "total", times->total);
    add_number(json, "without_shadows_and_occlusion", times_without_secondary(times));
    add_number(json, "least", entry->least);
    add_number(json, "wall", times->wall);
    add_number(json, "cpu", times->cpu);
    end(json, "}");
}

static void add_agreement(Text *json, const char *name, const Agreement *agreement)
{
    begin(json, name, "{");
    add_number(json, "hit_differs", agreement->hit_differs);
    add_number(json, "depth_differs", agreement->depth_differs);
    add_number(json, "inside_differs", agreement->inside_differs);
    add_number(json, "inside", agreement->inside);
    add_number(json, "depth_error", agreement->depth_error);
    end(json, "}");
}

static void add_entry(Text *json, const Results *results, const Contest *contest,
                      const Entry *entry)
{
    begin(json, NULL, "{");
    add_text(json, "method", entry->name);
    add_truth(json, "by_hand", entry->written != NULL);
    if (!entry->written) {
        add_text(json, "trace", krs_trace_names[entry->options.methods.trace]);
        add_text(json, "schedule", krs_schedule_names[entry->options.methods.schedule]);
        add_truth(json, "beams", !entry->options.methods.no_beams);
        add_number(json, "gflops", entry->gflops);
        add_number(json, "peak_share", entry->gflops / results->peak.gflops);
    } else {
        add_number(json, "spirv_ms", entry->spirv_ms);
        add_number(json, "pipeline_ms", entry->pipeline_ms);
    }
    add_number(json, "error", entry->error);
    add_times(json, entry);
    add_number(json, "evaluations_per_ray", entry->evaluations_per_ray);
    add_number(json, "ns_per_ray", entry->ns_per_ray);
    add_number(json, "unresolved", entry->unresolved);
    add_number(json, "coverage", entry->coverage);
    add_number(json, "coverage_error", coverage_error(contest, entry->coverage));
    add_agreement(json, "agreement", &entry->agreement);
    end(json, "}");
}

static void add_reference(Text *json, const Contest *contest)
{
    begin(json, "reference", "{");
    add_number(json, "error", REFERENCE_ERROR);
    add_number(json, "coverage", contest->reference_coverage);
    add_number(json, "evaluations_per_ray", contest->reference_evaluations_per_ray);
    add_number(json, "unresolved", (double)contest->reference_unresolved);
    end(json, "}");
}

static void add_ratios(Text *json, const Contest *contest)
{
    const Entry *right = contest->same_coverage;
    begin(json, "by_hand_takes", "{");
    add_number(json, "at_the_same_error", contest_ratio(contest, contest->same_error));
    add_number(json, "at_the_same_error_least", contest_min_ratio(contest, contest->same_error));
    add_number(json, "at_the_same_coverage", right ? contest_ratio(contest, right) : NAN);
    add_number(json, "at_the_same_coverage_least", right ? contest_min_ratio(contest, right) : NAN);
    add_number(json, "error_for_the_same_coverage", right ? right->error : NAN);
    end(json, "}");
}

static void add_contest(Text *json, const Results *results, const Contest *contest)
{
    begin(json, NULL, "{");
    add_text(json, "name", contest->row->name);
    add_text(json, "scene", contest->row->path);
    add_number(json, "flops_per_evaluation", contest->flops_per_evaluation);
    begin(json, "first_use", "{");
    add_number(json, "spirv_ms", contest->entries[0].spirv_ms);
    add_number(json, "pipeline_ms", contest->entries[0].pipeline_ms);
    end(json, "}");
    add_reference(json, contest);
    add_agreement(json, "by_hand_at_the_reference_error", &contest->geometry);
    begin(json, "entries", "[\n      ");
    for (size_t i = 0; i < contest->count; i++) {
        add_entry(json, results, contest, &contest->entries[i]);
        text_add(json, i + 1 < contest->count ? "\n      " : "");
    }
    end(json, "]");
    add_ratios(json, contest);
    end(json, "}");
}

static void add_line(Text *json, const char *name, const Line *line)
{
    begin(json, name, "{");
    add_number(json, "slope", line->slope);
    add_number(json, "intercept", line->intercept);
    add_number(json, "r2", line->r2);
    end(json, "}");
}

static void add_growth(Text *json, const Growth *growth)
{
    begin(json, "growth", "{");
    begin(json, "trees", "[");
    for (size_t i = 0; i < growth->count; i++) {
        begin(json, NULL, "{");
        add_number(json, "levels", growth->levels[i]);
        add_number(json, "ns_per_distance", growth->ns_per_distance[i]);
        add_number(json, "ns_per_evaluation", growth->ns_per_evaluation[i]);
        add_number(json, "ms", growth->total_ms[i]);
        end(json, "}");
    }
    end(json, "]");
    add_line(json, "ns_per_distance", &growth->distance_line);
    add_line(json, "ns_per_evaluation", &growth->evaluation_line);
    add_line(json, "ms", &growth->total_line);
    end(json, "}");
}

static void add_sequences(Text *json, const Bench *bench, const Results *results)
{
    const Sequences *sequences = &results->sequences;
    begin(json, "sequences", "[");
    for (int k = 0; k < STAND_COUNT; k++) {
        begin(json, NULL, "{");
        add_text(json, "scene", stand_rows[k].name);
        begin(json, "by_levels", "[");
        for (size_t i = 0; i < sequences->count; i++) {
            if (isnan(sequences->ms[k][i]))
                continue;
            begin(json, NULL, "{");
            add_number(json, "levels", sequences->levels[i]);
            add_number(json, "flops", sequences->flops[k][i]);
            add_number(json, "evaluations_per_ray", sequences->evaluations[k][i]);
            add_number(json, "beams_ms", sequences->beams_ms[k][i]);
            add_number(json, "ms", sequences->ms[k][i]);
            add_number(json, "cpu_ms", sequences->cpu_ms[k][i]);
            add_number(json, "coverage", sequences->coverage[k][i]);
            end(json, "}");
        }
        end(json, "]");
        add_line(json, "ms_by_levels", &sequences->lines[k]);
        end(json, "}");
    }
    end(json, "]");
    begin(json, "paper", "[");
    for (int i = 0; i < PAPER_ROWS; i++) {
        begin(json, NULL, "{");
        add_text(json, "case", paper_rows[i].name);
        add_number(json, "levels", paper_rows[i].levels);
        add_number(json, "paper_kiloflops_per_ray", paper_rows[i].kiloflops);
        add_number(json, "kiloflops_per_ray",
                   paper_row_ours(bench, sequences, &paper_rows[i], results->peak.gflops));
        end(json, "}");
    }
    end(json, "]");
}

static void add_triangles(Text *json, const Triangles *triangles)
{
    begin(json, "triangles", "[");
    for (size_t i = 0; i < triangles->count; i++) {
        begin(json, NULL, "{");
        add_number(json, "doublings", triangle_rows[i].doublings);
        for (int k = 0; k < GROWING_COUNT; k++) {
            begin(json, growing_names[k], "{");
            add_number(json, "ns", triangles->ns_per_ray[k][i]);
            add_number(json, "paper_us", triangle_rows[i].paper_us[k]);
            end(json, "}");
        }
        end(json, "}");
    }
    end(json, "]");
}

void results_json(const Bench *bench, const Results *results, Text *json)
{
    begin(json, NULL, "{\n  ");
    add_text(json, "date", results->date);
    add_truth(json, "quick", bench->quick);
    begin(json, "machine", "{");
    for (size_t i = 0; i < results->machine.count; i++)
        add_text(json, results->machine.facts[i].name, results->machine.facts[i].text);
    end(json, "}");
    add_number(json, "peak_gflops", results->peak.gflops);
    add_number(json, "width", bench->width);
    add_number(json, "height", bench->height);
    add_number(json, "repeats", bench->repeats);
    add_number(json, "error", PERMITTED_ERROR);
    begin(json, "scenes", "[\n    ");
    for (size_t i = 0; i < results->contest_count; i++) {
        add_contest(json, results, &results->contests[i]);
        text_add(json, i + 1 < results->contest_count ? "\n    " : "");
    }
    end(json, "]");
    add_growth(json, &results->growth);
    add_sequences(json, bench, results);
    add_triangles(json, &results->triangles);
    begin(json, "questions", "{");
    for (int i = 0; i < ANSWERER_COUNT; i++) {
        begin(json, answerer_names[i], "{");
        add_number(json, "points_per_second", results->questions.points_per_second[i]);
        add_number(json, "rays_per_second", results->questions.rays_per_second[i]);
        end(json, "}");
    }
    add_number(json, "alone_ms", results->questions.alone_ms);
    add_number(json, "disagree", results->questions.disagree);
    end(json, "}");
    begin(json, "first_picture", "{");
    add_number(json, "cold_ms", results->latency.cold_ms);
    add_number(json, "warm_ms", results->latency.warm_ms);
    end(json, "}");
    add_text(json, "faults", results->faults.length > 0 ? results->faults.bytes : "");
    end(json, "}");
    json->bytes[json->length -= 2] = '\0';
    text_add(json, "\n");
}
