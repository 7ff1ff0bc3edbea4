/*
 * changes.c: finds what is different in a scene that was edited.
 *
 * Two scenes have the same shaders if these are made of the same nodes, apart from numbers of the
 * state, and if all else that decides about their text is equal.  Some constants never get into the
 * text, and tables of instance groups and textures do not, but what is derived from them may.  So scenes of
 * which nodes, tables or textures differ are compared by their text as well.
 */
#include "compiler/scene/changes.h"

#include <stdlib.h>
#include <string.h>

#include "compiler/graph/instance_table.h"
#include "compiler/graph/texture.h"

/* The likeness of two parts of scenes, the least first. */
typedef enum Likeness { DIFFERENT, ALIKE_BUT_NUMBERS, EQUAL } Likeness;

static Likeness equal_if(bool equal) { return equal ? EQUAL : DIFFERENT; }

static Likeness least(Likeness a, Likeness b) { return a < b ? a : b; }

typedef struct Comparison {
    const KrsScene *a, *b;
    Memory          memory;
    Arena           arena;
    KrsChanges      changes;
} Comparison;

/* ---- graphs ---- */

typedef struct RootList {
    Node  *items;
    size_t count, capacity;
} RootList;

/* Adds the nodes that functions of instance groups and their tables have. */
static void add_groups(RootList *list, const KrsScene *scene, Arena *arena)
{
    const Instances *instances = scene->graph->instances;
    for (size_t i = 0; instances && i < instances->bodies.count; i++)
        array_push(arena, list, instances->bodies.items[i]);
    for (size_t i = 0; instances && i < instances->frame_numbers.count; i++)
        array_push(arena, list, instances->frame_numbers.items[i]);
}

/* Returns the roots that shaders are made of, or those of the view. */
static RootList collect_roots(const KrsScene *scene, bool of_shaders, RootKind first, RootKind last,
                              Arena *arena)
{
    RootList list = {0};
    for (RootKind kind = first; kind <= last; kind++) {
        RootRange range = roots_of(&scene->roots, kind);
        bool      view  = kind >= ROOTS_CAMERA && kind <= ROOTS_SKY;
        for (size_t i = 0; i < range.count && view != of_shaders; i++)
            array_push(arena, &list, range.items[i]);
    }
    if (of_shaders)
        add_groups(&list, scene, arena);
    return list;
}

/* Returns the roots that say what is solid, of which meshes of shapes alone are made. */
static RootList collect_solid_roots(const KrsScene *scene, Arena *arena)
{
    static const RootKind kinds[] = {ROOTS_ZONE, ROOTS_SLOPE, ROOTS_BOX, ROOTS_ASSEMBLY};
    RootList              list    = {0};
    for (size_t i = 0; i < scene->component_count; i++)
        array_push(arena, &list, distance_root(&scene->roots, i));
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        RootRange range = roots_of(&scene->roots, kinds[k]);
        for (size_t i = 0; i < range.count; i++)
            array_push(arena, &list, range.items[i]);
    }
    add_groups(&list, scene, arena);
    return list;
}

static Likeness compare_nodes(const Tape *a, const Tape *b, size_t at)
{
    const Expr *x = &a->graph->items[a->nodes[at]], *y = &b->graph->items[b->nodes[at]];
    if (x->op != y->op || x->type != y->type || x->operand_count != y->operand_count)
        return DIFFERENT;
    for (uint32_t k = 0; k < x->operand_count; k++)
        if (tape_index(a, x->operands[k]) != tape_index(b, y->operands[k]))
            return DIFFERENT;
    bool same_number = x->operand_count > 0 || memcmp(x->number, y->number, sizeof x->number) == 0;
    if (x->op == OP_PARAMETERISED)
        return same_number ? EQUAL : ALIKE_BUT_NUMBERS;
    return equal_if(x->index == y->index && same_number);
}

