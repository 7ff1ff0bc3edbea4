/*
 * answers.h: answers to a page, in JSON.
 */
#ifndef KRS_WEB_ANSWERS_H
#define KRS_WEB_ANSWERS_H

#include "krs/krs.h"

/* Returns the last answer; it lives until the next. */
const char *answer_text(void);

/* Begins the answer; diagnostics come between, one by one. */
void answer_begin_compilation(void);
void answer_diagnostic(void *user, const KrsDiagnostic *diagnostic);
/* Ends the answer; `changes` may be NULL. */
void answer_end_compilation(KrsStatus status, const KrsChanges *changes);

void answer_scene(const KrsScene *scene);
void answer_view(const KrsScene *scene, KrsState *state);
void answer_hits(KrsStatus status, const KrsHit *hits, size_t count);
/* Answers with a mesh, which is NULL unless the status is KRS_OK. */
void answer_mesh(KrsStatus status, const KrsMesh *mesh);

#endif
