/*
 * commands.c: recording a piece of work, running it and timing it.  One piece runs at a time:
 * slices are long against what a submission costs, and the host must look at each anyway.
 */
#include <unistd.h>

#include "compiler/base/minmax.h"
#include "compiler/base/watchdog.h"
#include "runtime/device/buffer.h"
#include "runtime/device/driver.h"

static const VkPipelineStageFlags WORK = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT |
                                         VK_PIPELINE_STAGE_TRANSFER_BIT;

static void memory_barrier(VkCommandBuffer commands, VkPipelineStageFlags after,
                           VkAccessFlags seen_by)
{
    vkCmdPipelineBarrier(
        commands, WORK, after, 0, 1,
        &(VkMemoryBarrier){
            .sType         = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
            .srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT,
            .dstAccessMask = seen_by,
        },
        0, NULL, 0, NULL);
}

/* Lets what was written be used, and written again. */
static void barrier(VkCommandBuffer commands)
{
    memory_barrier(commands, WORK | VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT,
                   VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT |
                       VK_ACCESS_UNIFORM_READ_BIT | VK_ACCESS_TRANSFER_READ_BIT |
                       VK_ACCESS_TRANSFER_WRITE_BIT | VK_ACCESS_INDIRECT_COMMAND_READ_BIT);
}

void gpu_barrier(Gpu *gpu) { barrier(gpu->driver->commands); }

/* After this nothing of the device runs, and nothing is submitted to it: a fence may have been left as it was. */
static void give_up(Gpu *gpu)
{
    gpu->lost = true;
    vkDeviceWaitIdle(gpu->driver->device);
}

/* Tells whether work can be submitted; false with the failure noted. */
static bool takes_work(Gpu *gpu)
{
    if (gpu->lost && gpu->status == KRS_OK)
        gpu_fail(gpu, VK_ERROR_DEVICE_LOST, "submit work");
    return !gpu->stuck && !gpu->lost; /* why it is stuck has been said */
}

bool gpu_begin(Gpu *gpu)
{
    if (!takes_work(gpu))
        return false;
    TRY(gpu, "record work", vkResetCommandPool(gpu->driver->device, gpu->driver->pool, 0));
    TRY(gpu, "record work",
        vkBeginCommandBuffer(gpu->driver->commands,
                             &(VkCommandBufferBeginInfo){
                                 .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                 .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT,
                             }));
    gpu->marks = 0;
    if (gpu->driver->times) {
        vkCmdResetQueryPool(gpu->driver->commands, gpu->driver->times, 0, 2 + MAX_MARKS);
        vkCmdWriteTimestamp(gpu->driver->commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT,
                            gpu->driver->times, 0);
    }
    gpu_barrier(gpu);
    return true;

failed:
    give_up(gpu);
    return false;
}

/* Writes the timestamps: the first, the marks in their order, and after these the last. */
void gpu_mark(Gpu *gpu)
{
    gpu->marks++;
    if (gpu->driver->times)
        vkCmdWriteTimestamp(gpu->driver->commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT,
                            gpu->driver->times, gpu->marks);
}

static bool read_clock(Gpu *gpu, uint32_t query, uint64_t *ticks)
{
    TRY(gpu, "read the device's clock",
        vkGetQueryPoolResults(gpu->driver->device, gpu->driver->times, query, 1, sizeof *ticks,
                              ticks, sizeof *ticks,
                              VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT));
    return true;

failed:
    give_up(gpu);
    return false;
}

/* Adds the time from one timestamp to another. */
static bool measure(Gpu *gpu, uint32_t from, uint32_t to, double *ms)
{
    uint64_t start, end;
    if (!read_clock(gpu, from, &start) || !read_clock(gpu, to, &end))
        return false;
    uint64_t passed = (end - start) & gpu->driver->time_mask;
    *ms += (double)passed * (double)gpu->driver->properties.limits.timestampPeriod / 1e6;
    return true;
}

