/*
 * watcher.h: tells when files have been written, made, replaced or removed, by inotify.
 */
#ifndef KRS_WATCHER_H
#define KRS_WATCHER_H

#include <stdbool.h>

typedef struct Watcher Watcher;

/* Watches no file yet.  NULL: the system refuses, see errno. */
Watcher *watcher_new(void);
void     watcher_free(Watcher *watcher); /* NULL is ignored */

/* Watches one more file, which need not exist, nor its folder.  A link is watched as well as what
   it leads to.  A file may be added again, and must be after it has changed: what its folder was
   may be somewhere else.  False: the system refuses, see errno. */
bool watcher_add(Watcher *watcher, const char *path);

/* Becomes readable when something may have changed: for poll(). */
int watcher_descriptor(const Watcher *watcher);

/* Tells whether files have changed since the last call; waits for nothing. */
bool watcher_changed(Watcher *watcher);

/* Waits until files have changed.  False: `seconds` are over, or a signal has come. */
bool watcher_wait(Watcher *watcher, double seconds);

/* The time that editors take that save a file in several steps. */
#define SETTLED_SECONDS 0.05
/* Forgets the changes so far.  Where a file was only made or taken away, waits until something is written
   or put in its place, for no longer than SETTLED_SECONDS. */
void watcher_settle(Watcher *watcher);

#endif
