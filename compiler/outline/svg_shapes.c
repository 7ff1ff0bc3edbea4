/*
 * svg_shapes.c: numbers, transforms, and the data of paths, as SVG 1.1 has them.
 */
#include "compiler/outline/svg_shapes.h"

#include <ctype.h>
#include <math.h>
#include <string.h>

#include "compiler/base/elementary.h"
#include "compiler/base/text.h"

/* ---- numbers ---- */

static void skip_blanks(const char **text)
{
    while (**text && (isspace((unsigned char)**text) || **text == ','))
        ++*text;
}

/* Returns where the digits at a place end. */
static const char *behind_digits(const char *text) { return text + strspn(text, "0123456789"); }

/* Returns the length of a number without a sign; 0: there is none. */
static size_t number_length(const char *text)
{
    const char *end = behind_digits(text);
    if (*end == '.' && (end > text || isdigit((unsigned char)end[1])))
        end = behind_digits(end + 1);
    if (end > text && (*end | 32) == 'e') {
        const char *digits = end + 1 + (end[1] == '-' || end[1] == '+');
        end                = isdigit((unsigned char)*digits) ? behind_digits(digits) : end;
    }
    return (size_t)(end - text);
}

bool svg_number(const char **text, double *number)
{
    skip_blanks(text);
    const bool   minus  = **text == '-';
    const char  *digits = *text + (minus || **text == '+');
    const size_t length = number_length(digits);
    if (length == 0)
        return false;
    *number = text_decimal(digits, length);
    *number = minus ? -*number : *number;
    *text   = digits + length;
    return isfinite(*number);
}

int svg_numbers(const char *text, double *numbers, int most)
{
    int count = 0;
    while (count < most && svg_number(&text, &numbers[count]))
        count++;
    return count;
}

/* A flag of an arc is one digit, and needs nothing behind it. */
static bool next_flag(const char **text, double *flag)
{
    skip_blanks(text);
    if (**text != '0' && **text != '1')
        return false;
    *flag = *(*text)++ - '0';
    return true;
}

/* ---- transforms ---- */

SvgMap svg_product(const SvgMap *outer, const SvgMap *inner)
{
    const double *a = outer->m, *b = inner->m;
    return (SvgMap){{a[0] * b[0] + a[2] * b[1], a[1] * b[0] + a[3] * b[1],
                     a[0] * b[2] + a[2] * b[3], a[1] * b[2] + a[3] * b[3],
                     a[0] * b[4] + a[2] * b[5] + a[4], a[1] * b[4] + a[3] * b[5] + a[5]}};
}

static SvgMap rotation(double degrees, double x, double y)
{
    double c = real_cos(degrees * M_PI / 180), s = real_sin(degrees * M_PI / 180);
    return (SvgMap){{c, s, -s, c, x - c * x + s * y, y - s * x - c * y}};
}

static bool named_map(const char *name, size_t length, const double *n, int count, SvgMap *map)
{
#define NAMED(word) (length == strlen(word) && strncmp(name, word, length) == 0)
    if (NAMED("matrix") && count == 6)
        memcpy(map->m, n, sizeof map->m);
    else if (NAMED("translate") && count >= 1)
        *map = (SvgMap){{1, 0, 0, 1, n[0], count > 1 ? n[1] : 0}};
    else if (NAMED("scale") && count >= 1)
        *map = (SvgMap){{n[0], 0, 0, count > 1 ? n[1] : n[0], 0, 0}};
    else if (NAMED("rotate") && count >= 1)
        *map = rotation(n[0], count > 2 ? n[1] : 0, count > 2 ? n[2] : 0);
    else if (NAMED("skewX") && count == 1)
        *map = (SvgMap){{1, 0, real_tan(n[0] * M_PI / 180), 1, 0, 0}};
    else if (NAMED("skewY") && count == 1)
        *map = (SvgMap){{1, real_tan(n[0] * M_PI / 180), 0, 1, 0, 0}};
    else
        return false;
    return true;
#undef NAMED
}

