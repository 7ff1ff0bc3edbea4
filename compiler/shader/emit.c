/*
 * emit.c: the graph as GLSL.
 *
 * Each function is a list of short statements in the order of the nodes.  A value that is used
 * once, by something near, stands inside the expression that uses it; everything else gets a
 * name.  What depends on parameters only is computed once, in krs_prepare, into globals that
 * the march reads as locals; literals cost nothing.  Statements carry the line of the scene
 * that they come from.
 */
#include "compiler/shader/emit.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/graph/regions.h"

/* Expressions are nested to this depth and length at most: compilers of shaders recurse. */
enum { MOST_NESTING = 6, MOST_INLINE = 72 };

typedef struct Emitter {
    const Graph   *graph;
    const Sources *sources;
    Arena         *scratch;
    Text          *out;
    const char   **text;    /* of a node in the function being written: its name or expression */
    uint8_t       *nesting; /* of that expression */
    uint32_t      *uses;    /* in the function being written */
    struct { Node *items; size_t count, capacity; } needed; /* all that have uses, in order */
    const char   **frame;   /* names of the globals that krs_prepare sets */
    uint32_t       next;    /* number of the next local name */
    uint32_t       globals;
    uint32_t      *precise; /* of OP_precise: its slot in the parameter block */
    Regions        regions; /* of the function being written, where it has guards */
    Span           last;    /* the line that was commented last */
} Emitter;

static const char *type_name(GraphType type)
{
    switch (type) {
    case TYPE_FLOAT: return "float";
    case TYPE_VEC2:  return "vec2";
    case TYPE_VEC3:  return "vec3";
    case TYPE_VEC4:  return "vec4";
    case TYPE_BOOL:  return "bool";
    case TYPE_UINT:  return "uint";
    }
    return "float";
}

/* What names of values begin with. */
static char type_letter(GraphType type)
{
    switch (type) {
    case TYPE_FLOAT: return 't';
    case TYPE_BOOL:  return 'b';
    case TYPE_UINT:  return 'n';
    default:         return 'v';
    }
}

/* The shortest literal that reads back as the float nearest to the number. */
static void add_literal(Text *text, double number)
{
    char   digits[40];
    double limited = fmax(-FLT_MAX, fmin(number, FLT_MAX));
    float  single  = (float)limited;
    for (int precision = 6; precision <= 9; precision++) {
        snprintf(digits, sizeof digits, "%.*g", precision, (double)single);
        float back;
        if (sscanf(digits, "%f", &back) == 1 && back == single)
            break;
    }
    bool bare = !strpbrk(digits, ".e");
    text_format(text, single < 0 ? "(%s%s)" : "%s%s", digits, bare ? ".0" : "");
}

static const char *constant_text(Emitter *e, const Expr *expr)
{
    Text text = {.arena = e->scratch};
    if (expr->type == TYPE_BOOL)
        return expr->number[0] != 0 ? "true" : "false";
    if (expr->type == TYPE_UINT) {
        text_format(&text, "%.0fu", expr->number[0]);
        return text.bytes;
    }
    if (expr->type > TYPE_FLOAT)
        text_format(&text, "%s(", type_name(expr->type));
    bool equal = true;
    for (uint32_t i = 1; i < expr->type; i++)
        equal = equal && expr->number[i] == expr->number[0];
    for (uint32_t i = 0; i < (equal ? 1u : expr->type); i++) {
        if (i)
            text_add(&text, ", ");
        add_literal(&text, expr->number[i]);
    }
    if (expr->type > TYPE_FLOAT)
        text_add(&text, ")");
    return text.bytes;
}

/* Says where the next statement comes from, unless it is the same line as before. */
static void comment_line(Emitter *e, Span span)
{
    if (!span.source)
        return;
    const Source *source   = &e->sources->items[span.source];
    Position      position = source_position(source, span.start);
    if (e->last.source == span.source && e->last.start == position.line)
        return;
    e->last = (Span){span.source, position.line, 0};
    text_format(e->out, "    // %s:%u\n", source->name, position.line);
}

/* A row's template with the operands in the place of $a, $b, $c, $d.  What stands before a
   semicolon is a statement that comes before, and sets a local of its own, $t. */
static const char *fill_template(Emitter *e, const Expr *expr)
{
    Text        text = {.arena = e->scratch};
    const char *from = op_glsl((Op)expr->op);
    uint32_t    local = strchr(from, ';') ? e->next++ : 0;
    while (*from) {
        size_t plain = strcspn(from, "$;");
        text_add_bytes(&text, from, plain);
        from += plain;
        if (*from == ';') {
            comment_line(e, expr->span);
            text_format(e->out, "    %s;\n", text.bytes);
            text = (Text){.arena = e->scratch};
            from += strspn(from, "; ");
        } else if (*from) {
            if (from[1] == 't')
                text_format(&text, "t%u", local);
            else
                text_add(&text, e->text[expr->operands[from[1] - 'a']]);
            from += 2;
        }
    }
    return text.bytes;
}

