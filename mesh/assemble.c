/*
 * assemble.c: krs_assemble meshes the parts of a scene, and finds where their copies are.
 */
#include <stdlib.h>
#include <string.h>

#include "compiler/base/allocator.h"
#include "compiler/base/vec.h"
#include "compiler/field/steps.h"
#include "mesh/mesh.h"
#include "mesh/similarity.h"

/* Items that a search for how far one reaches may visit. */
enum { MAX_VISITS = 1 << 20 };
/* The part of the size by which rounding lets a part stick out of a mirror. */
static const double ROUNDING_OF_MIRRORS = 1e-9;

typedef struct Assembler {
    KrsState             *state;
    const KrsMeshOptions *options;
    const Assembly       *from;
    KrsAssembly          *to;
    ReachSearch           search;
    double               *scales;         /* of items: how much larger a copy is, at most */
    bool                 *separate;       /* of lowered components: has items of its own */
    size_t                meshed, meshes; /* for the fraction of the work */
} Assembler;

/* ---- transforms ---- */

static double number_of(const Assembler *a, Node node, int component)
{
    return a->state->values[node].v[component];
}

static const Node *roots_at(const Assembler *a, uint32_t first)
{
    return roots_of(&a->state->scene->roots, ROOTS_ASSEMBLY).items + first;
}

static void read_mirror(const Assembler *a, uint32_t root, double normal[3], double *offset)
{
    const MirrorRoots *mirror = (const MirrorRoots *)roots_at(a, root);
    for (int k = 0; k < 3; k++)
        normal[k] = number_of(a, mirror->normal, k);
    *offset = number_of(a, mirror->offset, 0);
}

static void read_map(const Assembler *a, uint32_t root, double matrix[3][4])
{
    const MapRoots *map = (const MapRoots *)roots_at(a, root);
    double          rows[3][3], shift[3];
    for (int i = 0; i < 3; i++) {
        shift[i] = number_of(a, map->shift, i);
        for (int k = 0; k < 3; k++)
            rows[i][k] = number_of(a, map->rows[i], k);
    }
    similarity_map(number_of(a, map->scale, 0), (const double(*)[3])rows, shift, matrix);
}

static void read_transform(const Assembler *a, const AssemblyTransform *from, KrsTransform *to)
{
    double normal[3], offset;
    to->item = from->item;
    memcpy(to->matrix, similarity_identity, sizeof to->matrix);
    if (from->kind == PLACED_MAPPED)
        read_map(a, from->root, to->matrix);
    else if (from->kind == PLACED_MIRRORED) {
        read_mirror(a, from->root, normal, &offset);
        similarity_mirror(normal, offset, to->matrix);
    }
}

/* Copies the items of the scene, with room for one of what is not separated, and one of all. */
static bool copy_items(Assembler *a)
{
    size_t       items = a->from->items.count, components = a->state->scene->component_count;
    KrsAssembly *to  = a->to;
    to->items        = allocator_new(&to->allocator, items + 2, sizeof *to->items);
    to->transforms   = allocator_new(&to->allocator, a->from->transforms.count + components,
                                     sizeof *to->transforms);
    a->search.bounds = calloc(items + 2, sizeof *a->search.bounds);
    a->scales        = calloc(items + 2, sizeof *a->scales);
    a->separate      = calloc(components + 1, sizeof *a->separate);
    if (!to->items || !to->transforms || !a->search.bounds || !a->scales || !a->separate)
        return false;
    to->item_count      = items;
    to->transform_count = a->from->transforms.count;
    a->search.assembly  = to;
    for (size_t i = 0; i < to->transform_count; i++)
        read_transform(a, &a->from->transforms.items[i], &to->transforms[i]);
    for (size_t i = 0; i < items; i++) {
        to->items[i].first      = a->from->items.items[i].first;
        to->items[i].count      = a->from->items.items[i].count;
        to->items[i].name       = a->from->items.items[i].name;
        a->search.bounds[i].box = a->from->items.items[i].box;
        find_item_bounds(&a->search, i);
    }
    return true;
}

/* ---- which components are separated ---- */

static bool is_cut(Assembler *a, const AssemblyTransform *transform)
{
    double normal[3], offset;
    if (transform->kind != PLACED_MIRRORED || box_is_empty(a->search.bounds[transform->item].box))
        return false;
    read_mirror(a, transform->root, normal, &offset);
    double most      = offset + ROUNDING_OF_MIRRORS * a->search.bounds[transform->item].ball.radius;
    a->search.visits = MAX_VISITS;
    return reach_along(&a->search, transform->item, similarity_identity, normal, most) > most;
}

