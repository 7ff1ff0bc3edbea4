/*
 * writer.c: files are written whole or not at all, with the permissions and in the place that they
 * had, and nothing else is left in the folder.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "runtime/writer/atomic.h"
#include "tests/unit/file_faults.h"

/* ---- targets ---- */

static void assert_refused(const char *path, KrsStatus status)
{
    OutputError error;
    assert_int_equal(output_text(path, "x", 1, NULL, &error), status);
    assert_non_null(strstr(error.message, path));
    assert_null(strchr(error.message, '\n'));
}

static void targets_that_cannot_be(void **state)
{
    (void)state;
    assert_refused("missing/a.exr", KRS_CANNOT_CREATE);
    assert_refused(".", KRS_CANNOT_CREATE);
    assert_refused("", KRS_CANNOT_CREATE);
    assert_refused("/dev/full", KRS_IO_ERROR);
    assert_int_equal(count_files(), 0);
}

static void links_are_followed(void **state)
{
    (void)state;
    OutputError error;
    struct stat info;
    put("target", "before");
    assert_int_equal(symlink("target", "link"), 0);
    assert_int_equal(output_text("link", "after", 5, NULL, &error), KRS_OK);
    assert_holds("target", "after");
    assert_int_equal(lstat("link", &info), 0);
    assert_true(S_ISLNK(info.st_mode));
    assert_int_equal(count_files(), 2);
}

/* Once renamed, the new file is whole, only its name may not survive a power failure. */
static void a_folder_that_cannot_be_flushed_is_a_warning(void **state)
{
    (void)state;
    OutputError error;
    put("old", "before");
    faults.armed     = true;
    faults.call      = CALL_FSYNC;
    faults.countdown = 2;
    faults.reason    = EIO;
    assert_int_equal(output_text("old", "after", 5, NULL, &error), KRS_OK);
    assert_non_null(strstr(error.warning, "`old` is written, but"));
    assert_holds("old", "after");
    faults.countdown = 0;
    assert_int_equal(output_text("old", "again", 5, NULL, &error), KRS_OK);
    assert_string_equal(error.warning, "");
}

static void a_fleeting_file_waits_for_no_disk(void **state)
{
    (void)state;
    OutputError error;
    faults.armed     = true;
    OutputFile *file = output_open("new", NULL, &error);
    assert_non_null(file);
    output_append(file, "after", 5);
    output_is_fleeting(file);
    assert_int_equal(output_commit(file), KRS_OK);
    assert_int_equal(faults.seen[CALL_FSYNC], 0);
    assert_int_equal(faults.seen[CALL_RENAME], 1);
    assert_holds("new", "after");
}

static mode_t mode_of(const char *path)
{
    struct stat info;
    assert_int_equal(stat(path, &info), 0);
    return info.st_mode & 07777;
}

/* A file that is replaced keeps them; a new one has them as the user's mask has it. */
static void permissions_are_kept(void **state)
{
    (void)state;
    static const mode_t masks[] = {022, 027, 077, 002}, modes[] = {0600, 0640, 0664, 0777};
    OutputError         error;
    mode_t              before = umask(022);
    for (int i = 0; i < 4; i++) {
        umask(masks[i]);
        unlink("new");
        assert_int_equal(output_text("new", "x", 1, NULL, &error), KRS_OK);
        assert_int_equal(mode_of("new"), 0666 & ~masks[i]);
        assert_int_equal(chmod("new", modes[i]), 0);
        assert_int_equal(output_text("new", "y", 1, NULL, &error), KRS_OK);
        assert_int_equal(mode_of("new"), modes[i]);
        assert_holds("new", "y");
    }
    umask(before);
    assert_int_equal(count_files(), 1);
}

/* Whoever runs this as the administrator may give files away. */
static void the_owner_is_kept(void **state)
{
    (void)state;
    OutputError error;
    struct stat info;
    put("old", "before");
    if (chown("old", 12345, 23456) != 0)
        skip();
    assert_int_equal(chmod("old", 0660), 0);
    assert_int_equal(output_text("old", "after", 5, NULL, &error), KRS_OK);
    assert_int_equal(stat("old", &info), 0);
    assert_int_equal(info.st_uid, 12345);
    assert_int_equal(info.st_gid, 23456);
    assert_int_equal(info.st_mode & 0777, 0660);
    assert_holds("old", "after");
}

/* ---- temporary files ---- */

static void temporaries_are_private(void **state)
{
    (void)state;
    OutputError error;
    mode_t      before = umask(0);
    put("old", "before");
    assert_int_equal(chmod("old", 0666), 0);
    for (int i = 0; i < 2; i++) {
        OutputFile *file = output_open(i == 0 ? "old" : "new", NULL, &error);
        assert_non_null(file);
        assert_int_equal(mode_of(output_temporary(file)), 0600);
        output_abandon(file);
    }
    umask(before);
}

/* What a killed writer leaves is removed by the next who asks for that folder; what has a writer,
   in this process or another, or belongs to others, stays. */
