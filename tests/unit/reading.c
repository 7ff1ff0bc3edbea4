/*
 * reading.c: a scene that is read by the front end, and what is said of it.
 */
#include "tests/unit/reading.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

Reading *reading_new(void)
{
    Reading *r       = calloc(1, sizeof *r);
    r->memory        = (Memory){.exhausted = &r->exhausted};
    r->arena         = (Arena){.memory = &r->memory};
    r->sources.arena = r->names.arena = r->diags.arena = &r->arena;
    r->diags.sources                                   = &r->sources;
    return r;
}

void reading_free(Reading *r)
{
    arena_free(&r->arena);
    assert_int_equal(r->memory.used, 0);
    free(r);
}

Reading *read_bytes(const char *text, size_t length)
{
    Reading *r = reading_new();
    if (setjmp(r->exhausted))
        fail_msg("out of memory");
    uint32_t source = source_add(&r->sources, "scene.krs", text, length, false);
    r->tokens       = lex(source, &r->sources, &r->names, &r->diags, &r->arena);
    r->file         = parse(&r->tokens, &r->diags, &r->arena);
    return r;
}

Reading *read_text(const char *text) { return read_bytes(text, strlen(text)); }

void check_all_names(Reading *r)
{
    static const KnownName known[] = {{"x", NULL},     {"y", NULL},      {"z", NULL},
                                      {"p", NULL},     {"sphere", NULL}, {"box", NULL},
                                      {"torus", NULL}, {"pi", NULL}};
    NameScope              scope   = {.known = known, .known_count = sizeof known / sizeof *known};
    names_check(r->file, &scope, &r->diags, &r->arena, &r->uses, &r->arena);
    diags_sort(&r->diags);
}

const char *codes(Reading *r)
{
    Text text = {.arena = &r->arena};
    text_add(&text, "");
    diags_sort(&r->diags);
    for (size_t i = 0; i < r->diags.count; i++) {
        const Diag *diag = r->diags.items[i];
        Position    at   = source_position(&r->sources.items[diag->span.source], diag->span.start);
        text_format(&text, "%s%s@%u:%u", i ? " " : "", diag_info[diag->code].code, at.line,
                    at.column);
    }
    return text.bytes;
}

void expect_codes(const char *scene, const char *wanted)
{
    Reading *r = read_text(scene);
    assert_string_equal(codes(r), wanted);
    reading_free(r);
}

void expect_name_codes(const char *scene, const char *wanted)
{
    Reading *r = read_text(scene);
    check_all_names(r);
    assert_string_equal(codes(r), wanted);
    reading_free(r);
}

void expect_number(Reading *r, double number, const char *wanted)
{
    Text text = {.arena = &r->arena};
    text_number(&text, number);
    assert_string_equal(text.bytes, wanted);
}
