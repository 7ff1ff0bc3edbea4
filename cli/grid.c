/*
 * grid.c: `krs grid`: samples of a scene.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/shell/console.h"
#include "cli/grid/gridding.h"
#include "cli/mesh/meshing.h"

/* Cells along the longest side, and in a band, where nothing else is asked for. */
static const double USUAL_CELLS = 128, USUAL_BAND = 3;
/* Samples of a file that has all, and bricks of those that are looked at for one that has those near the surface. */
static const double MAX_SAMPLES = 2147483648.0, MAX_BRICKS = 1073741824.0;
/* Along the longest side; the library takes twice as many. */
static const double MAX_CELLS = 0.5 * KRS_MAX_CELLS;

typedef struct GridOutput {
    const char       *path;
    const GridFormat *format;
    GridFile          file;
} GridOutput;

/* Files of the same samples, those that have all or those that have what is near the surface: they are sampled once. */
typedef struct GridGroup {
    GridOutput *outputs;
    size_t      count;
    GridSheet   sheet;
} GridGroup;

enum { GROUPS = 2 };

typedef struct Gridding {
    const Options  *options;
    const KrsScene *scene;
    KrsState       *state;
    Meshing         meshing;        /* what they share with meshes */
    KrsGridOptions  how;            /* but for what a format has */
    GridGroup       groups[GROUPS]; /* all, near */
    KrsGrid        *grid;
    bool            solid; /* some sample is in it */
    Progress        progress;
    double          done, begun, goal; /* of all work: done, and before and after this step of it */
} Gridding;

static bool report_progress(void *user, double fraction)
{
    Gridding *gridding = user;
    double    done     = gridding->begun + fraction * (gridding->goal - gridding->begun);
    gridding->done     = fmax(gridding->done, done);
    progress_show(&gridding->progress, gridding->done);
    return !*interrupted();
}

/* ---- what is asked for ---- */

static size_t file_total(const Gridding *gridding)
{
    return gridding->options->outputs.count ? gridding->options->outputs.count : 1;
}

static const char *file_name(const Gridding *gridding, size_t index)
{
    const Options *options = gridding->options;
    Text           path    = {.arena = options->arena};
    if (options->outputs.count > 0)
        return options->outputs.items[index];
    text_format(&path, "%s.npy", scene_name(options->arena, options->files.items[0]));
    return path.bytes;
}

static KrsStatus check_file(const Gridding *gridding, const char *path)
{
    const Options    *options = gridding->options;
    const GridFormat *format  = grid_format(path);
    if (!format)
        return say_usage(options, "`%s` is no grid: its name must end in " GRID_ENDINGS, path);
    if (options->grid_material && !format->has_material)
        return say_usage(options, "`%s` has no room for numbers of materials; .npy has", path);
    if (options->grid_half && !format->has_half)
        return say_usage(options, "`%s` has no numbers of 16 bits; .vdb, .npy and .ktx2 have",
                         path);
    for (size_t i = 0; i < options->outputs.count && options->outputs.items[i] != path; i++)
        if (output_is_same(options->outputs.items[i], path))
            return say_usage(options, "`%s` and `%s` are one file", options->outputs.items[i],
                             path);
    KrsStatus status = check_output(options, path);
    if (status == KRS_OK && format->begin == grid_begin_vdb)
        status = grid_check_vdb(path);
    return status;
}

static void add_output(Gridding *gridding, const char *path)
{
    const GridFormat *format = grid_format(path);
    GridGroup        *group  = &gridding->groups[format->sparse];
    if (!group->outputs)
        group->outputs = arena_new_array(gridding->options->arena, GridOutput,
                                         file_total(gridding));
    group->outputs[group->count++] = (GridOutput){.path = path, .format = format};
}

static KrsStatus check_options(Gridding *gridding)
{
    const Options *options = gridding->options;
    KrsStatus      status  = KRS_OK;
    if (options->grid_fog && (options->grid_exact || options->grid_band > 0))
        return say_usage(options, "--fog writes no distances, which --exact and --band are about");
    if (options->grid_error > 0 && !options->grid_exact)
        return say_usage(options, "--error is that of --exact");
    for (size_t i = 0; i < file_total(gridding) && status == KRS_OK; i++) {
        const char *path = file_name(gridding, i);
        status           = check_file(gridding, path);
        if (status == KRS_OK)
            add_output(gridding, path);
    }
    return status;
}

/* Says why the library failed. */
static KrsStatus say_failure(const Gridding *gridding, KrsStatus status)
{
    return status == KRS_INTERRUPTED ? status
                                     : say_status(status, gridding->options->files.items[0]);
}

