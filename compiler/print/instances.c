/*
 * instances.c: functions of instance groups: a loop over the instances that a grid lists for the point.
 *
 * They are opaque to all else: a call is an expression.  Which instances are near, and their numbers,
 * is read from texel buffers by helpers.  A texel of a row is loaded once, before its first use.
 */
#include <string.h>

#include "compiler/graph/instance_table.h"
#include "compiler/print/emitter.h"

/* ---- which are called ---- */

static void note_node(Emitter *e, Node node)
{
    const Expr *expr = &e->graph->items[node];
    emit_note_seen(e, expr);
    if (expr->op != OP_row && !is_call((Op)expr->op))
        return;
    uint32_t id = (uint32_t)e->graph->items[expr->operands[0]].number[0];
    if (is_call((Op)expr->op))
        e->called[id] = (uint8_t)(expr->operand_count - 1);
    uint32_t table_number        = is_call((Op)expr->op)
                                       ? e->graph->instances->functions.items[id].table_number
                                       : row_table(id);
    e->reads_table[table_number] = true;
}

static void note_roots(Emitter *e, const Node *roots, size_t count)
{
    emit_count_uses(e, roots, count, false);
    for (size_t i = 0; i < e->needed.count; i++)
        note_node(e, e->needed.items[i]);
}

static Node *bodies_of(const Emitter *e, const InstanceFunction *function)
{
    return e->graph->instances->bodies.items + function->first_body;
}

void emit_find_called(Emitter *e, NodeList *roots)
{
    const Instances *instances = e->graph->instances;
    if (instances) {
        e->called      = arena_new_array(e->scratch, uint8_t, instances->functions.count + 1);
        e->reads_table = arena_new_array(e->scratch, bool, instances->tables.count + 1);
    }
    note_roots(e, roots->items, roots->count);
    if (!instances)
        return;
    for (size_t id = instances->functions.count;
         id-- > 0;) { /* those that it calls come before it */
        const InstanceFunction *function = &instances->functions.items[id];
        if (!e->called[id])
            continue;
        note_roots(e, bodies_of(e, function), body_count(function));
        for (uint32_t i = 0; i < body_count(function); i++)
            array_push(e->scratch, roots, bodies_of(e, function)[i]);
    }
}

/* ---- tables ---- */

static const char *numbered(Emitter *e, const char *name, uint32_t number)
{
    Text text = {.arena = e->scratch};
    text_format(&text, "%s%u", name, (unsigned)number);
    return text.bytes;
}

static const char *table_name(Emitter *e, uint32_t table)
{
    return numbered(e, "krs_table", table);
}

bool emit_reads_tables(const Emitter *e)
{
    for (size_t i = 0; e->reads_table && i < e->graph->instances->tables.count; i++)
        if (e->reads_table[i])
            return true;
    return false;
}

void emit_table_globals(Emitter *e)
{
    for (uint32_t i = 0; e->reads_table && i < e->graph->instances->tables.count; i++)
        if (e->reads_table[i])
            emit_template(e, TEMPLATE_GLOBAL, (Operands){"KrsTable", table_name(e, i)});
}

void emit_table_reads(Emitter *e)
{
    for (uint32_t i = 0; e->reads_table && i < e->graph->instances->tables.count; i++)
        if (e->reads_table[i]) {
            emit_call(e, "krs_read_table", TYPE_UINT, 1);
            emit_line(e, "    %s = krs_read_table(%uu);\n", table_name(e, i), (unsigned)i);
        }
}

/* ---- rows ---- */

/* Returns the name of a texel that has been loaded, or NULL. */
static const char *find_texel(const Emitter *e, uint32_t table_number, uint32_t texel,
                              Node instance)
{
    for (size_t i = 0; i < e->row_texels.count; i++) {
        const RowTexel *loaded = &e->row_texels.items[i];
        if (loaded->table_number == table_number && loaded->texel == texel &&
            loaded->instance == instance)
            return loaded->name;
    }
    return NULL;
}

static const char *load_texel(Emitter *e, uint32_t table_number, uint32_t texel, Node instance)
{
    const InstanceTable *table  = &e->graph->instances->tables.items[table_number];
    RowTexel             loaded = {table_number, texel, instance, numbered(e, "row", e->next++)};
    Text                 text   = {.arena = e->scratch};
    bool        listed = e->graph->items[instance].op == OP_INSTANCE_ROW; /* of the loop at hand */
    const char *name   = listed ? "krs_listed_row" : "krs_row";
    emit_call(e, name, TYPE_UINT, 4);
    text_format(&text, "%s(%s, %uu, %uu, %s)", name, listed ? "i" : emit_bare(e, e->text[instance]),
                (unsigned)row_texels(table), (unsigned)texel, table_name(e, table_number));
    emit_local(e, TYPE_VEC4, loaded.name, text.bytes);
    array_push(e->scratch, &e->row_texels, loaded);
    return loaded.name;
}

