/*
 * saved_texts.c: what a document makes of files while an editor saves them.
 */
#include <fcntl.h>
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

#include "live/text/document.h"
#include "live/text/watcher.h"

enum { TRIES = 20 };

typedef struct Folder {
    char path[40], scene[48], used[48];
} Folder;

static Folder folder_make(void)
{
    Folder folder = {.path = "/tmp/krs-texts-XXXXXX"};
    assert_non_null(mkdtemp(folder.path));
    snprintf(folder.scene, sizeof folder.scene, "%s/a.krs", folder.path);
    snprintf(folder.used, sizeof folder.used, "%s/b.krs", folder.path);
    return folder;
}

static void folder_remove(const Folder *folder)
{
    remove(folder->scene);
    remove(folder->used);
    assert_int_equal(rmdir(folder->path), 0);
}

static void write_file(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

static size_t components(Document *document)
{
    Version     *version = document_version(document);
    const size_t count   = krs_component_count(version_scene(version));
    version_release(version);
    return count;
}

typedef struct Saving {
    Folder folder;
    bool   wrong; /* the scene was saved with a mistake; the next file that is opened mends it */
    int    told;
} Saving;

static void mend(void *user, const char *path)
{
    Saving *saving = user;
    if (!saving->wrong || strcmp(path, saving->folder.used) != 0)
        return;
    saving->wrong = false;
    write_file(saving->folder.scene, "use \"b.krs\"; show sphere(size);");
}

static void count(void *user, const KrsDiagnostic *diagnostic)
{
    Saving *saving = user;
    assert_non_null(diagnostic->json);
    saving->told++;
}

/* A text that is saved again while it is read is not blamed for its mistakes. */
static void mistakes_of_half_saved_texts_are_not_told(void **state)
{
    (void)state;
    Saving           saving = {.folder = folder_make(), .wrong = true};
    const KrsOptions with   = {
          .diagnostic = count, .user = &saving, .opened = mend, .opened_user = &saving};
    write_file(saving.folder.used, "let size = 1;");
    write_file(saving.folder.scene, "use \"b.krs\"; show spere(size);");
    Document *document = document_new(saving.folder.scene, &with);
    assert_int_equal(document_read(document), KRS_OK);
    assert_false(saving.wrong);
    assert_int_equal(saving.told, 0);
    write_file(saving.folder.scene, "show spere(1);");
    assert_int_equal(document_read(document), KRS_BAD_SCENE);
    assert_int_equal(saving.told, 1);
    document_free(document);
    folder_remove(&saving.folder);
}

static double now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

/* A file that is written counts at once. */
static void saved_files_count_at_once(void **state)
{
    (void)state;
    const Folder     folder = folder_make();
    const KrsOptions with   = {0};
    double           least  = 1;
    write_file(folder.scene, "show sphere(1);");
    Document *document = document_new(folder.scene, &with);
    assert_int_equal(document_read(document), KRS_OK);
    for (int i = 0; i < TRIES; i++) { /* a busy machine is slow in some of them */
        write_file(folder.scene, i % 2 ? "show sphere(2);" : "show sphere(3);");
        const double begun = now();
        assert_true(document_wait(document, 10));
        assert_int_equal(document_read(document), KRS_OK);
        const double seconds = now() - begun;
        least                = seconds < least ? seconds : least;
        assert_false(document_changed(document));
    }
    assert_true(least < SETTLED_SECONDS);
    document_free(document);
    folder_remove(&folder);
}

static void *finish(void *user)
{
    const int file = *(const int *)user;
    usleep(5000);
    assert_true(write(file, "show sphere(2);", 15) == 15);
    close(file);
    return NULL;
}

/* A file that was made is read when it is complete. */
static void files_are_read_when_they_are_closed(void **state)
{
    (void)state;
    const Folder     folder = folder_make();
    const KrsOptions with   = {0};
    int              whole  = 0;
    write_file(folder.scene, "show sphere(1);");
    Document *document = document_new(folder.scene, &with);
    assert_int_equal(document_read(document), KRS_OK);
    for (int i = 0; i < TRIES; i++) { /* a busy machine writes the rest too late in some of them */
        pthread_t thread;
        remove(folder.scene);
        int file = open(folder.scene, O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
        assert_true(file >= 0 && write(file, "show sphere(1);", 15) == 15);
        assert_int_equal(pthread_create(&thread, NULL, finish, &file), 0);
        assert_true(document_wait(document, 10));
        assert_int_equal(document_read(document), KRS_OK);
        whole += components(document) == 2;
        pthread_join(thread, NULL);
    }
    assert_true(whole > 0);
    document_free(document);
    folder_remove(&folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mistakes_of_half_saved_texts_are_not_told),
        cmocka_unit_test(saved_files_count_at_once),
        cmocka_unit_test(files_are_read_when_they_are_closed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
