/*
 * document.h: a scene while it is edited: its last good version, and what is wrong with its text.
 */
#ifndef KRS_DOCUMENT_H
#define KRS_DOCUMENT_H

#include "krs/krs.h"

/* A text that compiled.  Several threads may hold it; the last one to let go frees the scene. */
typedef struct Version Version;

Version  *version_hold(Version *version);
void      version_release(Version *version); /* NULL is ignored */
KrsScene *version_scene(const Version *version);
/* Returns the number of a version, from 1 on, greater for each later one. */
unsigned version_number(const Version *version);
/* Returns a number that versions share if the same shaders show them. */
unsigned version_structure(const Version *version);
/* Tells what differs from the version before; of the first, everything is new. */
KrsChanges version_changes(const Version *version);

/* Writes a place such as "a.krs:3". */
void diagnostic_location(const KrsDiagnostic *diagnostic, char place[300]);

/* The diagnostics of a text that was read.  The strings are its own. */
typedef struct Diagnostics {
    KrsDiagnostic *items;
    size_t         count, errors;
} Diagnostics;

typedef struct Document Document;

/* Returns a document of a file, which is not read yet.  The callbacks of `options` are called as
   well as the document's own; `path` and the options' strings must outlive the document.  NULL: the
   system does not let files be watched, or memory ran out. */
Document *document_new(const char *path, const KrsOptions *options);
void      document_free(Document *document);

/* A scene that is no file of its own, as one in a pack: its text, and its name. */
typedef struct SuppliedText {
    const char *name, *text; /* `text` NULL: the scene is a file */
    size_t      length;
} SuppliedText;

/* The document is this text, which must outlive it, and never changes: no file is watched. */
void document_supply(Document *document, SuppliedText text);

/* Reads and compiles the file.  On KRS_OK there is a new version; otherwise the last good one stays,
   and the diagnostics say why.  A mistake counts if nothing else is saved for SETTLED_SECONDS (watcher.h): an
   editor may not be done.  KRS_CANNOT_CREATE: the system does not let a file be watched. */
KrsStatus document_read(Document *document);

/* Compiles the file once more, the way that edits of it are compiled, if that is another way than the
   first (KRS_SPECIALIZE_AUTO).  The next reading is compared with that: what was made for its shaders
   serves the edit.  If the file has changed meanwhile, this is a reading. */
void document_prepare(Document *document);
/* Returns what that has made, which the caller releases; NULL: nothing, or a reading came after
   it.  For any thread. */
Version *document_spare(Document *document);

/* Returns the last good version, which the caller releases; NULL: there is none.  For any thread. */
Version *document_version(Document *document);
/* Returns a copy of what was said when the file was last read, which the caller frees; for any
   thread. */
Diagnostics document_diagnostics(Document *document);
void        diagnostics_free(Diagnostics *diagnostics);
/* Returns the first that is an error, not a warning; NULL: none is there. */
const KrsDiagnostic *diagnostics_first_error(const Diagnostics *diagnostics);
/* Tells how often the file was read; for any thread. */
unsigned document_readings(Document *document);

/* Watches a file as if it had been read.  False: the system refuses. */
bool document_watch(Document *document, const char *path);
/* Tells whether the file, or one that it uses, has changed since the last call; waits for nothing. */
bool document_changed(Document *document);
/* Waits for that.  False: a signal has come, the time is over, or document_wake was called. */
bool document_wait(Document *document, double seconds);
/* Ends a wait; for any thread. */
void document_wake(Document *document);

#endif
