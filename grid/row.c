/* row.c: fills the bricks of a row along x. */
#include "grid/grid.h"

#include <string.h>

#include "compiler/base/vec.h"

/* The field is pruned for a run and for a brick, and in between once for so many halvings. */
enum { ENTER_EVERY = 3 };

typedef struct Row {
    const KrsGrid  *grid;
    MeshField      *field;
    const BrickRun *run;
    bool            count_only;
    uint32_t        triangle; /* the nearest to the last sample */
    Brick          *bricks;
} Row;

/* Returns the box around the samples of some bricks of the run. */
static Box box_of(const Row *row, size_t first, size_t count)
{
    const size_t *at      = row->run->first;
    const size_t  from[3] = {(at[0] + first) * BRICK, at[1] * BRICK, at[2] * BRICK};
    const size_t  to[3]   = {from[0] + count * BRICK - 1, from[1] + BRICK - 1, from[2] + BRICK - 1};
    Box           box;
    for (int k = 0; k < 3; k++)
        box.axis[k] = (Range){grid_coordinate(row->grid, k, from[k]),
                              grid_coordinate(row->grid, k, to[k])};
    return box;
}

/* Returns the box in which the field is evaluated: wider than samples for their cubes, and for
   normals. */
static Box asked_box(const Row *row, Box box)
{
    const KrsGridOptions *options = &row->grid->options;
    double                margin  = options->fog || options->materials ? 0.63 * options->cell : 0;
    for (int k = 0; k < 3; k++)
        box.axis[k] = (Range){box.axis[k].low - margin, box.axis[k].high + margin};
    return box;
}

/* Tells whether all of a box is farther from the surface than `near`, by the distance at its
   middle, which changes no faster than points move, or by its range. */
static bool is_far(const Row *row, Box box, double *distance)
{
    double middle[3], half[3], near = row->grid->near;
    if (isinf(near))
        return false;
    for (int k = 0; k < 3; k++) {
        middle[k] = 0.5 * (box.axis[k].low + box.axis[k].high);
        half[k]   = 0.5 * (box.axis[k].high - box.axis[k].low);
    }
    *distance = field_distance(row->field, middle);
    if (fabs(*distance) > 1.0001 * length3(half) + near)
        return true;
    Range range = field_range(row->field, box);
    return range.low > near || range.high < -near;
}

static void fill_far(const Row *row, size_t first, size_t count, double distance)
{
    for (size_t i = first; i < first + count; i++) {
        row->bricks[i].near = false;
        row->bricks[i].far  = far_value(row->grid, distance);
    }
}

static KrsStatus fill_near(Row *row, size_t number)
{
    const size_t *first = row->run->first;
    const size_t  at[3] = {(first[0] + number) * BRICK, first[1] * BRICK, first[2] * BRICK};
    Brick        *brick = &row->bricks[number];
    brick->near         = true;
    if (row->count_only)
        return KRS_OK;
    fill_brick(row->grid, row->field, at, &row->triangle, brick);
    return brick->colors ? add_materials(row->grid, row->field, at, brick) : KRS_OK;
}

static KrsStatus fill(Row *row, size_t first, size_t count, int depth)
{
    const Box box      = box_of(row, first, count);
    double    distance = 0;
    if (is_far(row, box, &distance)) {
        fill_far(row, first, count, distance);
        return KRS_OK;
    }
    bool enter = (depth % ENTER_EVERY == 0 || count == 1) && row->field->region_count < MAX_REGIONS;
    if (enter)
        field_narrow(row->field, asked_box(row, box));
    size_t    half   = count / 2;
    KrsStatus status = count == 1 ? fill_near(row, first) : fill(row, first, half, depth + 1);
    if (count > 1 && status == KRS_OK)
        status = fill(row, first + half, count - half, depth + 1);
    if (enter)
        field_leave(row->field);
    return status;
}

KrsStatus fill_run(const KrsGrid *grid, MeshField *field, const BrickRun *run, bool count_only,
                   Brick *bricks)
{
    Row row = {grid, field, run, count_only, 0, bricks};
    return fill(&row, 0, run->count, 0);
}