/* Compares roots, with all nodes that they need. */
static Likeness compare_roots(Comparison *c, RootList a, RootList b)
{
    Tape     x     = tape_new(c->a->graph, a.items, a.count, &c->arena);
    Tape     y     = tape_new(c->b->graph, b.items, b.count, &c->arena);
    Likeness found = equal_if(a.count == b.count && x.count == y.count &&
                              x.frame_count == y.frame_count);
    for (size_t i = 0; i < x.count && found != DIFFERENT; i++)
        found = least(found, compare_nodes(&x, &y, i));
    for (size_t i = 0; i < a.count && found != DIFFERENT; i++)
        found = least(found, equal_if(tape_index(&x, a.items[i]) == tape_index(&y, b.items[i])));
    return found;
}

/* Compares the roots of these kinds. */
static Likeness compare_graphs(Comparison *c, bool of_shaders, RootKind first, RootKind last)
{
    return compare_roots(c, collect_roots(c->a, of_shaders, first, last, &c->arena),
                         collect_roots(c->b, of_shaders, first, last, &c->arena));
}

/* ---- instance groups ---- */

static size_t table_count(const Instances *instances)
{
    return instances ? instances->tables.count : 0;
}

static size_t function_count(const Instances *instances)
{
    return instances ? instances->functions.count : 0;
}

static bool same_lists(const Grid *a, const Grid *b, size_t cells)
{
    const size_t entries = a->first[cells]; /* none where all boxes are empty */
    return memcmp(a->first, b->first, (cells + 1) * sizeof *a->first) == 0 &&
           (entries == 0 ||
            memcmp(a->instances, b->instances, entries * sizeof *a->instances) == 0);
}

static bool same_tails(const Grid *a, const Grid *b, size_t cells)
{
    const size_t entries = a->first[cells];
    if (!a->tails || !b->tails)
        return a->tails == b->tails;
    return memcmp(a->middles, b->middles, cells * sizeof *a->middles) == 0 &&
           (entries == 0 || memcmp(a->tails, b->tails, entries * sizeof *a->tails) == 0);
}

static bool same_grid(const Grid *a, const Grid *b)
{
    const size_t cells = grid_cell_count(a);
    return memcmp(&a->inner, &b->inner, sizeof a->inner) == 0 &&
           memcmp(a->low, b->low, sizeof a->low) == 0 && a->size == b->size &&
           memcmp(a->cells, b->cells, sizeof a->cells) == 0 &&
           memcmp(a->clearance, b->clearance, cells * sizeof *a->clearance) == 0 &&
           same_lists(a, b, cells) && same_tails(a, b, cells);
}

/* Compares columns of the frame, whose nodes are compared with the graph. */
static bool same_frame_columns(const InstanceTable *a, const InstanceTable *b)
{
    if (!a->frame_columns || !b->frame_columns)
        return a->frame_columns == b->frame_columns;
    return memcmp(a->frame_columns, b->frame_columns, a->columns * sizeof *a->frame_columns) == 0;
}

static bool same_places(const InstanceTable *a, const InstanceTable *b)
{
    if (!a->places || !b->places)
        return a->places == b->places;
    bool same = a->first_place == b->first_place && a->reach == b->reach && a->margin == b->margin;
    for (uint32_t i = 0; same && i < a->rows; i++)
        same = a->places[i].kind == b->places[i].kind &&
               memcmp(&a->places[i].box, &b->places[i].box, sizeof a->places[i].box) == 0;
    return same;
}

static bool same_table(const InstanceTable *a, const InstanceTable *b)
{
    const size_t numbers = (size_t)a->rows * a->columns;
    return a->rows == b->rows && a->columns == b->columns && a->stretch == b->stretch &&
           a->fades == b->fades && a->slope == b->slope && same_frame_columns(a, b) &&
           same_places(a, b) && memcmp(a->numbers, b->numbers, numbers * sizeof *a->numbers) == 0 &&
           same_grid(&a->grid, &b->grid) && same_grid(&a->cells, &b->cells);
}

