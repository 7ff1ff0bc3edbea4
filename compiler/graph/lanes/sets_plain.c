/*
 * sets_plain.c: lanes are compiled as plain C; WITHOUT_CELLS, where nothing traces rays.
 */
#include "compiler/graph/lanes/lane_call.h"

#ifdef WITHOUT_CELLS
#define CELLS NULL, NULL
#else
#define CELLS lane_cells_plain, lane_wide_plain
#endif

size_t lane_sets(const LaneSet **sets)
{
    static const LaneSet plain = {"plain", {lane_double_plain, lane_single_plain}, CELLS};
    *sets                      = &plain;
    return 1;
}