bool gpu_marked(Gpu *gpu, uint32_t mark, double *ms)
{
    *ms = 0;
    return !gpu->driver->times || measure(gpu, mark, mark + 1, ms);
}

void gpu_copy(Gpu *gpu, const Buffer *from, uint64_t from_at, const Buffer *to, uint64_t to_at,
              uint64_t bytes)
{
    vkCmdCopyBuffer(gpu->driver->commands, FROM_HANDLE(VkBuffer, from->buffer),
                    FROM_HANDLE(VkBuffer, to->buffer), 1, &(VkBufferCopy){from_at, to_at, bytes});
}

void gpu_fill(Gpu *gpu, const Buffer *buffer, uint64_t at, uint64_t bytes, uint32_t word)
{
    vkCmdFillBuffer(gpu->driver->commands, FROM_HANDLE(VkBuffer, buffer->buffer), at, bytes, word);
}

void gpu_write(Gpu *gpu, const Buffer *buffer, uint64_t at, const void *bytes, uint32_t length)
{
    vkCmdUpdateBuffer(gpu->driver->commands, FROM_HANDLE(VkBuffer, buffer->buffer), at, length,
                      bytes);
}

static void bind(VkCommandBuffer commands, const Run *run)
{
    const VkPipelineLayout layout  = FROM_HANDLE(VkPipelineLayout, run->layout);
    const VkDescriptorSet  sets[2] = {FROM_HANDLE(VkDescriptorSet, run->sets[0]),
                                      FROM_HANDLE(VkDescriptorSet, run->sets[1])};
    const uint32_t         first   = run->sets[0] == 0;
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE,
                      FROM_HANDLE(VkPipeline, run->pipeline));
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout, first, 2 - first,
                            sets + first, 1, &run->work_at);
}

void gpu_dispatch(Gpu *gpu, const Run *run, uint32_t groups)
{
    bind(gpu->driver->commands, run);
    vkCmdDispatch(gpu->driver->commands, groups, 1, 1);
}

void gpu_dispatch_counted(Gpu *gpu, const Run *run, const Buffer *counts, uint64_t at)
{
    bind(gpu->driver->commands, run);
    vkCmdDispatchIndirect(gpu->driver->commands, FROM_HANDLE(VkBuffer, counts->buffer), at);
}

static VkResult wait_for(Gpu *gpu, double seconds)
{
    return vkWaitForFences(gpu->driver->device, 1, &gpu->driver->fence, VK_TRUE,
                           (uint64_t)(seconds * 1e9));
}

/* Waits for a device.  Most steps take no longer than the first slice; what the process does during
   more of them decides how much of the time counts, since drivers for CPUs work in its threads. */
static VkResult wait_with_timeout(Gpu *gpu)
{
    const double slice    = min2(gpu->timeout, WATCHDOG_LONGEST_GAP);
    Watchdog     watchdog = {.fruitless = slice};
    VkResult     result   = wait_for(gpu, slice);
    while (result == VK_TIMEOUT && watchdog.fruitless < gpu->timeout) {
        ProcessSample sample = {0};
        watchdog_sample(getpid(), &watchdog.last, &sample);
        watchdog_add(&watchdog, &sample);
        result = wait_for(gpu, slice);
    }
    return result;
}

/* A device that never answers leaves a message, and nothing that could be freed. */
static bool wait_for_fence(Gpu *gpu)
{
    const char *attempt = "wait for the device";
    VkResult    result  = wait_with_timeout(gpu);
    if (result == VK_TIMEOUT) {
        gpu->stuck = true;
        gpu_refuse(gpu, KRS_INTERNAL, "the device has not finished a step within %g seconds",
                   gpu->timeout);
        return false;
    }
    TRY(gpu, attempt, result);
    TRY(gpu, attempt, vkResetFences(gpu->driver->device, 1, &gpu->driver->fence));
    return true;

failed:
    give_up(gpu);
    return false;
}

