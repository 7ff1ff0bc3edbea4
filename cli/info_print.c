/*
 * info_print.c: `krs info --print`: the figures of a part that is to be made.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/info.h"
#include "cli/mesh/meshing.h"

typedef struct Printing {
    const Options  *options;
    const KrsScene *scene;
    KrsMeasures    *measures;
    const char     *unit; /* "mm" */
    double          cm;   /* of a length of 1 */
    Progress        progress;
} Printing;

static bool report_progress(void *user, double fraction)
{
    Printing *printing = user;
    progress_show(&printing->progress, fraction);
    return !*interrupted();
}

static double mass_of(const Printing *printing, double volume)
{
    return volume * pow(printing->cm, 3) * printing->options->density;
}

/* ---- text ---- */

static void print_place(const double point[3])
{
    printf("[%.6g, %.6g, %.6g]", point[0] + 0.0, point[1] + 0.0, point[2] + 0.0); /* no -0 */
}

/* Finds the rotation that makes a direction of the scene the one away from the plate. */
static void find_rotation(const double from[3], const double to[3], double axis[3], double *degrees)
{
    double cosine = 0, length;
    for (int k = 0; k < 3; k++) {
        axis[k] = from[(k + 1) % 3] * to[(k + 2) % 3] - from[(k + 2) % 3] * to[(k + 1) % 3];
        cosine += from[k] * to[k];
    }
    length   = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
    *degrees = atan2(length, cosine) * 180 / M_PI;
    if (length > 1e-9) {
        for (int k = 0; k < 3; k++)
            axis[k] /= length;
        return;
    }
    int across = fabs(to[0]) < 0.6 ? 0 : 1; /* half a turn about any direction across */
    for (int k = 0; k < 3; k++)
        axis[k] = (k == across) - to[across] * to[k];
}

static void print_lying(const Printing *printing, const char *name,
                        const KrsOrientation *orientation)
{
    const char *unit = printing->unit;
    printf("%-12s up ", name);
    print_place(orientation->up);
    printf(": height %.6g %s, base %.5g %s2%s, overhang %.5g %s2\n", orientation->height, unit,
           orientation->base, unit, orientation->stands ? "" : " (it does not stand on that)",
           orientation->overhang, unit);
}

static void print_rotation(const KrsOrientation *from, const KrsOrientation *to)
{
    double axis[3], degrees;
    find_rotation(to->up, from->up, axis, &degrees);
    if (degrees < 0.01) {
        puts("             which is as it lies");
        return;
    }
    fputs("             as it lies after .rotate(", stdout);
    print_place(axis);
    printf(", %.6gdeg)\n", degrees);
}

static void print_wall(const Printing *printing)
{
    const KrsMeasures *measures = printing->measures;
    if (isinf(measures->wall.thickness)) {
        puts("wall         none has its sides opposite to each other");
        return;
    }
    printf("wall         %.6g %s, from ", measures->wall.thickness, printing->unit);
    print_place(measures->wall.from);
    fputs(" to ", stdout);
    print_place(measures->wall.to);
    printf("; looked for at places %.3g apart\n", measures->spacing);
}

static void print_solid(const Printing *printing)
{
    const KrsMeasures *m    = printing->measures;
    const char        *unit = printing->unit;
    fputs("bounds       ", stdout);
    print_place(m->low);
    fputs(" to ", stdout);
    print_place(m->high);
    printf(" %s, within %.3g\n", unit, m->error);
    printf("size         %.6g x %.6g x %.6g %s\n", m->high[0] - m->low[0], m->high[1] - m->low[1],
           m->high[2] - m->low[2], unit);
    printf("volume       %.6g %s3, within %.3g, probably %.1g; %.6g cm3\n", m->volume, unit,
           m->volume_error, m->volume_change, m->volume * pow(printing->cm, 3));
    fputs("center       ", stdout);
    print_place(m->center);
    printf(" %s, within %.3g\n", unit, m->center_error);
    if (printing->options->density > 0)
        printf("mass         %.6g g, within %.3g, at %g g/cm3\n", mass_of(printing, m->volume),
               mass_of(printing, m->volume_error), printing->options->density);
    printf("area         %.6g %s2, of a mesh within %.3g of the surface\n", m->area, unit,
           m->error);
}

