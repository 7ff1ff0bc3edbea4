/*
 * choices.c: the words that options take; most are names of the library's enums, in their order.
 */
#include "cli/options/choices.h"

#include <stddef.h>
#include <string.h>

#define LAST       \
    {              \
        NULL, NULL \
    }

const Choice integrator_choices[] = {{"default", "as the scene says, or preview"},
#define KRS_INTEGRATOR(id, name, about) {#name, about},
#include "krs/choices.def"
                                     LAST};
const Choice trace_choices[] = {
#define KRS_TRACE(id, name, about) {name, about},
#include "krs/choices.def"
    LAST};
const Choice schedule_choices[] = {
#define KRS_SCHEDULE(id, name, about) {name, about},
#include "krs/choices.def"
    LAST};
const Choice components_choices[] = {
#define KRS_COMPONENTS(id, name, about) {name, about},
#include "krs/choices.def"
    LAST};
const Choice normals_choices[] = {
#define KRS_NORMALS(id, name, about) {name, about},
#include "krs/choices.def"
    LAST};
const Choice shadows_choices[] = {
#define KRS_SHADOWS(id, name, about) {name, about},
#include "krs/choices.def"
    LAST};
const Choice caustics_choices[] = {
#define KRS_CAUSTICS(id, name, about) {name, about},
#include "krs/choices.def"
    LAST};
const Choice executor_choices[] = {
#define KRS_EXECUTOR(id, name, about) {name, about},
#include "krs/choices.def"
    LAST};
const Choice starts_choices[] = {
#define KRS_STARTS(id, name, about) {name, about},
#include "krs/choices.def"
    LAST};
const Choice catcher_choices[] = {
#define KRS_CATCHER(id, name, about) {name, about},
#include "krs/choices.def"
    LAST};
const Choice pixel_filter_choices[] = {
#define KRS_PIXEL_FILTER(id, name, reach, integral, about) {name, about},
#include "krs/choices.def"
    LAST};
const Choice plane_choices[] = {
#define KRS_AOV(id, bit, aov, about, arrays) {aov, about},
#include "krs/aovs.def"
#undef KRS_AOV
    LAST};
const Choice tone_map_choices[] = {
#define KRS_TONE_MAP(id, name, about) {#name, about},
#include "krs/choices.def"
    LAST};
const Choice language_choices[] = {
#define KRS_TARGET(id, name, about) {#name, about},
#include "krs/targets.def"
    LAST};
const Choice export_choices[] = {
#define EXPORT_TARGET(id, name, words, language, source, tables, baked, cameras, longest, about) \
    {name, about},
#include "export/targets.def"
    LAST};
const Choice stereo_choices[] = {
    {"side-by-side", "the left eye's to the left"}, {"over-under", "the left eye's above"}, LAST};
const Choice specialize_choices[] = {
    {"numbers", "as literals: the fastest frames"},
    {"structure", "in the parameter block: an edit of a number compiles nothing"},
    {"auto", "as numbers at first, as structure from the first edit on that the cache knows of; as "
             "numbers for many samples; compile and dump see no edits, so as numbers"},
    LAST};
const Choice early_outs_choices[]  = {{"default", ""}, {"on", ""}, {"off", ""}, LAST};
const Choice on_off_choices[]      = {{"on", ""}, {"off", ""}, LAST};
const Choice on_choices[]          = {{"host", ""}, {"device", ""}, LAST};
const Choice when_choices[]        = {{"auto", ""}, {"always", ""}, {"never", ""}, LAST};
const Choice diagnostics_choices[] = {{"text", ""}, {"json", ""}, LAST};
const Choice copies_choices[] = {{"instances", "a mesh for each kernel, and where its copies are"},
                                 {"flat", "the triangles of each copy"},
                                 {"merged", "one mesh of all that is solid"},
                                 LAST};
const Choice split_choices[]  = {{"none", "one mesh of all"},
                                 {"components", "a mesh for each component, by its name"},
                                 {"materials", "triangles keep the names of their materials"},
                                 LAST};
const Choice unit_choices[]   = {{"mm", ""}, {"um", ""}, {"cm", ""}, {"m", ""},
                                 {"in", ""}, {"ft", ""}, LAST};
const Choice axis_choices[]   = {{"x", ""}, {"y", ""}, {"z", ""}, LAST};
const Choice exposure_choices[]  = {{"binary", ""}, {"gray", ""}, LAST};
const Choice untrusted_choices[] = {{"limits", ""}, LAST};
const Choice json_choices[]      = {{"json", ""}, LAST};
const Choice pass_choices[]      = {
#define PASS(name, validate, meaning)          {#name, ""},
#define PASS_TO(form, name, validate, meaning) {form, ""}, {#name, ""},
#include "compiler/passes/passes.def"
    {"spirv", ""}, LAST};

int find_choice(const char *word, const Choice *choices)
{
    for (int i = 0; choices[i].name; i++)
        if (choices[i].name[0] && strcmp(choices[i].name, "default") != 0 &&
            strcmp(choices[i].name, word) == 0)
            return i;
    return -1;
}