/* Returns a length of two digits, not below this one. */
static double round_up(double length)
{
    double unit = pow(10, floor(log10(length)) - 1);
    return ceil(length / unit - 1e-9) * unit;
}

static KrsStatus refuse_cell(const Gridding *gridding, const char *path, const char *what,
                             double most, double larger)
{
    return say_usage(gridding->options,
                     "`%s` would have %s, and can have %.0f; --cell %.4g has fewer", path, what,
                     most, round_up(larger));
}

/* The length of the longest side tells what the cell is without an option. */
static KrsStatus take_options(Gridding *gridding)
{
    const Options *options = gridding->options;
    Meshing       *meshing = &gridding->meshing;
    double         longest;
    meshing->options = options;
    meshing->scene   = gridding->scene;
    KrsStatus status = check_common_options(meshing);
    if (status != KRS_OK)
        return status;
    gridding->how = (KrsGridOptions){.fog          = options->grid_fog,
                                     .exact        = options->grid_exact,
                                     .error        = options->grid_error,
                                     .materials    = options->grid_color || options->grid_material,
                                     .component    = meshing->how.component,
                                     .within       = meshing->how.within,
                                     .memory_limit = options->limits.memory,
                                     .progress     = report_progress,
                                     .user         = gridding};
    memcpy(gridding->how.low, meshing->how.low, sizeof gridding->how.low);
    memcpy(gridding->how.high, meshing->how.high, sizeof gridding->how.high);
    find_end(meshing, &longest);
    gridding->how.cell = options->grid_cell > 0 ? options->grid_cell
                         : longest > 0          ? longest / USUAL_CELLS
                                                : 1;
    if (longest / gridding->how.cell > MAX_CELLS) {
        char what[64];
        snprintf(what, sizeof what, "%.3g cells along an axis", longest / gridding->how.cell);
        return refuse_cell(gridding, options->files.items[0], what, MAX_CELLS, longest / MAX_CELLS);
    }
    return KRS_OK;
}

/* ---- how large it is ---- */

/* Refuses a grid that is too large for its format before anything is computed. */
static KrsStatus check_size(const Gridding *gridding, const KrsGridShape *shape,
                            const GridOutput *output)
{
    const GridFormat *format = output->format;
    const char       *path   = output->path;
    double longest = 0, samples = 1, most = format->sparse ? 512 * MAX_BRICKS : MAX_SAMPLES;
    char   what[128];
    for (int k = 0; k < 3; k++) {
        longest = fmax(longest, (double)shape->count[k]);
        samples *= (double)shape->count[k];
    }
    snprintf(what, sizeof what, "%zu x %zu x %zu samples", shape->count[0], shape->count[1],
             shape->count[2]);
    if (samples > most)
        return refuse_cell(gridding, path, what, most, shape->cell * cbrt(1.1 * samples / most));
    if (longest > format->max_side) {
        snprintf(what, sizeof what, "%.0f samples along an axis", longest);
        return refuse_cell(gridding, path, what, format->max_side,
                           shape->cell * 1.01 * longest / format->max_side);
    }
    if (shape->cell < format->min_cell)
        return say_usage(gridding->options,
                         "`%s` would have cells of %.3g, and OpenVDB has none below %.3g; other "
                         "files have, or a larger scene",
                         path, shape->cell, format->min_cell);
    return KRS_OK;
}

/* Refuses grids that need too much memory, which grows with the area of the surface. */
static KrsStatus check_memory(Gridding *gridding, GridGroup *group)
{
    GridSheet *sheet  = &group->sheet;
    size_t     limit  = gridding->options->limits.memory;
    double     most   = (double)(limit ? limit : KRS_USUAL_MEMORY);
    KrsStatus  status = krs_grid_count_near(gridding->grid, &sheet->near);
    double     bytes  = (double)sheet->near * (double)group->count *
                   (KRS_BRICK_SAMPLES * (double)grid_sample_bytes(sheet) + 256);
    char what[64];
    if (status != KRS_OK)
        return say_failure(gridding, status);
    if (bytes <= most)
        return KRS_OK;
    snprintf(what, sizeof what, "%.4g MB of samples in memory", bytes * 1e-6);
    return say_usage(gridding->options,
                     "`%s` would have %s, and can have %.4g MB (--limit memory); --cell %.4g has "
                     "fewer",
                     group->outputs[0].path, what, most * 1e-6,
                     round_up(sheet->shape.cell * sqrt(1.1 * bytes / most)));
}

