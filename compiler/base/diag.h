/*
 * diag.h: diagnostics: errors, warnings and notes for the author of a scene.
 *
 * Diagnostics are collected, not printed.  Each has a code (a row of diag.def) and a location, and
 * may have a label, notes and help.  Messages start with a lower-case letter and do not end with
 * punctuation; only `help` suggests what to do.
 */
#ifndef KRS_DIAG_H
#define KRS_DIAG_H

#include "compiler/base/source.h"
#include "compiler/base/text.h"

struct Json;

typedef enum DiagSeverity { DIAG_ERROR, DIAG_WARNING, DIAG_NOTE } DiagSeverity;

typedef enum DiagCode {
#define DIAG(code, severity, name, title, explanation) DIAG_##name,
#include "compiler/base/diag.def"
#undef DIAG
    DIAG_CODE_COUNT
} DiagCode;

typedef struct DiagInfo {
    const char  *code; /* "E0203" */
    DiagSeverity severity;
} DiagInfo;

extern const DiagInfo diag_info[DIAG_CODE_COUNT];

/* A further location of a diagnostic, marked with ---- and its own label. */
typedef struct SecondarySpan {
    Span        span;
    const char *label;
} SecondarySpan;

typedef struct Diag {
    DiagCode    code;
    const char *message;
    Span        span;
    const char *label;       /* stands after the ^^^^ marks; may be NULL */
    const char *help;        /* may be NULL */
    const char *replacement; /* text to put in place of `span`; may be NULL */
    struct {
        SecondarySpan *items;
        size_t         count, capacity;
    } secondary;
    struct {
        const char **items;
        size_t       count, capacity;
    } notes;
} Diag;

typedef struct Diags {
    Arena         *arena; /* of the diagnostics and their texts */
    const Sources *sources;
    Diag         **items;
    size_t         count, capacity;
    size_t         errors, warnings; /* how many there were, stored or not */
    Diag           scrap;            /* takes a diagnostic that is not stored */
} Diags;

enum { MAX_DIAGS = 20 }; /* errors that are stored at most; as many warnings.  All notes are */

/* Adds a diagnostic, whose members behind `message` the caller may set.  Never NULL: a diagnostic
   that is not stored goes to `scrap`.  These are all after the first MAX_DIAGS, which are counted,
   and repeats of a code at one span, which are not.  Notes may repeat. */
Diag *diag_add(Diags *diags, DiagCode code, Span span, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
/* Formats text into the arena of the diagnostics, for labels and help. */
const char *diag_text(Diags *diags, const char *format, ...) __attribute__((format(printf, 2, 3)));
void        diag_note(Diags *diags, Diag *diag, const char *note);
void        diag_secondary(Diags *diags, Diag *diag, Span span, const char *label);

/* Tells whether further errors would not be stored, so that a pass may stop looking for them. */
bool diags_full(const Diags *diags);

/* Sorts by source, in the order in which sources were read, then by position.  Notes come first, in
   their own order. */
void diags_sort(Diags *diags);

/* Writes all diagnostics as in language.md, "What an error looks like".  The last line has their
   number, as in "2 errors".  `color` adds terminal colours. */
void diags_print_text(const Diags *diags, bool color, Text *out);
/* Writes a JSON object in each line, with the field names of the Language Server Protocol. */
void diags_print_json(const Diags *diags, Text *out);
/* Writes one diagnostic alone, as the two functions above do. */
void diag_print_one(const Diags *diags, const Diag *diag, bool color, Text *out);
void diag_json_one(const Diags *diags, const Diag *diag, Text *out);
/* Writes a range of a source as the Language Server Protocol has it; NULL: it is at the start. */
void diag_json_range(struct Json *json, const char *name, const Source *source, uint32_t start,
                     uint32_t end);

/* Returns "error", "warning" or "note". */
const char *diag_severity(DiagCode code);
/* Returns the row of "E0203", or NULL. */
const DiagInfo *diag_find(const char *code);

#endif
