/*
 * service_random.c: texts that are edited at random, and questions at random places.
 *
 * Each answer is JSON, by jansson; and a text that came of many edits is answered like one that was opened.
 */
#include <dirent.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <jansson.h>

#include "compiler/service/service.h"
#include "tests/support/random.h"

static const char *const questions[] = {
#define QUESTION(name, function, capability, value) name,
#include "compiler/service/questions.def"
};
enum { QUESTIONS = sizeof questions / sizeof *questions, MAX_TEXTS = 64, LONGEST = 20000 };

static char  *texts[MAX_TEXTS];
static size_t text_count;

static int read_examples(void **state)
{
    (void)state;
    DIR *folder = opendir("examples");
    assert_non_null(folder);
    for (const struct dirent *entry; (entry = readdir(folder)) != NULL && text_count < MAX_TEXTS;) {
        char        path[512];
        const char *ending = strrchr(entry->d_name, '.');
        if (!ending || strcmp(ending, ".krs") != 0)
            continue;
        snprintf(path, sizeof path, "examples/%s", entry->d_name);
        FILE *file = fopen(path, "r");
        assert_non_null(file);
        char  *text   = calloc(1, LONGEST + 1);
        size_t length = fread(text, 1, LONGEST, file);
        fclose(file);
        while (length > 0 && (text[length] & 0xC0) == 0x80) /* no character is cut */
            text[length--] = '\0';
        text[length]        = '\0';
        texts[text_count++] = text;
    }
    closedir(folder);
    assert_true(text_count > 10);
    return 0;
}

static int free_examples(void **state)
{
    (void)state;
    while (text_count > 0)
        free(texts[--text_count]);
    return 0;
}

/* ---- edits ---- */

static const char *const pieces[] = {"(",
                                     ")",
                                     "[",
                                     "]",
                                     "{",
                                     "}",
                                     ",",
                                     ";",
                                     ".",
                                     ":",
                                     "=",
                                     "\"",
                                     "#",
                                     "/*",
                                     "*/",
                                     "//",
                                     "\n",
                                     "\r\n",
                                     "let ",
                                     "def f(a, b = 2) = ",
                                     "a",
                                     "size",
                                     "30deg",
                                     "1e999",
                                     "0..3",
                                     "if ",
                                     " then ",
                                     " else ",
                                     "for i in 0..4 ",
                                     "krs { ",
                                     "kernel ",
                                     "shape s(r = 1) { distance: length(p) - r }",
                                     "camera { ",
                                     "material m { color: ",
                                     "use \"std/trees.krs\";",
                                     "sphere(1)",
                                     ".move([1, 0, 0])",
                                     ".paint(",
                                     "param t = 1 in [0, 2];",
                                     "show ",
                                     "union(",
                                     "\xC3\xA9",
                                     "\xF0\x9F\x8C\x8D",
                                     "#ff8800",
                                     ""};
enum { PIECES = sizeof pieces / sizeof *pieces };

/* Returns the position of an offset in a text of whole characters, counted once more. */
static Utf16Position position_of(const char *text, size_t offset)
{
    Utf16Position at = {0};
    for (size_t i = 0; i < offset; i++) {
        const unsigned char byte = (unsigned char)text[i];
        if (byte == '\n')
            at = (Utf16Position){at.line + 1, 0};
        else
            at.character += (byte & 0xC0) == 0x80 ? 0 : byte >= 0xF0 ? 2 : 1;
    }
    return at;
}

/* Returns an offset where a character begins, not between the two of a line's end. */
static size_t random_offset(Random *random, const char *text)
{
    size_t offset = random_below(random, (int)strlen(text) + 1);
    while (offset > 0 &&
           ((text[offset] & 0xC0) == 0x80 || (text[offset] == '\n' && text[offset - 1] == '\r')))
        offset--;
    return offset;
}

