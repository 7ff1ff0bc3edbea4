/*
 * slice.c: `krs slice`: sections of a scene, layer by layer.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/shell/console.h"
#include "cli/picture/frame_paths.h"
#include "cli/mesh/meshing.h"
#include "cli/slice/slicing.h"

enum { MAX_LAYERS = 1000000, AT_ONCE = 8, USUAL_PIXELS = 1024 };
/* Bytes of a picture. */
#define MAX_PIXELS 1073741824.0

typedef struct SliceOutput {
    const SliceFormat *format;
    const char        *path;
    SliceFile         *file; /* that has all layers; NULL: each has its own */
} SliceOutput;

typedef struct Slicing {
    const Options  *options;
    const KrsScene *scene;
    KrsState       *state;
    KrsSlicer      *slicer;
    SliceSheet      sheet;
    Meshing         meshing; /* what they share with meshes */
    KrsSliceOptions how;     /* of the slicer */
    bool            figures; /* what is shown is plane figures */
    KrsSectionPlane plane;   /* of a section, or of layer 0 */
    SliceOutput    *outputs;
    size_t          output_count;
    uint32_t        empty; /* layers before the first that is not */
    bool            found; /* that one */
    size_t          lost;  /* of all sections, as of KrsSection */
    double          lost_at[3], thinnest;
    Progress        progress;
} Slicing;

/* Layers tell the progress. */
static bool is_wanted(void *user, double fraction)
{
    (void)user, (void)fraction;
    return !*interrupted();
}

/* ---- what is asked for ---- */

static const char *output_name(const Slicing *slicing, size_t index)
{
    const Options *options = slicing->options;
    Text           path    = {.arena = options->arena};
    if (options->outputs.count > 0)
        return options->outputs.items[index];
    text_format(&path, "%s.svg", scene_name(options->arena, options->files.items[0]));
    return path.bytes;
}

/* Returns a `%` that looks like the place for a number, as in other programs, and is none; NULL:
   there is none. */
static const char *foreign_place(const char *path)
{
    for (const char *percent = path; (percent = strchr(percent, '%')); percent++) {
        const char *flags = percent + 1, *digits = flags + strspn(flags, "-+ #'0");
        const char *letter = digits + strspn(digits, "0123456789.");
        const bool  ours   = *letter == 'd' &&
                          strspn(flags, "0123456789") == (size_t)(letter - flags) &&
                          letter - flags <= 2;
        if (*letter && strchr("diouxX", *letter) && !ours)
            return percent;
    }
    return NULL;
}

/* Tells whether two names are one file for the first layer or the last. */
static bool are_one_output(const Options *options, const char *a, const char *b)
{
    bool one = output_is_same(numbered_path(options, a, 1), numbered_path(options, b, 1));
    for (uint32_t n = 10; n <= MAX_LAYERS && options->layer > 0; n *= 10)
        one = one || output_is_same(numbered_path(options, a, n), numbered_path(options, b, n));
    return one;
}

static KrsStatus check_section(const Slicing *slicing, const char *path)
{
    const Options     *options = slicing->options;
    const SliceFormat *format  = slice_format(path);
    const char        *first   = numbered_path(options, path, 1);
    if (!format)
        return say_usage(options, "`%s` is no section: its name must end in " SLICE_ENDINGS, path);
    if (frame_places(path) > 1)
        return say_usage(options, "`%s` has more than one place for the number of a layer", path);
    const char *foreign = options->layer > 0 ? foreign_place(path) : NULL;
    if (foreign)
        return say_usage(options, "`%s` is no place for the number of a layer; %%d or %%04d is one",
                         foreign);
    for (size_t i = 0; i < options->outputs.count && options->outputs.items[i] != path; i++)
        if (are_one_output(options, options->outputs.items[i], path))
            return say_usage(options, "`%s` and `%s` are one file", options->outputs.items[i],
                             path);
    if (!format->has_layers && frame_places(path) == 0 && options->layer > 0)
        return say_usage(
            options, "`%s` would have one layer; with %%04d in its name there is a file for each",
            path);
    return check_output(options, first);
}

