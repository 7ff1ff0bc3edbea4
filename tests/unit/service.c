/*
 * service.c: what editors ask of a text, question by question.
 *
 * `@` in a text is where a question is asked; of two, the range between them.  Answers are compared in lines and columns
 * that are counted here by hand.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/service/service.h"

/* ---- asking ---- */

typedef struct Asked {
    Service        *service;
    ServiceQuestion about;
} Asked;

/* Takes the next mark out of a text, and counts where it stood in UTF-16 units. */
static Utf16Position take_mark(char *text)
{
    char         *mark = strchr(text, '@');
    Utf16Position at   = {0};
    assert_non_null(mark);
    for (char *c = text; c < mark; c++) {
        const unsigned char byte = (unsigned char)*c;
        at.character += byte == '\n' ? 0 : (byte & 0xC0) == 0x80 ? 0 : byte >= 0xF0 ? 2 : 1;
        if (byte == '\n')
            at = (Utf16Position){at.line + 1, 0};
    }
    memmove(mark, mark + 1, strlen(mark));
    return at;
}

static Asked open_text(const char *marked)
{
    Asked asked      = {.service = service_new(NULL), .about = {.path = "scene.krs"}};
    char *text       = strdup(marked);
    asked.about.from = asked.about.to = take_mark(text);
    if (strchr(text, '@'))
        asked.about.to = take_mark(text);
    assert_true(service_open(asked.service, "scene.krs", "file:///scene.krs", text, strlen(text)));
    free(text);
    return asked;
}

static void close_text(Asked *asked) { service_free(asked->service); }

static void expect_in(const char *answer, const char *wanted)
{
    if (!answer || !strstr(answer, wanted))
        fail_msg("no\n  %s\nin\n  %s", wanted, answer ? answer : "nothing");
}

static void expect_not_in(const char *answer, const char *unwanted)
{
    if (!answer || strstr(answer, unwanted))
        fail_msg("unexpected\n  %s\nin\n  %s", unwanted, answer ? answer : "nothing");
}

static void expect_answer(const char *question, const char *marked, const char *wanted)
{
    Asked asked = open_text(marked);
    expect_in(service_answer(asked.service, question, &asked.about), wanted);
    close_text(&asked);
}

static void expect_no_answer(const char *question, const char *marked, const char *unwanted)
{
    Asked asked = open_text(marked);
    expect_not_in(service_answer(asked.service, question, &asked.about), unwanted);
    close_text(&asked);
}

#define RANGE(line, from, to)                                                          \
    "{\"start\":{\"line\":" #line ",\"character\":" #from "},\"end\":{\"line\":" #line \
    ",\"character\":" #to "}}"

/* ---- where names are defined and used ---- */

static void definitions_are_found(void **state)
{
    static const char question[] = "textDocument/definition";
    (void)state;
    expect_answer(question, "let radius = 2;\nshow sphere(rad@ius);\n",
                  "\"range\":" RANGE(0, 4, 10));
    expect_answer(question, "def f(a) = a@ + 1;\n", "\"range\":" RANGE(0, 6, 7));
    expect_answer(question, "let l = [i@ * 2 for i in 0..3];\n", "\"range\":" RANGE(0, 19, 20));
    expect_answer(question, "let l = let q = 1 in q@;\n", "\"range\":" RANGE(0, 12, 13));
    expect_answer(question, "def f(a) = a;\nlet b = f(a@: 2);\n", "\"range\":" RANGE(0, 6, 7));
    /* The inner of two, and the outer behind it. */
    expect_answer(question, "let a = 1;\nlet b = (let a = 2 in a@) + a;\n", RANGE(1, 13, 14));
    expect_answer(question, "let a = 1;\nlet b = (let a = 2 in a) + a@;\n", RANGE(0, 4, 5));
    /* Behind characters of two, and of one, units. */
    expect_answer(question, "/*\xF0\x9F\x8C\x8D\xC3\xA9*/ let a = 1; let b = a@;\n",
                  RANGE(0, 12, 13));
    /* In a statement that cannot be read. */
    expect_answer(question, "let radius = 2;\nshow sphere(rad@ius;\n", RANGE(0, 4, 10));
    expect_answer(question, "let radius = 2;\nlet b = radius@ +;\n", RANGE(0, 4, 10));
    expect_answer(question, "show sphere@(1);\n", "\"uri\":\"library:solids.krs\"");
    expect_answer(question, "use \"std/tr@ees.krs\";\n", "\"uri\":\"library:std/trees.krs\"");
    expect_answer(question, "let a = 1@;\n", "null");
    expect_answer(question, "let a = sin@(1);\n", "null");
}