/* Lays the samples out as the files of a group have them. */
static KrsStatus lay_out(Gridding *gridding, const GridGroup *group)
{
    const Options *options = gridding->options;
    bool           sparse  = group == &gridding->groups[true];
    double         usual   = sparse ? USUAL_BAND : 0;
    double band = options->grid_fog ? 0 : options->grid_band > 0 ? options->grid_band : usual;
    return krs_grid_set_band(gridding->grid, band, sparse);
}

static KrsStatus check_group(Gridding *gridding, GridGroup *group)
{
    const Options *options = gridding->options;
    KrsStatus      status  = lay_out(gridding, group);
    if (status == KRS_BAD_ARGUMENT)
        return say_usage(options, "--cell is too small for the size of `%s`",
                         options->files.items[0]);
    int unit     = options->mesh_units < 0 ? find_choice("mm", unit_choices) : options->mesh_units;
    group->sheet = (GridSheet){.shape    = krs_grid_shape(gridding->grid),
                               .fog      = options->grid_fog,
                               .color    = options->grid_color,
                               .material = options->grid_material,
                               .half     = options->grid_half,
                               .metres   = metres_of_units[unit]};
    if (group->sheet.shape.count[0] == 0)
        return say_nothing(&gridding->meshing, "write", NULL, 0);
    for (size_t i = 0; i < group->count && status == KRS_OK; i++)
        status = check_size(gridding, &group->sheet.shape, &group->outputs[i]);
    return status == KRS_OK && group->outputs[0].format->sparse ? check_memory(gridding, group)
                                                                : status;
}

/* The mesh behind exact distances is the first half of the work. */
static KrsStatus open_grid(Gridding *gridding)
{
    const Options *options = gridding->options;
    gridding->goal         = 0.5;
    KrsStatus status       = krs_grid_new(gridding->state, &gridding->how, &gridding->grid);
    if (status == KRS_BAD_ARGUMENT)
        return say_usage(options, "%s is too small for the size of `%s`",
                         gridding->how.error > 0 ? "--error" : "--cell", options->files.items[0]);
    return status == KRS_OK ? KRS_OK : say_failure(gridding, status);
}

/* ---- files ---- */

typedef struct Target {
    Gridding  *gridding;
    GridGroup *group;
    size_t     number; /* of the file */
    KrsStatus *status; /* of the files behind it, and of the samples */
} Target;

static bool add_brick(void *user, const KrsGridBrick *brick)
{
    const Target *target   = user;
    Gridding     *gridding = target->gridding;
    for (int i = 0; i < KRS_BRICK_SAMPLES && !gridding->solid; i++)
        gridding->solid = target->group->sheet.fog ? brick->values[i] > 0 : brick->values[i] <= 0;
    for (size_t i = 0; i < target->group->count; i++) {
        GridOutput *output = &target->group->outputs[i];
        if (!output->format->add(&output->file, brick))
            return false;
    }
    return true;
}

/* Samples a grid; errors of its files are reported with these. */
static KrsStatus sample(Target *target)
{
    const GridGroup *group  = target->group;
    KrsStatus        status = krs_grid_visit(target->gridding->grid, add_brick, target);
    for (size_t i = 0; i < group->count; i++)
        if (group->outputs[i].file.error->status != KRS_OK)
            return group->outputs[i].file.error->status;
    if (status != KRS_OK && status != KRS_INTERRUPTED)
        say("not enough memory for this grid; a larger --cell needs less");
    return status;
}

static KrsStatus write_from(const Target *target);

/* The samples are made when the last file has begun, and each goes to all of them. */
static bool fill_grid(const void *user, OutputFile *file, OutputError *error)
{
    const Target *target = user;
    GridGroup    *group  = target->group;
    GridOutput   *output = &group->outputs[target->number];
    output->file         = (GridFile){.sheet = &group->sheet,
                                      .file  = file,
                                      .error = error,
                                      .arena = target->gridding->options->arena};
    if (!output->format->begin(&output->file))
        return false;
    Target next     = *target;
    next.number     = target->number + 1;
    *target->status = next.number == group->count ? sample(&next) : write_from(&next);
    if (*target->status != KRS_OK && error->status == KRS_OK)
        error->status = KRS_INTERRUPTED; /* what else it was has been said */
    return *target->status == KRS_OK && output->format->end(&output->file);
}

/* Writes the files of a group from this one on. */
static KrsStatus write_from(const Target *target)
{
    KrsStatus made   = KRS_OK;
    Target    own    = *target;
    own.status       = &made;
    KrsStatus status = write_output(own.group->outputs[own.number].path, fill_grid, &own);
    return made == KRS_OK ? status : made;
}

