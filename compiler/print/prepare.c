/*
 * prepare.c: krs_prepare: what depends on parameters only, once, in globals that functions of the point
 * read.  The host has found it, or it is computed.
 */
#include <string.h>

#include "compiler/print/emitter.h"

/* Names the values of a frame, and declares them as globals unless they are macros; `set` gets their nodes.
   Returns how many there are. */
static size_t emit_globals(Emitter *e, const Node *roots, size_t count, bool macros, Node *set,
                           bool *is_global)
{
    const Graph *g       = e->graph;
    size_t       globals = 0;
    emit_count_uses(e, roots, count, false);
    for (size_t i = 0; i < e->needed.count; i++) {
        Node n = e->needed.items[i];
        if (g->items[n].time != TIME_FRAME)
            continue;
        set[globals++] = n;
        is_global[n]   = true;
        Text name      = {.arena = e->scratch};
        text_format(&name, "krs_frame%u", e->globals++);
        e->frame[n] = name.bytes;
        if (!macros)
            emit_template(e, TEMPLATE_GLOBAL,
                          (Operands){e->printer->types[g->items[n].type], name.bytes});
    }
    return globals;
}

/* Returns components of a slot.  A local gets all four numbers before the first of them is used:
   drivers compare each read with all reads before it, so fewer reads are compiled sooner. */
static const char *component_text(Emitter *e, uint32_t slot, uint32_t first, uint32_t width)
{
    if (e->printer->macros)
        return emit_slot(e, slot, first, width);
    Text name = {.arena = e->scratch};
    text_format(&name, "krs_slot%u", slot);
    if (!e->slot_is_read[slot])
        emit_template(
            e, TEMPLATE_LOCAL,
            (Operands){e->printer->types[TYPE_VEC4], name.bytes, emit_slot(e, slot, 0, 4)});
    e->slot_is_read[slot] = true;
    if (width < 4)
        text_format(&name, ".%.*s", (int)width, &"xyzw"[first]);
    return name.bytes;
}

static const char *number_text(Emitter *e, const StateValue *value, uint32_t k)
{
    return value->at[k] == NO_PLACE ? emit_number(e, value->constant[k])
                                    : component_text(e, value->at[k] / 4, value->at[k] % 4, 1);
}

/* Returns what the host has found, out of its slots. */
static const char *found_text(Emitter *e, const StateValue *value)
{
    GraphType type     = (GraphType)e->graph->items[value->node].type;
    uint32_t  last     = value->width - 1;
    bool      adjacent = true;
    for (uint32_t k = 0; k <= last; k++)
        adjacent = adjacent && value->at[k] != NO_PLACE && value->at[k] == value->at[0] + k;
    Text text = {.arena = e->scratch};
    if (type == TYPE_BOOL)
        text_format(&text, "(%s != 0.0)", number_text(e, value, 0));
    else if (type == TYPE_UINT && value->at[0] == NO_PLACE)
        text_format(&text, "%.0fu", value->constant[0]);
    else if (type == TYPE_UINT)
        return template_text(e, TEMPLATE_BITS, (Operands){number_text(e, value, 0)});
    else if (adjacent && value->at[0] / 4 == value->at[last] / 4)
        return component_text(e, value->at[0] / 4, value->at[0] % 4, value->width);
    else if (type == TYPE_FLOAT)
        return number_text(e, value, 0);
    else {
        text_format(&text, "%s(", e->printer->types[type]);
        for (uint32_t k = 0; k <= last; k++)
            text_format(&text, "%s%s", number_text(e, value, k), k < last ? ", " : ")");
    }
    return text.bytes;
}

