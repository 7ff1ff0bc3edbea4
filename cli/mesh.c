/*
 * mesh.c: `krs mesh`: a scene as triangles, for printers, engines and simulations.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/mesh/meshing.h"

/* --copies, in the order of copies_choices. */
enum { COPIES_INSTANCES, COPIES_FLAT, COPIES_MERGED };

/* Tells how a file has copies. */
static int copies_in(const Options *options, const MeshFormat *format)
{
    if (options->mesh_copies >= 0)
        return options->mesh_copies;
    return format->has_copies ? COPIES_INSTANCES : COPIES_MERGED;
}

/* ---- the mesh ---- */

static bool report_progress(void *user, double fraction)
{
    Meshing *meshing = user;
    double   done    = meshing->begun + fraction * (meshing->goal - meshing->begun);
    meshing->done    = fmax(meshing->done, done);
    progress_show(&meshing->progress, meshing->done);
    return mesh_is_wanted(meshing);
}

static KrsStatus make_merged(Meshing *meshing, Body *body)
{
    return krs_mesh(meshing->state, &meshing->how, &body->mesh);
}

/* Makes the meshes of an assembly, which are the merged ones if nothing can be separated. */
static KrsStatus make_assembled(Meshing *meshing, Body *body)
{
    KrsMeshOptions whole  = meshing->how;
    KrsStatus      status = KRS_OK;
    if (meshing->options->mesh_error == 0)
        meshing->how.error = 0;
    status             = krs_assemble(meshing->state, &meshing->how, &body->assembly);
    meshing->how.error = whole.error;
    return status == KRS_OK && !body->assembly ? make_merged(meshing, body) : status;
}

typedef KrsStatus MakeBody(Meshing *meshing, Body *body);

static KrsStatus make_body(Meshing *meshing, MakeBody *make, Bodies *bodies, double goal)
{
    const char *path  = meshing->options->files.items[0];
    bool        alone = meshing->options->mesh_lods == 0;
    Body        body  = {.component = meshing->how.component};
    enter_step(meshing, step_of(meshing, goal, alone ? 1 : 2));
    KrsStatus status = make(meshing, &body);
    if (status == KRS_OK && body.mesh && body.mesh->triangle_count > 0)
        status = make_lods(meshing, &body, goal);
    if (status != KRS_OK)
        progress_end(&meshing->progress);
    if (status == KRS_BAD_ARGUMENT)
        return say_usage(meshing->options, "--error is too small for the size of `%s`", path);
    if (status == KRS_BAD_SCENE)
        say("what moves in `%s` cannot be taken apart: a mirror cuts it, or a zone or --within "
            "cuts the scene",
            path);
    if (status == KRS_OUT_OF_MEMORY)
        say("a mesh of `%s` with this --error needs more memory than the %zu MiB of --limit "
            "memory; a "
            "larger --error needs less",
            path, (meshing->how.memory_limit ? meshing->how.memory_limit : KRS_USUAL_MEMORY) >> 20);
    if (status == KRS_OK)
        array_push(meshing->options->arena, bodies, body);
    return status;
}

static void drop_bodies(Bodies *bodies)
{
    for (size_t i = 0; i < bodies->count; i++) {
        krs_mesh_free(bodies->items[i].mesh);
        krs_assembly_free(bodies->items[i].assembly);
        for (size_t k = 0; k < bodies->items[i].lod_count; k++)
            krs_mesh_free(bodies->items[i].lods[k]);
    }
    bodies->count = 0;
}

