/*
 * What a scene uses is read from within a folder, or supplied by the caller, and from nowhere else.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "compiler/base/disk.h"
#include "compiler/base/sandbox.h"
#include "krs/krs.h"

/* ---- a folder ---- */

static char folder[] = "/tmp/krs-loader-XXXXXX";
static int  root;

static void put(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

/* Beside the root, which has files, a folder and links in it, is a secret. */
static int make_folder(void **state)
{
    char absolute[128];
    (void)state;
    if (!mkdtemp(folder) || chdir(folder) != 0)
        return -1;
    snprintf(absolute, sizeof absolute, "%s/secret", folder);
    mkdir("root", 0700);
    mkdir("root/deep", 0700);
    mkdir("beyond", 0700);
    put("secret", "secret");
    put("beyond/secret", "secret");
    put("root/file", "file");
    put("root/deep/file", "deep file");
    bool linked = symlink("../secret", "root/out") == 0 &&
                  symlink(absolute, "root/absolute") == 0 &&
                  symlink("../beyond", "root/folder") == 0 &&
                  symlink("/proc/self/cwd", "root/magic") == 0 &&
                  symlink("../file", "root/deep/in") == 0;
    root = open("root", O_PATH | O_DIRECTORY | O_CLOEXEC);
    return linked && root >= 0 ? 0 : -1;
}

static int remove_folder(void **state)
{
    char command[64];
    (void)state;
    close(root);
    snprintf(command, sizeof command, "rm -rf %s", folder);
    return chdir("/") == 0 && system(command) == 0 ? 0 : -1;
}

typedef int Opener(int root, const char *path);

/* Returns the first character of what was opened; 0 and errno when nothing was. */
static char first_of(Opener *opener, const char *path)
{
    char first = 0;
    int  fd    = opener(root, path);
    if (fd < 0)
        return 0;
    assert_int_equal(read(fd, &first, 1), 1);
    close(fd);
    return first;
}

static Opener *const openers[] = {sandbox_open, sandbox_open_by_steps};

static void nothing_outside_is_opened(void **state)
{
    (void)state;
    static const char *const paths[] = {"../secret",
                                        "/etc/passwd",
                                        "deep/../../secret",
                                        "deep/../../root/file",
                                        "out",
                                        "absolute",
                                        "folder/secret",
                                        "magic/secret",
                                        "magic/root/file",
                                        "../missing",
                                        "..",
                                        "./../secret",
                                        "deep/../../../../../../../../etc/passwd",
                                        "deep//..//..//secret"};
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++)
        for (int k = 0; k < 2; k++) {
            assert_int_equal(first_of(openers[k], paths[i]), 0);
            assert_int_equal(errno, EXDEV);
        }
}

static void what_is_inside_is_opened(void **state)
{
    (void)state;
    static const struct {
        const char *path;
        char        first;
    } files[] = {{"file", 'f'},         {"./file", 'f'},     {"deep/file", 'd'},
                 {"deep/../file", 'f'}, {"deep//file", 'd'}, {"deep/./../deep/file", 'd'}};
    for (size_t i = 0; i < sizeof files / sizeof *files; i++)
        for (int k = 0; k < 2; k++)
            assert_int_equal(first_of(openers[k], files[i].path), files[i].first);
    assert_int_equal(first_of(sandbox_open, "deep/in"), 'f');
    assert_int_equal(first_of(sandbox_open_by_steps, "deep/in"), 0); /* follows no links at all */
    assert_int_equal(errno, EXDEV);
    for (int k = 0; k < 2; k++) {
        assert_int_equal(first_of(openers[k], "missing"), 0);
        assert_int_equal(errno, ENOENT);
        assert_int_equal(first_of(openers[k], "file/x"), 0);
        assert_int_equal(errno, ENOTDIR);
    }
}

/* ---- the library ---- */

typedef struct Asked {
    char   paths[8][64];
    size_t count;
    char   code[8]; /* of the first diagnostic */
} Asked;

static const char *supply(void *user, const char *path, size_t *length)
{
    Asked      *asked = user;
    const char *text  = strcmp(path, "scenes/size.krs") == 0
                            ? "let size = half * 2;\nuse \"a/b.krs\";"
                        : strcmp(path, "scenes/a/b.krs") == 0 ? "let half = 0.75;"
                                                              : NULL;
    snprintf(asked->paths[asked->count++ % 8], 64, "%s", path);
    *length = text ? strlen(text) : 0;
    return text;
}

static void note(void *user, const KrsDiagnostic *diagnostic)
{
    Asked *asked = user;
    if (asked->code[0] == '\0')
        snprintf(asked->code, sizeof asked->code, "%s", diagnostic->code);
}

static KrsStatus compile(const char *text, const char *name, KrsOptions options, KrsScene **scene)
{
    if (options.user)
        ((Asked *)options.user)->code[0] = '\0';
    return krs_compile_text(text, strlen(text), name, &options, scene);
}

