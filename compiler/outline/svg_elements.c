/*
 * svg_elements.c: what the elements of a drawing are: areas and strokes with their colours.
 */
#include "compiler/outline/svg.h"

#include <math.h>
#include <string.h>

#include "compiler/outline/svg_paint.h"
#include "compiler/outline/svg_shapes.h"

/* `use` in `use`, and elements in all. */
enum { MAX_REFERENCES = 24, MAX_ENTERED = 400000 };

/* The properties that elements inherit. */
typedef struct State {
    SvgMap    map;
    SvgPaint  fill, line;
    uint32_t  current; /* `currentColor` */
    FillRule  rule;
    SvgStroke stroke;
    bool      hidden; /* by `visibility`: parts of it may be shown again */
    int       references;
} State;

/* ---- shapes ---- */

static bool draw_rectangle(SvgReader *reader, const SvgElement *element, SvgPen *pen)
{
    double corner[2] = {svg_length(reader, element, "x", 0, 0),
                        svg_length(reader, element, "y", 1, 0)};
    double size[2]   = {svg_length(reader, element, "width", 0, 0),
                        svg_length(reader, element, "height", 1, 0)};
    double rx        = svg_length(reader, element, "rx", 0, -1),
           ry        = svg_length(reader, element, "ry", 1, -1);
    double radii[2]  = {fmax(rx < 0 ? ry : rx, 0), fmax(ry < 0 ? rx : ry, 0)};
    if (size[0] > 0 && size[1] > 0)
        svg_rectangle(pen, corner, size, radii);
    return true;
}

static bool draw_ellipse(SvgReader *reader, const SvgElement *element, SvgPen *pen)
{
    double center[2] = {svg_length(reader, element, "cx", 0, 0),
                        svg_length(reader, element, "cy", 1, 0)};
    double radius    = svg_length(reader, element, "r", 2, 0);
    double radii[2]  = {svg_length(reader, element, "rx", 0, radius),
                        svg_length(reader, element, "ry", 1, radius)};
    if (radii[0] > 0 && radii[1] > 0)
        svg_ellipse(pen, center, radii);
    return true;
}

static bool draw_line(SvgReader *reader, const SvgElement *element, SvgPen *pen)
{
    double from[2] = {svg_length(reader, element, "x1", 0, 0),
                      svg_length(reader, element, "y1", 1, 0)};
    double to[2]   = {svg_length(reader, element, "x2", 0, 0),
                      svg_length(reader, element, "y2", 1, 0)};
    pen_move(pen, from);
    pen_line(pen, to);
    return true;
}

static bool draw_points(const SvgElement *element, SvgPen *pen, bool closed)
{
    const char *points = svg_attribute(element, "points");
    return !points || svg_polygon(pen, points, closed);
}

static bool draw_polygon(SvgReader *reader, const SvgElement *element, SvgPen *pen)
{
    (void)reader;
    return draw_points(element, pen, true);
}

static bool draw_polyline(SvgReader *reader, const SvgElement *element, SvgPen *pen)
{
    (void)reader;
    return draw_points(element, pen, false);
}

static bool draw_path(SvgReader *reader, const SvgElement *element, SvgPen *pen)
{
    const char *data = svg_attribute(element, "d");
    (void)reader;
    return !data || svg_path(pen, data);
}

typedef bool        DrawShape(SvgReader *reader, const SvgElement *element, SvgPen *pen);
typedef void        EnterElement(SvgReader *reader, const SvgElement *element, State state);
static EnterElement enter_use, enter_svg, enter_children, enter_switch;

/* The kinds of elements: shapes; what has others inside; definitions, which nothing is drawn of;
   others are left out. */
static const struct Kind {
    const char   *name;
    DrawShape    *draw;
    EnterElement *enter;
    bool          silent;
    const char   *fault; /* of a shape */
} kinds[] = {
    {"path", draw_path, NULL, false, "this path means nothing from some place on"},
    {"rect", draw_rectangle, NULL, false, ""},
    {"circle", draw_ellipse, NULL, false, ""},
    {"ellipse", draw_ellipse, NULL, false, ""},
    {"line", draw_line, NULL, false, ""},
    {"polygon", draw_polygon, NULL, false, "the points of this polygon are no pairs of numbers"},
    {"polyline", draw_polyline, NULL, false, "the points of this polyline are no pairs of numbers"},
    {"use", NULL, enter_use, false, NULL},
    {"svg", NULL, enter_svg, false, NULL},
    {"g", NULL, enter_children, false, NULL},
    {"a", NULL, enter_children, false, NULL},
    {"switch", NULL, enter_switch, false, NULL},
    {"defs", NULL, NULL, true, NULL},
    {"symbol", NULL, NULL, true, NULL},
    {"style", NULL, NULL, true, NULL},
    {"title", NULL, NULL, true, NULL},
    {"desc", NULL, NULL, true, NULL},
    {"metadata", NULL, NULL, true, NULL},
    {"linearGradient", NULL, NULL, true, NULL},
    {"radialGradient", NULL, NULL, true, NULL},
};

