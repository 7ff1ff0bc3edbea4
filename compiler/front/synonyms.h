/*
 * synonyms.h: what an unknown word, or form, of a scene means in other programs, and how it is said here.
 *
 * synonyms.def has the rows.  Names of the library's files, and what these define, belong here too: both
 * are looked up before a name that is spelt alike is suggested.
 */
#ifndef KRS_SYNONYMS_H
#define KRS_SYNONYMS_H

#include "compiler/base/diag.h"

typedef enum SynonymPlace {
    SYNONYM_NAME,
    SYNONYM_STATEMENT,
    SYNONYM_METHOD,
    SYNONYM_DIRECTIVE,
    SYNONYM_PROPERTY,
    SYNONYM_PARAMETER,
    SYNONYM_CALL
} SynonymPlace;

typedef enum SynonymForm {
#define SYNONYM(...)
#define FORM(name, written, meaning, example) FORM_##name,
#include "compiler/front/synonyms.def"
    FORM_COUNT
} SynonymForm;

typedef struct Synonym {
    SynonymPlace place;
    const char  *word, *owner, *from, *instead, *meaning, *example;
} Synonym;

/* Returns the rows, for tests; NULL behind the last. */
const Synonym *synonym_row(size_t index);
/* Returns the text of a form, in a scene that leads to its row; and its help. */
const char *form_written(SynonymForm form);
const char *form_example(SynonymForm form);
const char *form_help(Diags *diags, SynonymForm form);

/* Tells whether there is a row for a word without owner. */
bool is_synonym(SynonymPlace place, const char *word);
/* Adds the help of the row for a word, if there is one: label, help and replacement.  `owner` is that
   of the row, "" where the place has none. */
bool explain_word(Diags *diags, Diag *diag, SynonymPlace place, const char *word,
                  const char *owner);
/* Does the same for an argument called `word` of a function, or .method, that has other
   parameters. */
bool explain_parameter(Diags *diags, Diag *diag, const char *word, const char *owner,
                       const char *const *parameters, size_t count);
/* Does the same for a name that may also be defined in a file of the library that is not used. */
bool explain_name(Diags *diags, Diag *diag, const char *name);
/* Suggests a file of the library for a `use` of one that is not there. */
void explain_file(Diags *diags, Diag *diag, const char *path);

#endif
