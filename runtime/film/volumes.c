/*
 * volumes.c: media that scatter light: boxes of cells, with bounds of densities.
 */
#include "runtime/film/volumes.h"

#include <string.h>

#include "runtime/tracer/rendering.h"

bool volumes_are_met(const Job *job)
{
    return job->rendering->program->volumes > 0 &&
           job->options.integrator != KRS_INTEGRATOR_PREVIEW;
}

static size_t rows_of_cells(const KrsVolume *volume)
{
    return ((size_t)volume->cells[0] * volume->cells[1] * volume->cells[2] + 1) / 2;
}

static size_t count_rows(const KrsRendering *rendering)
{
    const size_t count = rendering->program->volumes;
    size_t       rows  = count * VOLUME_ROWS;
    for (size_t i = 0; i < count; i++) {
        const KrsVolume volume = krs_scene_volume(rendering->scene, i);
        rows += rows_of_cells(&volume);
    }
    return rows;
}

static VolumeBlock block_of(const KrsVolume *volume, size_t first)
{
    VolumeBlock block = {.before = volume->before, .first = (uint32_t)first};
    for (int k = 0; k < 3; k++) {
        block.low[k]   = (float)volume->low[k];
        block.cell[k]  = (float)((volume->high[k] - volume->low[k]) / volume->cells[k]);
        block.cells[k] = volume->cells[k];
    }
    return block;
}

static bool fill(Job *job, uint32_t (*rows)[4])
{
    const KrsRendering *r     = job->rendering;
    size_t              first = r->program->volumes * VOLUME_ROWS;
    for (size_t i = 0; i < r->program->volumes; i++) {
        const KrsVolume   volume = krs_scene_volume(r->scene, i);
        const VolumeBlock block  = block_of(&volume, first);
        const KrsStatus   status = krs_state_volume(job->state, i, (float(*)[2])rows[first]);
        if (status == KRS_BAD_SCENE)
            gpu_refuse(job->gpu, status, "the density of medium %zu has no bound in this frame",
                       i + 1);
        else if (status != KRS_OK)
            gpu_refuse(job->gpu, status, "no memory is left for bounds of media");
        if (status != KRS_OK)
            return false;
        memcpy(rows[i * VOLUME_ROWS], &block, sizeof block);
        first += rows_of_cells(&volume);
    }
    return true;
}

static void forget(KrsRendering *rendering)
{
    gpu_release(&rendering->renderer->gpu, rendering->volume_rows);
    rendering->volume_rows  = NULL;
    rendering->volume_count = 0;
}

bool volumes_find(Job *job)
{
    KrsRendering  *r     = job->rendering;
    const uint64_t stamp = krs_state_stamp(job->state);
    if (!volumes_are_met(job) || (r->volume_rows && r->volume_stamp == stamp))
        return true;
    forget(r);
    const size_t rows = count_rows(r);
    r->volume_rows    = gpu_alloc(job->gpu, rows, sizeof *r->volume_rows, "find bounds of media");
    if (!r->volume_rows || !fill(job, r->volume_rows)) {
        forget(r);
        return false;
    }
    r->volume_count = rows;
    r->volume_stamp = stamp;
    return true;
}

size_t volumes_rows(const Job *job)
{
    return volumes_are_met(job) ? job->rendering->volume_count : 0;
}

void volumes_copy(const Job *job, uint32_t (*rows)[4])
{
    memcpy(rows, job->rendering->volume_rows, volumes_rows(job) * sizeof *rows);
}