static void references_are_found(void **state)
{
    static const char text[] = "let a@ = 1;\nlet b = a + (let a = 2 in a);\nshow sphere(a);\n";
    (void)state;
    Asked             asked    = open_text(text);
    static const char wanted[] = "[{\"uri\":\"file:///scene.krs\",\"range\":" RANGE(
        1, 8, 9) "},"
                 "{\"uri\":\"file:///scene.krs\",\"range\":" RANGE(2, 12, 13) "}]";
    assert_string_equal(service_answer(asked.service, "textDocument/references", &asked.about),
                        wanted);
    asked.about.definition = true;
    expect_in(service_answer(asked.service, "textDocument/references", &asked.about),
              RANGE(0, 4, 5));
    close_text(&asked);
}

static const char *renamed(Asked *asked, const char *word)
{
    asked->about.word = word;
    return service_answer(asked->service, "textDocument/rename", &asked->about);
}

static void names_change_where_nothing_else_does(void **state)
{
    (void)state;
    Asked       asked  = open_text("def f(a, c) = a@ + a;\nlet a = f(a: 1, c: 2);\n");
    const char *answer = renamed(&asked, "size");
    expect_in(answer, RANGE(0, 6, 7));
    expect_in(answer, RANGE(0, 14, 15));
    expect_in(answer, RANGE(0, 18, 19));
    expect_in(answer, RANGE(1, 10, 11)); /* the name of the argument */
    expect_not_in(answer, RANGE(1, 4, 5));
    assert_null(renamed(&asked, "c"));
    expect_in(service_refusal(asked.service), "something else");
    assert_null(renamed(&asked, "let"));
    assert_null(renamed(&asked, "2a"));
    assert_null(renamed(&asked, "a b"));
    assert_null(renamed(&asked, ""));
    close_text(&asked);
    /* A new name that an inner one would hide. */
    asked = open_text("let a@ = 1;\nlet b = let c = 2 in a + c;\n");
    assert_null(renamed(&asked, "c"));
    assert_non_null(renamed(&asked, "d"));
    close_text(&asked);
    asked = open_text("show sphere@(1);\n");
    assert_null(renamed(&asked, "ball"));
    expect_in(service_refusal(asked.service), "library");
    close_text(&asked);
}

static void files_that_are_open_count(void **state)
{
    static const char used[] = "/// A ball.\ndef ball(r) = sphere(r);\n";
    (void)state;
    Asked asked = open_text("use \"used.krs\";\nshow ball@(2);\n");
    assert_true(service_open(asked.service, "used.krs", "file:///used.krs", used, strlen(used)));
    expect_in(service_answer(asked.service, "textDocument/definition", &asked.about),
              "{\"uri\":\"file:///used.krs\",\"range\":" RANGE(1, 4, 8) "}");
    expect_in(service_answer(asked.service, "textDocument/hover", &asked.about), "A ball.");
    const char *answer = renamed(&asked, "globe");
    expect_in(answer, "\"file:///used.krs\":[{\"range\":" RANGE(1, 4, 8));
    expect_in(answer, "\"file:///scene.krs\":[{\"range\":" RANGE(1, 5, 9));
    assert_null(renamed(&asked, "sphere"));
    /* From the other file. */
    asked.about.path       = "used.krs";
    asked.about.definition = false;
    asked.about.from       = (Utf16Position){1, 5};
    expect_in(service_answer(asked.service, "textDocument/references", &asked.about),
              "[{\"uri\":\"file:///scene.krs\",\"range\":" RANGE(1, 5, 9) "}]");
    /* A mistake there is one of the `use`. */
    assert_true(service_open(asked.service, "used.krs", NULL, "def ball(r) = ;", 15));
    expect_in(service_diagnostics(asked.service, "scene.krs"),
              "{\"range\":" RANGE(0, 0, 15) ",\"severity\":1,\"code\":\"E0101\"");
    service_close(asked.service, "used.krs");
    expect_in(service_diagnostics(asked.service, "scene.krs"), "E0501");
    close_text(&asked);
}