static const struct Kind *find_kind(const char *name)
{
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        if (strcmp(kinds[i].name, name) == 0)
            return &kinds[i];
    return NULL;
}

/* Returns how far pieces may be from their curves: a millionth of the view's size. */
static double tolerance_of(const SvgDrawing *drawing)
{
    double size = fmax(drawing->high[0] - drawing->low[0], drawing->high[1] - drawing->low[1]);
    return size > 0 ? 1e-6 * size : 1e-3;
}

static void add_figure(SvgReader *reader, const Curves *curves, FillRule rule, uint32_t rgb)
{
    SvgDrawing *drawing = reader->drawing;
    SvgFigure   figure  = {*curves, rule, rgb, reader->line};
    if (curves->count > 0)
        array_push(drawing->arena, &drawing->figures, figure);
}

/* Draws the area first, then the stroke upon it. */
static void draw_element(SvgReader *reader, const struct Kind *kind, const SvgElement *element,
                         const State *state)
{
    SvgDrawing *drawing = reader->drawing;
    SvgTrail    trail   = {NULL, 0, 0};
    bool        strokes = state->line.drawn && state->stroke.width > 0;
    SvgPen      pen     = {{.arena = drawing->arena, .tolerance = tolerance_of(drawing)},
                           state->map,
                  strokes ? &trail : NULL};
    if (!kind->draw(reader, element, &pen)) {
        svg_stop(reader, kind->fault);
        return;
    }
    if (state->fill.drawn && kind->draw != draw_line)
        add_figure(reader, &pen.path.curves, state->rule, state->fill.rgb);
    if (!strokes)
        return;
    pen.path  = (Path){.arena = drawing->arena, .tolerance = pen.path.tolerance};
    pen.trail = NULL;
    svg_stroke(&pen, &trail, &state->stroke);
    add_figure(reader, &pen.path.curves, FILL_NONZERO, state->line.rgb);
}

/* ---- elements ---- */

static const char *left_out(const SvgReader *reader, const char *name)
{
    Text text = {.arena = reader->drawing->arena};
    text_format(&text, "elements `%.40s`", name);
    return text.bytes;
}

static void read_looks(SvgReader *reader, const SvgElement *element, State *state)
{
    const char *rule       = svg_given(reader, element, "fill-rule");
    const char *color      = svg_given(reader, element, "color");
    const char *visibility = svg_given(reader, element, "visibility");
    if (color)
        svg_color(color, &state->current);
    if (visibility)
        state->hidden = strcmp(visibility, "visible") != 0;
    if (rule)
        state->rule = strcmp(rule, "evenodd") == 0 ? FILL_EVEN_ODD : FILL_NONZERO;
    svg_read_paint(reader, element, "fill", state->current, &state->fill);
    svg_read_paint(reader, element, "stroke", state->current, &state->line);
    svg_read_stroke(reader, element, &state->stroke);
    if (svg_is_clear(reader, element, "fill-opacity"))
        state->fill.drawn = false;
    if (svg_is_clear(reader, element, "stroke-opacity"))
        state->line.drawn = false;
}

/* Reads the state of an element within others that have this one; false: it is not drawn. */
static bool read_state(SvgReader *reader, const SvgElement *element, State *state)
{
    const char *transform = svg_property(&reader->tree, element, "transform");
    const char *display   = svg_property(&reader->tree, element, "display");
    SvgMap      map;
    if ((display && strcmp(display, "none") == 0) || svg_is_clear(reader, element, "opacity"))
        return false;
    if (transform && strcmp(transform, "none") != 0) {
        if (!svg_transform(transform, &map)) {
            svg_stop(reader, "this `transform` means nothing");
            return false;
        }
        state->map = svg_product(&state->map, &map);
    }
    for (const char *const *name = (const char *const[]){"clip-path", "mask", NULL}; *name;
         name++) {
        const char *cut = svg_given(reader, element, *name);
        if (cut && strcmp(cut, "none") != 0)
            svg_note(reader, "clips and masks");
    }
    read_looks(reader, element, state);
    return true;
}

static void enter(SvgReader *reader, const SvgElement *element, State state)
{
    const struct Kind *kind = find_kind(element->name);
    reader->line            = element->line;
    if (++reader->entered > MAX_ENTERED)
        svg_stop(reader, "there are too many elements, as `use` multiplies them");
    if (reader->fault || (kind && kind->silent))
        return;
    if (!kind) {
        if (!strchr(element->name, ':')) /* that of an editor */
            svg_note(reader, left_out(reader, element->name));
        return;
    }
    if (!read_state(reader, element, &state))
        return;
    if (kind->enter)
        kind->enter(reader, element, state);
    else if (!state.hidden)
        draw_element(reader, kind, element, &state);
}

static void enter_children(SvgReader *reader, const SvgElement *element, State state)
{
    for (const SvgElement *child = element->first; child && !reader->fault; child = child->next)
        enter(reader, child, state);
}

