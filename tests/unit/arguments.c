/*
 * arguments.c: what is said of wrong arguments.  Every function and shape of the library, every function
 * and every method of the language is called with values of wrong types, sizes and signs.  Whatever is
 * said is said of the scene, in its words: no private name of the library, no function that the scene does
 * not name, no place outside of the scene.
 *
 * Functions and their parameters are read from the text of the library, by its layout alone.
 */
#include <ctype.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/base/embedded.h"
#include "krs/krs.h"

enum { MAX_FUNCTIONS = 200, MAX_OF_ONE = 16, LONGEST = 8192 };

typedef struct Parameter {
    char name[40], good[120]; /* `good`: what is given where another argument is tried; or "" */
} Parameter;

typedef struct Called {
    char      name[40], file[40]; /* the file that has to be used, or "" */
    char      before[40];         /* the receiver of a method */
    Parameter parameters[MAX_OF_ONE];
    int       count;
} Called;

static Called functions[MAX_FUNCTIONS];
static int    function_count;

/* What fits a parameter without a default, by the word of its kind. */
static const char *const good_values[][2] = {
    {"number", "1"},
    {"size", "1"},
    {"known", "1"},
    {"count", "3"},
    {"value", "0.3"},
    {"pair", "[1, 2]"},
    {"vector", "[0.1, 0.2, 0.3]"},
    {"place", "[1, 2]"},
    {"point", "[0, 0, 0]"},
    {"points", "[[0, 0, 0], [1, 0, 0], [1, 1, 0]]"},
    {"path", "[[0, 0, 0], [1, 0, 0], [1, 1, 0]]"},
    {"mirrors", "[[[1, 0, 0], 1]]"},
    {"shape", "sphere(0.1)"},
    {"solid", "sphere(0.1)"},
    {"region", "box([1, 1, 1])"},
    {"figure", "circle(0.1)"},
    {"figures", "[circle(1), rectangle([1, 1])]"},
    {"pattern", "max"},
    {"list", "[1, 2]"},
};

static const char *const tried[] = {"true",
                                    "\"a\"",
                                    "-1",
                                    "0",
                                    "0.5",
                                    "6.5",
                                    "1e300",
                                    "-1e300",
                                    "1e-300",
                                    "[]",
                                    "[1]",
                                    "[-1]",
                                    "[0, 0]",
                                    "[1, 2]",
                                    "[0, 0, 0]",
                                    "[1, 2, 3]",
                                    "[1e300, 0, 0]",
                                    "[1, 2, 3, 4]",
                                    "[\"a\", 1]",
                                    "[[1, 2], [3, 4]]",
                                    "[[0, 0, 0]]",
                                    "[[0, 0, 0], [0, 0, 0]]",
                                    "[[0, 0, 0], [1, 0, 0], [0, 0, 0]]",
                                    "[[1, 0, 0], [2, 0, 0], 3]",
                                    "[[[0, 0, 0], [1, 0, 0], [2, 0]]]",
                                    "[[[0, 0, 0], [2, 0, 0], [1, 0, 0]]]",
                                    "sphere(1)",
                                    "circle(1)",
                                    "plane()",
                                    "[circle(1)]",
                                    "[sphere(1), circle(1)]",
                                    "[plane(), plane()]",
                                    "union([])",
                                    "paint",
                                    "white",
                                    "x",
                                    "[x, 0, 0]",
                                    "free",
                                    "bounded",
                                    "time",
                                    "translate([1, 0, 0])",
                                    "sin",
                                    "swatch"};

/* ---- the library's text ---- */

static void read_good(Parameter *parameter, const char *kind, size_t length, int place)
{
    for (size_t i = 0; i < sizeof good_values / sizeof *good_values; i++)
        if (strlen(good_values[i][0]) == length && strncmp(good_values[i][0], kind, length) == 0) {
            if (strcmp(good_values[i][0], "point") == 0) /* no three on a line */
                snprintf(parameter->good, sizeof parameter->good, "[0, %d, %d]", place,
                         place * place);
            else
                snprintf(parameter->good, sizeof parameter->good, "%s", good_values[i][1]);
        }
}

