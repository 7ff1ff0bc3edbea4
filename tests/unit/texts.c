/*
 * texts.c: memory, texts, names that are kept once, and places in a text.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/support/random.h"
#include "tests/unit/reading.h"

/* ---- memory and text ---- */

static void arena_counts_and_limits(void **state)
{
    (void)state;
    jmp_buf         exhausted;
    Memory          memory = {.exhausted = &exhausted, .limit = 100000};
    Arena           arena  = {.memory = &memory};
    volatile size_t got    = 0;
    if (setjmp(exhausted) == 0) {
        for (;;) {
            unsigned char *bytes = arena_alloc(&arena, 100, 10);
            for (int i = 0; i < 1000; i++)
                assert_int_equal(bytes[i], 0);
            assert_int_equal((uintptr_t)bytes % _Alignof(max_align_t), 0);
            memset(bytes, 0xFF, 1000);
            got++;
        }
    }
    assert_in_range(got, 50, 100);
    assert_in_range(memory.used, 50000, 100000);
    arena_free(&arena);
    assert_int_equal(memory.used, 0);
}

/* Small and large objects after a mark go; those before it stay, and what follows is zero again. */
static void arena_goes_back_to_a_mark(void **state)
{
    (void)state;
    enum { SMALL = 100, LARGE = 3 * LARGEST_BLOCK_BYTES };
    static const char zeros[SMALL];
    Memory            memory = {0};
    Arena             arena  = {.memory = &memory};
    for (int before = 0; before < 400; before++) {
        ArenaMark outer = arena_mark(&arena);
        char     *kept  = memset(arena_alloc(&arena, SMALL, 1), 1, SMALL);
        ArenaMark mark  = arena_mark(&arena);
        size_t    used  = memory.used;
        for (int turn = 0; turn < 3; turn++) {
            for (int i = 0; i < before; i++) {
                char *object = arena_alloc(&arena, SMALL, 1);
                assert_memory_equal(object, zeros, SMALL);
                memset(object, 2, SMALL);
            }
            if (before % 7 == turn)
                memset(arena_alloc(&arena, LARGE, 1), 3, LARGE);
            arena_rewind(&arena, mark);
            assert_int_equal(memory.used, used);
        }
        for (int k = 0; k < SMALL; k++)
            assert_int_equal(kept[k], 1);
        if (before % 2)
            arena_rewind(&arena, outer);
    }
    arena_free(&arena);
    assert_int_equal(memory.used, 0);
}

/* Whatever was in it, it is zero again, and one small block stays at most. */
static void arena_is_cleared(void **state)
{
    (void)state;
    enum { SMALL = 100, LARGE = 3 * LARGEST_BLOCK_BYTES, MOST = 4096 };
    static const char zeros[SMALL];
    Memory            memory = {0};
    Arena             arena  = {.memory = &memory};
    for (int turn = 0; turn < 400; turn++) {
        for (int i = 0; i < turn % 97; i++) {
            char *object = arena_alloc(&arena, SMALL, 1);
            assert_memory_equal(object, zeros, SMALL);
            memset(object, 2, SMALL);
            if (turn % 7 == 0 && i == turn % 11)
                memset(arena_alloc(&arena, LARGE, 1), 3, LARGE);
        }
        arena_clear(&arena);
        assert_true(memory.used <= MOST);
    }
    arena_free(&arena);
    assert_int_equal(memory.used, 0);
}

static void arena_refuses_products_that_overflow(void **state)
{
    (void)state;
    jmp_buf      exhausted;
    Memory       memory = {.exhausted = &exhausted};
    Arena        arena  = {.memory = &memory};
    volatile int caught = 0;
    if (setjmp(exhausted) == 0)
        arena_alloc(&arena, SIZE_MAX / 2, 3);
    else
        caught++;
    if (setjmp(exhausted) == 0)
        arena_alloc(&arena, SIZE_MAX - 3, 1);
    else
        caught++;
    assert_int_equal(caught, 2);
    arena_free(&arena);
}

