/*
 * crash_report.h: what is kept of a crash.
 */
#ifndef KRS_CRASH_REPORT_H
#define KRS_CRASH_REPORT_H

#include "cli/options/options.h"

/* Says what happened, and keeps what is needed to see it again, scenes and command line; KRS_INTERNAL. */
int report_bug(const Options *options, const char *story);

#endif
