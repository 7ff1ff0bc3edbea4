/*
 * spell.c: functions and expressions of print/glsl in WGSL: the same formulas need not be written twice.
 *
 * Both languages are of C's family.  A text is read once from left to right; what WGSL says in other words is
 * said in them: types and where they stand, choices, statements without braces, a dozen functions of one
 * name.  README.md says what else helpers have to keep to.
 */
#include "compiler/print/wgsl/spell.h"

#include <assert.h>
#include <ctype.h>
#include <string.h>

/* A part of the text. */
typedef struct Part {
    const char *from, *end;
} Part;

typedef struct Variable {
    Part name, type;
} Variable;

enum { MAX_VARIABLES = 48 };

typedef struct Speller {
    const char *at, *begin, *end; /* where it reads */
    Text       *out;
    Variable    variables[MAX_VARIABLES]; /* of the function, with their types in GLSL */
    size_t      count;
} Speller;

static const struct {
    const char *glsl, *wgsl;
} types[] = {
    {"float", "f32"},        {"int", "i32"},          {"uint", "u32"},         {"vec2", "vec2f"},
    {"vec3", "vec3f"},       {"vec4", "vec4f"},       {"ivec2", "vec2i"},      {"ivec3", "vec3i"},
    {"ivec4", "vec4i"},      {"uvec2", "vec2u"},      {"uvec3", "vec3u"},      {"uvec4", "vec4u"},
    {"bvec2", "vec2<bool>"}, {"bvec3", "vec3<bool>"}, {"bvec4", "vec4<bool>"},
};

/* ---- parts of texts ---- */

static Part part(const char *from, const char *end) { return (Part){from, end}; }

static bool is(Part p, const char *word)
{
    return strlen(word) == (size_t)(p.end - p.from) && strncmp(p.from, word, strlen(word)) == 0;
}

static bool is_of_word(char c) { return isalnum((unsigned char)c) || c == '_' || c == '$'; }

static Part word_at(const char *from, const char *end)
{
    const char *at = from;
    while (at < end && is_of_word(*at))
        at++;
    return part(from, at);
}

static Part trimmed(Part p)
{
    while (p.from < p.end && isspace((unsigned char)*p.from))
        p.from++;
    while (p.from < p.end && isspace((unsigned char)p.end[-1]))
        p.end--;
    return p;
}

/* Returns the first of these characters that stands in no parentheses, or the end. */
static const char *find(Part p, const char *characters)
{
    int depth = 0;
    for (const char *at = p.from; at < p.end; at++) {
        if (depth == 0 && strchr(characters, *at))
            return at;
        depth += strchr("([{", *at) != NULL;
        depth -= strchr(")]}", *at) != NULL;
    }
    return p.end;
}

/* Returns what is in the parentheses, brackets or braces that begin here. */
static Part inside(const char *open, const char *end)
{
    return part(open + 1, find(part(open + 1, end), ")]}"));
}

static void add(Speller *s, Part p) { text_add_bytes(s->out, p.from, (size_t)(p.end - p.from)); }

/* Returns the part before a separator; p is what is behind it then. */
static Part take(Part *p, const char *separator)
{
    const char *end   = find(*p, separator);
    const Part  first = part(p->from, end);
    p->from           = end < p->end ? end + 1 : end;
    return first;
}

/* ---- types ---- */

static const char *type_name(Part type)
{
    for (size_t i = 0; i < sizeof types / sizeof *types; i++)
        if (is(type, types[i].glsl))
            return types[i].wgsl;
    return NULL;
}

static void add_word(Speller *s, Part word)
{
    const char *type = type_name(word);
    if (type)
        text_add(s->out, type);
    else
        add(s, word);
}

static void remember(Speller *s, Part name, Part type)
{
    assert(s->count < MAX_VARIABLES);
    s->variables[s->count++] = (Variable){name, type};
}

/* Returns the type of a variable, or the function that is called; nothing: no more is known of an
   expression. */
