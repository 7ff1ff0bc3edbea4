/*
 * render_stats.h: what `krs render --stats` prints of a frame.
 */
#ifndef KRS_CLI_RENDER_STATS_H
#define KRS_CLI_RENDER_STATS_H

#include "cli/shell/commands.h"
#include "krs/vulkan.h"

/* Prints in the form that was asked for; one JSON object a frame, each on a line of its own. */
void render_stats_show(const Options *options, const KrsRendering *rendering,
                       const KrsProgram *program, const KrsRenderStats *stats, uint32_t frame);

#endif
