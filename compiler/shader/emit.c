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
#include <string.h>

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
    const char   **frame;   /* names of the globals that krs_prepare sets */
    uint32_t       next;    /* number of the next local name */
    uint32_t       globals;
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

/* A row's template with the operands in the place of $a, $b, $c, $d. */
static const char *fill_template(Emitter *e, const Expr *expr)
{
    Text        text = {.arena = e->scratch};
    const char *from = op_glsl((Op)expr->op);
    while (*from) {
        size_t plain = strcspn(from, "$");
        text_add_bytes(&text, from, plain);
        from += plain;
        if (*from) {
            text_add(&text, e->text[expr->operands[from[1] - 'a']]);
            from += 2;
        }
    }
    return text.bytes;
}

static const char *node_text(Emitter *e, const Expr *expr)
{
    Text text = {.arena = e->scratch};
    switch (expr->op) {
    case OP_CONSTANT: return constant_text(e, expr);
    case OP_POINT:    return "p";
    case OP_PARAMETER: {
        static const char *const swizzle[] = {"", ".x", ".xy", ".xyz", ""};
        text_format(&text, "krs_parameter[%u]%s", expr->index, swizzle[expr->type]);
        return text.bytes;
    }
    case OP_COMPONENT:
        text_format(&text, "%s.%c", e->text[expr->operands[0]], "xyzw"[expr->index]);
        return text.bytes;
    default: return fill_template(e, expr);
    }
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

/* Whether a template names an operand twice: what stands twice is computed twice. */
static bool repeats_operand(const Expr *user, Node operand)
{
    if (user->op == OP_COMPONENT)
        return false;
    const char *glsl  = op_glsl((Op)user->op);
    uint32_t    count = 0;
    for (const char *at = strchr(glsl, '$'); at; at = strchr(at + 1, '$'))
        count += user->operands[at[1] - 'a'] == operand;
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

/* Marks the nodes that a function needs, counting uses; frame values end the walk. */
static void count_uses(Emitter *e, const Node *roots, size_t count, bool frame)
{
    const Graph *g = e->graph;
    memset(e->uses, 0, g->count * sizeof *e->uses);
    for (size_t i = 0; i < count; i++)
        e->uses[roots[i]] += 2; /* a root needs a name */
    for (Node n = (Node)g->count; n-- > 0;) {
        const Expr *expr = &g->items[n];
        if (!e->uses[n] || (!frame && expr->time != TIME_POINT))
            continue;
        for (uint32_t i = 0; i < expr->operand_count; i++)
            e->uses[expr->operands[i]] += repeats_operand(expr, expr->operands[i]) ? 2 : 1;
    }
}

static bool is_leaf(const Expr *expr)
{
    return expr->op == OP_CONSTANT || expr->op == OP_POINT || expr->op == OP_PARAMETER;
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
    for (Node n = 0; n < g->count; n++) {
        if (!e->uses[n])
            continue;
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
    for (Node n = 0; n < g->count; n++) {
        if (!e->uses[n] || g->items[n].time != TIME_FRAME)
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
    for (Node n = 0; n < g->count; n++) {
        if (!e->uses[n])
            continue;
        if (!needed[n]) {
            emit_node(e, n);
            continue;
        }
        comment_line(e, g->items[n].span);
        text_format(e->out, "    %s = %s;\n", e->frame[n], bare(e, node_text(e, &g->items[n])));
        e->text[n]    = e->frame[n];
        e->nesting[n] = 0;
    }
    text_add(e->out, "}\n\n");
}

static void emit_helpers(Emitter *e, const Node *roots, size_t count)
{
    const char *done[OP_COUNT];
    size_t      done_count = 0;
    count_uses(e, roots, count, true);
    for (Node n = 0; n < e->graph->count; n++) {
        const char *helper = e->uses[n] ? op_helper((Op)e->graph->items[n].op) : NULL;
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

static void emit_distances(Emitter *e, const Node *roots, size_t components)
{
    for (size_t i = 0; i < components; i++) {
        Node root = roots[i * ROOT_COUNT + ROOT_DISTANCE];
        text_format(e->out, "float krs_distance_%zu(vec3 p)\n{\n", i + 1);
        emit_body(e, &root, 1);
        text_format(e->out, "    return %s;\n}\n\n", e->text[root]);
    }
    text_add(e->out, "// Never above the distance to the nearest surface; negative inside.\n"
                     "float krs_distance(vec3 p)\n{\n");
    text_add(e->out, components ? "    float d = krs_distance_1(p);\n" : "    float d = 1e30;\n");
    for (size_t i = 1; i < components; i++)
        text_format(e->out, "    d = min(d, krs_distance_%zu(p));\n", i + 1);
    text_add(e->out, "    return d;\n}\n\n");
}

static void emit_surfaces(Emitter *e, const Node *roots, size_t components)
{
    for (size_t i = 0; i < components; i++) {
        const Node *root = &roots[i * ROOT_COUNT];
        text_format(e->out, "KrsSurface krs_surface_%zu(vec3 p)\n{\n", i + 1);
        emit_body(e, root, ROOT_COUNT);
        text_format(e->out, "    return KrsSurface(%s, %s, %s, %s, %s, %zuu, uint(%s), %s);\n}\n\n",
                    e->text[root[ROOT_DISTANCE]], e->text[root[ROOT_COLOR]],
                    e->text[root[ROOT_ROUGHNESS]], e->text[root[ROOT_METALLIC]],
                    e->text[root[ROOT_EMISSION]], i + 1, e->text[root[ROOT_LEVEL]],
                    e->text[root[ROOT_INSTANCE]]);
    }
    const char *empty =
        "    return KrsSurface(1e30, vec3(0.0), 1.0, 0.0, vec3(0.0), 0u, 0u, 0u);\n";
    text_add(e->out, "// What is at p: the component with the least distance.\n"
                     "KrsSurface krs_surface(vec3 p)\n{\n");
    text_add(e->out, components ? "    KrsSurface nearest = krs_surface_1(p);\n" : empty);
    if (components > 1)
        text_add(e->out, "    KrsSurface other;\n");
    for (size_t i = 1; i < components; i++)
        text_format(e->out,
                    "    other = krs_surface_%zu(p);\n"
                    "    if (other.distance < nearest.distance)\n"
                    "        nearest = other;\n",
                    i + 1);
    text_add(e->out, components ? "    return nearest;\n}\n" : "}\n");
}

void emit_glsl(const Graph *graph, const Sources *sources, const Node *roots,
               size_t component_count, Arena *scratch, Text *out)
{
    Emitter e = {.graph = graph, .sources = sources, .scratch = scratch, .out = out};
    size_t  count = component_count * ROOT_COUNT;
    e.text    = arena_new_array(scratch, const char *, graph->count + 1);
    e.frame   = arena_new_array(scratch, const char *, graph->count + 1);
    e.nesting = arena_new_array(scratch, uint8_t, graph->count + 1);
    e.uses    = arena_new_array(scratch, uint32_t, graph->count + 1);
    text_add(out, "// Distance code of a scene; "
                  "slot 0 holds the time, then one slot for each `param`.\n");
    text_format(out,
                "layout(std140, set = 0, binding = 0) uniform KrsParameters "
                "{ vec4 krs_parameter[%zu]; };\n\n",
                graph->parameters.count);
    text_add(out, "struct KrsSurface {\n"
                  "    float distance;\n"
                  "    vec3  color;\n"
                  "    float roughness;\n"
                  "    float metallic;\n"
                  "    vec3  emission;\n"
                  "    uint  component;\n"
                  "    uint  level;\n"
                  "    uint  instance;\n"
                  "};\n\n");
    emit_helpers(&e, roots, count);
    emit_frame(&e, roots, count);
    emit_distances(&e, roots, component_count);
    emit_surfaces(&e, roots, component_count);
}