/* Makes one body of all components, or one for each; many alike may share one. */
static KrsStatus make_bodies(Meshing *meshing, MakeBody *make, Bodies *bodies, double goal)
{
    size_t    asked  = meshing->how.component;
    bool      beams  = meshing->options->mesh_beams;
    bool      split  = (meshing->options->mesh_split == SPLIT_COMPONENTS || beams) && asked == 0;
    size_t    count  = split ? krs_component_count(meshing->scene) : 1;
    KrsStatus status = KRS_OK;
    for (size_t i = 0; i < count && status == KRS_OK; i++) {
        if (beams && add_beams(meshing, split ? i + 1 : asked, bodies))
            continue;
        if (split && krs_joined_rank(meshing->scene, i) > 0)
            continue;
        if (split)
            meshing->how.component = i + 1;
        status = make_body(meshing, make, bodies, step_of(meshing, goal, (double)(count - i)));
    }
    meshing->how.component = asked;
    return status;
}

/* ---- which meshes are made ---- */

/* The parts of the work that are done with a coarse mesh, and with what is assembled where all is merged as well. */
static const double COARSE_DONE = 0.1, ASSEMBLED_DONE = 0.5;

/* Finds the error.  With --size a coarse mesh tells how long the scene is, and so how much smaller
   the error is there.  The final mesh is at most by the coarse one's error shorter.  Parts have one
   error. */
static KrsStatus find_error(Meshing *meshing, MakeBody *make)
{
    const Options *options = meshing->options;
    double         longest = 0;
    Bodies         coarse  = {0};
    meshing->how.error     = options->mesh_error;
    find_end(meshing, &longest);
    if (options->mesh_error == 0 && longest > 0)
        meshing->how.error = longest / 200;
    if (options->mesh_size == 0 || options->mesh_error == 0)
        return KRS_OK;
    meshing->how.error = 0;
    KrsStatus status   = make_bodies(meshing, make, &coarse, COARSE_DONE);
    if (status == KRS_OK) {
        longest            = longest_side(&coarse) - 2 * summarize(&coarse).error;
        meshing->how.error = options->mesh_error * longest / options->mesh_size;
    }
    drop_bodies(&coarse);
    return status;
}

static bool is_any(const Meshing *meshing, bool merged)
{
    for (size_t i = 0; i < output_count(meshing); i++)
        if ((copies_in(meshing->options, mesh_format(output_path(meshing, i))) == COPIES_MERGED) ==
            merged)
            return true;
    return false;
}

static double count_instances(const Meshing *meshing)
{
    double count = 0;
    for (size_t i = 0; i < krs_component_count(meshing->scene); i++) {
        KrsComponent component;
        krs_component(meshing->scene, i, &component);
        count += component.levels > 0 ? component.instances : 0;
    }
    return count;
}

/* Refuses a mesh of all that would have too many triangles before it is made: those of the
   generators, copied, tell. */
static KrsStatus check_merged(Meshing *meshing)
{
    const double few    = 1000;
    KrsStatus    status = KRS_OK;
    if (!is_any(meshing, true) || count_instances(meshing) < few)
        return KRS_OK;
    if (meshing->assembled.count == 0)
        status = make_bodies(meshing, make_assembled, &meshing->assembled, ASSEMBLED_DONE);
    double triangles = summarize(&meshing->assembled).triangles;
    if (status != KRS_OK || triangles <= MAX_TRIANGLES)
        return status;
    progress_end(&meshing->progress);
    return say_usage(meshing->options,
                     "a mesh of `%s` as one would have about %.3g triangles; .glb and .3mf have "
                     "instances, %sa larger --error needs fewer",
                     meshing->options->files.items[0], triangles,
                     triangles <= UINT32_MAX ? "--copies flat writes all, and " : "and ");
}

/* Tells whether what is assembled has copies, or nothing has been assembled.  Without copies it is
   what would be merged. */
static bool has_copies(const Bodies *assembled)
{
    bool found = assembled->count == 0;
    for (size_t i = 0; i < assembled->count; i++)
        found = found || assembled->items[i].assembly;
    return found;
}

static KrsStatus refuse_lods_of_copies(Meshing *meshing)
{
    progress_end(&meshing->progress);
    return say_usage(
        meshing->options,
        "`%s` has copies, and meshes with copies have no --lods; --copies merged makes "
        "one mesh of all, which has",
        meshing->options->files.items[0]);
}