/* A host program has the files of a scene somewhere of its own; none is looked for on the disk. */
static void a_caller_supplies_what_is_used(void **state)
{
    (void)state;
    Asked      asked   = {.count = 0};
    KrsOptions options = {.load = supply, .load_user = &asked, .diagnostic = note, .user = &asked};
    KrsScene  *scene;
    KrsComponent ball;
    assert_int_equal(
        compile("use \"size.krs\"; show sphere(size);", "scenes/main.krs", options, &scene),
        KRS_OK);
    assert_int_equal(krs_component(scene, 0, &ball), KRS_OK);
    assert_true(ball.high[0] == 1.5);
    krs_scene_free(scene);
    assert_int_equal(asked.count, 2);
    assert_string_equal(asked.paths[0], "scenes/size.krs");
    assert_string_equal(asked.paths[1], "scenes/a/b.krs");

    assert_int_equal(compile("use \"root/file\"; show sphere(1);", "main.krs", options, &scene),
                     KRS_BAD_SCENE);
    assert_string_equal(asked.code, "E0501");
    assert_int_equal(asked.count, 3);
    assert_int_equal(compile("use \"std/trees.krs\"; show sphere(1);", "main.krs", options, &scene),
                     KRS_OK);
    assert_int_equal(asked.count, 3); /* the library is its own */
    krs_scene_free(scene);
}

static void note_opened(void *user, const char *path)
{
    Asked *opened = user;
    snprintf(opened->paths[opened->count++ % 8], 64, "%s", path);
}

/* Who watches a scene has to know what it is read from, also what is missing. */
static void callers_are_told_of_files(void **state)
{
    (void)state;
    Asked      opened  = {.count = 0};
    KrsOptions options = {.opened = note_opened, .opened_user = &opened};
    KrsScene  *scene;
    put("main.krs", "use \"std/trees.krs\"; use \"root/size.krs\"; show sphere(size);");
    put("root/size.krs", "let size = read_csv(\"table.csv\")[0][0];");
    put("root/table.csv", "2\n");
    assert_int_equal(krs_compile_file("main.krs", &options, &scene), KRS_OK);
    krs_scene_free(scene);
    assert_int_equal(opened.count, 3);
    assert_string_equal(opened.paths[0], "main.krs");
    assert_string_equal(opened.paths[1], "root/size.krs");
    assert_string_equal(opened.paths[2], "root/table.csv");

    opened.count = 0;
    assert_int_equal(compile("use \"a/missing.krs\"; show sphere(1);", "main.krs", options, &scene),
                     KRS_BAD_SCENE);
    assert_int_equal(opened.count, 1);
    assert_string_equal(opened.paths[0], "a/missing.krs");
}

static void a_library_is_confined(void **state)
{
    (void)state;
    Asked      asked = {.count = 0};
    KrsScene  *scene;
    KrsOptions options = {.root = "root", .diagnostic = note, .user = &asked};
    put("root/size.krs", "let size = 1;");
    put("size.krs", "let size = 2;");
    static const char inner[] = "use \"size.krs\"; show sphere(size);";
    static const char outer[] = "use \"../size.krs\"; show sphere(size);";
    assert_int_equal(compile(inner, "root/main.krs", options, &scene), KRS_OK);
    krs_scene_free(scene);
    assert_int_equal(compile(outer, "root/deep/main.krs", options, &scene), KRS_OK);
    krs_scene_free(scene);
    assert_int_equal(compile(outer, "root/main.krs", options, &scene), KRS_BAD_SCENE);
    assert_string_equal(asked.code, "E0504");
    assert_int_equal(compile(inner, "main.krs", options, &scene), KRS_BAD_SCENE);
    assert_string_equal(asked.code, "E0504");
    put("outside.krs", "show sphere(1);");
    asked.code[0] = '\0';
    assert_int_equal(krs_compile_file("outside.krs", &options, &scene), KRS_BAD_SCENE);
    assert_string_equal(asked.code, "E0504");
    options.root = "nowhere";
    assert_int_equal(compile(inner, "root/main.krs", options, &scene), KRS_BAD_SCENE);
    options.root = NULL;
    assert_int_equal(compile(outer, "root/main.krs", options, &scene), KRS_OK);
    krs_scene_free(scene);
}

/* Returns how much is read of a file of that many bytes, of which the last is an `a`. */
static size_t length_read(off_t length)
{
    FILE *file = fopen("large", "w");
    assert_non_null(file);
    assert_int_equal(fseeko(file, length - 1, SEEK_SET), 0);
    fputc('a', file);
    assert_int_equal(fclose(file), 0);
    const Loaded read = disk_read("large");
    assert_non_null(read.text);
    if (read.length == (size_t)length)
        assert_int_equal(read.text[length - 1], 'a');
    free(read.owned);
    return read.length;
}

static void large_files_are_read_to_their_end(void **state)
{
    (void)state;
    assert_int_equal(length_read(MAX_FILE_BYTES / 2 + 12345), MAX_FILE_BYTES / 2 + 12345);
    assert_int_equal(length_read(MAX_FILE_BYTES), MAX_FILE_BYTES);
    assert_int_equal(length_read(MAX_FILE_BYTES + 12345), MAX_FILE_BYTES + 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_outside_is_opened),
        cmocka_unit_test(what_is_inside_is_opened),
        cmocka_unit_test(a_caller_supplies_what_is_used),
        cmocka_unit_test(callers_are_told_of_files),
        cmocka_unit_test(a_library_is_confined),
        cmocka_unit_test(large_files_are_read_to_their_end),
    };
    return cmocka_run_group_tests_name("loader", tests, make_folder, remove_folder);
}
