/*
 * textures.c: textures in texts, and the ray that sees a surface.
 *
 * krs_prepare reads the header of each texture into a global.  The ray is a global as well, which
 * whoever calls krs_surface may set.
 */
#include "compiler/graph/instance_table.h"
#include "compiler/graph/texture.h"
#include "compiler/print/emitter.h"

static const char *texture_name(Emitter *e, uint32_t number)
{
    Text text = {.arena = e->scratch};
    text_format(&text, "krs_texture%u", (unsigned)number);
    return text.bytes;
}

static size_t texture_count(const Emitter *e)
{
    return e->graph->textures ? e->graph->textures->list.count : 0;
}

static uint32_t number_of(const Emitter *e, const Expr *texture)
{
    return (uint32_t)e->graph->items[texture->operands[2]].number[0];
}

void emit_note_seen(Emitter *e, const Expr *expr)
{
    e->sees = e->sees || expr->op == OP_VIEW || expr->op == OP_FRONT;
    if (!is_texture((Op)expr->op))
        return;
    if (!e->reads_texture)
        e->reads_texture = arena_new_array(e->scratch, bool, texture_count(e));
    e->reads_texture[number_of(e, expr)] = true;
}

bool emit_reads_textures(const Emitter *e) { return e->reads_texture != NULL; }

void emit_texture_globals(Emitter *e)
{
    for (uint32_t i = 0; e->reads_texture && i < texture_count(e); i++)
        if (e->reads_texture[i])
            emit_template(e, TEMPLATE_GLOBAL, (Operands){"KrsTexture", texture_name(e, i)});
    if (e->sees)
        text_add(e->out, "// The direction of the ray that sees a surface, if it is set behind "
                         "krs_prepare: pixels\n"
                         "// are as long on the surface as that tells.\n");
    if (e->sees)
        emit_template(e, TEMPLATE_GLOBAL, (Operands){e->printer->types[TYPE_VEC3], "krs_view"});
}

/* Emits the reads of headers, which are behind those of tables. */
void emit_texture_reads(Emitter *e)
{
    const size_t tables = e->graph->instances ? e->graph->instances->tables.count : 0;
    for (uint32_t i = 0; e->reads_texture && i < texture_count(e); i++)
        if (e->reads_texture[i]) {
            emit_call(e, "krs_read_texture", TYPE_UINT, 1);
            emit_line(e, "    %s = krs_read_texture(%zuu);\n", texture_name(e, i),
                      tables * GRID_HEADER + (size_t)i * TEXTURE_HEADER);
        }
    if (e->sees)
        emit_line(e, "    krs_view = %s;\n", emit_vector(e, (const double[3]){0, 0, 0}));
}

/* Tells whether a pixel has no width: then one level is enough. */
static bool is_sharp(const Emitter *e, Node pixel)
{
    const Expr *expr = &e->graph->items[pixel];
    return expr->op == OP_CONSTANT && expr->number[TEXTURE_WIDTH] == 0;
}

const char *emit_texture(Emitter *e, const Expr *texture)
{
    bool        sharp = is_sharp(e, texture->operands[1]);
    const char *name  = sharp ? "krs_texture_sharp" : "krs_texture";
    Text        text  = {.arena = e->scratch};
    emit_call(e, name, TYPE_VEC2, sharp ? 2 : 3);
    text_format(&text, "%s(%s, ", name, emit_bare(e, e->text[texture->operands[0]]));
    if (!sharp)
        text_format(&text, "%s, ", emit_bare(e, e->text[texture->operands[1]]));
    text_format(&text, "%s)%s", texture_name(e, number_of(e, texture)),
                texture->op == OP_texture_gray ? ".x" : "");
    return text.bytes;
}