/* Draws the first child that is known. */
static void enter_switch(SvgReader *reader, const SvgElement *element, State state)
{
    for (const SvgElement *child = element->first; child; child = child->next)
        if (find_kind(child->name)) {
            enter(reader, child, state);
            return;
        }
}

static void move_map(SvgMap *map, double x, double y)
{
    SvgMap moved = {{1, 0, 0, 1, x, y}};
    *map         = svg_product(map, &moved);
}

/* Adds the map from the view of a part to its place, whose middle is that of the view, unless it is
   stretched. */
static void fit_view(SvgReader *reader, const SvgElement *element, const double size[2],
                     State *state)
{
    const char *box    = svg_attribute(element, "viewBox");
    const char *aspect = svg_attribute(element, "preserveAspectRatio");
    double      n[4];
    if (!box || svg_numbers(box, n, 4) < 4 || !(n[2] > 0 && n[3] > 0 && size[0] > 0 && size[1] > 0))
        return;
    double scale[2] = {size[0] / n[2], size[1] / n[3]};
    if (!aspect || strncmp(aspect, "none", 4) != 0)
        scale[0] = scale[1] = fmin(scale[0], scale[1]);
    if (aspect && strncmp(aspect, "none", 4) != 0 && strncmp(aspect, "xMidYMid", 8) != 0)
        svg_note(reader, "`preserveAspectRatio`: the middles of views are kept");
    SvgMap map = {{scale[0], 0, 0, scale[1], 0.5 * size[0] - scale[0] * (n[0] + 0.5 * n[2]),
                   0.5 * size[1] - scale[1] * (n[1] + 0.5 * n[3])}};
    state->map = svg_product(&state->map, &map);
}

/* Draws an `svg` in another, or a `symbol` where it is used. */
static void enter_view(SvgReader *reader, const SvgElement *element, const double size[2],
                       State state)
{
    fit_view(reader, element, size, &state);
    enter_children(reader, element, state);
}

static void enter_svg(SvgReader *reader, const SvgElement *element, State state)
{
    double size[2] = {svg_length(reader, element, "width", 0, svg_view_size(reader, 0)),
                      svg_length(reader, element, "height", 1, svg_view_size(reader, 1))};
    if (element == reader->tree.root) {
        enter_children(reader, element, state);
        return;
    }
    move_map(&state.map, svg_length(reader, element, "x", 0, 0),
             svg_length(reader, element, "y", 1, 0));
    enter_view(reader, element, size, state);
}

static void enter_use(SvgReader *reader, const SvgElement *element, State state)
{
    const SvgElement *used = svg_referred(&reader->tree, svg_link(element));
    double            size[2];
    if (!used || ++state.references > MAX_REFERENCES) {
        svg_note(reader,
                 used ? "elements `use` in each other" : "elements `use` of nothing in the file");
        return;
    }
    move_map(&state.map, svg_length(reader, element, "x", 0, 0),
             svg_length(reader, element, "y", 1, 0));
    if (strcmp(used->name, "symbol") != 0) {
        enter(reader, used, state);
        return;
    }
    size[0] = svg_length(reader, element, "width", 0, svg_view_size(reader, 0));
    size[1] = svg_length(reader, element, "height", 1, svg_view_size(reader, 1));
    if (read_state(reader, used, &state))
        enter_view(reader, used, size, state);
}

/* ---- the whole ---- */

static void read_view(SvgReader *reader)
{
    SvgDrawing *drawing = reader->drawing;
    const char *box     = svg_attribute(reader->tree.root, "viewBox");
    double      n[4]    = {0, 0, svg_length(reader, reader->tree.root, "width", 2, 0),
                           svg_length(reader, reader->tree.root, "height", 2, 0)};
    if (box)
        svg_numbers(box, n, 4);
    for (int k = 0; k < 2 && n[2] > 0 && n[3] > 0; k++) {
        drawing->low[k]  = n[k];
        drawing->high[k] = n[k] + n[k + 2];
    }
}

bool svg_read(SvgDrawing *drawing, const char *bytes, size_t length)
{
    SvgReader reader = {.drawing = drawing, .tree = {.arena = drawing->arena}, .line = 1};
    drawing->low[0] = drawing->low[1] = 1;
    drawing->high[0] = drawing->high[1] = 0;
    if (!svg_tree_read(&reader.tree, bytes, length)) {
        drawing->fault      = reader.tree.fault;
        drawing->fault_line = reader.tree.fault_line;
        return false;
    }
    read_view(&reader);
    if (reader.tree.unknown_rules > 0) {
        reader.line = reader.tree.unknown_rules;
        svg_note(&reader, "rules of `style` for more than names, classes and ids");
    }
    enter(&reader, reader.tree.root,
          (State){.map    = {{1, 0, 0, 1, 0, 0}},
                  .fill   = {.drawn = true},
                  .rule   = FILL_NONZERO,
                  .stroke = {.width = 1, .miter_limit = 4}});
    drawing->fault      = reader.fault;
    drawing->fault_line = reader.fault_line;
    return !reader.fault;
}