static KrsStatus make_all(Meshing *meshing)
{
    bool      assembled = is_any(meshing, false);
    bool      merged    = is_any(meshing, true) && count_instances(meshing) > 0;
    KrsStatus status    = find_error(meshing, assembled ? make_assembled : make_merged);
    if (status == KRS_OK && assembled)
        status = make_bodies(meshing, make_assembled, &meshing->assembled,
                             merged ? ASSEMBLED_DONE : 1);
    if (status == KRS_OK && assembled && meshing->options->mesh_lods > 0 &&
        has_copies(&meshing->assembled))
        return refuse_lods_of_copies(meshing);
    if (status == KRS_OK)
        status = check_merged(meshing);
    if (status == KRS_OK && is_any(meshing, true) && has_copies(&meshing->assembled))
        status = make_bodies(meshing, make_merged, &meshing->merged, 1);
    return status;
}

/* Returns the bodies of a file. */
static const Bodies *bodies_of(const Meshing *meshing, const MeshFormat *format)
{
    bool merged = copies_in(meshing->options, format) == COPIES_MERGED;
    return merged && meshing->merged.count > 0 ? &meshing->merged : &meshing->assembled;
}

static KrsStatus find_meshes(Meshing *meshing)
{
    const Options *options = meshing->options;
    stage_enter(STAGE_MESH);
    progress_start(&meshing->progress, options, 1);
    KrsStatus status = make_all(meshing);
    progress_end(&meshing->progress);
    if (status != KRS_OK)
        return status;
    const Bodies *bodies = meshing->merged.count > 0 ? &meshing->merged : &meshing->assembled;
    if (summarize(bodies).triangles == 0 && summarize(bodies).beams == 0)
        return say_nothing(meshing, "write", NULL, summarize(bodies).error);
    if (options->mesh_size > 0)
        meshing->scale = options->mesh_size / longest_side(bodies);
    return KRS_OK;
}

/* ---- files ---- */

typedef struct Output {
    const Meshing    *meshing;
    const MeshParts  *parts;
    const MeshFormat *format;
    Summary           all;
} Output;

static bool fill_mesh(const void *user, OutputFile *file, OutputError *error)
{
    const Output *output   = user;
    MeshFile     *writer   = arena_new(output->meshing->options->arena, MeshFile);
    writer->parts          = output->parts;
    writer->vertex_count   = (size_t)output->all.vertices;
    writer->triangle_count = (size_t)output->all.triangles;
    writer->file           = file;
    if (output->parts->corner_places)
        writer->places = arena_new_array(output->meshing->options->arena, ObjPlace,
                                         parts_vertex_count(output->parts));
    bool written = mesh_file_write(writer, output->format);
    if (!written && error->status == KRS_OK) {
        error->status = KRS_OUT_OF_MEMORY;
        snprintf(error->message, sizeof error->message, "not enough memory for this file");
    }
    return written;
}

KrsStatus check_mesh_outputs(const Meshing *meshing)
{
    for (size_t i = 0; i < output_count(meshing); i++) {
        const char *path = output_path(meshing, i);
        if (!mesh_format(path))
            return say_usage(meshing->options,
                             "`%s` is no mesh: its name must end in " MESH_ENDINGS, path);
        if (meshing->options->mesh_split != 0 && !mesh_format(path)->has_parts)
            return say_usage(meshing->options,
                             "`%s` has no parts to --split; .obj, .glb and .3mf have", path);
        if (copies_in(meshing->options, mesh_format(path)) == COPIES_INSTANCES &&
            !mesh_format(path)->has_copies)
            return say_usage(meshing->options, "`%s` has no instances; .glb and .3mf have", path);
        KrsStatus status = check_output(meshing->options, path);
        if (status != KRS_OK)
            return status;
    }
    return KRS_OK;
}

