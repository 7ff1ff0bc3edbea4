/*
 * update.c: compiles an edited text of a scene, and tells what is different.
 */
#include "compiler/scene/changes.h"

/* Compiles the text or, when that is NULL, the scene's file. */
static KrsStatus compile_again(const KrsScene *scene, const char *text, size_t length,
                               const KrsOptions *options, KrsScene **updated)
{
    return text ? krs_compile_text(text, length, scene->name, options, updated)
                : krs_compile_file(scene->name, options, updated);
}

static KrsStatus compile_edited(const KrsScene *scene, const char *text, size_t length,
                                KrsScene **updated)
{
    KrsOptions options   = scene->options;
    const bool automatic = options.specialize == KRS_SPECIALIZE_AUTO;
    options.text         = NULL; /* that of the first compilation */
    if (automatic)
        options.specialize = KRS_SPECIALIZE_STRUCTURE;
    KrsStatus status = compile_again(scene, text, length, &options, updated);
    if (status == KRS_OK && automatic && !krs_structure_is_affordable(*updated)) {
        krs_scene_free(*updated);
        options.specialize = KRS_SPECIALIZE_AUTO;
        options.diagnostic = NULL; /* all has been said */
        status             = compile_again(scene, text, length, &options, updated);
    }
    if (status == KRS_OK) { /* those of later edits */
        (*updated)->options.specialize = scene->options.specialize;
        (*updated)->options.diagnostic = scene->options.diagnostic;
    }
    return status;
}

static KrsStatus update(const KrsScene *scene, const char *text, size_t length, KrsScene **updated,
                        KrsChanges *changes)
{
    KrsChanges found  = {0};
    KrsStatus  status = compile_edited(scene, text, length, updated);
    if (status == KRS_OK)
        status = scene_changes(scene, *updated, &found);
    if (status == KRS_OK && found.kind != KRS_CHANGE_STRUCTURE)
        (*updated)->program.shaders = scene->program.shaders;
    if (status != KRS_OK) {
        krs_scene_free(*updated);
        *updated = NULL;
    }
    if (changes)
        *changes = found;
    return status;
}

KrsStatus krs_scene_update(const KrsScene *scene, const char *text, size_t length,
                           KrsScene **updated, KrsChanges *changes)
{
    if (!text && length > 0) {
        *updated = NULL;
        return KRS_BAD_ARGUMENT;
    }
    return update(scene, text ? text : "", length, updated, changes);
}

KrsStatus krs_scene_reload(const KrsScene *scene, KrsScene **updated, KrsChanges *changes)
{
    return update(scene, NULL, 0, updated, changes);
}
