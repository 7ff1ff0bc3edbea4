/*
 * front.c: lexer, parser and names, each by what goes in and what comes out.
 */
#include <locale.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/unit/reading.h"

/* ---- lexer ---- */

static void expect_tokens(const char *scene, const char *wanted)
{
    Reading *r    = read_text(scene);
    Text     text = {.arena = &r->arena};
    tokens_print(&r->tokens, &r->sources, &text);
    assert_string_equal(text.bytes, wanted);
    reading_free(r);
}

static void tokens_are_split(void **state)
{
    (void)state;
    expect_tokens("let a=0..n;", "1:1 `let`\n1:5 a name a\n1:6 `=`\n1:7 a number 0\n1:8 `..`\n"
                                 "1:10 a name n\n1:11 `;`\n1:12 the end of the file\n");
    expect_tokens("1.5.round//x\n/* \n */ <==", "1:1 a number 1.5\n1:4 `.`\n1:5 a name round\n"
                                                "3:5 `<=`\n3:7 `=`\n3:8 the end of the file\n");
    expect_tokens("\xEF\xBB\xBF#c8553d", "1:1 a colour #c8553d\n1:8 the end of the file\n");
}

static void numbers_are_read(void **state)
{
    (void)state;
    Reading *r = read_text("12.5 1e-3 180deg 0.1e1 1e400 123456789012345678901234567890 00.50");
    static const double wanted[] = {12.5, 1e-3, M_PI, 1, 0, 123456789012345678901234567890.0, 0.5};
    for (size_t i = 0; i < sizeof wanted / sizeof *wanted; i++)
        assert_true(r->tokens.items[i].number == wanted[i]);
    reading_free(r);
}

static void numbers_do_not_depend_on_the_locale(void **state)
{
    (void)state;
    static const char *const locales[] = {"de_DE.UTF-8", "fr_FR.UTF-8", "de_DE", "C"};
    for (size_t i = 0; !setlocale(LC_NUMERIC, locales[i]); i++)
        ;
    Reading *r = read_text("1.5");
    assert_true(r->tokens.items[0].number == 1.5);
    expect_number(r, 1.5, "1.5");
    reading_free(r);
    setlocale(LC_NUMERIC, "C");
}

static void colours_become_linear(void **state)
{
    (void)state;
    Reading *r = read_text("#ff0a80");
    double   number[3];
    assert_int_equal(r->tokens.items[0].rgb, 0xff0a80);
    linear_from_srgb(r->tokens.items[0].rgb, number);
    assert_true(number[0] == 1);
    assert_true(fabs(number[1] - 10 / 255.0 / 12.92) < 1e-15);
    assert_true(fabs(number[2] - 0.21586050011389926) < 1e-15);
    reading_free(r);
}

static void strings_are_unescaped(void **state)
{
    (void)state;
    Reading *r = read_text("\"a\\\"b\\\\c\\n\xC3\xA9\"");
    assert_string_equal(r->tokens.items[0].name, "a\"b\\c\n\xC3\xA9");
    assert_int_equal(r->diags.count, 1); /* a string is no statement */
    reading_free(r);
}

static void comments_document(void **state)
{
    (void)state;
    Reading *r = read_text("/// A ball,\n/// round.\n//// not this\ndef ball() = 1;\ndef b() = 2;");
    assert_string_equal(r->file->children[0]->doc, "A ball,\nround.");
    assert_null(r->file->children[1]->doc);
    reading_free(r);
}

