/*
 * tables.c: writes tables of instance groups, and textures, for shaders.
 */
#include "compiler/scene/tables.h"

#include <float.h>
#include <string.h>

#include "compiler/base/far.h"
#include "compiler/graph/instances/grid_build.h"

typedef uint32_t Texel[2];

/* The places of the parts of a table, in texels. */
typedef struct Place {
    size_t row, copy, cell, list;
} Place;

/* Places the parts of a table with so many cells and entries at `next`, and moves that on to the next table. */
static Place place_parts(const InstanceTable *table, size_t cells, size_t entries, TableSizes *next)
{
    size_t texels = row_texels(table);
    Place  place  = {next->rows, next->rows + table->rows * texels, next->cells,
                     next->cells + cells + 1};
    next->rows    = place.copy + entries * texels;
    next->cells   = place.list + (entries + 1) / 2;
    return place;
}

static Place place_table(const InstanceTable *table, TableSizes *next)
{
    size_t cells = grid_cell_count(&table->cells);
    return place_parts(table, cells, table->cells.first[cells], next);
}

/* Leaves room for the grids of all states. */
static void leave_room(const InstanceTable *table, TableSizes *next)
{
    GridLimits most = grid_limits_of_frame(table->rows);
    if (table->places)
        place_parts(table, (size_t)most.cells, (size_t)most.entries, next);
    else
        place_table(table, next);
}

static size_t table_count(const Instances *instances)
{
    return instances ? instances->tables.count : 0;
}

static size_t texture_count(const Textures *textures)
{
    return textures ? textures->list.count : 0;
}

static TableSizes after_headers(const Instances *instances, const Textures *textures)
{
    return (TableSizes){0, GRID_HEADER * table_count(instances) +
                               TEXTURE_HEADER * texture_count(textures)};
}

TableSizes tables_measure(const Instances *instances, const Textures *textures)
{
    TableSizes sizes = after_headers(instances, textures);
    for (size_t t = 0; t < table_count(instances); t++)
        leave_room(&instances->tables.items[t], &sizes);
    for (size_t t = 0; t < texture_count(textures); t++)
        sizes.cells += textures->list.items[t].texel_count;
    if (sizes.cells > 0 && sizes.rows == 0)
        sizes.rows = 1; /* no buffer is empty */
    return sizes;
}

static uint32_t bits_of(double number)
{
    float    rounded = (float)number;
    uint32_t bits;
    memcpy(&bits, &rounded, sizeof bits);
    return bits;
}

static void put_floats(Texel texel, double first, double second)
{
    texel[0] = bits_of(first);
    texel[1] = bits_of(second);
}

/* Returns half of a side, with all that is lost when center and half are rounded. */
static double half_upward(Range axis, float center)
{
    double half = fmax(axis.high - (double)center, (double)center - axis.low);
    return nextafterf((float)half, HUGE_VALF);
}

/* The origin that a table is relative to. */
typedef struct Origin {
    double v[3];
} Origin;

static Origin origin_of(const Instances *instances, const InstanceTable *table,
                        const NodeValue *values, bool relocated)
{
    Origin origin = {{0}};
    for (int k = 0; k < 3 && relocated && table->origin > 0; k++)
        if (relocates_along(table, k))
            origin.v[k] = values[instances->frame_numbers.items[table->origin - 1]].v[k];
    return origin;
}

static void put_header(const Grid *grid, Origin origin, Place place, Texel *header)
{
    bool   infinite = isinf(grid->size);
    float  center[3];
    double half[3];
    for (int k = 0; k < 3; k++) {
        Range axis = {grid->inner.axis[k].low - origin.v[k],
                      grid->inner.axis[k].high - origin.v[k]};
        center[k]  = infinite ? 0 : (float)(0.5 * (axis.low + axis.high));
        half[k]    = infinite ? NOWHERE : half_upward(axis, center[k]);
    }
    put_floats(header[0], grid->low[0] - origin.v[0], grid->low[1] - origin.v[1]);
    put_floats(header[1], grid->low[2] - origin.v[2], 1 / grid->size);
    memcpy(header[2], grid->cells, 2 * sizeof *grid->cells);
    header[3][0] = grid->cells[2];
    header[3][1] = (uint32_t)place.cell;
    put_floats(header[4], center[0], center[1]);
    put_floats(header[5], center[2], half[0]);
    put_floats(header[6], half[1], half[2]);
    header[7][0] = (uint32_t)place.row;
    header[7][1] = (uint32_t)place.copy;
}

/* Writes what loops that end by tails need. */
static void put_fading(const InstanceTable *table, Texel *header)
{
    const Grid *grid = &table->cells;
    memset(header[8], 0, 2 * sizeof *header);
    if (!grid->tails)
        return;
    put_floats(header[8], table->fades, 1 / table->fades);
    put_floats(header[9], table->slope / table->fades, table->margin);
}

