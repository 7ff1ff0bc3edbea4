/*
 * mesh.c: `krs mesh`: a scene as triangles, for printers, engines and simulations.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/commands.h"
#include "cli/console.h"
#include "cli/mesh_files.h"
#include "compiler/base/srgb.h"

typedef struct Meshing {
    const Options  *options;
    const KrsScene *scene;
    KrsFrame       *frame;
    KrsMeshOptions  how;
    KrsMesh        *mesh;
    double          scale; /* from the scene to the file */
    unsigned char (*colors)[3];
    Progress progress;
} Meshing;

/* ---- what is asked for ---- */

static KrsStatus find_component(Meshing *meshing)
{
    const char *wanted = meshing->options->component;
    size_t      count  = krs_component_count(meshing->scene);
    Text        known  = {.arena = meshing->options->arena};
    for (size_t i = 0; wanted && i < count; i++) {
        KrsComponent component;
        krs_component(meshing->scene, i, &component);
        if (strcmp(component.name, wanted) == 0) {
            meshing->how.component = i + 1;
            return KRS_OK;
        }
        text_format(&known, "%s`%s`", i ? ", " : "", component.name);
    }
    if (!wanted)
        return KRS_OK;
    return say_usage(meshing->options, "the scene has no component `%s`; it has %s", wanted,
                     count ? known.bytes : "none");
}

/* Why nothing can be made of what is asked for; false: it can. */
static bool find_end(const Meshing *meshing, double *longest)
{
    const KrsProgram *program = krs_scene_program(meshing->scene);
    KrsComponent      component;
    const double     *low = program->low, *high = program->high;
    if (meshing->how.component) {
        krs_component(meshing->scene, meshing->how.component - 1, &component);
        low  = component.low;
        high = component.high;
    }
    *longest = 0;
    for (int k = 0; k < 3; k++) {
        double from = meshing->how.within ? fmax(low[k], meshing->how.low[k]) : low[k];
        double to   = meshing->how.within ? fmin(high[k], meshing->how.high[k]) : high[k];
        if (from < to && isinf(to - from))
            return false;
        *longest = fmax(*longest, to - from);
    }
    return true;
}

static KrsStatus check_wishes(Meshing *meshing)
{
    const Options *options = meshing->options;
    const char    *path    = options->files.items[0];
    double         longest;
    KrsStatus      status = find_component(meshing);
    if (status != KRS_OK)
        return status;
    if (options->within.given) {
        meshing->how.within = true;
        memcpy(meshing->how.low, options->within.low, sizeof meshing->how.low);
        memcpy(meshing->how.high, options->within.high, sizeof meshing->how.high);
    }
    if (krs_scene_program(meshing->scene)->sheets)
        return say_usage(options,
                         "`%s` has surfaces without thickness, which enclose nothing; .shell "
                         "makes a solid of them",
                         path);
    if (!find_end(meshing, &longest))
        return say_usage(options,
                         "`%s` has no end; say which box of it is wanted, as in "
                         "--within=-1,-1,-1,1,1,1, or which --component",
                         path);
    return KRS_OK;
}

/* ---- the mesh ---- */

static bool go_on(void *user, double fraction)
{
    Meshing *meshing = user;
    progress_show(&meshing->progress, fraction);
    return !*interrupted();
}

static KrsStatus make_mesh(Meshing *meshing)
{
    const char *path   = meshing->options->files.items[0];
    KrsStatus   status = krs_mesh(meshing->frame, &meshing->how, &meshing->mesh);
    if (status == KRS_BAD_ARGUMENT) {
        progress_end(&meshing->progress);
        return say_usage(meshing->options, "--error is too small for the size of `%s`", path);
    }
    if (status == KRS_OUT_OF_MEMORY) {
        progress_end(&meshing->progress);
        say("a mesh of `%s` with this --error needs more memory than --limit memory permits", path);
    }
    return status;
}

/* The longest side of a box around the vertices. */
static double longest_side(const KrsMesh *mesh)
{
    double longest = 0;
    for (int k = 0; k < 3; k++) {
        double low = INFINITY, high = -INFINITY;
        for (size_t i = 0; i < mesh->vertex_count; i++) {
            low  = fmin(low, mesh->vertices[i][k]);
            high = fmax(high, mesh->vertices[i][k]);
        }
        longest = fmax(longest, high - low);
    }
    return longest;
}

/* With --size: a coarse mesh tells how long the scene is, and so how much smaller the error is there.
   The final mesh is at most by the coarse one's error shorter. */
static KrsStatus find_scale(Meshing *meshing)
{
    const Options *options = meshing->options;
    meshing->how.error     = options->mesh_error;
    if (options->mesh_size == 0 || options->mesh_error == 0)
        return KRS_OK;
    meshing->how.error = 0;
    KrsStatus status   = make_mesh(meshing);
    if (status != KRS_OK)
        return status;
    double longest     = longest_side(meshing->mesh) - 2 * meshing->mesh->error;
    meshing->how.error = options->mesh_error * longest / options->mesh_size;
    krs_mesh_free(meshing->mesh);
    meshing->mesh = NULL;
    return KRS_OK;
}

