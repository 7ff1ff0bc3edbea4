/*
 * csg.c: trees of solids as `openscad -o FILE.csg` writes them: what a program of OpenSCAD
 * has computed, without variables and loops.
 *
 *     node  = { "#" } name "(" [ argument { "," argument } ] ")" ( ";" | "{" { node } "}" )
 *     argument = [ name "=" ] value
 *
 * Its z is up, that of scenes is towards the eye: the whole is rotated when it is shown.
 */
#include "import/csg/csg.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "import/csg/node.h"
#include "import/common/words.h"

typedef struct CsgReader {
    WordReader words;
    int        depth;
    bool       left_out; /* the last node is, by --keep-going: it is not nothing, but unknown */
} CsgReader;

static bool deeper(CsgReader *reader)
{
    return ++reader->depth <= IMPORT_MAX_DEPTH ||
           import_refuse(reader->words.import, reader->words.word.line, "more than %d deep",
                         IMPORT_MAX_DEPTH);
}

/* ---- joints ---- */

/* Refuses figures among solids; a union of one part is this part. */
static bool join_nodes(const CsgNode *node, PartJoin join, Part **part)
{
    if (!node->parts)
        return true;
    for (size_t i = 1; i < node->parts->parts.count; i++)
        if (node->parts->parts.items[i]->figure != node->parts->figure)
            return import_refuse(node->import, node->parts->parts.items[i]->line,
                                 "a %s stands beside a %s: `%s` joins solids, or figures",
                                 node->parts->figure ? "solid" : "plane figure",
                                 node->parts->figure ? "plane figure" : "solid", node->name);
    *part = node->parts->parts.count == 1 ? node->parts->parts.items[0] : node->parts;
    if (*part == node->parts)
        (*part)->join = join;
    return true;
}

bool csg_joined(const CsgNode *node, bool figure, Part **part)
{
    if (!join_nodes(node, PART_UNION, part))
        return false;
    return !*part || (*part)->figure == figure ||
           import_refuse(node->import, node->line, "`%s` needs %s", node->name,
                         figure ? "plane figures" : "solids");
}

static bool build_union(const CsgNode *node, Part **part)
{
    return join_nodes(node, PART_UNION, part);
}

/* Builds an intersection, which is nothing if a part is. */
static bool build_intersection(const CsgNode *node, Part **part)
{
    return node->lacks || join_nodes(node, PART_INTERSECTION, part);
}

static bool build_difference(const CsgNode *node, Part **part)
{
    return node->lacks_first || join_nodes(node, PART_DIFFERENCE, part);
}

static bool build_placed(const CsgNode *node, Part **part)
{
    const CsgValue *matrix    = csg_argument(node, "");
    Transform       transform = transform_identity();
    bool            good      = matrix && matrix->kind == CSG_LIST && matrix->list.count == 4;
    for (size_t i = 0; good && i < 16; i++) {
        const CsgValue *row = &matrix->list.items[i / 4];
        good                = row->kind == CSG_LIST && row->list.count == 4 &&
               row->list.items[i % 4].kind == CSG_NUMBER;
        if (!good)
            break;
        double number = row->list.items[i % 4].number;
        if (i >= 12)
            good = number == (i == 15);
        else if (i % 4 == 3)
            transform.shift[i / 4] = number;
        else
            transform.rows[i / 4][i % 4] = number;
    }
    if (!good)
        return import_refuse(node->import, node->line,
                             "`multmatrix` needs four rows of four numbers, the last 0, 0, 0, 1");
    if (!join_nodes(node, PART_UNION, part))
        return false;
    if (*part && (*part)->figure && !transform_flatten(&transform))
        return import_refuse(node->import, node->line,
                             "this turns a plane figure out of its plane");
    if (*part)
        part_move(*part, &transform);
    return true;
}