static KrsStatus check_options(Slicing *slicing)
{
    const Options *options = slicing->options;
    KrsStatus      status  = KRS_OK;

    if (options->layer > 0 && options->plane.given)
        return say_usage(options, "--layer makes many sections, and --plane one");
    if (options->plane.given && option_is_given(options, OPTION_AXIS))
        return say_usage(options, "--axis is that of --layer; --plane has a direction of its own");
    slicing->output_count = options->outputs.count ? options->outputs.count : 1;
    slicing->outputs      = arena_new_array(options->arena, SliceOutput, slicing->output_count);
    for (size_t i = 0; i < slicing->output_count && status == KRS_OK; i++) {
        const char *path    = output_name(slicing, i);
        status              = check_section(slicing, path);
        slicing->outputs[i] = (SliceOutput){slice_format(path), path, NULL};
    }
    return status;
}

/* Refuses solids beside plane figures, and layers of these, which are sections already. */
static KrsStatus check_figures(Slicing *slicing)
{
    const Options *options = slicing->options;
    const size_t   chosen = slicing->how.component, count = krs_component_count(slicing->scene);
    size_t         figures = 0, all = 0;
    for (size_t i = chosen ? chosen - 1 : 0; i < (chosen ? chosen : count); i++, all++) {
        KrsComponent component;
        krs_component(slicing->scene, i, &component);
        figures += component.figure;
    }
    slicing->figures = figures > 0;
    if (figures > 0 && figures < all)
        return say_usage(options, "`%s` shows plane figures and solids; --component takes one",
                         options->files.items[0]);
    if (figures > 0 && (options->layer > 0 || options->plane.given))
        return say_usage(options, "`%s` is a plane figure, which has neither --layer nor --plane",
                         options->files.items[0]);
    return KRS_OK;
}

/* ---- where sections are ---- */

static KrsSectionPlane plane_of(const Slicing *slicing, double at)
{
    KrsSectionPlane plane = slicing->plane;
    if (slicing->sheet.stacked)
        plane.point[slicing->options->axis] = at;
    return plane;
}

/* Returns a layer.  One that is thicker than all is cut in the middle of what there is. */
static Layer layer_of(const Slicing *slicing, uint32_t index)
{
    const SliceSheet *sheet = &slicing->sheet;
    double            low = sheet->bottom + index * sheet->layer, high = low + sheet->layer;
    double at = sheet->layer_count == 1 ? 0.5 * (low + fmin(high, sheet->top)) : 0.5 * (low + high);
    return (Layer){NULL, index + 1, low, at, high};
}

/* Finds the layers: those whose middle is in the solid. */
static KrsStatus find_layers(Slicing *slicing, const double low[3], const double high[3])
{
    const Options *options = slicing->options;
    SliceSheet    *sheet   = &slicing->sheet;
    sheet->layer_count     = 1;
    if (!slicing->figures && options->layer == 0 && !options->plane.given)
        return say_usage(options, "say how thick layers are, as in --layer 0.05, or where a "
                                  "section is, as in --plane=0,0,0.5,0,0,1");
    if (options->layer == 0) {
        slicing->plane = slicing->figures ? (KrsSectionPlane){.normal = {0, 0, 1}}
                                          : options->plane.at;
        return KRS_OK;
    }
    sheet->stacked                       = true;
    sheet->layer                         = options->layer;
    sheet->bottom                        = low[options->axis];
    sheet->top                           = high[options->axis];
    slicing->plane.normal[options->axis] = 1;
    double count = fmax(1, ceil((sheet->top - sheet->bottom) / sheet->layer - 0.5 - 1e-9));
    if (count > MAX_LAYERS)
        return say_usage(options,
                         "`%s` would have %.3g layers, and can have %d; --layer is too thin",
                         options->files.items[0], count, MAX_LAYERS);
    sheet->layer_count = (uint32_t)count;
    return KRS_OK;
}

/* Finds the box of the scene as the plane shows it. */
static void find_sides(Slicing *slicing, const double low[3], const double high[3])
{
    SliceSheet *sheet = &slicing->sheet;
    double      axes[2][3];
    krs_plane_axes(&slicing->plane, axes[0], axes[1]);
    for (int k = 0; k < 2; k++) {
        sheet->low[k] = sheet->high[k] = 0;
        for (int i = 0; i < 3; i++) {
            sheet->low[k] += fmin(axes[k][i] * low[i], axes[k][i] * high[i]);
            sheet->high[k] += fmax(axes[k][i] * low[i], axes[k][i] * high[i]);
        }
    }
}

