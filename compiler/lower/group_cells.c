/*
 * group_cells.c: the grid of an instance group.  That of a blend is refined where the distances of its instances depend
 * on nothing but their numbers, and those are known.
 */
#include <math.h>

#include "compiler/graph/instances/grid_build.h"
#include "compiler/graph/instances/grid_refine.h"
#include "compiler/graph/instances/grid_sift.h"
#include "compiler/lower/instance_group.h"
#include "compiler/lower/join.h"

/* The distance of an instance with a parameter for each column, behind all others. */
typedef struct InstanceDistance {
    Tape     tape;
    Node     root;
    uint32_t first; /* parameter */
} InstanceDistance;

/* Tells whether nothing on the tape changes with the frame, or is another instance group or a texture. */
static bool is_of_columns(const Graph *g, const InstanceDistance *distance)
{
    for (size_t i = 0; i < distance->tape.count; i++) {
        const Expr *e = &g->items[distance->tape.nodes[i]];
        if ((e->op == OP_PARAMETER && e->index < distance->first) ||
            op_has_traits((Op)e->op, READS_TABLES))
            return false;
    }
    return true;
}

static InstanceDistance distance_of_columns(const InstanceGroup *group, const GroupJoin *join)
{
    Graph           *g                  = join->graph;
    InstanceDistance distance           = {.first = (uint32_t)g->parameters.count};
    bool             wanted[PART_ROOTS] = {[PART_DISTANCE] = true};
    Node             roots[PART_ROOTS];
    Node            *slots = arena_new_array(join->scratch, Node, group->template->slot_count + 1);
    LeafPair         point = {join->leaves.point, graph_leaf(g, OP_POINT)};
    group_slots_of_parameters(group, g, distance.first, slots);
    template_copy(g, group->template, slots, &point, 1, wanted, roots, join->scratch);
    distance.root = roots[PART_DISTANCE];
    distance.tape = tape_new(g, &distance.root, 1, join->scratch);
    return distance;
}

/* Returns the numbers that the lanes need of each instance. */
static double *scalars_of(const InstanceDistance *distance, const LaneTape *lanes,
                          const InstanceTable *table, Arena *scratch)
{
    const size_t count      = lanes->scalar_count;
    NodeValue   *parameters = arena_new_array(scratch, NodeValue,
                                              distance->first + table->columns + 1);
    NodeValue   *values     = arena_new_array(scratch, NodeValue, distance->tape.graph->count);
    double      *scalars    = arena_new_array(scratch, double, count * table->rows + 1);
    for (uint32_t i = 0; i < table->rows; i++) {
        for (uint32_t k = 0; k < table->columns; k++)
            parameters[distance->first + k].v[0] = table->numbers[(size_t)i * table->columns + k];
        tape_run_frame(&distance->tape, parameters, values);
        lane_tape_scalars(lanes, values, scalars + i * count);
    }
    return scalars;
}

/* Tells whether a blend has the slope of its operands, and what is far from the least of them does not act. */
static bool may_refine(const InstanceGroup *group, const GroupJoin *join, const GridBlend *blend,
                       const InstanceTable *table)
{
    const bool row = blend_many(join->blend.kind).way == MANY_IN_ROW && !blend->sums;
    return !row && blend_info[join->blend.kind].slope == 1 && isfinite(blend->acts) &&
           blend->width > 0 && isfinite(group->slope) && !join->complement && !table->frame_columns;
}

/* Entries of lists that shaders do not read are few: as if each had so many texels. */
enum { TEXELS_OF_HOST = 64 };

/* Most texels of all entries of refined lists, and by how much those are more than the coarse ones. */
enum { MAX_TEXELS = 1 << 23, LISTS_GROW = 16 };