/* The outermost colour counts, as in scenes. */
static bool build_colored(const CsgNode *node, Part **part)
{
    const CsgValue *color     = csg_argument(node, "");
    double          levels[4] = {0, 0, 0, 1};
    char            hex[8];
    if (!join_nodes(node, PART_UNION, part) || !*part)
        return node->import->refusal.length == 0;
    for (size_t i = 0; color && color->kind == CSG_LIST && i < 4 && i < color->list.count; i++)
        levels[i] = color->list.items[i].number;
    if (levels[0] < 0) /* none */
        return true;
    for (int i = 0; i < 3; i++)
        snprintf(hex + 1 + 2 * i, 3, "%02x", (unsigned)lround(255 * fmin(fmax(levels[i], 0), 1)));
    hex[0] = '#';
    if (levels[3] < 1)
        import_note(node->import, node->line, "nothing is transparent");
    (*part)->look = arena_copy_text(node->import->arena, hex, 7);
    return true;
}

/* ---- the tree ---- */

static const struct {
    const char *name;
    CsgBuild   *build;
} nodes[] = {
    {"group", build_union},
    {"union", build_union},
    {"render", build_union},
    {"intersection", build_intersection},
    {"difference", build_difference},
    {"multmatrix", build_placed},
    {"color", build_colored},
    {"cube", csg_cube},
    {"sphere", csg_sphere},
    {"cylinder", csg_cylinder},
    {"polyhedron", csg_polyhedron},
    {"square", csg_square},
    {"circle", csg_circle},
    {"polygon", csg_polygon},
    {"linear_extrude", csg_linear_extrude},
    {"rotate_extrude", csg_rotate_extrude},
    {"hull", csg_hull},
    {"minkowski", csg_minkowski},
    {"offset", csg_offset},
    {"text", csg_text},
    {"resize", csg_resize},
    {"projection", csg_projection},
    {"import", csg_import},
    {"surface", csg_surface},
};
enum { NODES = sizeof nodes / sizeof *nodes };

static bool read_value(CsgReader *reader, CsgValue *value)
{
    WordReader *words    = &reader->words;
    bool        negative = word_accept(words, "-"), truth = word_is(words, "true");
    *value = (CsgValue){.kind = CSG_NUMBER, .number = words->word.number};
    if (words->word.kind == IMPORT_WORD_NUMBER) {
        value->number = negative ? -value->number : value->number;
        words_advance(words);
        return true;
    }
    value->kind   = words->word.kind == IMPORT_WORD_STRING ? CSG_STRING : CSG_TRUTH;
    value->string = words->word.text;
    value->number = truth;
    if (truth || word_is(words, "false") || words->word.kind == IMPORT_WORD_STRING) {
        words_advance(words);
        return true;
    }
    value->kind = CSG_UNDEF;
    if (word_accept(words, "undef"))
        return true;
    value->kind = CSG_LIST;
    if (!word_accept(words, "["))
        return word_refuse(words, "a number, a list, `true`, `false` or `undef`");
    if (!deeper(reader))
        return false;
    while (!word_is(words, "]")) {
        CsgValue item;
        if (!read_value(reader, &item))
            return false;
        array_push(words->import->arena, &value->list, item);
        if (!word_accept(words, ","))
            break;
    }
    reader->depth--;
    return word_expect(words, "]");
}

static bool read_arguments(CsgReader *reader, CsgNode *node)
{
    WordReader *words = &reader->words;
    if (!word_expect(words, "("))
        return false;
    while (!word_is(words, ")")) {
        CsgArgument argument = {.name = ""};
        if (words->word.kind == IMPORT_WORD_NAME && !word_is(words, "true") &&
            !word_is(words, "false") && !word_is(words, "undef")) {
            argument.name = words->word.text;
            words_advance(words);
            if (!word_expect(words, "="))
                return false;
        }
        if (!read_value(reader, &argument.value))
            return false;
        array_push(words->import->arena, &node->arguments, argument);
        if (!word_accept(words, ","))
            break;
    }
    return word_expect(words, ")");
}

