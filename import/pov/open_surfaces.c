/*
 * open_surfaces.c: surfaces of POV-Ray that enclose nothing: objects that are clipped, columns that
 * are open, triangles and polygons.
 *
 * `clipped_by` cuts a surface where `intersection` cuts a solid: what is left has no cut faces, and both
 * of its sides are seen.  In scenes that is an equation `.within` a region.  So an object is taken apart
 * into the equations of its surfaces.  Of a join each surface is within the region and within, or
 * outside of, the other objects of the join.
 */
#include <math.h>
#include <string.h>

#include "import/pov/reader.h"
#include "compiler/base/vec.h"

enum { MAX_POINTS = 10000, MAX_FIGURES = 500 };

static const double FAR_AWAY = 1e5; /* open surfaces end somewhere */

/* The arguments of a cut: `open_surfaces` has them in the space of the whole object, and `region`
   is in that space. */
typedef struct Cut {
    Import     *import;
    Part       *open_surfaces;
    const char *name; /* of the object, for words about it */
    unsigned    line;
    bool        open; /* without the ends of columns */
} Cut;

bool pov_is_open_surface(const Part *part)
{
    bool found = part->join == PART_CLIP;
    for (size_t i = 0; i < part->parts.count && !found; i++)
        found = pov_is_open_surface(part->parts.items[i]);
    return found;
}

static bool is_bounded(const Part *part)
{
    size_t bounded = 0, count = part->parts.count;
    if (part->outside)
        return false;
    if (part->shape)
        return part->inside.kind != PART_HALF_SPACE && (!part->equation || part->extent);
    for (size_t i = 0; i < count; i++)
        bounded += is_bounded(part->parts.items[i]);
    return part->methods || (part->join == PART_INTERSECTION ? bounded > 0
                             : part->join == PART_DIFFERENCE ? is_bounded(part->parts.items[0])
                                                             : bounded == count);
}

/* Returns both parts joined, or the one that there is. */
static Part *both(Import *import, PartJoin join, Part *a, Part *b)
{
    if (!a || !b)
        return a ? a : b;
    Part *part = part_new(import, a->line, join == PART_DIFFERENCE ? "without" : "within");
    part->join = join;
    part_add(import, part, a);
    part_add(import, part, b);
    return part;
}

/* Adds `equation` as the language has it, within `own`, a region of the same space, if there is
   one. */
static void add_open_surface(Cut *cut, const Part *like, const Transform *transform,
                             const char *look, Part *region, const char *equation, const char *own)
{
    Part *surface = part_shape(cut->import, like->line, "surface", "%s", equation);
    Part *part = part_new(cut->import, like->line, "sheet"), *extent = NULL;
    if (own) {
        extent            = part_shape(cut->import, like->line, "extent", "%s", own);
        extent->transform = *transform;
    }
    surface->transform = *transform;
    surface->equation  = surface->shape;
    part->join         = PART_CLIP;
    part->look         = look;
    part_add(cut->import, part, surface);
    part_add(cut->import, part, both(cut->import, PART_INTERSECTION, extent, region));
    part_add(cut->import, cut->open_surfaces, part);
}

/* Returns a normal times the point. */
static const char *along(Import *import, const double n[3])
{
    Text text = {.arena = import->arena};
    for (int i = 0; i < 3; i++)
        if (n[i] == 1)
            text_format(&text, "%s%c", text.length > 0 ? " + " : "", "xyz"[i]);
        else if (n[i] != 0)
            text_format(&text, "%s%s * %c", text.length > 0 ? " + " : "",
                        import_number_text(import, n[i]), "xyz"[i]);
    return text.bytes;
}

