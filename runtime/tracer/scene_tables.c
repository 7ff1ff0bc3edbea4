/*
 * scene_tables.c: tables are in memory of the device, since kernels read them at every point, and are
 * copied there from memory of the host.
 */
#include "runtime/tracer/scene_tables.h"

#include <string.h>

#include "runtime/tracer/layouts.h"

#define TABLES "tables of the scene"

enum { ROW_BYTES = 4 * sizeof(float), CELL_BYTES = 2 * sizeof(uint32_t) };

static VkDeviceSize most_texels(const Gpu *gpu, uint32_t texel_bytes)
{
    const VkPhysicalDeviceLimits *limits = &gpu->properties.limits;
    return gpu->texels ? limits->maxTexelBufferElements
                       : limits->maxStorageBufferRange / texel_bytes;
}

/* One of the two buffers, which holds so many texels. */
static bool table_create(KrsRendering *rendering, uint32_t binding, Buffer *buffer, size_t texels,
                         uint32_t texel_bytes)
{
    Gpu         *gpu   = &rendering->renderer->gpu;
    VkDeviceSize bytes = buffer_texel_bytes((VkDeviceSize)texels * texel_bytes);
    VkDeviceSize most  = most_texels(gpu, texel_bytes);
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

static bool copy(Gpu *gpu, const Buffer *from, const Buffer *to)
{
    double ms = 0;
    if (!gpu_begin(gpu))
        return false;
    vkCmdCopyBuffer(gpu->commands, from->buffer, to->buffer, 1, &(VkBufferCopy){0, 0, from->size});
    return gpu_finish(gpu, &ms);
}

static bool upload_all(KrsRendering *rendering, const KrsFrame *frame)
{
    Gpu   *gpu  = &rendering->renderer->gpu;
    Buffer rows = {0}, cells = {0};
    if (buffer_create(gpu, &rows, rendering->table_rows.size, SHARED, TABLES) &&
        buffer_create(gpu, &cells, rendering->table_cells.size, SHARED, TABLES)) {
        krs_frame_tables(frame, rows.bytes, cells.bytes);
        rendering->has_tables = copy(gpu, &rows, &rendering->table_rows) &&
                                copy(gpu, &cells, &rendering->table_cells);
    }
    buffer_destroy(gpu, &rows);
    buffer_destroy(gpu, &cells);
    return rendering->has_tables;
}

static bool upload_rows(KrsRendering *rendering, const void *rows, size_t bytes)
{
    Gpu   *gpu    = &rendering->renderer->gpu;
    Buffer staged = {0};
    bool   done   = buffer_create(gpu, &staged, rendering->table_rows.size, SHARED, TABLES);
    if (done) {
        memcpy(staged.bytes, rows, bytes);
        done = copy(gpu, &staged, &rendering->table_rows);
    }
    buffer_destroy(gpu, &staged);
    return done;
}

/* Rows are those of the frame, unless they are so already. */
static bool renew_rows(KrsRendering *rendering, const KrsFrame *frame)
{
    Gpu   *gpu        = &rendering->renderer->gpu;
    size_t texels     = rendering->program->table_rows;
    float(*rows)[4]   = gpu_alloc(gpu, texels, sizeof *rows, "set the " TABLES);
    float(*before)[4] = rendering->frame_rows;
    if (!rows)
        return false;
    krs_frame_rows(frame, rows);
    bool same = before && memcmp(before, rows, texels * sizeof *rows) == 0;
    bool done = same || upload_rows(rendering, rows, texels * sizeof *rows);
    gpu_release(gpu, done ? before : rows);
    if (done)
        rendering->frame_rows = rows;
    return done;
}

bool scene_tables_upload(KrsRendering *rendering, const KrsFrame *frame)
{
    if (rendering->program->table_cells == 0)
        return true;
    if (!rendering->has_tables && !upload_all(rendering, frame))
        return false;
    return !rendering->program->rows_vary || renew_rows(rendering, frame);
}
