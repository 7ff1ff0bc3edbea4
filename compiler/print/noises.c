/*
 * noises.c: noises that do not need one another's values are found in the iterations of one loop.
 *
 * A noise is some hundreds of instructions where a driver copies the function to each place.  Of
 * materials with patterns these are most of what it has to translate.  In an iteration all places, and all
 * values found so far, move on by one: a driver copies variables that have fixed names without
 * instructions, but not elements of an array.
 */
#include "compiler/print/emitter.h"

/* Drivers end all loops of a lane after some iterations, without a word: lavapipe after 65535.  A lane may
   find 64 surfaces in a dispatch, with these iterations for each. */
enum { MAX_ITERATIONS = 256 };

static bool is_noise(const Expr *expr) { return expr->op == OP_noise2 || expr->op == OP_noise3; }

/* Tells whether the function that is being written has to compute it. */
static bool is_computed(const Emitter *e, Node n)
{
    return e->graph->items[n].time == TIME_POINT && !e->given[n];
}

/* Finds how many noises stand between each value and the point, one in the other.  Returns the most. */
static uint32_t find_ranks(Emitter *e)
{
    uint32_t most = 0;
    for (size_t i = 0; i < e->needed.count; i++) {
        const Node  n    = e->needed.items[i];
        const Expr *expr = &e->graph->items[n];
        e->rank[n]       = 0;
        for (uint32_t k = 0; is_computed(e, n) && k < expr->operand_count; k++) {
            const Node     operand = expr->operands[k];
            const uint32_t noises  = is_computed(e, operand) && is_noise(&e->graph->items[operand]);
            if (e->rank[operand] + noises > e->rank[n])
                e->rank[n] = e->rank[operand] + noises;
        }
        most = e->rank[n] > most ? e->rank[n] : most;
    }
    return most;
}

static const char *new_name(Emitter *e, char letter)
{
    Text name = {.arena = e->scratch};
    text_format(&name, "%c%u", letter, e->next++);
    return name.bytes;
}

/* Emits moves: each variable gets the value of the next one, and the last gets `last`, or stays. */
static void emit_moves(Emitter *e, const char **names, size_t count, const char *last)
{
    for (size_t i = 0; i + 1 < count; i++)
        emit_line(e, "    %s = %s;\n", names[i], names[i + 1]);
    if (last)
        emit_line(e, "    %s = %s;\n", names[count - 1], last);
}

static void emit_loop(Emitter *e, const NodeList *noises)
{
    const char **places    = arena_new_array(e->scratch, const char *, noises->count);
    const char **values    = arena_new_array(e->scratch, const char *, noises->count);
    const char  *iteration = new_name(e, 'n'), *value = new_name(e, 't');
    const Expr   first = e->graph->items[noises->items[0]];
    const Node   place = first.operands[0];
    for (size_t i = 0; i < noises->count; i++) {
        const Expr *noise = &e->graph->items[noises->items[i]];
        emit_comment(e, noise->span);
        places[i] = new_name(e, 'v');
        values[i] = new_name(e, 't');
        emit_variable(e, (GraphType)e->graph->items[place].type, places[i],
                      emit_bare(e, e->text[noise->operands[0]]));
        emit_variable(e, TYPE_FLOAT, values[i], "0.0");
    }
    emit_template(e, TEMPLATE_ITERATIONS, (Operands){iteration});
    const char *text = e->text[place];
    e->text[place]   = places[0];
    emit_local(e, TYPE_FLOAT, value, emit_bare(e, emit_expression(e, &first)));
    e->text[place] = text;
    emit_moves(e, places, noises->count, NULL);
    emit_moves(e, values, noises->count, value);
    emit_template(e, TEMPLATE_ITERATIONS_END, (Operands){iteration, emit_count(e, noises->count)});
    for (size_t i = 0; i < noises->count; i++) {
        e->text[noises->items[i]]    = values[i];
        e->nesting[noises->items[i]] = 0;
    }
}

static void emit_noises(Emitter *e, uint32_t rank, Op op)
{
    NodeList noises = {0};
    for (size_t i = 0; i < e->needed.count; i++) {
        const Node n = e->needed.items[i];
        if (is_computed(e, n) && e->rank[n] == rank && e->graph->items[n].op == op)
            array_push(e->scratch, &noises, n);
    }
    if (noises.count >= KRS_MIN_FUSED_NOISES && noises.count <= MAX_ITERATIONS - e->iterations) {
        e->iterations += (uint32_t)noises.count;
        emit_loop(e, &noises);
        return;
    }
    for (size_t i = 0; i < noises.count; i++)
        emit_node(e, noises.items[i]);
}

void emit_with_noises(Emitter *e)
{
    const uint32_t most = find_ranks(e);
    for (uint32_t rank = 0; rank <= most; rank++) {
        for (size_t i = 0; i < e->needed.count; i++) {
            const Node n = e->needed.items[i];
            if (e->rank[n] == rank && e->graph->items[n].time == TIME_POINT &&
                !(is_computed(e, n) && is_noise(&e->graph->items[n])))
                emit_point_node(e, n);
        }
        emit_noises(e, rank, OP_noise2);
        emit_noises(e, rank, OP_noise3);
    }
}