static const char *slot_text(Emitter *e, uint32_t slot, GraphType type)
{
    static const char *const swizzle[] = {"", ".x", ".xy", ".xyz", ""};
    Text text = {.arena = e->scratch};
    text_format(&text, "krs_parameter[%u]%s", slot, swizzle[type]);
    return text.bytes;
}

static const char *node_text(Emitter *e, const Expr *expr)
{
    Text text = {.arena = e->scratch};
    switch (expr->op) {
    case OP_CONSTANT: return constant_text(e, expr);
    case OP_POINT:    return "p";
    case OP_NORMAL:   return "normal";
    case OP_FOOTPRINT: return "footprint";
    case OP_DIRECTION: return "direction";
    case OP_precise: return slot_text(e, e->precise[expr - e->graph->items], expr->type);
    case OP_PARAMETER: return slot_text(e, expr->index, expr->type);
    case OP_COMPONENT:
        text_format(&text, "%s.%c", e->text[expr->operands[0]], "xyzw"[expr->index]);
        return text.bytes;
    default: return fill_template(e, expr);
    }
}

/* Whether a template names an operand twice: what stands twice is computed twice. */
static bool repeats_operand(const Expr *user, Node operand)
{
    if (user->op == OP_COMPONENT)
        return false;
    const char *glsl  = op_glsl((Op)user->op);
    uint32_t    count = 0;
    for (const char *at = strchr(glsl, '$'); at; at = strchr(at + 1, '$'))
        count += at[1] != 't' && user->operands[at[1] - 'a'] == operand;
    return count > 1;
}

/* An expression that is a whole statement needs no parentheses around it. */
static const char *bare(Emitter *e, const char *text)
{
    size_t   length = strlen(text);
    uint32_t open   = 0;
    if (text[0] != '(')
        return text;
    for (size_t i = 0; i < length; i++) {
        open += text[i] == '(';
        open -= text[i] == ')';
        if (open == 0 && i + 1 < length)
            return text;
    }
    return arena_copy_text(e->scratch, text + 1, length - 2);
}

static void use(Emitter *e, Node node, uint32_t count)
{
    if (e->uses[node] == 0)
        array_push(e->scratch, &e->needed, node);
    e->uses[node] += count;
}

static int compare_nodes(const void *a, const void *b)
{
    return (*(const Node *)a > *(const Node *)b) - (*(const Node *)a < *(const Node *)b);
}

/* Finds the nodes that a function needs, counting uses; frame values end the walk.  The work grows
   with the function, not with the graph: there are several functions for each component. */
static void count_uses(Emitter *e, const Node *roots, size_t count, bool frame)
{
    for (size_t i = 0; i < e->needed.count; i++)
        e->uses[e->needed.items[i]] = 0;
    e->needed.count = 0;
    for (size_t i = 0; i < count; i++)
        use(e, roots[i], 2); /* a root needs a name */
    for (size_t i = 0; i < e->needed.count; i++) {
        const Expr *expr = &e->graph->items[e->needed.items[i]];
        if ((!frame && expr->time != TIME_POINT) || expr->op == OP_precise)
            continue; /* what is precise, the host finds */
        for (uint32_t k = 0; k < expr->operand_count; k++)
            use(e, expr->operands[k], repeats_operand(expr, expr->operands[k]) ? 2 : 1);
    }
    if (e->needed.count)
        qsort(e->needed.items, e->needed.count, sizeof *e->needed.items, compare_nodes);
}

static bool is_leaf(const Expr *expr)
{
    return expr->operand_count == 0;
}

/* Writes the statement of a node, or keeps its expression for the one place that needs it. */
static void emit_node(Emitter *e, Node n)
{
    const Expr *expr = &e->graph->items[n];
    uint8_t     deep = 0;
    for (uint32_t i = 0; i < expr->operand_count; i++)
        if (e->nesting[expr->operands[i]] > deep)
            deep = e->nesting[expr->operands[i]];
    const char *text  = node_text(e, expr);
    bool        plain = is_leaf(expr) || (expr->op == OP_COMPONENT && deep == 0);
    e->nesting[n]     = plain ? 0 : deep + 1;
    e->text[n]        = text;
    if (plain || (e->uses[n] == 1 && e->nesting[n] < MOST_NESTING && strlen(text) < MOST_INLINE))
        return;
    comment_line(e, expr->span);
    Text name = {.arena = e->scratch};
    text_format(&name, "%c%u", type_letter(expr->type), e->next++);
    text_format(e->out, "    %s %s = %s;\n", type_name(expr->type), name.bytes, bare(e, text));
    e->text[n]    = name.bytes;
    e->nesting[n] = 0;
}

/* Statements for all that the roots need. */
static void emit_body(Emitter *e, const Node *roots, size_t count)
{
    const Graph *g = e->graph;
    count_uses(e, roots, count, false);
    e->next = 0;
    e->last = (Span){0, 0, 0};
    for (size_t i = 0; i < e->needed.count; i++) {
        Node n = e->needed.items[i];
        if (g->items[n].time == TIME_FRAME) {
            e->text[n]    = e->frame[n];
            e->nesting[n] = 0;
        } else
            emit_node(e, n);
    }
}

