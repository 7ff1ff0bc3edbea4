/*
 * tile_starts.glsl: the tiles of rays and beams, and where these start: where the larger beam around
 * them has ended.
 */
uvec2 first_8, count_8, first_32, count_32; // the tiles of beams

// The properties that the items of a tile have in common: 64 rays, or four beams of 4x4 pixels.  A
// beam of 8x8 or of 32x32 pixels is the only item of its tile.
struct TileStart {
    uvec2 tile;   // its column and row in the picture, of tiles of 8x8 or of 32x32 pixels
    vec4  starts; // for each quarter: where the larger beam around it ended; nothing is before
};

// Returns the tile of an item.  Items are numbered tile by tile, and quarter by quarter in each.
uint tile_of_item(uint number)
{
    return number >> (control.phase == TRACE_RAYS ? 6u : control.phase == TRACE_BEAMS_4 ? 2u : 0u);
}

uint quarter_of(uint number)
{
    return control.phase == TRACE_RAYS      ? number >> 4u & 3u
           : control.phase == TRACE_BEAMS_4 ? number & 3u
                                            : 0u;
}

// Returns the tile of a beam, counted in the band.
uvec2 cell_of_beam(uint number)
{
    return find_cell(number, control.across) +
           uvec2(control.window & 0xffffu, control.window >> 16u);
}

// These return indices in `ends` of the beams of tiles, which are counted in the band.
uint end_of_8(uvec2 cell) { return work.extent.x * work.extent.y + cell.y * count_8.x + cell.x; }

uint end_of_32(uvec2 cell)
{
    return end_of_8(uvec2(0u, count_8.y)) + cell.y * count_32.x + cell.x;
}

uint end_of_4(uvec2 cell, uint quarter)
{
    return end_of_32(uvec2(0u, count_32.y)) + 4u * (cell.y * count_8.x + cell.x) + quarter;
}

float load_start(uint end) { return uintBitsToFloat(load_end(end).x); }

// Loads a tile, and where its rays or beam start.  Rays and beams of 4x4 pixels are those of all
// tiles of the band, or of the listed ones.  Each starts where the next larger beam around it has
// ended.  For rays that is one of 4x4 pixels, if there are such beams, else of 8x8.
TileStart load_tile(uint number)
{
    bool  is_ray = control.phase == TRACE_RAYS, large = control.phase == TRACE_BEAMS_32;
    bool  small = control.phase == TRACE_BEAMS_4;
    bool  exists = control.source != ITEMS_QUEUED && number <= tile_of_item(control.items - 1u);
    if (exists && (is_ray || small) && control.listed != 0u)
        number = load_tile_word(number);
    uvec2 cell = is_ray || small ? find_cell(number, count_8.x) : cell_of_beam(number);
    uvec2 tile = cell + (large ? first_32 : first_8);
    vec4  starts = vec4(0.0);
    if (exists && !large && control.starts_from != 0u) {
        bool quarters = is_ray && control.starts_from == 2u;
        uint end = quarters ? end_of_4(cell, 0u)
                 : is_ray || small ? end_of_8(cell) : end_of_32(tile / 4u - first_32);
        starts = vec4(load_start(end));
        if (quarters)
            starts.yzw = vec3(load_start(end + 1u), load_start(end + 2u), load_start(end + 3u));
    }
    return TileStart(tile, starts);
}
