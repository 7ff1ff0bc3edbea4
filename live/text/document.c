/*
 * document.c: a scene while it is edited.
 *
 * Edits are compared to the version before.  So a scene that is right again after a mistake is an
 * update of the one that was right before it, and its shaders are not compiled again.
 */
#include "live/text/document.h"

#include <limits.h>
#include <poll.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/eventfd.h>
#include <sys/stat.h>
#include <unistd.h>

#include "live/text/watcher.h"

struct Version {
    KrsScene   *scene;
    KrsChanges  changes;
    unsigned    number, structure;
    atomic_uint holders;
};

struct Document {
    const char     *path;
    KrsOptions      options; /* the caller's */
    SuppliedText    supplied;
    Watcher        *watcher;
    bool            refused; /* the system does not let us watch a file */
    int             woken;   /* an eventfd */
    Diagnostics     heard;   /* by the reading that is under way; told when it has ended */
    bool            quiet;   /* what is said now was said before */
    pthread_mutex_t lock;    /* of all below */
    Version        *version;
    Version        *spare; /* of the same text, for edits to be compared with */
    Diagnostics     diagnostics;
    unsigned        readings;
};

/* ---- versions ---- */

Version *version_hold(Version *version)
{
    if (version)
        atomic_fetch_add(&version->holders, 1);
    return version;
}

void version_release(Version *version)
{
    if (!version || atomic_fetch_sub(&version->holders, 1) > 1)
        return;
    krs_scene_free(version->scene);
    free(version);
}

KrsScene *version_scene(const Version *version) { return version->scene; }

unsigned version_number(const Version *version) { return version->number; }

unsigned version_structure(const Version *version) { return version->structure; }

KrsChanges version_changes(const Version *version) { return version->changes; }

/* ---- diagnostics ---- */

void diagnostic_location(const KrsDiagnostic *diagnostic, char place[300])
{
    snprintf(place, 300, "%s:%u", diagnostic->source, diagnostic->line);
}

static void diagnostic_free(KrsDiagnostic *diagnostic)
{
    free((char *)diagnostic->code);
    free((char *)diagnostic->message);
    free((char *)diagnostic->source);
    free((char *)diagnostic->text);
    free((char *)diagnostic->json);
}

void diagnostics_free(Diagnostics *diagnostics)
{
    for (size_t i = 0; i < diagnostics->count; i++)
        diagnostic_free(&diagnostics->items[i]);
    free(diagnostics->items);
    *diagnostics = (Diagnostics){0};
}

static char *copy(const char *words) { return strdup(words ? words : ""); }

static void diagnostics_add(Diagnostics *diagnostics, const KrsDiagnostic *diagnostic)
{
    KrsDiagnostic *items = realloc(diagnostics->items, (diagnostics->count + 1) * sizeof *items);
    if (!items)
        return;
    diagnostics->items   = items;
    KrsDiagnostic *added = &items[diagnostics->count];
    *added               = *diagnostic;
    added->code          = copy(diagnostic->code);
    added->message       = copy(diagnostic->message);
    added->source        = copy(diagnostic->source);
    added->text          = copy(diagnostic->text);
    added->json          = copy(diagnostic->json);
    diagnostics->errors += diagnostic->error;
    if (added->code && added->message && added->source && added->text && added->json)
        diagnostics->count++;
    else
        diagnostic_free(added);
}

const KrsDiagnostic *diagnostics_first_error(const Diagnostics *diagnostics)
{
    for (size_t i = 0; i < diagnostics->count; i++)
        if (diagnostics->items[i].error)
            return &diagnostics->items[i];
    return NULL;
}

static void hear(void *user, const KrsDiagnostic *diagnostic)
{
    Document *document = user;
    if (!document->quiet)
        diagnostics_add(&document->heard, diagnostic);
}