/* Frame values that point values need become globals, set by krs_prepare. */
static void emit_frame(Emitter *e, const Node *roots, size_t count)
{
    const Graph *g      = e->graph;
    bool        *needed = arena_new_array(e->scratch, bool, g->count);
    Node        *frame  = arena_new_array(e->scratch, Node, g->count);
    size_t       frames = 0;
    count_uses(e, roots, count, false);
    for (size_t i = 0; i < e->needed.count; i++) {
        Node n = e->needed.items[i];
        if (g->items[n].time != TIME_FRAME)
            continue;
        needed[n] = true;
        frame[frames++] = n;
        Text name = {.arena = e->scratch};
        text_format(&name, "krs_frame%u", e->globals++);
        e->frame[n] = name.bytes;
        text_format(e->out, "%s %s;\n", type_name(g->items[n].type), name.bytes);
    }
    text_add(e->out, "\n// Everything that stays the same within a frame: call it first.\n"
                     "void krs_prepare()\n{\n");
    count_uses(e, frame, frames, true);
    e->next = 0;
    for (size_t i = 0; i < e->needed.count; i++) {
        Node n = e->needed.items[i];
        if (!needed[n]) {
            emit_node(e, n);
            continue;
        }
        comment_line(e, g->items[n].span);
        text_format(e->out, "    %s = %s;\n", e->frame[n], bare(e, node_text(e, &g->items[n])));
        e->text[n]    = e->frame[n];
        e->nesting[n] = 0;
    }
    text_format(e->out,
                "#ifdef ZONES\n"
                "    for (int i = 0; i < ZONES; i++)\n"
                "        krs_zones[i] = krs_parameter[%zu + i];\n"
                "#endif\n"
                "}\n\n", e->graph->parameters.count);
}

static void emit_helpers(Emitter *e, const Node *roots, size_t count)
{
    const char *done[OP_COUNT];
    size_t      done_count = 0;
    count_uses(e, roots, count, true); /* of the whole graph */
    for (size_t k = 0; k < e->needed.count; k++) {
        const char *helper = op_helper((Op)e->graph->items[e->needed.items[k]].op);
        for (size_t i = 0; helper && i < done_count; i++)
            if (done[i] == helper)
                helper = NULL;
        if (!helper)
            continue;
        done[done_count++] = helper;
        text_add(e->out, helper);
        text_add(e->out, "\n");
    }
}

/* What the distance must not be below: how deep p is in zones, negative outside.  Those of the
   caller are in the slots behind the parameters, in a variant that has room for ZONES of them. */
static void emit_zones(Emitter *e, Node zone)
{
    if (zone != NODE_NONE) {
        text_add(e->out, "// How deep p is in the zones of the scene, where nothing is.\n"
                         "float krs_zone_depth(vec3 p)\n{\n");
        emit_body(e, &zone, 1);
        text_format(e->out, "    return %s;\n}\n\n", e->text[zone]);
    }
    text_format(e->out,
                "// The distance where zones have been cut out: those of the scene, and ZONES of\n"
                "// the caller, of which slot %zu holds the first: center and radius.\n"
                "float krs_cut(vec3 p, float d)\n{\n", e->graph->parameters.count);
    if (zone != NODE_NONE)
        text_add(e->out, "    d = max(d, krs_zone_depth(p));\n");
    text_add(e->out, "#ifdef ZONES\n"
                     "    for (int i = 0; i < ZONES; i++)\n"
                     "        d = max(d, krs_zones[i].w - length(p - krs_zones[i].xyz));\n"
                     "#endif\n"
                     "    return d;\n}\n\n");
}

/* With flats, kernels that know them march the rest. */
static void emit_union(Emitter *e, size_t components, const bool *flat)
{
    if (flat) {
        text_add(e->out, "#ifdef FLATS\n    float d = 1e30;\n");
        for (size_t i = 0; i < components; i++)
            if (!flat[i])
                text_format(e->out, "    d = min(d, krs_distance_%zu(p));\n", i + 1);
        text_add(e->out, "#else\n");
    }
    text_add(e->out, components ? "    float d = krs_distance_1(p);\n" : "    float d = 1e30;\n");
    for (size_t i = 1; i < components; i++)
        text_format(e->out, "    d = min(d, krs_distance_%zu(p));\n", i + 1);
    if (flat)
        text_add(e->out, "#endif\n");
}

/* Where rays meet planes. */
static void emit_flats(Emitter *e, const EmitMarch *march)
{
    if (!march->flat)
        return;
    text_add(e->out, "#ifdef FLATS\n"
                     "// How far it is along a ray from outside to the nearest of the planes that\n"
                     "// krs_distance then leaves out, and how steeply it falls towards one: n.d.\n"
                     "float krs_ahead(vec3 p, vec3 direction)\n{\n");
    emit_body(e, &march->ahead[0], 1);
    text_format(e->out, "    return %s;\n}\n\nfloat krs_rise(vec3 direction)\n{\n",
                e->text[march->ahead[0]]);
    emit_body(e, &march->ahead[1], 1);
    text_format(e->out, "    return %s;\n}\n#endif\n\n", e->text[march->ahead[1]]);
}

