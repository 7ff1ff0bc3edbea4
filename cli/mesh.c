/*
 * mesh.c: `krs mesh`: a scene as triangles, for printers, engines and simulations.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/commands.h"
#include "cli/console.h"
#include "cli/mesh_files.h"
#include "compiler/base/srgb.h"

/* --split, in the order of split_choices. */
enum { SPLIT_NONE, SPLIT_COMPONENTS, SPLIT_MATERIALS };

typedef struct Meshing {
    const Options  *options;
    const KrsScene *scene;
    KrsFrame       *frame;
    KrsMeshOptions  how;
    KrsMesh        *mesh;  /* the last one */
    double          scale; /* from the scene to the file */
    Progress        progress;
    struct {
        KrsMesh **items;
        size_t    count, capacity;
    } meshes; /* of parts */
    size_t vertex_count, triangle_count, unresolved;
    double unresolved_at[3], error;
    bool   estimate;
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

/* A floor without an end is common, so the components that have one are named. */
static KrsStatus refuse_endless(const Meshing *meshing)
{
    Text others = {.arena = meshing->options->arena};
    for (size_t i = 0; i < krs_component_count(meshing->scene); i++) {
        KrsComponent component;
        krs_component(meshing->scene, i, &component);
        const double *low = component.low, *high = component.high;
        if (isfinite((high[0] - low[0]) + (high[1] - low[1]) + (high[2] - low[2])))
            text_format(&others, "%s`%s`", others.length ? ", " : "", component.name);
    }
    return say_usage(meshing->options,
                     "`%s` has no end; say which box is wanted, as in --within=-1,-1,-1,1,1,1%s%s",
                     meshing->options->files.items[0],
                     others.length ? ", or by --component one that has: " : "",
                     others.length ? others.bytes : "");
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
        return refuse_endless(meshing);
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

/* The longest side of a box around all vertices. */
static double longest_side(const Meshing *meshing)
{
    double longest = 0;
    for (int k = 0; k < 3; k++) {
        double low = INFINITY, high = -INFINITY;
        for (size_t m = 0; m < meshing->meshes.count; m++)
            for (size_t i = 0; i < meshing->meshes.items[m]->vertex_count; i++) {
                low  = fmin(low, meshing->meshes.items[m]->vertices[i][k]);
                high = fmax(high, meshing->meshes.items[m]->vertices[i][k]);
            }
        longest = fmax(longest, high - low);
    }
    return longest;
}

static void drop_meshes(Meshing *meshing)
{
    for (size_t i = 0; i < meshing->meshes.count; i++)
        krs_mesh_free(meshing->meshes.items[i]);
    meshing->meshes.count   = 0;
    meshing->vertex_count   = 0;
    meshing->triangle_count = 0;
    meshing->unresolved     = 0;
    meshing->error          = 0;
}

static void keep_mesh(Meshing *meshing)
{
    KrsMesh *mesh = meshing->mesh;
    array_push(meshing->options->arena, &meshing->meshes, mesh);
    if (mesh->unresolved > 0 && meshing->unresolved == 0)
        memcpy(meshing->unresolved_at, mesh->unresolved_at, sizeof meshing->unresolved_at);
    meshing->vertex_count += mesh->vertex_count;
    meshing->triangle_count += mesh->triangle_count;
    meshing->unresolved += mesh->unresolved;
    meshing->error    = fmax(meshing->error, mesh->error);
    meshing->estimate = meshing->estimate || mesh->estimate;
    meshing->mesh     = NULL;
}

static bool is_split(const Meshing *meshing)
{
    return meshing->options->mesh_split == SPLIT_COMPONENTS && meshing->how.component == 0;
}

/* One of all, or one for each component. */
static KrsStatus make_meshes(Meshing *meshing)
{
    size_t    count  = is_split(meshing) ? krs_component_count(meshing->scene) : 1;
    bool      split  = is_split(meshing);
    KrsStatus status = KRS_OK;
    for (size_t i = 0; i < count && status == KRS_OK; i++) {
        if (split)
            meshing->how.component = i + 1;
        status = make_mesh(meshing);
        if (status == KRS_OK)
            keep_mesh(meshing);
    }
    if (split)
        meshing->how.component = 0;
    return status;
}

/* With --size: a coarse mesh tells how long the scene is, and so how much smaller the error is there.
   The final mesh is at most by the coarse one's error shorter.  Parts have one error. */
static KrsStatus find_scale(Meshing *meshing)
{
    const Options *options = meshing->options;
    double         longest = 0;
    meshing->how.error     = options->mesh_error;
    find_end(meshing, &longest);
    if (options->mesh_error == 0 && longest > 0)
        meshing->how.error = longest / 200;
    if (options->mesh_size == 0 || options->mesh_error == 0)
        return KRS_OK;
    meshing->how.error = 0;
    KrsStatus status   = make_meshes(meshing);
    if (status != KRS_OK)
        return status;
    longest            = longest_side(meshing) - 2 * meshing->error;
    meshing->how.error = options->mesh_error * longest / options->mesh_size;
    drop_meshes(meshing);
    return KRS_OK;
}

static KrsStatus find_meshes(Meshing *meshing)
{
    const Options *options = meshing->options;
    stage_enter(STAGE_MESH);
    progress_start(&meshing->progress, options, 1);
    KrsStatus status = find_scale(meshing);
    if (status == KRS_OK)
        status = make_meshes(meshing);
    progress_end(&meshing->progress);
    if (status != KRS_OK)
        return status;
    if (meshing->triangle_count == 0) {
        say("there is nothing to write: `%s` has nothing solid%s that is thicker than the error",
            options->files.items[0], meshing->how.within ? " in this box" : "");
        return KRS_BAD_SCENE;
    }
    if (options->mesh_size > 0)
        meshing->scale = options->mesh_size / longest_side(meshing);
    return KRS_OK;
}

/* ---- parts ---- */

static const char *part_name(const Meshing *meshing, size_t index)
{
    KrsComponent component;
    size_t       number = is_split(meshing) ? index + 1 : meshing->how.component;
    if (number == 0)
        return scene_name(meshing->options->arena, meshing->options->files.items[0]);
    krs_component(meshing->scene, number - 1, &component);
    return component.name;
}

/* All meshes one behind the other. */
static void join_meshes(const Meshing *meshing, MeshParts *parts)
{
    Arena *arena            = meshing->options->arena;
    double(*vertices)[3]    = arena_alloc(arena, meshing->vertex_count, sizeof *vertices);
    uint32_t(*triangles)[3] = arena_alloc(arena, meshing->triangle_count, sizeof *triangles);
    MeshPart *list          = arena_new_array(arena, MeshPart, meshing->meshes.count);
    size_t    vertex = 0, triangle = 0;
    for (size_t i = 0; i < meshing->meshes.count; i++) {
        const KrsMesh *mesh = meshing->meshes.items[i];
        if (mesh->triangle_count == 0)
            continue;
        list[parts->part_count++] = (MeshPart){part_name(meshing, i), vertex, mesh->vertex_count,
                                               triangle, mesh->triangle_count};
        memcpy(vertices + vertex, mesh->vertices, mesh->vertex_count * sizeof *vertices);
        for (size_t t = 0; t < mesh->triangle_count; t++)
            for (int k = 0; k < 3; k++)
                triangles[triangle + t][k] = mesh->triangles[t][k] + (uint32_t)vertex;
        vertex += mesh->vertex_count;
        triangle += mesh->triangle_count;
    }
    parts->vertices  = (const double(*)[3])vertices;
    parts->triangles = (const uint32_t(*)[3])triangles;
    parts->parts     = list;
}

static unsigned char byte_of(double linear)
{
    double encoded = linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1 / 2.4) - 0.055;
    return (unsigned char)lrint(255 * fmin(fmax(encoded, 0), 1));
}

enum { PROBES = 256 };

static void find_colors(const Meshing *meshing, MeshParts *parts)
{
    unsigned char(*colors)[3] = arena_alloc(meshing->options->arena, meshing->vertex_count,
                                            sizeof *colors);
    KrsHit hits[PROBES];
    for (size_t i = 0, now; i < meshing->vertex_count; i += now) {
        now = meshing->vertex_count - i < PROBES ? meshing->vertex_count - i : PROBES;
        krs_probe(meshing->frame, parts->vertices + i, now, hits);
        for (size_t k = 0; k < 3 * now; k++)
            colors[i + k / 3][k % 3] = byte_of(hits[k / 3].color[k % 3]);
    }
    parts->colors = (const unsigned char(*)[3])colors;
}

/* Materials as they come, with the look of their first triangle. */
typedef struct MaterialList {
    uint32_t     *places; /* from 1, by the number that answers have */
    MeshMaterial *items;
    size_t        count;
} MaterialList;

static uint32_t take_material(const Meshing *meshing, MaterialList *list, const KrsHit *hit)
{
    bool        split  = meshing->options->mesh_split == SPLIT_MATERIALS;
    uint32_t    number = split ? hit->material : 0;
    const char *name   = split ? krs_material_name(meshing->scene, number) : NULL;
    if (list->places[number] == 0) {
        MeshMaterial *material = &list->items[list->count];
        *material              = (MeshMaterial){.name      = name ? name : "material",
                                                .roughness = hit->roughness,
                                                .metallic  = hit->metallic};
        for (int k = 0; k < 3; k++)
            material->color[k] = byte_of(hit->color[k]);
        list->places[number] = (uint32_t)++list->count;
    }
    return list->places[number] - 1;
}

static void find_materials(const Meshing *meshing, MeshParts *parts)
{
    Arena       *arena = meshing->options->arena;
    size_t       known = krs_material_count(meshing->scene) + 2;
    MaterialList list  = {arena_new_array(arena, uint32_t, known),
                          arena_new_array(arena, MeshMaterial, known), 0};
    uint32_t    *of    = arena_new_array(arena, uint32_t, meshing->triangle_count);
    double       middles[PROBES][3];
    KrsHit       hits[PROBES];
    for (size_t i = 0, now; i < meshing->triangle_count; i += now) {
        now = meshing->triangle_count - i < PROBES ? meshing->triangle_count - i : PROBES;
        for (size_t t = 0; t < now; t++)
            for (int k = 0; k < 3; k++)
                middles[t][k] = (parts->vertices[parts->triangles[i + t][0]][k] +
                                 parts->vertices[parts->triangles[i + t][1]][k] +
                                 parts->vertices[parts->triangles[i + t][2]][k]) /
                                3;
        krs_probe(meshing->frame, (const double(*)[3])middles, now, hits);
        for (size_t t = 0; t < now; t++)
            of[i + t] = take_material(meshing, &list, &hits[t]);
    }
    parts->material_of    = of;
    parts->materials      = list.items;
    parts->material_count = list.count;
}

static void find_parts(const Meshing *meshing, MeshParts *parts)
{
    *parts = (MeshParts){.scale = meshing->scale};
    join_meshes(meshing, parts);
    find_colors(meshing, parts);
    find_materials(meshing, parts);
}

/* ---- units ---- */

/* In the order of unit_choices. */
static const double metres_of_units[] = {1e-3, 1e-6, 1e-2, 1, 0.0254, 0.3048};

/* Without a wish, what the format is usually in. */
static void set_units(const Meshing *meshing, const MeshFormat *format, MeshParts *parts)
{
    int unit = meshing->options->mesh_units;
    if (unit < 0)
        unit = find_choice(strcmp(format->ending, ".glb") == 0 ? "m" : "mm", unit_choices);
    parts->unit   = unit_choices[unit].name;
    parts->metres = metres_of_units[unit];
}

/* ---- files ---- */

typedef struct Output {
    const Meshing    *meshing;
    const MeshParts  *parts;
    const MeshFormat *format;
} Output;

static bool fill_mesh(const void *user, OutputFile *file, OutputError *error)
{
    const Output  *output  = user;
    const Meshing *meshing = output->meshing;
    MeshFile      *writer  = arena_new(meshing->options->arena, MeshFile);
    writer->parts          = output->parts;
    writer->vertex_count   = meshing->vertex_count;
    writer->triangle_count = meshing->triangle_count;
    writer->file           = file;
    bool written           = mesh_file_write(writer, output->format);
    if (!written && error->status == KRS_OK) {
        error->status = KRS_OUT_OF_MEMORY;
        snprintf(error->message, sizeof error->message, "not enough memory for this file");
    }
    return written;
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
        if (meshing->options->mesh_split != 0 && !mesh_format(path)->has_parts)
            return say_usage(meshing->options,
                             "`%s` has no parts to --split; .obj, .glb and .3mf have", path);
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
    MeshParts parts;
    find_parts(meshing, &parts);
    for (size_t i = 0; i < output_count(meshing) && status == KRS_OK; i++) {
        const char *path   = output_path(meshing, i);
        Output      output = {meshing, &parts, mesh_format(path)};
        set_units(meshing, output.format, &parts);
        status = write_output(path, fill_mesh, &output);
    }
    return status;
}

static void report(const Meshing *meshing)
{
    const double *at = meshing->unresolved_at;
    if (meshing->options->quiet)
        return;
    if (meshing->estimate)
        say("warning: the distance is an estimate, so the error is one as well");
    if (meshing->unresolved > 0)
        say("warning: at %zu places, the first [%g, %g, %g] of the scene, is what is thinner than "
            "the "
            "error, or solids touch; a smaller --error tells",
            meshing->unresolved, at[0], at[1], at[2]);
    say("%zu triangles, within %.4g of the surface", meshing->triangle_count,
        meshing->error * meshing->scale);
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
        status = find_meshes(&meshing);
    if (status == KRS_OK)
        status = write_meshes(&meshing);
    if (status == KRS_OK)
        report(&meshing);
    drop_meshes(&meshing);
    krs_frame_free(meshing.frame);
    krs_scene_free(scene);
    return status;
}
