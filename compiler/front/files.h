/*
 * files.h: the files of a scene: its own, those that it uses, and those of the library.
 *
 * All of them are read before anything is evaluated.  First come texts, tokens and trees of the
 * scene and the library, then the files that `use` statements in these trees name.
 */
#ifndef KRS_FILES_H
#define KRS_FILES_H

#include "compiler/base/loader.h"
#include "compiler/front/names.h"

typedef struct File {
    const char   *path;   /* as diagnostics show it */
    uint32_t      source; /* index in Files.sources */
    size_t        number; /* index in Files.items */
    bool          library;
    bool          reading;    /* the files that it uses are being read */
    bool          incomplete; /* names may be missing: a used file has mistakes or was not read */
    bool          checked;    /* its names have been checked */
    Tokens        tokens;
    const Syntax *syntax;
    struct {
        struct File **items;
        size_t        count, capacity;
    } used;        /* in the order of its `use` statements; there are no cycles */
    NameUses uses; /* what its names mean, where Files.tells_uses */
} File;

/* A file that is no scene. */
typedef struct DataFile {
    const char *path;
    uint32_t    source;
} DataFile;

/* All files: first the scene's own, then those of the library that every scene sees, then the used
   ones in the order in which they were read. */
typedef struct Files {
    File        **items;
    size_t        count, capacity;
    size_t        bytes;   /* length of all texts but those that every scene sees */
    Arena        *arena;   /* of paths and lists */
    Arena        *trees;   /* of tokens and trees */
    Arena        *scratch; /* of what a call needs only while it runs */
    Diags        *diags;
    Names        *names;
    Sources      *sources;
    const Loader *loader; /* reads the files that a scene names */
    bool tells_uses;      /* names_check tells what the names of each file mean, and tokens stay */
    struct {
        DataFile *items;
        size_t    count, capacity;
    } data; /* that was read */
} Files;

/* Adds the scene, whose text is given, and the files of the library. */
void files_load(Files *files, const char *path, const char *text, size_t length);
/* Makes tokens, and from these trees, of all files so far. */
void files_lex(Files *files);
void files_parse(Files *files);
/* Reads the files that the scene uses, directly or through others.  Mistakes are reported. */
void files_load_used(Files *files);
/* Returns the file that a `use` of another names; NULL: it was not read. */
const File *files_used(Files *files, const File *from, const Syntax *use);
/* Returns the number of the source with the text of a file that source `from` reads, named at
   `place`; 0: it cannot be read, which is reported. */
uint32_t files_load_data(Files *files, uint32_t from, const char *name, Span place);
/* Returns "folder/used.krs" for a "used.krs" that is named in "folder/file.krs". */
const char *files_beside(const Files *files, const char *from, const char *path);
/* Reports a file that could not be read. */
Diag *files_refuse(const Files *files, Span place, const char *path, const Loaded *loaded,
                   const char *label);
/* Checks the names of each file (names.h); those in `builtin` need no definition. */
void files_check_names(Files *files, const char *const *builtin, size_t count);

/* Dumps: a line for each text; for each file, and for each file that it uses; for each definition,
   those of the library last. */
void files_print_texts(const Files *files, Text *out);
void files_print_uses(const Files *files, Text *out);
void files_print_names(const Files *files, Text *out);

#endif