static void names_that_cannot_be_read_are_not_changed(void **state)
{
    (void)state;
    static const char *const unread[] = {"let d = a +;", "show box([a, 1 2]);", "show a a;",
                                         "camera { eye: [a }", "let 3 = a;"};
    for (size_t i = 0; i < sizeof unread / sizeof *unread; i++) {
        char text[100];
        snprintf(text, sizeof text, "let a@ = 1;\n%s\n", unread[i]);
        Asked asked = open_text(text);
        assert_null(renamed(&asked, "c"));
        expect_in(service_refusal(asked.service), "cannot be read");
        close_text(&asked);
    }
    /* What is left of a statement is read, and members have names of their own. */
    Asked asked = open_text("let a@ = 1;\nlet b = a;\nshow sphere(a;\nshow v.a +;\n");
    expect_in(renamed(&asked, "c"), RANGE(2, 12, 13));
    close_text(&asked);
}

/* A folder of files that are not open. */
static const char *const beside[][2] = {{"user.krs", "use \"scene.krs\";\nshow ball(2);\n"},
                                        {"other.krs", "def ball(r) = sphere(r);\nshow ball(3);\n"},
                                        {"notes.txt", "use \"scene.krs\";\nshow ball(4);\n"}};

static const char *list_beside(void *user, const char *folder)
{
    (void)user;
    return *folder ? NULL : "user.krs\nother.krs\nnotes.txt\nmore/\n";
}

static const char *read_beside(void *user, const char *path, size_t *length)
{
    (void)user;
    for (size_t i = 0; i < sizeof beside / sizeof *beside; i++)
        if (strcmp(beside[i][0], path) == 0) {
            *length = strlen(beside[i][1]);
            return beside[i][1];
        }
    return NULL;
}

static void files_beside_a_document_count(void **state)
{
    static const char        text[] = "def ball(r) = sphere(r);\n";
    static const ServiceHost host   = {.list = list_beside, .read = read_beside};
    (void)state;
    Asked asked = {.service = service_new(&host), .about = {.path = "scene.krs", .from = {0, 5}}};
    assert_true(service_open(asked.service, "scene.krs", NULL, text, strlen(text)));
    assert_string_equal(service_answer(asked.service, "textDocument/references", &asked.about),
                        "[{\"uri\":\"user.krs\",\"range\":" RANGE(1, 5, 9) "}]");
    expect_in(renamed(&asked, "globe"), "\"user.krs\":[{\"range\":" RANGE(1, 5, 9));
    /* An open text counts in place of the file. */
    assert_true(service_open(asked.service, "user.krs", NULL, "show sphere(1);\n", 16));
    assert_string_equal(service_answer(asked.service, "textDocument/references", &asked.about),
                        "[]");
    close_text(&asked);
}

/* ---- hover ---- */

