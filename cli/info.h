/*
 * info.h: one run of `krs info`: info.c shows what a scene consists of, info_print.c the figures of a part, info_cost.c
 * what parts cost.
 */
#ifndef KRS_INFO_H
#define KRS_INFO_H

#include "cli/shell/commands.h"
#include "cli/shell/console.h"
#include "compiler/base/json.h"

/* Refuses options that have no meaning without --print, or without --cost. */
KrsStatus info_check_options(const Options *options);
/* Measures what the scene shows, and prints that. */
KrsStatus info_print(const Options *options, const KrsScene *scene);
/* Times the parts of the scene, and prints what each costs. */
KrsStatus info_cost(const Options *options, const KrsScene *scene);
/* Adds the members that `krs info --json` and the NAME.json of `krs compile` have in common. */
void info_add_json(Json *json, const KrsScene *scene);
/* Adds the version and the hash of a scene, with which each answer begins. */
void info_begin_json(Json *json, const KrsScene *scene);

#endif
