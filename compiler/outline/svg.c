/*
 * svg.c: what the elements of a drawing are: areas and strokes with their colours.
 */
#include "compiler/outline/svg.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "compiler/base/elementary.h"
#include "compiler/base/embedded.h"
#include "compiler/base/text.h"
#include "compiler/outline/svg_stroke.h"
#include "compiler/outline/svg_tree.h"

/* `use` in `use`, and gradients that continue others. */
enum { MAX_REFERENCES = 24, MAX_ENTERED = 400000 };

/* The paint of a fill or stroke.  Its colour is sRGB, 0xrrggbb. */
typedef struct Paint {
    bool     drawn;
    uint32_t rgb;
} Paint;

/* The properties that elements inherit. */
typedef struct State {
    SvgMap    map;
    Paint     fill, line;
    uint32_t  current; /* `currentColor` */
    FillRule  rule;
    SvgStroke stroke;
    bool      hidden; /* by `visibility`: parts of it may be shown again */
    int       references;
} State;

typedef struct Reader {
    SvgDrawing *drawing;
    SvgTree     tree;
    unsigned    line; /* of the element at hand */
    const char *fault;
    unsigned    fault_line;
    unsigned    entered; /* elements so far */
} Reader;

/* ---- notes ---- */

/* Notes once for each kind what is left out. */
static void note(Reader *reader, const char *what)
{
    SvgDrawing *drawing = reader->drawing;
    for (size_t i = 0; i < drawing->notes.count; i++)
        if (strcmp(drawing->notes.items[i].what, what) == 0)
            return;
    SvgNote left = {what, reader->line};
    array_push(drawing->arena, &drawing->notes, left);
}

static void stop(Reader *reader, const char *fault)
{
    if (reader->fault)
        return;
    reader->fault      = fault;
    reader->fault_line = reader->line;
}

/* ---- attributes ---- */

static bool is_blank(char c) { return isspace((unsigned char)c) != 0; }

static const char *property(const Reader *reader, const SvgElement *element, const char *name)
{
    const char *value = svg_property(&reader->tree, element, name);
    return value && strcmp(value, "inherit") == 0 ? NULL : value;
}

/* Returns a length in units of the drawing, of which the view has `whole`; what is measured in
   others is not known here. */
static double length_in(Reader *reader, const char *text, double whole, double otherwise)
{
    double number;
    if (!text || !svg_number(&text, &number))
        return otherwise;
    if (*text == '%' && whole > 0)
        return number / 100 * whole;
    if (*text && strncmp(text, "px", 2) != 0 && !is_blank(*text))
        note(reader, "units other than px, which count as px");
    return number;
}

static double view_size(const Reader *reader, int axis)
{
    return reader->drawing->high[axis] - reader->drawing->low[axis];
}

/* Returns a length; `axis`: 0 and 1 along the view's width and height, 2 neither. */
static double length_of(Reader *reader, const SvgElement *element, const char *name, int axis,
                        double otherwise)
{
    double whole = axis < 2 ? view_size(reader, axis)
                            : real_hypot(view_size(reader, 0), view_size(reader, 1)) / sqrt(2);
    return length_in(reader, svg_property(&reader->tree, element, name), whole, otherwise);
}

/* ---- colours ---- */

static bool hexadecimal(const char *digits, uint32_t *rgb)
{
    size_t count = strspn(digits, "0123456789abcdefABCDEF");
    if (count != 3 && count != 4 && count != 6 && count != 8)
        return false;
    uint32_t number = (uint32_t)strtoul(digits, NULL, 16);
    number = count == 4 ? number >> 4 : count == 8 ? number >> 8 : number; /* without alpha */
    *rgb   = number;
    if (count <= 4)
        *rgb = (number >> 8 & 15) * 0x110000 + (number >> 4 & 15) * 0x1100 + (number & 15) * 0x11;
    return true;
}

/* Reads rgb(255, 128, 0) or rgb(100%, 50%, 0%). */
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

static const char *library_text(const char *name)
{
    const EmbeddedFile *file = library_files;
    while (file->name && strcmp(file->name, name) != 0)
        file++;
    return file->name ? file->text : "";
}

/* Reads a colour of CSS by the library's declaration, `let tomato = #ff6347;`, except for `tan`,
   which is the tangent in the language. */