/* Sifts the cells; false: that would take too long, or too much memory. */
static bool sift(const GridBlend *blend, const Box *boxes, Grid *coarse, const InstanceTable *table,
                 Arena *scratch)
{
    double most = (double)MAX_TEXELS / LISTS_GROW / fmax((double)row_texels(table), 1);
    return grid_sift(coarse, boxes, table->rows, blend, scratch) &&
           coarse->first[grid_cell_count(coarse)] <= 4 * most;
}

/* Makes the grid, and large cells with lists of the instances that act there: by their boxes if
   that is possible. */
static bool make_coarse(GridBlend *blend, const Box *boxes, Grid *coarse, InstanceTable *table,
                        Arena *scratch)
{
    double reach = blend->reach * table->stretch;
    bool   far   = blend->fades || !isfinite(reach);
    if (far && sift(blend, boxes, coarse, table, scratch)) {
        grid_build(&table->grid, boxes, table->rows, reach, blend->margin, TEXELS_OF_HOST,
                   table->arena, scratch);
        blend->sifted = true;
        return true;
    }
    if (!isfinite(reach) || !grid_build_coarse(&table->grid, boxes, table->rows, reach,
                                               blend->margin, table->arena, scratch))
        return false;
    *coarse = table->grid;
    return true;
}

/* The grid is made and refined for what `blend` has already. */
static bool refine(const InstanceGroup *group, const GroupJoin *join, const Box *boxes,
                   GridBlend *blend, InstanceTable *table)
{
    Arena           *scratch  = join->scratch;
    InstanceDistance distance = distance_of_columns(group, join);
    Grid             coarse;
    if (!is_of_columns(join->graph, &distance))
        return false;
    LaneTape lanes = lane_tape_new(&distance.tape, &distance.root, 1, false, 0, scratch);
    blend->tape    = &lanes;
    blend->scalars = scalars_of(&distance, &lanes, table, scratch);
    if (!make_coarse(blend, boxes, &coarse, table, scratch))
        return false;
    grid_refine(&table->cells, &coarse, blend, table->arena, scratch);
    table->fades = blend->width;
    table->slope = blend->slope;
    return true;
}

static bool make_refined(const InstanceGroup *group, const GroupJoin *join, const Box *boxes,
                         double reach, double margin, InstanceTable *table)
{
    const Blend *of    = &join->blend;
    GridBlend    blend = {.slope = group->slope, .reach = reach / table->stretch, .margin = margin};
    if (of->width == NODE_NONE || !graph_known_component(join->graph, of->width, 0, &blend.width) ||
        (of->steps != NODE_NONE && !graph_known_component(join->graph, of->steps, 0, &blend.steps)))
        return false;
    const BlendMany many = blend_many(of->kind);
    blend.shares         = many.way == MANY_SHARE;
    blend.sums           = blend_fades(of->kind);
    blend.op             = blend.shares ? many.of_eight : blend_info[of->kind].op;
    blend.acts           = blend.width * blend_acts(of->kind, table->rows);
    blend.fades          = blend_fades(of->kind) && !group_varies(group, join);
    blend.swell          = table->stretch * blend.width * blend_bulge(of->kind, table->rows);
    if (!may_refine(group, join, &blend, table))
        return false;
    GraphMark mark    = graph_mark(join->graph);
    bool      refined = refine(group, join, boxes, &blend, table);
    graph_release(join->graph, mark);
    return refined;
}

void group_make_cells(const InstanceGroup *group, const GroupJoin *join, const Box *boxes,
                      double reach, double margin, InstanceTable *table)
{
    size_t texels = row_texels(table);
    if (table->places) {
        grid_build_within(&table->grid, boxes, table->rows, reach, margin,
                          grid_limits_of_frame(table->rows), table->arena, join->scratch);
        table->cells = table->grid;
        return;
    }
    if (make_refined(group, join, boxes, reach, margin, table))
        return;
    grid_build(&table->grid, boxes, table->rows, reach, margin, texels > 0 ? (uint32_t)texels : 1,
               table->arena, join->scratch);
    table->cells = table->grid;
}