/* Tells whether a mirror cuts an item, or one that it is made of; `asked` has answers + 1. */
static bool has_cuts(Assembler *a, size_t number, char *asked)
{
    const AssemblyItem *item = &a->from->items.items[number];
    bool                cut  = false;
    if (asked[number])
        return asked[number] - 1;
    for (size_t i = item->first; i < item->first + item->count && !cut; i++) {
        const AssemblyTransform *transform = &a->from->transforms.items[i];
        cut = has_cuts(a, transform->item, asked) || is_cut(a, transform);
    }
    asked[number] = (char)(1 + cut);
    return cut;
}

static bool is_wanted(const Assembler *a, size_t lowered)
{
    return a->options->component == 0 ||
           a->state->scene->lowered[a->options->component - 1] == lowered;
}

/* Chooses the components that are separated; returns false if none is. */
static bool choose_components(Assembler *a, char *asked)
{
    const uint32_t *of_component = a->from->of_component;
    bool            any          = false;
    for (size_t i = 0; i < a->state->scene->component_count; i++) {
        a->separate[i] = is_wanted(a, i) && of_component[i] != NO_ITEM &&
                         !isinf(a->search.bounds[of_component[i]].ball.radius) &&
                         !has_cuts(a, of_component[i], asked);
        any = any || a->separate[i];
    }
    return any;
}

/* ---- the whole ---- */

static void place_still(KrsAssembly *to, size_t item)
{
    KrsTransform *transform = &to->transforms[to->transform_count++];
    transform->item         = item;
    memcpy(transform->matrix, similarity_identity, sizeof transform->matrix);
}

/* Adds an item for what is not separated, if there is such, and one for all. */
static void add_last_items(Assembler *a)
{
    KrsAssembly *to    = a->to;
    size_t       first = to->transform_count;
    for (size_t i = 0; i < a->state->scene->component_count; i++)
        if (a->separate[i])
            place_still(to, a->from->of_component[i]);
    for (size_t i = 0; i < a->state->scene->component_count; i++)
        if (is_wanted(a, i) && !a->separate[i]) {
            place_still(to, to->item_count++);
            break;
        }
    to->items[to->item_count++] = (KrsItem){.first = first, .count = to->transform_count - first};
}

/* Counts the copies of items, and finds how large they are and where the first is, from the whole
   down to the meshes. */
static void count_copies(Assembler *a)
{
    KrsAssembly *to   = a->to;
    KrsItem     *last = &to->items[to->item_count - 1];
    last->copies = a->scales[to->item_count - 1] = 1;
    memcpy(last->first_copy, similarity_identity, sizeof last->first_copy);
    for (size_t n = to->item_count; n-- > 0;) {
        const KrsItem *item = &to->items[n];
        for (size_t i = item->first; item->copies > 0 && i < item->first + item->count; i++) {
            const KrsTransform *transform = &to->transforms[i];
            KrsItem            *placed    = &to->items[transform->item];
            double             *scale     = &a->scales[transform->item];
            const double(*matrix)[4]      = (const double(*)[4])transform->matrix;
            if (placed->copies == 0)
                similarity_product((const double(*)[4])item->first_copy, matrix,
                                   placed->first_copy);
            placed->copies += item->copies;
            *scale = fmax(*scale, a->scales[n] * similarity_scale(matrix));
        }
    }
}

/* ---- meshes ---- */

static bool report_progress(void *user, double fraction)
{
    const Assembler *a = user;
    return a->options->progress(a->options->user,
                                ((double)a->meshed + fraction) / (double)a->meshes);
}

static KrsStatus mesh_item(Assembler *a, size_t number, const MeshSolid *solid)
{
    KrsMeshOptions options = *a->options;
    options.error /= a->scales[number];
    options.progress = a->options->progress ? report_progress : NULL;
    options.user     = a;
    a->meshed++;
    return mesh_solid(a->state, &options, solid, &a->to->items[number].mesh);
}