bool gpu_finish(Gpu *gpu, double *ms)
{
    if (gpu->driver->times)
        vkCmdWriteTimestamp(gpu->driver->commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT,
                            gpu->driver->times, 1 + gpu->marks);
    memory_barrier(gpu->driver->commands, VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
    TRY(gpu, "record work", vkEndCommandBuffer(gpu->driver->commands));

    double start = clock_ms();
    gpu->submissions++;
    TRY(gpu, "submit work",
        vkQueueSubmit(gpu->driver->queue, 1,
                      &(VkSubmitInfo){
                          .sType              = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                          .commandBufferCount = 1,
                          .pCommandBuffers    = &gpu->driver->commands,
                      },
                      gpu->driver->fence));
    if (!wait_for_fence(gpu))
        return false;
    if (gpu->driver->times)
        return measure(gpu, 0, 1 + gpu->marks, ms);
    *ms += clock_ms() - start;
    return true;

failed:
    give_up(gpu);
    return false;
}

/* Records one of the two timestamps of prewarming, unless all are used. */
static void time_prewarm(const Gpu *gpu, VkCommandBuffer commands, bool end)
{
    const uint32_t first = 2 * gpu->prewarms;
    if (!gpu->driver->prewarm_times || gpu->prewarms >= MAX_TIMED_PREWARMS)
        return;
    if (!end)
        vkCmdResetQueryPool(commands, gpu->driver->prewarm_times, first, 2);
    vkCmdWriteTimestamp(
        commands, end ? VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT : VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT,
        gpu->driver->prewarm_times, first + end);
}

double gpu_prewarm_ms(const Gpu *gpu, uint32_t number)
{
    uint64_t ticks[2];
    if (!gpu->driver->prewarm_times || number >= gpu->prewarms || number >= MAX_TIMED_PREWARMS ||
        vkGetQueryPoolResults(gpu->driver->device, gpu->driver->prewarm_times, 2 * number, 2,
                              sizeof ticks, ticks, sizeof *ticks,
                              VK_QUERY_RESULT_64_BIT) != VK_SUCCESS)
        return 0;
    const uint64_t passed = (ticks[1] - ticks[0]) & gpu->driver->time_mask;
    return (double)passed * (double)gpu->driver->properties.limits.timestampPeriod / 1e6;
}

bool gpu_prewarm(Gpu *gpu, const Run *run, uint32_t *number)
{
    const char     *attempt = "try a shader out";
    VkCommandBuffer commands; /* the pool's, until it is destroyed */
    TRY(gpu, attempt,
        vkAllocateCommandBuffers(gpu->driver->device,
                                 &(VkCommandBufferAllocateInfo){
                                     .sType       = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                     .commandPool = gpu->driver->prewarm_pool,
                                     .level       = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                     .commandBufferCount = 1,
                                 },
                                 &commands));
    TRY(gpu, attempt,
        vkBeginCommandBuffer(commands, &(VkCommandBufferBeginInfo){
                                           .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                           .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT,
                                       }));
    barrier(commands); /* all shaders are prewarmed with the same buffers */
    time_prewarm(gpu, commands, false);
    bind(commands, run);
    vkCmdDispatch(commands, 1, 1, 1);
    time_prewarm(gpu, commands, true);
    *number = gpu->prewarms++;
    TRY(gpu, attempt, vkEndCommandBuffer(commands));
    TRY(gpu, attempt,
        vkQueueSubmit(gpu->driver->queue, 1,
                      &(VkSubmitInfo){
                          .sType              = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                          .commandBufferCount = 1,
                          .pCommandBuffers    = &commands,
                      },
                      VK_NULL_HANDLE));
    return true;

failed:
    give_up(gpu);
    return false;
}

bool gpu_wait(Gpu *gpu)
{
    if (!takes_work(gpu)) {
        if (!gpu->stuck && gpu_is_open(gpu))
            give_up(gpu);
        return false;
    }
    TRY(gpu, "wait for the device", vkQueueSubmit(gpu->driver->queue, 0, NULL, gpu->driver->fence));
    return wait_for_fence(gpu);

failed:
    give_up(gpu);
    return false;
}
