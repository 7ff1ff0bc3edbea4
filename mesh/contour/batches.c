/* batches.c: prunes the field for each group, and computes its items. */
#include "mesh/contour/batches.h"

#include "compiler/base/parallel.h"

/* Evaluations from which on pruning costs less than it saves. */
enum { PRUNED_FROM = 64 };

typedef struct BatchWork {
    const BatchContext *context;
    const Batches      *batches;
    const void         *user;
} BatchWork;

static Box box_of_group(const BatchWork *w, const Group *group)
{
    Box box = {{{INFINITY, -INFINITY}, {INFINITY, -INFINITY}, {INFINITY, -INFINITY}}};
    for (uint32_t i = group->first; i < group->first + group->count; i++) {
        double low[3], high[3];
        w->batches->box(w->user, w->context->groups->order.items[i], low, high);
        for (int k = 0; k < 3; k++)
            box.axis[k] = range_hull(box.axis[k], (Range){low[k], high[k]});
    }
    for (int k = 0; k < 3; k++) {
        box.axis[k].low -= w->context->margin;
        box.axis[k].high += w->context->margin;
    }
    return box;
}

static void find_group(const BatchWork *w, MeshField *field, const Group *group)
{
    const uint32_t *numbers = w->context->groups->order.items + group->first;
    bool            pruned  = group->count * w->batches->questions >= PRUNED_FROM;
    if (pruned)
        field_focus(field, box_of_group(w, group));
    for (uint32_t i = 0, now; i < group->count; i += now) {
        now = group->count - i < MAX_FIELD_POINTS ? group->count - i : MAX_FIELD_POINTS;
        w->batches->find(w->user, field, numbers + i, now);
    }
    if (pruned)
        field_leave(field);
}

static void find_part(void *task, size_t part, size_t parts)
{
    const BatchWork *w     = task;
    size_t           count = w->context->groups->list.count;
    for (size_t i = part; i < count; i += parts)
        find_group(w, &w->context->fields[part], &w->context->groups->list.items[i]);
}

void batches_find(const BatchContext *context, const Batches *batches, const void *user,
                  size_t first, size_t end)
{
    BatchWork w = {context, batches, user};
    groups_clear(context->groups);
    for (size_t i = first; i < end; i++) {
        double low[3], high[3], at[3];
        if (batches->is_known && batches->is_known(user, i))
            continue;
        batches->box(user, i, low, high);
        for (int k = 0; k < 3; k++)
            at[k] = (0.5 * (low[k] + high[k]) - context->origin[k]) / context->side;
        groups_add(context->groups, (uint32_t)i, at);
    }
    groups_finish(context->groups);
    run_in_parallel(find_part, &w);
}