/* Of the group that is defined, or of all. */
static void emit_group_distances(Emitter *e, size_t components, const uint32_t *groups,
                                 const bool *flat)
{
    text_add(e->out, "#ifdef GROUP\n    float d = 1e30;\n");
    for (size_t i = 0; i < components; i++)
        text_format(e->out, "#if GROUP == %u\n    d = min(d, krs_distance_%zu(p));\n#endif\n",
                    groups[i], i + 1);
    text_add(e->out, "#else\n");
    emit_union(e, components, flat);
    text_add(e->out, "#endif\n");
}

static void emit_distances(Emitter *e, const Node *roots, size_t components,
                           const uint32_t *groups, const bool *flat)
{
    for (size_t i = 0; i < components; i++) {
        Node root = roots[i * ROOT_COUNT + ROOT_DISTANCE];
        if (groups)
            text_format(e->out, "#if !defined GROUP || GROUP == %u\n", groups[i]);
        text_format(e->out, "float krs_distance_%zu(vec3 p)\n{\n", i + 1);
        emit_body(e, &root, 1);
        text_format(e->out, "    return %s;\n}\n%s\n", e->text[root], groups ? "#endif\n" : "");
    }
    text_add(e->out, "// Never above the distance to the nearest surface; negative inside.\n"
                     "float krs_distance(vec3 p)\n{\n");
    if (groups)
        emit_group_distances(e, components, groups, flat);
    else
        emit_union(e, components, flat);
    text_add(e->out, "    return krs_cut(p, d);\n}\n\n");
}

/* ---- early-outs ---- */

/* Names for all that a function needs of other times than its own. */
static void name_constants(Emitter *e)
{
    const Graph *g = e->graph;
    for (size_t i = 0; i < e->needed.count; i++) {
        Node n = e->needed.items[i];
        if (g->items[n].time == TIME_POINT)
            continue;
        if (g->items[n].time == TIME_COMPILE) {
            emit_node(e, n);
            continue;
        }
        e->text[n]    = e->frame[n];
        e->nesting[n] = 0;
    }
}

static const char *emit_region(Emitter *e, const Regions *regions, uint32_t region, Node result,
                               bool returns);

/* Where nothing has been found yet, the bound alone counts. */
static bool nothing_found(const Emitter *e, Node least)
{
    const Expr *expr = &e->graph->items[least];
    return expr->op == OP_CONSTANT && expr->number[0] >= 1e30;
}

/* The condition of OP_guard, shorter where some of it is known. */
static const char *guard_text(Emitter *e, const Node *o)
{
    const Expr *limit = &e->graph->items[o[3]];
    const char *bound = e->text[o[0]], *far = e->text[o[3]];
    Text        text = {.arena = e->scratch};
    if (nothing_found(e, o[1]))
        text_format(&text, "%s >= %s", bound, far);
    else
        text_format(&text, "%s >= min(%s, %s)", bound, e->text[o[1]], bare(e, far));
    if (limit->op != OP_CONSTANT)
        text_format(&text, " && %s > min(%s, 0.0)", bound, bare(e, far));
    else if (limit->number[0] >= 0)
        text_format(&text, " && %s > 0.0", bound);
    return text.bytes;
}

/* A guard within an expression: what it may leave out stands in a block. */
static void emit_guard(Emitter *e, const Regions *regions, Node guard)
{
    const Node *o     = e->graph->items[guard].operands;
    const char *bound = e->text[o[0]], *least = e->text[o[1]];
    Text        name  = {.arena = e->scratch};
    text_format(&name, "t%u", e->next++);
    text_format(e->out, "    float %s = min(%s, %s);\n    if (!(%s)) {\n", name.bytes, bound, least,
                guard_text(e, o));
    const char *rest = emit_region(e, regions, regions->body[guard], o[2], false);
    text_format(e->out, "    %s = %s;\n    }\n", name.bytes, rest);
    e->text[guard]    = name.bytes;
    e->nesting[guard] = 0;
}

static void emit_return(Emitter *e, const Node *o)
{
    const char *bound = e->text[o[0]];
    text_format(e->out, "    if (%s)\n        return ", guard_text(e, o));
    if (nothing_found(e, o[1]))
        text_format(e->out, "%s;\n", bound);
    else
        text_format(e->out, "min(%s, %s);\n", bound, e->text[o[1]]);
}

/* Statements of a region; returns its result.  Where that is all that the function is about, a
   guard can return. */
static const char *emit_region(Emitter *e, const Regions *regions, uint32_t region, Node result,
                               bool returns)
{
    for (Node n = regions->list.items[region].first; n != NODE_NONE; n = regions->next[n]) {
        const Node *o = e->graph->items[n].operands;
        if (regions->body[n] == NO_REGION) {
            emit_node(e, n);
        } else if (n != result || !returns) {
            comment_line(e, e->graph->items[n].span);
            emit_guard(e, regions, n);
        } else {
            emit_return(e, o);
            return emit_region(e, regions, regions->body[n], o[2], true);
        }
    }
    return e->text[result];
}

