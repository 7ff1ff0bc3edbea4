/*
 * file_faults.c: system calls that put bytes on the disk and fail at will, and an empty folder for
 * each test of a group.
 */
#include "tests/unit/file_faults.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/syscall.h>
#include <unistd.h>

Faults faults;

static bool fault(Call call)
{
    if (!faults.armed)
        return false;
    faults.seen[call]++;
    if (call != faults.call || faults.seen[call] != faults.countdown)
        return false;
    errno = faults.reason;
    return true;
}

ssize_t pwrite(int fd, const void *bytes, size_t length, off_t offset)
{
    if (fault(CALL_PWRITE))
        return -1;
    if (faults.armed && faults.short_writes && length > 200)
        length = 200;
    return syscall(SYS_pwrite64, fd, bytes, length, offset);
}

int fsync(int fd) { return fault(CALL_FSYNC) ? -1 : (int)syscall(SYS_fsync, fd); }

int rename(const char *from, const char *to)
{
    return fault(CALL_RENAME) ? -1 : (int)syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0u);
}

/* ---- a folder for each test ---- */

static char folder[] = "/tmp/krs-writer-XXXXXX";

int enter_faulty_folder(void **state)
{
    (void)state;
    memset(&faults, 0, sizeof faults);
    memcpy(folder + sizeof folder - 7, "XXXXXX", 6);
    return mkdtemp(folder) && chdir(folder) == 0 ? 0 : -1;
}

int leave_faulty_folder(void **state)
{
    (void)state;
    faults.armed = false;
    DIR *listing = opendir(".");
    for (struct dirent *entry; (entry = readdir(listing));)
        unlink(entry->d_name);
    closedir(listing);
    return chdir("/") == 0 && rmdir(folder) == 0 ? 0 : -1;
}

int count_files(void)
{
    int  count   = 0;
    DIR *listing = opendir(".");
    for (struct dirent *entry; (entry = readdir(listing));)
        count += entry->d_name[0] != '.' || strlen(entry->d_name) > 2;
    closedir(listing);
    return count;
}

void put(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

void assert_holds(const char *path, const char *text)
{
    char  found[64] = "";
    FILE *file      = fopen(path, "r");
    assert_non_null(file);
    size_t length = fread(found, 1, sizeof found - 1, file);
    fclose(file);
    found[length] = '\0';
    assert_string_equal(found, text);
}
