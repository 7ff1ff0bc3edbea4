/*
 * instances.glsl: tables of parts that are alike but for numbers, and which instances are near a point.
 *
 * The header of a table has 10 texels of krs_cells; compiler/scene/tables.c writes them.
 */

// The header of a table.
KrsTable krs_read_table(uint table)
{
    uvec2 texels[10];
    for (int i = 0; i < 10; i++)
        texels[i] = krs_cell_texel(10u * table + uint(i));
    return KrsTable(uintBitsToFloat(uvec3(texels[0], texels[1].x)), uintBitsToFloat(texels[1].y),
                    uvec3(texels[2], texels[3].x), texels[3].y,
                    uintBitsToFloat(uvec3(texels[4], texels[5].x)),
                    uintBitsToFloat(uvec3(texels[5].y, texels[6])), texels[7].x, texels[7].y,
                    uintBitsToFloat(texels[8].x), uintBitsToFloat(texels[8].y),
                    uintBitsToFloat(texels[9].x), uintBitsToFloat(texels[9].y));
}

// The list of the cell where p is, and how far all else is at least.  Outside of the grid there is
// no list, and all is behind the wall of a box.
KrsNear krs_near(vec3 p, KrsTable table)
{
    vec3 place = floor((p - table.low) * table.cells_per_length);
    bool inside = all(bvec2(all(greaterThanEqual(place, vec3(0.0))),
                            all(lessThan(place, vec3(table.cells)))));
    uvec3 cell = uvec3(mix(vec3(0.0), place, bvec3(inside)));
    uint record = table.records + cell.x + table.cells.x * (cell.y + table.cells.y * cell.z);
    uvec2 first = krs_cell_texel(record);
    uint end = krs_cell_texel(record + 1u).x;
    float wall = length(max(abs(p - table.centre) - table.half_sides, vec3(0.0)));
    return KrsNear(first.x, inside ? end : first.x, inside ? uintBitsToFloat(first.y) : wall);
}

// The instance at a place of the lists, of which two are in a texel.
uint krs_listed(uint i, KrsTable table)
{
    uvec3 n = table.cells;
    uvec2 two = krs_cell_texel(table.records + n.x * n.y * n.z + 1u + i / 2u);
    return (i & 1u) == 0u ? two.x : two.y;
}

// Four numbers of an instance, whose row has so many texels.
vec4 krs_row(uint row, uint texels, uint texel, KrsTable table)
{
    return krs_row_texel(table.rows + row * texels + texel);
}

// The same of the instance at a place of the lists: shaders read these copies one after another.
vec4 krs_listed_row(uint i, uint texels, uint texel, KrsTable table)
{
    return krs_row_texel(table.copies + i * texels + texel);
}

// Sums of powers grow by this factor at most on the way from the middle of the cell where p is.
float krs_growth(vec3 p, KrsTable table)
{
    vec3 place = (p - table.low) * table.cells_per_length;
    vec3 way = (place - floor(place) - 0.5) / table.cells_per_length;
    return exp(table.slope_per_width * length(way));
}

// Above 1 over such a sum results need not be exact.
float krs_exact_from(vec3 p, KrsTable table)
{
    return min(exp((table.exact_to - krs_near(p, table).clearance) * table.per_width), 1e30);
}

// What a sum may lack: a ten-thousandth, and a part more and more where results are far from 0.
float krs_lack(float sum, float exact_from)
{
    float far = max(1.0 - sum * exact_from, 0.0);
    return sum * max(1e-4, 0.2 * far * far);
}