static void numbers_are_short_and_exact(void **state)
{
    (void)state;
    Reading *r = reading_new();
    expect_number(r, 0.1, "0.1");
    expect_number(r, 1e30, "1e+30");
    expect_number(r, -0.0, "-0");
    expect_number(r, 1.0 / 3, "0.3333333333333333");
    expect_number(r, 5e-324, "5e-324");
    expect_number(r, 0.1 + 0.2, "0.30000000000000004");
    expect_number(r, INFINITY, "inf");
    expect_number(r, -INFINITY, "-inf");
    expect_number(r, NAN, "nan");
    uint64_t bits = 1;
    for (int i = 0; i < 20000; i++) {
        bits = bits * 6364136223846793005u + 1442695040888963407u;
        double number;
        memcpy(&number, &bits, sizeof number);
        if (!isfinite(number))
            continue;
        Text text = {.arena = &r->arena};
        text_number(&text, number);
        assert_true(strtod(text.bytes, NULL) == number);
    }
    reading_free(r);
}

/* 1 + 2^-53 is halfway between two doubles, so digits behind it decide, however many zeros are between.
   strtod reads the same texts where points are decimal. */
static void decimals_of_many_digits_are_exact(void **state)
{
    static const char halfway[] = "100000000000000011102230246251565404236316680908203125";
    static const struct {
        const char *beginning;
        int exponent; /* puts the first digit before the point; 0: that of all but one digit */
    } forms[]                 = {{"", 0}, {"000", 0}, {"0.", 1}, {".00000", 6}};
    static const int counts[] = {54, 799, 800, 801, 802, 1500};
    (void)state;
    for (int form = 0; form < 4; form++)
        for (int i = 0; i < 6; i++)
            for (char last = '0'; last <= '5'; last++) {
                char text[2000], digits[1501];
                memset(digits, '0', sizeof digits);
                memcpy(digits, halfway, sizeof halfway - 1);
                digits[counts[i] - 1] = last;
                snprintf(text, sizeof text, "%s%.*se%d", forms[form].beginning, counts[i], digits,
                         forms[form].exponent > 0 ? forms[form].exponent : 1 - counts[i]);
                const double read = text_decimal(text, strlen(text)), wanted = strtod(text, NULL);
                if (read != wanted)
                    fail_msg("%s: %a, not %a", text, read, wanted);
            }
}

static void json_is_escaped(void **state)
{
    (void)state;
    Reading *r    = reading_new();
    Text     text = {.arena = &r->arena};
    text_json(&text, "a\"b\\c\n\t\x01\xC3\xA9\xFF\xED\xA0\x80");
    assert_string_equal(text.bytes,
                        "\"a\\\"b\\\\c\\n\\t\\u0001\xC3\xA9\\ufffd\\ufffd\\ufffd\\ufffd\"");
    reading_free(r);
}

static void names_are_kept_once(void **state)
{
    (void)state;
    Reading    *r      = reading_new();
    const char *sphere = name_intern(&r->names, "sphere", 6);
    char        name[20];
    for (int i = 0; i < 5000; i++) {
        int length = snprintf(name, sizeof name, "n%d", i);
        name_intern(&r->names, name, (size_t)length);
    }
    assert_ptr_equal(name_intern(&r->names, "spheres", 6), sphere);
    assert_ptr_not_equal(name_intern(&r->names, "spheres", 7), sphere);
    assert_int_equal(r->names.count, 5002);
    reading_free(r);
}

static void misspelt_names_are_recognised(void **state)
{
    (void)state;
    static const char *const names[] = {"torus", "sphere", "x", "box", "pi", "xy"};
    const size_t             count   = sizeof names / sizeof *names;
    assert_string_equal(nearest_name("tours", names, count), "torus"); /* a swap counts once */
    assert_string_equal(nearest_name("spheer", names, count), "sphere");
    assert_string_equal(nearest_name("shere", names, count), "sphere");
    assert_string_equal(nearest_name("pj", names, count), "pi");
    assert_null(nearest_name("q", names, count)); /* not all letters may change */
    assert_null(nearest_name("cylinder", names, count));
    assert_null(nearest_name("ab", names, count));
    assert_null(nearest_name("ti", names, count)); /* short words keep their first letter, */
    assert_string_equal(nearest_name("ip", names, count), "pi"); /* or swap it */
    assert_null(nearest_name("torus", names, 0));
}