static const char *formatted(Import *import, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

static const char *formatted(Import *import, const char *format, ...)
{
    Text    text = {.arena = import->arena};
    va_list arguments;
    va_start(arguments, format);
    text_format_list(&text, format, arguments);
    va_end(arguments);
    return text.bytes;
}

/* Cuts a column: its side, and the discs that end it. */
static void cut_column(Cut *cut, const Part *part, const Transform *transform, const char *look,
                       Part *region)
{
    Import       *import = cut->import;
    const double *n = part->inside.numbers, half = n[3], *radii = n + 4;
    double        back[3] = {-n[0], -n[1], -n[2]}, wide = fmax(radii[0], radii[1]);
    const char   *axis = along(import, n), *height = import_number_text(import, half);
    const char   *at[2] = {import_number_text(import, -half), height};
    const char   *slab = formatted(import, "intersection(sphere(%s), plane(%s, %s), plane(%s, %s))",
                                   import_number_text(import, 1.01 * hypot(half, wide)),
                                   import_vector_text(import, n, 3), height,
                                   import_vector_text(import, back, 3), height);
    add_open_surface(cut, part, transform, look, region,
                     formatted(import, "algebraic(x^2 + y^2 + z^2 - (%s)^2 == (%s + %s * (%s))^2)",
                               axis, import_number_text(import, (radii[0] + radii[1]) / 2),
                               import_number_text(import, (radii[1] - radii[0]) / (2 * half)),
                               axis),
                     slab);
    for (int i = 0; i < 2 && !cut->open; i++)
        if (radii[i] > 0)
            add_open_surface(
                cut, part, transform, look, region,
                formatted(import, "algebraic(%s == %s)", axis, at[i]),
                formatted(import, "sphere(%s)", import_number_text(import, hypot(half, radii[i]))));
}

static void cut_box(Cut *cut, const Part *part, const Transform *transform, const char *look,
                    Part *region)
{
    for (int i = 0; i < 3; i++) {
        double size[3];
        for (int k = 0; k < 3; k++)
            size[k] = (k == i ? 2.1 : 2) * part->inside.numbers[k];
        add_open_surface(
            cut, part, transform, look, region,
            formatted(cut->import, "algebraic(%c^2 == %s^2)", "xyz"[i],
                      import_number_text(cut->import, part->inside.numbers[i])),
            formatted(cut->import, "box(%s)", import_vector_text(cut->import, size, 3)));
    }
}

static bool cut_shape(Cut *cut, const Part *part, const Transform *transform, const char *look,
                      Part *region)
{
    Import       *import = cut->import;
    const double *n      = part->inside.numbers;
    bool          ends   = region && is_bounded(region);
    const char   *r      = import_number_text(import, n[0]);
    const char   *around = ends ? NULL : formatted(import, "sphere(%g)", FAR_AWAY);
    if (part->inside.kind == PART_BALL) {
        add_open_surface(
            cut, part, transform, look, region,
            formatted(import, "algebraic(x^2 + y^2 + z^2 == %s^2)", r),
            ends ? NULL : formatted(import, "sphere(%s)", import_number_text(import, 1.01 * n[0])));
    } else if (part->inside.kind == PART_RING) {
        double outer = 1.01 * (n[0] + n[1]);
        add_open_surface(
            cut, part, transform, look, region,
            formatted(import, "algebraic((x^2 + y^2 + z^2 + %s)^2 == 4 * %s^2 * (x^2 + z^2))",
                      import_number_text(import, n[0] * n[0] - n[1] * n[1]), r),
            ends ? NULL : formatted(import, "sphere(%s)", import_number_text(import, outer)));
    } else if (part->inside.kind == PART_ROUND) {
        cut_column(cut, part, transform, look, region);
    } else if (part->inside.kind == PART_BOX) {
        cut_box(cut, part, transform, look, region);
    } else if (part->inside.kind == PART_HALF_SPACE) {
        add_open_surface(cut, part, transform, look, region,
                         formatted(import, "algebraic(%s == %s)", along(import, n),
                                   import_number_text(import, n[3])),
                         around);
    } else if (part->equation) {
        add_open_surface(cut, part, transform, look, region, part->equation,
                         part->extent ? part->extent : around);
    } else {
        return import_refuse(import, cut->line, "`%s` of a %s is not translated", cut->name,
                             part->stem);
    }
    if (!ends && (part->inside.kind == PART_HALF_SPACE || (part->equation && !part->extent)))
        import_note(import, cut->line, "what is endless and clipped ends %g units away", FAR_AWAY);
    return true;
}

static Part *placed(Import *import, Part *part, const Transform *transform)
{
    static const Transform here = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 0, 0}};
    part->shared                = true;
    if (memcmp(transform, &here, sizeof here) == 0)
        return part;
    Part *moved      = part_around(import, part->line, part->stem, part);
    moved->transform = *transform;
    return moved;
}

