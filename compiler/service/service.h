/*
 * service.h: what editors ask of texts that are open: what a name means, what may stand at a place, and more.
 *
 * Questions have the names of the Language Server Protocol 3.17, and answers are its JSON.  `krs lsp` and the core of
 * pages are two ways to ask.
 */
#ifndef KRS_SERVICE_H
#define KRS_SERVICE_H

#include "compiler/base/loader.h"
#include "compiler/base/source.h"

typedef struct Service Service;

/* The functions that a service calls of its host.  Paths are those of documents and, from these, of
   what they use; files of the library are "library:NAME".  Each member may be NULL. */
typedef struct ServiceHost {
    /* The text of a file that is not open; without it files are read from the disk. */
    TextSupplier *read;
    /* Names of all that is in a folder, a line each, those of folders with a slash behind; NULL: nobody knows. */
    const char *(*list)(void *user, const char *folder);
    /* The URI of a file that is not open; without it its path. */
    const char *(*uri)(void *user, const char *path);
    void *user;
} ServiceHost;

/* Makes a service; NULL: there is no memory. */
Service *service_new(const ServiceHost *host);
void     service_free(Service *service);

/* Opens a text, which replaces an open one of that path; changes a part of it; closes it.  False: there is no memory, it
   is longer than MAX_SOURCE_BYTES, or it is not open. */
bool service_open(Service *service, const char *path, const char *uri, const char *text,
                  size_t length);
bool service_edit(Service *service, const char *path, Utf16Position from, Utf16Position to,
                  const char *text, size_t length);
void service_close(Service *service, const char *path);
/* Forgets files that are not open: one may have changed. */
void service_forget(Service *service);

/* A change that a diagnostic proposes: a text in place of another; and the diagnostic itself, as
   JSON. */
typedef struct ServiceFix {
    Utf16Position from, to;
    const char   *replacement, *diagnostic;
} ServiceFix;

/* Parameters of a question; those that it has not are not read. */
typedef struct ServiceQuestion {
    const char       *path;
    Utf16Position     from, to;   /* a position is `from` */
    const char       *word;       /* the new name; what symbols are asked for */
    bool              definition; /* references: with the definition */
    double            color[3];   /* sRGB, from 0 to 1 */
    const ServiceFix *fixes;      /* of the diagnostics at the place */
    size_t            fix_count;
} ServiceQuestion;

/* Returns the result, until the next call; NULL: there is no such question, or it is refused. */
const char *service_answer(Service *service, const char *question, const ServiceQuestion *about);
/* Tells whether there is a question of this name. */
bool service_knows(const char *question);
/* Returns why the last question was refused; NULL: there is none of this name. */
const char *service_refusal(const Service *service);

/* These return an array of the diagnostics of a document: those that reading it finds, and those of
   a whole check, which may take long.  Both live until the next call; NULL: it is not open, or
   there is no memory. */
const char *service_diagnostics(Service *service, const char *path);
const char *service_check(Service *service, const char *path);

/* Returns the capabilities in the answer to `initialize`. */
const char *service_capabilities(Service *service);

#endif