static KrsStatus find_mesh(Meshing *meshing)
{
    const Options *options = meshing->options;
    stage_enter(STAGE_MESH);
    progress_start(&meshing->progress, options, 1);
    KrsStatus status = find_scale(meshing);
    if (status == KRS_OK)
        status = make_mesh(meshing);
    progress_end(&meshing->progress);
    if (status != KRS_OK)
        return status;
    if (meshing->mesh->triangle_count == 0) {
        say("there is nothing to write: `%s` has nothing solid%s that is thicker than the error",
            options->files.items[0], meshing->how.within ? " in this box" : "");
        return KRS_BAD_SCENE;
    }
    if (options->mesh_size > 0)
        meshing->scale = options->mesh_size / longest_side(meshing->mesh);
    return KRS_OK;
}

static unsigned char byte_of(double linear)
{
    double encoded = linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1 / 2.4) - 0.055;
    return (unsigned char)lrint(255 * fmin(fmax(encoded, 0), 1));
}

static void find_colors(Meshing *meshing)
{
    const KrsMesh *mesh = meshing->mesh;
    meshing->colors     = arena_alloc(meshing->options->arena, mesh->vertex_count,
                                      sizeof *meshing->colors);
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        KrsHit hit;
        krs_probe(meshing->frame, (const double(*)[3])mesh->vertices + i, 1, &hit);
        for (int k = 0; k < 3; k++)
            meshing->colors[i][k] = byte_of(hit.color[k]);
    }
}

/* ---- files ---- */

typedef struct Output {
    const Meshing    *meshing;
    const MeshFormat *format;
} Output;

static bool fill_mesh(const void *user, OutputFile *file, OutputError *error)
{
    const Output  *output  = user;
    const Meshing *meshing = output->meshing;
    MeshFile      *writer  = arena_new(meshing->options->arena, MeshFile);
    (void)error;
    writer->mesh   = meshing->mesh;
    writer->scale  = meshing->scale;
    writer->colors = (const unsigned char(*)[3])meshing->colors;
    writer->file   = file;
    return mesh_file_write(writer, output->format);
}

static const char *output_path(const Meshing *meshing, size_t index)
{
    const Options *options = meshing->options;
    Text           path    = {.arena = options->arena};
    if (options->outputs.count > 0)
        return options->outputs.items[index];
    text_format(&path, "%s.stl", scene_name(options->arena, options->files.items[0]));
    return path.bytes;
}

static size_t output_count(const Meshing *meshing)
{
    return meshing->options->outputs.count ? meshing->options->outputs.count : 1;
}

static KrsStatus check_outputs(const Meshing *meshing)
{
    for (size_t i = 0; i < output_count(meshing); i++) {
        const char *path = output_path(meshing, i);
        OutputError error;
        if (!mesh_format(path))
            return say_usage(meshing->options,
                             "`%s` is no mesh: its name must end in " MESH_ENDINGS, path);
        KrsStatus status = check_scene_not_overwritten(meshing->options, path);
        if (status != KRS_OK)
            return status;
        if (output_check(path, &error) != KRS_OK) {
            say("%s", error.message);
            return error.status;
        }
    }
    return KRS_OK;
}

static KrsStatus write_meshes(const Meshing *meshing)
{
    KrsStatus status = KRS_OK;
    for (size_t i = 0; i < output_count(meshing) && status == KRS_OK; i++) {
        const char *path   = output_path(meshing, i);
        Output      output = {meshing, mesh_format(path)};
        status             = write_output(path, fill_mesh, &output);
    }
    return status;
}

static void report(const Meshing *meshing)
{
    const KrsMesh *mesh = meshing->mesh;
    const double  *at   = mesh->unresolved_at;
    if (meshing->options->quiet)
        return;
    if (mesh->estimate)
        say("warning: the distance is an estimate, so the error is one as well");
    if (mesh->unresolved > 0)
        say("warning: at %zu places, the first [%g, %g, %g] of the scene, is what is thinner than "
            "the "
            "error, or solids touch; a smaller --error tells",
            mesh->unresolved, at[0], at[1], at[2]);
    say("%zu triangles, within %.4g of the surface", mesh->triangle_count,
        mesh->error * meshing->scale);
}

KrsStatus command_mesh(Options *options)
{
    Meshing   meshing = {.options = options, .scale = 1};
    KrsScene *scene   = NULL;
    KrsStatus status  = check_outputs(&meshing);
    if (status == KRS_OK)
        status = scene_open(options, options->files.items[0], &scene);
    meshing.scene = scene;
    if (status == KRS_OK)
        status = scene_frame(options, scene, &meshing.frame);
    if (status == KRS_OK) {
        meshing.how = (KrsMeshOptions){
            .memory_limit = options->limits.memory, .go_on = go_on, .user = &meshing};
        status = check_wishes(&meshing);
    }
    if (status == KRS_OK)
        status = find_mesh(&meshing);
    if (status == KRS_OK) {
        find_colors(&meshing);
        status = write_meshes(&meshing);
    }
    if (status == KRS_OK)
        report(&meshing);
    krs_mesh_free(meshing.mesh);
    krs_frame_free(meshing.frame);
    krs_scene_free(scene);
    return status;
}