/* Reads a value of the frame as shaders get it from the host. */
static const char *read_text(Emitter *e, const StateValues *values, Node n)
{
    const Expr *expr = &e->graph->items[n];
    if (e->place[n])
        return found_text(e, &values->items[e->place[n] - 1]);
    if (expr->op == OP_COMPONENT && state_value_is_given(e->graph, n))
        return component_text(e, e->graph->items[expr->operands[0]].index, expr->index, 1);
    for (uint32_t k = 0; k < expr->operand_count; k++) /* a leaf has none */
        e->text[expr->operands[k]] = read_text(e, values, expr->operands[k]);
    return emit_expression(e, expr);
}

/* Emits the globals, or macros, from the parameter block, in which the host has put them. */
static void emit_reads(Emitter *e, const Node *set, size_t globals, const StateValues *values)
{
    e->slot_is_read = arena_new_array(e->scratch, bool, emit_slot_count(e));
    memset(e->place, 0, e->graph->count * sizeof *e->place);
    for (size_t i = 0; i < values->count; i++)
        e->place[values->items[i].node] = (uint32_t)i + 1;
    for (size_t i = 0; i < globals; i++)
        emit_line(e, e->printer->macros ? "#define %s (%s)\n" : "    %s = %s;\n", e->frame[set[i]],
                  emit_bare(e, read_text(e, values, set[i])));
}

/* Emits the globals by operations. */
static void emit_definitions(Emitter *e, const Node *set, size_t globals, const bool *is_global)
{
    emit_count_uses(e, set, globals, true);
    e->next = 0;
    for (size_t i = 0; i < e->needed.count; i++) {
        Node        n    = e->needed.items[i];
        const Expr *expr = &e->graph->items[n];
        if (!is_global[n]) {
            emit_node(e, n);
            continue;
        }
        emit_comment(e, expr->span);
        emit_line(e, "    %s = %s;\n", e->frame[n], emit_bare(e, emit_expression(e, expr)));
        e->text[n]    = e->frame[n];
        e->nesting[n] = 0;
    }
}

bool emit_reads_zones(const Emitter *e)
{
    return e->variant->zones > 0 && (e->cuts || emit_wants_gradient(e));
}

/* Returns the first slot of the zones of the caller. */
static uint32_t zone_slot(const Emitter *e)
{
    const StateValues *plain = &e->module->slots.plain;
    const bool         found = e->variant->values || e->variant->camera_relative;
    return plain->first_slot + (found ? plain->slots : 0);
}

/* Emits the reads of zones of the caller. */
static void emit_zone_reads(Emitter *e)
{
    if (emit_reads_zones(e))
        emit_template(e, TEMPLATE_READ_ZONES,
                      (Operands){emit_count(e, e->variant->zones), emit_count(e, zone_slot(e))});
}

uint32_t emit_slot_count(const Emitter *e)
{
    const StateSlots *slots = &e->module->slots;
    if (e->variant->camera_relative)
        return slots->camera_relative.first_slot + slots->camera_relative.slots + 1;
    return zone_slot(e) + e->variant->zones;
}

void emit_prepare(Emitter *e, const Node *roots, size_t count, const StateValues *values)
{
    Node  *set       = arena_new_array(e->scratch, Node, e->graph->count);
    bool  *is_global = arena_new_array(e->scratch, bool, e->graph->count);
    bool   reads     = e->variant->camera_relative || (e->variant->values && values->slots > 0);
    bool   macros    = reads && e->printer->macros;
    size_t globals   = emit_globals(e, roots, count, macros, set, is_global);
    emit_table_globals(e);
    emit_texture_globals(e);
    bool any = globals || emit_reads_tables(e) || emit_reads_textures(e) || e->sees;
    text_add(e->out, any ? "\n" : "");
    if (macros) {
        emit_reads(e, set, globals, values);
        text_add(e->out, globals ? "\n" : "");
    }
    emit_prepare_head(e);
    emit_table_reads(e);
    emit_texture_reads(e);
    if (reads && !macros)
        emit_reads(e, set, globals, values);
    if (!reads)
        emit_definitions(e, set, globals, is_global);
    emit_zone_reads(e);
    text_add(e->out, "}\n\n");
}
