/*
 * completion.h: one completion, as its parts see it: complete.c, which finds what kind of word stands at the place;
 * complete_names.c, the names that are known there; and complete_words.c, words of tables, files and colours.
 */
#ifndef KRS_SERVICE_COMPLETION_H
#define KRS_SERVICE_COMPLETION_H

#include "compiler/service/analysis.h"

/* Kinds of items of the protocol. */
typedef enum ItemKind {
    ITEM_METHOD   = 2,
    ITEM_FUNCTION = 3,
    ITEM_FIELD    = 5,
    ITEM_VARIABLE = 6,
    ITEM_CLASS    = 7,
    ITEM_PROPERTY = 10,
    ITEM_UNIT     = 11,
    ITEM_KEYWORD  = 14,
    ITEM_COLOUR   = 16,
    ITEM_FILE     = 17,
    ITEM_FOLDER   = 19,
    ITEM_CONSTANT = 21,
    ITEM_STRUCT   = 22,
    ITEM_KIND     = 25
} ItemKind;

typedef struct Completion {
    const Here  *here;
    Json        *json;
    Tokens       tokens;
    const Token *before;     /* the last token in front of the word, or NULL */
    uint32_t     start, end; /* of the word that is being written */
    const char **seen;       /* names that were added: a hash table by address */
    size_t       seen_capacity;
} Completion;

typedef struct Item {
    const char *label, *insert, *detail, *doc;
    ItemKind    kind;
    char        order; /* letters, those that are nearer first */
} Item;

/* ---- complete_words.c ---- */

void completion_add(const Completion *c, Item item);
/* Adds words, behind which is NULL. */
void completion_add_words(const Completion *c, const char *const *words, ItemKind kind);
/* Returns two texts as one. */
const char *completion_text(const Completion *c, const char *before, const char *behind);
/* Tells whether a name is new, and notes it. */
bool completion_notes(Completion *c, const char *name);

/* Each of these adds what may stand at the place: a property of a block, a kind of a parameter, the first word of a
   statement, a colour, or the path of a file, whose beginning is written. */
void complete_property(const Completion *c, SyntaxKind block);
void complete_kind(const Completion *c);
void complete_statement(const Completion *c, SyntaxKind block);
void complete_colour(Completion *c);
void complete_library_file(const Completion *c, const char *written);
/* Adds files in the folder that is written so far: scenes for a `use`, others for anything else. */
void complete_file(const Completion *c, const char *written, bool scenes);

/* ---- complete_names.c ---- */

/* Adds what an expression may begin with: names, and parameters of the call that is written. */
void complete_expression(Completion *c);
/* Adds what may stand behind a dot. */
void complete_member(const Completion *c);

#endif
