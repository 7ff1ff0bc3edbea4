/*
 * lane_call.h: what the loops over lanes share.
 */
#ifndef KRS_LANE_CALL_H
#define KRS_LANE_CALL_H

#include "compiler/graph/lanes/lanes.h"

/* Returns an operation at one point; `values`, which only those that read tables need, are of the
   frame. */
NodeValue lane_call(const Tape *tape, NodeValue *values, Node node, const NodeValue *operands);

/* Runs a call that has a body, in as many points; `run` is the loop that asks. */
void lane_instance_call(const LaneTape *tape, const LaneWork *work, const LaneCall *call,
                        size_t points, LaneRun *run);
/* Steps that tell of the instance of each lane, in blocks that are full. */
void lane_instance_step(const LaneWork *work, const LaneCode *code, size_t points);

/* Returns the length of a vector that is very long or very short. */
double lane_length(const double *vector, uint32_t size);

LaneRun lane_double_plain, lane_single_plain;
LaneRun lane_double_avx2, lane_single_avx2;
LaneRun lane_double_avx512, lane_single_avx512;

/* Cell tapes, by the best set and by each. */
LaneCellRun lane_cell_run, lane_cells_plain, lane_cells_avx2, lane_cells_avx512;
LaneWideRun lane_wide_run, lane_wide_plain, lane_wide_avx2, lane_wide_avx512;

#endif
