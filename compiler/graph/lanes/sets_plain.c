/*
 * sets_plain.c: lanes are compiled as plain C.
 */
#include "compiler/graph/lanes/lane_call.h"

size_t lane_sets(const LaneSet **sets)
{
    static const LaneSet plain = {
        "plain", {lane_double_plain, lane_single_plain}, lane_cells_plain, lane_wide_plain};
    *sets = &plain;
    return 1;
}
