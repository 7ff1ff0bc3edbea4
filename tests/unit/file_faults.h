/*
 * file_faults.h: system calls that put bytes on the disk and fail at will, and an empty folder for
 * each test of a group.
 *
 * The calls are defined in front of those of the C library.
 */
#ifndef UNIT_FILE_FAULTS_H
#define UNIT_FILE_FAULTS_H

#include <stdbool.h>

typedef enum Call { CALL_PWRITE, CALL_FSYNC, CALL_RENAME, CALL_COUNT } Call;

typedef struct Faults {
    bool armed;
    Call call;
    int  countdown, reason; /* the countdown-th call fails; 0: none does */
    int  seen[CALL_COUNT];
    bool short_writes; /* at most 200 bytes are taken at once */
} Faults;

extern Faults faults;

/* For cmocka: the folder, which is the current one; no call fails. */
int  enter_faulty_folder(void **state);
int  leave_faulty_folder(void **state);
int  count_files(void);
void put(const char *path, const char *text);
void assert_holds(const char *path, const char *text);

#define IN_FOLDER(test) \
    cmocka_unit_test_setup_teardown(test, enter_faulty_folder, leave_faulty_folder)

#endif