/* Reads "name: kind = default in range" up to the comma or parenthesis behind it. */
static const char *read_parameter(const char *text, Called *called)
{
    Parameter  *parameter = &called->parameters[called->count];
    size_t      length    = strcspn(text, ":,) \n=");
    const char *rest      = text + length;
    int         depth     = 0;
    assert_true(called->count < MAX_OF_ONE && length > 0 && length < sizeof parameter->name);
    snprintf(parameter->name, sizeof parameter->name, "%.*s", (int)length, text);
    bool given = false;
    if (*rest == ':') {
        rest += 1 + strspn(rest + 1, " ");
        length = strcspn(rest, ",) \n=");
        read_good(parameter, rest, length, called->count);
        rest += length;
    }
    for (; depth > 0 || (*rest != ',' && *rest != ')'); rest++) {
        depth += *rest == '(' || *rest == '[';
        depth -= *rest == ')' || *rest == ']';
        given = given || *rest == '=';
    }
    if (given)
        parameter->good[0] = '\0';
    else
        assert_true(parameter->good[0] != '\0');
    called->count++;
    return rest + (*rest == ',') + strspn(rest + (*rest == ','), " \n");
}

static void read_function(const char *text, const char *file)
{
    Called *called = &functions[function_count];
    size_t  length = strcspn(text, "(");
    if (*text == '_')
        return;
    assert_true(function_count < MAX_FUNCTIONS && length < sizeof called->name);
    snprintf(called->name, sizeof called->name, "%.*s", (int)length, text);
    if (strncmp(file, "std/", 4) == 0)
        snprintf(called->file, sizeof called->file, "use \"%s\";", file);
    for (text += length + 1; *text != ')';)
        text = read_parameter(text, called);
    function_count++;
}

static void read_library(void)
{
    for (const EmbeddedFile *file = library_files; file->name; file++)
        for (const char *line = file->text; line && *line; line = strchr(line, '\n')) {
            line += *line == '\n';
            if (strncmp(line, "def ", 4) == 0)
                read_function(line + 4, file->name);
            else if (strncmp(line, "shape ", 6) == 0)
                read_function(line + 6, file->name);
        }
}

/* ---- what is built in ---- */

static void add_builtin(const char *name, const char *words, const char *before)
{
    Called *called = &functions[function_count++];
    snprintf(called->name, sizeof called->name, "%s", name);
    snprintf(called->before, sizeof called->before, "%s", before);
    while (*words) {
        size_t     length = strcspn(words, " =."), whole = strcspn(words, " ");
        Parameter *parameter = &called->parameters[called->count];
        /* those that take several take one by its place */
        if (words[length] != '.')
            snprintf(parameter->name, sizeof parameter->name, "%.*s", (int)length, words);
        if (words[length] == ' ' || words[length] == '\0')
            snprintf(parameter->good, sizeof parameter->good, "%s", "1");
        called->count++;
        words += whole + (words[whole] == ' ');
    }
}

/* ---- what is said ---- */

static char scene[1 << 15];

static bool is_letter(char c) { return isalnum((unsigned char)c) || c == '_'; }

/* Tells whether a text names a word between quotes. */
static bool names(const char *text, const char *word)
{
    size_t length = strlen(word);
    for (const char *at = strchr(text, '`'); at; at = strchr(at + 1, '`'))
        if (strncmp(at + 1, word, length) == 0 && !is_letter(at[1 + length]))
            return true;
    return false;
}

/* A name with a `_` in front, which is private. */
static bool has_private(const char *text)
{
    for (const char *at = strchr(text, '_'); at; at = strchr(at + 1, '_'))
        if (!(at > text && is_letter(at[-1])) && is_letter(at[1]))
            return true;
    return false;
}

/* What is said without its help, which may suggest whatever there is. */
static void copy_without_help(char *to, size_t size, const char *text)
{
    snprintf(to, size, "%s", text);
    char *help = strstr(to, "= help");
    if (help)
        *help = '\0';
}

static const Called *called; /* by the scene that is compiled */

static bool is_parameter(const char *name)
{
    for (int i = 0; i < called->count; i++)
        if (strcmp(called->parameters[i].name, name) == 0)
            return true;
    return false;
}

