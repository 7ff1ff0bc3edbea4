/*
 * synonyms.c: every row of synonyms.def is found where its word would stand, and its example compiles.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/front/synonyms.h"
#include "krs/krs.h"

enum { LONGEST = 1024 };

/* What is said of a scene, in one text. */
typedef struct Said {
    char   text[8 * LONGEST];
    size_t errors, warnings;
} Said;

static void listen(void *user, const KrsDiagnostic *diagnostic)
{
    Said  *said = user;
    size_t used = strlen(said->text);
    snprintf(said->text + used, sizeof said->text - used, "%s\n", diagnostic->text);
    said->errors += diagnostic->error;
    said->warnings += !diagnostic->error;
}

static KrsStatus compile(const char *scene, Said *said)
{
    KrsOptions options = {.diagnostic = listen, .user = said};
    KrsScene  *result  = NULL;
    memset(said, 0, sizeof *said);
    KrsStatus status = krs_compile_text(scene, strlen(scene), "scene.krs", &options, &result);
    krs_scene_free(result);
    return status;
}

/* A scene in which the word of a row stands where it is looked up. */
static void write_word(const Synonym *row, char *scene)
{
    const char *word = row->word, *owner = row->owner;
    bool        method = *owner == '.';
    switch (row->place) {
    case SYNONYM_NAME: snprintf(scene, LONGEST, "let a = %s;", word); break;
    case SYNONYM_STATEMENT: snprintf(scene, LONGEST, "%s (1);", word); break;
    case SYNONYM_METHOD: snprintf(scene, LONGEST, "show sphere(1).%s(1);", word); break;
    case SYNONYM_DIRECTIVE: snprintf(scene, LONGEST, "#%s a = 1;", word); break;
    case SYNONYM_CALL:
        snprintf(scene, LONGEST,
                 method ? "let a = sphere(1).%s(1, 2, 3, 4, 5);"
                        : "let a = %s(1, 2, 3, 4, 5); show a;",
                 word);
        break;
    case SYNONYM_PARAMETER: {
        /* The example names the parameter that is meant; else all calls are alike. */
        const char *at = *row->instead ? strstr(row->example, row->instead) : NULL;
        while (at && at[strlen(row->instead)] != ':')
            at = strstr(at + 1, row->instead);
        if (at)
            snprintf(scene, LONGEST, "%.*s%s%s", (int)(at - row->example), row->example, word,
                     at + strlen(row->instead));
        else if (method)
            snprintf(scene, LONGEST, "show circle(1)%s(%s: 1);", owner, word);
        else
            snprintf(scene, LONGEST, "show %s(%s: 1);", *owner ? owner : "sphere", word);
        break;
    }
    case SYNONYM_PROPERTY: {
        const char *name = strcmp(owner, "light") == 0 || strcmp(owner, "material") == 0 ? "a" : "";
        snprintf(scene, LONGEST, "%s %s { %s: 1 } show sphere(1);", owner, name, word);
    }
    }
}

static void every_word_is_answered(void **state)
{
    (void)state;
    static Said    said;
    const Synonym *row;
    for (size_t i = 0; (row = synonym_row(i)); i++) {
        char scene[LONGEST], help[LONGEST];
        write_word(row, scene);
        snprintf(help, sizeof help, "%s, as in `%s`", row->meaning, row->example);
        if (compile(scene, &said) == KRS_OK)
            fail_msg("`%s` compiles: the language has `%s` now, so its row goes", scene, row->word);
        if (said.errors != 1 || !strstr(said.text, help))
            fail_msg("`%s` should lead to the row of `%s` alone: %s", scene, row->word, said.text);
    }
}

static void every_form_is_answered(void **state)
{
    (void)state;
    static Said said;
    for (SynonymForm form = 0; form < FORM_COUNT; form++) {
        if (compile(form_written(form), &said) == KRS_OK || !strstr(said.text, form_example(form)))
            fail_msg("`%s` should lead to its row: %s", form_written(form), said.text);
    }
}

static void expect_compiled(const char *example)
{
    static Said said;
    if (compile(example, &said) != KRS_OK || said.warnings > 0)
        fail_msg("the example `%s`: %s", example, said.text);
}

static void every_example_compiles(void **state)
{
    (void)state;
    const Synonym *row, *before;
    for (size_t i = 0; (row = synonym_row(i)); i++) {
        size_t k = 0;
        while ((before = synonym_row(k)) != row && strcmp(before->example, row->example) != 0)
            k++;
        if (before == row)
            expect_compiled(row->example);
    }
    for (SynonymForm form = 0; form < FORM_COUNT; form++)
        expect_compiled(form_example(form));
}

/* A word has one row in one place, else the second is never found. */
static void no_row_hides_another(void **state)
{
    (void)state;
    const Synonym *a, *b;
    for (size_t i = 0; (a = synonym_row(i)); i++)
        for (size_t k = 0; k < i; k++) {
            b = synonym_row(k);
            if (a->place == b->place && strcmp(a->word, b->word) == 0 &&
                strcmp(a->owner, b->owner) == 0)
                fail_msg("two rows for `%s`", a->word);
        }
}

/* What may be put in place of a word as it is, makes the scene one that says nothing of it. */
static void replacements_are_understood(void **state)
{
    (void)state;
    static Said    said;
    const Synonym *row;
    for (size_t i = 0; (row = synonym_row(i)); i++)
        if (*row->instead && !strstr(row->example, row->instead) && row->place != SYNONYM_STATEMENT)
            fail_msg("the example of `%s` lacks `%s`", row->word, row->instead);
    assert_int_not_equal(compile("show ball(1);", &said), KRS_OK);
    assert_non_null(strstr(said.text, "help: a ball is a `sphere`"));
}

static void names_of_the_library_are_found(void **state)
{
    (void)state;
    static Said said;
    compile("show tree();", &said);
    assert_non_null(strstr(said.text, "`use \"std/trees.krs\";` makes it visible"));
    compile("show barth_sextic();", &said);
    assert_non_null(strstr(said.text, "`use \"std/surfaces.krs\";` makes it visible"));
    compile("use \"std/tree.krs\"; show tree();", &said);
    assert_non_null(strstr(said.text, "`\"std/trees.krs\"`"));
    assert_non_null(strstr(said.text, "the library has: std/"));
    compile("use \"nature\"; show rock();", &said);
    assert_non_null(strstr(said.text, "`\"std/nature.krs\"`"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_word_is_answered),
        cmocka_unit_test(every_form_is_answered),
        cmocka_unit_test(every_example_compiles),
        cmocka_unit_test(no_row_hides_another),
        cmocka_unit_test(replacements_are_understood),
        cmocka_unit_test(names_of_the_library_are_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
