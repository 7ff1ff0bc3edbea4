/*
 * files.h: the files that a scene consists of: its own, those that it uses, and the library's.
 *
 * They are read before anything is evaluated: texts, then tokens, then trees, and then, tree by
 * tree, the files that a `use` names.
 */
#ifndef KRS_FILES_H
#define KRS_FILES_H

#include "compiler/base/loader.h"
#include "compiler/front/syntax.h"

typedef struct File {
    const char   *path;   /* as diagnostics show it */
    uint32_t      source; /* its number in Files.sources */
    size_t        number; /* its place in Files.items */
    bool          library;
    bool          reading;    /* files that it uses are being read */
    bool          incomplete; /* mistakes may hide names: in another file, or in a missing one */
    bool          checked;
    Tokens        tokens;
    const Syntax *syntax;
    struct {
        struct File **items;
        size_t        count, capacity;
    } used; /* in the order of its `use` statements; no file uses itself, however indirectly */
} File;

/* The scene's own file is the first; those of the library that every scene sees come next, then
   the used ones in the order of reading. */
typedef struct Files {
    File        **items;
    size_t        count, capacity;
    size_t        bytes;   /* of all texts, the library's aside */
    Arena        *arena;   /* paths and lists */
    Arena        *trees;   /* tokens and syntax */
    Arena        *scratch; /* free after each call */
    Diags        *diags;
    Names        *names;
    Sources      *sources;
    const Loader *loader; /* of files that a `use` names */
} Files;

/* Takes up the text of the scene and those of the library. */
void files_load(Files *files, const char *path, const char *text, size_t length);
/* Tokens, and trees, of all that has been taken up. */
void files_lex(Files *files);
void files_parse(Files *files);
/* Reads all that the scene uses, and what that uses.  Mistakes are reported. */
void files_load_used(Files *files);
/* Checks the names of each file (names.h); `builtin` need no definition. */
void files_check_names(Files *files, const char *const *builtin, size_t count);

/* For dumps: a line for each text; for each file with the files it uses; for each definition, the
   library's last. */
void files_print_texts(const Files *files, Text *out);
void files_print_uses(const Files *files, Text *out);
void files_print_names(const Files *files, Text *out);

#endif