/* Returns the region within which the surface of item i of a join is seen. */
static Part *region_of(Cut *cut, const Part *join, size_t i, const Transform *transform,
                       Part *region)
{
    for (size_t k = 0; k < join->parts.count && join->join != PART_UNION; k++)
        if (k != i && (k == 0 || join->join == PART_INTERSECTION))
            region = both(cut->import, PART_INTERSECTION, region,
                          placed(cut->import, join->parts.items[k], transform));
    for (size_t k = 1; k < join->parts.count && join->join == PART_DIFFERENCE; k++)
        if (k != i) {
            Part *without = placed(cut->import, join->parts.items[k], transform);
            if (region) {
                region = both(cut->import, PART_DIFFERENCE, region, without);
            } else {
                region          = part_around(cut->import, without->line, "without", without);
                region->outside = true;
            }
        }
    return region;
}

/* Adds the surfaces of a part, which is placed within what is at `outer`. */
static bool cut_part(Cut *cut, Part *part, const Transform *outer, const char *look, Part *region)
{
    Transform transform = transform_chain(&part->transform, outer);
    bool      many      = part->parts.count > 1;
    look                = part->look ? part->look : look;
    if (part->join == PART_CLIP)
        return cut_part(cut, part->parts.items[0], &transform, look,
                        both(cut->import, PART_INTERSECTION, region,
                             placed(cut->import, part->parts.items[1], &transform)));
    if (part->shape)
        return cut_shape(cut, part, &transform, look, region);
    if (part->methods || part->join > PART_DIFFERENCE || (many && part->outside) ||
        (many && strcmp(part->stem, "merge") == 0))
        return import_refuse(cut->import, cut->line, "`%s` of %s is not translated", cut->name,
                             part->outside              ? "what is inverse and of several parts"
                             : part->join == PART_UNION ? part->stem
                                                        : "such a part");
    for (size_t i = 0; i < part->parts.count; i++)
        if (!cut_part(cut, part->parts.items[i], &transform, look,
                      region_of(cut, part, i, &transform, region)))
            return false;
    return true;
}

static Part *cut_whole(Import *import, Part *part, const char *name, unsigned line, bool open,
                       Part *region)
{
    Cut       cut  = {.import        = import,
                      .open_surfaces = part_new(import, part->line, part->stem),
                      .name          = name,
                      .line          = line,
                      .open          = open};
    Transform here = transform_identity();
    return cut_part(&cut, part, &here, NULL, region) ? cut.open_surfaces : NULL;
}

bool pov_clip(PovReader *reader, const Transform *transform, Part **part, unsigned line,
              Part *region)
{
    Transform back = transform_mirrored(transform);
    if (pov_is_open_surface(region))
        return import_refuse(reader->import, line,
                             "`clipped_by` what is clipped is not translated");
    if (!transform_invert(&back))
        return import_refuse(reader->import, line, "its transform flattens this to nothing");
    region->shared = true;
    *part          = cut_whole(reader->import, *part, "clipped_by", line, false,
                               placed(reader->import, region, &back));
    return *part != NULL;
}

bool pov_open(PovReader *reader, unsigned line, Part **part)
{
    if ((*part)->inside.kind != PART_ROUND)
        return import_refuse(reader->import, line, "`open` of a %s is not translated",
                             (*part)->stem);
    *part = cut_whole(reader->import, *part, "open", line, true, NULL);
    return *part != NULL;
}

/* ---- flat figures ---- */