static bool has_pictures(const Slicing *slicing)
{
    for (size_t i = 0; i < slicing->output_count; i++)
        if (!slicing->outputs[i].format->has_layers)
            return true;
    return false;
}

static KrsStatus find_pixels(Slicing *slicing)
{
    const Options *options = slicing->options;
    SliceSheet    *sheet   = &slicing->sheet;
    double sides[2] = {sheet->high[0] - sheet->low[0], sheet->high[1] - sheet->low[1]}, pixels[2];
    double longest  = fmax(sides[0], sides[1]);
    sheet->per_unit = options->resolution > 0 ? options->resolution : USUAL_PIXELS / longest;
    for (int k = 0; k < 2; k++)
        pixels[k] = fmax(1, ceil(sides[k] * sheet->per_unit - 1e-6));
    if (options->how.width > 0) {
        pixels[0] = options->how.width;
        pixels[1] = options->how.height;
    }
    double all = pixels[0] * pixels[1];
    if (fmax(pixels[0], pixels[1]) > KRS_MAX_SIDE || all > MAX_PIXELS)
        return say_usage(options,
                         "pictures of %.0f x %.0f pixels are too large; a smaller --resolution "
                         "has fewer",
                         pixels[0], pixels[1]);
    if (options->limits.pixels > 0 && all > (double)options->limits.pixels)
        return say_usage(options,
                         "pictures of %.0f x %.0f pixels are more than --limit pixels=%llu",
                         pixels[0], pixels[1], (unsigned long long)options->limits.pixels);
    sheet->width  = (uint32_t)pixels[0];
    sheet->height = (uint32_t)pixels[1];
    return KRS_OK;
}

static void find_units(Slicing *slicing)
{
    SliceSheet *sheet = &slicing->sheet;
    int         unit  = slicing->options->mesh_units;
    unit              = unit < 0 ? find_choice("mm", unit_choices) : unit;
    sheet->unit       = unit_choices[unit].name;
    sheet->metres     = metres_of_units[unit];
    sheet->gray       = slicing->options->slice_exposure == EXPOSURE_GRAY;
    sheet->digits     = (int)fmax(0, fmin(15, ceil(-log10(slicing->how.error)) + 3));
}

static KrsStatus refuse_error(const Slicing *slicing)
{
    return say_usage(slicing->options, "--error is too small for the size of `%s`",
                     slicing->options->files.items[0]);
}

/* Finds the error where no option says it, once the box is known. */
static KrsStatus find_error(Slicing *slicing, const double low[3], const double high[3])
{
    const double usual = 1.0 / 2000, of_pixel = 1.0 / 16;
    double       longest = 0;
    for (int k = 0; k < 3; k++)
        longest = fmax(longest, high[k] - low[k]);
    if (slicing->how.error > 0)
        return KRS_OK;
    slicing->how.error = usual * longest;
    if (slicing->sheet.width > 0)
        slicing->how.error = fmin(slicing->how.error, of_pixel / slicing->sheet.per_unit);
    return krs_slicer_set_error(slicing->slicer, slicing->how.error) == KRS_OK
               ? KRS_OK
               : refuse_error(slicing);
}

/* Tells whether the box of the scene is on one side of the plane. */
static bool misses_box(const Slicing *slicing)
{
    const KrsSectionPlane *plane = &slicing->plane;
    double                 low[3], high[3], least = 0, most = 0;
    if (!krs_slicer_box(slicing->slicer, low, high))
        return true;
    for (int k = 0; k < 3; k++) {
        double from = plane->normal[k] * (low[k] - plane->point[k]);
        double to   = plane->normal[k] * (high[k] - plane->point[k]);
        least += fmin(from, to);
        most += fmax(from, to);
    }
    return least > 0 || most < 0;
}

static KrsStatus say_no_section(const Slicing *slicing)
{
    const char *where = slicing->options->plane.given ? " in this plane"
                        : slicing->sheet.stacked      ? " in the planes of its layers"
                                                      : NULL;
    if (!slicing->figures)
        return say_nothing(&slicing->meshing, "write", where,
                           misses_box(slicing) ? 0 : slicing->how.error);
    say("there is nothing to write: `%s` is a figure without area",
        slicing->options->files.items[0]);
    return KRS_BAD_SCENE;
}

