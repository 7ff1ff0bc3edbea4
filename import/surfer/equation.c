/*
 * equation.c: the equation of a .jsurf file.
 *
 * It has the operators of the scenes' language, with the same precedence, so that it is copied sign
 * by sign once it is understood; only numbers and names may have to be written differently.
 */
#include "import/surfer/equation.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_DEPTH = 60 };

typedef struct Equation {
    JsurfSurface *surface;
    unsigned      line;
    const char   *start, *at;
    int           depth;
    Text          text; /* in the language of scenes: signs and factors are the same */
} Equation;

static bool refuse_equation(const Equation *equation, const char *what)
{
    int column = (int)(equation->at - equation->start) + 1;
    if (*equation->at == '\0')
        return import_refuse(equation->surface->import, equation->line,
                             "the equation ends where there should be %s", what);
    return import_refuse(equation->surface->import, equation->line,
                         "the equation has `%.10s` at place %d, where there should be %s",
                         equation->at, column, what);
}

static void skip_blanks(Equation *equation) { equation->at += strspn(equation->at, " \t\r\n\f"); }

/* Takes `sign` and the blanks around it. */
static bool accept_sign(Equation *equation, char sign)
{
    skip_blanks(equation);
    if (*equation->at != sign)
        return false;
    equation->at++;
    skip_blanks(equation);
    return true;
}

/* Reads a number.  The language wants digits on both sides of the point, SURFER does not: they are added. */
static bool parse_number(Equation *equation)
{
    char       *end;
    const char *start = equation->at;
    double      number;
    if (start[0] == '0' && (start[1] == 'x' || start[1] == 'X'))
        return refuse_equation(equation, "a decimal number");
    number = strtod(start, &end);
    if (end == start || !isfinite(number))
        return refuse_equation(equation, "a number");
    equation->at = end;
    text_number(&equation->text, number);
    return true;
}

static const char *const functions[] = {"sin", "cos",  "tan",  "asin",  "acos", "atan", "exp",
                                        "log", "sqrt", "ceil", "floor", "abs",  "sign"};
enum { FUNCTIONS = sizeof functions / sizeof *functions };

/* Adds a parameter's name in the scene: most names of the language are longer than a letter. */
static void add_parameter_name(Text *text, const char *name)
{
    bool is_free = name[1] == '\0' && isalpha((unsigned char)name[0]) && !strchr("puv", name[0]);
    text_format(text, "%s%s", is_free ? "" : "k_", name);
}

static bool use_parameter(Equation *equation, const char *name)
{
    JsurfSurface *surface = equation->surface;
    Text          key     = {.arena = surface->import->arena};
    text_format(&key, "surface_parameter_%s", name);
    const JsurfProperty *property = jsurf_property(surface, key.bytes);
    if (!property)
        return import_refuse(surface->import, equation->line,
                             "the equation uses `%.60s`, but there is no %.80s", name, key.bytes);
    add_parameter_name(&equation->text, name);
    for (size_t i = 0; i < surface->used_count; i++)
        if (surface->used[i] == property)
            return true;
    if (surface->used_count == MAX_PARAMETERS)
        return import_refuse(surface->import, equation->line, "more than %d parameters",
                             MAX_PARAMETERS);
    surface->used[surface->used_count++] = property;
    return true;
}

static bool parse_sum(Equation *equation);

static bool parse_parentheses(Equation *equation)
{
    if (!accept_sign(equation, '('))
        return refuse_equation(equation, "a parenthesis");
    text_add(&equation->text, "(");
    if (!parse_sum(equation))
        return false;
    if (!accept_sign(equation, ')'))
        return refuse_equation(equation, "an operator or a closing parenthesis");
    text_add(&equation->text, ")");
    return true;
}