static bool read_node(CsgReader *reader, Part **part);

/* Reads nodes up to `}`, or to the end of the file. */
static bool read_nodes(CsgReader *reader, CsgNode *node)
{
    WordReader *words = &reader->words;
    for (bool first = true; !word_is(words, "}") && words->word.kind != IMPORT_WORD_END;) {
        Part *part = NULL;
        if (word_accept(words, ";"))
            continue;
        if (word_is(words, "%")) {
            import_note(words->import, words->word.line, "what `%%` makes a backdrop is left out");
            words_advance(words);
            if (!read_node(reader, &part))
                return false;
            continue;
        }
        reader->left_out = false;
        if (!read_node(reader, &part))
            return false;
        if (!part && reader->left_out) {
            reader->left_out = false;
            continue;
        }
        node->lacks       = node->lacks || !part;
        node->lacks_first = node->lacks_first || (first && !part);
        first             = false;
        if (part && !node->parts)
            node->parts = part_new(words->import, node->line, node->name);
        if (part)
            part_add(words->import, node->parts, part);
    }
    return words->import->refusal.length == 0;
}

static bool build_node(const CsgNode *node, Part **part)
{
    const char *names[NODES];
    for (size_t i = 0; i < NODES; i++) {
        names[i] = nodes[i].name;
        if (strcmp(nodes[i].name, node->name) == 0)
            return nodes[i].build(node, part);
    }
    const char *nearest = nearest_name(node->name, names, NODES);
    return import_refuse(node->import, node->line, "`%.40s` is not translated%s%s%s", node->name,
                         nearest ? "; is it `" : "", nearest ? nearest : "", nearest ? "`?" : "");
}

static bool read_node(CsgReader *reader, Part **part)
{
    WordReader *words = &reader->words;
    if (word_is(words, "!"))
        return import_refuse(words->import, words->word.line,
                             "`!` shows one part alone: export that part, or take `!` away");
    while (word_accept(words, "#")) /* is highlighted */
        ;
    CsgNode node = {.import = words->import, .name = words->word.text, .line = words->word.line};
    if (words->word.kind != IMPORT_WORD_NAME)
        return word_refuse(words, "a name such as `cube`");
    words_advance(words);
    if (!deeper(reader) || !read_arguments(reader, &node))
        return false;
    if (word_accept(words, "{")) {
        if (!read_nodes(reader, &node) || !word_expect(words, "}"))
            return false;
    } else if (!word_expect(words, ";")) {
        return false;
    }
    reader->depth--;
    if (import_was_left_out(node.import, node.line))
        return reader->left_out = true;
    return build_node(&node, part) ||
           (reader->left_out = import_leaves_out(node.import, node.line));
}

/* Shows a part; OpenSCAD shows plane figures a unit thick. */
static bool show_part(PartWriter *writer, Part *part)
{
    if (part->figure) {
        import_note(writer->import, part->line, "a plane figure is shown a unit thick");
        part          = part_around(writer->import, part->line, "shown", part);
        part->methods = ".extrude(1)";
    }
    return part_show(writer, part, ".rotate([1, 0, 0], -90deg)");
}

bool import_csg(Import *import)
{
    CsgReader  reader = {.depth = 0};
    PartWriter writer = {.import = import};
    CsgNode    root   = {.import = import, .name = "union", .line = 1};
    words_start(&reader.words, import, false);
    if (!read_nodes(&reader, &root))
        return false;
    if (reader.words.word.kind != IMPORT_WORD_END)
        return word_refuse(&reader.words, "a name such as `cube`");
    if (!root.parts)
        return import_refuse(import, 1, "there is nothing in the file");
    import_write_head(import);
    text_add(&import->scene, "// OpenSCAD's z is up: all is turned where it is shown.\n");
    for (size_t i = 0; i < root.parts->parts.count; i++)
        if (!show_part(&writer, root.parts->parts.items[i]))
            return false;
    return true;
}