static void bad_text_is_reported(void **state)
{
    (void)state;
    expect_codes("let a = 1.;", "E0104@1:9");
    expect_codes("let a = .5;", "E0104@1:9");
    expect_codes("let a = 1.2.3;", "E0104@1:9");
    expect_codes("let a = 1.e5;", "E0104@1:9");
    expect_codes("let a = 3px;", "E0104@1:10");
    expect_codes("let a = 1e999;", "E0104@1:9");
    expect_codes("let a = 1e999deg;", "E0104@1:9");
    expect_codes("let a = #fff;", "E0104@1:9");
    expect_codes("let a = \"b;\nlet c = 1;", "E0103@1:9");
    expect_codes("let a = 1; /* b", "E0103@1:12");
    expect_codes("let a = 'b';", "E0101@1:9");
    expect_codes("let a = b && c || !d;", "E0101@1:11 E0101@1:16 E0101@1:19");
    expect_codes("let a = @@@;\nlet b = 1 \xE2\x88\x92 2;", "E0102@1:9 E0102@2:11");
    expect_codes("let a = 1; // \xFF\xFE", "E0102@1:15");
    expect_codes("let a = \"\\q\";", "E0102@1:10");
}

static void bytes_of_zero_are_reported(void **state)
{
    (void)state;
    static const char scene[] = "let a = 1;\0\"b\0c\"";
    Reading          *r       = read_bytes(scene, sizeof scene - 1);
    assert_string_equal(codes(r), "E0102@1:11 E0102@1:14");
    reading_free(r);
}

/* A picture or a program has nothing reported but the first byte. */
static void a_binary_file_is_one_mistake(void **state)
{
    (void)state;
    static const char scene[] = "\x89PNG\r\n\x1A\n\0\0\0\x0DIHDR\0\0\0\x20 $$ \xFF\xFE\nshow ?;";
    Reading          *r       = read_bytes(scene, sizeof scene - 1);
    assert_string_equal(codes(r), "E0102@1:1");
    reading_free(r);
}

/* ---- parser ---- */

/* Writes an expression with every operation in parentheses. */
static void write_grouped(const Syntax *syntax, Text *out)
{
    const char *op = token_kind_text(syntax->op);
    switch (syntax->kind) {
    case SYNTAX_NUMBER: text_number(out, syntax->number[0]); return;
    case SYNTAX_NAME: text_add(out, syntax->name); return;
    case SYNTAX_UNARY:
    case SYNTAX_BINARY:
    case SYNTAX_RANGE:
        text_add(out, "(");
        if (syntax->count == 2)
            write_grouped(syntax->children[0], out);
        text_format(out, "%.*s", (int)strlen(op) - 2, op + 1);
        write_grouped(syntax->children[syntax->count - 1], out);
        break;
    default:
        text_format(out, "(%s%s%s", syntax_kind_name(syntax->kind), syntax->name ? " " : "",
                    syntax->name ? syntax->name : "");
        for (uint32_t i = 0; i < syntax->count; i++) {
            text_add(out, " ");
            write_grouped(syntax->children[i], out);
        }
    }
    text_add(out, ")");
}

static void expect_grouping(const char *expression, const char *wanted)
{
    char scene[200];
    snprintf(scene, sizeof scene, "let a = %s;", expression);
    Reading *r = read_text(scene);
    assert_string_equal(codes(r), "");
    Text text = {.arena = &r->arena};
    write_grouped(r->file->children[0]->children[0], &text);
    assert_string_equal(text.bytes, wanted);
    reading_free(r);
}

