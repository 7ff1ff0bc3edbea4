/* cells.c: the bricks that are near the surface, as hexahedra between their samples: VTK's unstructured grids. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/grid/gridding.h"

enum { SIDE = KRS_BRICK_SIDE, SAMPLES = KRS_BRICK_SAMPLES, CORNERS = 8, VTK_HEXAHEDRON = 12 };

typedef struct NearBrick {
    size_t at[3];
    float *values;
    float (*colors)[3];  /* or NULL */
    uint32_t *materials; /* or NULL */
} NearBrick;

typedef struct GridCells {
    NearBrick *items; /* in the order of their z, y and x */
    size_t     count;
    uint64_t   cells;
} GridCells;

bool grid_begin_vtu(GridFile *file)
{
    GridCells *cells = arena_new(file->arena, GridCells);
    cells->items     = arena_new_array(file->arena, NearBrick, file->sheet->near + 1);
    file->own        = cells;
    return true;
}

bool grid_add_vtu(GridFile *file, const KrsGridBrick *brick)
{
    GridCells *cells = file->own;
    if (!brick->near)
        return true;
    NearBrick *to = &cells->items[cells->count++];
    memcpy(to->at, brick->at, sizeof to->at);
    to->values = arena_new_array(file->arena, float, SAMPLES);
    memcpy(to->values, brick->values, SAMPLES * sizeof *to->values);
    if (file->sheet->color) {
        to->colors = arena_alloc(file->arena, SAMPLES, sizeof *to->colors);
        memcpy(to->colors, brick->colors, SAMPLES * sizeof *to->colors);
    }
    if (file->sheet->material) {
        to->materials = arena_new_array(file->arena, uint32_t, SAMPLES);
        memcpy(to->materials, brick->materials, SAMPLES * sizeof *to->materials);
    }
    return true;
}

/* ---- cells ---- */

static int compare_bricks(const void *a, const void *b)
{
    const NearBrick *first = a, *second = b;
    for (int k = 2; k >= 0; k--)
        if (first->at[k] != second->at[k])
            return first->at[k] < second->at[k] ? -1 : 1;
    return 0;
}

/* Finds the brick and the seven behind it along x, y and z, by bits 1, 2 and 4; NULL where there is
   none. */
static void find_neighbours(const GridCells *cells, size_t number, const NearBrick *neighbours[8])
{
    for (size_t i = 0; i < 8; i++) {
        NearBrick wanted = cells->items[number];
        for (size_t k = 0; k < 3; k++)
            wanted.at[k] += (i >> k & 1) * SIDE;
        neighbours[i] = bsearch(&wanted, cells->items, cells->count, sizeof wanted, compare_bricks);
    }
}

/* Finds the points at the corners of the cell behind sample `i`, as VTK orders them; false: some
   are in no brick. */