static void abandoned_temporaries_are_removed(void **state)
{
    (void)state;
    OutputError error;
    int         to_child[2], from_child[2];
    char        byte;
    assert_int_equal(pipe(to_child), 0);
    assert_int_equal(pipe(from_child), 0);
    pid_t child = fork();
    if (child == 0) {
        OutputFile *file = output_open("theirs", NULL, &error);
        output_append(file, "half", 4);
        bool told = write(from_child[1], "", 1) == 1;
        close(to_child[1]);
        while (told && read(to_child[0], &byte, 1) > 0)
            ;
        _exit(0); /* neither committed nor abandoned */
    }
    assert_int_equal(read(from_child[0], &byte, 1), 1);
    OutputFile *mine = output_open("mine", NULL, &error);
    assert_non_null(mine);
    put(".krs-cache-1-2-0.tmp", "a cache's");
    put(".krs-7-0.tmp", "of one who is long gone");
    put("krs-7-0.tmp", "not ours");
    assert_int_equal(count_files(), 5);
    assert_int_equal(output_check("mine", &error), KRS_OK);
    assert_int_equal(count_files(), 4);
    assert_int_equal(access(".krs-7-0.tmp", F_OK), -1);

    close(to_child[1]); /* now the child goes */
    int ended;
    assert_int_equal(waitpid(child, &ended, 0), child);
    assert_int_equal(output_check("mine", &error), KRS_OK);
    assert_int_equal(count_files(), 3);
    output_append(mine, "whole", 5);
    assert_int_equal(output_commit(mine), KRS_OK);
    assert_holds("mine", "whole");
    assert_int_equal(access(".krs-cache-1-2-0.tmp", F_OK), 0);
    close(from_child[0]);
    close(from_child[1]);
    close(to_child[0]);
}

/* A link that leads to nothing stays a link, and what it leads to is made. */
static void dangling_links_are_followed(void **state)
{
    (void)state;
    OutputError error;
    struct stat info;
    assert_int_equal(symlink("second", "first"), 0);
    assert_int_equal(symlink("./target", "second"), 0);
    assert_int_equal(output_text("first", "after", 5, NULL, &error), KRS_OK);
    assert_holds("target", "after");
    assert_int_equal(lstat("first", &info), 0);
    assert_true(S_ISLNK(info.st_mode));
    assert_int_equal(lstat("second", &info), 0);
    assert_true(S_ISLNK(info.st_mode));
    assert_int_equal(lstat("target", &info), 0);
    assert_true(S_ISREG(info.st_mode));
    assert_int_equal(symlink("circle", "circle"), 0);
    assert_refused("circle", KRS_CANNOT_CREATE);
    assert_int_equal(symlink("missing/target", "nowhere"), 0);
    assert_refused("nowhere", KRS_CANNOT_CREATE);
}

static void paths_to_one_file_are_known(void **state)
{
    (void)state;
    static const struct {
        const char *a, *b;
        bool        same;
    } pairs[] = {{"a", "a", true},
                 {"a", "./a", true},
                 {"a", "b", false},
                 {"link", "a", true},
                 {"dangling", "new", true},
                 {"new", ".//new", true},
                 {"dangling", "a", false},
                 {"missing/a", "a", false},
                 {"missing/a", "missing/a", true},
                 {"../missing/x", "x", false}};
    put("a", "x");
    assert_int_equal(symlink("a", "link"), 0);
    assert_int_equal(symlink("new", "dangling"), 0);
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++)
        assert_int_equal(output_is_same(pairs[i].a, pairs[i].b), pairs[i].same);
}

static void abandoned_files_leave_nothing(void **state)
{
    (void)state;
    OutputError error;
    put("old", "before");
    OutputFile *file = output_open("old", NULL, &error);
    assert_non_null(file);
    assert_true(output_append(file, "after", 5));
    output_abandon(file);
    assert_holds("old", "before");
    assert_int_equal(count_files(), 1);
}

static void interrupts_stop_the_writing(void **state)
{
    (void)state;
    OutputError           error;
    volatile sig_atomic_t cancelled = 0;
    put("old", "before");
    OutputFile *file = output_open("old", &cancelled, &error);
    assert_non_null(file);
    assert_true(output_append(file, "after", 5));
    cancelled = 1;
    assert_int_equal(output_commit(file), KRS_INTERRUPTED);
    assert_holds("old", "before");
    assert_int_equal(count_files(), 1);
}

static void bytes_in_any_order(void **state)
{
    (void)state;
    OutputError error;
    OutputFile *file = output_open("a", NULL, &error);
    assert_non_null(file);
    assert_true(output_write(file, "world", 5, 6));
    assert_true(output_write(file, "hello ", 6, 0));
    assert_true(output_append(file, "!", 1));
    assert_int_equal(output_commit(file), KRS_OK);
    assert_holds("a", "hello world!");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        IN_FOLDER(targets_that_cannot_be),
        IN_FOLDER(links_are_followed),
        IN_FOLDER(dangling_links_are_followed),
        IN_FOLDER(paths_to_one_file_are_known),
        IN_FOLDER(a_folder_that_cannot_be_flushed_is_a_warning),
        IN_FOLDER(a_fleeting_file_waits_for_no_disk),
        IN_FOLDER(permissions_are_kept),
        IN_FOLDER(the_owner_is_kept),
        IN_FOLDER(temporaries_are_private),
        IN_FOLDER(abandoned_temporaries_are_removed),
        IN_FOLDER(abandoned_files_leave_nothing),
        IN_FOLDER(interrupts_stop_the_writing),
        IN_FOLDER(bytes_in_any_order),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
