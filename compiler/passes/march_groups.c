/*
 * march_groups.c: decides which components are marched by themselves (KrsMarchGroup in compiled.h).
 */
#include <math.h>

#include "compiler/passes/compilation.h"

/* Least flops of a component that counts as expensive, and of a scene where such are marched by
   themselves.  Scenes whose boxes overlap need more, since they gain less.  Measured by bench/krs.c. */
static const double EXPENSIVE_FLOPS = 100, SCATTERED_FLOPS = 1000, MIXED_FLOPS = 2000;
/* A group has shaders of its own, which take longer to compile than they save in a small picture.
   So where groups are marched by themselves, components below SEPARATE_FLOPS share one, as long as
   that stays below SHARED_FLOPS. */
static const double SEPARATE_FLOPS = 300, SHARED_FLOPS = 1000;
/* A component whose box a group's box contains, but for a little, shares that group: rays of nearly all
   tiles meet the group anyway.  In scenes below MIXED_FLOPS such a group would have most of the scene,
   and 05-rock takes 3 % longer. */
static const double NESTED_FLOPS = 450, NESTED_VOLUME = 1.25;

/* The part of all flops from which marching one group by itself saves nothing. */
static const double MAX_OF_SCENE = 0.9;

static double component_flops(Compilation *c, size_t component)
{
    Node distance = distance_root(&c->scene->roots, component);
    Tape tape     = tape_new(c->scene->graph, &distance, 1, &c->scratch);
    return tape_flops(&tape);
}

static double volume_of(Box box)
{
    double volume = 1;
    for (int i = 0; i < 3; i++)
        volume *= box.axis[i].high - box.axis[i].low;
    return volume;
}

static Box box_of_group(const KrsMarchGroup *group)
{
    Box box;
    for (int i = 0; i < 3; i++)
        box.axis[i] = (Range){group->low[i], group->high[i]};
    return box;
}

/* Returns the index of a group that a component should share; or the number of groups. */
static size_t find_nested(const KrsProgram *program, double flops, Box box)
{
    size_t i = program->march_group_count;
    if (flops >= NESTED_FLOPS || program->flops < MIXED_FLOPS)
        return i;
    for (i = 0; i < program->march_group_count; i++) {
        const KrsMarchGroup *group = &program->march_groups[i];
        const Box            own   = box_of_group(group);
        const double         most  = fmax(volume_of(own), volume_of(box));
        if (group->flops + flops <= SHARED_FLOPS &&
            volume_of(box_hull(own, box)) <= NESTED_VOLUME * most)
            break;
    }
    return i;
}

/* Returns the index of a component's group: a new one if the component is expensive and bounded,
   and groups are left; or one that it is nested with.  Else that of the last group, which has all
   other components. */
static size_t choose_march_group(const KrsProgram *program, double flops, double rest_flops,
                                 Box box)
{
    const bool shares = flops < SEPARATE_FLOPS && program->flops >= SCATTERED_FLOPS &&
                        rest_flops + flops <= SHARED_FLOPS;
    bool own = flops >= EXPENSIVE_FLOPS && !shares && box_is_finite(box) && !box_is_empty(box);
    if (!own)
        return KRS_MAX_MARCH_GROUPS - 1;
    size_t nested = find_nested(program, flops, box);
    return nested < KRS_MAX_MARCH_GROUPS - 1 ? nested : KRS_MAX_MARCH_GROUPS - 1;
}

/* Makes a group larger by a component. */
static void extend_march_group(KrsMarchGroup *group, double flops, Box box)
{
    Box hull = box_hull(box_of_group(group), box);
    group->flops += flops;
    for (int i = 0; i < 3; i++) {
        group->low[i]  = hull.axis[i].low;
        group->high[i] = hull.axis[i].high;
    }
}

static void add_march_group(KrsProgram *program, double flops, Box box)
{
    KrsMarchGroup *group = &program->march_groups[program->march_group_count++];
    group->flops         = flops;
    for (int i = 0; i < 3; i++) {
        group->low[i]  = box.axis[i].low;
        group->high[i] = box.axis[i].high;
    }
}

static double flops_worth_splitting(const KrsProgram *program)
{
    double sum = 0, hull = 1, largest = 0;
    for (size_t i = 0; i < program->march_group_count; i++) {
        sum += volume_of(box_of_group(&program->march_groups[i]));
        largest = fmax(largest, program->march_groups[i].flops);
    }
    if (largest > MAX_OF_SCENE * program->flops)
        return INFINITY;
    for (int k = 0; k < 3; k++)
        hull *= program->high[k] - program->low[k];
    return sum <= hull ? SCATTERED_FLOPS : MIXED_FLOPS;
}

void form_march_groups(Compilation *c)
{
    KrsProgram *program      = &c->scene->program;
    uint32_t   *march_groups = arena_new_array(&c->scene->arena, uint32_t,
                                               c->scene->component_count + 1);
    Box         rest         = box_empty;
    double      rest_flops   = 0;
    bool        any_rest     = false;
    for (size_t i = 0; i < c->scene->component_count; i++) {
        const Component *component = &c->elaborated.components.items[i];
        march_groups[i]            = 0;
        if (program->planes && component_is_plane(component))
            continue;
        double flops = component_flops(c, i);
        for (size_t k = 0; k < component->count; k++)
            c->scene->components[component->first + k].flops = flops / (double)component->count;
        program->expensive += flops >= EXPENSIVE_FLOPS;
        size_t group    = choose_march_group(program, flops, rest_flops, component->shape->box);
        march_groups[i] = (uint32_t)group + 1;
        if (group < program->march_group_count) {
            extend_march_group(&program->march_groups[group], flops, component->shape->box);
            continue;
        }
        if (group < KRS_MAX_MARCH_GROUPS - 1) {
            add_march_group(program, flops, component->shape->box);
            continue;
        }
        rest_flops += flops;
        any_rest = true;
        rest     = box_hull(rest, component->shape->box);
    }
    if (any_rest && program->march_group_count > 0) {
        for (size_t i = 0; i < c->scene->component_count; i++)
            if (march_groups[i] == KRS_MAX_MARCH_GROUPS)
                march_groups[i] = (uint32_t)program->march_group_count + 1;
        add_march_group(program, rest_flops, rest);
    }
    if (program->march_group_count < 2)
        program->march_group_count = 0;
    program->per_component = program->march_group_count > 0 &&
                             program->flops >= flops_worth_splitting(program);
    c->march_groups = march_groups;
}
