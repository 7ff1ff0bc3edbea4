/*
 * statements.c: nodes of the graph as statements.
 *
 * Each function is a list of short statements in the order of the nodes.  A value that is used
 * once, by something near, stands inside the expression that uses it; everything else gets a
 * name.  What depends on parameters only is computed once, in krs_prepare, into globals that
 * the march reads as locals; literals cost nothing.  Statements carry the line of the scene
 * that they come from.
 */
#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/print/emitter.h"

/* Expressions are nested to this depth and length at most: compilers of shaders recurse. */
enum { MAX_NESTING = 6, MAX_INLINE = 72 };

/* Returns what names of values begin with. */
static char type_letter(GraphType type)
{
    switch (type) {
    case TYPE_FLOAT: return 't';
    case TYPE_BOOL: return 'b';
    case TYPE_UINT: return 'n';
    default: return 'v';
    }
}

/* Returns the printer's words for an operation. */
static const char *template_of(const Emitter *e, const Expr *expr)
{
    const char **words = &e->operations[expr->op * TYPES + expr->type];
    if (!*words)
        *words = printer_operation(e->printer, (Op)expr->op, (GraphType)expr->type, e->scratch);
    return *words;
}

/* Returns what $a or $A stands for. */
static Node operand_of(const Expr *expr, char letter)
{
    return expr->operands[letter - (isupper((unsigned char)letter) ? 'A' : 'a')];
}

static void add_operand(Emitter *e, Text *text, const Expr *expr, char letter)
{
    const char *operand = e->text[operand_of(expr, letter)];
    text_add(text, isupper((unsigned char)letter) ? emit_bare(e, operand) : operand);
}

/* Returns the printer's template with the operands in the place of $a, $b, $c, $d; $A is bare.
   What stands before a semicolon is a statement that comes before, and sets a local of its own,
   $t. */
static const char *fill_template(Emitter *e, const Expr *expr)
{
    Text        text  = {.arena = e->scratch};
    const char *from  = template_of(e, expr);
    uint32_t    local = strchr(from, ';') ? e->next++ : 0;
    const char *call  = strstr(from, "krs_");
    while (*from) {
        size_t plain = strcspn(from, "$;");
        if (call && call <= from + plain) {
            const GraphType type = (GraphType)e->graph->items[expr->operands[0]].type;
            text_add_bytes(&text, from, (size_t)(call - from));
            text_add(&text, emit_call(e, call, type, expr->operand_count));
            from = call + strcspn(call, "(");
            call = NULL;
            continue;
        }
        text_add_bytes(&text, from, plain);
        from += plain;
        if (*from == ';') {
            emit_comment(e, expr->span);
            emit_line(e, "    %s;\n", text.bytes);
            text = (Text){.arena = e->scratch};
            from += strspn(from, "; ");
        } else if (*from) {
            if (from[1] == 't')
                text_format(&text, "t%u", local);
            else
                add_operand(e, &text, expr, from[1]);
            from += 2;
        }
    }
    return text.bytes;
}

/* Tells whether an operation is one of two variables by a choice of the printer: built-ins mind what is not a
   number. */
static bool picks_variable(const Emitter *e, const Expr *expr)
{
    return (expr->op == OP_min || expr->op == OP_max) && expr->type == TYPE_FLOAT &&
           e->graph->items[expr->operands[0]].op != OP_CONSTANT &&
           e->graph->items[expr->operands[1]].op != OP_CONSTANT;
}

/* ---- what is not a template of the printer ---- */

static const char *slot_text(Emitter *e, const Expr *expr)
{
    return emit_slot(e, expr->index, 0, expr->type);
}

static const char *component_text(Emitter *e, const Expr *expr)
{
    Text text = {.arena = e->scratch};
    text_format(&text, "%s.%c", e->text[expr->operands[0]], "xyzw"[expr->index]);
    return text.bytes;
}

static const char *extremum_text(Emitter *e, const Expr *expr)
{
    Text text = {.arena = e->scratch};
    if (!picks_variable(e, expr))
        return fill_template(e, expr);
    text_format(&text, "%s(%s, %s)", expr->op == OP_min ? "KRS_MIN" : "KRS_MAX",
                e->text[expr->operands[0]], e->text[expr->operands[1]]);
    return text.bytes;
}

static const char *fold_text(Emitter *e, const Expr *expr)
{
    const char *mirror = mirror_text(e, expr);
    return mirror ? mirror : fill_template(e, expr);
}

/* Returns the text of the side that is seen, by the ray and the normal of the component's surface,
   whose function this is. */
static const char *front_text(Emitter *e, const Expr *expr)
{
    Text        text  = {.arena = e->scratch};
    const char *front = template_text(e, TEMPLATE_CHOICE,
                                      (Operands){"dot(krs_view, normal) > 0.0", "0.0", "1.0"});
    (void)expr;
    text_format(&text, "(%s)", front);
    return text.bytes;
}

/* Parameters of the function that is being written. */
static const char *const leaf_names[OP_COUNT] = {[OP_POINT]              = "p",
                                                 [OP_NORMAL]             = "normal",
                                                 [OP_FOOTPRINT]          = "footprint",
                                                 [OP_VIEW]               = "krs_view",
                                                 [OP_DIRECTION]          = "direction",
                                                 [OP_INSTANCE_POINT]     = "p",
                                                 [OP_INSTANCE_NORMAL]    = "normal",
                                                 [OP_INSTANCE_FOOTPRINT] = "pixel.x",
                                                 [OP_INSTANCE_THRESHOLD] = "pixel.y",
                                                 [OP_INSTANCE_ROW]       = "row"};