static void hover_tells_documentation_and_value(void **state)
{
    static const char question[] = "textDocument/hover";
    (void)state;
    expect_no_answer(question, "let n = 3;\nlet m = n@;\n", "\\n= 3");
    expect_answer(question, "let n = 3 * 6;\nlet m = n@;\n", "= 18");
    expect_answer(question, "/// How wide.\nparam w = 0.5 in [0, 1];\nlet a = w@;\n", "How wide.");
    expect_answer(question, "/// How wide.\nparam w = 0.5 in [0, 1];\nlet a = w@;\n",
                  "a number from 0 to 1, known in frames");
    expect_answer(question,
                  "/// Of steel.\nmaterial m { roughness: 0.2 }\nshow sphere(1).paint(m@);\n",
                  "Of steel.");
    expect_answer(question, "/// All parts.\nlet n = 2 * 3;\nlet m = n@;\n", "All parts.");
    expect_answer(question, "let ball@ = sphere(2);\n", "from [-2, -2, -2] to [2, 2, 2]");
    expect_answer(question, "show sphere(2).mo@ve([1, 0, 0]);\n", "moves by a vector");
    expect_answer(question, "show sphere(2).mo@ve([1, 0, 0]);\n", "from [-1, -2, -2] to [3, 2, 2]");
    expect_answer(question, "show sph@ere(2);\n", "sphere(radius = 1)");
    expect_answer(question, "show sph@ere(2);\n", "A ball around the origin.");
    expect_answer(question, "let a = s@in(1);\n", "sine");
    expect_answer(question, "let a = p@i;\n", "half a turn");
    expect_answer(question, "let a = 90d@eg;\n", "= 1.5707963267948966");
    expect_answer(question, "let c = #ff8000@;\n", "fill='%23ff8000'");
    expect_answer(question, "let c = #ff8000;\nshow sphere(1).paint(c@);\n", "fill='%23ff8000'");
    expect_answer(question, "let l = [i@ * 2 for i in 5..8];\n", "= 5");
    expect_answer(question, "def f(a = 7) = a@ + 1;\n", "= 7");
    expect_answer(question, "light sun { inten@sity: 3 + 1 }\n", "= 4");
    /* Beside mistakes, and within one. */
    expect_answer(question, "let n = 4;\nlet bad = ;\nlet m = n@;\nshow nothing;\n", "= 4");
    expect_answer(question, "let n = 4;\nshow sphere(n@;\n", "= 4");
    expect_answer(question, "let a = 1 / 0;\nlet b = a@;\n", "let a = 1 / 0");
    expect_answer(question, "let a@ = 1;\n", "let a = 1");
    expect_answer(question, "// words@\nlet a = 1;\n", "null");
}

/* A value that takes too long is not waited for. */
static void long_values_are_given_up(void **state)
{
    (void)state;
    expect_no_answer("textDocument/hover",
                     "def f(n) = if n == 0 then 1 else f(n - 1) + f(n - 1);\nlet a@ = f(40);\n",
                     "\\n= ");
}

/* ---- completion ---- */

static void completion_offers_what_fits(void **state)
{
    static const char question[] = "textDocument/completion";
    (void)state;
    expect_answer(question, "let radius = 1;\nshow sphere(ra@);\n",
                  "{\"label\":\"radius\",\"kind\":6");
    expect_answer(question, "let a = @;\n", "{\"label\":\"torus\"");
    expect_answer(question, "show sphere(@);\n", "{\"label\":\"radius:\"");
    expect_answer(question, "show sphere(1).@;\n", "{\"label\":\"move\"");
    expect_answer(question, "show sphere(1).@\nshow box([1, 1, 1]);\n", "{\"label\":\"move\"");
    expect_answer(question, "show union(sphere(1).ro@\nlet a = 1;\n", "{\"label\":\"rotate\"");
    expect_answer(question, "let v = [1, 2];\nlet a = v.@;\n", "[{\"label\":\"x\"");
    expect_no_answer(question, "let v = [1, 2];\nlet a = v.@;\n", "{\"label\":\"z\"");
    expect_answer(question, "let v = translate([1, 0, 0]);\nlet a = v.@;\n",
                  "[{\"label\":\"inverse\"");
    expect_answer(question, "def f(s: shape) = s.@;\n", "{\"label\":\"paint\"");
    expect_answer(question, "def f(s: point) = s.@;\n", "{\"label\":\"z\"");
    expect_no_answer(question, "def f(s: point) = s.@;\n", "{\"label\":\"paint\"");
    expect_answer(question, "camera { eye: [1, 2, 3], @ }\n", "{\"label\":\"target:\"");
    expect_no_answer(question, "camera { eye: [1, 2, 3], @ }\n", "{\"label\":\"roughness:\"");
    expect_answer(question, "material m {\n    @\n}\n", "{\"label\":\"roughness:\"");
    expect_answer(question, "material m { color: @ }\n", "{\"label\":\"white\"");
    expect_answer(question, "shape s(r = 1) { @ }\n", "{\"label\":\"distance:\"");
    expect_answer(question, "def f(a: @) = a;\n", "{\"label\":\"points\"");
    expect_answer(question, "let a = 30@;\n", "[{\"label\":\"deg\"");
    expect_answer(question, "let c = #c8553d;\nlet d = #@;\n", "\"#c8553d\"");
    expect_answer(question, "use \"st@\";\n", "\"std/trees.krs\"");
    expect_answer(question, "@", "{\"label\":\"show\"");
    expect_answer(question, "let k = krs { @ };\n", "{\"label\":\"kernel\"");
    /* Names of the place, in statements that cannot be read. */
    expect_answer(question, "def f(width) = wi@ +;\n", "{\"label\":\"width\"");
    expect_answer(question, "let a = let inner = 1 in sphere(in@\n", "{\"label\":\"inner\"");
    expect_answer(question, "let a = [sphere(@ for turn in 0..3];\n", "{\"label\":\"torus\"");
    expect_no_answer(question, "def f(width) = width;\nlet a = @;\n", "{\"label\":\"width\"");
    /* Where nothing fits. */
    expect_answer(question, "let @", "[]");
    expect_answer(question, "// show @\n", "[]");
    expect_answer(question, "/* show\n@ */\n", "[]");
}

