/*
 * solids.c: POV-Ray's solids of figures and fields: prisms, lathes,
 * texts, discs, blobs, superellipsoids and Julia sets.
 */
#include <math.h>
#include <string.h>
#include <unistd.h>

#include "import/pov/reader.h"
#include "compiler/base/vec.h"

enum { MAX_POINTS = 10000, PIECES = 12 };

/* ---- splines ---- */

typedef enum Spline { LINEAR, QUADRATIC, CUBIC, BEZIER } Spline;

typedef struct Points {
    double (*items)[3];
    size_t count, capacity;
} Points;

static void add_point(PovReader *reader, Points *points, double x, double y)
{
    if (points->count == points->capacity) {
        points->capacity  = points->capacity ? 2 * points->capacity : 64;
        double(*wider)[3] = arena_alloc(reader->import->arena, points->capacity, sizeof *wider);
        if (points->count > 0)
            memcpy(wider, points->items, points->count * sizeof *wider);
        points->items = wider;
    }
    double *at = points->items[points->count++];
    at[0]      = x;
    at[1]      = y;
    at[2]      = 0;
}

static Spline read_spline(PovReader *reader)
{
    static const char *const names[] = {"linear_spline", "quadratic_spline", "cubic_spline",
                                        "bezier_spline"};
    for (int i = 0; i < 4; i++)
        if (word_accept(&reader->words, names[i]))
            return (Spline)i;
    return LINEAR;
}

static bool read_points(PovReader *reader, Points *points)
{
    double count;
    if (!pov_number(reader, &count))
        return false;
    if (!(count >= 2 && count <= MAX_POINTS))
        return import_refuse(reader->import, reader->words.word.line,
                             "a curve has from 2 to %d points", MAX_POINTS);
    for (int i = 0; i < (int)count; i++) {
        double v[3];
        word_accept(&reader->words, ",");
        if (!pov_vector(reader, v))
            return false;
        add_point(reader, points, v[0], v[1]);
    }
    return true;
}

/* Interpolates between b and c: by Catmull and Rom's cubic, or by the parabola through a, b and c
 * where `square`. */
static double between(double a, double b, double c, double d, double t, bool square)
{
    if (square) /* the parabola through a, b and c */
        return b + t * (0.5 * (c - a) + t * 0.5 * (a - 2 * b + c));
    return b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)));
}

/* Returns what a spline goes through, as a polygon. */
static Points flattened(PovReader *reader, Spline spline, const Points *points)
{
    Points flat  = {0};
    size_t n     = points->count;
    size_t first = spline == LINEAR || spline == BEZIER ? 0 : 1;
    size_t last  = spline == CUBIC ? n - 2 : n - 1;
    if (spline == LINEAR)
        return *points;
    import_note(reader->import, reader->words.word.line, "curves of splines are polygons");
    for (size_t i = first; spline != BEZIER && i < last; i++)
        for (int k = 0; k < PIECES; k++) {
            const double *a = points->items[i - 1], *b = points->items[i];
            const double *c = points->items[i + 1], *d = points->items[i + 2 < n ? i + 2 : n - 1];
            double        t = (double)k / PIECES;
            add_point(reader, &flat, between(a[0], b[0], c[0], d[0], t, spline == QUADRATIC),
                      between(a[1], b[1], c[1], d[1], t, spline == QUADRATIC));
        }
    for (size_t i = 0; spline == BEZIER && i + 3 < n; i += 4)
        for (int k = 0; k < PIECES; k++) {
            double t = (double)k / PIECES, u = 1 - t, at[2];
            for (int m = 0; m < 2; m++)
                at[m] = u * u * u * points->items[i][m] + 3 * u * u * t * points->items[i + 1][m] +
                        3 * u * t * t * points->items[i + 2][m] +
                        t * t * t * points->items[i + 3][m];
            add_point(reader, &flat, at[0], at[1]);
        }
    if (n > 0)
        add_point(reader, &flat, points->items[spline == CUBIC ? n - 2 : n - 1][0],
                  points->items[spline == CUBIC ? n - 2 : n - 1][1]);
    return flat;
}

