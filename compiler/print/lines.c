/*
 * lines.c: lines of code, comments of where they come from, literals.
 *
 * A line may name alternatives of the printer.  They are written out when the line is whole, so that
 * expressions are as long as their names, whatever is chosen.
 */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "compiler/print/emitter.h"

/* ---- alternatives ---- */

static void write_out(Emitter *e, Text *to, const char *text, size_t length);

/* Finds the alternative that is called at `text`, or NULL. */
static const Alternative *find_alternative(const Emitter *e, const char *text, size_t length)
{
    for (const Alternative *alternative = e->printer->alternatives; alternative->name;
         alternative++) {
        size_t name = strlen(alternative->name);
        if (name < length && strncmp(text, alternative->name, name) == 0 && text[name] == '(')
            return alternative;
    }
    return NULL;
}

/* Returns the length of an operand, up to a comma or a parenthesis that ends it. */
static size_t operand_length(const char *text, size_t length)
{
    size_t at = 0;
    for (int depth = 0; at < length; at++) {
        if (depth == 0 && (text[at] == ',' || text[at] == ')'))
            break;
        depth += (text[at] == '(') - (text[at] == ')');
    }
    return at;
}

/* Writes an alternative between two operands out; returns the length of what stood for it. */
static size_t write_alternative(Emitter *e, Text *to, const Alternative *alternative,
                                const char *text, size_t length)
{
    const char *form          = e->variant->many_threads ? alternative->threads : alternative->few;
    size_t      first         = strlen(alternative->name) + 1;
    size_t      first_length  = operand_length(text + first, length - first);
    size_t      second        = first + first_length + 2; /* behind a comma and a blank */
    size_t      second_length = operand_length(text + second, length - second);
    while (*form) {
        size_t plain = strcspn(form, "$");
        text_add_bytes(to, form, plain);
        form += plain;
        if (!*form)
            break;
        if (form[1] == 'a')
            write_out(e, to, text + first, first_length);
        else
            write_out(e, to, text + second, second_length);
        form += 2;
    }
    return second + second_length + 1;
}

static void write_out(Emitter *e, Text *to, const char *text, size_t length)
{
    size_t plain = 0; /* before what is looked at */
    for (size_t at = 0; at < length;) {
        const Alternative *alternative = text[at] == 'K'
                                             ? find_alternative(e, text + at, length - at)
                                             : NULL;
        if (!alternative) {
            at++;
            continue;
        }
        text_add_bytes(to, text + plain, at - plain);
        at += write_alternative(e, to, alternative, text + at, length - at);
        plain = at;
    }
    text_add_bytes(to, text + plain, length - plain);
}

void emit_line(Emitter *e, const char *format, ...)
{
    va_list arguments;
    size_t  start = e->out->length;
    va_start(arguments, format);
    text_format_list(e->out, format, arguments);
    va_end(arguments);
    if (!strstr(e->out->bytes + start, "KRS_"))
        return;
    size_t length  = e->out->length - start;
    char  *line    = arena_copy_text(e->scratch, e->out->bytes + start, length);
    e->out->length = start;
    write_out(e, e->out, line, length);
}

/* ---- templates ---- */

const char *template_text(Emitter *e, TextTemplate template, const Operands operands)
{
    Text text = {.arena = e->scratch};
    for (const char *words = e->printer->templates[template]; *words;) {
        size_t plain = strcspn(words, "$");
        text_add_bytes(&text, words, plain);
        words += plain;
        if (*words) {
            text_add(&text, operands[words[1] - 'a']);
            words += 2;
        }
    }
    return text.length > 0 ? text.bytes : "";
}

void emit_template(Emitter *e, TextTemplate template, const Operands operands)
{
    emit_line(e, "%s", template_text(e, template, operands));
}

void emit_local(Emitter *e, GraphType type, const char *name, const char *value)
{
    emit_template(e, TEMPLATE_LOCAL, (Operands){e->printer->types[type], name, value});
}

void emit_variable(Emitter *e, GraphType type, const char *name, const char *value)
{
    emit_template(e, TEMPLATE_VARIABLE, (Operands){e->printer->types[type], name, value});
}

/* ---- literals ---- */