const char *emit_row(Emitter *e, const Expr *row)
{
    uint32_t    id           = (uint32_t)e->graph->items[row->operands[0]].number[0];
    uint32_t    table_number = row_table(id), texel = row_column(id) / 4;
    const char *name = find_texel(e, table_number, texel, row->operands[1]);
    Text        text = {.arena = e->scratch};
    if (!name)
        name = load_texel(e, table_number, texel, row->operands[1]);
    text_format(&text, "%s.%c", name, "xyzw"[row_column(id) % 4]);
    return text.bytes;
}

/* ---- functions ---- */

/* Returns the name of a function; in texts functions count from 1. */
static const char *function_name(Emitter *e, uint32_t id)
{
    return numbered(e, "krs_instances_", id + 1);
}

static const char *state_name(Emitter *e, uint32_t state) { return numbered(e, "state", state); }

const char *emit_instance_call(Emitter *e, const Expr *call)
{
    uint32_t id   = (uint32_t)e->graph->items[call->operands[0]].number[0];
    Text     text = {.arena = e->scratch};
    text_format(&text, "%s(", function_name(e, id));
    for (uint32_t k = 1; k < call->operand_count; k++)
        text_format(&text, "%s%s", k > 1 ? ", " : "", emit_bare(e, e->text[call->operands[k]]));
    text_add(&text, ")");
    return text.bytes;
}

const char *emit_state(Emitter *e, const Expr *state)
{
    return state_name(e, state_of(state->index));
}

/* Returns the parameters of functions that are called with so many operands: some with the point alone. */
static const char *parameters_text(Emitter *e, uint32_t count)
{
    static const GraphType   types[] = {TYPE_VEC3, TYPE_VEC3, TYPE_VEC2};
    static const char *const names[] = {"p", "normal", "pixel"};
    Text                     text    = {.arena = e->scratch};
    for (uint32_t i = 0; i < count; i++) {
        Operands parameter = {e->printer->types[types[i]], names[i]};
        text_add(&text, i ? ", " : "");
        text_add(&text, template_text(e, TEMPLATE_PARAMETER, parameter));
    }
    return text.bytes;
}

/* Returns the first value of a state. */
static const char *first_text(Emitter *e, const InstanceState *state)
{
    Expr first = {.op = OP_CONSTANT, .type = (uint8_t)state->type};
    memcpy(first.number, state->first, sizeof first.number);
    return emit_constant(e, &first);
}

static void emit_first_states(Emitter *e, const InstanceFunction *function)
{
    for (uint32_t i = 0; i < function->state_count; i++) {
        const InstanceState *state = &function->states[i];
        emit_variable(e, state->type, state_name(e, i), first_text(e, state));
    }
}

/* Emits the next states, which change at once. */
static void emit_next_states(Emitter *e, const InstanceFunction *function, const Node *bodies)
{
    bool one = function->state_count == 1;
    for (uint32_t i = 0; i < function->state_count && !one; i++)
        emit_local(e, function->states[i].type, numbered(e, "next", i),
                   emit_bare(e, e->text[bodies[i]]));
    for (uint32_t i = 0; i < function->state_count; i++)
        emit_line(e, "    %s = %s;\n", state_name(e, i),
                  one ? emit_bare(e, e->text[bodies[i]]) : numbered(e, "next", i));
}

/* Moves the lines behind a place of the text to the right. */
static void indent_lines(Emitter *e, size_t from)
{
    const char *lines = arena_copy_text(e->scratch, e->out->bytes + from, e->out->length - from);
    e->out->length    = from;
    for (size_t length; *lines; lines += length) {
        length = strcspn(lines, "\n") + 1;
        text_add(e->out, "    ");
        text_add_bytes(e->out, lines, length);
    }
}

/* Returns the tail of the entry at hand: in the last of its texels, which may be loaded. */
static const char *tail_text(Emitter *e, uint32_t table_number)
{
    const InstanceTable *table = &e->graph->instances->tables.items[table_number];
    const char          *name  = NULL;
    Text                 text  = {.arena = e->scratch};
    for (size_t i = 0; i < e->row_texels.count; i++)
        if (e->row_texels.items[i].table_number == table_number &&
            e->row_texels.items[i].texel == table->columns / 4)
            name = e->row_texels.items[i].name;
    if (name) {
        text_add(&text, name);
    } else {
        emit_call(e, "krs_listed_row", TYPE_UINT, 4);
        text_format(&text, "krs_listed_row(i, %uu, %uu, %s)", (unsigned)row_texels(table),
                    (unsigned)table->columns / 4, table_name(e, table_number));
    }
    text_format(&text, ".%c", "xyzw"[table->columns % 4]);
    return text.bytes;
}

static const char *choice_text(Emitter *e, const char *condition, const char *one,
                               const char *other)
{
    return template_text(e, TEMPLATE_CHOICE, (Operands){condition, one, other});
}

/* Emits a sum of powers, until what is left may lack.  The last power that counts is cut so that
   the result has no steps. */
