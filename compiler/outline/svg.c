/*
 * svg.c: reads the XML of a drawing, by expat.
 */
#include "compiler/outline/svg.h"

#include <ctype.h>
#include <expat.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "compiler/base/text.h"
#include "compiler/outline/svg_shapes.h"

enum { MOST_DEPTH = 256 };

/* What elements inherit. */
typedef struct State {
    SvgMap   map;
    uint32_t rgb;
    FillRule rule;
    bool     filled, stroked, hidden; /* hidden: in a definition, or in what is left out */
} State;

typedef struct Reader {
    SvgDrawing *drawing;
    XML_Parser  parser;
    const char *fault;
    State       states[MOST_DEPTH]; /* of the elements that are open */
    int         depth;
} Reader;

/* ---- memory ---- */

/* expat has memory of the arena, which is freed with it: also where it runs out, and the call of expat
   does not return. */
static _Thread_local Arena *expat_arena;

typedef struct Block {
    size_t size;
    _Alignas(max_align_t) char bytes[];
} Block;

static void *get_block(size_t size)
{
    Block *block = arena_alloc(expat_arena, 1, sizeof *block + size);
    block->size  = size;
    return block->bytes;
}

static void *resize_block(void *old, size_t size)
{
    void *fresh = get_block(size);
    if (old) {
        size_t had = ((Block *)((char *)old - offsetof(Block, bytes)))->size;
        memcpy(fresh, old, had < size ? had : size);
    }
    return fresh;
}

static void drop_block(void *block) { (void)block; }

/* ---- notes ---- */

static unsigned line_of(const Reader *reader)
{
#if XML_MAJOR_VERSION * 100 + XML_MINOR_VERSION >= 209
    return (unsigned)XML_GetCurrentLineNumber64(reader->parser);
#else
    return (unsigned)XML_GetCurrentLineNumber(reader->parser);
#endif
}

/* Once for each kind. */
static void note(Reader *reader, const char *what)
{
    SvgDrawing *drawing = reader->drawing;
    for (size_t i = 0; i < drawing->notes.count; i++)
        if (strcmp(drawing->notes.items[i].what, what) == 0)
            return;
    SvgNote left = {what, line_of(reader)};
    array_push(drawing->arena, &drawing->notes, left);
}

static void stop(Reader *reader, const char *fault)
{
    reader->fault = fault;
    XML_StopParser(reader->parser, XML_FALSE);
}

/* ---- attributes ---- */

static const char *attribute(const char **attributes, const char *name)
{
    for (; *attributes; attributes += 2)
        if (strcmp(attributes[0], name) == 0)
            return attributes[1];
    return NULL;
}

static bool is_blank(char c) { return isspace((unsigned char)c) != 0; }

/* "a: b" in "...; a: b; ...": NULL if there is none. */
static const char *styled(const Reader *reader, const char *style, const char *name)
{
    size_t length = strlen(name);
    while (style && *style) {
        while (is_blank(*style) || *style == ';')
            style++;
        const char *colon = style + length, *end = style + strcspn(style, ";");
        while (strncmp(style, name, length) == 0 && is_blank(*colon))
            colon++;
        if (strncmp(style, name, length) == 0 && *colon == ':') {
            for (colon++; is_blank(*colon);)
                colon++;
            while (end > colon && is_blank(end[-1]))
                end--;
            return arena_copy_text(reader->drawing->arena, colon,
                                   end > colon ? (size_t)(end - colon) : 0);
        }
        style = end;
    }
    return NULL;
}

/* In `style`, or as an attribute. */
static const char *property(const Reader *reader, const char **attributes, const char *name)
{
    const char *value = styled(reader, attribute(attributes, "style"), name);
    return value ? value : attribute(attributes, name);
}

/* A length in units of the drawing; what is measured in others is not known here. */
static double length_of(Reader *reader, const char **attributes, const char *name, double otherwise)
{
    const char *text = attribute(attributes, name);
    double      number;
    if (!text || !svg_number(&text, &number))
        return otherwise;
    if (*text && strncmp(text, "px", 2) != 0 && !is_blank(*text))
        note(reader, "units other than px, which count as px");
    return number;
}