/* Where it has no guards, it is the distance. */
static void emit_guarded(Emitter *e, size_t component, Node root, Node distance)
{
    text_format(e->out, "float krs_distance_lod_%zu(vec3 p, float footprint)\n{\n", component + 1);
    if (root == distance) {
        text_format(e->out, "    return krs_distance_%zu(p);\n}\n\n", component + 1);
        return;
    }
    graph_regions(&e->regions, e->graph, &root, 1, e->scratch);
    count_uses(e, &root, 1, false);
    e->next = 0;
    e->last = (Span){0, 0, 0};
    name_constants(e);
    const char *result = emit_region(e, &e->regions, REGION_ALWAYS, root, true);
    text_format(e->out, "    return %s;\n}\n\n", result);
}

static const char *vector_text(Emitter *e, const double v[3])
{
    Expr constant = {.op = OP_CONSTANT, .type = TYPE_VEC3, .number = {v[0], v[1], v[2]}};
    return constant_text(e, &constant);
}

/* A component whose box is not nearer than what has been found is left out. */
static void emit_guarded_component(Emitter *e, size_t component, Box box, bool first)
{
    if (first) {
        text_format(e->out, "    float d = krs_distance_lod_%zu(p, footprint);\n", component + 1);
        return;
    }
    double centre[3], half[3];
    box_centre(box, centre);
    for (int i = 0; i < 3; i++)
        half[i] = (0.5 + 1e-6) * (box.axis[i].high - box.axis[i].low) + 1e-6 * fabs(centre[i]);
    if (box_is_finite(box))
        text_format(e->out, "    if (krs_box_distance(p, %s, %s) < max(d, 1e-30))\n    ",
                    vector_text(e, centre), vector_text(e, half));
    text_format(e->out, "    d = min(d, krs_distance_lod_%zu(p, footprint));\n", component + 1);
}

/* What marches by branches: endless components first, then the others where they may be nearer. */
static void emit_early_outs(Emitter *e, const EmitMarch *march, const Node *roots,
                            size_t components)
{
    text_add(e->out, "#ifdef EARLY_OUTS\n");
    for (size_t i = 0; i < components; i++)
        emit_guarded(e, i, march->guarded[i], roots[i * ROOT_COUNT + ROOT_DISTANCE]);
    text_add(e->out,
             "float krs_box_distance(vec3 p, vec3 center, vec3 half_sides)\n{\n"
             "    return length(max(abs(p - center) - half_sides, 0.0));\n}\n\n"
             "// To march by: never above the distance to the nearest surface, and not above 0 in\n"
             "// the same places as krs_distance.  What is far for its size is not looked at, nor\n"
             "// what is smaller than the footprint.\n"
             "float krs_distance_lod(vec3 p, float footprint)\n{\n");
    size_t count = march->flat != NULL;
    if (march->flat)
        text_add(e->out, "    float d = 1e30;\n");
    for (int finite = 0; finite < 2; finite++)
        for (size_t i = 0; i < components; i++) {
            bool flat = march->flat && march->flat[i];
            if (box_is_empty(march->boxes[i]) || box_is_finite(march->boxes[i]) != finite)
                continue;
            text_add(e->out, flat ? "#ifndef FLATS\n" : "");
            emit_guarded_component(e, i, march->boxes[i], count++ == 0);
            text_add(e->out, flat ? "#endif\n" : "");
        }
    if (count == 0)
        text_add(e->out, "    float d = 1e30;\n");
    text_add(e->out, "    return krs_cut(p, d);\n}\n#endif\n\n");
}

/* ---- parts ---- */

/* Beyond so many, neighbours share a part. */
enum { MOST_PARTS = 64 };

uint32_t emit_part_count(size_t components)
{
    return components < MOST_PARTS ? (uint32_t)components : MOST_PARTS;
}

/* The first component of a part, or of the one behind the last. */
static size_t first_of_part(size_t part, size_t components)
{
    return part * components / emit_part_count(components);
}

/* What is inside of a switch over parts. */
static void emit_part_distance(Emitter *e, size_t part, const bool *flat, size_t components)
{
    text_format(e->out, "    case %zuu:\n", part);
    for (int guarded = 1; guarded >= 0; guarded--) {
        text_add(e->out, guarded ? "#ifdef EARLY_OUTS\n" : "#else\n");
        for (size_t i = first_of_part(part, components); i < first_of_part(part + 1, components);
             i++) {
            text_add(e->out, flat && flat[i] ? "#ifndef FLATS\n" : "");
            text_format(e->out, guarded ? "        d = min(d, krs_distance_lod_%zu(p, 0.0));\n"
                                        : "        d = min(d, krs_distance_%zu(p));\n", i + 1);
            text_add(e->out, flat && flat[i] ? "#endif\n" : "");
        }
    }
    text_add(e->out, "#endif\n        break;\n");
}

/* Its box, grown by what single precision may lose.  Where points are given from an anchor, no box
   is known. */