bool svg_transform(const char *text, SvgMap *map)
{
    *map = (SvgMap){{1, 0, 0, 1, 0, 0}};
    for (skip_blanks(&text); *text; skip_blanks(&text)) {
        size_t      length = strcspn(text, "( \t\r\n");
        const char *name = text, *open = strchr(text, '(');
        double      numbers[6];
        SvgMap      next;
        const char *close = open ? strchr(open, ')') : NULL;
        if (!close || !named_map(name, length, numbers, svg_numbers(open + 1, numbers, 6), &next))
            return false;
        *map = svg_product(map, &next);
        text = close + 1;
    }
    return true;
}

/* ---- drawing behind the map ---- */

static void mapped(const SvgPen *pen, const double p[2], double q[2])
{
    const double *m = pen->map.m;
    q[0]            = m[0] * p[0] + m[2] * p[1] + m[4];
    q[1]            = m[1] * p[0] + m[3] * p[1] + m[5];
}

/* Begins a part of the trail.  What follows a `Z` begins where that contour did. */
static Path *begin_subpath(SvgPen *pen, const double at[2])
{
    const double *m     = pen->map.m;
    double        scale = sqrt(fabs(m[0] * m[3] - m[1] * m[2]));
    SvgSubpath    sub   = {
             .path = {.arena = pen->path.arena, .tolerance = pen->path.tolerance / fmax(scale, 1e-9)}};
    path_move(&sub.path, at);
    array_push(pen->path.arena, pen->trail, sub);
    return &pen->trail->items[pen->trail->count - 1].path;
}

static Path *subpath(SvgPen *pen)
{
    if (!pen->trail || pen->trail->count == 0)
        return NULL;
    SvgSubpath *sub = &pen->trail->items[pen->trail->count - 1];
    if (sub->closed) {
        const double start[2] = {sub->path.start[0], sub->path.start[1]};
        begin_subpath(pen, start);
        sub = &pen->trail->items[pen->trail->count - 1];
    }
    sub->drawn = true;
    return &sub->path;
}

void pen_move(SvgPen *pen, const double to[2])
{
    double q[2];
    mapped(pen, to, q);
    path_move(&pen->path, q);
    if (pen->trail)
        begin_subpath(pen, to);
}

void pen_line(SvgPen *pen, const double to[2])
{
    double q[2];
    Path  *trail = subpath(pen);
    mapped(pen, to, q);
    path_line(&pen->path, q);
    if (trail)
        path_line(trail, to);
}

void pen_quadratic(SvgPen *pen, const double via[2], const double to[2])
{
    double p[2], q[2];
    Path  *trail = subpath(pen);
    mapped(pen, via, p);
    mapped(pen, to, q);
    path_quadratic(&pen->path, p, q);
    if (trail)
        path_quadratic(trail, via, to);
}

void pen_cubic(SvgPen *pen, const double first[2], const double second[2], const double to[2])
{
    double p[2], q[2], r[2];
    Path  *trail = subpath(pen);
    mapped(pen, first, p);
    mapped(pen, second, q);
    mapped(pen, to, r);
    path_cubic(&pen->path, p, q, r);
    if (trail)
        path_cubic(trail, first, second, to);
}

void pen_close(SvgPen *pen)
{
    Path *trail = subpath(pen);
    path_close(&pen->path);
    if (!trail)
        return;
    path_close(trail);
    pen->trail->items[pen->trail->count - 1].closed = true;
}

/* ---- arcs ---- */

/* An arc of an ellipse: center, radii, its rotation; from one angle on, by another. */
typedef struct Arc {
    double center[2], radii[2], rotation_angle, from, by;
} Arc;

static void arc_place(const Arc *arc, double x, double y, double p[2])
{
    double c = real_cos(arc->rotation_angle), s = real_sin(arc->rotation_angle);
    p[0] = arc->center[0] + c * arc->radii[0] * x - s * arc->radii[1] * y;
    p[1] = arc->center[1] + s * arc->radii[0] * x + c * arc->radii[1] * y;
}

/* Draws an arc by pieces of 22.5 degrees at most: a cubic curve leaves such an arc by a
   10-millionth of its radius. */
static void draw_arc(SvgPen *pen, const Arc *arc, const double *end)
{
    int    count = (int)fmax(ceil(fabs(arc->by) / (M_PI / 8) - 1e-9), 1);
    double step = arc->by / count, pull = 4.0 / 3 * real_tan(step / 4);
    for (int i = 0; i < count; i++) {
        double a = arc->from + i * step, b = a + step, first[2], second[2], to[2];
        arc_place(arc, real_cos(a) - pull * real_sin(a), real_sin(a) + pull * real_cos(a), first);
        arc_place(arc, real_cos(b) + pull * real_sin(b), real_sin(b) - pull * real_cos(b), second);
        arc_place(arc, real_cos(b), real_sin(b), to);
        pen_cubic(pen, first, second, end && i + 1 == count ? end : to);
    }
}

