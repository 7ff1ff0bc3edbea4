/*
 * part.c: a scene of another program as a tree of parts, and how it is
 * written: a `let` for each part, what it is made of before it.
 */
#include "import/common/part.h"

#include <math.h>
#include <string.h>

#include "compiler/base/vec.h"

enum { PAINTED = 1, UNPAINTED = 2, MAX_WRITTEN = 200000, MAX_DEPTH = 1000, WIDTH = 100 };

Part *part_new(Import *import, unsigned line, const char *stem)
{
    Part *part      = arena_new(import->arena, Part);
    part->stem      = stem;
    part->line      = line;
    part->transform = transform_identity();
    return part;
}

Part *part_shape(Import *import, unsigned line, const char *stem, const char *format, ...)
{
    Part   *part = part_new(import, line, stem);
    Text    text = {.arena = import->arena};
    va_list arguments;
    va_start(arguments, format);
    text_format_list(&text, format, arguments);
    va_end(arguments);
    part->shape = text.bytes;
    return part;
}

void part_add(Import *import, Part *part, Part *item)
{
    part->depth  = item->depth >= part->depth ? item->depth + 1 : part->depth;
    part->figure = part->parts.count == 0 ? item->figure : part->figure;
    array_push(import->arena, &part->parts, item);
}

Part *part_around(Import *import, unsigned line, const char *stem, Part *what)
{
    Part *part = part_new(import, line, stem);
    part_add(import, part, what);
    return part;
}

void part_move(Part *part, const Transform *transform)
{
    part->transform = transform_chain(&part->transform, transform);
}

/* Tells whether a point is in a round part, with `n` as of PART_ROUND: the radius changes from one
   end to the other. */
static bool is_in_round(const double n[6], const double p[3])
{
    double off[3], along = dot3(n, p);
    add_scaled3(off, p, -along, n);
    double part = 0.5 + 0.5 * along / n[3];
    return fabs(along) < n[3] && length3(off) < n[4] + part * (n[5] - n[4]);
}

static bool is_in(const PartInside *inside, const double p[3])
{
    const double *n = inside->numbers;
    switch (inside->kind) {
    case PART_BALL: return length3(p) < n[0];
    case PART_BOX: return fabs(p[0]) < n[0] && fabs(p[1]) < n[1] && fabs(p[2]) < n[2];
    case PART_HALF_SPACE: return dot3(n, p) < n[3];
    case PART_ROUND: return is_in_round(n, p);
    case PART_RING: return hypot(hypot(p[0], p[2]) - n[0], p[1]) < n[1];
    default: return false;
    }
}

bool part_holds(const Part *part, const double point[3])
{
    Transform back = part->transform;
    double    p[3];
    size_t    held = 0, count = part->parts.count;
    if (!transform_invert(&back) || part->depth > MAX_DEPTH)
        return false;
    transform_apply(&back, point, p);
    bool first = false, in = is_in(&part->inside, p);
    for (size_t i = 0; i < count && !part->methods; i++) {
        bool item = part_holds(part->parts.items[i], p);
        held += item;
        first = i == 0 ? item : first;
    }
    if (count > 0)
        in = part->join == PART_UNION          ? held > 0
             : part->join == PART_INTERSECTION ? held == count
             : part->join == PART_DIFFERENCE   ? first && held == 1
                                               : false;
    return in != part->outside;
}

const char *import_number_text(Import *import, double number)
{
    Text text = {.arena = import->arena};
    import_add_number(&text, import_rounded(number));
    return text.bytes;
}

const char *import_vector_text(Import *import, const double *numbers, int count)
{
    Text   text = {.arena = import->arena};
    double most = 0;
    for (int i = 0; i < count; i++)
        most = fmax(most, fabs(numbers[i]));
    for (int i = 0; i < count; i++) {
        double number = fabs(numbers[i]) > 1e-14 * most ? numbers[i] : 0; /* else it is noise */
        text_format(&text, "%s%s", i == 0 ? "[" : ", ", import_number_text(import, number));
    }
    text_add(&text, "]");
    return text.bytes;
}

/* ---- writing ---- */

/* Tells how many of its parts are seen: the region of a clipped one is not. */
static size_t seen_items(const Part *part)
{
    return part->join == PART_CLIP ? 1 : part->parts.count;
}