static void emit_part_box(Emitter *e, size_t part, Box box, bool flat)
{
    if (box_is_empty(box))
        return;
    double corner[2][3], size = box_is_finite(box) ? box_diagonal(box) : 0;
    for (int i = 0; i < 3; i++) {
        double reach  = fmax(fabs(box.axis[i].low), fabs(box.axis[i].high));
        double margin = isfinite(reach) ? 1e-4 * size + 1e-6 * reach : 0;
        corner[0][i]  = fmax(box.axis[i].low - margin, -1e18);
        corner[1][i]  = fmin(box.axis[i].high + margin, 1e18);
    }
    text_format(e->out, "%s    case %zuu:\n        low = %s;\n        high = %s;\n"
                        "        break;\n%s", flat ? "#ifndef FLATS\n" : "", part, vector_text(e, corner[0]),
                vector_text(e, corner[1]), flat ? "#endif\n" : "");
}

/* `boxes` of components; NULL: not known. */
static void emit_parts(Emitter *e, const Box *boxes, const bool *flat, size_t components)
{
    size_t parts = emit_part_count(components);
    if (parts < 2)
        return;
    text_format(e->out, "#ifdef PACKED\n"
                        "// Parts of the scene, most of them one component: the distance of one,"
                        " and a box\n// around it; where there is none the box stays empty.\n"
                        "const uint KRS_PARTS = %zuu;\n\n"
                        "float krs_distance_of(uint part, vec3 p)\n{\n"
                        "    float d = 1e30;\n    switch (part) {\n", parts);
    for (size_t part = 0; part < parts; part++)
        emit_part_distance(e, part, flat, components);
    text_add(e->out, "    }\n    return krs_cut(p, d);\n}\n\n"
                     "void krs_part_box(uint part, inout vec3 low, inout vec3 high)\n{\n"
                     "    switch (part) {\n");
    for (size_t part = 0; part < parts; part++) {
        Box  box      = box_empty;
        bool all_flat = true;
        for (size_t i = first_of_part(part, components); i < first_of_part(part + 1, components);
             i++) {
            box      = box_hull(box, boxes ? boxes[i] : box_infinite);
            all_flat = all_flat && flat && flat[i];
        }
        emit_part_box(e, part, box, all_flat);
    }
    text_add(e->out, "    }\n}\n#endif\n\n");
}

/* ---- along rays ---- */

/* What a component has to itself by one method, and where it joins the others. */
static void emit_one_along(Emitter *e, Node along, size_t component, const char *asked)
{
    text_format(e->out, "float krs_along_%zu(vec3 p, %s)\n{\n", component + 1, asked);
    emit_body(e, &along, 1);
    text_format(e->out, "    return %s;\n}\n\n", e->text[along]);
}

static void open_component(Emitter *e, const EmitMarch *march, size_t component)
{
    if (march->groups)
        text_format(e->out, "#if !defined GROUP || GROUP == %u\n", march->groups[component]);
    if (march->flat && march->flat[component])
        text_add(e->out, "#ifndef FLATS\n");
}

static void close_component(Emitter *e, const EmitMarch *march, size_t component)
{
    text_add(e->out, march->flat && march->flat[component] ? "#endif\n" : "");
    text_add(e->out, march->groups ? "#endif\n" : "");
}

/* krs_along by one method, or krs_probe. */
static void emit_along_by(Emitter *e, AlongMethod method, const EmitMarch *march, const Node *roots,
                          size_t components)
{
    const Node *along = march->along + method * components;
    bool        probe = method == ALONG_PROBE;
    for (size_t i = 0; i < components; i++) {
        if (along[i] == roots[i * ROOT_COUNT + ROOT_DISTANCE])
            continue;
        open_component(e, march, i);
        emit_one_along(e, along[i], i, probe ? "float footprint" : "vec3 direction");
        close_component(e, march, i);
    }
    text_add(e->out, probe
        ? "// Whether the ball around p of this radius is empty: if it could be more than 1 times as\n"
          "// large, which is what this says, about.\n"
          "float krs_probe(vec3 p, float footprint)\n{\n    float t = 1e30;\n"
        : "// How far a ray from p along a unit direction may go before it can meet a surface: at\n"
          "// least the distance, and farther where polynomials or maps tell; negative inside.\n"
          "float krs_along(vec3 p, vec3 direction)\n{\n    float t = 1e30;\n");
    for (size_t i = 0; i < components; i++) {
        bool plain = along[i] == roots[i * ROOT_COUNT + ROOT_DISTANCE];
        open_component(e, march, i);
        text_format(e->out, "    t = min(t, krs_%s_%zu(p%s));\n", plain ? "distance" : "along",
                    i + 1, plain ? "" : probe ? ", footprint" : ", direction");
        close_component(e, march, i);
    }
    text_format(e->out, "    return krs_cut(p, t)%s;\n}\n", probe ? " / footprint" : "");
}

static void emit_along(Emitter *e, const EmitMarch *march, const Node *roots, size_t components)
{
    for (AlongMethod method = 0; method < ALONG_COUNT; method++) {
        bool any = false;
        for (size_t i = 0; i < components; i++)
            any = any || march->along[method * components + i] !=
                             roots[i * ROOT_COUNT + ROOT_DISTANCE];
        if (!any)
            continue;
        text_format(e->out, "#if defined(ALONG) && ALONG == %d\n", (int)method);
        emit_along_by(e, method, march, roots, components);
        text_add(e->out, "#endif\n\n");
    }
}

/* ---- gradients ---- */

static bool has_gradient(const Emitter *e, const Node *roots)
{
    return e->graph->items[roots[0]].type == TYPE_VEC3;
}