static KrsStatus mesh_part(Assembler *a, size_t number)
{
    const AssemblyItem *item  = &a->from->items.items[number];
    Node                root  = *roots_at(a, item->root);
    MeshSolid           solid = {.tape       = &a->from->tape,
                                 .roots      = &root,
                                 .root_count = 1,
                                 .box        = item->box,
                                 .estimate   = item->estimate,
                                 .plain      = has_one_material(a->state->scene, NULL),
                                 .steps      = materials_step(a->state->scene, NULL),
                                 .copy       = (const double(*)[4])a->to->items[number].first_copy};
    return mesh_item(a, number, &solid);
}

/* Makes one mesh of what is not separated. */
static KrsStatus mesh_rest(Assembler *a, size_t number)
{
    const KrsScene *scene  = a->state->scene;
    MeshSolid       solid  = {.roots = malloc(solid_root_bytes(scene))};
    bool           *wanted = calloc(scene->component_count + 1, sizeof *wanted);
    KrsStatus       status = KRS_OUT_OF_MEMORY;
    for (size_t i = 0; wanted && i < scene->component_count; i++)
        wanted[i] = is_wanted(a, i) && !a->separate[i];
    if (wanted && solid.roots) {
        solid_of_components(scene, wanted, &solid);
        status = mesh_item(a, number, &solid);
    }
    free(wanted);
    free(solid.roots);
    return status;
}

static bool is_mesh(const KrsItem *item) { return item->count == 0 && item->copies > 0; }

static KrsStatus mesh_items(Assembler *a)
{
    KrsAssembly *to     = a->to;
    KrsStatus    status = KRS_OK;
    for (size_t i = 0; i < to->item_count; i++)
        a->meshes += is_mesh(&to->items[i]);
    for (size_t i = 0; i < to->item_count && status == KRS_OK; i++) {
        if (is_mesh(&to->items[i]))
            status = i < a->from->items.count ? mesh_part(a, i) : mesh_rest(a, i);
        if (status != KRS_OK)
            break;
        find_item_bounds(&a->search, i);
        if (to->items[i].mesh) {
            to->copies += to->items[i].copies;
            to->triangles += to->items[i].copies * (double)to->items[i].mesh->triangle_count;
        }
    }
    return status;
}

static void find_box(Assembler *a)
{
    for (int k = 0; k < 6; k++) {
        double direction[3] = {0};
        direction[k / 2]    = k % 2 ? 1 : -1;
        a->search.visits    = SIZE_MAX;
        double most = reach_along(&a->search, a->to->item_count - 1, similarity_identity, direction,
                                  -INFINITY);
        *(k % 2 ? &a->to->high[k / 2] : &a->to->low[k / 2]) = k % 2 ? most : -most;
    }
}

/* ---- entry points ---- */

/* Tells whether something that moves would stand still, since it is not separated. */
static bool stands_still(const Assembler *a)
{
    for (size_t i = 0; a->from->motions && i < a->state->scene->component_count; i++)
        if (is_wanted(a, i) && !(a->separate && a->separate[i]) && a->from->motions[i].moves)
            return true;
    return false;
}

static KrsStatus assemble(Assembler *a)
{
    if (!copy_items(a))
        return KRS_OUT_OF_MEMORY;
    char *asked = calloc(a->to->item_count + 1, 1);
    if (!asked)
        return KRS_OUT_OF_MEMORY;
    bool any = choose_components(a, asked);
    free(asked);
    if (stands_still(a))
        return KRS_BAD_SCENE;
    if (!any)
        return KRS_OK;
    add_last_items(a);
    count_copies(a);
    KrsStatus status = mesh_items(a);
    if (status == KRS_OK)
        find_box(a);
    return status;
}

static bool is_possible(const KrsState *state, const KrsMeshOptions *options)
{
    return state->scene->assembly.items.count > 0 && !options->within && state->zone_count == 0 &&
           zone_root(state->scene) == NODE_NONE;
}

KrsStatus krs_assemble(KrsState *state, const KrsMeshOptions *options, KrsAssembly **assembly)
{
    static const KrsMeshOptions none = {0};
    Assembler                   a    = {
                             .state = state, .options = options ? options : &none, .from = &state->scene->assembly};
    *assembly = NULL;
    if (a.options->component > state->scene->shown_count || state->scene->program.open_surfaces)
        return KRS_BAD_ARGUMENT;
    if (!is_possible(state, a.options))
        return stands_still(&a) ? KRS_BAD_SCENE : KRS_OK;
    state_refresh(state);
    a.to = allocator_new(&state->scene->options.allocator, 1, sizeof *a.to);
    if (a.to)
        a.to->allocator = state->scene->options.allocator;
    KrsStatus status = a.to ? assemble(&a) : KRS_OUT_OF_MEMORY;
    if (status == KRS_OK && a.to->copies > 0)
        *assembly = a.to;
    else
        krs_assembly_free(a.to);
    free(a.search.bounds);
    free(a.scales);
    free(a.separate);
    return status;
}

