/*
 * specialize.c: `--specialize auto`: whether a scene is rendered with its numbers as literals, or
 * with numbers in the parameter block, so that edits of them compile nothing.
 *
 * Who has edited a scene once will do so again.  So the cache of shaders remembers each structure
 * that was rendered: its key is the text of the shaders without their numbers.  The entry has a
 * hash of the text with the first literals, and whether other ones were seen since.  Edits that no
 * shader shows, of cameras and lights, do not count.
 *
 * Scenes that no structure can be compiled of, or remembered, have literals.  So have scenes of so many
 * numbers that a driver would take minutes without them.
 */
#include <stdlib.h>
#include <string.h>

#include "cli/shell/commands.h"
#include "cli/shell/supervise.h"
#include "runtime/device/cache.h"

/* Samples from which literals are better even if they are new.  At 640x360, 16 samples of
   examples/09-palm.krs save as much time as the compilation of its literals takes (`krs render
   --stats` with each --specialize, lavapipe); scenes that are faster compiled save more. */
#define SAMPLES_THAT_REPAY_LITERALS (16.0 * 640 * 360)

/* An entry of the cache; all bytes, so nothing is between the members. */
typedef struct SeenStructure {
    CacheKey      literals; /* of the scene that had it first */
    unsigned char edited;   /* whether a scene with other literals has had it */
} SeenStructure;

_Static_assert(sizeof(SeenStructure) == sizeof(CacheKey) + 1, "each byte of an entry has a value");

/* Returns false if without memory. */
static bool hash_text(const KrsScene *scene, const char *maker, CacheKey *key)
{
    char *text = krs_scene_plain_text(scene, NULL);
    if (!text)
        return false;
    *key = cache_key(maker, text, strlen(text));
    free(text);
    return true;
}

static bool load_structure(Cache *cache, CacheKey key, SeenStructure *seen)
{
    size_t     length = 0;
    void      *bytes  = cache_load(cache, CACHE_STRUCTURE, key, &length);
    const bool known  = bytes && length == sizeof *seen;
    if (known)
        memcpy(seen, bytes, sizeof *seen);
    free(bytes);
    return known;
}

/* Tells whether a scene of this structure has ever had other literals; from now on it is known. */
static bool remember(Cache *cache, CacheKey structure, CacheKey literals)
{
    SeenStructure seen  = {.literals = literals};
    const bool    known = load_structure(cache, structure, &seen);
    const bool    other = memcmp(&seen.literals, &literals, sizeof literals) != 0;
    if (!known || (other && !seen.edited)) {
        seen.edited = other;
        cache_store(cache, CACHE_STRUCTURE, structure, &seen, sizeof seen);
    }
    return seen.edited;
}

static bool is_edited(const Options *options, const KrsScene *literals, const KrsScene *structure)
{
    Cache    cache;
    CacheKey key, first;
    if (strcmp(krs_scene_hash(structure), krs_scene_hash(literals)) != 0)
        return false; /* its file was written in between */
    if (!hash_text(structure, "structure", &key) || !hash_text(literals, "literals", &first))
        return false;
    cache_open(&cache, cache_folder(options), (KrsAllocator){0});
    const bool edited = remember(&cache, key, first);
    cache_close(&cache);
    return edited;
}

/* Compiles the structure without diagnostics, which were printed when the literals were compiled. */
static KrsScene *compile_structure(const Options *options)
{
    const char    *path = options->files.items[0];
    DiagnosticSink sink = {.options = options};
    KrsOptions     with = scene_options(&sink, path);
    KrsScene      *scene;
    with.diagnostic = NULL;
    with.specialize = KRS_SPECIALIZE_STRUCTURE;
    scene_enter_compile(path);
    scene_compile(options, path, &with, &scene); /* NULL where it cannot be compiled */
    stage_enter(STAGE_START);
    return scene;
}

KrsScene *specialize_edited(const Options *options, const KrsScene *literals, double samples)
{
    if (samples > SAMPLES_THAT_REPAY_LITERALS || !cache_folder(options))
        return NULL;
    KrsScene *structure = compile_structure(options);
    if (!structure ||
        (krs_structure_is_affordable(structure) && is_edited(options, literals, structure)))
        return structure;
    krs_scene_free(structure);
    return NULL;
}