static Part *polygon(PovReader *reader, unsigned line, double (*points)[3], size_t count)
{
    Text list = {.arena = reader->import->arena};
    for (size_t i = 0; i < count; i++)
        text_format(&list, "%s%s", i == 0 ? "" : ", ",
                    import_vector_text(reader->import, points[i], 2));
    Part *part   = part_shape(reader->import, line, "polygon", "polygon([%s])", list.bytes);
    part->figure = true;
    return part;
}

/* ---- prisms and lathes ---- */

static bool is_same(const Points *points, size_t i, size_t k)
{
    return distance3(points->items[i], points->items[k]) < 1e-9;
}

/* Returns the number of points up to the end of the contour that begins there: it comes back to
   where it has started.  Splines that need neighbours have a point before the start, cubic ones
   another one behind the end, and those of Bezier four points a curve. */
static size_t end_of_contour(const Points *points, Spline spline, size_t begin)
{
    size_t start = begin + (spline == QUADRATIC || spline == CUBIC),
           step  = spline == BEZIER ? 4 : 1;
    for (size_t i = start + (spline == BEZIER ? 3 : 1); i < points->count; i += step)
        if (is_same(points, i, start)) {
            size_t end = i + 1 + (spline == CUBIC);
            return end < points->count ? end : points->count;
        }
    return points->count;
}

/* Returns a figure; several contours cut holes. */
static Part *figure_of(PovReader *reader, unsigned line, Spline spline, const Points *points)
{
    Part *figure = NULL;
    for (size_t begin = 0, end; begin < points->count; begin = end) {
        end            = end_of_contour(points, spline, begin);
        Points contour = {.items = points->items + begin, .count = end - begin};
        if (contour.count < 3)
            continue;
        contour = flattened(reader, spline, &contour);
        if (contour.count > 1 && is_same(&contour, 0, contour.count - 1))
            contour.count--;
        if (contour.count < 3)
            continue;
        Part *next = polygon(reader, line, contour.items, contour.count);
        Part *both = part_new(reader->import, line, "polygons");
        both->join = PART_XOR;
        if (figure) {
            part_add(reader->import, both, figure);
            part_add(reader->import, both, next);
        }
        figure = figure ? both : next;
    }
    return figure;
}

Part *pov_figure(PovReader *reader, unsigned line, double (*points)[3], size_t count)
{
    Points contours = {.items = points, .count = count};
    return figure_of(reader, line, LINEAR, &contours);
}

bool pov_prism(PovReader *reader, unsigned line, Part **part)
{
    /* A figure in x and y stands along z; here it lies in x and z. */
    static const Transform upright = {{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}}, {0, 0, 0}};
    Points                 points  = {0};
    double                 low, high;
    Spline                 spline = LINEAR;
    Text                   text   = {.arena = reader->import->arena};
    for (int i = 0; i < 2; i++) {
        Spline found = read_spline(reader);
        spline       = found != LINEAR ? found : spline;
        word_accept(&reader->words, "linear_sweep");
    }
    if (word_is(&reader->words, "conic_sweep"))
        return import_refuse(reader->import, line, "`conic_sweep` is not translated");
    if (!pov_number(reader, &low))
        return false;
    word_accept(&reader->words, ",");
    if (!pov_number(reader, &high))
        return false;
    word_accept(&reader->words, ",");
    if (!read_points(reader, &points))
        return false;
    word_accept(&reader->words, ",");
    Part *figure = figure_of(reader, line, spline, &points);
    if (!figure || low == high)
        return import_refuse(reader->import, line, "this prism has no volume");
    text_format(&text, ".extrude(%s)", import_number_text(reader->import, fabs(high - low)));
    Transform moved  = transform_move((double[]){0, (low + high) / 2, 0});
    *part            = part_around(reader->import, line, "prism", figure);
    (*part)->figure  = false;
    (*part)->methods = text.bytes;
    part_move(*part, &upright);
    part_move(*part, &moved);
    return true;
}

