/*
 * group_find.c: finds the parts of a CSG node that are alike.
 *
 * Parts are lowered where nothing of the CSG node's surroundings is, but for leaves.  All nodes are
 * dropped, and hashes of their expressions are kept.  Of hashes that are frequent enough, the first
 * part is a template of the others, and is lowered again.
 *
 * Of the first hashes the numbers of instances are kept as well.  A template that needs no nodes finds
 * them.  Other instances are lowered again: where there are more hashes, where numbers depend on the
 * frame, and where hashes are equal by chance.
 */
#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/lower/instance_group.h"
#include "compiler/lower/join.h"

/* Hashes whose instances are noted at once; most nodes of one. */
enum { MAX_CANDIDATES = 256, CANDIDATE_SLOTS = 1024, MAX_CANDIDATE_NODES = 10000 };

typedef struct Candidate {
    uint64_t      hash;
    InstanceGroup group;
    bool          again; /* instances are lowered again */
} Candidate;

typedef struct Search {
    const PartFinder *finder;
    Graph            *graph;
    Arena            *arena, *scratch;
    uint64_t         *hashes; /* of each part */
    uint64_t         *sorted;
    Candidate        *candidates;
    uint32_t          candidate_count;
    uint16_t          slots[CANDIDATE_SLOTS]; /* 1 + number of a candidate, by its hash; or 0 */
    InstanceGroups    groups;
    struct {
        SlotContent *items;
        size_t       count, capacity;
    } contents; /* space for those of a part */
} Search;

/* ---- parts ---- */

/* The state that is noted before a part is lowered. */
typedef struct PartMark {
    GraphMark graph;
    uint32_t  made;
} PartMark;

static PartMark part_mark(const Search *search)
{
    return (PartMark){graph_mark(search->graph), *search->finder->made};
}

bool lower_part(const PartFinder *finder, const Shape *shape, struct LoweredGroups *groups,
                Node roots[PART_ROOTS])
{
    const Lowering *outer   = finder->outer;
    Lowering        l       = {.graph       = outer->graph,
                               .scratch     = outer->scratch,
                               .surfaces    = true,
                               .series_step = outer->series_step,
                               .most        = outer->most,
                               .groups      = groups};
    ArenaMark       mark    = arena_mark(outer->scratch);
    Lowered         lowered = finder->operands ? lower_operand(&l, shape, finder->context)
                                               : lower_shape(&l, shape, finder->context);
    arena_rewind(outer->scratch, mark);
    roots[PART_DISTANCE] = lowered.distance;
    memcpy(&roots[PART_SURFACE], &lowered.surface, sizeof lowered.surface);
    return lowered.distance != NODE_NONE && !l.overflow;
}

static bool lower_own(const PartFinder *finder, uint32_t part, Node roots[PART_ROOTS])
{
    return lower_part(finder, finder->parts[part], finder->outer->groups, roots);
}

/* Returns the nodes of the frame in the first `slots` slots. */
static Node *frame_nodes(const Search *search, uint32_t slots, size_t *count)
{
    Node *nodes = arena_new_array(search->scratch, Node, 4 * (size_t)slots + 1);
    *count      = 0;
    for (uint32_t i = 0; i < slots; i++)
        for (int k = 0; k < 4; k++)
            if (search->contents.items[i].nodes[k] != NODE_NONE)
                nodes[(*count)++] = search->contents.items[i].nodes[k];
    return nodes;
}

/* Writes the new numbers of the nodes that stay into the slots. */
static void set_frame_nodes(const Search *search, uint32_t slots, const Node *nodes)
{
    for (uint32_t i = 0; i < slots; i++)
        for (int k = 0; k < 4; k++)
            if (search->contents.items[i].nodes[k] != NODE_NONE)
                search->contents.items[i].nodes[k] = *nodes++;
}

/* Drops what a part was lowered to, unless instance groups of its own parts need it.  What the first `slots`
   slots have stays. */
static void drop_part(const Search *search, PartMark mark, uint32_t slots)
{
    if (*search->finder->made != mark.made) {
        graph_keep(search->graph);
        return;
    }
    ArenaMark scratch = arena_mark(search->scratch);
    size_t    count;
    Node     *nodes = frame_nodes(search, slots, &count);
    graph_release_but(search->graph, mark.graph, nodes, count, search->scratch);
    structures_forget(search->finder->structures, mark.graph.count);
    set_frame_nodes(search, slots, nodes);
    arena_rewind(search->scratch, scratch);
}

static bool matches(Search *search, const Template *template, const Node *roots)
{
    while (search->contents.count < template->slot_count)
        array_push(search->scratch, &search->contents, ((SlotContent){{0}, {0}}));
    return template_match(search->finder->structures, template, roots, search->contents.items);
}

/* ---- candidates ---- */

static uint16_t *candidate_slot(Search *search, uint64_t hash)
{
    size_t slot = (hash >> 32) % CANDIDATE_SLOTS;
    while (search->slots[slot] && search->candidates[search->slots[slot] - 1].hash != hash)
        slot = (slot + 1) % CANDIDATE_SLOTS;
    return &search->slots[slot];
}

/* Finds the candidate of a hash; NULL: instances with this hash are lowered again. */
static Candidate *find_candidate(Search *search, uint64_t hash)
{
    uint16_t number = *candidate_slot(search, hash);
    if (number == 0 || search->candidates[number - 1].again)
        return NULL;
    return &search->candidates[number - 1];
}