static bool named(const char *name, uint32_t *rgb)
{
    size_t length = strlen(name);
    *rgb          = 0xd2b48c;
    if (strcasecmp(name, "tan") == 0)
        return true;
    for (const char *at = strstr(library_text("colours.krs"), "\nlet "); at;
         at             = strstr(at + 1, "\nlet ")) {
        if (length == 0 || strncasecmp(at + 5, name, length) != 0)
            continue;
        const char *behind = at + 5 + length + strspn(at + 5 + length, " ");
        if (strncmp(behind, "= #", 3) != 0)
            continue;
        *rgb = (uint32_t)strtoul(behind + 3, NULL, 16);
        return true;
    }
    *rgb = 0;
    return false;
}

static bool color_of(const char *text, uint32_t *rgb)
{
    if (text[0] == '#')
        return hexadecimal(text + 1, rgb);
    *rgb = 0;
    if (strncmp(text, "rgb(", 4) == 0 || strncmp(text, "rgba(", 5) == 0)
        return functional(strchr(text, '(') + 1, rgb);
    return named(text, rgb);
}

/* ---- gradients ---- */

typedef struct Stop {
    double   at, opacity;
    uint32_t rgb;
} Stop;

/* Red, green and blue by their opacity, and this. */
typedef struct Mean {
    double sum[4];
} Mean;

/* Adds a stretch between stops, where colours change evenly: the mean is that of its ends, in terms
   of what each adds to light that is mixed. */
static void add_stretch(Mean *mean, const Stop *a, const Stop *b, double length)
{
    for (int end = 0; end < 2; end++) {
        const Stop *stop = end ? b : a;
        for (int k = 0; k < 3; k++)
            mean->sum[k] += 0.5 * length * stop->opacity * (stop->rgb >> (16 - 8 * k) & 255);
        mean->sum[3] += 0.5 * length * stop->opacity;
    }
}

static Stop read_stop(Reader *reader, const SvgElement *element, const Stop *before)
{
    const char *color   = property(reader, element, "stop-color");
    const char *opacity = property(reader, element, "stop-opacity");
    const char *offset  = svg_attribute(element, "offset");
    Stop        stop    = {.opacity = 1};
    double      number;
    if (offset && svg_number(&offset, &number))
        stop.at = *offset == '%' ? number / 100 : number;
    stop.at = fmin(fmax(stop.at, before ? before->at : 0), 1);
    if (opacity && svg_number(&opacity, &number))
        stop.opacity = fmin(fmax(*opacity == '%' ? number / 100 : number, 0), 1);
    if (color && !color_of(color, &stop.rgb))
        note(reader, "unknown colours, which are grey");
    return stop;
}

/* Finds the mean along a gradient; false: there is nothing to be seen of it. */
static bool mean_of_stops(Reader *reader, const SvgElement *gradient, uint32_t *rgb)
{
    Mean mean   = {{0}};
    Stop before = {0};
    bool first  = true;
    for (const SvgElement *at = gradient->first; at; at = at->next) {
        if (strcmp(at->name, "stop") != 0)
            continue;
        Stop stop = read_stop(reader, at, first ? NULL : &before);
        add_stretch(&mean, first ? &stop : &before, &stop, first ? stop.at : stop.at - before.at);
        before = stop;
        first  = false;
    }
    if (first)
        return false;
    add_stretch(&mean, &before, &before, 1 - before.at);
    if (mean.sum[3] <= 0)
        return false;
    *rgb = 0;
    for (int k = 0; k < 3; k++)
        *rgb = *rgb << 8 | (uint32_t)lround(fmin(mean.sum[k] / mean.sum[3], 255));
    return true;
}

static bool has_stops(const SvgElement *gradient)
{
    for (const SvgElement *at = gradient->first; at; at = at->next)
        if (strcmp(at->name, "stop") == 0)
            return true;
    return false;
}

static const char *link_of(const SvgElement *element)
{
    const char *link = svg_attribute(element, "href");
    return link ? link : svg_attribute(element, "xlink:href");
}

/* Reads `url(#id)`: the mean of a gradient, whose stops may be those of another one. */
static bool read_reference(Reader *reader, const char *text, Paint *paint)
{
    const SvgElement *found = svg_referred(&reader->tree, text);
    if (!found || !strstr(found->name, "Gradient"))
        return false;
    for (int i = 0; found && !has_stops(found) && i < MAX_REFERENCES; i++)
        found = svg_referred(&reader->tree, link_of(found));
    note(reader, "gradients, which have one colour: their mean");
    paint->drawn = found && mean_of_stops(reader, found, &paint->rgb);
    return true;
}

