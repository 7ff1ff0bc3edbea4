/*
 * group_iterations.c: parts of a CSG node that are iterations of one loop (family/iteration.c).
 *
 * What they have in common is lowered once, and is the template of a group.  Slots that depend on the
 * iteration are found for all instances at once.
 */
#include <math.h>
#include <stddef.h>

#include "compiler/graph/instances/iterations.h"
#include "compiler/lower/instance_group.h"

static bool of_one_loop(const Shape *a, const Shape *b)
{
    return a->iterated == b->iterated && (a->shown > 0) == (b->shown > 0);
}

/* Adds the parts from the first one on that are of its loop. */
static InstanceGroup instances_with(const PartFinder *finder, uint32_t first, const bool *taken)
{
    InstanceGroup group = {.template = NULL};
    for (uint32_t i = first; i < finder->count; i++)
        if (!taken[i] && of_one_loop(finder->parts[first], finder->parts[i]))
            array_push_large(finder->outer->scratch, &group.instances, i);
    return group;
}

/* ---- the template ---- */

enum { PART_COMPONENT = PART_SURFACE + offsetof(Surface, component) / sizeof(Node) };

/* Lowers a shared iteration; false: it is empty, too large, or has functions of its own. */
static bool lower_shared(const PartFinder *finder, const Shape *iteration, Node roots[PART_ROOTS])
{
    Graph       *graph     = finder->outer->graph;
    const size_t functions = graph_instances(graph)->functions.count;
    const bool   lowered   = lower_part(finder, iteration->iterated, NULL, roots);
    if (iteration->shown > 0)
        roots[PART_COMPONENT] = graph_uint(graph, iteration->shown);
    return lowered && graph->instances->functions.count == functions;
}

typedef struct IteratedGroup {
    const Graph *graph;
    const Shape *iteration; /* the first */
    bool        *depends;
} IteratedGroup;

static bool iterations(const IteratedGroup *t, Node node)
{
    return node != NODE_NONE && node >= t->iteration->iteration &&
           t->depends[node - t->iteration->iteration];
}

/* Tells whether slots alone depend on the iteration. */
static bool only_in_slots(const IteratedGroup *t, const Template *template)
{
    bool good = true;
    for (uint32_t i = 0; i < template->root_count; i++)
        good = good &&
               (template->roots[i].kind != USE_SAME || !iterations(t, template->roots[i].index));
    for (uint32_t i = 0; good && i < template->node_count; i++)
        for (int k = 0; k < MAX_OPERANDS; k++) {
            const TemplateUse *use = &template->nodes[i].uses[k];
            good                   = good && (use->kind != USE_SAME || !iterations(t, use->index));
        }
    return good;
}

/* ---- what is in the slots ---- */

/* Fills the numbers of one element in all instances; `from` is that of the first, and the next
   follow after `step`.  False: some are not finite. */
static bool fill_element(SlotElement *to, const double *from, size_t step, size_t count,
                         Arena *scratch)
{
    bool varies = false;
    to->number  = from[0];
    to->node    = NODE_NONE;
    for (size_t i = 0; i < count; i++) {
        if (!isfinite(from[i * step]))
            return false;
        varies = varies || from[i * step] != from[0];
    }
    for (size_t i = 0; varies && i < count; i++)
        array_push_large(scratch, &to->numbers, from[i * step]);
    return true;
}

static const double *numbers_of_iterations(const PartFinder *finder, const InstanceGroup *group,
                                           const Shape *first, const Nodes *slots, size_t width)
{
    Arena       *scratch  = finder->outer->scratch;
    const size_t count    = group->instances.count;
    double      *iterated = arena_new_array(scratch, double, count);
    double      *numbers  = arena_new_array(scratch, double, count *width + 1);
    for (size_t i = 0; i < count; i++)
        iterated[i] = finder->parts[group->instances.items[i]]->number;
    graph_at_iterations(finder->outer->graph, slots->items, slots->count, first->iteration,
                        iterated, count, numbers, scratch);
    return numbers;
}