static Part type_of(const Speller *s, Part p)
{
    p               = trimmed(p);
    const Part word = word_at(p.from, p.end);
    if (word.end < p.end && *word.end == '(' && inside(word.end, p.end).end + 1 == p.end)
        return word;
    for (size_t i = s->count; i-- > 0;) {
        const Part name = s->variables[i].name;
        if (word.end == p.end && name.end - name.from == word.end - word.from &&
            strncmp(name.from, word.from, (size_t)(word.end - word.from)) == 0)
            return s->variables[i].type;
    }
    return part(p.from, p.from);
}

/* Returns how many components a part has, as far as that is known. */
static int size_of(const Speller *s, Part p)
{
    const Part  type = type_of(s, p);
    const char *name = type_name(type);
    return name && strncmp(name, "vec", 3) == 0 ? name[3] - '0' : 1;
}

static bool is_truth(const Speller *s, Part p)
{
    const Part type = type_of(s, p);
    if (type.from < type.end)
        return is(type, "bool") || strncmp(type.from, "bvec", 4) == 0 || is(type, "all") ||
               is(type, "any");
    return find(p, "<>=!&|") < p.end;
}

static bool is_number(Part p)
{
    p = trimmed(p);
    return p.from < p.end && strspn(p.from, "-0123456789.e") >= (size_t)(p.end - p.from);
}

/* ---- expressions ---- */

static void spell_expression(Speller *s, Part p);

/* Returns the text of a part by itself. */
static const char *spelled(Speller *s, Part p)
{
    Text text = {.arena = s->out->arena}, *out = s->out;
    text_add(&text, "");
    s->out = &text;
    spell_expression(s, trimmed(p));
    s->out = out;
    return text.bytes;
}

/* Spells expressions with commas between. */
static void spell_list(Speller *s, Part p)
{
    while (p.from < p.end) {
        Part one = take(&p, ",");
        spell_expression(s, one);
        text_add(s->out, p.from < p.end ? "," : "");
    }
}

/* Functions that have another name in WGSL, or are no functions there; $T is a type of as many numbers as the
   operand has. */
static const struct {
    const char *glsl, *wgsl;
} calls[] = {
    {"inversesqrt", "inverseSqrt($a)"},
    {"floatBitsToUint", "bitcast<u32>($a)"},
    {"unpackHalf2x16", "unpack2x16float($a)"},
    {"uintBitsToFloat", "bitcast<$T>($a)"},
    {"greaterThan", "($a > $b)"},
    {"lessThan", "($a < $b)"},
    {"greaterThanEqual", "($a >= $b)"},
};

static const char *const of_numbers[] = {NULL, "f32", "vec2f", "vec3f", "vec4f"};

static const char *template_of(const Speller *s, Part name, const Part operands[3])
{
    if (is(name, "mix") && is_truth(s, operands[2]))
        return "select($a, $b, $c)";
    for (size_t i = 0; i < sizeof calls / sizeof *calls; i++)
        if (is(name, calls[i].glsl))
            return calls[i].wgsl;
    return NULL;
}

static void fill(Speller *s, const char *words, const Part operands[3])
{
    while (*words) {
        const size_t plain = strcspn(words, "$");
        text_add_bytes(s->out, words, plain);
        words += plain;
        if (*words) {
            text_add(s->out, words[1] == 'T' ? of_numbers[size_of(s, operands[0])]
                                             : spelled(s, operands[words[1] - 'a']));
            words += 2;
        }
    }
}

/* Tells whether operands have one type: a number beside a vector becomes one. */
static bool has_one_type(Part name)
{
    return is(name, "min") || is(name, "max") || is(name, "clamp");
}

static void spell_call(Speller *s, Part name, Part list)
{
    Part        operands[3] = {{0}}, rest = list;
    const char *separator = "";
    for (int i = 0; i < 3 && rest.from < rest.end; i++)
        operands[i] = take(&rest, ",");
    const char *words = template_of(s, name, operands);
    const int   size  = has_one_type(name) ? size_of(s, operands[0]) : 1;
    if (words) {
        fill(s, words, operands);
        return;
    }
    add_word(s, name);
    text_add(s->out, "(");
    for (int i = 0; i < 3 && size > 1 && operands[i].from; i++, separator = ", ")
        text_format(s->out, is_number(operands[i]) ? "%s%s(%s)" : "%s%.0s%s", separator,
                    of_numbers[size], spelled(s, operands[i]));
    if (size == 1)
        spell_list(s, list);
    text_add(s->out, ")");
}