/* Finds the axes of the plane of points, and its normal; false: they are on a line. */
static bool frame_of(double (*points)[3], size_t count, Transform *frame)
{
    double x[3], y[3] = {0}, z[3] = {0}, most = 0;
    for (size_t i = 1; i < count; i++) { /* the widest triangle from the first point, twice */
        double a[3], b[3], across[3];
        add_scaled3(a, points[i], -1, points[0]);
        add_scaled3(b, points[i + 1 < count ? i + 1 : 1], -1, points[0]);
        cross3(a, b, across);
        if (length3(across) > most) {
            most = length3(across);
            memcpy(x, a, sizeof x);
            memcpy(z, across, sizeof z);
        }
    }
    if (!(most > 0) || !normalize3(x) || !normalize3(z))
        return false;
    cross3(z, x, y);
    for (int i = 0; i < 3; i++) {
        frame->rows[i][0] = x[i];
        frame->rows[i][1] = y[i];
        frame->rows[i][2] = z[i];
        frame->shift[i]   = points[0][i];
    }
    return true;
}

/* Finds the plane within what stands on a figure; points are POV-Ray's, and become those of the
   figure. */
static bool flat(PovReader *reader, unsigned line, double (*points)[3], size_t count, Part **part)
{
    Transform frame = transform_identity(), back;
    double    wide  = 0;
    if (++reader->flat_figures >
        MAX_FIGURES) /* no scene has room for them, as it takes long to find */
        return import_refuse(reader->import, line,
                             "more than %d triangles and polygons are not translated", MAX_FIGURES);
    for (size_t i = 0; i < count; i++)
        pov_point(points[i], points[i]);
    if (!frame_of(points, count, &frame))
        return true; /* nothing is seen of it */
    back = frame;
    transform_invert(&back);
    for (size_t i = 0; i < count; i++) {
        transform_apply(&back, points[i], points[i]);
        wide = fmax(wide, hypot(points[i][0], points[i][1]));
        if (fabs(points[i][2]) > 1e-4 * wide)
            return import_refuse(reader->import, line, "the points are not in a plane");
        points[i][2] = 0;
    }
    Part *figure = pov_figure(reader, line, points, count);
    if (!figure)
        return true;
    Part *column    = part_around(reader->import, line, "region", figure);
    column->figure  = false;
    column->methods = formatted(reader->import, ".extrude(%s)",
                                import_number_text(reader->import, wide));
    *part           = part_new(reader->import, line, "sheet");
    (*part)->join   = PART_CLIP;
    Part *plane     = part_shape(reader->import, line, "surface", "algebraic(z == 0)");
    plane->equation = plane->shape;
    part_add(reader->import, *part, plane);
    part_add(reader->import, *part, column);
    part_move(*part, &frame);
    return true;
}

static bool triangle(PovReader *reader, unsigned line, bool smooth, Part **part)
{
    double points[4][3], normal[3];
    for (int i = 0; i < 3; i++) {
        if (!pov_vector(reader, points[i]))
            return false;
        word_accept(&reader->words, ",");
        if (smooth && !pov_vector(reader, normal))
            return false;
        word_accept(&reader->words, ",");
    }
    if (smooth)
        import_note(reader->import, line, "smooth triangles are flat: their normals are left out");
    memcpy(points[3], points[0], sizeof points[0]);
    return flat(reader, line, points, 4, part);
}

bool pov_triangle(PovReader *reader, unsigned line, Part **part)
{
    return triangle(reader, line, false, part);
}

bool pov_smooth_triangle(PovReader *reader, unsigned line, Part **part)
{
    return triangle(reader, line, true, part);
}

/* Contours that end where they begin, and cut holes into each other; the last one may be open. */
bool pov_polygon(PovReader *reader, unsigned line, Part **part)
{
    double count;
    if (!pov_number(reader, &count))
        return false;
    if (!(count >= 3 && count <= MAX_POINTS))
        return import_refuse(reader->import, line, "a polygon has from 3 to %d points", MAX_POINTS);
    double(*points)[3] = arena_alloc(reader->import->arena, (size_t)count, sizeof *points);
    for (int i = 0; i < (int)count; i++) {
        word_accept(&reader->words, ",");
        if (!pov_vector(reader, points[i]))
            return false;
    }
    word_accept(&reader->words, ",");
    return flat(reader, line, points, (size_t)count, part);
}