bool pov_lathe(PovReader *reader, unsigned line, Part **part)
{
    Points points = {0};
    Spline spline = read_spline(reader);
    if (!read_points(reader, &points))
        return false;
    word_accept(&reader->words, ",");
    points              = flattened(reader, spline, &points);
    const double *first = points.items[0], *last = points.items[points.count - 1];
    double        from = first[1], to = last[1];
    bool          closed = distance3(first, last) < 1e-9;
    if (!closed && (fabs(first[0]) > 1e-9 || fabs(last[0]) > 1e-9))
        import_note(reader->import, line, "a lathe that is open is closed towards its axis");
    if (!closed) {
        add_point(reader, &points, 0, to);
        add_point(reader, &points, 0, from);
    }
    Part *figure     = polygon(reader, line, points.items, points.count);
    *part            = part_around(reader->import, line, "lathe", figure);
    (*part)->figure  = false;
    (*part)->methods = ".revolve(0)";
    return true;
}

/* ---- texts ---- */

/* Reads `ttf "file.ttf" "string" thickness, offset`. */
bool pov_text(PovReader *reader, unsigned line, Part **part)
{
    WordReader *words = &reader->words;
    const char *font, *string;
    double      thickness, offset[3];
    Text        text = {.arena = reader->import->arena}, path = {.arena = reader->import->arena};
    word_accept(words, "ttf");
    if (!pov_string(reader, &font))
        return false;
    word_accept(&reader->words, ",");
    if (!pov_string(reader, &string))
        return false;
    word_accept(&reader->words, ",");
    if (!pov_number(reader, &thickness))
        return false;
    word_accept(&reader->words, ",");
    if (!pov_vector(reader, offset))
        return false;
    if (string[0] == '\0' || !(thickness > 0))
        return import_refuse(reader->import, line, "this text shows nothing");
    text_add(&text, "text(\"");
    for (const char *c = string; *c; c++)
        text_format(&text, *c == '"' ? "\\%c" : "%c", *c);
    text_add(&text, "\"");
    text_format(&path, "/usr/share/povray-3.7/include/%s", font);
    if (reader->import->root)
        import_note(reader->import, line,
                    "the font `%.60s` is not read: an untrusted import reads nothing of POV-Ray's "
                    "folders; another one is taken",
                    font);
    else if (!strstr(font, "..") && access(path.bytes, R_OK) == 0)
        text_format(&text, ", font: \"%s\"", path.bytes);
    else
        import_note(reader->import, line, "the font `%.60s` is not found: another one is taken",
                    font);
    text_format(&text, ").extrude(%s)", import_number_text(reader->import, thickness));
    *part           = part_shape(reader->import, line, "text", "%s", text.bytes);
    Transform moved = transform_move((double[]){0, 0, -thickness / 2});
    part_move(*part, &moved);
    return true;
}

/* ---- discs ---- */

bool pov_disc(PovReader *reader, unsigned line, Part **part)
{
    double center[3], v[3], normal[3], radius, hole = 0, p[3];
    Text   text = {.arena = reader->import->arena};
    if (!pov_vector(reader, center))
        return false;
    word_accept(&reader->words, ",");
    if (!pov_vector(reader, v))
        return false;
    word_accept(&reader->words, ",");
    if (!pov_number(reader, &radius))
        return false;
    if (word_accept(&reader->words, ",") && pov_value_follows(reader) && !pov_number(reader, &hole))
        return false;
    pov_point(v, normal);
    if (!normalize3(normal) || !(radius > hole))
        return import_refuse(reader->import, line, "a disc has no normal, or no radius");
    import_note(reader->import, line, "discs are a thousandth of their radius thick");
    const char *height = import_number_text(reader->import, 1e-3 * radius);
    text_format(&text, "cylinder(%s, %s)", import_number_text(reader->import, radius), height);
    if (hole > 0) {
        Text ring = {.arena = reader->import->arena};
        text_format(&ring, "(%s - cylinder(%s, %s))", text.bytes,
                    import_number_text(reader->import, hole),
                    import_number_text(reader->import, radius));
        text = ring;
    }
    if (normal[0] != 0 || normal[2] != 0)
        text_format(&text, ".align([0, 1, 0], %s)", import_vector_text(reader->import, normal, 3));
    *part = part_shape(reader->import, line, "disc", "%s", text.bytes);
    pov_point(center, p);
    add_scaled3(p, p, -0.5e-3 * radius, normal); /* its upper side is where the disc is */
    Transform moved = transform_move(p);
    part_move(*part, &moved);
    return true;
}