/* Tells whether a part, or what it is made of, has looks of its own: all of it,
 * nothing, or some. */
static int part_painted(Part *part)
{
    if (part->painted == 0) {
        for (size_t i = 0; i < seen_items(part) && !part->look; i++)
            part->painted |= part_painted(part->parts.items[i]);
        if (part->look)
            part->painted = PAINTED;
        else if (part->parts.count == 0)
            part->painted = UNPAINTED;
    }
    return part->painted;
}

bool part_is_painted(Part *part) { return part_painted(part) == PAINTED; }

static int items_painted(const Part *part)
{
    int painted = part->parts.count == 0 ? UNPAINTED : 0;
    for (size_t i = 0; i < seen_items(part); i++)
        painted |= part_painted(part->parts.items[i]);
    return painted;
}

/* Writes the names of what it is made of, on lines that are not too long. */
static void write_join(Text *text, const Part *part, const char *const *names)
{
    static const char *const functions[] = {"union(", "intersection(", "difference(", "xor(",
                                            "hull("};
    size_t                   width       = 40;
    if (part->join == PART_CLIP) {
        text_format(text, "%s.within(%s, open: true)", names[0], names[1]);
        return;
    }
    text_add(text, functions[part->join]);
    for (size_t i = 0; i < part->parts.count; i++) {
        width += strlen(names[i]) + 2;
        bool wraps = i > 0 && width > WIDTH;
        text_format(text, "%s%s", i == 0 ? "" : wraps ? ",\n    " : ", ", names[i]);
        width = wraps ? strlen(names[i]) + 4 : width;
    }
    text_add(text, ")");
}

/* Returns its name there; NULL after a refusal. */
static const char *write_let(PartWriter *writer, Part *part, const char *const *names,
                             const char *look)
{
    Import *import = writer->import;
    Text   *text = &import->scene, name = {.arena = import->arena};
    if (++writer->written > MAX_WRITTEN) {
        import_refuse(import, part->line, "the scene has more than %d parts", MAX_WRITTEN);
        return NULL;
    }
    if (part->wanted)
        text_add(&name, part->wanted);
    else
        text_format(&name, "%s_%zu", part->stem, writer->written);
    part->wanted = NULL; /* there may be another one, of another look */
    import_mark(import, part->line);
    text_format(text, "let %s = ", name.bytes);
    if (part->outside)
        text_add(text, "difference(plane([0, 1, 0], 1e6), ");
    if (part->shape)
        text_add(text, part->shape);
    else if (part->parts.count == 1 && part->join != PART_HULL)
        text_add(text, names[0]);
    else
        write_join(text, part, names);
    text_add(text, part->methods ? part->methods : "");
    if (!transform_write(text, &part->transform)) {
        import_refuse(import, part->line, "its transform flattens this to nothing");
        return NULL;
    }
    if (part->outside)
        text_add(text, ")");
    if (look)
        text_format(text, ".paint(%s)", look);
    text_format(text, "; // line %u\n", part->line);
    return name.bytes;
}

/* Writes a part; `around` is the material of what it is a part of. */
static const char *write_part(PartWriter *writer, Part *part, const char *around)
{
    int         inside = items_painted(part);
    const char *look   = part->look ? part->look : around;
    bool        pushed = writer->inner_looks && inside != UNPAINTED;
    bool        plain  = !around || part_painted(part) == PAINTED; /* the same wherever it is */
    if (plain && part->shared && part->name)
        return part->name;
    const char **names = arena_new_array(writer->import->arena, const char *,
                                         part->parts.count + 1);
    for (size_t i = 0; i < part->parts.count; i++) {
        names[i] = write_part(writer, part->parts.items[i],
                              pushed && i < seen_items(part) ? look : NULL);
        if (!names[i])
            return NULL;
    }
    const char *name = write_let(writer, part, names, pushed ? NULL : look);
    if (plain)
        part->name = name;
    return name;
}

bool part_write(PartWriter *writer, Part *part)
{
    if (part->depth > MAX_DEPTH)
        return import_refuse(writer->import, part->line, "parts are more than %d deep", MAX_DEPTH);
    return write_part(writer, part, NULL) != NULL;
}

bool part_show(PartWriter *writer, Part *part, const char *methods)
{
    if (!part_write(writer, part))
        return false;
    text_format(&writer->import->scene, "show %s%s;\n", part->name, methods);
    return true;
}