/* Of one component: the gradient, and the distance. */
static void emit_gradient_of(Emitter *e, size_t component, const Node *roots)
{
    text_format(e->out, "vec4 krs_gradient_%zu(vec3 p, float reach)\n{\n", component + 1);
    if (has_gradient(e, roots)) {
        emit_body(e, roots, 2);
        text_format(e->out, "    return vec4(%s, %s);\n}\n\n", e->text[roots[0]],
                    e->text[roots[1]]);
        return;
    }
    text_format(e->out, "    vec4 found = vec4(0.0);\n"
                        "    for (uint i = 0u; i < 7u; i++) {\n"
                        "        vec3 way = vec3(i >> 1u == 0u, i >> 1u == 1u, i >> 1u == 2u);\n"
                        "        way *= (i & 1u) == 0u ? reach : -reach;\n"
                        "        float d = krs_distance_%zu(p + way);\n"
                        "        found += i < 6u ? vec4(d * way, 0.0) : vec4(0.0, 0.0, 0.0, d);\n"
                        "    }\n"
                        "    return found;\n}\n\n", component + 1);
}

/* Where zones cut, their walls are the surface. */
static void emit_zone_gradients(Emitter *e, Node zone, const Node *roots)
{
    if (zone != NODE_NONE) {
        emit_body(e, roots, 2);
        text_format(e->out, "    if (%s > nearest.w)\n        nearest = vec4(%s, %s);\n",
                    e->text[roots[1]], e->text[roots[0]], e->text[roots[1]]);
    }
    text_add(e->out, "#ifdef ZONES\n"
                     "    for (int i = 0; i < ZONES; i++) {\n"
                     "        vec3 toward = krs_zones[i].xyz - p;\n"
                     "        float depth = krs_zones[i].w - length(toward);\n"
                     "        nearest = depth > nearest.w ? vec4(toward, depth) : nearest;\n"
                     "    }\n"
                     "#endif\n");
}

static void emit_gradients(Emitter *e, const EmitMarch *march, size_t components, Node zone)
{
    text_add(e->out, "#if defined(GRADIENT) && !defined(ANCHORED)\n");
    for (size_t i = 0; i < components; i++)
        emit_gradient_of(e, i, march->gradient + 2 * i);
    text_add(e->out, "// The direction in which krs_distance rises fastest at a surface, of any\n"
                     "// length, by derivatives; by differences over `reach` where there are none.\n"
                     "vec3 krs_gradient(vec3 p, float reach)\n{\n"
                     "    vec4 nearest = vec4(0.0, 0.0, 0.0, 1e30), other;\n");
    for (size_t i = 0; i < components; i++)
        text_format(e->out, "    other = krs_gradient_%zu(p, reach);\n"
                            "    nearest = other.w < nearest.w ? other : nearest;\n", i + 1);
    emit_zone_gradients(e, zone, march->gradient + 2 * components);
    text_add(e->out, "    return nearest.xyz;\n}\n#endif\n\n");
}

static void emit_surfaces(Emitter *e, const Node *roots, size_t components)
{
    for (size_t i = 0; i < components; i++) {
        const Node *root = &roots[i * ROOT_COUNT];
        text_format(e->out,
                    "KrsSurface krs_surface_%zu(vec3 p, vec3 normal, float footprint)\n{\n",
                    i + 1);
        emit_body(e, root, ROOT_COUNT);
        text_format(e->out,
                    "    return KrsSurface(%s, %s, %s, %s, %s, %zuu, uint(%s), %s, %s);\n}\n\n",
                    e->text[root[ROOT_DISTANCE]], e->text[root[ROOT_COLOR]],
                    e->text[root[ROOT_ROUGHNESS]], e->text[root[ROOT_METALLIC]],
                    e->text[root[ROOT_EMISSION]], i + 1, e->text[root[ROOT_LEVEL]],
                    e->text[root[ROOT_INSTANCE]], e->text[root[ROOT_NORMAL]]);
    }
    const char *empty =
        "    return KrsSurface(1e30, vec3(0.0), 1.0, 0.0, vec3(0.0), 0u, 0u, 0u, normal);\n";
    text_add(e->out, "// What is at p: the component with the least distance.  `normal` is the\n"
                     "// gradient of krs_distance there, `footprint` the radius of a pixel, or 0.\n"
                     "KrsSurface krs_surface(vec3 p, vec3 normal, float footprint)\n{\n");
    text_add(e->out, components ? "    KrsSurface nearest = krs_surface_1(p, normal, footprint);\n"
                                : empty);
    if (components > 1)
        text_add(e->out, "    KrsSurface other;\n");
    for (size_t i = 1; i < components; i++)
        text_format(e->out,
                    "    other = krs_surface_%zu(p, normal, footprint);\n"
                    "    if (other.distance < nearest.distance)\n"
                    "        nearest = other;\n",
                    i + 1);
    if (components > 0)
        text_add(e->out, "    float cut = krs_cut(p, nearest.distance);\n"
                         "    if (cut > nearest.distance)\n"
                         "        nearest.normal = normal;\n"
                         "    nearest.distance = cut;\n"
                         "    return nearest;\n");
    text_add(e->out, "}\n");
}

