/* flat_joins.c: joins half-spaces, without what makes no difference. */
#include "mesh/flat/flat_joins.h"

#include "compiler/base/vec.h"

static int add_node(Finding *f, FlatNode node)
{
    if (f->pieces->node_count == MAX_FLAT_NODES) {
        f->failed = true;
        return FLAT_NONE;
    }
    f->pieces->nodes[f->pieces->node_count] = node;
    return (int)f->pieces->node_count++;
}

static int join(Finding *f, int kind, int a, int b)
{
    int all  = kind == FLAT_BOTH ? FLAT_ALL : FLAT_NONE,
        none = kind == FLAT_BOTH ? FLAT_NONE : FLAT_ALL;
    if (a == none || b == none)
        return none;
    if (a == all || b == all || a == b)
        return a == all ? b : a;
    return add_node(f, (FlatNode){kind, a, b});
}

/* The relation of two half-spaces with parallel planes. */
typedef enum Relation { DISJOINT, COVERING, WITHIN, AROUND, CROSSING } Relation;

static Relation find_relation(const Finding *f, const FlatNode *a, const FlatNode *b)
{
    const HalfSpace *first = &f->pieces->list[a->first], *second = &f->pieces->list[b->first];
    double           off[3], cosine = a->second * b->second * dot3(first->normal, second->normal);
    double           sign = cosine < 0 ? -1 : 1, margin = FLAT_ROUNDING * f->size;
    for (int k = 0; k < 3; k++)
        off[k] = a->second * first->normal[k] - sign * b->second * second->normal[k];
    double depth = a->second * first->offset - sign * b->second * second->offset;
    if (!(largest3(off) < FLAT_ROUNDING) || !isfinite(depth))
        return CROSSING;
    if (cosine < 0)
        return depth >= -margin ? DISJOINT : COVERING;
    return depth >= -margin ? WITHIN : AROUND;
}

/* Simplifies a solid inside of a half-space, or outside of it. */
static int given(Finding *f, const FlatNode *known, bool inside, int solid)
{
    if (solid < 0 || f->failed)
        return solid;
    FlatNode node = f->pieces->nodes[solid];
    if (node.kind == FLAT_HALF_SPACE) {
        Relation relation = find_relation(f, &node, known);
        if (inside)
            return relation == DISJOINT ? FLAT_NONE : relation == AROUND ? FLAT_ALL : solid;
        return relation == WITHIN ? FLAT_NONE : relation == COVERING ? FLAT_ALL : solid;
    }
    int first = given(f, known, inside, node.first), second = given(f, known, inside, node.second);
    return first == node.first && second == node.second ? solid : join(f, node.kind, first, second);
}

/* Simplifies a solid inside of the half-spaces that another intersects, or outside of those that it
   unites. */
static int given_solid(Finding *f, int kind, int known, int solid)
{
    if (known < 0 || solid < 0)
        return solid;
    FlatNode node = f->pieces->nodes[known];
    if (node.kind == FLAT_HALF_SPACE)
        return given(f, &node, kind == FLAT_BOTH, solid);
    return (int)node.kind != kind
               ? solid
               : given_solid(f, kind, node.second, given_solid(f, kind, node.first, solid));
}

static int join_solids(Finding *f, int kind, int a, int b)
{
    b = given_solid(f, kind, a, b);
    a = given_solid(f, kind, b, a);
    return join(f, kind, a, b);
}

int flat_both(Finding *f, int a, int b) { return join_solids(f, FLAT_BOTH, a, b); }

int flat_either(Finding *f, int a, int b) { return join_solids(f, FLAT_EITHER, a, b); }

/* Returns the number of a half-space, or of the opposite one; the sign is then -1. */
static int find_half_space(Finding *f, const HalfSpace *plane, int *sign)
{
    FlatPieces *pieces = f->pieces;
    for (size_t i = 0; i < pieces->count; i++) {
        *sign = dot3(plane->normal, pieces->list[i].normal) < 0 ? -1 : 1;
        double off[3];
        add_scaled3(off, plane->normal, -*sign, pieces->list[i].normal);
        if (largest3(off) < FLAT_ROUNDING &&
            fabs(plane->offset - *sign * pieces->list[i].offset) < FLAT_ROUNDING * f->size)
            return (int)i;
    }
    *sign = 1;
    if (pieces->count == MAX_FLATS) {
        f->failed = true;
        return 0;
    }
    pieces->list[pieces->count]    = *plane;
    pieces->slack[pieces->count]   = (FlatSlack){0, 0};
    pieces->chooses[pieces->count] = false;
    return (int)pieces->count++;
}

static void add_slack(Finding *f, int number, double below, double above, double length)
{
    FlatSlack *slack = &f->pieces->slack[number];
    slack->below     = max2(slack->below, below / length);
    slack->above     = max2(slack->above, above / length);
}

double flat_moved(const Finding *f) { return f->use == FLAT_MAKING ? FLAT_MOVED * f->size : 0; }

int flat_half_space(Finding *f, const Form *form)
{
    Range     range  = form_range(f, form);
    double    length = length3(form->by);
    HalfSpace plane;
    int       sign;
    double    moved = length * flat_moved(f);
    if (range.low > moved || range.high < -moved)
        return range.low > 0 ? FLAT_NONE : FLAT_ALL;
    if (!(length > 0)) {
        f->failed = true;
        return FLAT_NONE;
    }
    for (int k = 0; k < 3; k++)
        plane.normal[k] = form->by[k] / length;
    plane.offset = form->at / length;
    int number   = find_half_space(f, &plane, &sign);
    length /= form_divisor(f, form).high;
    add_slack(f, number, sign > 0 ? f->slack.below : f->slack.above,
              sign > 0 ? f->slack.above : f->slack.below, length);
    f->pieces->chooses[number] |= f->chooses;
    return add_node(f, (FlatNode){FLAT_HALF_SPACE, number, sign});
}

int flat_complement(Finding *f, int solid)
{
    if (solid == FLAT_ALL || solid == FLAT_NONE)
        return solid == FLAT_ALL ? FLAT_NONE : FLAT_ALL;
    FlatNode node = f->pieces->nodes[solid];
    if (node.kind == FLAT_HALF_SPACE)
        return add_node(f, (FlatNode){FLAT_HALF_SPACE, node.first, -node.second});
    int first = flat_complement(f, node.first), second = flat_complement(f, node.second);
    return node.kind == FLAT_BOTH ? flat_either(f, first, second) : flat_both(f, first, second);
}