static void operators_have_their_precedence(void **state)
{
    (void)state;
    expect_grouping("a | b - c", "(a|(b-c))");
    expect_grouping("a & b | c & d", "((a&b)|(c&d))");
    expect_grouping("a - b & c + d", "((a-b)&(c+d))");
    expect_grouping("-x^2", "(-(x^2))");
    expect_grouping("2^-x^2", "(2^(-(x^2)))");
    expect_grouping("2^3^4", "(2^(3^4))");
    expect_grouping("-a * b", "((-a)*b)");
    expect_grouping("a * b / c % d", "(((a*b)/c)%d)");
    expect_grouping("a - b - c", "((a-b)-c)");
    expect_grouping("0..n + 1", "(0..(n+1))");
    expect_grouping("a | b .. c", "((a|b)..c)");
    expect_grouping("a + 1 == b * 2", "((a+1)==(b*2))");
    expect_grouping("not a == b and c or d", "(((not(a==b))andc)ord)");
    expect_grouping("a or b and not not c", "(aor(band(not(notc))))");
    expect_grouping("(a + b) * c", "((a+b)*c)");
    expect_grouping("a.b(c)[d]^2", "((index (method b a (argument c)) d)^2)");
    expect_grouping("f(a, b: c)(d)", "(call (call f (argument a) (argument b c)) (argument d))");
    expect_grouping("p.x", "(method x p)");
    expect_grouping("a.shape.use(image: 1)", "(method use (method shape a) (argument image 1))");
    expect_grouping("if a then b else c + d", "(if then else a b (c+d))");
    expect_grouping("let b = 1 in b + let1", "(let in b 1 (b+let1))");
    expect_grouping("[i for i in a for j in b if c]",
                    "(comprehension i (for clause i a) (for clause j b) (if clause c))");
    expect_grouping("[if a then b else c for i in d]",
                    "(comprehension (if then else a b c) (for clause i d))");
    expect_grouping("[a, b,]", "(list a b)");
    expect_grouping("krs { kernel a; reflect reflect(b); mobius c * d; let e = 1; }",
                    "(krs (kernel a) (reflect (call reflect (argument b)))"
                    " (mobius (c*d)) (let e 1))");
}

static void the_tree_is_printed(void **state)
{
    (void)state;
    Reading *r    = read_text("param a = 30deg in [0, #ffffff];\n"
                                 "shape s(r = 1) { light: -r, }\n"
                                 "for i in 0..2 { if true { show \"t\"; } else { } }");
    Text     text = {.arena = &r->arena};
    syntax_print(r->file, &r->sources, &text);
    assert_string_equal(text.bytes, "block 1:1\n"
                                    "  param a 1:1\n"
                                    "    number 0.5235987755982988 1:11\n"
                                    "    list 1:20\n"
                                    "      number 0 1:21\n"
                                    "      colour 1 1 1 1:24\n"
                                    "  shape s 2:1\n"
                                    "    parameter r 2:9\n"
                                    "      number 1 2:13\n"
                                    "    property light 2:18\n"
                                    "      unary `-` 2:25\n"
                                    "        name r 2:26\n"
                                    "  for i 3:1\n"
                                    "    range 3:10\n"
                                    "      number 0 3:10\n"
                                    "      number 2 3:13\n"
                                    "    block 3:15\n"
                                    "      if 3:17\n"
                                    "        boolean true 3:20\n"
                                    "        block 3:25\n"
                                    "          show 3:27\n"
                                    "            string \"t\" 3:32\n"
                                    "        block 3:44\n");
    reading_free(r);
}

static void every_mistake_is_reported_once(void **state)
{
    (void)state;
    expect_codes("let a = 1 +;\nlet b = ;\nlet c = 2;\nshow a b;",
                 "E0101@1:12 E0101@2:9 E0101@4:8");
    expect_codes("let a = 1\nlet b = 2\n", "E0101@1:10 E0101@2:10");
    expect_codes("camera { eye: [1, 2 3], fov: 1 2, up: 3 }\nlet = 3;",
                 "E0101@1:21 E0101@1:32 E0101@2:5");
    expect_codes("camera { eye = 1; target: 2 fov: 3 }", "E0101@1:14 E0101@1:17 E0101@1:28");
    expect_codes("let k = krs { kernel; reflect 2 3; kernel a; foo; };\nlet b = ;",
                 "E0101@1:21 E0101@1:33 E0101@1:46 E0101@2:9");
    expect_codes("for i of 0..3 { show i; }\nif a then b; \nlet c = ;",
                 "E0101@1:7 E0101@2:6 E0101@3:9");
    expect_codes("}\nfoo bar;\nlet image = 2;", "E0101@1:1 E0101@2:1 E0101@3:5");
    expect_codes("let a = if b then c;", "E0101@1:20");
    expect_codes("let a = 5 deg;", "E0101@1:11");
    expect_codes("let a = let b = 1;", "E0101@1:18");
    expect_codes("let a = 1 in 2;", "E0101@1:11");
    expect_codes("show f(a: 1, 2);", "E0101@1:14");
}