/* Fills the elements of slots that depend on the iteration, which then hold what the first instance
   has. */
static bool fill_iterated(const PartFinder *finder, InstanceGroup *group, const IteratedGroup *t)
{
    Graph *graph       = finder->outer->graph;
    Arena *scratch     = finder->outer->scratch;
    Template *template = group->template;
    const size_t count = group->instances.count;
    Nodes        slots = {0};
    for (uint32_t i = 0; i < template->slot_count; i++)
        if (iterations(t, template->slots[i]))
            array_push(scratch, &slots, template->slots[i]);
    if (graph_needs_parameters(graph, slots.items, slots.count, t->iteration->iteration, scratch))
        return false;
    const size_t  width   = graph_numbers_of(graph, slots.items, slots.count);
    const double *numbers = numbers_of_iterations(finder, group, t->iteration, &slots, width);
    for (uint32_t i = 0; i < template->slot_count; i++) {
        if (!iterations(t, template->slots[i]))
            continue;
        for (uint32_t k = 0; k < components(template->slot_types[i]); k++)
            if (!fill_element(&group->elements[4 * i + k], numbers++, width, count, scratch))
                return false;
        template->slots[i] = graph_in_iteration(graph, template->slots[i], t->iteration->iteration,
                                                t->iteration->number, scratch);
    }
    return true;
}

/* Fills what all instances have, and the number of each component. */
static void fill_others(const PartFinder *finder, InstanceGroup *group, const IteratedGroup *t,
                        const SlotContent *contents)
{
    const Template *template     = group->template;
    const TemplateUse *component = &template->roots[PART_COMPONENT];
    Arena             *scratch   = finder->outer->scratch;
    for (uint32_t i = 0; i < template->slot_count; i++)
        for (uint32_t k = 0; !iterations(t, template->slots[i]) && k < 4; k++) {
            group->elements[4 * i + k].number = contents[i].numbers[k];
            group->elements[4 * i + k].node   = contents[i].nodes[k];
        }
    for (size_t i = 0; t->iteration->shown > 0 && i < group->instances.count; i++)
        array_push_large(scratch, &group->elements[4 * component->index].numbers,
                         (double)finder->parts[group->instances.items[i]]->shown);
}

static bool make_group(const PartFinder *finder, InstanceGroup *group, Arena *arena)
{
    Graph              *graph   = finder->outer->graph;
    Arena              *scratch = finder->outer->scratch;
    IteratedGroup       t       = {graph, finder->parts[group->instances.items[0]], NULL};
    const InstanceGroup found   = *group;
    Node                roots[PART_ROOTS];
    if (!lower_shared(finder, t.iteration, roots))
        return false;
    *group           = group_new(template_new(finder->structures, roots, PART_ROOTS, arena), arena);
    group->instances = found.instances;
    SlotContent *contents = arena_new_array(scratch, SlotContent, group->template->slot_count + 1);
    if (!template_match(finder->structures, group->template, roots, contents))
        return false;
    t.depends = arena_new_array(scratch, bool, graph->count - t.iteration->iteration);
    graph_mark_iterated(graph, t.iteration->iteration, t.depends);
    if (!only_in_slots(&t, group->template))
        return false;
    fill_others(finder, group, &t, contents);
    return fill_iterated(finder, group, &t);
}

void find_iteration_groups(const PartFinder *finder, InstanceGroups *groups, bool *taken,
                           Arena *arena)
{
    for (uint32_t i = 0; i < finder->count; i++) {
        if (finder->parts[i]->kind != SHAPE_ITERATION || taken[i])
            continue;
        /* An operand is cut to its own box (lower_operand), but where its distance is exact. */
        if (finder->operands && !finder->parts[i]->exact)
            continue;
        InstanceGroup group = instances_with(finder, i, taken);
        if (group.instances.count < finder->least || !make_group(finder, &group, arena))
            continue;
        for (size_t k = 0; k < group.instances.count; k++)
            taken[group.instances.items[k]] = true;
        array_push(arena, groups, group);
    }
}