/* ---- paints and strokes ---- */

static void read_paint(Reader *reader, const SvgElement *element, const char *name,
                       const State *state, Paint *paint)
{
    const char *text = property(reader, element, name);
    bool        url  = text && strncmp(text, "url(", 4) == 0;
    if (!text || (url && read_reference(reader, text, paint)))
        return;
    const char *otherwise = url ? strchr(text, ')') : NULL;
    if (otherwise && otherwise[1] &&
        color_of(otherwise + 1 + strspn(otherwise + 1, " "), &paint->rgb))
        return;
    paint->drawn = strcmp(text, "none") != 0 && strcmp(text, "transparent") != 0;
    if (strcasecmp(text, "currentColor") == 0)
        paint->rgb = state->current;
    else if (paint->drawn && !color_of(text, &paint->rgb)) {
        paint->rgb = 0x808080;
        note(reader, url ? "patterns, which are grey" : "unknown colours, which are grey");
    }
}

/* Tells whether a property is a share of nothing: nothing in between is known of areas. */
static bool is_clear(Reader *reader, const SvgElement *element, const char *name)
{
    const char *text = property(reader, element, name);
    double      number;
    if (!text || !svg_number(&text, &number))
        return false;
    if (number > 0 && number < (*text == '%' ? 100 : 1))
        note(reader, "opacity: all is opaque");
    return number <= 0;
}

/* Returns the row of a table whose name a property has; without one, what was inherited. */
static int choice_of(Reader *reader, const SvgElement *element, const char *name,
                     const char *const *names, int count, int inherited)
{
    const char *text = property(reader, element, name);
    for (int i = 0; text && i < count; i++)
        if (strcmp(text, names[i]) == 0)
            return i;
    if (text)
        note(reader, "unknown forms of the ends and corners of strokes");
    return inherited;
}

static void read_dashes(Reader *reader, const SvgElement *element, SvgStroke *stroke)
{
    enum { MOST = 32 };
    const char *text = property(reader, element, "stroke-dasharray");
    if (!text)
        return;
    double *dashes = arena_new_array(reader->drawing->arena, double, 2 * MOST);
    int     count  = 0;
    for (double number; count < MOST && svg_number(&text, &number); count++) {
        dashes[count] = fmax(number, 0);
        text += strncmp(text, "px", 2) == 0 ? 2 : 0;
    }
    memcpy(dashes + count, dashes, (size_t)count * sizeof *dashes);
    stroke->dashes     = dashes;
    stroke->dash_count = count % 2 == 1 ? 2 * count : count;
}

static void read_stroke(Reader *reader, const SvgElement *element, SvgStroke *stroke)
{
    static const char *const caps[]  = {"butt", "round", "square"};
    static const char *const joins[] = {"miter", "round", "bevel"};
    const char              *limit   = property(reader, element, "stroke-miterlimit");
    stroke->width       = fmax(length_of(reader, element, "stroke-width", 2, stroke->width), 0);
    stroke->dash_offset = length_of(reader, element, "stroke-dashoffset", 2, stroke->dash_offset);
    stroke->cap         = choice_of(reader, element, "stroke-linecap", caps, 3, (int)stroke->cap);
    stroke->join = choice_of(reader, element, "stroke-linejoin", joins, 3, (int)stroke->join);
    if (limit)
        svg_number(&limit, &stroke->miter_limit);
    read_dashes(reader, element, stroke);
}

/* ---- shapes ---- */

static bool draw_rectangle(Reader *reader, const SvgElement *element, SvgPen *pen)
{
    double corner[2] = {length_of(reader, element, "x", 0, 0),
                        length_of(reader, element, "y", 1, 0)};
    double size[2]   = {length_of(reader, element, "width", 0, 0),
                        length_of(reader, element, "height", 1, 0)};
    double rx        = length_of(reader, element, "rx", 0, -1),
           ry        = length_of(reader, element, "ry", 1, -1);
    double radii[2]  = {fmax(rx < 0 ? ry : rx, 0), fmax(ry < 0 ? rx : ry, 0)};
    if (size[0] > 0 && size[1] > 0)
        svg_rectangle(pen, corner, size, radii);
    return true;
}