static void what_is_meant_is_understood(void **state)
{
    (void)state;
    expect_codes("a = 3;", "E0101@1:1");
    expect_codes("let a: 3;", "E0101@1:6");
    expect_codes("show f(r = 3);", "E0101@1:10");
    expect_codes("let a = if b = 1 then 2 else 3;", "E0101@1:14");
    expect_codes("def f(a: 1) = a;", "E0101@1:8");
    expect_codes("image { };;", "W0301@1:10 W0301@1:11");
    expect_codes("let a = b < c < d == e;", "E0106@1:15 E0106@1:19");
}

static void brackets_are_blamed_where_they_open(void **state)
{
    (void)state;
    expect_codes("show sphere(1;\nlet a = [1, 2;", "E0103@1:12 E0103@2:9");
    expect_codes("show f((1];", "E0103@1:8");
    expect_codes("let a = krs {\n  kernel a;\nshow a;\nlet b = ;", "E0103@1:13 E0101@4:9");
    expect_codes("for i in 0..3 {\n  if a {\n show b;\n}\nparam c = 1;", "E0103@1:15");
    expect_codes("material m {\n  color: 1\nshow a;", "E0103@1:12");
    expect_codes("let a = krs { show b; };", "E0101@1:15");
    expect_codes("show ((((", "E0101@1:10");
}

/* `count` times `piece` between two other texts. */
static Reading *read_repeated(const char *before, const char *piece, size_t count,
                              const char *after)
{
    size_t length = strlen(piece);
    char  *text   = malloc(strlen(before) + count * length + strlen(after) + 1);
    char  *end    = stpcpy(text, before);
    for (size_t i = 0; i < count; i++)
        end = stpcpy(end, piece);
    stpcpy(end, after);
    Reading *r = read_text(text);
    free(text);
    return r;
}

static void expect_too_deep(const char *before, const char *piece, size_t count, const char *after,
                            bool too_deep)
{
    Reading *r = read_repeated(before, piece, count, after);
    assert_int_equal(r->diags.count, too_deep);
    if (too_deep)
        assert_int_equal(r->diags.items[0]->code, DIAG_TOO_DEEP);
    reading_free(r);
}

static void nesting_is_limited(void **state)
{
    (void)state;
    expect_too_deep("let a = ", "-", 200, "1;", false);
    expect_too_deep("let a = ", "-", 201, "1;", true);
    expect_too_deep("let a = ", "(", 100000, "1;", true);
    expect_too_deep("let a = ", "f([", 100000, "1;", true);
    expect_too_deep("let a = ", "2^", 100000, "1;", true);
    expect_too_deep("let a = ", "if 1 then 2 else ", 100000, "1;", true);
    expect_too_deep("let a = ", "krs { kernel ", 1000, "1;", true);
    expect_too_deep("", "if a { ", 1000, "", true);
    expect_too_deep("let a = 1", "+1", 999, ";", false);
    expect_too_deep("let a = 1", "+1", 1000, ";", true);
    expect_too_deep("let a = 1", "+1", 100000, ";", true);
    expect_too_deep("let a = 1", ".b", 100000, ";", true);
    expect_too_deep("let a = 1", "[0]", 100000, ";", true);
    expect_too_deep("let a = [1", ", 1", 100000, "];", false);
}

static void brackets_nest_200_deep(void **state)
{
    (void)state;
    for (int depth = 199; depth <= 201; depth++) {
        char text[420] = "let a = ";
        memset(text + 8, '[', (size_t)depth);
        memset(text + 8 + depth, ']', (size_t)depth);
        strcpy(text + 8 + 2 * depth, ";");
        Reading *r = read_text(text);
        assert_int_equal(r->diags.count, depth > 200);
        reading_free(r);
    }
}