static void emit_sum_that_ends(Emitter *e, const InstanceFunction *function, const Node *bodies)
{
    const char *table = table_name(e, function->table_number);
    Text        text  = {.arena = e->scratch};
    emit_call(e, "krs_growth", TYPE_VEC3, 2);
    emit_call(e, "krs_exact_from", TYPE_VEC3, 2);
    emit_call(e, "krs_lack", TYPE_FLOAT, 2);
    text_format(&text, "krs_growth(p, %s)", table);
    emit_local(e, TYPE_FLOAT, "growth", text.bytes);
    text.length = 0;
    text_format(&text, "krs_exact_from(p, %s)", table);
    emit_local(e, TYPE_FLOAT, "exact_from", text.bytes);
    emit_variable(e, TYPE_FLOAT, "sum", "0.0");
    emit_variable(e, TYPE_FLOAT, "whole", "0.0");
    emit_template(e, TEMPLATE_EACH_LISTED, (Operands){table});
    const size_t body = e->out->length;
    emit_body(e, &bodies[3], 1);
    text.length = 0;
    emit_local(e, TYPE_FLOAT, "apart", emit_bare(e, e->text[bodies[3]]));
    text_format(&text, "exp((nearby.clearance - apart) * %s.per_width)", table);
    emit_local(e, TYPE_FLOAT, "power", text.bytes);
    text.length = 0;
    text_format(&text, "sum + %s * growth", tail_text(e, function->table_number));
    emit_local(e, TYPE_FLOAT, "most", text.bytes);
    emit_line(e, "    sum += power;\n");
    emit_line(e, "    whole = sum + krs_lack(sum, exact_from);\n");
    emit_line(e, "    nearby.end = %s;\n", choice_text(e, "most > whole", "nearby.end", "i"));
    emit_line(e, "    whole = min(whole, most);\n");
    indent_lines(e, body);
    text_add(e->out, "    }\n");
    text.length = 0;
    text_format(&text, "nearby.clearance - %s.width * log(whole)", table);
    emit_local(e, TYPE_FLOAT, "blended", text.bytes);
    emit_line(e, "    return %s;\n}\n\n",
              choice_text(e, "whole > 0.0", "blended", "nearby.clearance"));
}

/* Emits the end of a function that joins its states: what it returns. */
static void emit_end_of_states(Emitter *e, const InstanceFunction *function, const Node *bodies)
{
    const Node  body   = bodies[function->state_count];
    const char *listed = function->listed == NOT_LISTED ? "" : state_name(e, function->listed);
    emit_body(e, &body, 1);
    const char *end = emit_bare(e, e->text[body]);
    if (!function->clear) {
        text_format(e->out, "    return %s;\n}\n\n", function->listed == NOT_LISTED ? end : listed);
    } else if (function->listed == NOT_LISTED) {
        text_format(e->out, "    return min(%s, nearby.clearance);\n}\n\n", end);
    } else {
        const InstanceState *state     = &function->states[function->listed];
        Text                 is_listed = {.arena = e->scratch};
        text_format(&is_listed, "%s < nearby.clearance", end);
        emit_local(e, TYPE_BOOL, "listed", is_listed.bytes);
        emit_variable(e, state->type, "none", first_text(e, state));
        if (function->listed == 0)
            emit_line(e, state->type == TYPE_FLOAT ? "    none = nearby.clearance;\n"
                                                   : "    none.x = nearby.clearance;\n");
        text_format(e->out, "    return %s;\n}\n\n", choice_text(e, "listed", listed, "none"));
    }
}

static void emit_function_of_instances(Emitter *e, uint32_t id)
{
    const InstanceFunction *function = &e->graph->instances->functions.items[id];
    const Node             *bodies   = bodies_of(e, function);
    const char             *table    = table_name(e, function->table_number);
    const Operands          head     = {e->printer->types[function->type], function_name(e, id),
                                        parameters_text(e, e->called[id])};
    emit_call(e, "krs_near", TYPE_VEC3, 2);
    emit_call(e, "krs_listed", TYPE_UINT, 2);
    text_format(e->out, "%s\n{\n", template_text(e, TEMPLATE_FUNCTION, head));
    if (function->ends) {
        emit_sum_that_ends(e, function, bodies);
        return;
    }
    emit_first_states(e, function);
    emit_template(e, TEMPLATE_EACH_LISTED, (Operands){table});
    const size_t body = e->out->length;
    emit_body(e, bodies, function->state_count);
    emit_next_states(e, function, bodies);
    indent_lines(e, body);
    text_add(e->out, "    }\n");
    if (function->joins) {
        emit_end_of_states(e, function, bodies);
        return;
    }
    if (function->sums) /* without an instance the sum is 0 */
        emit_line(e, "    state0 -= state2 * log(max(state1, 1.0));\n");
    text_format(e->out, "    return %s;\n}\n\n",
                function->either  ? choice_text(e, "abs(state0) < abs(nearby.clearance)", "state0",
                                                "nearby.clearance")
                : function->clear ? "min(state0, nearby.clearance)"
                                  : "state0");
}

void emit_instances(Emitter *e)
{
    for (uint32_t id = 0; e->called && id < e->graph->instances->functions.count; id++)
        if (e->called[id])
            emit_function_of_instances(e, id);
}