/* ---- fields ---- */

typedef struct BlobReader {
    PovReader *reader;
    Text       terms;
    double     low[3], high[3];
} BlobReader;

static void grow_box(BlobReader *blob, const double p[3], double radius)
{
    for (int i = 0; i < 3; i++) {
        blob->low[i]  = fmin(blob->low[i], p[i] - radius);
        blob->high[i] = fmax(blob->high[i], p[i] + radius);
    }
}

/* Reads a component: a sphere, or a cylinder with round ends. */
static bool read_component(BlobReader *blob, bool round)
{
    PovReader *reader = blob->reader;
    Import    *import = reader->import;
    double     a[3], b[3], p[3], q[3], radius, strength = 1;
    words_advance(&reader->words);
    if (!word_expect(&reader->words, "{") || !pov_vector(reader, a))
        return false;
    word_accept(&reader->words, ",");
    if (!round && !pov_vector(reader, b))
        return false;
    word_accept(&reader->words, ",");
    if (!pov_number(reader, &radius))
        return false;
    word_accept(&reader->words, ",");
    word_accept(&reader->words, "strength");
    if (pov_value_follows(reader) && !pov_number(reader, &strength))
        return false;
    bool      moved     = false;
    Transform transform = transform_identity();
    while (!word_is(&reader->words, "}")) {
        PovLook ignored = pov_usual_look();
        bool    taken = false, looks = false;
        if (!pov_transform(reader, &transform, &taken) ||
            (!taken && !pov_look(reader, &ignored, &looks)))
            return false;
        if (!taken && !looks && !pov_leave_out(reader, "of a blob is"))
            return false;
        moved = moved || taken;
    }
    double factor = moved ? transform_factor(&transform) : 1;
    if (!(radius > 0) || factor == 0)
        return import_refuse(import, reader->words.word.line,
                             "this component of a blob is not translated");
    transform_apply(&transform, a, a);
    pov_point(a, p);
    radius *= factor;
    grow_box(blob, p, radius);
    const char *from = import_vector_text(import, p, 3);
    if (round) {
        text_format(&blob->terms, "%s%s * max(1 - dot(p - %s, p - %s) / %s, 0)^2",
                    blob->terms.length > 0 ? "\n    + " : "", import_number_text(import, strength),
                    from, from, import_number_text(import, radius * radius));
    } else {
        transform_apply(&transform, b, b);
        pov_point(b, q);
        grow_box(blob, q, radius);
        double way[3];
        add_scaled3(way, q, -1, p);
        const char *along = import_vector_text(import, way, 3);
        text_format(&blob->terms,
                    "%s%s * (let h = clamp(dot(p - %s, %s) / %s, 0, 1) in let q = "
                    "p - %s - h * %s in"
                    " max(1 - dot(q, q) / %s, 0)^2)",
                    blob->terms.length > 0 ? "\n    + " : "", import_number_text(import, strength),
                    from, along, import_number_text(import, dot3(way, way)), from, along,
                    import_number_text(import, radius * radius));
    }
    return word_expect(&reader->words, "}");
}