/* ---- colours ---- */

static bool hexadecimal(const char *digits, uint32_t *rgb)
{
    size_t count = strspn(digits, "0123456789abcdefABCDEF");
    if (count != 3 && count != 6)
        return false;
    uint32_t number = (uint32_t)strtoul(digits, NULL, 16);
    *rgb            = number;
    if (count == 3)
        *rgb = (number >> 8 & 15) * 0x110000 + (number >> 4 & 15) * 0x1100 + (number & 15) * 0x11;
    return true;
}

/* rgb(255, 128, 0) or rgb(100%, 50%, 0%) */
static bool functional(const char *text, uint32_t *rgb)
{
    *rgb = 0;
    for (int k = 0; k < 3; k++) {
        double number;
        if (!svg_number(&text, &number))
            return false;
        bool share = *text == '%';
        text += share;
        number = fmin(fmax(share ? number * 255 / 100 : number, 0), 255);
        *rgb   = *rgb << 8 | (uint32_t)lround(number);
    }
    return true;
}

static bool color_of(const char *text, uint32_t *rgb)
{
    static const struct {
        const char *name;
        uint32_t    rgb;
    } colors[] = {
#define COLOR(name, rgb) {name, rgb},
#include "compiler/outline/svg_colors.def"
    };
    if (text[0] == '#')
        return hexadecimal(text + 1, rgb);
    *rgb = 0;
    if (strcmp(text, "currentColor") == 0)
        return true;
    if (strncmp(text, "rgb(", 4) == 0)
        return functional(text + 4, rgb);
    for (size_t i = 0; i < sizeof colors / sizeof *colors; i++)
        if (strcasecmp(text, colors[i].name) == 0) {
            *rgb = colors[i].rgb;
            return true;
        }
    return false;
}

static void read_fill(Reader *reader, const char **attributes, State *state)
{
    const char *fill = property(reader, attributes, "fill");
    const char *rule = property(reader, attributes, "fill-rule");
    if (rule && strcmp(rule, "inherit") != 0)
        state->rule = strcmp(rule, "evenodd") == 0 ? FILL_EVEN_ODD : FILL_NONZERO;
    if (!fill || strcmp(fill, "inherit") == 0)
        return;
    state->filled = strcmp(fill, "none") != 0 && strcmp(fill, "transparent") != 0;
    if (state->filled && !color_of(fill, &state->rgb)) {
        state->rgb = 0x808080;
        note(reader, strncmp(fill, "url(", 4) == 0 ? "gradients and patterns, which are grey"
                                                   : "unknown colours, which are grey");
    }
}

/* ---- shapes ---- */

static bool draw_rectangle(Reader *reader, const char **attributes, SvgPen *pen)
{
    double corner[2] = {length_of(reader, attributes, "x", 0),
                        length_of(reader, attributes, "y", 0)};
    double size[2]   = {length_of(reader, attributes, "width", 0),
                        length_of(reader, attributes, "height", 0)};
    double rx        = length_of(reader, attributes, "rx", -1),
           ry        = length_of(reader, attributes, "ry", -1);
    double radii[2]  = {fmax(rx < 0 ? ry : rx, 0), fmax(ry < 0 ? rx : ry, 0)};
    if (size[0] > 0 && size[1] > 0)
        svg_rectangle(pen, corner, size, radii);
    return true;
}

static bool draw_ellipse(Reader *reader, const char **attributes, SvgPen *pen)
{
    double center[2] = {length_of(reader, attributes, "cx", 0),
                        length_of(reader, attributes, "cy", 0)};
    double radius    = length_of(reader, attributes, "r", 0);
    double radii[2]  = {length_of(reader, attributes, "rx", radius),
                        length_of(reader, attributes, "ry", radius)};
    if (radii[0] > 0 && radii[1] > 0)
        svg_ellipse(pen, center, radii);
    return true;
}

