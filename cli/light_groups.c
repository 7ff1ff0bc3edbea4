/*
 * light_groups.c: the light of each light, and the rest, as channels of a picture.
 */
#include "cli/light_groups.h"

#include <stdlib.h>

typedef struct Groups {
    size_t pixels, count; /* of groups: each has three numbers a pixel */
    float *values;
} Groups;

/* The last group is what the others leave of the whole. */
static void find_groups(const Groups *g, const KrsPicture *picture)
{
    const size_t lights = picture->light_count;
    for (size_t k = 0; k < g->pixels; k++)
        for (size_t i = 0; i < 3; i++) {
            float *numbers = g->values + 3 * g->count * k;
            float  rest    = picture->color[4 * k + i];
            for (size_t n = 0; n < lights; n++) {
                numbers[3 * n + i] = picture->lights[lights * k + n][i];
                rest -= numbers[3 * n + i];
            }
            numbers[3 * lights + i] = rest;
        }
}

static void name_channels(Arena *arena, const KrsScene *scene, const Groups *g, LightGroups *groups)
{
    groups->channel_count = 3 * g->count;
    groups->channels      = arena_new_array(arena, PictureChannel, groups->channel_count);
    for (size_t c = 0; c < groups->channel_count; c++) {
        const size_t n     = c / 3;
        const char  *light = krs_light_name(scene, n);
        Text         name  = {.arena = arena};
        if (n + 1 == g->count)
            text_add(&name, "rest");
        else if (light)
            text_format(&name, "light.%s", light);
        else
            text_format(&name, "light.%zu", n + 1);
        text_format(&name, ".%c", "RGB"[c % 3]);
        groups->channels[c] = (PictureChannel){.name    = name.bytes,
                                               .type    = SAMPLE_HALF,
                                               .samples = g->values + c,
                                               .stride  = groups->channel_count};
    }
}

KrsStatus light_groups_make(Arena *arena, const KrsScene *scene, const KrsPicture *picture,
                            LightGroups *groups)
{
    Groups g = {.pixels = (size_t)picture->window.width * picture->window.height,
                .count  = (size_t)picture->light_count + 1};
    *groups  = (LightGroups){0};
    g.values = malloc(3 * g.count * g.pixels * sizeof(float));
    if (!g.values)
        return KRS_OUT_OF_MEMORY;
    find_groups(&g, picture);
    name_channels(arena, scene, &g, groups);
    groups->values = g.values;
    return KRS_OK;
}