static bool find_corners(const GridCells *cells, const NearBrick *const neighbours[8], size_t i,
                         int64_t corners[CORNERS])
{
    static const size_t order[CORNERS][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                             {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    const size_t        from[3]           = {i % SIDE, i / SIDE % SIDE, i / (SIDE * SIDE)};
    for (size_t c = 0; c < CORNERS; c++) {
        size_t brick = 0, sample = 0;
        for (size_t k = 3; k-- > 0;) {
            size_t to = from[k] + order[c][k];
            brick     = 2 * brick + to / SIDE;
            sample    = SIDE * sample + to % SIDE;
        }
        if (!neighbours[brick])
            return false;
        corners[c] = (neighbours[brick] - cells->items) * SAMPLES + (int64_t)sample;
    }
    return true;
}

typedef bool TakeCell(GridFile *file, const int64_t corners[CORNERS]);

static bool visit_cells(GridFile *file, TakeCell *take)
{
    const GridCells *cells = file->own;
    for (size_t b = 0; b < cells->count; b++) {
        const NearBrick *neighbours[8];
        find_neighbours(cells, b, neighbours);
        for (size_t i = 0; i < SAMPLES; i++) {
            int64_t corners[CORNERS];
            if (find_corners(cells, neighbours, i, corners) && !take(file, corners))
                return false;
        }
    }
    return true;
}

static bool count_cell(GridFile *file, const int64_t corners[CORNERS])
{
    (void)corners;
    ((GridCells *)file->own)->cells++;
    return true;
}

static bool write_cell(GridFile *file, const int64_t corners[CORNERS])
{
    return output_append(file->file, corners, CORNERS * sizeof *corners);
}

/* ---- the file ---- */

static bool write_points(GridFile *file)
{
    const GridCells    *cells = file->own;
    const KrsGridShape *shape = &file->sheet->shape;
    float               points[SAMPLES][3];
    for (size_t b = 0; b < cells->count; b++) {
        for (size_t i = 0; i < SAMPLES; i++) {
            const size_t steps[3] = {i % SIDE, i / SIDE % SIDE, i / (SIDE * SIDE)};
            for (int k = 0; k < 3; k++)
                points[i][k] = (float)((double)(shape->first[k] +
                                                (int64_t)(cells->items[b].at[k] + steps[k])) *
                                       shape->cell);
        }
        if (!output_append(file->file, points, sizeof points))
            return false;
    }
    return true;
}

static bool write_connectivity(GridFile *file) { return visit_cells(file, write_cell); }

static bool write_offsets(GridFile *file)
{
    const GridCells *cells = file->own;
    for (uint64_t i = 1; i <= cells->cells; i++) {
        int64_t offset = (int64_t)(CORNERS * i);
        if (!output_append(file->file, &offset, sizeof offset))
            return false;
    }
    return true;
}

static bool write_types(GridFile *file)
{
    const GridCells *cells = file->own;
    uint8_t          type  = VTK_HEXAHEDRON;
    for (uint64_t i = 0; i < cells->cells; i++)
        if (!output_append(file->file, &type, 1))
            return false;
    return true;
}

static bool write_values(GridFile *file)
{
    const GridCells *cells = file->own;
    for (size_t b = 0; b < cells->count; b++)
        if (!output_append(file->file, cells->items[b].values, SAMPLES * sizeof(float)))
            return false;
    return true;
}

static bool write_colors(GridFile *file)
{
    const GridCells *cells = file->own;
    for (size_t b = 0; b < cells->count; b++)
        if (!output_append(file->file, cells->items[b].colors, 3 * SAMPLES * sizeof(float)))
            return false;
    return true;
}

static bool write_materials(GridFile *file)
{
    const GridCells *cells = file->own;
    for (size_t b = 0; b < cells->count; b++)
        if (!output_append(file->file, cells->items[b].materials, SAMPLES * sizeof(uint32_t)))
            return false;
    return true;
}

/* The arrays in their order, with the headings before some of them. */
typedef struct CellArray {
    const char *before, *type, *name; /* name NULL: that of the values */
    int         components;
    size_t      of_point, of_cell; /* bytes */
    bool        wanted;
    bool (*write)(GridFile *file);
} CellArray;

bool grid_end_vtu(GridFile *file)
{
    const GridSheet *sheet = file->sheet;
    const GridCells *cells = file->own;
    visit_cells(file, count_cell);
    const CellArray arrays[] = {
        {"<Points>\n", "Float32", "points", 3, 12, 0, true, write_points},
        {"</Points>\n<Cells>\n", "Int64", "connectivity", 1, 0, 64, true, write_connectivity},
        {"", "Int64", "offsets", 1, 0, 8, true, write_offsets},
        {"", "UInt8", "types", 1, 0, 1, true, write_types},
        {"</Cells>\n<PointData>\n", "Float32", grid_name(sheet), 1, 4, 0, true, write_values},
        {"", "Float32", "color", 3, 12, 0, sheet->color, write_colors},
        {"", "UInt32", "material", 1, 4, 0, sheet->material, write_materials}};
    const size_t count = sizeof arrays / sizeof *arrays;
    uint64_t     sizes[sizeof arrays / sizeof *arrays], at = 0;
    Text         text = {.arena = file->arena};
    text_format(&text,
                "<?xml version=\"1.0\"?>\n"
                "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
                "header_type=\"UInt64\">\n<UnstructuredGrid>\n"
                "<Piece NumberOfPoints=\"%zu\" NumberOfCells=\"%llu\">\n",
                SAMPLES * cells->count, (unsigned long long)cells->cells);
    for (size_t i = 0; i < count; i++) {
        const CellArray *array = &arrays[i];
        sizes[i] = array->of_point * SAMPLES * cells->count + array->of_cell * cells->cells;
        if (!array->wanted)
            continue;
        text_format(&text,
                    "%s<DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%d\" "
                    "format=\"appended\" offset=\"%llu\"/>\n",
                    array->before, array->type, array->name, array->components,
                    (unsigned long long)at);
        at += sizeof at + sizes[i];
    }
    text_add(&text,
             "</PointData>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_");
    bool done = output_append(file->file, text.bytes, text.length);
    for (size_t i = 0; i < count && done; i++)
        if (arrays[i].wanted)
            done = output_append(file->file, &sizes[i], sizeof sizes[i]) && arrays[i].write(file);
    return done && output_append(file->file, "\n</AppendedData>\n</VTKFile>\n", 28);
}