static bool draw_polygon(Reader *reader, const char **attributes, SvgPen *pen)
{
    const char *points = attribute(attributes, "points");
    (void)reader;
    return !points || svg_polygon(pen, points);
}

static bool draw_path(Reader *reader, const char **attributes, SvgPen *pen)
{
    const char *data = attribute(attributes, "d");
    (void)reader;
    return !data || svg_path(pen, data);
}

typedef bool DrawShape(Reader *reader, const char **attributes, SvgPen *pen);

/* What elements are: shapes; groups; definitions, which nothing is drawn of; others are left out. */
static const struct Element {
    const char *name;
    DrawShape  *draw;
    bool        group, silent;
    const char *fault; /* of a shape */
} elements[] = {
    {"path", draw_path, false, false, "this path means nothing from some place on"},
    {"rect", draw_rectangle, false, false, ""},
    {"circle", draw_ellipse, false, false, ""},
    {"ellipse", draw_ellipse, false, false, ""},
    {"polygon", draw_polygon, false, false, "the points of this polygon are no pairs of numbers"},
    {"polyline", draw_polygon, false, false, "the points of this polyline are no pairs of numbers"},
    {"svg", NULL, true, false, NULL},
    {"g", NULL, true, false, NULL},
    {"a", NULL, true, false, NULL},
    {"defs", NULL, false, true, NULL},
    {"title", NULL, false, true, NULL},
    {"desc", NULL, false, true, NULL},
    {"metadata", NULL, false, true, NULL},
    {"linearGradient", NULL, false, true, NULL},
    {"radialGradient", NULL, false, true, NULL},
    {"line", NULL, false, true, NULL},
};

/* In pieces of the view's size; curves leave them by a millionth of it. */
static double tolerance_of(const SvgDrawing *drawing)
{
    double size = fmax(drawing->high[0] - drawing->low[0], drawing->high[1] - drawing->low[1]);
    return size > 0 ? 1e-6 * size : 1e-3;
}

static void draw_element(Reader *reader, const struct Element *element, const char **attributes,
                         const State *state)
{
    SvgDrawing *drawing = reader->drawing;
    SvgPen      pen = {{.arena = drawing->arena, .tolerance = tolerance_of(drawing)}, state->map};
    if (state->stroked)
        note(reader, "strokes");
    if (!element->draw(reader, attributes, &pen))
        stop(reader, element->fault);
    else if (state->filled && pen.path.curves.count > 0) {
        SvgFigure figure = {pen.path.curves, state->rule, state->rgb, line_of(reader)};
        array_push(drawing->arena, &drawing->figures, figure);
    }
}

/* ---- elements ---- */

static void read_view(Reader *reader, const char **attributes)
{
    SvgDrawing *drawing = reader->drawing;
    const char *box     = attribute(attributes, "viewBox");
    double      n[4]    = {0, 0, length_of(reader, attributes, "width", 0),
                           length_of(reader, attributes, "height", 0)};
    if (box)
        svg_numbers(box, n, 4);
    for (int k = 0; k < 2 && n[2] > 0 && n[3] > 0; k++) {
        drawing->low[k]  = n[k];
        drawing->high[k] = n[k] + n[k + 2];
    }
}

static const struct Element *find_element(const char *name)
{
    for (size_t i = 0; i < sizeof elements / sizeof *elements; i++)
        if (strcmp(elements[i].name, name) == 0)
            return &elements[i];
    return NULL;
}

/* "svg:path" is a path where names have prefixes; others belong to editors. */
static const char *local_name(const char *name)
{
    const char *colon = strchr(name, ':');
    return colon && strncmp(name, "svg:", 4) == 0 ? colon + 1 : name;
}

static const char *left_out(const Reader *reader, const char *name)
{
    Text text = {.arena = reader->drawing->arena};
    text_format(&text, "elements `%.40s`", name);
    return text.bytes;
}