/* Formats have 32 bits for numbers, and some are made in memory. */
static KrsStatus check_size(const Meshing *meshing, const char *path, const MeshFormat *format,
                            const Summary *all)
{
    int    copies = copies_in(meshing->options, format);
    double most   = !format->has_copies ? UINT32_MAX : MAX_TRIANGLES;
    double count  = copies == COPIES_INSTANCES ? all->copies : all->triangles;
    if (copies == COPIES_INSTANCES)
        most = MAX_INSTANCES;
    if (copies == COPIES_MERGED || count <= most)
        return KRS_OK;
    return say_usage(meshing->options, "`%s` would have %.0f %s, and can have %.0f; %s", path,
                     count, copies == COPIES_INSTANCES ? "instances" : "triangles", most,
                     copies == COPIES_INSTANCES ? "--component takes less of the scene"
                     : format->has_copies       ? "--copies instances writes each kernel once"
                                                : "a larger --error needs fewer");
}

/* Returns the largest error, that of levels of detail as well. */
static double farthest(const Bodies *bodies)
{
    double error = summarize(bodies).error;
    for (size_t i = 0; i < bodies->count; i++)
        for (size_t k = 0; k < bodies->items[i].lod_count; k++)
            error = fmax(error, bodies->items[i].lods[k]->error);
    return error;
}

static KrsStatus write_mesh(Meshing *meshing, const char *path)
{
    const MeshFormat *format = mesh_format(path);
    const Bodies     *bodies = bodies_of(meshing, format);
    MeshParts         parts;
    Output            output = {meshing, &parts, format, summarize(bodies)};
    KrsStatus         status = check_size(meshing, path, format, &output.all);
    if (status != KRS_OK)
        return status;
    find_parts(meshing, bodies, &parts);
    find_materials(meshing, format, path, &parts);
    if (format->has_looks && meshing->options->mesh_bake > 0)
        status = bake_materials(meshing, &parts, farthest(bodies));
    else if (format->has_places)
        status = find_uvs(meshing, &parts);
    if (status != KRS_OK)
        return status;
    if (format->has_looks)
        find_frames(meshing, &parts);
    if (format->has_copies && copies_in(meshing->options, format) == COPIES_FLAT)
        flatten_parts(meshing, &parts);
    if (format->has_colors && !format->has_face_colors)
        split_corners(meshing->options->arena, &parts, format->places_of_vertices);
    set_units(meshing, format, &parts);
    if (meshing->options->animated)
        status = find_motion(meshing, &parts);
    if (status != KRS_OK)
        return status;
    return write_output(path, fill_mesh, &output);
}

static KrsStatus write_files(Meshing *meshing)
{
    KrsStatus status = KRS_OK;
    for (size_t i = 0; i < output_count(meshing) && status == KRS_OK; i++)
        status = write_mesh(meshing, output_path(meshing, i));
    return status;
}

/* Warns where the numbers of a file, far from the origin, are coarser than the error of a mesh. */
static void warn_of_rounding(const Meshing *meshing, const Summary *all)
{
    static const double SMALL   = 0.1; /* parts of the error that go without saying */
    double              largest = 0;
    for (int k = 0; k < 3; k++)
        largest = fmax(largest, fmax(fabs(all->low[k]), fabs(all->high[k])));
    for (size_t i = 0; i < output_count(meshing); i++) {
        const char *path     = output_path(meshing, i);
        double      rounding = largest * mesh_format(path)->rounding;
        if (rounding > SMALL * all->error)
            say("warning: numbers in `%s` are rounded, so that corners may be off by %.2g more: "
                "its solid is "
                "%.4g from the origin; `.move()` it there",
                path, rounding * meshing->scale, largest * meshing->scale);
    }
}

