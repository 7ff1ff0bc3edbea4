/*
 * diagnostics.c: how diagnostics are drawn as text, and written as JSON.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/unit/reading.h"

static void expect_picture(Reading *r, const char *wanted)
{
    Text text = {.arena = &r->arena};
    diags_print_text(&r->diags, false, &text);
    assert_string_equal(text.bytes, wanted);
    reading_free(r);
}

static Diag *add(Reading *r, DiagCode code, uint32_t source, uint32_t start, uint32_t end)
{
    return diag_add(&r->diags, code, (Span){source, start, end}, "%s", "a message");
}

static void a_diagnostic_is_drawn(void **state)
{
    (void)state;
    static const char scene[] = "\n\n\n\n\n\n\n\n\n\n\n\n\n        reflect sphere(2);\n";
    Reading          *r       = read_text("");
    uint32_t          file = source_add(&r->sources, "grove.krs", scene, sizeof scene - 1, false);
    Diag             *diag = diag_add(&r->diags, DIAG_NEEDS_PLANE, (Span){file, 29, 38},
                                      "'reflect' needs a plane, found a shape");
    diag->label            = "this is a shape";
    diag->help             = "for an inversion in a sphere write "
                             "'mobius invert(center: [0,0,0], radius: 2);'";
    expect_picture(r, "error[E0312]: 'reflect' needs a plane, found a shape\n"
                      "  --> grove.krs:14:17\n"
                      "   |\n"
                      "14 |         reflect sphere(2);\n"
                      "   |                 ^^^^^^^^^ this is a shape\n"
                      "   = help: for an inversion in a sphere write "
                      "'mobius invert(center: [0,0,0], radius: 2);'\n"
                      "\n"
                      "1 error\n");
}

static void several_places_are_drawn(void **state)
{
    (void)state;
    static const char one[] = "let a = 1;\nlet b = 2;\n\nlet a = b;\n", two[] = "def c() = 1;";
    Reading          *r    = read_text("");
    uint32_t          file = source_add(&r->sources, "one.krs", one, sizeof one - 1, false);
    uint32_t          used = source_add(&r->sources, "two.krs", two, sizeof two - 1, false);
    Diag             *diag = add(r, DIAG_DUPLICATE_NAME, file, 27, 28);
    diag->label            = "again";
    diag->replacement      = "c";
    diag_secondary(&r->diags, diag, (Span){file, 4, 5}, "first");
    diag_secondary(&r->diags, diag, (Span){file, 31, 32}, "this, too");
    diag_secondary(&r->diags, diag, (Span){used, 0, 12}, "elsewhere");
    diag_note(&r->diags, diag, "a note\nof two lines");
    diag              = add(r, DIAG_NO_EFFECT, used, 4, 5);
    diag->help        = "a name that is similar exists";
    diag->replacement = "d";
    expect_picture(r, "error[E0202]: a message\n"
                      " --> one.krs:4:5\n"
                      "  |\n"
                      "1 | let a = 1;\n"
                      "  |     - first\n"
                      "...\n"
                      "4 | let a = b;\n"
                      "  |     ^ again\n"
                      "  |         - this, too\n"
                      " ::: two.krs:1:1\n"
                      "  |\n"
                      "1 | def c() = 1;\n"
                      "  | ------------ elsewhere\n"
                      "  = note: a note\n"
                      "          of two lines\n"
                      "  = help: write `c`\n"
                      "\n"
                      "warning[W0301]: a message\n"
                      " --> two.krs:1:5\n"
                      "  |\n"
                      "1 | def c() = 1;\n"
                      "  |     ^\n"
                      "  = help: a name that is similar exists: `d`\n"
                      "\n"
                      "1 error, 1 warning\n");
}

static void odd_text_is_drawn(void **state)
{
    (void)state;
    /* a tab, a wide and a narrow character, a control byte, a byte that is no UTF-8 */
    static const char scene[] = "\t\xE6\x9C\xA8\xC3\xA9\x1B\xFF here\r\nthere";
    Reading          *r       = read_text("");
    source_add(&r->sources, "odd\x1B.krs", scene, sizeof scene - 1, false);
    add(r, DIAG_STRAY_BYTES, 2, 9, 20)->label = "to the end of the line";
    expect_picture(r, "error[E0102]: a message\n"
                      " --> odd\xE2\x90\x9B.krs:1:7\n"
                      "  |\n"
                      "1 |     \xE6\x9C\xA8\xC3\xA9\xE2\x90\x9B\xEF\xBF\xBD here\n"
                      "  |           ^^^^ to the end of the line\n"
                      "\n"
                      "1 error\n");
}

static void a_byte_order_mark_is_no_character(void **state)
{
    (void)state;
    static const char scene[] = "\xEF\xBB\xBFshow a;";
    Reading          *r       = read_text("");
    uint32_t          file    = source_add(&r->sources, "bom.krs", scene, sizeof scene - 1, false);
    add(r, DIAG_UNKNOWN_NAME, file, 8, 9);
    expect_picture(r, "error[E0201]: a message\n"
                      " --> bom.krs:1:6\n"
                      "  |\n"
                      "1 | show a;\n"
                      "  |      ^\n"
                      "\n"
                      "1 error\n");
    r    = read_text("");
    file = source_add(&r->sources, "bom.krs", scene, sizeof scene - 1, false);
    add(r, DIAG_UNKNOWN_NAME, file, 0, 0); /* of the whole file */
    expect_picture(r, "error[E0201]: a message\n"
                      " --> bom.krs:1:1\n"
                      "  |\n"
                      "1 | show a;\n"
                      "  | ^\n"
                      "\n"
                      "1 error\n");
}