/* Returns why what is said is not the author's; NULL: it is. */
static const char *fault_of(const char *text)
{
    static char fault[80], said[LONGEST];
    copy_without_help(said, sizeof said, text);
    if (has_private(said))
        return "a private name";
    if (strstr(said, "library:"))
        return "a place in the library";
    if (!strstr(said, "--> scene.krs:"))
        return "no place in the scene";
    for (int i = 0; i < function_count; i++) {
        snprintf(fault, sizeof fault, "the function `%.40s`", functions[i].name);
        if (!*functions[i].before && names(said, functions[i].name) &&
            !strstr(scene, functions[i].name) && !is_parameter(functions[i].name))
            return fault;
    }
    return NULL;
}

static void listen(void *user, const KrsDiagnostic *diagnostic)
{
    const char *fault = fault_of(diagnostic->text);
    if (fault)
        print_error("%s:\n%s\n", fault, diagnostic->text);
    *(int *)user += fault != NULL;
}

static size_t write_call(size_t used, int which, const char *value, size_t line)
{
    bool first = true;
    used += (size_t)snprintf(scene + used, sizeof scene - used, "let v%zu = %s%s(", line,
                             called->before, called->name);
    for (int i = 0; i < called->count; i++) {
        const Parameter *parameter = &called->parameters[i];
        const char      *given     = i == which ? value : parameter->good;
        if (!*given)
            continue;
        used += (size_t)snprintf(scene + used, sizeof scene - used, "%s%s%s%s", first ? "" : ", ",
                                 parameter->name, *parameter->name ? ": " : "", given);
        first = false;
    }
    return used + (size_t)snprintf(scene + used, sizeof scene - used, ");\n");
}

/* Faults of what is said of some values of one argument, each in a call of its own. */
static int try_values(const Called *function, int which, const char *const *values, size_t count)
{
    called      = function;
    size_t used = (size_t)snprintf(
        scene, sizeof scene,
        "%s param free = 1; param bounded = 1 in [0.5, 2]; material paint { roughness: 0.5 }\n"
        "material swatch(a) { color: a } show sphere(1);\n",
        called->file);
    for (size_t i = 0; i < count; i++)
        used = write_call(used, which, values[i], i);
    assert_true(used < sizeof scene);
    int        faults  = 0;
    KrsOptions options = {.diagnostic = listen, .user = &faults};
    KrsScene  *result  = NULL;
    KrsStatus  status  = krs_compile_text(scene, used, "scene.krs", &options, &result);
    krs_scene_free(result);
    if (status != KRS_OK && status != KRS_BAD_SCENE)
        fail_msg("status %d of\n%s", status, scene);
    return faults;
}

static void wrong_arguments_are_told_in_the_authors_words(void **state)
{
    (void)state;
    enum { AT_ONCE = 16, COUNT = sizeof tried / sizeof *tried }; /* few enough for all to be said */
    int faults = 0;
    for (int f = 0; f < function_count; f++)
        for (int i = 0; i < functions[f].count; i++)
            for (size_t v = 0; v < COUNT; v += AT_ONCE)
                faults += try_values(&functions[f], i, tried + v,
                                     COUNT - v < AT_ONCE ? COUNT - v : AT_ONCE);
    assert_int_equal(faults, 0);
}

/* An argument that is not given is asked for. */
static void missing_arguments_are_told(void **state)
{
    (void)state;
    static const char *const none[] = {""};
    for (int f = 0; f < function_count; f++)
        for (int i = 0; i < functions[f].count; i++)
            if (*functions[f].parameters[i].good)
                assert_int_equal(try_values(&functions[f], i, none, 1), 0);
}

static void functions_are_found(void **state)
{
    (void)state;
    read_library();
    assert_true(function_count > 80);
#define FUNCTION(name, parameters, function, meaning) add_builtin(#name, parameters, "");
#include "compiler/eval/builtins/functions.def"
#undef FUNCTION
#define METHOD(name, parameters, method, meaning) add_builtin(#name, parameters, "sphere(1).");
#include "compiler/eval/builtins/methods.def"
#undef METHOD
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(functions_are_found),
        cmocka_unit_test(wrong_arguments_are_told_in_the_authors_words),
        cmocka_unit_test(missing_arguments_are_told),
    };
    return cmocka_run_group_tests_name("arguments", tests, NULL, NULL);
}