/* Spells what is no choice: operators, numbers and names stay; what is in parentheses is an expression. */
static void spell_terms(Speller *s, Part p)
{
    while (p.from < p.end) {
        const Part word = word_at(p.from, p.end);
        const bool open = word.end < p.end && (*word.end == '(' || *word.end == '[');
        const Part list = open ? inside(word.end, p.end) : word;
        if (open && *word.end == '(' && word.from < word.end)
            spell_call(s, word, list);
        else
            add(s, part(word.from, open ? word.end + 1 : word.end));
        if (open && !(*word.end == '(' && word.from < word.end)) {
            spell_list(s, list);
            add(s, part(list.end, list.end + 1));
        }
        p.from = open ? list.end + 1 : word.end;
        if (!open && p.from < p.end) {
            add(s, part(p.from, p.from + 1));
            p.from++;
        }
    }
}

/* Returns the colon of a choice, whose first part may be another one. */
static const char *find_colon(Part p)
{
    for (int choices = 0;; p.from++) {
        p.from = find(p, "?:");
        assert(p.from < p.end);
        if (*p.from == ':' && choices-- == 0)
            return p.from;
        choices += *p.from == '?';
    }
}

static void spell_expression(Speller *s, Part p)
{
    const char *question = find(p, "?");
    if (question == p.end) {
        spell_terms(s, p);
        return;
    }
    const char *colon = find_colon(part(question + 1, p.end));
    add(s, part(p.from, trimmed(p).from));
    text_format(s->out, "select(%s, ", spelled(s, part(colon + 1, p.end)));
    text_format(s->out, "%s, ", spelled(s, part(question + 1, colon)));
    text_format(s->out, "%s)", spelled(s, part(p.from, question)));
}

/* ---- statements ---- */

static void spell_statement(Speller *s);

/* Copies blanks and comments. */
static void pass_blanks(Speller *s)
{
    const char *from = s->at;
    for (bool more = true; more;) {
        while (s->at < s->end && isspace((unsigned char)*s->at))
            s->at++;
        more = strncmp(s->at, "//", 2) == 0;
        if (more)
            s->at = find(part(s->at, s->end), "\n");
    }
    add(s, part(from, s->at));
}

static Part next_word(const Speller *s) { return word_at(s->at, s->end); }

/* Returns the blanks that the line at hand begins with. */
static Part indentation(const Speller *s)
{
    const char *line = s->at;
    while (line > s->begin && line[-1] != '\n')
        line--;
    return part(line, line + strspn(line, " "));
}

/* Spells what belongs to a head, in braces. */
static void spell_body(Speller *s, Part indent)
{
    const bool block = s->at[strspn(s->at, " \n")] == '{';
    text_add(s->out, block ? "" : " {");
    pass_blanks(s);
    spell_statement(s);
    if (block)
        return;
    text_add(s->out, "\n");
    add(s, indent);
    text_add(s->out, "}");
}

/* Spells "vec3 a = b, c, d[4]". */
static void spell_declaration(Speller *s, Part p)
{
    const Part  type = word_at(p.from, p.end), indent = indentation(s);
    const char *separator = "";
    p                     = trimmed(part(type.end, p.end));
    while (p.from < p.end) {
        const Part  one = trimmed(take(&p, ",")), name = word_at(one.from, one.end);
        const char *equal = find(one, "=");
        const bool  array = name.end < one.end && *name.end == '[';
        text_add(s->out, separator);
        add(s, *separator ? indent : part(s->at, s->at));
        text_add(s->out, *name.from == '$' ? "let " : "var ");
        add(s, name);
        text_add(s->out, array ? ": array<" : ": ");
        add_word(s, type);
        if (array) {
            text_add(s->out, ", ");
            add(s, inside(name.end, one.end));
            text_add(s->out, ">");
        }
        if (equal < one.end)
            text_format(s->out, " = %s", spelled(s, part(equal + 1, one.end)));
        remember(s, name, type);
        separator = ";\n";
    }
}