static void emit_struct(Emitter *e)
{
    text_add(e->out, "struct KrsSurface {\n"
                  "    float distance;\n"
                  "    vec3  color;\n"
                  "    float roughness;\n"
                  "    float metallic;\n"
                  "    vec3  emission;\n"
                  "    uint  component;\n"
                  "    uint  level;\n"
                  "    uint  instance;\n"
                  "    vec3  normal;\n"
                  "};\n\n");
}

/* Numbers what the host finds; returns how many slots that takes. */
static uint32_t number_precise(Emitter *e, uint32_t slot)
{
    uint32_t first = slot;
    for (Node n = 0; n < e->graph->count; n++)
        if (e->graph->items[n].op == OP_precise)
            e->precise[n] = slot++;
    return slot - first;
}

/* The whole again for kernels far from the origin, to whom points are given from an anchor. */
static void emit_anchored(Emitter *e, const EmitMarch *march, size_t components)
{
    const Node *roots = march->anchored, *ahead = roots + components * ROOT_COUNT;
    uint32_t    slots = number_precise(e, march->precise_slot);
    EmitMarch   plain = {.flat = march->flat, .ahead = ahead};
    text_format(e->out,
                "#ifdef ANCHORED // p is given from an anchor near it: graph/anchor.h\n"
                "layout(std140, set = 0, binding = 0) uniform KrsParameters "
                "{ vec4 krs_parameter[%u]; };\n\n",
                march->precise_slot + slots + 1);
    emit_struct(e);
    emit_helpers(e, roots, components * ROOT_COUNT + 2);
    emit_frame(e, roots, components * ROOT_COUNT + 2);
    text_add(e->out, "float krs_cut(vec3 p, float d) { return d; }\n\n");
    emit_distances(e, roots, components, NULL, march->flat);
    emit_parts(e, NULL, march->flat, components);
    emit_flats(e, &plain);
    emit_surfaces(e, roots, components);
    text_add(e->out, "#else\n");
}

void emit_glsl(const Graph *graph, const Sources *sources, const Node *roots,
               size_t component_count, Node zone, const EmitMarch *march, Arena *scratch, Text *out)
{
    Emitter e = {.graph = graph, .sources = sources, .scratch = scratch, .out = out};
    size_t  plain = component_count * ROOT_COUNT + (zone != NODE_NONE);
    size_t  rays = plain + (1 + ALONG_COUNT) * component_count;
    size_t  flats = rays + (march->flat ? 2 : 0);
    size_t  count = flats + (march->gradient ? 2 * (component_count + 1) : 0);
    Node   *all = arena_new_array(scratch, Node, count + 1);
    memcpy(all, roots, plain * sizeof *all);
    memcpy(all + plain, march->guarded, component_count * sizeof *all);
    memcpy(all + plain + component_count, march->along,
           ALONG_COUNT * component_count * sizeof *all);
    if (march->flat)
        memcpy(all + rays, march->ahead, 2 * sizeof *all);
    if (march->gradient)
        memcpy(all + flats, march->gradient, 2 * (component_count + 1) * sizeof *all);
    e.text    = arena_new_array(scratch, const char *, graph->count + 1);
    e.frame   = arena_new_array(scratch, const char *, graph->count + 1);
    e.nesting = arena_new_array(scratch, uint8_t, graph->count + 1);
    e.uses    = arena_new_array(scratch, uint32_t, graph->count + 1);
    e.precise = arena_new_array(scratch, uint32_t, graph->count + 1);
    text_add(out, "// Distance code of a scene; "
                  "slot 0 holds the time, then one slot for each `param`.\n");
    if (march->slopes)
        text_add(out, "// Behind them slopes that the host finds for each frame: "
                      "krs_frame_parameters in krs.h.\n");
    if (march->anchored)
        emit_anchored(&e, march, component_count);
    text_format(out,
                "#ifdef ZONES\n"
                "layout(std140, set = 0, binding = 0) uniform KrsParameters "
                "{ vec4 krs_parameter[%zu + ZONES]; };\n"
                "vec4 krs_zones[ZONES];\n"
                "#else\n"
                "layout(std140, set = 0, binding = 0) uniform KrsParameters "
                "{ vec4 krs_parameter[%zu]; };\n"
                "#endif\n\n",
                graph->parameters.count, graph->parameters.count);
    emit_struct(&e);
    emit_helpers(&e, all, count);
    emit_frame(&e, all, count);
    emit_zones(&e, zone);
    emit_distances(&e, roots, component_count, march->groups, march->flat);
    emit_flats(&e, march);
    emit_along(&e, march, roots, component_count);
    if (march->groups)
        text_add(out, "#ifndef GROUP\n");
    emit_early_outs(&e, march, roots, component_count);
    emit_parts(&e, march->boxes, march->flat, component_count);
    if (march->gradient)
        emit_gradients(&e, march, component_count, zone);
    emit_surfaces(&e, roots, component_count);
    if (march->groups)
        text_add(out, "#endif\n");
    if (march->anchored)
        text_add(out, "#endif\n");
}