/* ---- places ---- */

static void places_count_characters(void **state)
{
    (void)state;
    Reading      *r      = read_text("// \xC3\xA9\xF0\x9F\x98\x80x\r\nab\n\n");
    const Source *source = &r->sources.items[1];
    assert_int_equal(source->line_count, 4);
    Position position = source_position(source, 9);
    assert_int_equal(position.line, 1);
    assert_int_equal(position.column, 6);
    position = source_position(source, 13);
    assert_int_equal(position.line, 2);
    assert_int_equal(position.column, 2);
    position = source_position(source, source->length);
    assert_int_equal(position.line, 4);
    assert_int_equal(position.column, 1);
    reading_free(r);
}

/* By counting from the beginning. */
static Position position_by_walking(const Source *source, uint32_t offset)
{
    Position position = {1, 1};
    for (uint32_t i = 0; i < offset && i < source->length; i++) {
        bool begins = ((unsigned char)source->text[i + 1] & 0xC0) != 0x80;
        position    = source->text[i] == '\n' ? (Position){position.line + 1, 1}
                                              : (Position){position.line, position.column + begins};
    }
    return position;
}

/* In lines that are short and that are longer than what is counted at once. */
static void places_are_found_in_long_lines(void **state)
{
    (void)state;
    static const char *const pieces[] = {"a", "\xC3\xA9", "\xF0\x9F\x98\x80", " ", "let"};
    Random                   random   = {7};
    for (int lines = 1; lines <= 64; lines *= 4) {
        char   text[4 * SOURCE_BLOCK + 8];
        size_t length = 0;
        while (length < 4 * SOURCE_BLOCK)
            if (random_below(&random, 4 * SOURCE_BLOCK) < lines)
                text[length++] = '\n';
            else
                for (const char *c = pieces[random_below(&random, 5)]; *c; c++)
                    text[length++] = *c;
        text[length]         = '\0';
        Reading      *r      = read_bytes(text, length);
        const Source *source = &r->sources.items[1];
        for (uint32_t offset = 0; offset <= length; offset++) {
            if (((unsigned char)text[offset] & 0xC0) == 0x80)
                continue;
            Position found = source_position(source, offset);
            Position right = position_by_walking(source, offset);
            assert_int_equal(found.line, right.line);
            assert_int_equal(found.column, right.column);
        }
        reading_free(r);
    }
}

static void separators_of_locales_become_points(void **state)
{
    static const char *const numbers[][2] = {{"1.5", "1.5"},
                                             {"-0,25", "-0.25"},
                                             {"1,5e-07", "1.5e-07"},
                                             {"0\xd9\xab"
                                              "5",
                                              "0.5"},
                                             {"-12", "-12"},
                                             {"inf", "inf"}};
    (void)state;
    Reading *r = reading_new();
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        Text text = {.arena = &r->arena};
        text_printed_number(&text, numbers[i][0]);
        assert_string_equal(text.bytes, numbers[i][1]);
    }
    reading_free(r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(arena_counts_and_limits),
        cmocka_unit_test(arena_goes_back_to_a_mark),
        cmocka_unit_test(arena_is_cleared),
        cmocka_unit_test(arena_refuses_products_that_overflow),
        cmocka_unit_test(numbers_are_short_and_exact),
        cmocka_unit_test(separators_of_locales_become_points),
        cmocka_unit_test(decimals_of_many_digits_are_exact),
        cmocka_unit_test(json_is_escaped),
        cmocka_unit_test(names_are_kept_once),
        cmocka_unit_test(misspelt_names_are_recognised),
        cmocka_unit_test(places_count_characters),
        cmocka_unit_test(places_are_found_in_long_lines),
    };
    return cmocka_run_group_tests_name("texts", tests, NULL, NULL);
}
