/*
 * reading.h: a scene that is read by the front end, and what is said of it.
 */
#ifndef UNIT_READING_H
#define UNIT_READING_H

#include <setjmp.h>

#include "compiler/front/names.h"
#include "compiler/front/parse.h"

typedef struct Reading {
    jmp_buf  exhausted;
    Memory   memory;
    Arena    arena;
    Sources  sources;
    Names    names;
    Diags    diags;
    Tokens   tokens;
    Syntax  *file;
    NameUses uses; /* of check_all_names */
} Reading;

Reading *reading_new(void);
void     reading_free(Reading *r);
Reading *read_bytes(const char *text, size_t length);
Reading *read_text(const char *text);
void     check_all_names(Reading *r);
/* "E0101@3:7 E0103@4:1" */
const char *codes(Reading *r);
void        expect_codes(const char *scene, const char *wanted);
void        expect_name_codes(const char *scene, const char *wanted);

/* As text. */
void expect_number(Reading *r, double number, const char *wanted);

#endif
