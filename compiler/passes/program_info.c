/*
 * program_info.c: what the renderer has to know of a program: all fields of KrsProgram except the times
 * and what the pass `emit` sets.
 *
 * They follow from the elaborated scene, the simplified graph with its tapes, and the decisions of
 * the pass `lower`.
 */
#include <assert.h>
#include <math.h>

#include "compiler/passes/compilation.h"
#include "compiler/scene/tables.h"

/* ---- boxes ---- */

static void copy_box(Box box, double low[3], double high[3])
{
    for (int k = 0; k < 3; k++) {
        low[k]  = box.axis[k].low;
        high[k] = box.axis[k].high;
    }
}

/* Finds the box around all components, and the one around those that are not planes. */
static void find_boxes(Compilation *c)
{
    static const Box at_origin = {{{0, 0}, {0, 0}, {0, 0}}};
    KrsProgram      *program   = &c->scene->program;
    Box              rest      = box_empty;
    for (size_t i = 0; i < c->elaborated.components.count; i++) {
        const Component *component = &c->elaborated.components.items[i];
        rest = component_is_plane(component) ? rest : box_hull(rest, component->shape->box);
    }
    copy_box(c->elaborated.box, program->low, program->high);
    copy_box(box_is_empty(rest) ? at_origin : rest, program->rest_low, program->rest_high);
}

/* ---- costs ---- */

/* Finds the cost of krs_distance. */
static void find_costs(Compilation *c)
{
    const Tape *distance = &c->scene->distance;
    KrsProgram *program  = &c->scene->program;
    program->operations  = tape_operations(distance);
    program->flops       = tape_flops(distance);
    program->loops       = tape_loops(distance);
}

/* ---- kinds of scenes ---- */

static void find_kinds(Compilation *c)
{
    const Scene *s       = &c->elaborated;
    KrsProgram  *program = &c->scene->program;
    program->plain       = true;
    for (size_t i = 0; i < s->components.count; i++)
        program->plain = program->plain && !shape_is_curved(s->components.items[i].shape);
    program->mirrors     = s->mirrors;
    program->layers      = s->layers;
    program->films       = s->films;
    program->anisotropic = s->anisotropic;
    for (size_t i = 0; i < s->lights.count; i++)
        program->shadows = program->shadows || s->lights.items[i].shadow;
    program->emits   = c->scene->emissive_count > 0;
    program->volumes = s->volumes.count;
    program->sky_map = s->sky.map != NULL || s->sky.daylight;
}

/* ---- optional roots ---- */

static void find_additions(Compilation *c)
{
    KrsProgram *program      = &c->scene->program;
    program->planes          = c->additions.planes;
    program->camera_relative = c->additions.camera_relative;
    program->open_surfaces   = c->additions.open_surfaces;
    program->algebraic       = c->additions.algebraic;
    program->gradients       = c->additions.gradients;
}

/* Finds whether steps along rays exceed the distance, and whether rays have arcs as images. */
static void find_steps(Compilation *c)
{
    KrsProgram  *program = &c->scene->program;
    const Roots *roots   = &c->scene->roots;
    const Node  *along   = roots_of(roots, ROOTS_ALONG).items;
    for (size_t i = 0; i < c->scene->component_count; i++) {
        const Shape *shape = c->elaborated.components.items[i].shape;
        program->along     = program->along || along[i] != distance_root(roots, i);
        program->inverts   = program->inverts || reaches_inversion(shape);
    }
    program->research = c->options->research;
}

static void find_tables(Compilation *c)
{
    KrsProgram      *program   = &c->scene->program;
    const Instances *instances = c->scene->graph->instances;
    TableSizes       sizes     = tables_measure(instances, c->scene->graph->textures);
    program->table_rows        = sizes.rows;
    program->table_cells       = sizes.cells;
    program->rows_vary         = instances_vary(instances);
    program->table_count       = instances ? instances->tables.count : 0;
    for (size_t t = 0; t < program->table_count; t++)
        program->table_instances += instances->tables.items[t].rows;
}