static void read_state(Reader *reader, const char **attributes, State *state)
{
    const char *transform = attribute(attributes, "transform");
    const char *stroke    = property(reader, attributes, "stroke");
    const char *display   = property(reader, attributes, "display");
    SvgMap      map;
    if (stroke)
        state->stroked = strcmp(stroke, "none") != 0;
    if (display && strcmp(display, "none") == 0)
        state->hidden = true;
    if (transform && !svg_transform(transform, &map))
        stop(reader, "this `transform` means nothing");
    else if (transform)
        state->map = svg_product(&state->map, &map);
    if (property(reader, attributes, "clip-path") || property(reader, attributes, "mask"))
        note(reader, "clips and masks");
    read_fill(reader, attributes, state);
}

static void begin_element(void *user, const char *full_name, const char **attributes)
{
    Reader     *reader = user;
    const char *name   = local_name(full_name);
    if (reader->depth + 1 >= MOST_DEPTH) {
        stop(reader, "elements are nested too deep");
        return;
    }
    State *state = &reader->states[reader->depth + 1];
    *state       = reader->states[reader->depth];
    if (reader->depth++ == 0) {
        if (strcmp(name, "svg") != 0)
            stop(reader, "this is no SVG: its first element is not `svg`");
        read_view(reader, attributes);
    }
    if (state->hidden || reader->fault)
        return;
    const struct Element *element = find_element(name);
    if (element && (element->draw || element->group))
        read_state(reader, attributes, state);
    else {
        state->hidden = true;
        if (!element && !strchr(name, ':'))
            note(reader, left_out(reader, name));
    }
    if (element && element->draw && !state->hidden && !reader->fault)
        draw_element(reader, element, attributes, state);
}

static void end_element(void *user, const char *name)
{
    Reader *reader = user;
    (void)name;
    reader->depth--;
}

/* ---- the whole ---- */

/* The words of expat change with its version. */
static const char *xml_fault(XML_Parser parser)
{
    switch (XML_GetErrorCode(parser)) {
    case XML_ERROR_NONE: return "it is too long";
    case XML_ERROR_NO_ELEMENTS:
    case XML_ERROR_UNCLOSED_TOKEN:
    case XML_ERROR_UNCLOSED_CDATA_SECTION:
    case XML_ERROR_PARTIAL_CHAR: return "it ends too early";
    case XML_ERROR_TAG_MISMATCH: return "an element is closed by the name of another";
    case XML_ERROR_DUPLICATE_ATTRIBUTE: return "an element has an attribute twice";
    case XML_ERROR_JUNK_AFTER_DOC_ELEMENT: return "there is something behind its last element";
    case XML_ERROR_UNDEFINED_ENTITY: return "an entity (`&name;`) is not declared";
    case XML_ERROR_UNKNOWN_ENCODING:
    case XML_ERROR_INCORRECT_ENCODING: return "its encoding is not known";
    default: return "this is not XML";
    }
}

bool svg_read(SvgDrawing *drawing, const char *bytes, size_t length)
{
    static const XML_Memory_Handling_Suite memory = {get_block, resize_block, drop_block};
    expat_arena                                   = drawing->arena;
    Reader *reader                                = arena_new(drawing->arena, Reader);
    *reader = (Reader){.drawing = drawing, .parser = XML_ParserCreate_MM(NULL, &memory, NULL)};
    reader->states[0] = (State){.map = {{1, 0, 0, 1, 0, 0}}, .filled = true, .rule = FILL_NONZERO};
    drawing->low[0] = drawing->low[1] = 1;
    drawing->high[0] = drawing->high[1] = 0;
    XML_SetUserData(reader->parser, reader);
    XML_SetElementHandler(reader->parser, begin_element, end_element);
    bool good = length <= INT32_MAX &&
                XML_Parse(reader->parser, bytes, (int)length, XML_TRUE) == XML_STATUS_OK;
    if (!good) {
        drawing->fault      = reader->fault ? reader->fault : xml_fault(reader->parser);
        drawing->fault_line = line_of(reader);
    }
    XML_ParserFree(reader->parser);
    return good;
}