/* Draws the arc from one point to another by SVG 1.1, F.6.5 and F.6.6. */
static void draw_arc_between(SvgPen *pen, const double from[2], const double n[7])
{
    double rx = fabs(n[0]), ry = fabs(n[1]), rotation_angle = n[2] * M_PI / 180,
           c = real_cos(rotation_angle), s = real_sin(rotation_angle);
    double dx = 0.5 * (from[0] - n[5]), dy = 0.5 * (from[1] - n[6]);
    double x = c * dx + s * dy, y = c * dy - s * dx;
    if (!(rx > 0 && ry > 0)) {
        pen_line(pen, n + 5);
        return;
    }
    double apart = x * x / (rx * rx) + y * y / (ry * ry), grown = apart > 1 ? sqrt(apart) : 1;
    if (apart == 0)
        return;
    rx *= grown, ry *= grown;
    double side = sqrt(fmax(grown * grown / apart - 1, 0)) * (n[3] == n[4] ? -1 : 1);
    double u = side * rx * y / ry, v = -side * ry * x / rx;
    Arc    arc    = {.radii = {rx, ry}, .rotation_angle = rotation_angle};
    arc.center[0] = c * u - s * v + 0.5 * (from[0] + n[5]);
    arc.center[1] = s * u + c * v + 0.5 * (from[1] + n[6]);
    arc.from      = real_atan2((y - v) / ry, (x - u) / rx);
    arc.by        = real_atan2((-y - v) / ry, (-x - u) / rx) - arc.from;
    if (n[4] != 0 && arc.by < 0)
        arc.by += 2 * M_PI;
    if (n[4] == 0 && arc.by > 0)
        arc.by -= 2 * M_PI;
    draw_arc(pen, &arc, n + 5);
}

/* ---- the data of paths ---- */

typedef struct PathReader {
    SvgPen     *pen;
    const char *text;
    double      at[2], start[2], control[2]; /* the last control point, which S and T mirror */
    char        before;                      /* the letter of what was drawn last, in capitals */
} PathReader;

/* Returns how many numbers stand behind a letter; -1: it is none of a path. */
static int numbers_of(char letter)
{
    static const char letters[] = "MLHVCSQTAZ";
    static const int  counts[]  = {2, 2, 1, 1, 6, 4, 4, 2, 7, 0};
    const char       *found     = strchr(letters, letter);
    return letter && found ? counts[found - letters] : -1;
}

static bool read_numbers(PathReader *reader, char letter, int count, double *n)
{
    for (int i = 0; i < count; i++) {
        bool flag = letter == 'A' && (i == 3 || i == 4);
        if (!(flag ? next_flag(&reader->text, &n[i]) : svg_number(&reader->text, &n[i])))
            return false;
    }
    return true;
}

static void make_absolute(const PathReader *reader, char letter, int count, double *n)
{
    if (letter == 'H' || letter == 'V')
        n[0] += reader->at[letter == 'V'];
    else
        for (int i = letter == 'A' ? 5 : 0; i < count; i++)
            n[i] += reader->at[letter == 'A' ? i - 5 : i % 2];
}

/* Finds the last control point, mirrored in the current point, if the last piece was of such a
   kind. */
static void mirrored(const PathReader *reader, const char *kinds, double p[2])
{
    bool mirrors = reader->before && strchr(kinds, reader->before);
    for (int k = 0; k < 2; k++)
        p[k] = mirrors ? 2 * reader->at[k] - reader->control[k] : reader->at[k];
}

