/*
 * server.h: what the files of the language server share.
 */
#ifndef KRS_LSP_SERVER_H
#define KRS_LSP_SERVER_H

#include <stdbool.h>
#include <stddef.h>
#include <sys/types.h>

#include "compiler/service/service.h"

/* ---- frames.c ---- */

/* The bytes that came from the editor, and have not been read. */
typedef struct Frames {
    char  *bytes;
    size_t start, end, capacity;
    bool   broken; /* no message can begin any more */
} Frames;

/* Reads what is there; false: it has ended, or there is no memory. */
bool frames_read(Frames *frames, int file);
/* Takes the next message, which is in the frames until the next call; false: it is not complete. */
bool frames_next(Frames *frames, const char **message, size_t *length);
/* Writes a message with its header; false: nobody reads. */
bool frame_write(int file, const char *message, size_t length);

/* ---- checks.c ---- */

/* A check of one document in a process of its own. */
typedef struct Check {
    pid_t  process; /* 0: none runs */
    int    pipe;
    char  *found; /* what it has written */
    size_t length, capacity;
} Check;

/* Returns false if no process can be started. */
bool check_start(Check *check, Service *service, const char *path);
/* Reads what it writes; true: it is done, and `found` is an array in JSON, or NULL where it ended without one. */
bool check_read(Check *check);
void check_stop(Check *check);

/* ---- places.c ---- */

/* Returns the path of a file, or the URI itself where that is of no file, for free(). */
char *path_of_uri(const char *uri);
/* The folder in which files of the library are put for editors, and the path that was last handed
   out. */
typedef struct Places {
    const char *folder; /* NULL: nowhere */
    char       *uri, *names;
} Places;
/* Members of ServiceHost. */
const char *place_uri(void *user, const char *path);
const char *place_list(void *user, const char *folder);
void        places_free(Places *places);

#endif