static void print_text(const Printing *printing)
{
    const KrsMeasures *measures = printing->measures;
    const Options     *options  = printing->options;
    print_solid(printing);
    print_wall(printing);
    if (options->nozzle > 0)
        printf("thin         %.5g %s2 have walls thinner than %g\n", measures->thin_area,
               printing->unit, options->nozzle);
    printf("overhang     where faces look down and lean by more than %g degrees from upright\n",
           options->overhang);
    print_lying(printing, "lies", &measures->as_is);
    if (!measures->orientations[0].stands) {
        puts("best         it stands on none of its flat faces");
        return;
    }
    print_lying(printing, "best", &measures->orientations[0]);
    print_rotation(&measures->as_is, &measures->orientations[0]);
}

/* ---- JSON ---- */

static void add_orientation(Json *json, const char *name, const KrsOrientation *orientation)
{
    json_open(json, name, "{");
    json_numbers(json, "up", orientation->up, 3);
    json_number(json, "height", orientation->height);
    json_number(json, "base", orientation->base);
    json_number(json, "overhang", orientation->overhang);
    json_truth(json, "stands", orientation->stands);
    json_close(json, "}");
}

static void add_solid(Json *json, const Printing *printing)
{
    const KrsMeasures *m = printing->measures;
    json_open(json, "bounds", "{");
    json_numbers(json, "low", m->low, 3);
    json_numbers(json, "high", m->high, 3);
    json_close(json, "}");
    json_number(json, "volume", m->volume);
    json_number(json, "volume_error", m->volume_error);
    json_number(json, "volume_change", m->volume_change);
    json_number(json, "volume_cm3", m->volume * pow(printing->cm, 3));
    json_numbers(json, "center", m->center, 3);
    json_number(json, "center_error", m->center_error);
    if (printing->options->density > 0) {
        json_number(json, "density", printing->options->density);
        json_number(json, "mass_g", mass_of(printing, m->volume));
        json_number(json, "mass_error_g", mass_of(printing, m->volume_error));
    }
    json_number(json, "area", m->area);
    json_number(json, "mesh_error", m->error);
}

static void add_walls(Json *json, const Printing *printing)
{
    const KrsMeasures *m = printing->measures;
    if (isinf(m->wall.thickness)) {
        json_ready(json, "wall", "null");
    } else {
        json_open(json, "wall", "{");
        json_number(json, "thickness", m->wall.thickness);
        json_numbers(json, "from", m->wall.from, 3);
        json_numbers(json, "to", m->wall.to, 3);
        json_close(json, "}");
    }
    json_number(json, "spacing", m->spacing);
    if (printing->options->nozzle > 0) {
        json_number(json, "nozzle", printing->options->nozzle);
        json_number(json, "thin_area", m->thin_area);
    }
}

static void print_json(const Printing *printing)
{
    const KrsMeasures *m    = printing->measures;
    Json               json = {.text = {.arena = printing->options->arena}, .spaced = true};
    json_open(&json, NULL, "{");
    info_begin_json(&json, printing->scene);
    json_open(&json, "print", "{");
    json_text(&json, "units", printing->unit);
    add_solid(&json, printing);
    add_walls(&json, printing);
    json_number(&json, "overhang_degrees", printing->options->overhang);
    add_orientation(&json, "lies", &m->as_is);
    json_open(&json, "orientations", "[");
    for (size_t i = 0; i < m->orientation_count; i++)
        add_orientation(&json, NULL, &m->orientations[i]);
    json_close(&json, "]");
    json_whole(&json, "unresolved", m->unresolved);
    if (m->unresolved > 0)
        json_numbers(&json, "unresolved_at", m->unresolved_at, 3);
    json_truth(&json, "estimate", m->estimate);
    json_close(&json, "}");
    json_close(&json, "}");
    puts(json.text.bytes);
}

