/*
 * slots.c: the size of the parameter block.
 */
#include "runtime/tracer/slots.h"

/* Returns all slots but those of values that the host computes and shaders can compute by
   themselves. */
static uint32_t slots_without_values(const KrsProgram *program)
{
    return program->parameter_slots + KRS_MAX_ZONES + 1;
}

static uint32_t max_slots(const KrsRendering *rendering)
{
    return rendering->renderer->gpu.limits.uniform_bytes / (4 * sizeof(float));
}

bool rendering_rebases(const KrsRendering *rendering)
{
    const KrsProgram *program = rendering->program;
    return program->camera_relative &&
           slots_without_values(program) + program->value_slots + program->camera_relative_slots <=
               max_slots(rendering);
}

uint32_t rendering_value_slots(const KrsRendering *rendering)
{
    const KrsProgram *program = rendering->program;
    uint32_t          slots   = slots_without_values(program) + program->value_slots;
    return slots <= max_slots(rendering) ? program->value_slots : 0;
}

uint32_t rendering_slots(const KrsRendering *rendering)
{
    const KrsProgram *program = rendering->program;
    uint32_t          slots   = slots_without_values(program) + rendering_value_slots(rendering);
    slots += rendering_rebases(rendering) ? program->camera_relative_slots : 0;
    if (slots <= max_slots(rendering))
        return slots;
    gpu_refuse(&rendering->renderer->gpu, KRS_NO_DEVICE,
               "the device has no room for the scene's %u parameters",
               rendering->program->parameter_slots);
    return 0;
}