static KrsStatus open_slicer(Slicing *slicing)
{
    const Options *options = slicing->options;
    for (size_t i = 0; i < slicing->output_count; i++) {
        const bool arcs    = slicing->outputs[i].format->has_arcs;
        slicing->how.arcs  = slicing->how.arcs || arcs;
        slicing->how.lines = slicing->how.lines || !arcs;
    }
    KrsStatus status = krs_slicer_new(slicing->state, &slicing->how, &slicing->slicer);
    if (status == KRS_BAD_ARGUMENT)
        return refuse_error(slicing);
    return status == KRS_OK ? KRS_OK : say_status(status, options->files.items[0]);
}

/* Fills in how the scene is cut, but for where. */
static KrsStatus take_options(Slicing *slicing)
{
    Meshing *meshing = &slicing->meshing;
    meshing->options = slicing->options;
    meshing->scene   = slicing->scene;
    KrsStatus status = check_common_options(meshing);
    slicing->how     = (KrsSliceOptions){.error        = slicing->options->slice_error,
                                         .component    = meshing->how.component,
                                         .within       = meshing->how.within,
                                         .memory_limit = slicing->options->limits.memory,
                                         .progress     = is_wanted};
    memcpy(slicing->how.low, meshing->how.low, sizeof slicing->how.low);
    memcpy(slicing->how.high, meshing->how.high, sizeof slicing->how.high);
    return status == KRS_OK ? check_figures(slicing) : status;
}

static KrsStatus find_options(Slicing *slicing)
{
    double    low[3], high[3];
    KrsStatus status = take_options(slicing);
    if (status == KRS_OK)
        status = open_slicer(slicing);
    if (status != KRS_OK)
        return status;
    if (!krs_slicer_box(slicing->slicer, low, high))
        return say_no_section(slicing);
    status = find_layers(slicing, low, high);
    find_sides(slicing, low, high);
    if (status == KRS_OK && has_pictures(slicing))
        status = find_pixels(slicing);
    if (status != KRS_OK)
        return status;
    status = find_error(slicing, low, high);
    find_units(slicing);
    return status;
}

/* ---- files ---- */

static const KrsSection *section_for(const SliceOutput *output, const KrsSection *section)
{
    return section->lines && !output->format->has_arcs ? section->lines : section;
}

/* A file that has one layer. */
typedef struct LayerFile {
    const Slicing     *slicing;
    const SliceOutput *output;
    const Layer       *layer;
} LayerFile;

static bool fill_layer(const void *user, OutputFile *output, OutputError *error)
{
    const LayerFile   *of     = user;
    const SliceFormat *format = of->output->format;
    SliceFile          file   = {.sheet = &of->slicing->sheet, .file = output, .error = error};
    return format->begin(&file) && format->add(&file, of->layer) && format->end(&file) &&
           slice_file_flush(&file);
}

/* Adds a layer to all files. */
static KrsStatus write_layer(const Slicing *slicing, Layer layer, const KrsSection *section)
{
    KrsStatus status = KRS_OK;
    for (size_t i = 0; i < slicing->output_count && status == KRS_OK; i++) {
        const SliceOutput *output = &slicing->outputs[i];
        layer.section             = section_for(output, section);
        if (output->file)
            status = output->format->add(output->file, &layer) ? KRS_OK : KRS_IO_ERROR;
        else
            status = write_output(numbered_path(slicing->options, output->path, layer.number),
                                  fill_layer, &(LayerFile){slicing, output, &layer});
    }
    return status;
}

/* Takes a section.  The file begins with the first one that is not empty. */
static KrsStatus take_layer(Slicing *slicing, uint32_t index, const KrsSection *section)
{
    static const KrsSection nothing = {.contour_count = 0};
    KrsStatus               status  = KRS_OK;
    if (section->contour_count == 0 && !slicing->found) {
        slicing->empty++;
        return KRS_OK;
    }
    for (; slicing->empty > 0 && status == KRS_OK; slicing->empty--)
        status = write_layer(slicing, layer_of(slicing, index - slicing->empty), &nothing);
    slicing->found = true;
    return status == KRS_OK ? write_layer(slicing, layer_of(slicing, index), section) : status;
}

static void note_lost(Slicing *slicing, const KrsSection *section)
{
    if (slicing->lost == 0)
        memcpy(slicing->lost_at, section->lost_at, sizeof slicing->lost_at);
    slicing->lost += section->lost;
    slicing->thinnest = fmax(slicing->thinnest, section->thinnest);
}