static void signatures_follow_the_argument(void **state)
{
    static const char question[] = "textDocument/signatureHelp";
    (void)state;
    expect_answer(question, "show torus(@);\n", "\"label\":\"torus(major = 1, minor = 0.25)\"");
    expect_answer(question, "show torus(@);\n", "\"activeParameter\":0");
    expect_answer(question, "show torus(1, @", "\"activeParameter\":1");
    expect_answer(question, "show torus(minor: @);\n", "\"activeParameter\":1");
    expect_answer(question, "show torus([1, 2][0], max(1, 2) @);\n", "\"activeParameter\":1");
    expect_answer(question, "show sphere(1).rotate([0, 1, 0], @);\n",
                  "\"label\":\"rotate(axis?, angle?)\"");
    expect_answer(question, "let a = clamp(1, @);\n", "\"label\":\"clamp(x, low, high)\"");
    expect_answer(question, "let a = clamp(1, @);\n", "{\"label\":[9,12]}");
    expect_answer(question, "def f(a, b) = (@a);\n", "null");
    expect_answer(question, "show torus(1);@\n", "null");
}

/* ---- lists ---- */

static void symbols_are_listed(void **state)
{
    static const char text[] =
        "@let a = 1;\nshape s(r = 1) { distance: length(p) - r }\n"
        "for i in 0..3 { show s(i); }\nlet bad = ;\ncamera { eye: [1, 2, 3] }\n";
    (void)state;
    Asked       asked  = open_text(text);
    const char *answer = service_answer(asked.service, "textDocument/documentSymbol", &asked.about);
    expect_in(answer, "{\"name\":\"a\",\"detail\":\"let\",\"kind\":13,\"range\":" RANGE(0, 0, 10));
    expect_in(answer, "{\"name\":\"s\",\"detail\":\"s(r = 1)\",\"kind\":5");
    expect_in(answer, "{\"name\":\"show s(i)\"");
    expect_in(answer, "{\"name\":\"bad\"");
    expect_in(answer, "{\"name\":\"camera\"");
    close_text(&asked);
}

static void tokens_are_told_apart(void **state)
{
    (void)state;
    /* let a = sphere(2); // c: keyword, variable that is declared, =, class of the library, number, comment */
    expect_answer("textDocument/semanticTokens/full", "@let a = sphere(2);\n  // c\n",
                  "{\"data\":[0,0,3,0,0,0,4,1,1,1,0,2,1,11,0,0,2,6,6,2,0,7,1,8,0,1,2,4,10,0]}");
    /* A comment of two lines, the second behind a character of two units. */
    expect_answer("textDocument/semanticTokens/full", "@/* a\n\xF0\x9F\x8C\x8D */ let b = 1;\n",
                  "{\"data\":[0,0,4,10,0,1,0,5,10,0,0,6,3,0,0,0,4,1,1,1,0,2,1,11,0,0,2,1,8,0]}");
    expect_answer("textDocument/semanticTokens/range", "let a = 1;\n@let b = a;@\nlet c = 1;\n",
                  "{\"data\":[1,0,3,0,0,0,4,1,1,1,0,2,1,11,0,0,2,1,1,0]}");
}

