/*
 * info.c: `krs info`: what a scene consists of and costs.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/info.h"

static void print_vector(const double *values, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        printf("%s%.6g", i == 0 ? (count > 1 ? "[" : "") : ", ", values[i]);
    }
    fputs(count > 1 ? "]" : "", stdout);
}

/* Bounds of a component, and components of a loop, that are printed at most; JSON has all. */
enum { MAX_LINES = 48, MAX_ALIKE = 50 };

static bool is_box(const KrsBound *bound)
{
    for (int i = 0; i < 3; i++)
        if (!isfinite(bound->low[i]) || !isfinite(bound->high[i]))
            return false;
    return true;
}

/* Prints a line such as "torus ring.krs:4:6 exact, by claim; box [..] to [..]". */
static void print_bound(const KrsBound *bound, size_t number)
{
    printf("    %3zu  %*s%s", number, 2 * (int)bound->depth, "", bound->name);
    if (bound->line > 0)
        printf("  %s:%u:%u", bound->source, bound->line, bound->column);
    printf("  %s", bound->rule);
    if (bound->slope > 1 + 1e-9)
        printf("; slope %.4g, divided out at the end", bound->slope);
    if (is_box(bound)) {
        fputs("; box ", stdout);
        print_vector(bound->low, 3);
        fputs(" to ", stdout);
        print_vector(bound->high, 3);
    }
    if (bound->levels > 0)
        printf("; %u levels, %.0f instances", bound->levels, bound->instances);
    if (bound->same > 0)
        printf("; as %zu", bound->same);
    if (bound->similar > 0)
        printf("; %u more like it", bound->similar);
    putchar('\n');
}

static void print_bounds(const KrsScene *scene, size_t component)
{
    size_t more, count = krs_bound_count(scene, component, &more), lines = count;
    if (count > MAX_LINES)
        lines = MAX_LINES;
    more += count - lines;
    puts("    distances, by shape:");
    for (size_t i = 0; i < lines; i++) {
        KrsBound bound;
        krs_bound(scene, component, i, &bound);
        print_bound(&bound, i + 1);
    }
    if (more > 0)
        printf("         and %zu more shapes\n", more);
}

static void print_component(const KrsComponent *component, size_t number)
{
    /* Components without a name are called by their number. */
    if (strncmp(component->name, "component ", 10) == 0)
        printf("%s\n    bounds     ", component->name);
    else
        printf("component %zu: %s\n    bounds     ", number, component->name);
    print_vector(component->low, 3);
    fputs(" to ", stdout);
    print_vector(component->high, 3);
    if (component->figure)
        fputs("\n    figure     plane, for `krs slice`; other commands take what is solid", stdout);
    fputs("\n    slope      ", stdout);
    printf("%.6g%s", component->slope, component->slope > 1 + 1e-9 ? ", divided out" : "");
    puts(component->exact       ? " (the distance is exact, by claim)"
         : component->per_state ? " (the distance is a bound, derived for each frame: at first)"
         : component->estimate  ? " (the distance is an estimate: `krs validate` measures it)"
                                : " (the distance is a bound, derived)");
    if (component->levels > 0) {
        printf("    levels     %u\n    instances  ", component->levels);
        printf("%.0f", component->instances);
        putchar('\n');
    }
    if (component->inversions > 0)
        printf("    inversions %u\n", component->inversions);
    printf("    flops      %.1f\n", component->flops);
}

static void print_parameter(const KrsParameter *parameter)
{
    printf("param %s = ", parameter->name);
    const char *unit  = parameter->degrees ? "deg" : "";
    double      scale = parameter->degrees ? 180 / M_PI : 1;
    if (parameter->degrees && parameter->components == 1)
        printf("%.6gdeg", scale * parameter->value[0]);
    else
        print_vector(parameter->value, parameter->components);
    for (uint32_t i = 0; i < parameter->components; i++)
        if (isfinite(parameter->low[i]) || isfinite(parameter->high[i]))
            printf(" in [%.6g%s, %.6g%s]", scale * parameter->low[i], unit,
                   scale * parameter->high[i], unit);
    putchar('\n');
}

/* Prints the first few of many components that are alike. */
static void print_components(const KrsScene *scene)
{
    const size_t count = krs_component_count(scene);
    for (size_t i = 0, end; i < count; i = end) {
        for (end = i; end < count && krs_joined_rank(scene, end) >= MAX_ALIKE;)
            end++;
        if (end > i) {
            printf("components %zu to %zu: %zu more that are alike\n", i + 1, end, end - i);
            continue;
        }
        KrsComponent component;
        krs_component(scene, i, &component);
        print_component(&component, i + 1);
        print_bounds(scene, i);
        end = i + 1;
    }
}