/* Hands on what was heard: now it counts. */
static void tell(const Document *document)
{
    const KrsOptions *options = &document->options;
    for (size_t i = 0; options->diagnostic && i < document->heard.count; i++)
        options->diagnostic(options->user, &document->heard.items[i]);
}

static void watch_file(void *user, const char *path)
{
    Document *document = user;
    document->refused  = !watcher_add(document->watcher, path) || document->refused;
    if (document->options.opened)
        document->options.opened(document->options.opened_user, path);
}

/* ---- documents ---- */

Document *document_new(const char *path, const KrsOptions *options)
{
    Document *document = calloc(1, sizeof *document);
    if (!document)
        return NULL;
    document->path    = path;
    document->options = *options;
    document->woken   = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    document->watcher = watcher_new();
    pthread_mutex_init(&document->lock, NULL);
    if (document->watcher && document->woken >= 0)
        return document;
    document_free(document);
    return NULL;
}

void document_supply(Document *document, SuppliedText text) { document->supplied = text; }

void document_free(Document *document)
{
    if (!document)
        return;
    version_release(document->version);
    version_release(document->spare);
    diagnostics_free(&document->diagnostics);
    diagnostics_free(&document->heard);
    watcher_free(document->watcher);
    if (document->woken >= 0)
        close(document->woken);
    pthread_mutex_destroy(&document->lock);
    free(document);
}

/* Returns what the next version is compared with. */
static Version *version_before(const Document *document)
{
    return document->spare ? document->spare : document->version;
}

/* Tells whether there is something else than a file, such as a pipe, which may never end: nobody
   could save the scene any more. */
static bool is_no_file(Document *document)
{
    struct stat about;
    if (stat(document->path, &about) != 0 || S_ISREG(about.st_mode) || S_ISDIR(about.st_mode))
        return false;
    watch_file(document, document->path);
    hear(document,
         &(KrsDiagnostic){.error   = true,
                          .code    = "E0501",
                          .message = "in the place of the scene is no file, but a pipe or a device",
                          .source  = document->path,
                          .line    = 1,
                          .column  = 1,
                          .text = "error[E0501]: in the place of the scene is no file, but a pipe "
                                  "or a device\n",
                          .json = "{\"severity\": 1, \"code\": \"E0501\", \"message\": \"in the "
                                  "place of the scene is no file, but a pipe or a device\"}"});
    return true;
}

static const KrsChanges all_is_new = {
    KRS_CHANGE_STRUCTURE, true, true, true, true, true, true, true};

static KrsStatus compile(Document *document, KrsScene **scene, KrsChanges *changes)
{
    const SuppliedText *supplied = &document->supplied;
    KrsOptions          with     = document->options;
    with.diagnostic              = hear;
    with.user                    = document;
    if (supplied->text) {
        *changes = all_is_new;
        return krs_compile_text(supplied->text, supplied->length, supplied->name, &with, scene);
    }
    if (is_no_file(document))
        return KRS_IO_ERROR;
    with.opened      = watch_file;
    with.opened_user = document;
    if (document->version)
        return krs_scene_reload(version_before(document)->scene, scene, changes);
    *changes = all_is_new;
    return krs_compile_file(document->path, &with, scene);
}

/* Takes the scene.  NULL: without memory. */
static Version *version_new(KrsScene *scene, KrsChanges changes, const Version *before)
{
    const bool structure = changes.kind == KRS_CHANGE_STRUCTURE;
    Version   *version   = malloc(sizeof *version);
    if (!version) {
        krs_scene_free(scene);
        return NULL;
    }
    version->scene     = scene;
    version->changes   = changes;
    version->number    = before ? before->number + 1 : 1;
    version->structure = before ? before->structure + structure : 1;
    atomic_init(&version->holders, 1);
    return version;
}