static void many_mistakes_are_cut_short(void **state)
{
    (void)state;
    Reading *r = read_repeated("", "let a = ;\n", 19, "");
    assert_int_equal(r->diags.errors, 19);
    reading_free(r);
    r = read_repeated("", "let a = ;\n", 100000, "");
    assert_int_equal(r->diags.count, MAX_DIAGS);
    assert_true(r->diags.errors > MAX_DIAGS);
    Text text = {.arena = &r->arena};
    diags_print_text(&r->diags, false, &text);
    assert_non_null(strstr(text.bytes, "\ntoo many errors, the first 20 are shown\n"));
    reading_free(r);
}

/* ---- names ---- */

static void names_are_found(void **state)
{
    (void)state;
    expect_name_codes("show a;\nlet a = b;\nlet b = 1;", "");
    expect_name_codes("show sphre(1);\nlet a = bar + baz;\nlet b = bar;",
                      "E0201@1:6 E0201@2:9 E0201@2:15");
    expect_name_codes("def f(a, b = a) = a + b + c;", "E0201@1:27");
    expect_name_codes("def f(a = b, b = 1) = a;", "E0201@1:11");
    expect_name_codes("let l = [i + j for i in [1] for j in [i] if j > i];\nlet m = i;",
                      "E0201@2:9");
    expect_name_codes("let l = [1 for i in [i]];", "E0201@1:22");
    expect_name_codes("let l = let q = 1 in q;\nshow q;", "E0201@2:6");
    expect_name_codes("for i in [1] { let j = i; show j; }\nshow j;", "E0201@2:6");
    expect_name_codes("let k = krs { kernel a; let a = sphere(1); kernel a; };", "E0201@1:22");
    expect_name_codes("shape s(r = 1) { distance: r, within: q }", "E0201@1:39");
    expect_name_codes("material m { color: 1 }\nlight sun { size: m }\nsky { sun: sun }", "");
    expect_name_codes("show pi.unknown(a_name: 1);", "");
}

/* "a@1:5 a@2:9=1:5": where names stand, and behind a use what it means there. */
static const char *uses_of(Reading *r)
{
    Text text = {.arena = &r->arena};
    check_all_names(r);
    for (size_t i = 0; i < r->uses.count; i++) {
        const NameUse *use    = &r->uses.items[i];
        const Source  *source = &r->sources.items[use->span.source];
        Position       at     = source_position(source, use->span.start);
        text_format(&text, "%s%s@%u:%u", i ? " " : "", use->name, at.line, at.column);
        if (use->defines || !use->meaning)
            text_add(&text, use->defines ? "" : "=");
        else {
            at = source_position(source, use->meaning->name_span.start);
            text_format(&text, "=%u:%u", at.line, at.column);
        }
    }
    return text.bytes;
}

