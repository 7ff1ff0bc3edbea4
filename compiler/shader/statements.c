/*
 * statements.c: nodes of the graph as statements.
 *
 * Each function is a list of short statements in the order of the nodes.  A value that is used
 * once, by something near, stands inside the expression that uses it; everything else gets a
 * name.  What depends on parameters only is computed once, in krs_prepare, into globals that
 * the march reads as locals; literals cost nothing.  Statements carry the line of the scene
 * that they come from.
 */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/shader/emitter.h"

/* Expressions are nested to this depth and length at most: compilers of shaders recurse. */
enum { MOST_NESTING = 6, MOST_INLINE = 72 };

static const char *type_name(GraphType type)
{
    switch (type) {
    case TYPE_FLOAT: return "float";
    case TYPE_VEC2: return "vec2";
    case TYPE_VEC3: return "vec3";
    case TYPE_VEC4: return "vec4";
    case TYPE_BOOL: return "bool";
    case TYPE_UINT: return "uint";
    }
    return "float";
}

/* What names of values begin with. */
static char type_letter(GraphType type)
{
    switch (type) {
    case TYPE_FLOAT: return 't';
    case TYPE_BOOL: return 'b';
    case TYPE_UINT: return 'n';
    default: return 'v';
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

const char *emit_number(Emitter *e, double number)
{
    Text text = {.arena = e->scratch};
    add_literal(&text, number);
    return text.bytes;
}

const char *emit_vector(Emitter *e, const double v[3])
{
    Expr constant = {.op = OP_CONSTANT, .type = TYPE_VEC3, .number = {v[0], v[1], v[2]}};
    return constant_text(e, &constant);
}

/* A file may have any name; what would end the comment, or the text, is shown as `?`. */
static void add_file_name(Text *out, const char *name)
{
    for (; *name; name++) {
        bool control = (unsigned char)*name < ' ' || *name == 0x7f;
        text_add_bytes(out, control ? "?" : name, 1);
    }
}

void emit_comment(Emitter *e, Span span)
{
    if (!span.source)
        return;
    const Source *source   = &e->sources->items[span.source];
    Position      position = source_position(source, span.start);
    if (e->last.source == span.source && e->last.start == position.line)
        return;
    e->last = (Span){span.source, position.line, 0};
    text_add(e->out, "    // ");
    add_file_name(e->out, source->name);
    text_format(e->out, ":%u\n", position.line);
}

/* A row's template with the operands in the place of $a, $b, $c, $d.  What stands before a
   semicolon is a statement that comes before, and sets a local of its own, $t. */
static const char *fill_template(Emitter *e, const Expr *expr)
{
    Text        text  = {.arena = e->scratch};
    const char *from  = op_glsl((Op)expr->op);
    uint32_t    local = strchr(from, ';') ? e->next++ : 0;
    while (*from) {
        size_t plain = strcspn(from, "$;");
        text_add_bytes(&text, from, plain);
        from += plain;
        if (*from == ';') {
            emit_comment(e, expr->span);
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

/* `width` components of a slot. */
static const char *slot_text(Emitter *e, uint32_t slot, uint32_t first, uint32_t width)
{
    Text text = {.arena = e->scratch};
    text_format(&text, width == 4 ? "krs_parameter[%u]" : "krs_parameter[%u].%.*s", slot,
                (int)width, &"xyzw"[first]);
    return text.bytes;
}

/* Of two variables by a macro, since built-ins mind what is not a number. */
static bool picks_variable(const Emitter *e, const Expr *expr)
{
    return (expr->op == OP_min || expr->op == OP_max) && expr->type == TYPE_FLOAT &&
           e->graph->items[expr->operands[0]].op != OP_CONSTANT &&
           e->graph->items[expr->operands[1]].op != OP_CONSTANT;
}

/* Of numbers by mix, which is no branch; it knows no others. */
static const char *select_text(Emitter *e, const Expr *expr)
{
    const Node *o    = expr->operands;
    Text        text = {.arena = e->scratch};
    if (expr->type == TYPE_BOOL || expr->type == TYPE_UINT)
        return fill_template(e, expr);
    text_format(&text, "mix(%s, %s, ", e->text[o[2]], e->text[o[1]]);
    if (expr->type == TYPE_FLOAT)
        text_format(&text, "%s)", emit_bare(e, e->text[o[0]]));
    else
        text_format(&text, "bvec%d(%s))", (int)expr->type, emit_bare(e, e->text[o[0]]));
    return text.bytes;
}

static const char *node_text(Emitter *e, const Expr *expr)
{
    Text text = {.arena = e->scratch};
    switch (expr->op) {
    case OP_CONSTANT: return constant_text(e, expr);
    case OP_POINT: return "p";
    case OP_NORMAL: return "normal";
    case OP_FOOTPRINT: return "footprint";
    case OP_DIRECTION: return "direction";
    case OP_PARAMETER: return slot_text(e, expr->index, 0, expr->type);
    case OP_COMPONENT:
        text_format(&text, "%s.%c", e->text[expr->operands[0]], "xyzw"[expr->index]);
        return text.bytes;
    case OP_min:
    case OP_max:
        if (!picks_variable(e, expr))
            return fill_template(e, expr);
        text_format(&text, "%s(%s, %s)", expr->op == OP_min ? "KRS_MIN" : "KRS_MAX",
                    e->text[expr->operands[0]], e->text[expr->operands[1]]);
        return text.bytes;
    case OP_select: return select_text(e, expr);
    case OP_fold: {
        const char *mirror = mirror_text(e, expr);
        return mirror ? mirror : fill_template(e, expr);
    }
    default: return fill_template(e, expr);
    }
}

/* Whether a template names an operand twice: what stands twice is computed twice. */
static bool repeats_operand(const Emitter *e, const Expr *user, Node operand)
{
    if (user->op == OP_COMPONENT)
        return false;
    if (picks_variable(e, user) ||
        (user->op == OP_fold && user->operands[0] == operand && mirror_repeats(e, user)))
        return true;
    const char *glsl  = op_glsl((Op)user->op);
    uint32_t    count = 0;
    for (const char *at = strchr(glsl, '$'); at; at = strchr(at + 1, '$'))
        count += at[1] != 't' && user->operands[at[1] - 'a'] == operand;
    return count > 1;
}

const char *emit_bare(Emitter *e, const char *text)
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

static void add_use(Emitter *e, Node node, uint32_t count)
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
        e->uses[e->needed.items[i]] = e->feeds_mirror[e->needed.items[i]] = 0;
    e->needed.count = 0;
    for (size_t i = 0; i < count; i++)
        add_use(e, roots[i], 2); /* a root needs a name */
    for (size_t i = 0; i < e->needed.count; i++) {
        const Expr *expr = &e->graph->items[e->needed.items[i]];
        if (!frame && expr->time != TIME_POINT)
            continue;
        for (uint32_t k = 0; k < expr->operand_count; k++)
            add_use(e, expr->operands[k], repeats_operand(e, expr, expr->operands[k]) ? 2 : 1);
        if (expr->op == OP_fold)
            e->feeds_mirror[expr->operands[0]] = true;
    }
    if (e->needed.count)
        qsort(e->needed.items, e->needed.count, sizeof *e->needed.items, compare_nodes);
}

static bool is_leaf(const Expr *expr) { return expr->operand_count == 0; }

/* Writes the statement of a node, or keeps its expression for the one place that needs it. */
void emit_node(Emitter *e, Node n)
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
    emit_comment(e, expr->span);
    Text name = {.arena = e->scratch};
    text_format(&name, "%c%u", type_letter(expr->type), e->next++);
    text_format(e->out, "    %s %s = %s;\n", type_name(expr->type), name.bytes, emit_bare(e, text));
    e->text[n]    = name.bytes;
    e->nesting[n] = 0;
}

void emit_begin(Emitter *e, const Node *roots, size_t count)
{
    count_uses(e, roots, count, false);
    e->next = 0;
    e->last = (Span){0, 0, 0};
    for (size_t i = 0; i < e->needed.count; i++) {
        Node n = e->needed.items[i];
        if (e->graph->items[n].time == TIME_COMPILE)
            emit_node(e, n);
        if (e->graph->items[n].time != TIME_FRAME)
            continue;
        e->text[n]    = e->frame[n];
        e->nesting[n] = 0;
    }
}

void emit_body(Emitter *e, const Node *roots, size_t count)
{
    emit_begin(e, roots, count);
    for (size_t i = 0; i < e->needed.count; i++)
        if (e->graph->items[e->needed.items[i]].time == TIME_POINT)
            emit_node(e, e->needed.items[i]);
}

/* Declares the globals; `set` gets the nodes that have one, of which there are so many. */
static size_t emit_globals(Emitter *e, const Node *roots, size_t count, Node *set, bool *is_global)
{
    const Graph *g       = e->graph;
    size_t       globals = 0;
    count_uses(e, roots, count, false);
    for (size_t i = 0; i < e->needed.count; i++) {
        Node n = e->needed.items[i];
        if (g->items[n].time != TIME_FRAME)
            continue;
        set[globals++] = n;
        is_global[n]   = true;
        Text name      = {.arena = e->scratch};
        text_format(&name, "krs_frame%u", e->globals++);
        e->frame[n] = name.bytes;
        text_format(e->out, "%s %s;\n", type_name(g->items[n].type), name.bytes);
    }
    return globals;
}

void emit_lay_out(Emitter *e, const Node *roots, size_t count, FrameValues *values)
{
    count_uses(e, roots, count, false);
    frame_values_assign(values, e->graph, e->needed.items, e->needed.count, e->out->arena,
                        e->scratch);
}

static const char *number_text(Emitter *e, const FrameValue *value, uint32_t k)
{
    return value->at[k] == NO_PLACE ? emit_number(e, value->constant[k])
                                    : slot_text(e, value->at[k] / 4, value->at[k] % 4, 1);
}

/* What the host has found, out of its slots. */
static const char *found_text(Emitter *e, const FrameValue *value)
{
    GraphType type     = (GraphType)e->graph->items[value->node].type;
    uint32_t  last     = value->width - 1;
    bool      together = true;
    for (uint32_t k = 0; k <= last; k++)
        together = together && value->at[k] != NO_PLACE && value->at[k] == value->at[0] + k;
    Text text = {.arena = e->scratch};
    if (type == TYPE_BOOL)
        text_format(&text, "(%s != 0.0)", number_text(e, value, 0));
    else if (type == TYPE_UINT && value->at[0] == NO_PLACE)
        text_format(&text, "%.0fu", value->constant[0]);
    else if (type == TYPE_UINT)
        text_format(&text, "floatBitsToUint(%s)", number_text(e, value, 0));
    else if (together && value->at[0] / 4 == value->at[last] / 4)
        return slot_text(e, value->at[0] / 4, value->at[0] % 4, value->width);
    else if (type == TYPE_FLOAT)
        return number_text(e, value, 0);
    else {
        text_format(&text, "%s(", type_name(type));
        for (uint32_t k = 0; k <= last; k++)
            text_format(&text, "%s%s", number_text(e, value, k), k < last ? ", " : ")");
    }
    return text.bytes;
}

/* A value of the frame as kernels get it from the host. */
static const char *read_text(Emitter *e, const FrameValues *values, Node n)
{
    const Expr *expr = &e->graph->items[n];
    if (e->found_index[n])
        return found_text(e, &values->items[e->found_index[n] - 1]);
    if (expr->op == OP_COMPONENT && frame_value_is_given(e->graph, n))
        return slot_text(e, e->graph->items[expr->operands[0]].index, expr->index, 1);
    for (uint32_t k = 0; k < expr->operand_count; k++) /* a leaf has none */
        e->text[expr->operands[k]] = read_text(e, values, expr->operands[k]);
    return node_text(e, expr);
}

/* The globals from the parameter block, in which the host has put them. */
static void emit_reads(Emitter *e, const Node *set, size_t globals, const FrameValues *values)
{
    memset(e->found_index, 0, e->graph->count * sizeof *e->found_index);
    for (size_t i = 0; i < values->count; i++)
        e->found_index[values->items[i].node] = (uint32_t)i + 1;
    for (size_t i = 0; i < globals; i++)
        text_format(e->out, "    %s = %s;\n", e->frame[set[i]],
                    emit_bare(e, read_text(e, values, set[i])));
}

/* The globals by operations. */
static void emit_definitions(Emitter *e, const Node *set, size_t globals, const bool *is_global)
{
    count_uses(e, set, globals, true);
    e->next = 0;
    for (size_t i = 0; i < e->needed.count; i++) {
        Node        n    = e->needed.items[i];
        const Expr *expr = &e->graph->items[n];
        if (!is_global[n]) {
            emit_node(e, n);
            continue;
        }
        emit_comment(e, expr->span);
        text_format(e->out, "    %s = %s;\n", e->frame[n], emit_bare(e, node_text(e, expr)));
        e->text[n]    = e->frame[n];
        e->nesting[n] = 0;
    }
}

void emit_frame(Emitter *e, const Node *roots, size_t count, const FrameValues *values)
{
    Node  *set       = arena_new_array(e->scratch, Node, e->graph->count);
    bool  *is_global = arena_new_array(e->scratch, bool, e->graph->count);
    size_t globals   = emit_globals(e, roots, count, set, is_global);
    text_add(e->out, "\n// Everything that stays the same within a frame: call it first.\n"
                     "void krs_prepare()\n{\n");
    if (!e->from_host && values->slots > 0)
        text_add(e->out, "#ifdef FRAME_VALUES // the host has found them\n");
    if (e->from_host || values->slots > 0)
        emit_reads(e, set, globals, values);
    if (!e->from_host && values->slots > 0)
        text_add(e->out, "#else\n");
    if (!e->from_host)
        emit_definitions(e, set, globals, is_global);
    if (!e->from_host && values->slots > 0)
        text_add(e->out, "#endif\n");
    text_add(e->out, "#ifdef ZONES\n"
                     "    for (int i = 0; i < ZONES; i++)\n"
                     "        krs_zones[i] = krs_parameter[KRS_SLOTS + i];\n"
                     "#endif\n"
                     "}\n\n");
}

typedef struct Helpers {
    const char **items;
    size_t       count, capacity;
} Helpers;

static bool holds(const Helpers *helpers, const char *text)
{
    for (size_t i = 0; i < helpers->count; i++)
        if (helpers->items[i] == text)
            return true;
    return false;
}

void emit_helpers(Emitter *e, const Node *roots, size_t count)
{
    Helpers done = {0};
    count_uses(e, roots, count, true); /* of the whole graph */
    for (size_t k = 0; k < e->needed.count; k++) {
        Op          op = (Op)e->graph->items[e->needed.items[k]].op;
        const char *helper;
        for (uint32_t i = 0; (helper = op_helper(op, i)); i++) {
            if (holds(&done, helper))
                continue;
            array_push(e->scratch, &done, helper);
            text_add(e->out, helper);
            text_add(e->out, "\n");
        }
    }
}