/* Edits a text and the service's, which must stay the same. */
static void edit(Random *random, Service *service, const char *path, char **text)
{
    const size_t from  = random_offset(random, *text);
    size_t       to    = from;
    const char  *piece = pieces[random_below(random, PIECES)];
    if (random_below(random, 2))
        to = random_offset(random, *text);
    if (to < from || to > from + 40)
        to = from;
    char *edited = NULL;
    assert_true(asprintf(&edited, "%.*s%s%s", (int)from, *text, piece, *text + to) >= 0);
    assert_true(service_edit(service, path, position_of(*text, from), position_of(*text, to), piece,
                             strlen(piece)));
    free(*text);
    *text = edited;
}

/* ---- questions ---- */

static void ask(Random *random, Service *service, const char *path, Utf16Position last)
{
    static const char *const words[] = {"a", "let", "", "size", "x y"};
    const ServiceFix         fix     = {{0, 0}, {1, 2}, "a", "{}"};
    ServiceQuestion          about   = {
                   .path = path, .fixes = &fix, .fix_count = (size_t)random_below(random, 2)};
    const char *question = questions[random_below(random, QUESTIONS)];
    about.from           = (Utf16Position){(uint32_t)random_below(random, (int)last.line + 2),
                                           (uint32_t)random_below(random, 100)};
    about.to             = random_below(random, 2)
                               ? about.from
                               : (Utf16Position){(uint32_t)random_below(random, (int)last.line + 2),
                                                 (uint32_t)random_below(random, 100)};
    about.word           = words[random_below(random, 5)];
    const char *answer   = service_answer(service, question, &about);
    if (!answer) {
        assert_non_null(service_refusal(service));
        return;
    }
    json_t *json = json_loads(answer, JSON_DECODE_ANY, NULL);
    if (!json)
        fail_msg("%s: no JSON: %s", question, answer);
    json_decref(json);
}

static void answers_are_json(void **state)
{
    Random random = {7};
    (void)state;
    for (size_t round = 0; round < 12; round++) {
        Service *service = service_new(NULL);
        char    *text    = strdup(texts[random_below(&random, (int)text_count)]);
        assert_true(service_open(service, "examples/a.krs", NULL, text, strlen(text)));
        for (int step = 0; step < 25; step++) {
            edit(&random, service, "examples/a.krs", &text);
            for (int k = 0; k < 4; k++)
                ask(&random, service, "examples/a.krs", position_of(text, strlen(text)));
        }
        /* The same text, opened. */
        Service              *other = service_new(NULL);
        const ServiceQuestion about = {.path = "examples/a.krs"};
        assert_true(service_open(other, "examples/a.krs", NULL, text, strlen(text)));
        char *edited = strdup(service_diagnostics(service, "examples/a.krs"));
        assert_string_equal(edited, service_diagnostics(other, "examples/a.krs"));
        free(edited);
        edited = strdup(service_answer(service, "textDocument/semanticTokens/full", &about));
        assert_string_equal(edited,
                            service_answer(other, "textDocument/semanticTokens/full", &about));
        free(edited);
        service_free(service);
        service_free(other);
        free(text);
    }
}

/* Bytes that are no text at all, also within characters. */
static void any_bytes_are_answered(void **state)
{
    Random random = {11};
    (void)state;
    for (size_t round = 0; round < 12; round++) {
        Service *service = service_new(NULL);
        char    *text    = strdup(texts[random_below(&random, (int)text_count)]);
        size_t   length  = strlen(text);
        for (int k = 0; k < 40; k++)
            text[random_below(&random, (int)length)] = (char)random_below(&random, 256);
        assert_true(service_open(service, "a.krs", NULL, text, length));
        for (int k = 0; k < 30; k++)
            ask(&random, service, "a.krs", (Utf16Position){200, 0});
        assert_true(service_edit(service, "a.krs", (Utf16Position){3, 7}, (Utf16Position){5, 1},
                                 text + length / 2, length / 2));
        for (int k = 0; k < 10; k++)
            ask(&random, service, "a.krs", (Utf16Position){400, 0});
        service_free(service);
        free(text);
    }
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(answers_are_json),
        cmocka_unit_test(any_bytes_are_answered),
    };
    return cmocka_run_group_tests(tests, read_examples, free_examples);
}