static void meanings_of_names_are_told(void **state)
{
    static const char *const rows[][2] = {
        {"let a = 1;\nlet b = a + pi;", "a@1:5 b@2:5 a@2:9=1:5 pi@2:13="},
        {"let b = c;\nlet c = 1;", "b@1:5 c@2:5 c@1:9=2:5"},
        {"let a = let a = 2 in a;", "a@1:5 a@1:13 a@1:22=1:13"},
        {"let l = [i for i in a if i];\nlet a = 1;",
         "l@1:5 a@2:5 a@1:21=2:5 i@1:16 i@1:26=1:16 i@1:10=1:16"},
        {"def f(a, b = a) = b;\nlet c = f(b: 1, d: 2);",
         "f@1:5 c@2:5 a@1:7 a@1:14=1:7 b@1:10 b@1:19=1:10 b@2:11=1:10 f@2:9=1:5"},
        {"for i in 0..2 { let q = i; show q; }", "i@1:5 i@1:25=1:5 q@1:21 q@1:33=1:21"},
        {"let a = nothing + a.nothing;", "a@1:5 a@1:19=1:5"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        Reading *r = read_text(rows[i][0]);
        assert_string_equal(uses_of(r), rows[i][1]);
        reading_free(r);
    }
}

static void duplicates_are_reported(void **state)
{
    (void)state;
    expect_name_codes("let a = 1;\ndef a() = 2;", "E0202@2:5");
    expect_name_codes("def f(a, a) = a;", "E0202@1:10");
    expect_name_codes("camera { eye: 1, eye: 2 }", "E0202@1:18");
    expect_name_codes("let a = 1;\nlet b = [a for a in [1]];\ndef f(a) = let a = a in a;", "");
    expect_name_codes("let sphere = 1;", "");
    expect_name_codes("for i in [1] { let j = i; let j = 2; let i = 3; }", "E0202@1:31");
}

static void circles_are_reported(void **state)
{
    (void)state;
    expect_name_codes("let a = a;", "E0203@1:5");
    expect_name_codes("let a = b;\nlet b = c;\nlet c = a;", "E0203@1:5");
    expect_name_codes("def f(n) = if n > 0 then g(n - 1) else 0;\ndef g(n) = f(n);", "");
    expect_name_codes("def f(n) = f(n) + a;\nlet a = f(1);", "E0203@2:5");
    expect_name_codes("shape s(r = 1) { distance: r, example: s(2) }", "");
    expect_name_codes("let a = b + b;\nlet b = 1;\nlet c = c;\nlet d = a + c;", "E0203@3:5");
    expect_name_codes("let a = let a = 1 in a;", "");
}

static void long_chains_need_no_stack(void **state)
{
    (void)state;
    enum { COUNT = 100000 };
    for (int closed = 0; closed < 2; closed++) {
        Reading *writing = reading_new();
        Text     text    = {.arena = &writing->arena};
        for (int i = 0; i < COUNT; i++)
            text_format(&text, "let n%d = n%d;\n", i, i + 1);
        text_format(&text, "let n%d = %s;\n", COUNT, closed ? "n0" : "1");
        Reading *r = read_text(text.bytes);
        check_all_names(r);
        assert_string_equal(codes(r), closed ? "E0203@1:5" : "");
        reading_free(r);
        reading_free(writing);
    }
}

static void hidden_coordinates_are_warned_of(void **state)
{
    (void)state;
    expect_name_codes("let x = 1;\ndef f(u) = [p for p in [u]];\nlet t = 2;",
                      "W0201@1:5 W0201@2:7 W0201@2:19");
}

static void one_mistake_does_not_make_another(void **state)
{
    (void)state;
    expect_name_codes("let a = ;\nshow a;", "E0101@1:9");
    expect_name_codes("dfe f(a) = 1;\nshow f(1);", "E0101@1:1");
    expect_name_codes("let a = [i + for i in [1]];", "E0101@1:14");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tokens_are_split),
        cmocka_unit_test(numbers_are_read),
        cmocka_unit_test(numbers_do_not_depend_on_the_locale),
        cmocka_unit_test(colours_become_linear),
        cmocka_unit_test(strings_are_unescaped),
        cmocka_unit_test(comments_document),
        cmocka_unit_test(bad_text_is_reported),
        cmocka_unit_test(bytes_of_zero_are_reported),
        cmocka_unit_test(a_binary_file_is_one_mistake),
        cmocka_unit_test(operators_have_their_precedence),
        cmocka_unit_test(the_tree_is_printed),
        cmocka_unit_test(every_mistake_is_reported_once),
        cmocka_unit_test(what_is_meant_is_understood),
        cmocka_unit_test(brackets_are_blamed_where_they_open),
        cmocka_unit_test(nesting_is_limited),
        cmocka_unit_test(brackets_nest_200_deep),
        cmocka_unit_test(many_mistakes_are_cut_short),
        cmocka_unit_test(names_are_found),
        cmocka_unit_test(meanings_of_names_are_told),
        cmocka_unit_test(duplicates_are_reported),
        cmocka_unit_test(circles_are_reported),
        cmocka_unit_test(long_chains_need_no_stack),
        cmocka_unit_test(hidden_coordinates_are_warned_of),
        cmocka_unit_test(one_mistake_does_not_make_another),
    };
    return cmocka_run_group_tests_name("front end", tests, NULL, NULL);
}
