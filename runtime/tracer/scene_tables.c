/*
 * scene_tables.c: tables are in memory of the device, since shaders read them at every point, and are
 * copied there from memory of the host.
 */
#include "runtime/tracer/scene_tables.h"

#include <string.h>

#include "runtime/tracer/layouts.h"

#define TABLES "tables of the scene"

enum { ROW_BYTES = 4 * sizeof(float), CELL_BYTES = 2 * sizeof(uint32_t) };

static uint64_t max_texels(const Gpu *gpu, uint32_t texel_bytes)
{
    return gpu->texels ? gpu->limits.texels : gpu->limits.storage_bytes / texel_bytes;
}

/* Makes one of the two buffers, which holds so many texels. */
static bool table_create(KrsRendering *rendering, uint32_t binding, Buffer *buffer, size_t texels,
                         uint32_t texel_bytes)
{
    Gpu           *gpu   = &rendering->renderer->gpu;
    const uint64_t bytes = buffer_texel_bytes((uint64_t)texels * texel_bytes);
    const uint64_t most  = max_texels(gpu, texel_bytes);
    if (bytes / texel_bytes > most) {
        gpu_refuse(gpu, KRS_NO_DEVICE,
                   "the device has no room for the " TABLES
                   ": they have %zu texels, and it reads %llu",
                   texels, (unsigned long long)most);
        return false;
    }
    return buffer_create(gpu, buffer, bytes, ON_DEVICE, TABLES) &&
           layouts_view_table(gpu, binding, buffer, TABLES);
}

bool scene_tables_create(KrsRendering *rendering)
{
    const KrsProgram *program = rendering->program;
    return program->table_cells == 0 ||
           (table_create(rendering, ROWS_BINDING, &rendering->table_rows, program->table_rows,
                         ROW_BYTES) &&
            table_create(rendering, CELLS_BINDING, &rendering->table_cells, program->table_cells,
                         CELL_BYTES));
}

void scene_tables_bind(KrsRendering *rendering)
{
    const bool    any      = rendering->program->table_cells > 0;
    const Buffer *tables[] = {
        [ROWS_BINDING] = &rendering->table_rows, [CELLS_BINDING] = &rendering->table_cells};
    for (uint32_t binding = ROWS_BINDING; binding <= CELLS_BINDING; binding++)
        layouts_bind_scene(&rendering->renderer->gpu, rendering->scene_set, binding,
                           any ? tables[binding]
                               : layouts_idle_table(rendering->renderer, binding));
}

static bool copy(Gpu *gpu, const Buffer *from, const Buffer *to, uint64_t bytes)
{
    double ms = 0;
    if (!gpu_begin(gpu))
        return false;
    gpu_copy(gpu, from, 0, to, 0, bytes);
    return gpu_finish(gpu, &ms);
}

static bool upload(KrsRendering *rendering, const KrsState *state, const double *rebase_origin)
{
    Gpu   *gpu  = &rendering->renderer->gpu;
    Buffer rows = {0}, cells = {0};
    size_t row_count, cell_count;
    bool   done = false;
    if (buffer_create(gpu, &rows, rendering->table_rows.size, SHARED, TABLES) &&
        buffer_create(gpu, &cells, rendering->table_cells.size, SHARED, TABLES)) {
        krs_state_tables_in_use(state, rebase_origin, rows.bytes, cells.bytes, &row_count,
                                &cell_count);
        done = copy(gpu, &rows, &rendering->table_rows, row_count * ROW_BYTES) &&
               copy(gpu, &cells, &rendering->table_cells, cell_count * CELL_BYTES);
    }
    buffer_destroy(gpu, &rows);
    buffer_destroy(gpu, &cells);
    return done;
}

/* Brings the tables of a state to the device, unless it has them already. */
static bool renew(KrsRendering *rendering, const KrsState *state, const double *rebase_origin)
{
    Gpu   *gpu         = &rendering->renderer->gpu;
    size_t slots       = rendering->program->parameter_slots;
    double(*inputs)[4] = gpu_alloc(gpu, slots, sizeof *inputs, "set the " TABLES);
    double(*before)[4] = rendering->table_inputs;
    if (!inputs)
        return false;
    krs_state_table_inputs(state, rebase_origin, inputs);
    bool same = before && memcmp(before, inputs, slots * sizeof *inputs) == 0;
    bool done = same || upload(rendering, state, rebase_origin);
    gpu_release(gpu, done ? before : inputs);
    if (done)
        rendering->table_inputs = inputs;
    return done;
}

bool scene_tables_upload(KrsRendering *rendering, const KrsState *state,
                         const double *rebase_origin)
{
    return rendering->program->table_cells == 0 || renew(rendering, state, rebase_origin);
}