/* ---- what is asked for ---- */

static void warn(const Printing *printing)
{
    const KrsMeasures *m  = printing->measures;
    const double      *at = m->unresolved_at, *from = m->wall.from;
    if (printing->options->quiet)
        return;
    if (m->estimate)
        say("warning: the distance is an estimate, so the errors are some as well");
    if (m->unresolved > 0)
        say("warning: %zu place%s may hold what is thinner than %.3g, or solids that touch; the "
            "first is at [%g, %g, %g]; a smaller --error tells",
            m->unresolved, m->unresolved == 1 ? "" : "s", m->error, at[0], at[1], at[2]);
    if (m->thin_area > 0 || m->wall.thickness < (1 - 1e-6) * printing->options->nozzle)
        say("warning: a wall of %.4g %s at [%g, %g, %g] is thinner than the nozzle, %g %s; "
            "walls of %.4g %s2 in all are",
            m->wall.thickness, printing->unit, from[0], from[1], from[2], printing->options->nozzle,
            printing->unit, m->thin_area, printing->unit);
}

static KrsMeasureOptions measure_options(Printing *printing, const KrsMeshOptions *meshed,
                                         double longest)
{
    const Options    *options = printing->options;
    KrsMeasureOptions how     = {.error        = options->print_error,
                                 .component    = meshed->component,
                                 .within       = meshed->within,
                                 .overhang     = options->overhang * M_PI / 180,
                                 .nozzle       = options->nozzle,
                                 .memory_limit = options->limits.memory,
                                 .progress     = report_progress,
                                 .user         = printing};
    how.up[options->axis]     = 1;
    memcpy(how.low, meshed->low, sizeof how.low);
    memcpy(how.high, meshed->high, sizeof how.high);
    /* Parts of the solid that may be missing are then too thin for the nozzle. */
    if (how.error == 0 && options->nozzle > 0)
        how.error = fmin(longest / 200, options->nozzle);
    return how;
}

static KrsStatus measure(Printing *printing, KrsState *state)
{
    const Options *options = printing->options;
    const char    *path    = options->files.items[0];
    Meshing        meshing = {.options = options, .scene = printing->scene};
    double         longest;
    KrsStatus      status = check_common_options(&meshing);
    if (status != KRS_OK)
        return status;
    find_end(&meshing, &longest);
    KrsMeasureOptions how = measure_options(printing, &meshing.how, longest);
    stage_enter(STAGE_MESH);
    progress_start(&printing->progress, options, 1);
    status = krs_measure(state, &how, &printing->measures);
    progress_end(&printing->progress);
    if (status == KRS_BAD_ARGUMENT)
        return say_usage(options, "--%s is too small for the size of `%s`",
                         options->print_error > 0 ? "error" : "nozzle", path);
    if (status == KRS_OUT_OF_MEMORY)
        say("figures of `%s` with this --error need more memory than --limit memory permits", path);
    if (status == KRS_OK && printing->measures->area == 0)
        return say_nothing(&meshing, "measure", NULL, how.error > 0 ? how.error : longest / 200);
    return status;
}

KrsStatus info_print(const Options *options, const KrsScene *scene)
{
    Printing printing = {.options = options, .scene = scene};
    int      unit = options->mesh_units < 0 ? find_choice("mm", unit_choices) : options->mesh_units;
    KrsState *state;
    printing.unit    = unit_choices[unit].name;
    printing.cm      = 100 * metres_of_units[unit];
    KrsStatus status = scene_state(options, scene, &state);
    if (status != KRS_OK)
        return status;
    status = measure(&printing, state);
    if (status == KRS_OK) {
        if (options->json)
            print_json(&printing);
        else
            print_text(&printing);
        warn(&printing);
    }
    krs_measures_free(printing.measures);
    krs_state_free(state);
    return status;
}