static bool draw_ellipse(Reader *reader, const SvgElement *element, SvgPen *pen)
{
    double center[2] = {length_of(reader, element, "cx", 0, 0),
                        length_of(reader, element, "cy", 1, 0)};
    double radius    = length_of(reader, element, "r", 2, 0);
    double radii[2]  = {length_of(reader, element, "rx", 0, radius),
                        length_of(reader, element, "ry", 1, radius)};
    if (radii[0] > 0 && radii[1] > 0)
        svg_ellipse(pen, center, radii);
    return true;
}

static bool draw_line(Reader *reader, const SvgElement *element, SvgPen *pen)
{
    double from[2] = {length_of(reader, element, "x1", 0, 0),
                      length_of(reader, element, "y1", 1, 0)};
    double to[2] = {length_of(reader, element, "x2", 0, 0), length_of(reader, element, "y2", 1, 0)};
    pen_move(pen, from);
    pen_line(pen, to);
    return true;
}

static bool draw_points(const SvgElement *element, SvgPen *pen, bool closed)
{
    const char *points = svg_attribute(element, "points");
    return !points || svg_polygon(pen, points, closed);
}

static bool draw_polygon(Reader *reader, const SvgElement *element, SvgPen *pen)
{
    (void)reader;
    return draw_points(element, pen, true);
}

static bool draw_polyline(Reader *reader, const SvgElement *element, SvgPen *pen)
{
    (void)reader;
    return draw_points(element, pen, false);
}

static bool draw_path(Reader *reader, const SvgElement *element, SvgPen *pen)
{
    const char *data = svg_attribute(element, "d");
    (void)reader;
    return !data || svg_path(pen, data);
}

typedef bool        DrawShape(Reader *reader, const SvgElement *element, SvgPen *pen);
typedef void        EnterElement(Reader *reader, const SvgElement *element, State state);
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

static void add_figure(Reader *reader, const Curves *curves, FillRule rule, uint32_t rgb)
{
    SvgDrawing *drawing = reader->drawing;
    SvgFigure   figure  = {*curves, rule, rgb, reader->line};
    if (curves->count > 0)
        array_push(drawing->arena, &drawing->figures, figure);
}