static const char *(*const special[OP_COUNT])(Emitter *e, const Expr *expr) = {
    [OP_CONSTANT]          = emit_constant,
    [OP_PARAMETERISED]     = emit_constant,
    [OP_PARAMETER]         = slot_text,
    [OP_COMPONENT]         = component_text,
    [OP_min]               = extremum_text,
    [OP_max]               = extremum_text,
    [OP_fold]              = fold_text,
    [OP_FRONT]             = front_text,
    [OP_STATE]             = emit_state,
    [OP_texture]           = emit_texture,
    [OP_texture_gray]      = emit_texture,
    [OP_row]               = emit_row,
    [OP_instance_distance] = emit_instance_call,
    [OP_instance_list]     = emit_instance_call,
    [OP_instance_index]    = emit_instance_call,
    [OP_instance_number]   = emit_instance_call,
    [OP_instance_vector]   = emit_instance_call,
};

const char *emit_expression(Emitter *e, const Expr *expr)
{
    if (leaf_names[expr->op])
        return leaf_names[expr->op];
    return special[expr->op] ? special[expr->op](e, expr) : fill_template(e, expr);
}

/* ---- uses ---- */

/* Tells whether a template names an operand twice: what stands twice is computed twice.  Where nothing is
   printed there is none. */
static bool repeats_operand(const Emitter *e, const Expr *user, Node operand)
{
    if (user->op == OP_COMPONENT || op_has_traits((Op)user->op, READS_TABLES) || !e->printer)
        return false;
    if (picks_variable(e, user) ||
        (user->op == OP_fold && user->operands[0] == operand && mirror_repeats(e, user)))
        return true;
    uint32_t count = 0;
    for (const char *at = strchr(template_of(e, user), '$'); at; at = strchr(at + 1, '$'))
        count += at[1] != 't' && operand_of(user, at[1]) == operand;
    return count > 1;
}

static void use(Emitter *e, Node node, uint32_t count)
{
    if (e->uses[node] == 0)
        array_push(e->scratch, &e->needed, node);
    e->uses[node] += count;
}

/* Notes what a row of mirrors needs. */
static void use_mirror(Emitter *e, Node fold)
{
    const MirrorNodes *nodes                           = mirror_nodes(e, fold);
    e->feeds_mirror[e->graph->items[fold].operands[0]] = true;
    if (!nodes)
        return;
    for (int i = 0; i < 2; i++)
        if (nodes->products[i] != NODE_NONE)
            use(e, nodes->products[i], 1);
}

static int compare_nodes(const void *a, const void *b)
{
    return (*(const Node *)a > *(const Node *)b) - (*(const Node *)a < *(const Node *)b);
}

/* The work grows with the function, not with the graph: there are several functions for each
   component. */
void emit_count_uses(Emitter *e, const Node *roots, size_t count, bool frame)
{
    for (size_t i = 0; i < e->needed.count; i++)
        e->uses[e->needed.items[i]] = e->feeds_mirror[e->needed.items[i]] = 0;
    e->needed.count = 0;
    for (size_t i = 0; i < count; i++)
        use(e, roots[i], 2); /* a root needs a name */
    for (size_t i = 0; i < e->needed.count; i++) {
        const Expr *expr = &e->graph->items[e->needed.items[i]];
        if ((!frame && expr->time != TIME_POINT) || e->given[e->needed.items[i]])
            continue;
        for (uint32_t k = 0; k < expr->operand_count; k++)
            use(e, expr->operands[k], repeats_operand(e, expr, expr->operands[k]) ? 2 : 1);
        if (expr->op == OP_fold)
            use_mirror(e, e->needed.items[i]);
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
    const char *text  = emit_expression(e, expr);
    bool        part  = (expr->op == OP_COMPONENT && deep == 0) || expr->op == OP_row;
    bool        plain = is_leaf(expr) || part;
    e->nesting[n]     = plain ? 0 : deep + 1;
    e->text[n]        = text;
    if (plain || (e->uses[n] == 1 && e->nesting[n] < MAX_NESTING && strlen(text) < MAX_INLINE))
        return;
    emit_comment(e, expr->span);
    Text name = {.arena = e->scratch};
    text_format(&name, "%c%u", type_letter(expr->type), e->next++);
    emit_local(e, (GraphType)expr->type, name.bytes, emit_bare(e, text));
    e->text[n]    = name.bytes;
    e->nesting[n] = 0;
}

void emit_begin(Emitter *e, const Node *roots, size_t count)
{
    emit_count_uses(e, roots, count, false);
    e->next             = 0;
    e->row_texels.count = 0;
    e->last             = (Span){0, 0, 0};
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

/* Emits a node of the point; what is given has its name. */
void emit_point_node(Emitter *e, Node n)
{
    if (!e->given[n]) {
        emit_node(e, n);
        return;
    }
    e->text[n]    = e->given[n];
    e->nesting[n] = 0;
}

void emit_body(Emitter *e, const Node *roots, size_t count)
{
    emit_begin(e, roots, count);
    if (e->gathers_noises) {
        emit_with_noises(e);
        return;
    }
    for (size_t i = 0; i < e->needed.count; i++)
        if (e->graph->items[e->needed.items[i]].time == TIME_POINT)
            emit_point_node(e, e->needed.items[i]);
}
