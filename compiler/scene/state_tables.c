/*
 * state_tables.c: the tables of instance groups in a state.  Where instances move, a state has tables and a graph of
 * its own, which its tapes read; nodes are those of the scene.
 */
#include <stdlib.h>
#include <string.h>

#include "compiler/graph/instances/instance_frame.h"
#include "compiler/scene/program.h"
#include "compiler/scene/tables.h"

struct StateTables {
    Memory     memory;
    Arena      arena;          /* of all but grids */
    Arena      grids, scratch; /* freed for each state */
    Graph      graph;          /* that of the scene with tables of the state */
    Instances *instances;
    bool       found; /* they are those of the values */
};

/* ---- tapes ---- */

/* Returns a tape of the scene over the tables of the state; so are those of functions that it
   calls. */
static Tape tape_of_frame(const Tape *tape, struct StateTables *tables)
{
    Tape  copy      = *tape;
    Tape *functions = arena_new_array(&tables->arena, Tape, tape->function_count + 1);
    copy.graph      = &tables->graph;
    copy.functions  = functions;
    for (uint32_t i = 0; i < tape->function_count; i++) {
        functions[i]           = tape->functions[i];
        functions[i].graph     = functions[i].graph ? &tables->graph : NULL; /* not called */
        functions[i].functions = functions;
    }
    return copy;
}

void state_count_operations(KrsState *state)
{
    StateTapes *tapes   = &state->tapes;
    tapes->distance.ran = tapes->guarded.ran = tapes->ahead.ran = &state->ran;
    tapes->gradients.ran = tapes->surface.ran = tapes->places.ran = &state->ran;
}

static void make_tables(KrsState *state, struct StateTables *tables)
{
    const KrsScene *scene    = state->scene;
    Tape           *copies[] = {&state->tapes.distance,  &state->tapes.guarded, &state->tapes.ahead,
                                &state->tapes.gradients, &state->tapes.surface, &state->tapes.places};
    const Tape     *tapes[]  = {&scene->distance,  &scene->guarded, &scene->ahead,
                                &scene->gradients, &scene->surface, &scene->places};
    tables->graph            = *scene->graph;
    tables->instances        = instances_for_frames(scene->graph->instances, &tables->arena);
    tables->graph.instances  = tables->instances;
    for (size_t i = 0; i < sizeof tapes / sizeof *tapes; i++)
        *copies[i] = tape_of_frame(tapes[i], tables);
}

static void *allocate(const Memory *memory, size_t size)
{
    return memory->allocate ? memory->allocate(memory->user, size) : malloc(size);
}

static void release(const Memory *memory, void *block)
{
    if (memory->allocate)
        memory->release(memory->user, block);
    else
        free(block);
}

bool state_tables_new(KrsState *state)
{
    const KrsScene *scene = state->scene;
    state->tapes          = (StateTapes){scene->distance,  scene->guarded, scene->ahead,
                                         scene->gradients, scene->surface, scene->places};
    state_count_operations(state);
    if (!instances_move(scene->graph->instances))
        return true;
    struct StateTables *tables = allocate(&scene->memory, sizeof *tables);
    if (!tables)
        return false;
    *tables       = (struct StateTables){.memory = {.allocate = scene->memory.allocate,
                                                    .release  = scene->memory.release,
                                                    .user     = scene->memory.user}};
    tables->arena = tables->grids = tables->scratch = (Arena){.memory = &tables->memory};
    state->tables                                   = tables;
    jmp_buf exhausted;
    tables->memory.exhausted = &exhausted;
    if (setjmp(exhausted) != 0)
        return false;
    make_tables(state, tables);
    state_count_operations(state);
    tables->memory.exhausted = NULL;
    return true;
}

void state_tables_free(KrsState *state)
{
    struct StateTables *tables = state->tables;
    if (!tables)
        return;
    arena_free(&tables->arena);
    arena_free(&tables->grids);
    arena_free(&tables->scratch);
    release(&state->scene->memory, tables);
    state->tables = NULL;
}

/* ---- grids ---- */

void state_tables_change(KrsState *state)
{
    if (state->tables)
        state->tables->found = false;
}

/* Finds the grids.  Where memory runs out they are those for all states, which are right in each. */
static void find_grids(struct StateTables *tables, const Instances *of_scene,
                       const NodeValue *values)
{
    jmp_buf exhausted;
    arena_clear(&tables->grids);
    tables->memory.exhausted = &exhausted;
    if (setjmp(exhausted) == 0)
        instances_enter_frame(tables->instances, values, &tables->grids, &tables->scratch);
    else
        memcpy(tables->instances->tables.items, of_scene->tables.items,
               of_scene->tables.count * sizeof *of_scene->tables.items);
    tables->memory.exhausted = NULL;
    arena_clear(&tables->scratch);
}

void state_tables_refresh(const KrsState *state)
{
    struct StateTables *tables = state->tables;
    const KrsScene     *scene  = state->scene;
    if (!tables || tables->found)
        return;
    if (!state->fresh)
        tape_run_frame(&scene->rows, state->parameters, state->values);
    find_grids(tables, scene->graph->instances, state->values);
    tables->found = true;
}

/* ---- as shaders read them ---- */

/* Tells whether a slot is that of the origin: the last one of the parameter block. */
static bool is_origin(const KrsScene *scene, uint32_t slot)
{
    return scene->program.camera_relative && slot == scene->program.parameter_slots - 1;
}

void krs_state_tables_in_use(const KrsState *state, const double *rebase_origin, float (*rows)[4],
                             uint32_t (*cells)[2], size_t *row_count, size_t *cell_count)
{
    const KrsScene  *scene     = state->scene;
    const Instances *instances = state->tables ? state->tables->instances : scene->graph->instances;
    if (rebase_origin)
        memcpy(state->parameters[scene->program.parameter_slots - 1].v, rebase_origin,
               3 * sizeof *rebase_origin);
    if (!state->fresh || rebase_origin)
        tape_run_frame(&scene->rows, state->parameters, state->values);
    state_tables_refresh(state);
    TableSizes used = tables_pack(instances, scene->graph->textures, state->values,
                                  rebase_origin != NULL, rows, cells);
    *row_count      = used.rows;
    *cell_count     = used.cells;
}

void krs_state_tables(const KrsState *state, float (*rows)[4], uint32_t (*cells)[2])
{
    const KrsProgram *program = &state->scene->program;
    size_t            row_count, cell_count;
    if (program->table_cells == 0)
        return;
    if (state->tables)
        memset(cells, 0, program->table_cells * sizeof *cells);
    krs_state_tables_in_use(state, NULL, rows, cells, &row_count, &cell_count);
    memset(rows + row_count, 0, (program->table_rows - row_count) * sizeof *rows);
}

void krs_state_table_inputs(const KrsState *state, const double *rebase_origin, double (*inputs)[4])
{
    const KrsScene *scene = state->scene;
    const Tape     *rows  = &scene->rows;
    memset(inputs, 0, scene->program.parameter_slots * sizeof *inputs);
    for (size_t i = 0; i < rows->frame_count; i++) {
        const Expr *e = &rows->graph->items[rows->nodes[i]];
        if (e->op != OP_PARAMETER)
            continue;
        if (!is_origin(scene, e->index))
            memcpy(inputs[e->index], state->parameters[e->index].v, sizeof *inputs);
        else if (rebase_origin)
            memcpy(inputs[e->index], rebase_origin, 3 * sizeof *rebase_origin);
    }
}