static void folds_are_found(void **state)
{
    (void)state;
    expect_answer(
        "textDocument/foldingRange", "@// a\n// b\ncamera {\n    eye: [1,\n 2, 3]\n}\n",
        "[{\"startLine\":0,\"endLine\":1,\"kind\":\"comment\"},{\"startLine\":2,\"endLine\":4}]");
    expect_answer("textDocument/foldingRange", "@camera {\n    eye: [1, 2, 3]\n}\n",
                  "[{\"startLine\":0,\"endLine\":1}]");
    expect_answer("textDocument/foldingRange", "@let a = 1;\n", "[]");
}

/* ---- changes ---- */

static void colours_are_picked(void **state)
{
    (void)state;
    expect_answer("textDocument/documentColor", "@let c = #ff0033;\n",
                  "{\"range\":" RANGE(
                      0, 8, 15) ",\"color\":{\"red\":1,\"green\":0,\"blue\":0.2,\"alpha\":1}}");
    Asked asked          = open_text("@let c = #ff0033;\n");
    asked.about.color[1] = 0.5;
    asked.about.color[2] = 7;
    expect_in(service_answer(asked.service, "textDocument/colorPresentation", &asked.about),
              "\"#0080ff\"");
    close_text(&asked);
}

static void numbers_become_params(void **state)
{
    static const char question[] = "textDocument/codeAction";
    (void)state;
    expect_answer(
        question, "// A ball.\nshow sphere(0.@5);\n",
        "{\"range\":" RANGE(0, 0, 0) ",\"newText\":\"param radius = 0.5 in [0, 1];\\n\"},"
                                     "{\"range\":" RANGE(1, 12, 15) ",\"newText\":\"radius\"}");
    expect_answer(question, "let radius = 1;\nshow sphere(2@);\n", "param radius_2 = 2 in [0, 4];");
    expect_answer(question, "camera { fov: 40d@eg }\n", "param fov = 40deg in [20deg, 80deg];");
    /* Ranges that the compiler takes, where there is one. */
    expect_answer(question, "show sphere(1).scale(2@);\n", " = 2 in [1, 4];");
    expect_answer(question, "camera { fov: 120d@eg }\n", "in [60deg, 150deg];");
    expect_answer(question, "show sphere(0.1).move([1, 0, 0]).repeat_polar(7@);\n", "[]");
    expect_answer(question, "show prism(5@, 1, 1);\n", "[]");
    expect_answer(question, "let n = 5@;\nshow union([sphere(i) for i in 1..n]);\n", "[]");
    expect_answer(question, "let a = 35d@eg;\nshow sphere(1).rotate([0, 1, 0], a);\n",
                  " = 35deg in [0deg, 70deg];");
    expect_answer(question, "let a = [i for i in 0..8@];\n", "[]");
    expect_answer(question, "param a = 8@;\n", "[]");
}

static void expressions_become_definitions(void **state)
{
    static const char question[] = "textDocument/codeAction";
    (void)state;
    expect_answer(question, "show @sphere(1) | box([1, 1, 1])@;\n",
                  "\"newText\":\"let part = sphere(1) | box([1, 1, 1]);\\n\"");
    expect_answer(question, "let a = 2;\nlet l = [@sphere(i * a)@ for i in 0..3];\n",
                  "\"newText\":\"def part(i) = sphere(i * a);\\n\"},{\"range\":" RANGE(
                      1, 9, 22) ",\"newText\":\"part(i)\"}");
    expect_answer(question, "for i in 0..3 { show sphere(1).move(@[i, 0, 0]@); }\n",
                  "\"newText\":\"def part(i) = [i, 0, 0];\\n\"");
    expect_answer(question, "show @sphere(1) |@ box([1, 1, 1]);\n", "[]");
}

static void mistakes_are_mended(void **state)
{
    (void)state;
    Asked            asked = open_text("show spher@e(1)\n");
    const ServiceFix fix   = {{0, 14}, {0, 14}, ";", "{\"code\":\"E0101\"}"};
    asked.about.fixes      = &fix;
    asked.about.fix_count  = 1;
    expect_in(
        service_answer(asked.service, "textDocument/codeAction", &asked.about),
        "{\"title\":\"write `;`\",\"kind\":\"quickfix\",\"diagnostics\":[{\"code\":\"E0101\"}]");
    close_text(&asked);
}