static void draw_piece(PathReader *reader, char letter, double *n, int count)
{
    SvgPen *pen   = reader->pen;
    double  to[2] = {reader->at[0], reader->at[1]};
    if (letter == 'H' || letter == 'V')
        to[letter == 'V'] = n[0];
    else if (letter == 'Z')
        memcpy(to, reader->start, sizeof to);
    else
        memcpy(to, n + count - 2, sizeof to);
    memcpy(reader->control, to, sizeof to);
    switch (letter) {
    case 'M':
        pen_move(pen, to);
        memcpy(reader->start, to, sizeof to);
        break;
    case 'C':
        pen_cubic(pen, n, n + 2, to);
        memcpy(reader->control, n + 2, sizeof to);
        break;
    case 'Q':
        pen_quadratic(pen, n, to);
        memcpy(reader->control, n, sizeof to);
        break;
    case 'A': draw_arc_between(pen, reader->at, n); break;
    case 'Z': pen_close(pen); break;
    default: pen_line(pen, to); break;
    }
    memcpy(reader->at, to, sizeof to);
    reader->before = letter;
}

/* Draws S and T as C and Q: the piece before tells the first control point. */
static void draw_smooth(PathReader *reader, char letter, double *n)
{
    double all[6], p[2];
    mirrored(reader, letter == 'S' ? "CS" : "QT", p);
    memcpy(all, p, sizeof p);
    memcpy(all + 2, n, (letter == 'S' ? 4 : 2) * sizeof *n);
    draw_piece(reader, letter == 'S' ? 'C' : 'Q', all, letter == 'S' ? 6 : 4);
}

/* Draws all pieces behind one letter.  What follows the first point of M are lines. */
static bool draw_letter(PathReader *reader, char letter)
{
    bool   relative = islower((unsigned char)letter);
    char   capital  = (char)toupper((unsigned char)letter);
    int    count    = numbers_of(capital);
    double n[7];
    if (count < 0)
        return false;
    do {
        if (!read_numbers(reader, capital, count, n))
            return false;
        if (relative)
            make_absolute(reader, capital, count, n);
        if (capital == 'S' || capital == 'T')
            draw_smooth(reader, capital, n);
        else
            draw_piece(reader, capital, n, count);
        capital = capital == 'M' ? 'L' : capital;
        skip_blanks(&reader->text);
    } while (count > 0 && *reader->text && !isalpha((unsigned char)*reader->text));
    return true;
}

bool svg_path(SvgPen *pen, const char *text)
{
    PathReader reader = {.pen = pen, .text = text};
    bool       good   = true;
    skip_blanks(&reader.text);
    good = *reader.text == '\0' || (*reader.text | 32) == 'm';
    while (good && *reader.text) {
        char letter = *reader.text++;
        good        = draw_letter(&reader, letter);
        skip_blanks(&reader.text);
    }
    path_close(&pen->path);
    return good;
}

/* ---- basic shapes ---- */

void svg_ellipse(SvgPen *pen, const double center[2], const double radii[2])
{
    Arc    arc = {.center = {center[0], center[1]}, .radii = {radii[0], radii[1]}, .by = 2 * M_PI};
    double start[2] = {center[0] + radii[0], center[1]};
    pen_move(pen, start);
    draw_arc(pen, &arc, start);
    pen_close(pen);
}

void svg_rectangle(SvgPen *pen, const double corner[2], const double size[2], const double radii[2])
{
    double rx = fmin(radii[0], 0.5 * size[0]), ry = fmin(radii[1], 0.5 * size[1]);
    double x[2] = {corner[0] + rx, corner[0] + size[0] - rx};
    double y[2] = {corner[1] + ry, corner[1] + size[1] - ry};
    for (int i = 0; i < 4; i++) { /* from the right side around, y downwards */
        bool   left = i == 1 || i == 2, top = i >= 2;
        Arc    arc = {{x[!left], y[!top]}, {rx, ry}, 0, i * M_PI_2, M_PI_2};
        double begin[2];
        arc_place(&arc, real_cos(arc.from), real_sin(arc.from), begin);
        if (i == 0)
            pen_move(pen, begin);
        else
            pen_line(pen, begin);
        if (rx > 0 && ry > 0)
            draw_arc(pen, &arc, NULL);
    }
    pen_close(pen);
}

bool svg_polygon(SvgPen *pen, const char *points, bool closed)
{
    double p[2];
    for (bool first = true; svg_number(&points, &p[0]); first = false) {
        if (!svg_number(&points, &p[1]))
            return false;
        if (first)
            pen_move(pen, p);
        else
            pen_line(pen, p);
    }
    if (closed && pen->path.curves.count > 0)
        pen_close(pen);
    path_close(&pen->path);
    return true;
}