/* Adds a candidate for a hash seen for the first time. */
static void add_candidate(Search *search, uint64_t hash, const Node *roots, size_t first)
{
    Structures *structures = search->finder->structures;
    if (search->candidate_count == MAX_CANDIDATES)
        return;
    Candidate *candidate          = &search->candidates[search->candidate_count++];
    *candidate                    = (Candidate){.hash = hash, .again = true};
    *candidate_slot(search, hash) = (uint16_t)search->candidate_count;
    if (search->graph->count - first > MAX_CANDIDATE_NODES)
        return;
    Template *template = template_new(structures, roots, PART_ROOTS, search->scratch);
    candidate->again   = !template_detach(structures, template, first, search->scratch);
    candidate->group   = group_new(template, search->scratch);
}

static bool all_known(const Search *search, uint32_t slots)
{
    for (uint32_t i = 0; i < slots; i++)
        for (int k = 0; k < 4; k++)
            if (search->contents.items[i].nodes[k] != NODE_NONE)
                return false;
    return true;
}

/* Tells whether the numbers of a part are found; they are in search->contents. */
static bool note_numbers(Search *search, uint64_t hash, const Node *roots, size_t first)
{
    if (*candidate_slot(search, hash) == 0)
        add_candidate(search, hash, roots, first);
    Candidate *candidate = find_candidate(search, hash);
    if (!candidate)
        return false;
    const Template *template = candidate->group.template;
    candidate->again         = !matches(search, template, roots) ||
                       !all_known(search, template->slot_count);
    return !candidate->again;
}

static void hash_part(Search *search, uint32_t part)
{
    Node     roots[PART_ROOTS];
    bool     noted = false;
    uint64_t hash  = 0;
    PartMark mark  = part_mark(search);
    if (lower_own(search->finder, part, roots)) {
        hash  = structure_hash(search->finder->structures, roots, PART_ROOTS) | 1;
        noted = note_numbers(search, hash, roots, mark.graph.count);
    }
    drop_part(search, mark, 0);
    if (noted)
        group_add(&find_candidate(search, hash)->group, part, search->contents.items,
                  search->scratch);
    search->hashes[part] = search->sorted[part] = hash;
}

/* ---- frequent hashes ---- */

static int compare_hashes(const void *a, const void *b)
{
    uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return (x > y) - (x < y);
}

/* Tells how many hashes are less. */
static uint32_t rank(const Search *search, uint64_t hash)
{
    uint32_t low = 0, high = search->finder->count;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (search->sorted[middle] < hash)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static bool is_frequent(const Search *search, uint64_t hash)
{
    return hash != 0 && rank(search, hash + 1) - rank(search, hash) >= search->finder->least;
}

/* ---- groups ---- */

static InstanceGroup *find_group(Search *search, const Node *roots)
{
    uint64_t hash = structure_hash(search->finder->structures, roots, PART_ROOTS);
    for (size_t i = 0; i < search->groups.count; i++) {
        InstanceGroup *group = &search->groups.items[i];
        if (group->template->hash == hash && matches(search, group->template, roots))
            return group;
    }
    return NULL;
}

static InstanceGroup *new_group(Search *search, const Node *roots)
{
    Structures   *structures = search->finder->structures;
    InstanceGroup group      = group_new(template_new(structures, roots, PART_ROOTS, search->arena),
                                         search->arena);
    matches(search, group.template, roots);
    array_push(search->arena, &search->groups, group);
    return &search->groups.items[search->groups.count - 1];
}

/* Groups the instances like one that is lowered again. */
static void group_part(Search *search, uint32_t part)
{
    Node           roots[PART_ROOTS];
    PartMark       mark  = part_mark(search);
    bool           there = lower_own(search->finder, part, roots);
    InstanceGroup *group = there ? find_group(search, roots) : NULL;
    if (group || !there)
        drop_part(search, mark, group ? group->template->slot_count : 0);
    else {
        graph_keep(search->graph);
        group = new_group(search, roots);
    }
    if (there)
        group_add(group, part, search->contents.items, search->scratch);
}

/* Groups all instances of a candidate, of which the first is lowered again. */
static void group_candidate(Search *search, const Candidate *candidate)
{
    const InstanceGroup *noted = &candidate->group;
    group_part(search, noted->instances.items[0]);
    InstanceGroup *group = &search->groups.items[search->groups.count - 1];
    assert(group->instances.count == 1 &&
           group->template->slot_count == noted->template->slot_count);
    group->instances = noted->instances;
    memcpy(group->elements, noted->elements,
           4 * (size_t)noted->template->slot_count * sizeof *group->elements);
}

InstanceGroups find_groups(const PartFinder *finder, Arena *arena)
{
    Arena   *scratch = finder->outer->scratch;
    uint32_t count   = finder->count;
    Search  *search  = arena_new(scratch, Search);
    *search          = (Search){.finder     = finder,
                                .graph      = finder->outer->graph,
                                .arena      = arena,
                                .scratch    = scratch,
                                .hashes     = arena_new_array(scratch, uint64_t, count),
                                .sorted     = arena_new_array(scratch, uint64_t, count),
                                .candidates = arena_new_array(scratch, Candidate, MAX_CANDIDATES)};
    bool *taken      = arena_new_array(scratch, bool, count + 1);
    find_iteration_groups(finder, &search->groups, taken, arena);
    for (uint32_t i = 0; i < count; i++)
        if (!taken[i])
            hash_part(search, i);
    qsort(search->sorted, count, sizeof *search->sorted, compare_hashes);
    for (uint32_t i = 0; i < count; i++) {
        if (!is_frequent(search, search->hashes[i]))
            continue;
        const Candidate *candidate = find_candidate(search, search->hashes[i]);
        if (!candidate)
            group_part(search, i);
        else if (candidate->group.instances.items[0] == i)
            group_candidate(search, candidate);
    }
    return search->groups;
}