/* Tells whether a mirror cuts an item of which there are copies. */
static bool any_is_cut(Assembler *a)
{
    for (size_t i = 0; i < a->to->item_count; i++)
        find_item_bounds(&a->search, i);
    for (size_t i = 0; i < a->from->items.count; i++) {
        const AssemblyItem *item = &a->from->items.items[i];
        for (uint32_t k = item->first; k < item->first + item->count; k++)
            if (a->to->items[i].copies > 0 && is_cut(a, &a->from->transforms.items[k]))
                return true;
    }
    return false;
}

static bool has_mirrors(const Assembly *assembly)
{
    for (size_t i = 0; i < assembly->transforms.count; i++)
        if (assembly->transforms.items[i].kind == PLACED_MIRRORED)
            return true;
    return false;
}

KrsStatus krs_assembly_transform(KrsState *state, KrsAssembly *assembly)
{
    Assembler a = {.state = state, .from = &state->scene->assembly, .to = assembly};
    state_refresh(state);
    for (size_t i = 0; i < a.from->transforms.count; i++)
        read_transform(&a, &a.from->transforms.items[i], &assembly->transforms[i]);
    if (!has_mirrors(a.from))
        return KRS_OK;
    a.search.assembly = assembly;
    a.search.bounds   = calloc(assembly->item_count + 1, sizeof *a.search.bounds);
    KrsStatus status  = KRS_OUT_OF_MEMORY;
    if (a.search.bounds)
        status = any_is_cut(&a) ? KRS_BAD_SCENE : KRS_OK;
    free(a.search.bounds);
    return status;
}

KrsStatus krs_component_motion(const KrsScene *scene, size_t index, KrsMotion *motion)
{
    if (index >= scene->shown_count || !scene->assembly.motions)
        return KRS_BAD_ARGUMENT;
    *motion = scene->assembly.motions[scene->lowered[index]];
    return KRS_OK;
}

size_t krs_component_beams(KrsState *state, size_t index, KrsBeam *beams)
{
    const KrsScene *scene = state->scene;
    if (index >= scene->shown_count || !scene->assembly.beams || state->zone_count > 0 ||
        zone_root(scene) != NODE_NONE)
        return 0;
    const AssemblyBeams *found = &scene->assembly.beams[index];
    const SceneBeam     *nodes = (const SceneBeam *)(roots_of(&scene->roots, ROOTS_ASSEMBLY).items +
                                                 found->root);
    state_refresh(state);
    for (size_t i = 0; beams && i < found->count; i++)
        for (int end = 0; end < 2; end++) {
            beams[i].radii[end] = state->values[nodes[i].radii[end]].v[0];
            for (int k = 0; k < 3; k++)
                beams[i].ends[end][k] = state->values[nodes[i].ends[end]].v[k];
        }
    return found->count;
}

void krs_assembly_free(KrsAssembly *assembly)
{
    if (!assembly)
        return;
    for (size_t i = 0; assembly->items && i < assembly->item_count; i++)
        krs_mesh_free(assembly->items[i].mesh);
    const KrsAllocator allocator = assembly->allocator;
    allocator_release(&allocator, assembly->items);
    allocator_release(&allocator, assembly->transforms);
    allocator_release(&allocator, assembly);
}

static bool visit_copies(const KrsAssembly *assembly, const KrsItem *item,
                         const double matrix[3][4], KrsVisitCopy *visit, void *user)
{
    if (item->mesh)
        return visit(user, item, matrix);
    for (size_t i = item->first; i < item->first + item->count; i++) {
        const KrsTransform *transform = &assembly->transforms[i];
        double              product[3][4];
        similarity_product(matrix, (const double(*)[4])transform->matrix, product);
        if (!visit_copies(assembly, &assembly->items[transform->item], (const double(*)[4])product,
                          visit, user))
            return false;
    }
    return true;
}

bool krs_assembly_visit(const KrsAssembly *assembly, KrsVisitCopy *visit, void *user)
{
    return visit_copies(assembly, &assembly->items[assembly->item_count - 1], similarity_identity,
                        visit, user);
}