static void warn_of_lost(const Slicing *slicing)
{
    const double *at = slicing->lost_at;
    if (slicing->lost > 0 && !slicing->options->quiet)
        say("warning: in %zu places something is thinner than %.3g, and not in the sections; the "
            "first is at [%g, %g, %g]; a smaller --error finds it",
            slicing->lost, slicing->thinnest, at[0], at[1], at[2]);
}

static KrsStatus make_some(Slicing *slicing, uint32_t first, size_t count)
{
    KrsSectionPlane planes[AT_ONCE];
    KrsSection     *sections[AT_ONCE];
    for (size_t i = 0; i < count; i++)
        planes[i] = plane_of(slicing, layer_of(slicing, first + (uint32_t)i).at);
    stage_enter(STAGE_SLICE);
    KrsStatus status = krs_slice(slicing->slicer, planes, count, sections);
    if (status != KRS_OK)
        return status == KRS_INTERRUPTED ? status
                                         : say_status(status, slicing->options->files.items[0]);
    for (size_t i = 0; i < count; i++) {
        note_lost(slicing, sections[i]);
        if (status == KRS_OK)
            status = take_layer(slicing, first + (uint32_t)i, sections[i]);
        krs_section_free(sections[i]);
    }
    return status;
}

static KrsStatus make_layers(Slicing *slicing)
{
    uint32_t  all    = slicing->sheet.layer_count;
    KrsStatus status = KRS_OK;
    for (uint32_t i = 0; i < all && status == KRS_OK; i += AT_ONCE) {
        progress_show(&slicing->progress, (double)i / all);
        status = make_some(slicing, i, all - i < AT_ONCE ? all - i : AT_ONCE);
    }
    progress_end(&slicing->progress);
    warn_of_lost(slicing);
    return status == KRS_OK && !slicing->found ? say_no_section(slicing) : status;
}

/* A file that has all layers. */
typedef struct WholeFile {
    Slicing   *slicing;
    size_t     number;
    KrsStatus *status; /* of the files behind it, and of the layers */
} WholeFile;

static KrsStatus write_from(Slicing *slicing, size_t number);

/* The layers are made when the last file has begun, and each goes to all of them. */
static bool fill_whole(const void *user, OutputFile *output, OutputError *error)
{
    const WholeFile *of      = user;
    Slicing         *slicing = of->slicing;
    SliceOutput     *to      = &slicing->outputs[of->number];
    to->file                 = arena_new(slicing->options->arena, SliceFile);
    to->file->sheet          = &slicing->sheet;
    to->file->file           = output;
    to->file->error          = error;
    if (!to->format->begin(to->file))
        return false;
    *of->status = write_from(slicing, of->number + 1);
    if (*of->status != KRS_OK && error->status == KRS_OK)
        error->status = KRS_INTERRUPTED; /* what else it was has been said */
    return *of->status == KRS_OK && to->format->end(to->file) && slice_file_flush(to->file);
}

/* Writes the files from this one on. */
static KrsStatus write_from(Slicing *slicing, size_t number)
{
    KrsStatus made = KRS_OK;
    while (number < slicing->output_count && frame_places(slicing->outputs[number].path) > 0)
        number++;
    if (number == slicing->output_count)
        return make_layers(slicing);
    KrsStatus status = write_output(slicing->outputs[number].path, fill_whole,
                                    &(WholeFile){slicing, number, &made});
    return made == KRS_OK ? status : made;
}

static KrsStatus write_sections(Slicing *slicing)
{
    progress_start(&slicing->progress, slicing->options, 1);
    KrsStatus status = write_from(slicing, 0);
    progress_end(&slicing->progress);
    return status;
}

KrsStatus command_slice(Options *options)
{
    Slicing   slicing = {.options = options};
    KrsScene *scene   = NULL;
    KrsStatus status  = check_options(&slicing);
    if (status == KRS_OK)
        status = scene_open(options, options->files.items[0], &scene);
    slicing.scene = scene;
    if (status == KRS_OK)
        status = scene_state(options, scene, &slicing.state);
    if (status == KRS_OK)
        status = find_options(&slicing);
    if (status == KRS_OK)
        status = write_sections(&slicing);
    krs_slicer_free(slicing.slicer);
    krs_state_free(slicing.state);
    krs_scene_free(scene);
    return status;
}
