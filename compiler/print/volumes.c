/*
 * volumes.c: functions of media that scatter light: each has its own, and one function chooses by its number.
 */
#include "compiler/print/emitter.h"

static const KrsFunction functions[VOLUME_FUNCTIONS] = {
    KRS_FUNCTION_DENSITY, KRS_FUNCTION_ALBEDO, KRS_FUNCTION_ANISOTROPY, KRS_FUNCTION_EMISSION};

bool emit_wants_volume(const Emitter *e, uint32_t which) { return e->wanted[functions[which]]; }

void emit_volumes(Emitter *e)
{
    for (uint32_t which = 0; which < VOLUME_FUNCTIONS; which++)
        for (uint32_t i = 0; emit_wants_volume(e, which) && i < e->module->volume_count; i++) {
            const Node *root = &e->module->volumes[i * VOLUME_FUNCTIONS + which];
            emit_head_of_volume(e, which, i);
            emit_body(e, root, 1);
            emit_line(e, "    return %s;\n}\n\n", e->text[*root]);
        }
}

/* Emits the choice of a medium's own function. */
static void emit_choice(Emitter *e, uint32_t which, GraphType type, const char *nothing)
{
    emit_variable(e, type, "value", nothing);
    if (e->module->volume_count == 0)
        return;
    emit_template(e, TEMPLATE_SWITCH, (Operands){"volume"});
    for (uint32_t i = 0; i < e->module->volume_count; i++) {
        emit_template(e, TEMPLATE_CASE, (Operands){emit_count(e, i)});
        text_format(e->out, "        value = %s;\n", emit_call_of_volume(e, which, i));
        emit_template(e, TEMPLATE_CASE_END, (Operands){0});
    }
    emit_template(e, TEMPLATE_SWITCH_END, (Operands){0});
}

static void emit_plain(Emitter *e, uint32_t which, GraphType type)
{
    const Expr nothing = {.op = OP_CONSTANT, .type = type};
    emit_choice(e, which, type, emit_constant(e, &nothing));
    text_add(e->out, "    return value;\n");
}

void emit_density(Emitter *e) { emit_plain(e, 0, TYPE_FLOAT); }
void emit_albedo(Emitter *e) { emit_plain(e, 1, TYPE_VEC3); }
void emit_anisotropy(Emitter *e) { emit_plain(e, 2, TYPE_FLOAT); }
void emit_emission(Emitter *e) { emit_plain(e, 3, TYPE_VEC3); }