static void long_lines_are_cut(void **state)
{
    (void)state;
    char scene[1001];
    for (int i = 0; i < 1000; i++)
        scene[i] = (char)('0' + i % 10);
    scene[1000]   = '\0';
    Reading *r    = read_text("");
    uint32_t file = source_add(&r->sources, "long.krs", scene, 1000, false);
    Diag    *diag = add(r, DIAG_STRAY_BYTES, file, 500, 503);
    diag_secondary(&r->diags, diag, (Span){file, 0, 2}, "far away");
    expect_picture(r, "error[E0102]: a message\n"
                      " --> long.krs:1:501\n"
                      "  |\n"
                      "1 | ...01234567890123456789012345678901234567890123456789"
                      "01234567890123456789012345678901234567890123456789...\n"
                      "  |                                            ^^^\n"
                      "1 | 01234567890123456789012345678901234567890123456789"
                      "01234567890123456789012345678901234567890123456789...\n"
                      "  | -- far away\n"
                      "\n"
                      "1 error\n");
}

static void a_diagnostic_without_a_place_is_drawn(void **state)
{
    (void)state;
    Reading *r = read_text("");
    add(r, DIAG_LIMIT, 0, 0, 0);
    add(r, DIAG_LIMIT, 0, 0, 0);
    expect_picture(r, "error[E0503]: a message\n\nerror[E0503]: a message\n\n2 errors\n");
}

static void colours_are_terminal_codes(void **state)
{
    (void)state;
    Reading *r    = read_text("let a = ;");
    Text     text = {.arena = &r->arena};
    diag_print_one(&r->diags, r->diags.items[0], true, &text);
    assert_non_null(strstr(text.bytes, "\033[1;31merror[E0101]\033[0m"));
    assert_non_null(strstr(text.bytes, "\033[1;31m^\033[0m\n"));
    reading_free(r);
}

static void json_has_places_of_the_protocol(void **state)
{
    (void)state;
    static const char scene[] = "a\n\xF0\x9F\x98\x80 b c";
    Reading          *r       = read_text("");
    uint32_t          file    = source_add(&r->sources, "j.krs", scene, sizeof scene - 1, false);
    Diag             *diag    = add(r, DIAG_UNKNOWN_NAME, file, 7, 8);
    diag->replacement         = "d";
    diag_secondary(&r->diags, diag, (Span){file, 0, 1}, "a \"place\"");
    Text text = {.arena = &r->arena};
    diags_print_json(&r->diags, &text);
    assert_string_equal(
        text.bytes,
        "{\"uri\":\"j.krs\",\"range\":{\"start\":{\"line\":1,\"character\":3},"
        "\"end\":{\"line\":1,\"character\":4}},\"severity\":1,\"code\":\"E0201\","
        "\"source\":\"krs\",\"message\":\"a message\","
        "\"relatedInformation\":[{\"location\":{\"uri\":\"j.krs\","
        "\"range\":{\"start\":{\"line\":0,\"character\":0},\"end\":{\"line\":0,\"character\":1}}},"
        "\"message\":\"a \\\"place\\\"\"}],\"data\":{\"replacement\":\"d\",\"notes\":[]}}\n");
    reading_free(r);
}

static void repeats_are_dropped(void **state)
{
    (void)state;
    Reading *r = read_text("let a = 1;");
    add(r, DIAG_TYPE_MISMATCH, 1, 4, 5);
    add(r, DIAG_TYPE_MISMATCH, 1, 4, 5);
    add(r, DIAG_TYPE_MISMATCH, 1, 2, 5);
    add(r, DIAG_NO_EFFECT, 1, 4, 5);
    assert_int_equal(r->diags.errors, 2);
    assert_string_equal(codes(r), "E0301@1:3 E0301@1:5 W0301@1:5");
    reading_free(r);
}

static void codes_are_found(void **state)
{
    (void)state;
    assert_ptr_equal(diag_find("E0312"), &diag_info[DIAG_NEEDS_PLANE]);
    assert_null(diag_find("E9999"));
    for (size_t i = 0; i < DIAG_CODE_COUNT; i++) {
        static const char letters[] = {[DIAG_ERROR] = 'E', [DIAG_WARNING] = 'W', [DIAG_NOTE] = 'N'};
        assert_int_equal(diag_info[i].code[0], letters[diag_info[i].severity]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_diagnostic_is_drawn),
        cmocka_unit_test(several_places_are_drawn),
        cmocka_unit_test(odd_text_is_drawn),
        cmocka_unit_test(a_byte_order_mark_is_no_character),
        cmocka_unit_test(long_lines_are_cut),
        cmocka_unit_test(a_diagnostic_without_a_place_is_drawn),
        cmocka_unit_test(colours_are_terminal_codes),
        cmocka_unit_test(json_has_places_of_the_protocol),
        cmocka_unit_test(repeats_are_dropped),
        cmocka_unit_test(codes_are_found),
    };
    return cmocka_run_group_tests_name("diagnostics", tests, NULL, NULL);
}