bool pov_blob(PovReader *reader, unsigned line, Part **part)
{
    WordReader *words     = &reader->words;
    double      threshold = 1, size[3], middle[3];
    BlobReader  blob      = {.reader = reader,
                             .terms  = {.arena = reader->import->arena},
                             .low    = {INFINITY, INFINITY, INFINITY},
                             .high   = {-INFINITY, -INFINITY, -INFINITY}};
    for (;; word_accept(&reader->words, ",")) {
        if (word_accept(words, "threshold")) {
            if (!pov_number(reader, &threshold))
                return false;
        } else if (word_is(words, "sphere") || word_is(words, "cylinder")) {
            if (!read_component(&blob, word_is(words, "sphere")))
                return false;
        } else {
            break;
        }
        if (!pov_release(reader))
            return false;
    }
    if (blob.terms.length == 0)
        return word_refuse(words, "`sphere` or `cylinder`");
    for (int i = 0; i < 3; i++) {
        size[i]   = blob.high[i] - blob.low[i];
        middle[i] = 0.5 * (blob.high[i] + blob.low[i]);
    }
    Text equation = {.arena = reader->import->arena}, extent = {.arena = reader->import->arena};
    text_format(&equation, "field(%s - (%s))", import_number_text(reader->import, threshold),
                blob.terms.bytes);
    text_format(&extent, "box(%s).move(%s)", import_vector_text(reader->import, size, 3),
                import_vector_text(reader->import, middle, 3));
    *part = part_shape(reader->import, line, "blob", "%s\n    .within(%s)", equation.bytes,
                       extent.bytes);
    (*part)->equation = equation.bytes;
    (*part)->extent   = extent.bytes;
    return true;
}

/* Builds (|x|^(2/e) + |y|^(2/e))^(e/n) + |z|^(2/n) = 1; if e is less than n, solved for the first
   sum. */
bool pov_superellipsoid(PovReader *reader, unsigned line, Part **part)
{
    double v[3];
    if (!pov_vector(reader, v))
        return false;
    if (!(v[0] > 0 && v[1] > 0))
        return import_refuse(reader->import, line, "the exponents are not above 0");
    Text        text = {.arena = reader->import->arena}, trial = {.arena = reader->import->arena};
    const char *across = import_number_text(reader->import, 2 / v[0]);
    const char *along  = import_number_text(reader->import, 2 / v[1]);
    if (v[0] < v[1]) /* so that no exponent is below 1 */
        text_format(&text,
                    "field(pow(abs(x), %s) + pow(abs(y), %s) - pow(max(1 - "
                    "pow(abs(z), %s), 0), %s))",
                    across, across, along, import_number_text(reader->import, v[1] / v[0]));
    else
        text_format(&text,
                    "field(pow(pow(abs(x), %s) + pow(abs(y), %s), %s) + "
                    "pow(abs(z), %s) - 1)",
                    across, across, import_number_text(reader->import, v[0] / v[1]), along);
    text_format(&trial, "show %s.within(box([2, 2, 2]));", text.bytes);
    if (!import_compiles(reader->import, trial.bytes))
        return import_refuse(reader->import, line,
                             "a superellipsoid of these exponents is not translated");
    *part = part_shape(reader->import, line, "superellipsoid", "%s.within(box([2, 2, 2]))",
                       text.bytes);
    (*part)->equation = text.bytes;
    (*part)->extent   = "box([2, 2, 2])";
    return true;
}

/* Makes a Julia set in the space in which the fourth coordinate is 0. */
bool pov_julia(PovReader *reader, unsigned line, Part **part)
{
    WordReader *words = &reader->words;
    PovValue    c;
    double      iterations = 20;
    int         power      = 2;
    if (!pov_value(reader, &c))
        return false;
    while (!pov_modifier_follows(reader)) {
        double ignored;
        if (word_accept(words, "quaternion") || word_accept(words, "sqr"))
            continue;
        if (word_accept(words, "cube"))
            power = 3;
        else if (word_accept(words, "max_iteration")) {
            if (!pov_number(reader, &iterations))
                return false;
        } else if (word_accept(words, "precision")) {
            if (!pov_number(reader, &ignored))
                return false;
        } else {
            return import_refuse(reader->import, line, "`%.30s` of a Julia set is not translated",
                                 words->word.text);
        }
    }
    *part = part_shape(reader->import, line, "julia", "julia(c: %s, power: %d, iterations: %d)",
                       import_vector_text(reader->import, c.v, 4), power,
                       (int)fmin(fmax(iterations, 1), 64));
    Transform mirror = transform_scale((double[]){1, 1, -1});
    part_move(*part, &mirror);
    return true;
}