/* Draws the area first, then the stroke upon it. */
static void draw_element(Reader *reader, const struct Kind *kind, const SvgElement *element,
                         const State *state)
{
    SvgDrawing *drawing = reader->drawing;
    SvgTrail    trail   = {NULL, 0, 0};
    bool        strokes = state->line.drawn && state->stroke.width > 0;
    SvgPen      pen     = {{.arena = drawing->arena, .tolerance = tolerance_of(drawing)},
                           state->map,
                  strokes ? &trail : NULL};
    if (!kind->draw(reader, element, &pen)) {
        stop(reader, kind->fault);
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

static const char *left_out(const Reader *reader, const char *name)
{
    Text text = {.arena = reader->drawing->arena};
    text_format(&text, "elements `%.40s`", name);
    return text.bytes;
}

static void read_looks(Reader *reader, const SvgElement *element, State *state)
{
    const char *rule       = property(reader, element, "fill-rule");
    const char *color      = property(reader, element, "color");
    const char *visibility = property(reader, element, "visibility");
    if (color)
        color_of(color, &state->current);
    if (visibility)
        state->hidden = strcmp(visibility, "visible") != 0;
    if (rule)
        state->rule = strcmp(rule, "evenodd") == 0 ? FILL_EVEN_ODD : FILL_NONZERO;
    read_paint(reader, element, "fill", state, &state->fill);
    read_paint(reader, element, "stroke", state, &state->line);
    read_stroke(reader, element, &state->stroke);
    if (is_clear(reader, element, "fill-opacity"))
        state->fill.drawn = false;
    if (is_clear(reader, element, "stroke-opacity"))
        state->line.drawn = false;
}

/* Reads the state of an element within others that have this one; false: it is not drawn. */
static bool read_state(Reader *reader, const SvgElement *element, State *state)
{
    const char *transform = svg_property(&reader->tree, element, "transform");
    const char *display   = svg_property(&reader->tree, element, "display");
    SvgMap      map;
    if ((display && strcmp(display, "none") == 0) || is_clear(reader, element, "opacity"))
        return false;
    if (transform && strcmp(transform, "none") != 0) {
        if (!svg_transform(transform, &map)) {
            stop(reader, "this `transform` means nothing");
            return false;
        }
        state->map = svg_product(&state->map, &map);
    }
    for (const char *const *name = (const char *const[]){"clip-path", "mask", NULL}; *name;
         name++) {
        const char *cut = property(reader, element, *name);
        if (cut && strcmp(cut, "none") != 0)
            note(reader, "clips and masks");
    }
    read_looks(reader, element, state);
    return true;
}

static void enter(Reader *reader, const SvgElement *element, State state)
{
    const struct Kind *kind = find_kind(element->name);
    reader->line            = element->line;
    if (++reader->entered > MAX_ENTERED)
        stop(reader, "there are too many elements, as `use` multiplies them");
    if (reader->fault || (kind && kind->silent))
        return;
    if (!kind) {
        if (!strchr(element->name, ':')) /* that of an editor */
            note(reader, left_out(reader, element->name));
        return;
    }
    if (!read_state(reader, element, &state))
        return;
    if (kind->enter)
        kind->enter(reader, element, state);
    else if (!state.hidden)
        draw_element(reader, kind, element, &state);
}

static void enter_children(Reader *reader, const SvgElement *element, State state)
{
    for (const SvgElement *child = element->first; child && !reader->fault; child = child->next)
        enter(reader, child, state);
}

/* Draws the first child that is known. */
static void enter_switch(Reader *reader, const SvgElement *element, State state)
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
static void fit_view(Reader *reader, const SvgElement *element, const double size[2], State *state)
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
        note(reader, "`preserveAspectRatio`: the middles of views are kept");
    SvgMap map = {{scale[0], 0, 0, scale[1], 0.5 * size[0] - scale[0] * (n[0] + 0.5 * n[2]),
                   0.5 * size[1] - scale[1] * (n[1] + 0.5 * n[3])}};
    state->map = svg_product(&state->map, &map);
}

/* Draws an `svg` in another, or a `symbol` where it is used. */
static void enter_view(Reader *reader, const SvgElement *element, const double size[2], State state)
{
    fit_view(reader, element, size, &state);
    enter_children(reader, element, state);
}

static void enter_svg(Reader *reader, const SvgElement *element, State state)
{
    double size[2] = {length_of(reader, element, "width", 0, view_size(reader, 0)),
                      length_of(reader, element, "height", 1, view_size(reader, 1))};
    if (element == reader->tree.root) {
        enter_children(reader, element, state);
        return;
    }
    move_map(&state.map, length_of(reader, element, "x", 0, 0),
             length_of(reader, element, "y", 1, 0));
    enter_view(reader, element, size, state);
}

static void enter_use(Reader *reader, const SvgElement *element, State state)
{
    const SvgElement *used = svg_referred(&reader->tree, link_of(element));
    double            size[2];
    if (!used || ++state.references > MAX_REFERENCES) {
        note(reader,
             used ? "elements `use` in each other" : "elements `use` of nothing in the file");
        return;
    }
    move_map(&state.map, length_of(reader, element, "x", 0, 0),
             length_of(reader, element, "y", 1, 0));
    if (strcmp(used->name, "symbol") != 0) {
        enter(reader, used, state);
        return;
    }
    size[0] = length_of(reader, element, "width", 0, view_size(reader, 0));
    size[1] = length_of(reader, element, "height", 1, view_size(reader, 1));
    if (read_state(reader, used, &state))
        enter_view(reader, used, size, state);
}

/* ---- the whole ---- */

static void read_view(Reader *reader)
{
    SvgDrawing *drawing = reader->drawing;
    const char *box     = svg_attribute(reader->tree.root, "viewBox");
    double      n[4]    = {0, 0, length_of(reader, reader->tree.root, "width", 2, 0),
                           length_of(reader, reader->tree.root, "height", 2, 0)};
    if (box)
        svg_numbers(box, n, 4);
    for (int k = 0; k < 2 && n[2] > 0 && n[3] > 0; k++) {
        drawing->low[k]  = n[k];
        drawing->high[k] = n[k] + n[k + 2];
    }
}

bool svg_read(SvgDrawing *drawing, const char *bytes, size_t length)
{
    Reader reader   = {.drawing = drawing, .tree = {.arena = drawing->arena}, .line = 1};
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
        note(&reader, "rules of `style` for more than names, classes and ids");
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
