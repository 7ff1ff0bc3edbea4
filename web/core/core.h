/*
 * core.h: what a page calls of the compiler, beside functions of the library that take numbers and arrays alone.
 *
 * What is asked for in structs comes as JSON: each call that has an answer leaves it in core_answer.  There is one thread.
 */
#ifndef KRS_CORE_H
#define KRS_CORE_H

#include "krs/krs.h"

/* Members of KrsOptions, as bits. */
typedef enum CoreOption {
    CORE_STUDIO    = 1,
    CORE_PICTURES  = 2,
    CORE_GRADIENTS = 4,
    CORE_ASSEMBLY  = 8,
    CORE_FIGURES   = 16,
    CORE_STRUCTURE = 32, /* KRS_SPECIALIZE_STRUCTURE */
    CORE_AUTOMATIC = 64  /* KRS_SPECIALIZE_AUTO */
} CoreOption;

/* Returns the answer to the last call that has one, an object in JSON; it lives until the next. */
const char *core_answer(void);

/* These compile a text, or the edited text of a scene, which stays, within KrsOptions.memory_limit.
   The answer has `status` and `diagnostics`, and of an edit `changes`.  NULL: no scene came of it. */
KrsScene *core_compile(const char *text, size_t length, const char *name, uint32_t options,
                       size_t memory);
KrsScene *core_update(const KrsScene *scene, const char *text, size_t length);
/* Returns the text in the canonical layout, for free(); the answer is that of a compilation. */
char *core_format(const char *text, size_t length, const char *name);

/* Returns the text in a language of targets.def, for free(); `options` are the members of
   KrsTextOptions, as bits. */
char *core_text(const KrsScene *scene, uint32_t target, uint32_t options);
/* Answers with what a scene has: parameters, components, cameras, textures, sizes of what its text
   reads. */
void core_describe(const KrsScene *scene);

/* Returns the first state of a scene; NULL: there is no memory. */
KrsState *core_state(const KrsScene *scene);
/* Answers with what a picture of a state has: cameras, lights, sky and fog. */
void core_view(const KrsScene *scene, KrsState *state);

/* These answer with what is known at points, and where rays end: `status` and `hits`. */
void core_probe(KrsState *state, const double (*points)[3], size_t count);
void core_raycast(KrsState *state, const double (*origins)[3], const double (*directions)[3],
                  size_t count, double farthest, double tolerance);

/* Returns a mesh of a component, or of all where that is 0.  The answer has `status` and the
   members of KrsMesh; arrays are numbers of bytes in memory. */
KrsMesh *core_mesh(KrsState *state, double error, size_t component, bool simplify, bool draft);

/* ---- editor.c: what editors ask (compiler/service/service.h) ---- */

/* These open a text, which replaces an open one of that name; change what is between two positions,
   each a line and a number of UTF-16 units; and close it.  False: there is no memory, or it is not
   open. */
bool core_open(const char *name, const char *text, size_t length);
bool core_edit(const char *name, const uint32_t place[4], const char *text, size_t length);
void core_close(const char *name);
/* Sets a change that a diagnostic proposes, for the next question. */
void core_fix(const uint32_t place[4], const char *replacement, const char *diagnostic);
/* These return the answer to a question, in JSON, until the next; `color` has three parts.  NULL:
   it is refused, for this reason. */
const char *core_ask(const char *question, const char *name, const uint32_t place[4],
                     const char *word, bool definition, const double *color);
const char *core_refusal(void);
/* These return mistakes that reading finds, an array in JSON; and what a service can be asked, as
   the protocol says it.  NULL: there is no memory, or it is not open. */
const char *core_mistakes(const char *name);
const char *core_capabilities(void);
/* Returns the text of a file of the library: "solids.krs", "std/trees.krs"; NULL: there is none. */
const char *core_library(const char *name);

#endif