static KrsStatus write_group(Gridding *gridding, GridGroup *group)
{
    KrsStatus status = lay_out(gridding, group);
    return status == KRS_OK ? write_from(&(Target){gridding, group, 0, NULL}) : status;
}

static KrsStatus write_groups(Gridding *gridding)
{
    double    files  = 0;
    KrsStatus status = KRS_OK;
    gridding->begun  = gridding->options->grid_exact ? gridding->goal : 0;
    for (int i = 0; i < GROUPS && status == KRS_OK; i++) {
        GridGroup *group = &gridding->groups[i];
        if (group->count == 0)
            continue;
        files += (double)group->count;
        double part     = files / (double)file_total(gridding);
        double begun    = gridding->options->grid_exact ? 0.5 : 0;
        gridding->goal  = begun + (1 - begun) * part;
        status          = write_group(gridding, group);
        gridding->begun = gridding->goal;
    }
    return status;
}

static KrsStatus make_grid(Gridding *gridding)
{
    stage_enter(STAGE_GRID);
    progress_start(&gridding->progress, gridding->options, 1);
    KrsStatus status = open_grid(gridding);
    for (int i = 0; i < GROUPS && status == KRS_OK; i++)
        if (gridding->groups[i].count > 0)
            status = check_group(gridding, &gridding->groups[i]);
    if (status == KRS_OK)
        status = write_groups(gridding);
    progress_end(&gridding->progress);
    return status;
}

static void warn(const Gridding *gridding, const KrsGridShape *shape)
{
    const double *at = shape->unresolved_at;
    if (shape->estimate)
        say("warning: the distance is an estimate, so nothing is proven of it");
    if (!gridding->solid)
        say("warning: no sample is in what is solid, which is thinner than cells are; a smaller "
            "--cell finds it");
    if (shape->unresolved > 0)
        say("warning: in %zu places distances may be too long, by what is thinner than the error; "
            "the first is at [%g, %g, %g]; a smaller --error tells",
            shape->unresolved, at[0], at[1], at[2]);
}

static void report(const Gridding *gridding, const GridGroup *group)
{
    const KrsGridShape *shape = &group->sheet.shape;
    Text                of    = {.arena = gridding->options->arena};
    char                what[128], rounding[64] = "";
    if (group->sheet.fog)
        snprintf(what, sizeof what, "densities");
    else if (shape->estimate)
        snprintf(what, sizeof what, "distances are estimates");
    else if (gridding->options->grid_exact)
        snprintf(what, sizeof what, "distances at most %.4g below the true ones", shape->error);
    else
        snprintf(what, sizeof what, "distances never above the true ones%s",
                 shape->outside ? ", and exact outside" : "; --exact computes these");
    if (group->sheet.half)
        snprintf(rounding, sizeof rounding, ", rounded by a 1024th at most");
    for (size_t i = 0; i < group->count && file_total(gridding) > group->count; i++)
        text_format(&of, "%s`%s`", i == 0 ? "" : ", ", group->outputs[i].path);
    if (of.length > 0)
        text_format(&of, ": ");
    say("%s%zu x %zu x %zu samples from [%.9g, %.9g, %.9g] on, %g apart; %s%s",
        of.length > 0 ? of.bytes : "", shape->count[0], shape->count[1], shape->count[2],
        (double)shape->first[0] * shape->cell, (double)shape->first[1] * shape->cell,
        (double)shape->first[2] * shape->cell, shape->cell, what, rounding);
}

static void report_all(const Gridding *gridding)
{
    bool warned = gridding->options->quiet;
    for (int i = 0; i < GROUPS; i++) {
        const GridGroup *group = &gridding->groups[i];
        if (group->count == 0 || gridding->options->quiet)
            continue;
        if (!warned)
            warn(gridding, &group->sheet.shape);
        warned = true;
        report(gridding, group);
    }
}

KrsStatus command_grid(Options *options)
{
    Gridding  gridding = {.options = options};
    KrsScene *scene    = NULL;
    KrsStatus status   = check_options(&gridding);
    if (status == KRS_OK)
        status = scene_open(options, options->files.items[0], &scene);
    gridding.scene = scene;
    if (status == KRS_OK)
        status = scene_state(options, scene, &gridding.state);
    if (status == KRS_OK)
        status = take_options(&gridding);
    if (status == KRS_OK)
        status = make_grid(&gridding);
    if (status == KRS_OK)
        report_all(&gridding);
    krs_grid_free(gridding.grid);
    krs_state_free(gridding.state);
    krs_scene_free(scene);
    return status;
}