static bool same_function(const InstanceFunction *a, const InstanceFunction *b)
{
    bool same = a->table_number == b->table_number && a->type == b->type && a->clear == b->clear &&
                a->either == b->either && a->sums == b->sums && a->ends == b->ends &&
                a->joins == b->joins && a->listed == b->listed &&
                a->state_count == b->state_count && a->distance == b->distance &&
                a->first_body == b->first_body;
    for (uint32_t i = 0; same && i < a->state_count; i++)
        same = a->states[i].type == b->states[i].type &&
               memcmp(a->states[i].first, b->states[i].first, sizeof a->states[i].first) == 0;
    return same;
}

/* Compares instances, whose bodies are compared with the graph. */
static bool same_instances(const Instances *a, const Instances *b)
{
    bool same = table_count(a) == table_count(b) && function_count(a) == function_count(b);
    for (size_t i = 0; same && i < function_count(a); i++)
        same = same_function(&a->functions.items[i], &b->functions.items[i]);
    for (size_t i = 0; same && i < table_count(a); i++)
        same = same_table(&a->tables.items[i], &b->tables.items[i]);
    return same;
}

static bool same_texture(const Texture *a, const Texture *b)
{
    return a->wrap == b->wrap && a->gray == b->gray && a->level_count == b->level_count &&
           memcmp(&a->levels, &b->levels, sizeof a->levels) == 0 &&
           memcmp(a->texels, b->texels, a->texel_count * sizeof *a->texels) == 0;
}

static size_t texture_count(const Textures *textures)
{
    return textures ? textures->list.count : 0;
}

static bool same_textures(const Textures *a, const Textures *b)
{
    bool same = texture_count(a) == texture_count(b);
    for (size_t i = 0; same && i < texture_count(a); i++)
        same = same_texture(&a->list.items[i], &b->list.items[i]);
    return same;
}

/* ---- what decides about shaders beside the graph ---- */

static bool same_slots(const KrsProgram *a, const KrsProgram *b)
{
    return a->parameter_slots == b->parameter_slots && a->value_slots == b->value_slots &&
           a->camera_relative_slots == b->camera_relative_slots;
}

static bool same_methods(const KrsProgram *a, const KrsProgram *b)
{
    return a->planes == b->planes && a->camera_relative == b->camera_relative &&
           a->gradients == b->gradients && a->algebraic == b->algebraic && a->along == b->along &&
           a->open_surfaces == b->open_surfaces && a->inverts == b->inverts &&
           a->research == b->research && a->plain == b->plain &&
           a->march_group_count == b->march_group_count && a->per_component == b->per_component &&
           a->scene_parts == b->scene_parts && a->expensive == b->expensive;
}

/* Tells whether shaders treat the boxes alike; corners are numbers of the state. */
static bool same_kinds_of_boxes(const KrsScene *a, const KrsScene *b)
{
    bool same = true;
    for (size_t i = 0; i < a->component_count; i++) {
        const Box *x = &a->module.boxes[i], *y = &b->module.boxes[i];
        same = same && box_is_empty(*x) == box_is_empty(*y) &&
               box_is_finite(*x) == box_is_finite(*y);
    }
    return same;
}

static bool same_groups(const Module *a, const Module *b)
{
    size_t count = a->components;
    if (!a->march_groups != !b->march_groups || !a->is_plane != !b->is_plane ||
        !a->is_subsurface != !b->is_subsurface)
        return false;
    return (!a->march_groups ||
            memcmp(a->march_groups, b->march_groups, count * sizeof *a->march_groups) == 0) &&
           (!a->is_plane || memcmp(a->is_plane, b->is_plane, count * sizeof *a->is_plane) == 0) &&
           (!a->is_subsurface ||
            memcmp(a->is_subsurface, b->is_subsurface, count * sizeof *a->is_subsurface) == 0);
}