static void find_textures(Compilation *c)
{
    KrsProgram     *program  = &c->scene->program;
    const Textures *textures = c->scene->graph->textures;
    const Tape     *surface  = &c->scene->surface;
    program->texture_count   = textures ? textures->list.count : 0;
    for (size_t t = 0; t < program->texture_count; t++)
        program->texture_texels += textures->list.items[t].texel_count;
    for (size_t i = 0; i < surface->count; i++) {
        const Op op    = surface->graph->items[surface->nodes[i]].op;
        program->views = program->views || op == OP_VIEW || op == OP_FRONT;
    }
}

static void find_noises(Compilation *c)
{
    const Tape *surface = &c->scene->surface;
    for (size_t i = 0; i < surface->count; i++) {
        const Op op = surface->graph->items[surface->nodes[i]].op;
        c->scene->program.noises += op == OP_noise2 || op == OP_noise3;
    }
}

/* ---- the pass ---- */

KrsStatus pass_info(Compilation *c)
{
    c->scene->program.parameter_slots = (uint32_t)c->scene->graph->parameters.count;
    find_boxes(c);
    find_costs(c);
    find_kinds(c);
    find_additions(c);
    find_steps(c);
    find_tables(c);
    find_textures(c);
    find_noises(c);
    form_march_groups(c); /* needs boxes, costs and planes */
    c->scene->program.scene_parts = module_scene_part_count(c->scene->component_count);
    return KRS_OK;
}

void validate_info(const Compilation *c)
{
    const KrsProgram *program = &c->scene->program;
    assert(program->parameter_slots > 0); /* slot 0 is the time */
    assert(isfinite(program->flops) && program->flops >= 0);
    assert(program->march_group_count != 1 && program->march_group_count <= KRS_MAX_MARCH_GROUPS);
    assert(!program->per_component || program->march_group_count > 0);
    assert(program->gradients || !(program->algebraic || program->open_surfaces));
    assert(!program->open_surfaces || !program->camera_relative);
    assert(program->scene_parts <= c->scene->component_count);
    (void)program;
}

/* ---- as text ---- */

static void print_box(const char *name, const double low[3], const double high[3], Text *out)
{
    text_format(out, "%s  [%.6g, %.6g, %.6g] to [%.6g, %.6g, %.6g]\n", name, low[0], low[1], low[2],
                high[0], high[1], high[2]);
}

static void print_flags(const KrsProgram *program, Text *out)
{
    const struct {
        const char *name;
        bool        is;
    } flags[] = {
        {"planes", program->planes},          {"camera-relative", program->camera_relative},
        {"gradients", program->gradients},    {"algebraic normals", program->algebraic},
        {"steps along rays", program->along}, {"maps that invert", program->inverts},
        {"sheets", program->open_surfaces},   {"no curved shapes", program->plain},
        {"shadows", program->shadows},        {"mirrors", program->mirrors},
        {"layers", program->layers},          {"march groups pay", program->per_component}};
    for (size_t i = 0; i < sizeof flags / sizeof *flags; i++)
        text_format(out, "%s  %s\n", flags[i].name, flags[i].is ? "yes" : "no");
}

void print_info(Compilation *c, Text *out)
{
    const KrsProgram *program = &c->scene->program;
    text_format(out, "parameter slots  %u\n", program->parameter_slots);
    print_box("bounds", program->low, program->high, out);
    print_box("bounds without planes", program->rest_low, program->rest_high, out);
    text_format(out, "operations  %zu\nflops  %.6g\nloops  %u\n", program->operations,
                program->flops, program->loops);
    print_flags(program, out);
    if (program->volumes > 0)
        text_format(out, "media  %zu\n", program->volumes);
    if (program->subsurface)
        text_add(out, "subsurface  yes\n");
    if (program->media) /* a line of its own, since few scenes have any */
        text_add(out, "media  yes\n");
    text_format(out, "scene parts  %u\nexpensive components  %u\nmarch groups  %zu\n",
                program->scene_parts, program->expensive, program->march_group_count);
    for (size_t i = 0; i < program->march_group_count; i++) {
        const KrsMarchGroup *group = &program->march_groups[i];
        text_format(out, "march group %zu  flops %.6g", i + 1, group->flops);
        print_box("", group->low, group->high, out);
    }
}
