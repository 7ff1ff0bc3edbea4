/*
 * imported.c: files of other programs, imported and compiled in memory, for tests.
 */
#include "tests/oracle/imported.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "import/file.h"

static jmp_buf exhausted;
static Memory  memory = {.exhausted = &exhausted};
static Arena   arena  = {.memory = &memory};

static Imported imported_by(const char *path, const char *text, bool keep_going)
{
    arena_free(&arena);
    assert_int_equal(setjmp(exhausted), 0);
    Import   import = {.path       = path,
                       .name       = path,
                       .bytes      = arena_copy_text(&arena, text, strlen(text)),
                       .length     = strlen(text),
                       .arena      = &arena,
                       .keep_going = keep_going};
    Imported result = {.status = import_file(&import)};
    result.scene    = import.scene.length > 0 ? import.scene.bytes : "";
    result.refusal  = import.refusal.length > 0 ? import.refusal.bytes : "";
    return result;
}

Imported imported(const char *path, const char *text) { return imported_by(path, text, false); }

Imported imported_as_far_as_possible(const char *path, const char *text)
{
    return imported_by(path, text, true);
}

static void show_error(void *user, const KrsDiagnostic *diagnostic)
{
    (void)user;
    if (diagnostic->error)
        print_message("%s\n", diagnostic->text);
}

/* By the compiler itself, not by what the import says. */
static KrsScene *compiled(const char *path, const char *text, const Imported *result)
{
    KrsOptions options = {.diagnostic = show_error};
    KrsScene  *scene   = NULL;
    if (result->status != KRS_OK ||
        krs_compile_text(result->scene, strlen(result->scene), path, &options, &scene) != KRS_OK)
        fail_msg("%s\n%s\nfrom\n%s", result->refusal, result->scene, text);
    return scene;
}

void imported_distances(const char *path, const char *text, double (*points)[3], size_t count,
                        double *distances)
{
    Imported  result = imported(path, text);
    KrsScene *scene  = compiled(path, text, &result);
    KrsState *state;
    assert_int_equal(krs_state_new(scene, &state), KRS_OK);
    assert_int_equal(krs_distance(state, (const double(*)[3])points, count, distances), KRS_OK);
    krs_state_free(state);
    krs_scene_free(scene);
}

void imported_hits(const char *path, const char   *text, double (*origins)[3],
                   double (*directions)[3], size_t count, double farthest, KrsHit *hits)
{
    Imported  result = imported(path, text);
    KrsScene *scene  = compiled(path, text, &result);
    KrsState *state;
    assert_int_equal(krs_state_new(scene, &state), KRS_OK);
    assert_int_equal(krs_raycast(state, (const double(*)[3])origins, (const double(*)[3])directions,
                                 count, farthest, 1e-9, hits),
                     KRS_OK);
    krs_state_free(state);
    krs_scene_free(scene);
}

void upright_point(const double q[3], double p[3])
{
    p[0] = q[0];
    p[1] = q[2];
    p[2] = -q[1];
}

void assert_refused(const char *path, const char *text, const char *words)
{
    Imported result = imported(path, text);
    if (result.status != KRS_BAD_SCENE || !strstr(result.refusal, words))
        fail_msg("not refused with `%s`: %s\n%s\nfrom\n%s", words, result.refusal, result.scene,
                 text);
}

static bool has_line(const char *path, const char *text, const char *refusal)
{
    long   lines  = 1;
    size_t length = strlen(path);
    for (const char *at = text; *at != '\0'; at++)
        lines += *at == '\n';
    if (strncmp(refusal, path, length) != 0 || refusal[length] != ':')
        return false;
    char *end;
    long  line = strtol(refusal + length + 1, &end, 10);
    return line >= 1 && line <= lines && strncmp(end, ": ", 2) == 0 && end[2] != '\0';
}

bool assert_scene_or_line(const char *path, const char *text)
{
    Imported result = imported(path, text);
    if (result.status == KRS_OK) {
        krs_scene_free(compiled(path, text, &result));
        return true;
    }
    if (result.status != KRS_BAD_SCENE || !has_line(path, text, result.refusal))
        fail_msg("status %d, `%s`, of\n%s\nfrom\n%s", result.status, result.refusal, result.scene,
                 text);
    return false;
}

void assert_damage_is_harmless(Random *random, const char *path, const char *text, int trials)
{
    size_t length  = strlen(text);
    char  *damaged = malloc(length + 1);
    assert_non_null(damaged);
    for (int i = 0; i < trials; i++) {
        memcpy(damaged, text, length + 1);
        size_t at   = (size_t)random_below(random, (int)length);
        size_t from = (size_t)random_below(random, (int)length);
        switch (random_below(random, 4)) {
        case 0: damaged[at] = '\0'; break;
        case 1: damaged[at] = (char)(1 + random_below(random, 255)); break;
        case 2: memmove(damaged + at, damaged + at + 1, length - at); break;
        default: damaged[at] = text[from]; break;
        }
        assert_scene_or_line(path, damaged);
    }
    free(damaged);
}