static bool same_volumes(const KrsScene *a, const KrsScene *b)
{
    bool same = a->volume_count == b->volume_count;
    for (size_t i = 0; same && i < a->volume_count; i++)
        same = a->volumes[i].before == b->volumes[i].before;
    return same;
}

static bool same_info(const KrsScene *a, const KrsScene *b)
{
    return a->component_count == b->component_count && a->zone_count == b->zone_count &&
           krs_scene_is_panoramic(a) == krs_scene_is_panoramic(b) &&
           krs_scene_has_lens(a) == krs_scene_has_lens(b) &&
           a->program.sky_map == b->program.sky_map && a->program.emits == b->program.emits &&
           a->program.films == b->program.films && a->program.volumes == b->program.volumes &&
           same_volumes(a, b) && a->program.anisotropic == b->program.anisotropic &&
           a->program.subsurface == b->program.subsurface && same_slots(&a->program, &b->program) &&
           same_methods(&a->program, &b->program) && a->module.has_slopes == b->module.has_slopes &&
           !a->module.box_nodes.around == !b->module.box_nodes.around &&
           same_kinds_of_boxes(a, b) && same_groups(&a->module, &b->module);
}

/* ---- texts ---- */

static bool same_text(Comparison *c, const KrsVariant *variant)
{
    return strcmp(scene_plain_text(c->a, variant, &c->arena),
                  scene_plain_text(c->b, variant, &c->arena)) == 0;
}

/* Tells whether shaders of the same info have the same text. */
static bool same_texts(Comparison *c)
{
    return same_text(c, &(KrsVariant){.values = true}) &&
           same_text(c, &(KrsVariant){.values = true, .many_threads = true}) &&
           (!c->a->program.camera_relative ||
            same_text(c, &(KrsVariant){.values = true, .camera_relative = true}));
}

static Likeness compare_shaders(Comparison *c)
{
    if (!same_info(c->a, c->b))
        return DIFFERENT;
    Likeness found = compare_graphs(c, true, ROOTS_SURFACE, ROOT_KINDS - 1);
    found = least(found, equal_if(same_instances(c->a->graph->instances, c->b->graph->instances)));
    found = least(found, equal_if(same_textures(c->a->graph->textures, c->b->graph->textures)));
    return found != DIFFERENT || !same_texts(c) ? found : ALIKE_BUT_NUMBERS;
}

/* ---- the rest of a scene ---- */

static bool same_name(const char *a, const char *b)
{
    return a == b || (a && b && strcmp(a, b) == 0);
}

static bool same_parameters(const KrsScene *a, const KrsScene *b)
{
    bool same = a->parameter_count == b->parameter_count;
    for (size_t i = 0; same && i < a->parameter_count; i++) {
        const Parameter *x = &a->parameters[i], *y = &b->parameters[i];
        same = same_name(x->name, y->name) && x->components == y->components &&
               memcmp(x->value, y->value, sizeof x->value) == 0 &&
               memcmp(x->low, y->low, sizeof x->low) == 0 &&
               memcmp(x->high, y->high, sizeof x->high) == 0;
    }
    return same;
}

static bool same_components(const KrsScene *a, const KrsScene *b)
{
    bool same = a->shown_count == b->shown_count;
    for (size_t i = 0; same && i < a->shown_count; i++)
        same = same_name(a->components[i].name, b->components[i].name);
    return same;
}

/* Compares what the compiler knows of components: it bounds rays, also where the graph is the
   same. */
static bool same_bounds(const KrsScene *a, const KrsScene *b)
{
    bool same = a->slope_count == b->slope_count;
    for (size_t i = 0; same && i < a->slope_count; i++)
        same = a->slopes[i].slot == b->slopes[i].slot &&
               memcmp(&a->slopes[i].task.box, &b->slopes[i].task.box,
                      sizeof a->slopes[i].task.box) == 0;
    for (size_t i = 0; same && i < a->shown_count; i++)
        same = memcmp(a->components[i].low, b->components[i].low, sizeof(double[3])) == 0 &&
               memcmp(a->components[i].high, b->components[i].high, sizeof(double[3])) == 0;
    return same;
}