static void put_grid(const Grid *grid, Texel *records, Texel *lists)
{
    size_t   cells   = grid_cell_count(grid);
    uint32_t entries = grid->first[cells];
    for (size_t c = 0; c <= cells; c++) {
        const bool middle = grid->tails && c < cells && grid->first[c] < grid->first[c + 1];
        records[c][0]     = grid->first[c];
        records[c][1]     = bits_of(middle      ? (double)grid->middles[c]
                                    : c < cells ? (double)grid->clearance[c]
                                                : 0);
    }
    for (uint32_t i = 0; i < entries; i++)
        lists[i / 2][i % 2] = grid->instances[i];
    if (entries % 2)
        lists[entries / 2][1] = 0;
}

/* Rounds to single precision as other values of the state are: what that does not have is the
   largest number that it has. */
static float to_single(double number)
{
    return (float)(number > FLT_MAX ? FLT_MAX : number < -FLT_MAX ? -FLT_MAX : number);
}

static void put_rows(const Instances *instances, const InstanceTable *table,
                     const NodeValue *values, Origin origin, float (*rows)[4])
{
    size_t texels = row_texels(table);
    memset(rows, 0, table->rows * texels * sizeof *rows);
    for (uint32_t c = 0; c < table->columns; c++) {
        const Node   *nodes   = column_nodes(instances, table, c);
        const double *numbers = table->numbers + c;
        const double  taken   = table->axes[c] > 0 ? origin.v[table->axes[c] - 1] : 0;
        for (size_t r = 0; r < table->rows; r++)
            rows[r * texels + c / 4][c % 4] = to_single(
                (nodes ? values[nodes[r]].v[0] : numbers[r * table->columns]) - taken);
    }
}

/* Writes the rows of all instances of the lists, in the order of the lists. */
static void put_copies(const InstanceTable *table, const float (*rows)[4], float (*copies)[4])
{
    const size_t texels  = row_texels(table),
                 entries = table->cells.first[grid_cell_count(&table->cells)];
    for (size_t i = 0; i < entries; i++)
        memcpy(copies + i * texels, rows + table->cells.instances[i] * texels,
               texels * sizeof *rows);
    for (size_t i = 0; i < entries && table->cells.tails; i++)
        copies[i * texels + table->columns / 4][table->columns % 4] = table->cells.tails[i];
}

/* Packs all rows; the sizes become those of all tables. */
static TableSizes pack_rows(const Instances *instances, const Textures *textures,
                            const NodeValue *values, bool relocated, float (*rows)[4])
{
    TableSizes next = after_headers(instances, textures);
    for (size_t t = 0; t < table_count(instances); t++) {
        const InstanceTable *table = &instances->tables.items[t];
        Place                place = place_table(table, &next);
        put_rows(instances, table, values, origin_of(instances, table, values, relocated),
                 rows + place.row);
        put_copies(table, (const float(*)[4])(rows + place.row), rows + place.copy);
    }
    return next;
}

/* ---- textures ---- */

static void put_texture(const Texture *texture, size_t first, Texel *header, Texel *texels)
{
    memset(header, 0, TEXTURE_HEADER * sizeof *header);
    header[0][0] = texture->level_count;
    header[0][1] = (uint32_t)texture->wrap + (texture->gray ? 4 : 0);
    for (uint32_t i = 0; i < texture->level_count; i++) {
        const TextureLevel *level = &texture->levels[i];
        header[1 + i][0]          = (uint32_t)(first + level->first);
        header[1 + i][1]          = level->width + (level->height << 16);
    }
    memcpy(texels, texture->texels, texture->texel_count * sizeof *texels);
}

/* Textures are in the order of their numbers, and the last of all. */
void tables_place_texture(const Instances *instances, const Textures *textures, size_t index,
                          size_t *header, size_t *first)
{
    *header = GRID_HEADER * table_count(instances) + TEXTURE_HEADER * index;
    *first  = tables_measure(instances, textures).cells;
    for (size_t t = index; t < textures->list.count; t++)
        *first -= textures->list.items[t].texel_count;
}

static void pack_textures(const Instances *instances, const Textures *textures, Texel *cells)
{
    for (size_t t = 0; t < texture_count(textures); t++) {
        size_t header, first;
        tables_place_texture(instances, textures, t, &header, &first);
        put_texture(&textures->list.items[t], first, cells + header, cells + first);
    }
}

TableSizes tables_pack(const Instances *instances, const Textures *textures,
                       const NodeValue *values, bool relocated, float (*rows)[4],
                       uint32_t (*cells)[2])
{
    TableSizes next = after_headers(instances, textures);
    for (size_t t = 0; t < table_count(instances); t++) {
        const InstanceTable *table = &instances->tables.items[t];
        Place                place = place_table(table, &next);
        put_header(&table->cells, origin_of(instances, table, values, relocated), place,
                   cells + GRID_HEADER * t);
        put_fading(table, cells + GRID_HEADER * t);
        put_grid(&table->cells, cells + place.cell, cells + place.list);
    }
    pack_textures(instances, textures, cells);
    next = pack_rows(instances, textures, values, relocated, rows);
    if (next.rows == 0)
        memset(rows[next.rows++], 0, sizeof *rows);
    if (texture_count(textures) > 0) /* they are the last of all */
        next.cells = tables_measure(instances, textures).cells;
    return next;
}