/* Reports how far the motion errs, if that is more than rounding. */
static void report_motion(const Meshing *meshing, double error)
{
    static const double ROUNDING = 1e-6; /* of the error */
    Text                between  = {.arena = meshing->options->arena};
    if (meshing->farthest > ROUNDING * error)
        text_format(&between, "; between them parts are within %.3g of where they belong",
                    meshing->farthest * meshing->scale);
    if (meshing->jumps > 0)
        text_format(&between, "; %zu jump%s a 1024th of a frame", meshing->jumps,
                    meshing->jumps == 1 ? " takes" : "s take");
    say("%zu part%s, by %zu keyframes%s", meshing->moving,
        meshing->moving == 1 ? " moves" : "s move", meshing->keys,
        between.length > 0 ? between.bytes : "");
}

static void report(const Meshing *meshing, const Bodies *bodies)
{
    Summary       all     = summarize(bodies);
    const double *at      = all.unresolved_at;
    const char   *about   = all.estimate ? "about " : "";
    bool          kernels = bodies == &meshing->assembled && all.copies > 1;
    if (meshing->options->quiet || bodies->count == 0)
        return;
    if (all.estimate && !meshing->options->mesh_draft)
        say("warning: the distance is an estimate, so the error is one as well");
    if (all.unresolved > 0)
        say("warning: %zu place%s may hold what is thinner than the error, or solids that touch; "
            "the first is at [%g, %g, %g] of the %s; a smaller --error tells",
            all.unresolved, all.unresolved == 1 ? "" : "s", at[0], at[1], at[2],
            kernels ? "kernel" : "scene");
    if (meshing->moving > 0)
        report_motion(meshing, all.error);
    if (all.beams > 0)
        say("%zu beam%s", all.beams, all.beams == 1 ? "" : "s");
    else if (meshing->options->mesh_beams)
        say("warning: no component is a union of capsules alone, so there are no beams");
    if (all.triangles == 0)
        return;
    warn_of_rounding(meshing, &all);
    if (meshing->pixel > 0)
        say("%u by %u pixels, each %.3g long on the surface", meshing->options->mesh_bake,
            meshing->options->mesh_bake, meshing->pixel * meshing->scale);
    else if (meshing->options->mesh_bake > 0)
        say("warning: no material varies, so nothing was baked");
    if (kernels && all.copies > (double)bodies->count)
        say("%.0f copies with %.0f triangles, within %s%.4g of the surface", all.copies,
            all.triangles, about, all.error * meshing->scale);
    else
        say("%.0f triangles, within %s%.4g of the surface", all.triangles, about,
            all.error * meshing->scale);
    if (all.colored)
        say("triangles are kept for the colours of several materials; --simplify leaves out all "
            "that "
            "the shape does not need");
}

KrsStatus write_meshes(Meshing *meshing)
{
    const Options *options = meshing->options;
    KrsStatus      status  = scene_state(options, meshing->scene, &meshing->state);
    meshing->scale         = 1;
    if (status == KRS_OK && options->animated)
        status = scene_set_time(options, meshing->state,
                                options->time + options->first_frame / options->fps);
    if (status == KRS_OK) {
        meshing->how = (KrsMeshOptions){
            .memory_limit = options->limits.memory, .progress = report_progress, .user = meshing};
        status = check_common_options(meshing);
    }
    if (status == KRS_OK)
        status = check_mesh_options(meshing);
    if (status == KRS_OK)
        status = find_meshes(meshing);
    if (status == KRS_OK)
        status = write_files(meshing);
    if (status == KRS_OK && (is_any(meshing, false) || meshing->merged.count == 0))
        report(meshing, &meshing->assembled);
    if (status == KRS_OK)
        report(meshing, &meshing->merged);
    drop_bodies(&meshing->assembled);
    drop_bodies(&meshing->merged);
    krs_state_free(meshing->state);
    return status;
}

KrsStatus command_mesh(Options *options)
{
    Meshing   meshing = {.options = options};
    KrsScene *scene   = NULL;
    KrsStatus status  = check_mesh_outputs(&meshing);
    if (status == KRS_OK)
        status = scene_open(options, options->files.items[0], &scene);
    meshing.scene = scene;
    if (status == KRS_OK)
        status = write_meshes(&meshing);
    krs_scene_free(scene);
    return status;
}
