/* options.c: what `krs mesh` is asked for, and what of it is refused. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/mesh/meshing.h"

/* A component of --frames that is moved has no end for all times, as a rule: the parts that it has must have one. */
static bool is_moved(const Meshing *meshing, size_t index)
{
    KrsMotion motion = {0};
    return meshing->options->animated &&
           krs_component_motion(meshing->scene, index, &motion) == KRS_OK && motion.moves;
}

static void find_box(const Meshing *meshing, double low[3], double high[3])
{
    for (int k = 0; k < 3; k++) {
        low[k]  = INFINITY;
        high[k] = -INFINITY;
    }
    for (size_t i = 0; i < krs_component_count(meshing->scene); i++) {
        KrsComponent component;
        bool         asked = meshing->how.component == 0 || meshing->how.component == i + 1;
        if (!asked || is_moved(meshing, i))
            continue;
        krs_component(meshing->scene, i, &component);
        for (int k = 0; k < 3; k++) {
            low[k]  = fmin(low[k], component.low[k]);
            high[k] = fmax(high[k], component.high[k]);
        }
    }
}

bool find_end(const Meshing *meshing, double *longest)
{
    double low[3], high[3];
    find_box(meshing, low, high);
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

/* A floor without an end is common, so the components that have one are named, unless they are many. */
static KrsStatus refuse_endless(const Meshing *meshing)
{
    enum { MAX_NAMED = 8 };
    Text   others = {.arena = meshing->options->arena};
    size_t named  = 0;
    for (size_t i = 0; i < krs_component_count(meshing->scene) && named <= MAX_NAMED; i++) {
        KrsComponent component;
        krs_component(meshing->scene, i, &component);
        const double *low = component.low, *high = component.high;
        if (!isfinite((high[0] - low[0]) + (high[1] - low[1]) + (high[2] - low[2])) ||
            !scene_is_first_of_name(meshing->scene, i))
            continue;
        if (named++ < MAX_NAMED)
            text_format(&others, "%s`%s`", others.length ? ", " : "", component.name);
        else
            text_add(&others, " and others");
    }
    return say_usage(meshing->options,
                     "`%s` has no end; say which box is wanted, as in --within=-1,-1,-1,1,1,1%s%s",
                     meshing->options->files.items[0],
                     others.length ? ", or by --component one that has: " : "",
                     others.length ? others.bytes : "");
}

const char *output_path(const Meshing *meshing, size_t index)
{
    const Options *options = meshing->options;
    Text           path    = {.arena = options->arena};
    if (options->outputs.count > 0)
        return options->outputs.items[index];
    text_format(&path, "%s.stl", scene_name(options->arena, options->files.items[0]));
    return path.bytes;
}

size_t output_count(const Meshing *meshing)
{
    return meshing->options->outputs.count ? meshing->options->outputs.count : 1;
}

/* Tells whether pictures show the colors of a file. */
static bool is_baked(const Meshing *meshing, const MeshFormat *format)
{
    return meshing->options->mesh_bake > 0 && format->has_looks;
}

static bool can_be_baked(const Meshing *meshing)
{
    for (size_t i = 0; i < output_count(meshing); i++)
        if (is_baked(meshing, mesh_format(output_path(meshing, i))))
            return true;
    return false;
}

/* Tells whether only the shape counts. */
static bool is_shape_enough(const Meshing *meshing)
{
    bool colors = false;
    for (size_t i = 0; i < output_count(meshing); i++)
        colors = colors || (mesh_format(output_path(meshing, i))->has_colors &&
                            !is_baked(meshing, mesh_format(output_path(meshing, i))));
    return meshing->options->mesh_simplify || !colors;
}

bool has_shapes_alone(const Meshing *meshing)
{
    bool alone = true;
    for (size_t i = 0; i < output_count(meshing); i++) {
        const MeshFormat *format = mesh_format(output_path(meshing, i));
        alone = alone && !format->has_colors && !format->has_parts && !format->has_looks &&
                !format->has_places;
    }
    return alone;
}

static bool can_have_lods(const Meshing *meshing)
{
    for (size_t i = 0; i < output_count(meshing); i++)
        if (mesh_format(output_path(meshing, i))->has_lods)
            return true;
    return false;
}

KrsStatus check_mesh_options(Meshing *meshing)
{
    const Options *options = meshing->options;
    KrsStatus      status  = check_motion(meshing);
    if (status == KRS_OK)
        status = check_beams(meshing);
    if (status != KRS_OK)
        return status;
    if (options->mesh_lods > 0 && !can_have_lods(meshing))
        return say_usage(options, "--lods makes levels of detail for .glb, and none is written");
    if (options->mesh_bake > 0 && !can_be_baked(meshing))
        return say_usage(options, "--bake makes pictures for .glb, and none is written");
    if (options->mesh_simplify && options->mesh_even)
        return say_usage(options, "--even keeps triangles that --simplify leaves out; one of both");
    meshing->how.draft    = options->mesh_draft;
    meshing->how.even     = options->mesh_even;
    meshing->how.simplify = !options->mesh_even;
    meshing->how.shape    = is_shape_enough(meshing);
    return KRS_OK;
}

KrsStatus check_common_options(Meshing *meshing)
{
    const Options *options = meshing->options;
    const char    *path    = options->files.items[0];
    double         longest;
    KrsStatus status = scene_component(meshing->options, meshing->scene, &meshing->how.component);
    if (status != KRS_OK)
        return status;
    if (options->within.given) {
        meshing->how.within = true;
        memcpy(meshing->how.low, options->within.low, sizeof meshing->how.low);
        memcpy(meshing->how.high, options->within.high, sizeof meshing->how.high);
    }
    if (krs_scene_program(meshing->scene)->open_surfaces)
        return say_usage(options,
                         "`%s` has surfaces without thickness, which enclose nothing; .shell "
                         "makes a solid of them",
                         path);
    if (!find_end(meshing, &longest))
        return refuse_endless(meshing);
    return KRS_OK;
}

KrsStatus say_nothing(const Meshing *meshing, const char *what, const char *where, double error)
{
    char   than[128] = "";
    double longest;
    if (!where)
        where = meshing->how.within ? " in this box" : "";
    if (find_end(meshing, &longest) && longest > 0 && error > longest)
        snprintf(than, sizeof than,
                 " as large as the error, %.4g: --error is larger than the scene", error);
    else if (error > 0 && longest > 0)
        snprintf(than, sizeof than, " that is thicker than the error, %.4g", error);
    say("there is nothing to %s: `%s` has nothing solid%s%s", what,
        meshing->options->files.items[0], where, than);
    return KRS_BAD_SCENE;
}