static size_t table_bytes(const KrsProgram *program)
{
    return program->table_rows * sizeof(float[4]) + program->table_cells * sizeof(uint32_t[2]);
}

static void print_tables(const KrsProgram *program)
{
    double bytes = (double)table_bytes(program);
    bool   large = bytes >= 999500;
    printf("tables: %zu %s, %zu rows, %.*f %s\n", program->table_count,
           program->table_count == 1 ? "kind" : "kinds", program->table_instances, large,
           large ? bytes / 1e6 : ceil(bytes / 1e3), large ? "MB" : "kB");
}

static void print_textures(const KrsScene *scene)
{
    for (size_t i = 0; i < krs_texture_count(scene); i++) {
        KrsTexture texture;
        krs_texture(scene, i, &texture);
        printf("texture %s: %u x %u texels, %s\n", texture.file, texture.width, texture.height,
               texture.gray ? "gray" : "colours");
    }
}

static void print_text(const KrsScene *scene)
{
    const KrsProgram *program = krs_scene_program(scene);
    print_components(scene);
    for (size_t i = 0; i < krs_parameter_count(scene); i++) {
        KrsParameter parameter;
        krs_parameter(scene, i, &parameter);
        print_parameter(&parameter);
    }
    for (size_t i = 0; i < krs_state_slope_count(scene); i++) {
        KrsStateSlope slope;
        krs_state_slope(scene, i, &slope);
        printf("slope of each frame: slot %u, of %s\n", slope.slot, slope.location);
    }
    for (size_t i = 0; i < krs_camera_count(scene); i++)
        if (krs_camera_name(scene, i))
            printf("camera %zu: %s\n", i, krs_camera_name(scene, i));
    if (krs_zone_count(scene) > 0)
        printf("zones %zu\n", krs_zone_count(scene));
    if (program->table_count > 0)
        print_tables(program);
    print_textures(scene);
    fputs("bounds ", stdout);
    print_vector(program->low, 3);
    fputs(" to ", stdout);
    print_vector(program->high, 3);
    printf("\noperations %zu\nflops per evaluation ", program->operations);
    printf("%.1f", program->flops);
    if (krs_scene_too_large(scene))
        printf("\ntoo large for shaders: %s", krs_scene_too_large(scene)->message);
    printf("\nhash %s\n", krs_scene_hash(scene));
}

static void add_bound(Json *json, const KrsBound *bound)
{
    json_open(json, NULL, "{");
    json_whole(json, "depth", bound->depth);
    json_text(json, "name", bound->name);
    json_text(json, "source", bound->source);
    json_whole(json, "line", bound->line);
    json_whole(json, "column", bound->column);
    json_text(json, "rule", bound->rule);
    json_number(json, "slope", bound->slope);
    json_numbers(json, "low", bound->low, 3);
    json_numbers(json, "high", bound->high, 3);
    json_truth(json, "exact", bound->exact);
    json_truth(json, "estimate", bound->estimate);
    json_whole(json, "levels", bound->levels);
    json_number(json, "instances", bound->instances);
    json_whole(json, "similar", bound->similar);
    json_whole(json, "same", bound->same);
    json_close(json, "}");
}

/* Adds the tree of a component as a list, parents first; `same` counts its entries from 1. */
static void add_bounds(Json *json, const KrsScene *scene, size_t component)
{
    size_t more, count = krs_bound_count(scene, component, &more);
    json_open(json, "shapes", "[");
    for (size_t i = 0; i < count; i++) {
        KrsBound bound;
        krs_bound(scene, component, i, &bound);
        add_bound(json, &bound);
    }
    json_close(json, "]");
    json_whole(json, "more_shapes", more);
}

static void add_components(Json *json, const KrsScene *scene)
{
    json_open(json, "components", "[");
    for (size_t i = 0; i < krs_component_count(scene); i++) {
        KrsComponent component;
        krs_component(scene, i, &component);
        json_open(json, NULL, "{");
        json_text(json, "name", component.name);
        json_numbers(json, "low", component.low, 3);
        json_numbers(json, "high", component.high, 3);
        json_number(json, "slope", component.slope);
        json_truth(json, "figure", component.figure);
        json_truth(json, "per_frame", component.per_state);
        json_truth(json, "exact", component.exact);
        json_truth(json, "estimate", component.estimate);
        json_whole(json, "levels", component.levels);
        json_number(json, "instances", component.instances);
        json_whole(json, "inversions", component.inversions);
        json_number(json, "flops", component.flops);
        add_bounds(json, scene, i);
        json_close(json, "}");
    }
    json_close(json, "]");
}

