/*
 * watcher.c: tells when files have been written, made, replaced or removed.
 *
 * Many editors do not write into a file, but put a new one in its place.  So folders are watched,
 * for the names of files in them.
 */
#include "live/text/watcher.h"

#include <errno.h>
#include <limits.h>
#include <poll.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/inotify.h>
#include <unistd.h>

/* A name in a folder; what happens to it counts. */
typedef struct Entry {
    int  folder; /* descriptor of inotify */
    char name[NAME_MAX + 1];
} Entry;

struct Watcher {
    int    inotify;
    bool   unfinished; /* the last change left no whole file */
    Entry *entries;
    size_t count, capacity;
};

/* After these there is a whole file.  Links and folders are whole when they are made, but so are not
   files, which only IN_CREATE tells of as well. */
#define WHOLE   (IN_CLOSE_WRITE | IN_MOVED_TO)
#define CHANGES (WHOLE | IN_MOVED_FROM | IN_CREATE | IN_DELETE | IN_DELETE_SELF | IN_MOVE_SELF)

Watcher *watcher_new(void)
{
    Watcher *watcher = calloc(1, sizeof *watcher);
    if (!watcher)
        return NULL;
    watcher->inotify = inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
    if (watcher->inotify >= 0)
        return watcher;
    free(watcher);
    return NULL;
}

void watcher_free(Watcher *watcher)
{
    if (!watcher)
        return;
    close(watcher->inotify);
    free(watcher->entries);
    free(watcher);
}

static bool add_entry(Watcher *watcher, int folder, const char *name)
{
    for (size_t i = 0; i < watcher->count; i++)
        if (watcher->entries[i].folder == folder && strcmp(watcher->entries[i].name, name) == 0)
            return true;
    if (watcher->count == watcher->capacity) {
        size_t capacity = watcher->capacity ? 2 * watcher->capacity : 16;
        Entry *entries  = realloc(watcher->entries, capacity * sizeof *entries);
        if (!entries)
            return false;
        watcher->entries  = entries;
        watcher->capacity = capacity;
    }
    Entry *entry  = &watcher->entries[watcher->count++];
    entry->folder = folder;
    strcpy(entry->name, name);
    return true;
}

/* Watches the last name of a path, which is changed here, in its folder.  If there is no such folder,
   its own name is watched in the one above. */
static bool watch_last_name(Watcher *watcher, char *path)
{
    for (;;) {
        char       *slash  = strrchr(path, '/');
        const char *name   = slash ? slash + 1 : path;
        const char *folder = !slash ? "." : slash == path ? "/" : path;
        char        kept[NAME_MAX + 1];
        if (strlen(name) > NAME_MAX)
            return true; /* no file can have this name */
        strcpy(kept, name);
        if (slash)
            *slash = '\0';
        int watched = inotify_add_watch(watcher->inotify, folder, CHANGES);
        if (watched >= 0)
            return add_entry(watcher, watched, kept);
        if ((errno != ENOENT && errno != ENOTDIR) || !slash || slash == path)
            return false;
    }
}

bool watcher_add(Watcher *watcher, const char *path)
{
    char *copy = strdup(path), *real = realpath(path, NULL);
    bool  done = copy && watch_last_name(watcher, copy);
    if (done && real)
        done = watch_last_name(watcher, real);
    int error = errno;
    free(copy);
    free(real);
    errno = error;
    return done;
}

int watcher_descriptor(const Watcher *watcher) { return watcher->inotify; }

static bool concerns(const Watcher *watcher, const struct inotify_event *event)
{
    if (event->mask & (IN_DELETE_SELF | IN_MOVE_SELF | IN_Q_OVERFLOW))
        return true; /* a folder is gone, or more has happened than the system remembers */
    for (size_t i = 0; event->len > 0 && i < watcher->count; i++)
        if (watcher->entries[i].folder == event->wd &&
            strcmp(watcher->entries[i].name, event->name) == 0)
            return true;
    return false;
}

bool watcher_changed(Watcher *watcher)
{
    _Alignas(struct inotify_event) char buffer[4096];
    bool                                changed = false;
    ssize_t                             length;
    while ((length = read(watcher->inotify, buffer, sizeof buffer)) > 0)
        for (char *at = buffer; at < buffer + length;) {
            const struct inotify_event *event = (const struct inotify_event *)(void *)at;
            at += sizeof *event + event->len;
            if (!concerns(watcher, event))
                continue;
            changed             = true;
            watcher->unfinished = !(event->mask & WHOLE);
        }
    return changed;
}

/* Tells whether something happens, to whatever file, within this time. */
static bool wait_for_event(Watcher *watcher, double seconds)
{
    struct pollfd events = {.fd = watcher->inotify, .events = POLLIN};
    return poll(&events, 1, seconds > INT_MAX / 1000 ? -1 : (int)(seconds * 1000)) > 0;
}

bool watcher_wait(Watcher *watcher, double seconds)
{
    bool changed = false;
    while (!changed && wait_for_event(watcher, seconds))
        changed = watcher_changed(watcher);
    return changed;
}

void watcher_settle(Watcher *watcher)
{
    watcher_changed(watcher);
    while (watcher->unfinished && wait_for_event(watcher, SETTLED_SECONDS))
        watcher_changed(watcher);
    watcher->unfinished = false;
}
