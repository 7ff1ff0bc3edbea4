/*
 * svg_paint.c: colours, gradients, paints and strokes of elements.
 */
#include "compiler/outline/svg_paint.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "compiler/base/embedded.h"
#include "compiler/outline/svg_shapes.h"

/* Gradients that continue others. */
enum { MAX_GRADIENTS = 24 };

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

/* Reads a colour of CSS by the library's declaration, `let tomato = #ff6347;`, except for `tan`,
   which is the tangent in the language. */
static bool named(const char *name, uint32_t *rgb)
{
    size_t length = strlen(name);
    *rgb          = 0xd2b48c;
    if (strcasecmp(name, "tan") == 0)
        return true;
    for (const char *at = strstr(embedded_find(library_files, "colours.krs")->text, "\nlet "); at;
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

bool svg_color(const char *text, uint32_t *rgb)
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

static Stop read_stop(SvgReader *reader, const SvgElement *element, const Stop *before)
{
    const char *color   = svg_given(reader, element, "stop-color");
    const char *opacity = svg_given(reader, element, "stop-opacity");
    const char *offset  = svg_attribute(element, "offset");
    Stop        stop    = {.opacity = 1};
    double      number;
    if (offset && svg_number(&offset, &number))
        stop.at = *offset == '%' ? number / 100 : number;
    stop.at = fmin(fmax(stop.at, before ? before->at : 0), 1);
    if (opacity && svg_number(&opacity, &number))
        stop.opacity = fmin(fmax(*opacity == '%' ? number / 100 : number, 0), 1);
    if (color && !svg_color(color, &stop.rgb))
        svg_note(reader, "unknown colours, which are grey");
    return stop;
}

/* Finds the mean along a gradient; false: there is nothing to be seen of it. */
static bool mean_of_stops(SvgReader *reader, const SvgElement *gradient, uint32_t *rgb)
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

/* Reads `url(#id)`: the mean of a gradient, whose stops may be those of another one. */
static bool read_reference(SvgReader *reader, const char *text, SvgPaint *paint)
{
    const SvgElement *found = svg_referred(&reader->tree, text);
    if (!found || !strstr(found->name, "Gradient"))
        return false;
    for (int i = 0; found && !has_stops(found) && i < MAX_GRADIENTS; i++)
        found = svg_referred(&reader->tree, svg_link(found));
    svg_note(reader, "gradients, which have one colour: their mean");
    paint->drawn = found && mean_of_stops(reader, found, &paint->rgb);
    return true;
}

/* ---- paints and strokes ---- */

void svg_read_paint(SvgReader *reader, const SvgElement *element, const char *name,
                    uint32_t current, SvgPaint *paint)
{
    const char *text = svg_given(reader, element, name);
    bool        url  = text && strncmp(text, "url(", 4) == 0;
    if (!text || (url && read_reference(reader, text, paint)))
        return;
    const char *otherwise = url ? strchr(text, ')') : NULL;
    if (otherwise && otherwise[1] &&
        svg_color(otherwise + 1 + strspn(otherwise + 1, " "), &paint->rgb))
        return;
    paint->drawn = strcmp(text, "none") != 0 && strcmp(text, "transparent") != 0;
    if (strcasecmp(text, "currentColor") == 0)
        paint->rgb = current;
    else if (paint->drawn && !svg_color(text, &paint->rgb)) {
        paint->rgb = 0x808080;
        svg_note(reader, url ? "patterns, which are grey" : "unknown colours, which are grey");
    }
}

bool svg_is_clear(SvgReader *reader, const SvgElement *element, const char *name)
{
    const char *text = svg_given(reader, element, name);
    double      number;
    if (!text || !svg_number(&text, &number))
        return false;
    if (number > 0 && number < (*text == '%' ? 100 : 1))
        svg_note(reader, "opacity: all is opaque");
    return number <= 0;
}

/* Returns the row of a table whose name a property has; without one, what was inherited. */
static int choice_of(SvgReader *reader, const SvgElement *element, const char *name,
                     const char *const *names, int count, int inherited)
{
    const char *text = svg_given(reader, element, name);
    for (int i = 0; text && i < count; i++)
        if (strcmp(text, names[i]) == 0)
            return i;
    if (text)
        svg_note(reader, "unknown forms of the ends and corners of strokes");
    return inherited;
}

static void read_dashes(SvgReader *reader, const SvgElement *element, SvgStroke *stroke)
{
    enum { MOST = 32 };
    const char *text = svg_given(reader, element, "stroke-dasharray");
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

void svg_read_stroke(SvgReader *reader, const SvgElement *element, SvgStroke *stroke)
{
    static const char *const caps[]  = {"butt", "round", "square"};
    static const char *const joins[] = {"miter", "round", "bevel"};
    const char              *limit   = svg_given(reader, element, "stroke-miterlimit");
    stroke->width       = fmax(svg_length(reader, element, "stroke-width", 2, stroke->width), 0);
    stroke->dash_offset = svg_length(reader, element, "stroke-dashoffset", 2, stroke->dash_offset);
    stroke->cap         = choice_of(reader, element, "stroke-linecap", caps, 3, (int)stroke->cap);
    stroke->join = choice_of(reader, element, "stroke-linejoin", joins, 3, (int)stroke->join);
    if (limit)
        svg_number(&limit, &stroke->miter_limit);
    read_dashes(reader, element, stroke);
}
