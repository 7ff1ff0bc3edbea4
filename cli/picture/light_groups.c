/*
 * light_groups.c: the light of each light, and the rest, as channels of a picture.
 */
#include "cli/picture/light_groups.h"

#include <stdlib.h>
#include <string.h>

typedef struct Groups {
    size_t  pixels, count; /* of groups: each has three numbers a pixel */
    size_t *of_light;      /* for each light: its group */
    size_t *light;         /* for each group but the last: its first light */
    float  *values;
} Groups;

/* Returns the group of a light.  Lights of one name, as of a loop, are one group. */
static size_t group_of(const KrsScene *scene, const Groups *g, size_t light)
{
    const char *name = krs_light_name(scene, light);
    for (size_t n = 0; name && n < g->count; n++) {
        const char *other = krs_light_name(scene, g->light[n]);
        if (other && strcmp(name, other) == 0)
            return n;
    }
    return g->count;
}

static void group_lights(Arena *arena, const KrsScene *scene, size_t lights, Groups *g)
{
    g->of_light = arena_new_array(arena, size_t, lights + 1);
    g->light    = arena_new_array(arena, size_t, lights + 1);
    for (size_t n = 0; n < lights; n++) {
        g->of_light[n] = group_of(scene, g, n);
        if (g->of_light[n] == g->count)
            g->light[g->count++] = n;
    }
    g->count++; /* the rest */
}

/* The last group is what the others leave of the whole. */
static void find_groups(const Groups *g, const KrsPicture *picture)
{
    const size_t lights = picture->light_count;
    for (size_t k = 0; k < g->pixels; k++)
        for (size_t i = 0; i < 3; i++) {
            float *numbers = g->values + 3 * g->count * k;
            float  rest    = picture->color[4 * k + i];
            for (size_t n = 0; n < lights; n++) {
                const float light = picture->lights[lights * k + n][i];
                numbers[3 * g->of_light[n] + i] += light;
                rest -= light;
            }
            numbers[3 * (g->count - 1) + i] = rest;
        }
}

static void name_channels(Arena *arena, const KrsScene *scene, const Groups *g, LightGroups *groups)
{
    groups->channel_count = 3 * g->count;
    groups->channels      = arena_new_array(arena, PictureChannel, groups->channel_count);
    for (size_t c = 0; c < groups->channel_count; c++) {
        const size_t n     = c / 3;
        const bool   rest  = n + 1 == g->count;
        const char  *light = rest ? NULL : krs_light_name(scene, g->light[n]);
        Text         name  = {.arena = arena};
        if (rest)
            text_add(&name, "rest");
        else if (light)
            text_format(&name, "light.%s", light);
        else
            text_format(&name, "light.%zu", g->light[n] + 1);
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
    Groups g = {.pixels = (size_t)picture->window.width * picture->window.height};
    *groups  = (LightGroups){0};
    group_lights(arena, scene, picture->light_count, &g);
    g.values = calloc(3 * g.count * g.pixels, sizeof(float));
    if (!g.values)
        return KRS_OUT_OF_MEMORY;
    find_groups(&g, picture);
    name_channels(arena, scene, &g, groups);
    groups->values = g.values;
    return KRS_OK;
}
