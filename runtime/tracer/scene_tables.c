/*
 * scene_tables.c: tables are in memory of the device, since kernels read them at every point, and are
 * copied there from memory of the host.
 */
#include "runtime/tracer/scene_tables.h"

#include "runtime/tracer/layouts.h"

#define TABLES "tables of the scene"

enum { ROW_BYTES = 4 * sizeof(float), CELL_BYTES = 2 * sizeof(uint32_t) };

/* One of the two buffers, which holds so many texels. */
static bool table_create(KrsRendering *rendering, uint32_t binding, Buffer *buffer, size_t texels,
                         uint32_t texel_bytes)
{
    Gpu         *gpu   = &rendering->renderer->gpu;
    VkDeviceSize bytes = buffer_texel_bytes((VkDeviceSize)texels * texel_bytes);
    uint32_t     most  = gpu->properties.limits.maxTexelBufferElements;
    if (bytes / texel_bytes > most) {
        gpu_refuse(gpu, KRS_NO_DEVICE,
                   "the device has no room for the " TABLES
                   ": they are %zu texels, and it reads %u",
                   texels, most);
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
    const bool    any                    = rendering->program->table_cells > 0;
    const Buffer *tables[SCENE_BINDINGS] = {
        [ROWS_BINDING] = &rendering->table_rows, [CELLS_BINDING] = &rendering->table_cells};
    for (uint32_t binding = ROWS_BINDING; binding < SCENE_BINDINGS; binding++)
        layouts_bind_scene(&rendering->renderer->gpu, rendering->scene_set, binding,
                           any ? tables[binding]
                               : layouts_idle_table(rendering->renderer, binding));
}

static bool copy(Gpu *gpu, const Buffer *rows, const Buffer *cells, const KrsRendering *to)
{
    double ms = 0;
    if (!gpu_begin(gpu))
        return false;
    vkCmdCopyBuffer(gpu->commands, rows->buffer, to->table_rows.buffer, 1,
                    &(VkBufferCopy){0, 0, rows->size});
    vkCmdCopyBuffer(gpu->commands, cells->buffer, to->table_cells.buffer, 1,
                    &(VkBufferCopy){0, 0, cells->size});
    return gpu_finish(gpu, &ms);
}

bool scene_tables_upload(KrsRendering *rendering, const KrsFrame *frame)
{
    Gpu   *gpu  = &rendering->renderer->gpu;
    Buffer rows = {0}, cells = {0};
    if (rendering->has_tables || rendering->program->table_cells == 0)
        return true;
    if (buffer_create(gpu, &rows, rendering->table_rows.size, SHARED, TABLES) &&
        buffer_create(gpu, &cells, rendering->table_cells.size, SHARED, TABLES)) {
        krs_frame_tables(frame, rows.bytes, cells.bytes);
        rendering->has_tables = copy(gpu, &rows, &cells, rendering);
    }
    buffer_destroy(gpu, &rows);
    buffer_destroy(gpu, &cells);
    return rendering->has_tables;
}