/* Puts what was read in the place of what was there. */
static void publish(Document *document, Version *version)
{
    Version *before = NULL, *spare = NULL;
    pthread_mutex_lock(&document->lock);
    Diagnostics old       = document->diagnostics;
    document->diagnostics = document->heard;
    document->readings    = document->readings + 1;
    if (version) {
        before            = document->version;
        spare             = document->spare;
        document->version = version;
        document->spare   = NULL;
    }
    pthread_mutex_unlock(&document->lock);
    document->heard = (Diagnostics){0};
    diagnostics_free(&old);
    version_release(before);
    version_release(spare);
}

/* Compiles once more as long as there is a mistake, and files are saved. */
static KrsStatus compile_settled(Document *document, KrsScene **scene, KrsChanges *changes)
{
    for (;;) {
        document->refused = false;
        watcher_settle(document->watcher);
        const KrsStatus status = compile(document, scene, changes);
        if (status == KRS_OK || document->refused ||
            !watcher_wait(document->watcher, SETTLED_SECONDS))
            return status;
        diagnostics_free(&document->heard);
    }
}

KrsStatus document_read(Document *document)
{
    KrsScene  *scene   = NULL;
    Version   *version = NULL;
    KrsChanges changes;
    KrsStatus  status = compile_settled(document, &scene, &changes);
    tell(document);
    if (status == KRS_OK) {
        version = version_new(scene, changes, version_before(document));
        status  = version ? KRS_OK : KRS_OUT_OF_MEMORY;
    }
    publish(document, version);
    return document->refused ? KRS_CANNOT_CREATE : status;
}

void document_prepare(Document *document)
{
    KrsScene  *scene;
    KrsChanges changes;
    if (!document->version || document->version->number > 1 || document->spare ||
        document->supplied.text || document->options.specialize != KRS_SPECIALIZE_AUTO)
        return;
    document->quiet        = true;
    const KrsStatus status = compile(document, &scene, &changes);
    document->quiet        = false;
    Version *spare = status == KRS_OK ? version_new(scene, changes, document->version) : NULL;
    if (document_changed(document)) {
        version_release(spare);
        document_read(document);
    } else if (spare) {
        spare->number = document->version->number; /* it shows the same */
        pthread_mutex_lock(&document->lock);
        document->spare = spare;
        pthread_mutex_unlock(&document->lock);
    }
}

static Version *hold(Document *document, Version *const *held)
{
    pthread_mutex_lock(&document->lock);
    Version *version = version_hold(*held);
    pthread_mutex_unlock(&document->lock);
    return version;
}

Version *document_version(Document *document) { return hold(document, &document->version); }

Version *document_spare(Document *document) { return hold(document, &document->spare); }

Diagnostics document_diagnostics(Document *document)
{
    Diagnostics copy = {0};
    pthread_mutex_lock(&document->lock);
    for (size_t i = 0; i < document->diagnostics.count; i++)
        diagnostics_add(&copy, &document->diagnostics.items[i]);
    pthread_mutex_unlock(&document->lock);
    return copy;
}

unsigned document_readings(Document *document)
{
    pthread_mutex_lock(&document->lock);
    unsigned readings = document->readings;
    pthread_mutex_unlock(&document->lock);
    return readings;
}

bool document_watch(Document *document, const char *path)
{
    return watcher_add(document->watcher, path);
}

bool document_changed(Document *document) { return watcher_changed(document->watcher); }

bool document_wait(Document *document, double seconds)
{
    struct pollfd events[2] = {{.fd = watcher_descriptor(document->watcher), .events = POLLIN},
                               {.fd = document->woken, .events = POLLIN}};
    int           limit     = seconds > INT_MAX / 1000 ? -1 : (int)(seconds * 1000);
    uint64_t      times;
    if (poll(events, 2, limit) <= 0)
        return false;
    if (events[1].revents && read(document->woken, &times, sizeof times) > 0)
        return false;
    return watcher_wait(document->watcher, 0);
}

void document_wake(Document *document)
{
    const uint64_t one = 1;
    if (write(document->woken, &one, sizeof one) < 0)
        return; /* it is awake already */
}
