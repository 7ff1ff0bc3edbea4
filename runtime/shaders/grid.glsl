/*
 * grid.glsl: finds the cell of a grid by its number, counted row by row.  The file is C as well,
 * for tests/unit/grid.c.
 */

// Returns column and row of a cell; `estimate` is number / columns with an error below 1.
uvec2 cell_near(uint number, uint columns, float estimate)
{
    uint row = uint(estimate);
    int  column = int(number - row * columns);
    int  off = int(column >= int(columns)) - int(column < 0); // error of the estimated row
    return uvec2(uint(column - off * int(columns)), row + uint(off));
}

// Returns column and row of a cell.  A device's quotient may be off by 2.5 units in the last place,
// and floats round whole numbers from 2^24 on.  In grids of up to 2^20 rows these errors are below
// 1.  lavapipe divides integers lane by lane, which would take twenty times as long.
uvec2 find_cell(uint number, uint columns)
{
    return cell_near(number, columns, float(number) / float(columns));
}