static void add_parameters(Json *json, const KrsScene *scene)
{
    json_open(json, "parameters", "[");
    for (size_t i = 0; i < krs_parameter_count(scene); i++) {
        KrsParameter parameter;
        krs_parameter(scene, i, &parameter);
        json_open(json, NULL, "{");
        json_text(json, "name", parameter.name);
        json_numbers(json, "value", parameter.value, parameter.components);
        json_numbers(json, "low", parameter.low, parameter.components);
        json_numbers(json, "high", parameter.high, parameter.components);
        json_close(json, "}");
    }
    json_close(json, "]");
}

/* Adds the slopes that the host finds for each frame, each with its slot in the GLSL. */
static void add_slopes(Json *json, const KrsScene *scene)
{
    json_open(json, "frame_slopes", "[");
    for (size_t i = 0; i < krs_state_slope_count(scene); i++) {
        KrsStateSlope slope;
        krs_state_slope(scene, i, &slope);
        json_open(json, NULL, "{");
        json_whole(json, "slot", slope.slot);
        json_text(json, "place", slope.location);
        json_numbers(json, "low", slope.low, 3);
        json_numbers(json, "high", slope.high, 3);
        json_close(json, "}");
    }
    json_close(json, "]");
}

void info_add_json(Json *json, const KrsScene *scene)
{
    const KrsProgram *program = krs_scene_program(scene);
    info_begin_json(json, scene);
    json_open(json, "bounds", "{");
    json_numbers(json, "low", program->low, 3);
    json_numbers(json, "high", program->high, 3);
    json_close(json, "}");
    json_whole(json, "zones", krs_zone_count(scene));
    json_open(json, "tables", "{");
    json_whole(json, "kinds", program->table_count);
    json_whole(json, "rows", program->table_instances);
    json_whole(json, "bytes", table_bytes(program));
    json_close(json, "}");
    json_whole(json, "operations", program->operations);
    json_number(json, "flops_per_evaluation", program->flops);
    json_truth(json, "too_large", krs_scene_too_large(scene));
    add_components(json, scene);
    add_parameters(json, scene);
    add_slopes(json, scene);
}

void info_begin_json(Json *json, const KrsScene *scene)
{
    json_text(json, "krs", KRS_VERSION);
    json_text(json, "hash", krs_scene_hash(scene));
}

static void print_json(const Options *options, const KrsScene *scene)
{
    Json json = {.text = {.arena = options->arena}, .spaced = true};
    json_open(&json, NULL, "{");
    info_add_json(&json, scene);
    json_close(&json, "}");
    puts(json.text.bytes);
}

/* Options that have a meaning with one of two others alone. */
typedef struct OnlyWith {
    OptionId id;
    bool     print, cost;
} OnlyWith;

KrsStatus info_check_options(const Options *options)
{
    static const OnlyWith rows[] = {
        {OPTION_PRINT_UNITS, .print = true}, {OPTION_AXIS, .print = true},
        {OPTION_PRINT_ERROR, .print = true}, {OPTION_OVERHANG, .print = true},
        {OPTION_NOZZLE, .print = true},      {OPTION_DENSITY, .print = true},
        {OPTION_COMPONENT, .print = true},   {OPTION_WITHIN, .print = true},
        {OPTION_TIME, true, true},           {OPTION_SET, true, true},
        {OPTION_ZONE, true, true},           {OPTION_COST_SIZE, .cost = true},
        {OPTION_COST_CAMERA, .cost = true},  {OPTION_COST_SECONDS, .cost = true},
        {OPTION_COST_RAYS, .cost = true},    {OPTION_DEVICE, .cost = true},
        {OPTION_CACHE, .cost = true}};
    if (options->print && options->cost)
        return say_usage(options, "--print and --cost are two questions; ask one");
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        const OnlyWith *row = &rows[k];
        if (option_is_given(options, row->id) && !(options->print && row->print) &&
            !(options->cost && row->cost))
            return say_usage(options, "--%s is for %s", option_info[row->id].name,
                             !row->cost    ? "the figures of --print"
                             : !row->print ? "the times of --cost"
                                           : "the figures of --print and the times of --cost");
    }
    return KRS_OK;
}

KrsStatus command_info(Options *options)
{
    KrsScene *scene  = NULL;
    KrsStatus status = info_check_options(options);
    if (status == KRS_OK)
        status = scene_open(options, options->files.items[0], &scene);
    if (status == KRS_OK && options->print)
        status = info_print(options, scene);
    else if (status == KRS_OK && options->cost)
        status = info_cost(options, scene);
    else if (status == KRS_OK && options->json)
        print_json(options, scene);
    else if (status == KRS_OK)
        print_text(scene);
    krs_scene_free(scene);
    return status;
}
