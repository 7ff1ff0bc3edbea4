/*
 * tables.h: the tables of instance groups, as shaders read them: rows of numbers, and grids; and textures.
 *
 * Both are arrays of texels, of four floats or two words.  Those of all tables are in the same two.
 *
 * In `rows`, each row of a table begins at a texel: column c of row r is number c % 4 of texel
 * first + r * row_texels + c / 4.  Behind the rows are copies of them in the order of the lists, which
 * loops read one after another without looking for instances.
 *
 * In `cells`, header t of GRID_HEADER texels is that of table t; floats are there as their bits:
 *     low x, low y
 *     low z, 1 / size of a cell
 *     cells along x, along y
 *     cells along z, texel of the first cell
 *     center x, center y    (of Grid.inner; the half sides are rounded up)
 *     center z, half x
 *     half y, half z
 *     texel of row 0 in `rows`, texel of the first copy
 *     width, 1 / width      (and these two only of tables with tails, grid_tails.h)
 *     slope / width, distance up to which results are exact
 * Each cell is a texel: where its list begins, counted in instances, and its clearance; with tails, where there is a list, the result in
 * its middle.  Copies of rows have the tail as one more column.  One more texel says
 * where the last list ends.  Behind them are the lists, two instances a texel.  A grid of one infinite cell has 1 / size
 * 0, so that all points are in cell 0.
 *
 * Behind the headers of tables are those of textures, of TEXTURE_HEADER texels:
 *     count of levels, what is outside + 4 if it is gray
 *     and for each level: its first texel, width + 65536 height
 * Their texels are behind all else, as texture.h has them.
 */
#ifndef KRS_TABLES_H
#define KRS_TABLES_H

#include "compiler/graph/instance_table.h"
#include "compiler/graph/texture.h"

/* The numbers of texels. */
typedef struct TableSizes {
    size_t rows, cells;
} TableSizes;

/* Returns the room for those of all states; 0 when there are neither tables nor textures; both may
   be NULL. */
TableSizes tables_measure(const Instances *instances, const Textures *textures);
/* Finds the texels of the cells at which the header of a texture and its finest level begin. */
void tables_place_texture(const Instances *instances, const Textures *textures, size_t index,
                          size_t *header, size_t *first);
/* Fills arrays of these sizes; `values` of nodes has the numbers of the state, and may be NULL where
   there are none.  `relocated`: tables with an origin are relative to it, for camera-relative points.  Returns how many texels at the beginning are in use: all, unless instances move. */
TableSizes tables_pack(const Instances *instances, const Textures *textures,
                       const NodeValue *values, bool relocated, float (*rows)[4],
                       uint32_t (*cells)[2]);

#endif