static bool same_cameras(const KrsScene *a, const KrsScene *b)
{
    bool same = a->camera_count == b->camera_count && a->framed == b->framed;
    for (size_t i = 0; same && i < a->camera_count; i++)
        same = same_name(a->cameras[i].name, b->cameras[i].name) &&
#define KRS_CAMERA_FIXED(name, type, part, counts) a->cameras[i].name == b->cameras[i].name &&
#include "krs/camera.def"
               true;
    return same && memcmp(a->framed_eye, b->framed_eye, sizeof a->framed_eye) == 0 &&
           memcmp(a->framed_target, b->framed_target, sizeof a->framed_target) == 0;
}

static bool same_lights(const KrsScene *a, const KrsScene *b)
{
    bool same = a->light_count == b->light_count;
    for (size_t i = 0; same && i < a->light_count; i++)
        same = same_name(a->lights[i].name, b->lights[i].name) &&
               a->lights[i].positional == b->lights[i].positional &&
               a->lights[i].colored == b->lights[i].colored &&
               a->lights[i].shadow == b->lights[i].shadow &&
               a->lights[i].type == b->lights[i].type && a->lights[i].spot == b->lights[i].spot;
    return same;
}

static bool same_sky(const KrsScene *a, const KrsScene *b)
{
    const KrsSkyMap *x = a->sky_map, *y = b->sky_map;
    return (x == y || (x && y && x->version == y->version)) && a->daylight == b->daylight &&
           a->daylight_by == b->daylight_by;
}

static bool same_image(const SceneImage *a, const SceneImage *b)
{
    return a->width == b->width && a->height == b->height && a->samples == b->samples &&
           a->bounces == b->bounces && same_name(a->integrator, b->integrator) &&
           same_name(a->tone_map, b->tone_map) && same_name(a->pixel_filter, b->pixel_filter) &&
           a->exposure == b->exposure && a->error == b->error && a->noise == b->noise &&
           a->white_balance[0] == b->white_balance[0] && a->white_balance[1] == b->white_balance[1];
}

/* ---- what meshes are made of ---- */

static bool same_items(const Assembly *a, const Assembly *b)
{
    bool same = a->items.count == b->items.count;
    for (size_t i = 0; same && i < a->items.count; i++) {
        const AssemblyItem *x = &a->items.items[i], *y = &b->items.items[i];
        same = x->first == y->first && x->count == y->count && x->root == y->root &&
               x->estimate == y->estimate && memcmp(&x->box, &y->box, sizeof x->box) == 0;
    }
    return same;
}

static bool same_placings(const Assembly *a, const Assembly *b)
{
    bool same = a->transforms.count == b->transforms.count;
    for (size_t i = 0; same && i < a->transforms.count; i++) {
        const AssemblyTransform *x = &a->transforms.items[i], *y = &b->transforms.items[i];
        same = x->item == y->item && x->kind == y->kind && x->root == y->root;
    }
    return same;
}

/* Tells whether the components, as many in both, are parts of the same items. */
static bool same_parts(const KrsScene *a, const KrsScene *b)
{
    const Assembly *x = &a->assembly, *y = &b->assembly;
    bool same = same_items(x, y) && same_placings(x, y) && !x->of_component == !y->of_component &&
                !x->motions == !y->motions && !x->beams == !y->beams;
    for (size_t i = 0; same && i < a->component_count; i++) {
        same = !x->of_component || x->of_component[i] == y->of_component[i];
        if (same && x->motions)
            same = memcmp(&x->motions[i], &y->motions[i], sizeof *x->motions) == 0;
    }
    for (size_t i = 0; same && x->beams && i < a->shown_count; i++)
        same = x->beams[i].root == y->beams[i].root && x->beams[i].count == y->beams[i].count;
    return same;
}