static void texts_are_laid_out(void **state)
{
    static const char question[] = "textDocument/formatting";
    (void)state;
    expect_answer(question, "@let  a=1;\n", "\"newText\":\"");
    expect_answer(question, "@let a = 1;\n", "[]");
    expect_answer(question, "@let  a=;\n", "[]");
}

static void texts_are_edited(void **state)
{
    (void)state;
    Asked asked = open_text("@let a = \"\xF0\x9F\x8C\x8D\";\nlet b = a;\n");
    /* Behind the character of two units, over the end of the line. */
    assert_true(service_edit(asked.service, "scene.krs", (Utf16Position){0, 12},
                             (Utf16Position){1, 4}, ";\nlet c", 7));
    asked.about.from = (Utf16Position){1, 9};
    expect_in(service_answer(asked.service, "textDocument/definition", &asked.about),
              RANGE(0, 4, 5));
    /* Positions beyond lines and the text, and in the wrong order. */
    assert_true(service_edit(asked.service, "scene.krs", (Utf16Position){0, 4000},
                             (Utf16Position){0, 3}, " // end", 7));
    assert_true(service_edit(asked.service, "scene.krs", (Utf16Position){700, 4},
                             (Utf16Position){900, 3}, "let d = 1;\n", 11));
    expect_in(service_answer(asked.service, "textDocument/documentSymbol", &asked.about),
              "{\"name\":\"d\"");
    assert_false(service_edit(asked.service, "other.krs", (Utf16Position){0, 0},
                              (Utf16Position){0, 0}, "", 0));
    close_text(&asked);
}

static void diagnostics_are_complete(void **state)
{
    static const char text[] = "@let a = 1;\nlet b = c;\nlet d = sphere(1) + 1;\n";
    (void)state;
    Asked asked = open_text(text);
    expect_in(service_diagnostics(asked.service, "scene.krs"), "E0201");
    expect_in(service_diagnostics(asked.service, "scene.krs"), "\"uri\":\"file:///scene.krs\"");
    char *found = strdup(service_diagnostics(asked.service, "scene.krs"));
    assert_string_equal(found, service_check(asked.service, "scene.krs"));
    free(found);
    close_text(&asked);
    asked = open_text("@let d = sphere(1) + 1;\nshow d;\n");
    assert_string_equal(service_diagnostics(asked.service, "scene.krs"), "[]");
    expect_in(service_check(asked.service, "scene.krs"), "E0301");
    close_text(&asked);
}

static void what_is_not_known_is_refused(void **state)
{
    (void)state;
    Asked asked = open_text("@let a = 1;\n");
    assert_null(service_answer(asked.service, "textDocument/nothing", &asked.about));
    assert_null(service_refusal(asked.service));
    asked.about.path = "other.krs";
    assert_null(service_answer(asked.service, "textDocument/hover", &asked.about));
    assert_non_null(service_refusal(asked.service));
    assert_null(service_check(asked.service, "other.krs"));
    expect_in(service_capabilities(asked.service), "\"hoverProvider\":true");
    close_text(&asked);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(definitions_are_found),
        cmocka_unit_test(references_are_found),
        cmocka_unit_test(names_change_where_nothing_else_does),
        cmocka_unit_test(names_that_cannot_be_read_are_not_changed),
        cmocka_unit_test(files_beside_a_document_count),
        cmocka_unit_test(files_that_are_open_count),
        cmocka_unit_test(hover_tells_documentation_and_value),
        cmocka_unit_test(long_values_are_given_up),
        cmocka_unit_test(completion_offers_what_fits),
        cmocka_unit_test(signatures_follow_the_argument),
        cmocka_unit_test(symbols_are_listed),
        cmocka_unit_test(tokens_are_told_apart),
        cmocka_unit_test(folds_are_found),
        cmocka_unit_test(colours_are_picked),
        cmocka_unit_test(numbers_become_params),
        cmocka_unit_test(expressions_become_definitions),
        cmocka_unit_test(mistakes_are_mended),
        cmocka_unit_test(texts_are_laid_out),
        cmocka_unit_test(texts_are_edited),
        cmocka_unit_test(diagnostics_are_complete),
        cmocka_unit_test(what_is_not_known_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