static bool parse_name(Equation *equation)
{
    const char *start = equation->at;
    while (isalnum((unsigned char)*equation->at) || *equation->at == '_')
        equation->at++;
    size_t      length = (size_t)(equation->at - start);
    const char *name   = arena_copy_text(equation->surface->import->arena, start, length);
    skip_blanks(equation);
    if (*equation->at == '(') {
        for (size_t i = 0; i < FUNCTIONS; i++)
            if (strcmp(functions[i], name) == 0) {
                text_add(&equation->text, name);
                return parse_parentheses(equation);
            }
        return import_refuse(equation->surface->import, equation->line,
                             "no function is called `%.60s`", name);
    }
    if (length == 1 && strchr("xyz", name[0])) {
        text_add(&equation->text, name);
        return true;
    }
    return use_parameter(equation, name);
}

static bool parse_factor(Equation *equation)
{
    skip_blanks(equation);
    unsigned char first = (unsigned char)*equation->at;
    if (first == '(')
        return parse_parentheses(equation);
    if (isdigit(first) || first == '.')
        return parse_number(equation);
    if (isalpha(first) || first == '_')
        return parse_name(equation);
    return refuse_equation(equation, "a number, a name or a parenthesis");
}

/* Parses a power: what stands alone before `^` may have one more behind it. */
static bool parse_power(Equation *equation)
{
    if (++equation->depth > MAX_DEPTH)
        return import_refuse(equation->surface->import, equation->line,
                             "the equation is more than %d deep", MAX_DEPTH);
    bool good = parse_factor(equation);
    if (good && accept_sign(equation, '^')) {
        text_add(&equation->text, "^");
        good = parse_power(equation);
    }
    equation->depth--;
    return good;
}

static bool parse_signed(Equation *equation)
{
    if (accept_sign(equation, '-'))
        text_add(&equation->text, "-");
    return parse_power(equation);
}

static bool parse_product(Equation *equation)
{
    if (!parse_signed(equation))
        return false;
    for (;;) {
        if (accept_sign(equation, '*'))
            text_add(&equation->text, " * ");
        else if (accept_sign(equation, '/'))
            text_add(&equation->text, " / ");
        else
            return true;
        if (!parse_signed(equation))
            return false;
    }
}

static bool parse_sum(Equation *equation)
{
    if (!parse_product(equation))
        return false;
    for (;;) {
        if (accept_sign(equation, '+'))
            text_add(&equation->text, " + ");
        else if (accept_sign(equation, '-'))
            text_add(&equation->text, " - ");
        else
            return true;
        if (!parse_product(equation))
            return false;
    }
}

bool jsurf_equation(JsurfSurface *surface, Text *text)
{
    const JsurfProperty *property = jsurf_property(surface, "surface_equation");
    if (!property)
        return import_refuse(surface->import, 1, "there is no surface_equation");
    Equation equation = {.surface = surface,
                         .line    = property->line,
                         .start   = property->value,
                         .at      = property->value,
                         .text    = {.arena = surface->import->arena}};
    if (!parse_sum(&equation))
        return false;
    skip_blanks(&equation);
    if (*equation.at != '\0')
        return refuse_equation(&equation, *equation.at == '=' ? "nothing: `= 0` is not written"
                                                              : "an operator");
    *text = equation.text;
    return true;
}

bool jsurf_write_parameters(const JsurfSurface *surface)
{
    Text *scene = &surface->import->scene;
    for (size_t i = 0; i < surface->used_count; i++) {
        const JsurfProperty *property = surface->used[i];
        double               value;
        if (!jsurf_numbers(surface, property->key, &value, 1))
            return false;
        import_mark(surface->import, property->line);
        text_add(scene, "param ");
        add_parameter_name(scene, property->key + strlen("surface_parameter_"));
        text_add(scene, " = ");
        import_add_number(scene, value);
        text_add(scene, " in ");
        import_add_vector(scene, (double[]){fmin(value, 0), fmax(value, 1)}, 2);
        text_add(scene, ";\n");
    }
    text_add(scene, surface->used_count > 0 ? "\n" : "");
    return true;
}
