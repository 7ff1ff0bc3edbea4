/*
 * text.c: the built-in function `text`: letters as a plane figure.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "compiler/eval/data/from_files.h"
#include "compiler/outline/letters.h"

/* Cubic curves may be off by so much, in ems. */
#define TOLERANCE 1e-5

enum { STRING, SIZE, FONT, ALIGN, VERTICAL, LINE_HEIGHT, SPACING };

static const char *const align_names[]    = {"left", "center", "right"};
static const char *const vertical_names[] = {"baseline", "top", "middle", "bottom"};

static const Choices aligns = {.noun    = "alignment",
                               .wanted  = "an alignment, a string",
                               .unknown = "unknown alignment",
                               .more    = "",
                               .items   = align_names,
                               .count   = 3};

static const Choices verticals = {.noun    = "vertical alignment",
                                  .wanted  = "a vertical alignment, a string",
                                  .unknown = "unknown alignment",
                                  .more    = "",
                                  .items   = vertical_names,
                                  .count   = 4};

/* ---- fonts ---- */

static bool ends_with(const char *name, const char *ending)
{
    size_t length = strlen(name), tail = strlen(ending);
    return length >= tail && strcasecmp(name + length - tail, ending) == 0;
}

static bool is_file_name(const char *name)
{
    static const char *const endings[] = {".ttf", ".otf", ".ttc", ".otc", ".pfb"};
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++)
        if (ends_with(name, endings[i]))
            return true;
    return false;
}

static void report_no_font(Elaboration *e, const Call *call, FontSearch search, const char *name)
{
    const Argument *font  = &call->arguments[FONT];
    const Syntax   *where = font->syntax ? font->syntax : call->syntax;
    bool            none  = search == FONT_NONE;
    Diag *diag  = none ? diag_add(e->diags, DIAG_NO_FONT, where->span, "this system has no fonts")
                       : diag_add(e->diags, DIAG_NO_FONT, where->span, "no font is called \"%s\"",
                                  name);
    diag->label = none ? "needs a font" : "unknown font";
    diag->help  = none ? "install some, as with `apt install fonts-dejavu-core`, or give a file: "
                         "`font: \"letters.ttf\"`"
                       : "`fc-list : family` lists the fonts of this system; a file is named with "
                         "its ending: `font: \"letters.ttf\"`";
}

static bool find_font(Elaboration *e, const Call *call, const char *name, Font *font)
{
    FileBytes  bytes;
    FontSearch search = read_font(e, name, &bytes);
    if (search != FONT_FOUND) {
        report_no_font(e, call, search, name);
        return false;
    }
    *font = (Font){bytes.bytes, bytes.length, bytes.face};
    return true;
}

/* Finds the font of a call; false: reported. */
static bool want_font(Elaboration *e, const Call *call, Font *font)
{
    const Argument *argument = &call->arguments[FONT];
    if (!argument->syntax)
        return find_font(e, call, NULL, font);
    if (argument->value.type != VALUE_STRING) {
        type_error(e, argument->syntax, argument->value, "the name of a font or of its file");
        return false;
    }
    if (!is_file_name(argument->value.string))
        return find_font(e, call, argument->value.string, font);
    FileBytes bytes;
    if (!read_beside(e, argument, argument->value.string, &bytes))
        return false;
    *font = (Font){bytes.bytes, bytes.length, 0};
    return true;
}

/* ---- letters ---- */

static bool want_positive_constant(Elaboration *e, const Call *call, uint32_t index, double *number)
{
    if (!want_constant(e, call, index, number))
        return false;
    if (!is_given(call, index) || (*number > 0 && *number < MAX_EXTENT))
        return true;
    Diag *diag  = diag_add(e->diags, DIAG_BAD_VALUE, call->arguments[index].syntax->span,
                           "a size of letters must be greater than 0, and below 1e12");
    diag->label = diag_text(e->diags, "this is %g", *number);
    return false;
}

static bool want_lettering(Elaboration *e, const Call *call, Lettering *lettering)
{
    uint32_t align;
    *lettering = (Lettering){.size = 1};
    if (!want_positive_constant(e, call, SIZE, &lettering->size) ||
        !want_positive_constant(e, call, LINE_HEIGHT, &lettering->line_height) ||
        !want_constant(e, call, SPACING, &lettering->spacing) ||
        !want_name(e, &call->arguments[ALIGN], &aligns, &align))
        return false;
    lettering->align = (LineAlign)align;
    return true;
}

/* Tabs are blanks; fonts have none. */
static const char *drawable_text(Elaboration *e, const char *string)
{
    char *text = arena_copy_text(e->arena, string, strlen(string));
    for (char *c = text; *c; c++)
        *c = *c == '\t' ? ' ' : *c;
    return text;
}

static void report_missing(Elaboration *e, const Call *call, uint32_t character)
{
    Diag *diag  = diag_add(e->diags, DIAG_MISSING_GLYPH, call->arguments[STRING].syntax->span,
                           "the font has no character U+%04X", (unsigned)character);
    diag->label = "its sign for missing characters is shown";
    diag->help  = "choose a font that has it: `font: \"...\"`";
}

/* Moves contours up or down. */
static void align_vertically(Curves *curves, uint32_t vertical)
{
    double low = 0, high = 0;
    for (size_t i = 0; i < curves->count; i++) {
        low  = i ? fmin(low, curves->items[i].from[1]) : curves->items[i].from[1];
        high = i ? fmax(high, curves->items[i].from[1]) : curves->items[i].from[1];
    }
    const double moves[] = {0, -high, -0.5 * (low + high), -low};
    for (size_t i = 0; i < curves->count; i++) {
        curves->items[i].from[1] += moves[vertical];
        curves->items[i].via[1] += moves[vertical];
        curves->items[i].to[1] += moves[vertical];
    }
}

Value builtin_text(Elaboration *e, Call *call)
{
    const Argument *string = &call->arguments[STRING];
    Lettering       lettering;
    Font            font;
    uint32_t        vertical, missing;
    if (string->value.type != VALUE_STRING) {
        type_error(e, string->syntax, string->value, "a string");
        return value_error();
    }
    if (!want_lettering(e, call, &lettering) ||
        !want_name(e, &call->arguments[VERTICAL], &verticals, &vertical) ||
        !want_font(e, call, &font))
        return value_error();
    Path path = {.arena = e->arena, .tolerance = TOLERANCE * lettering.size};
    if (!letters_draw(&path, &font, drawable_text(e, string->value.string), &lettering, &missing)) {
        const Syntax *where = is_given(call, FONT) ? call->arguments[FONT].syntax : call->syntax;
        Diag         *diag  = diag_add(e->diags, DIAG_NO_FONT, where->span,
                                       "this file is no font with outlines");
        diag->label         = "TrueType and OpenType fonts are possible";
        return value_error();
    }
    if (missing)
        report_missing(e, call, missing);
    align_vertically(&path.curves, vertical);
    return value_shape(
        make_outline(e->builder, "text", &path.curves, FILL_NONZERO, call->syntax->span));
}