/* Adds the shortest literal that reads back as the float nearest to the number. */
static void add_literal(Text *text, double number)
{
    char   digits[40];
    double limited = fmax(-FLT_MAX, fmin(number, FLT_MAX));
    float  single  = (float)limited;
    for (int precision = 6; precision <= 9; precision++) {
        snprintf(digits, sizeof digits, "%.*g", precision, (double)single);
        float back;
        if (sscanf(digits, "%f", &back) == 1 && back == single)
            break;
    }
    const bool bare = strspn(digits, "-0123456789") == strlen(digits);
    text_add(text, single < 0 ? "(" : "");
    text_printed_number(text, digits);
    text_add(text, bare ? ".0" : "");
    text_add(text, single < 0 ? ")" : "");
}

const char *emit_constant(Emitter *e, const Expr *expr)
{
    Text text = {.arena = e->scratch};
    if (expr->type == TYPE_BOOL)
        return expr->number[0] != 0 ? "true" : "false";
    if (expr->type == TYPE_UINT) {
        text_format(&text, "%.0fu", expr->number[0]);
        return text.bytes;
    }
    if (expr->type > TYPE_FLOAT)
        text_format(&text, "%s(", e->printer->types[expr->type]);
    bool equal = true;
    for (uint32_t i = 1; i < expr->type; i++)
        equal = equal && expr->number[i] == expr->number[0];
    for (uint32_t i = 0; i < (equal ? 1u : expr->type); i++) {
        if (i)
            text_add(&text, ", ");
        add_literal(&text, expr->number[i]);
    }
    if (expr->type > TYPE_FLOAT)
        text_add(&text, ")");
    return text.bytes;
}

const char *emit_number(Emitter *e, double number)
{
    Text text = {.arena = e->scratch};
    add_literal(&text, number);
    return text.bytes;
}

const char *emit_count(Emitter *e, size_t count)
{
    Text text = {.arena = e->scratch};
    text_format(&text, "%zu", count);
    return text.bytes;
}

const char *emit_vector(Emitter *e, const double v[3])
{
    Expr constant = {.op = OP_CONSTANT, .type = TYPE_VEC3, .number = {v[0], v[1], v[2]}};
    return emit_constant(e, &constant);
}

/* Adds the name of a file, which may be any: what would end the comment, in WGSL any end of a line of Unicode,
   or the text, is shown as `?`. */
static void add_file_name(Text *out, const char *name)
{
    size_t left = strlen(name), length;
    for (; left > 0; name += length, left -= length) {
        uint32_t   character;
        const bool coded = (length = text_character(name, left, &character)) > 0;
        const bool shown = coded && character >= ' ' && character != 0x7f && character != 0x85 &&
                           character != 0x2028 && character != 0x2029;
        length = coded ? length : 1;
        text_add_bytes(out, shown ? name : "?", shown ? length : 1);
    }
}

void emit_comment(Emitter *e, Span span)
{
    if (!span.source)
        return;
    const Source *source = &e->module->sources.items[span.source];
    uint32_t      line   = source->library ? 0 : source_line(source, span.start);
    if (e->last.source == span.source && e->last.start == line)
        return;
    e->last = (Span){span.source, line, 0};
    text_add(e->out, "    // ");
    add_file_name(e->out, source->name);
    if (source->library)
        text_add(e->out, "\n");
    else
        text_format(e->out, ":%u\n", line);
}

const char *emit_slot(Emitter *e, uint32_t slot, uint32_t first, uint32_t width)
{
    Text text = {.arena = e->scratch};
    text_format(&text, width == 4 ? "krs_parameter[%u]" : "krs_parameter[%u].%.*s", slot,
                (int)width, &"xyzw"[first]);
    return text.bytes;
}

const char *emit_bare(Emitter *e, const char *text)
{
    size_t   length = strlen(text);
    uint32_t open   = 0;
    if (text[0] != '(')
        return text;
    for (size_t i = 0; i < length; i++) {
        open += text[i] == '(';
        open -= text[i] == ')';
        if (open == 0 && i + 1 < length)
            return text;
    }
    return arena_copy_text(e->scratch, text + 1, length - 2);
}
