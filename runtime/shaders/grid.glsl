/*
 * grid.glsl: cells of a grid by their number, row by row.  This is C as well, for
 * tests/unit/grid.c.
 */

// Column and row of a cell, where `estimate` is number / across, but for less than 1.
uvec2 cell_near(uint number, uint columns, float estimate)
{
    uint row = uint(estimate);
    int  column = int(number - row * columns);
    int  off = int(column >= int(columns)) - int(column < 0); // rows
    return uvec2(uint(column - off * int(columns)), row + uint(off));
}

// Devices may be off by 2.5 units in the last place when they divide, and floats round whole
// numbers from 2^24 on: in grids of up to 2^20 rows that is less than 1.  lavapipe divides integers
// lane by lane, which takes twenty times as long.
uvec2 find_cell(uint number, uint columns)
{
    return cell_near(number, columns, float(number) / float(columns));
}