/* Spells what may stand before a semicolon: a declaration, an assignment, an expression. */
static void spell_simple(Speller *s, Part p)
{
    const Part word = word_at(p.from, p.end);
    if (is(word, "return")) {
        add(s, word);
        spell_expression(s, part(word.end, p.end));
        return;
    }
    if (word.from < word.end && word.end < p.end && *word.end == ' ' && is_of_word(word.end[1])) {
        spell_declaration(s, p);
        return;
    }
    const char *equal = find(p, "=");
    if (equal < p.end && equal[1] != '=' && equal > p.from && !strchr("<>!=", equal[-1])) {
        spell_terms(s, part(p.from, equal + 1));
        spell_expression(s, part(equal + 1, p.end));
        return;
    }
    spell_expression(s, p);
}

/* Spells "(int i = 0; i < 4; i++)", or a condition. */
static void spell_head(Speller *s)
{
    pass_blanks(s);
    Part p = inside(s->at, s->end);
    text_add(s->out, "(");
    s->at = p.end + 1;
    while (p.from < p.end) {
        const Part one = take(&p, ";");
        add(s, part(one.from, trimmed(one).from));
        spell_simple(s, trimmed(one));
        text_add(s->out, p.from < p.end ? ";" : "");
    }
    text_add(s->out, ")");
}

static void spell_block(Speller *s)
{
    const char *end = inside(s->at, s->end).end;
    text_add(s->out, "{");
    for (s->at++, pass_blanks(s); s->at < end; pass_blanks(s))
        spell_statement(s);
    text_add(s->out, "}");
    s->at = end + 1;
}

/* Spells "vec3 krs_cell(vec3 p, float count)", and the block behind it. */
static void spell_function(Speller *s, Part type, Part name)
{
    Part        parameters = inside(name.end, s->end);
    const char *separator  = "";
    s->at                  = parameters.end + 1;
    text_add(s->out, "fn ");
    add(s, name);
    text_add(s->out, "(");
    for (; parameters.from < parameters.end; separator = ", ") {
        const Part one = trimmed(take(&parameters, ",")), of = word_at(one.from, one.end);
        const Part called = trimmed(part(of.end, one.end));
        text_add(s->out, separator);
        add(s, called);
        text_add(s->out, ": ");
        add_word(s, of);
        remember(s, called, of);
    }
    text_add(s->out, ") -> ");
    add_word(s, type);
    pass_blanks(s);
    spell_block(s);
}

static void spell_controlled(Speller *s, Part word)
{
    const Part indent = indentation(s);
    add(s, word);
    s->at = word.end;
    if (!is(word, "else"))
        spell_head(s);
    spell_body(s, indent);
    const char *behind = s->at + strspn(s->at, " \n");
    if (!is(word, "if") || !is(word_at(behind, s->end), "else"))
        return;
    text_add(s->out, " ");
    s->at = behind;
    spell_controlled(s, next_word(s));
}

static void spell_statement(Speller *s)
{
    const Part word = next_word(s), name = word_at(word.end + (word.end < s->end), s->end);
    if (is(word, "if") || is(word, "for")) {
        spell_controlled(s, word);
        return;
    }
    if (*s->at == '{') {
        spell_block(s);
        return;
    }
    if (word.from < word.end && *word.end == ' ' && name.from < name.end && *name.end == '(' &&
        !is(word, "return")) {
        spell_function(s, word, name);
        return;
    }
    const char *end = find(part(s->at, s->end), ";");
    spell_simple(s, part(s->at, end));
    text_add(s->out, end < s->end ? ";" : "");
    s->at = end < s->end ? end + 1 : end;
}

void wgsl_spell(const char *text, size_t length, GraphType type, Text *out)
{
    static const char operands[] = "$a$b$c$d";
    const char       *name       = glsl_printer.types[type];
    Speller           s          = {.at = text, .begin = text, .end = text + length, .out = out};
    for (const char *at = operands; *at; at += 2)
        remember(&s, part(at, at + 2), part(name, name + strlen(name)));
    for (pass_blanks(&s); s.at < s.end; pass_blanks(&s))
        spell_statement(&s);
}