/* Compares all that is shown. */
static bool same_shown(const KrsScene *a, const KrsScene *b)
{
    bool same = a->component_count == b->component_count && a->shown_count == b->shown_count;
    for (size_t i = 0; same && i < a->shown_count; i++) {
        const KrsComponent *x = &a->components[i], *y = &b->components[i];
        same = a->lowered[i] == b->lowered[i] && a->rank[i] == b->rank[i] &&
               x->estimate == y->estimate && x->figure == y->figure && x->levels == y->levels &&
               x->instances == y->instances && memcmp(x->low, y->low, sizeof x->low) == 0 &&
               memcmp(x->high, y->high, sizeof x->high) == 0;
    }
    return same && same_parts(a, b);
}

static bool same_solids(Comparison *c)
{
    return same_shown(c->a, c->b) && same_parameters(c->a, c->b) && same_bounds(c->a, c->b) &&
           compare_roots(c, collect_solid_roots(c->a, &c->arena),
                         collect_solid_roots(c->b, &c->arena)) == EQUAL &&
           same_instances(c->a->graph->instances, c->b->graph->instances) &&
           same_textures(c->a->graph->textures, c->b->graph->textures);
}

/* Tells whether names that files of meshes have are the same: of components, materials and
   parts. */
static bool same_names(const KrsScene *a, const KrsScene *b)
{
    bool same = a->shown_count == b->shown_count && a->material_count == b->material_count &&
                a->assembly.items.count == b->assembly.items.count;
    for (size_t i = 0; same && i < a->shown_count; i++)
        same = same_name(a->components[i].name, b->components[i].name);
    for (size_t i = 0; same && i < a->material_count; i++)
        same = same_name(a->materials[i], b->materials[i]);
    for (size_t i = 0; same && i < a->assembly.items.count; i++)
        same = same_name(a->assembly.items.items[i].name, b->assembly.items.items[i].name);
    return same;
}

/* ---- all together ---- */

static void compare(Comparison *c)
{
    KrsChanges *changes = &c->changes;
    Likeness    shaders = compare_shaders(c);
    changes->parameters = !same_parameters(c->a, c->b);
    changes->components = !same_components(c->a, c->b);
    changes->cameras    = !same_cameras(c->a, c->b) ||
                       compare_graphs(c, false, ROOTS_CAMERA, ROOTS_CAMERA) != EQUAL;
    changes->lights = !same_lights(c->a, c->b) || !same_sky(c->a, c->b) ||
                      compare_graphs(c, false, ROOTS_LIGHT, ROOTS_SKY) != EQUAL;
    changes->image = !same_image(&c->a->image, &c->b->image);
    bool values = shaders != EQUAL || changes->parameters || changes->cameras || changes->lights ||
                  changes->image || !same_bounds(c->a, c->b);
    changes->kind     = shaders == DIFFERENT ? KRS_CHANGE_STRUCTURE
                        : values             ? KRS_CHANGE_VALUES
                                             : KRS_CHANGE_NOTHING;
    changes->solids   = !same_solids(c);
    changes->surfaces = changes->solids || shaders != EQUAL || !same_names(c->a, c->b);
}

/* Compares scenes; where memory runs out, longjmp returns here. */
static KrsStatus compare_guarded(Comparison *c)
{
    jmp_buf exhausted;
    c->memory.exhausted = &exhausted;
    if (setjmp(exhausted) != 0)
        return KRS_OUT_OF_MEMORY;
    compare(c);
    return KRS_OK;
}

KrsStatus scene_changes(const KrsScene *a, const KrsScene *b, KrsChanges *changes)
{
    const KrsAllocator *allocator = &a->options.allocator;
    Comparison          c         = {.a      = a,
                                     .b      = b,
                                     .memory = {.allocate = allocator->allocate,
                                                .release  = allocator->release,
                                                .user     = allocator->user}};
    c.arena.memory                = &c.memory;
    KrsStatus status              = compare_guarded(&c);
    arena_free(&c.arena);
    *changes = c.changes;
    return status;
}
