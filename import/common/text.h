/*
 * text.h: a file of another program, and the text of the scene that it becomes.
 */
#ifndef KRS_IMPORT_TEXT_H
#define KRS_IMPORT_TEXT_H

#include <stdbool.h>

#include "compiler/base/text.h"
#include "krs/krs.h"

/* An offset from which on the text of the scene comes from this line of the file. */
typedef struct ImportMark {
    size_t   offset;
    unsigned line;
} ImportMark;

/* A note of something that is left out of the scene without harm. */
typedef struct ImportNote {
    const char *words;
    unsigned    line;
    bool left_out; /* it is of a part that was refused, which the command says in its own words */
} ImportNote;

typedef struct Import {
    const char *path;  /* of the file, for words about it */
    const char *name;  /* the same without folders, for a comment in the scene */
    const char *bytes; /* all of it, without a NUL but for the one behind it */
    size_t      length;
    const char *output; /* the file of the scene; NULL: standard output */
    const char *root;   /* the folder that may be read; NULL: any */
    uint64_t    memory; /* bytes that compiling the scene may use; 0: as usual */
    Arena      *arena;
    bool        as_field; /* an equation is no polynomial */
    Text        scene;    /* what came of it */
    struct {
        ImportMark *items;
        size_t      count, capacity;
    } marks;
    struct {
        ImportNote *items;
        size_t      count, capacity;
    } notes;
    struct {
        ImportNote *items;
        size_t      count, capacity;
    } blames;        /* what slopes without a bound may come from */
    bool keep_going; /* what is refused is left out */
    struct {
        ImportNote *items;
        size_t      count, capacity;
    } left_out; /* what was refused, and where */
    struct {
        unsigned *items;
        size_t    count, capacity;
    } no_scene;   /* lines of parts that do not compile, and are not read again */
    Text refusal; /* "path:line: " and why there is no scene; empty when there is one */
} Import;

/* Notes "path:line: " and the words, unless something was refused before; returns false. */
bool import_refuse(Import *import, unsigned line, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Notes what the scene leaves out; the same words count once. */
void import_note(Import *import, unsigned line, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* Notes why a slope may have no bound at a line, for words about it. */
void import_blame(Import *import, unsigned line, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* Tells whether to go on without a part that was just refused, which stands on this line: notes why, and
   forgets the refusal. */
bool import_leaves_out(Import *import, unsigned line);
/* Tells whether a part of this line was found to be no scene. */
bool import_was_left_out(const Import *import, unsigned line);
/* Writes "From FILE." and the notes, as comments. */
void import_write_head(Import *import);

/* Tells how the scene is compiled: where a folder is all that may be read, it reads no file but the one
   that it comes from.  The import must live as long as they are used. */
KrsOptions import_options(Import *import);
/* Tells whether a text is a scene. */
bool import_compiles(Import *import, const char *scene);

/* Notes the line that what is added to the scene now comes from. */
void import_mark(Import *import, unsigned line);
/* Returns the line of the file that a line of the scene comes from, from 1. */
unsigned import_origin(const Import *import, unsigned scene_line);

/* Rounds a number that an import has computed: drops the noise behind twelve digits. */
double import_rounded(double number);
/* These add a number as the language writes it; NaN and infinities have no such form. */
void import_add_number(Text *text, double number);
void import_add_vector(Text *text, const double *numbers, int count);

#endif
