/*
 * light_groups.c: pictures of each light by itself.
 *
 * Light adds up, so the picture of one light, less what shines without any, is that light's part.
 * All have the same rays, so this is exact for each pixel, with its noise.  What is left of the whole
 * is the rest.
 */
#include "cli/light_groups.h"

#include <stdlib.h>

typedef struct Groups {
    KrsRendering           *rendering;
    KrsFrame               *frame;
    const KrsRenderOptions *how;
    size_t                  pixels, count; /* of groups: each has three numbers a pixel */
    float                  *values;
} Groups;

/* Renders the light of one number of KrsRenderOptions.light. */
static KrsStatus render_light(const Groups *g, uint32_t light, KrsPicture **picture)
{
    KrsRenderOptions how = *g->how;
    how.planes           = KRS_PLANE_COLOR;
    how.mattes           = false;
    how.light            = light;
    return krs_render(g->rendering, g->frame, &how, picture);
}

static void subtract(const Groups *g, const KrsPicture *from, const KrsPicture *dark, size_t group)
{
    float *to = g->values + 3 * group;
    for (size_t k = 0; k < g->pixels; k++, to += 3 * g->count)
        for (int i = 0; i < 3; i++)
            to[i] = from->color[4 * k + i] - dark->color[4 * k + i];
}

/* The last group is what the others leave of the whole. */
static void find_rest(const Groups *g, const KrsPicture *whole)
{
    for (size_t k = 0; k < g->pixels; k++)
        for (size_t i = 0; i < 3; i++) {
            float *numbers = g->values + 3 * g->count * k;
            float  rest    = whole->color[4 * k + i];
            for (size_t n = 0; n + 1 < g->count; n++)
                rest -= numbers[3 * n + i];
            numbers[3 * (g->count - 1) + i] = rest;
        }
}

static KrsStatus find_groups(const Groups *g, const KrsPicture *whole)
{
    KrsPicture *dark   = NULL;
    KrsStatus   status = render_light(g, KRS_NO_LIGHT, &dark);
    for (uint32_t n = 0; n + 1 < g->count && status == KRS_OK; n++) {
        KrsPicture *picture = NULL;
        status              = render_light(g, n + 1, &picture);
        if (status == KRS_OK)
            subtract(g, picture, dark, n);
        krs_picture_free(picture);
    }
    krs_picture_free(dark);
    if (status == KRS_OK)
        find_rest(g, whole);
    return status;
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

KrsStatus light_groups_render(Arena *arena, KrsRendering *rendering, KrsFrame *frame,
                              const KrsScene *scene, const KrsRenderOptions *how,
                              const KrsPicture *picture, LightGroups *groups)
{
    Groups g = {.rendering = rendering,
                .frame     = frame,
                .how       = how,
                .pixels    = (size_t)picture->window.width * picture->window.height,
                .count     = krs_light_count(scene) + 1};
    *groups  = (LightGroups){0};
    g.values = malloc(3 * g.count * g.pixels * sizeof(float));
    if (!g.values)
        return KRS_OUT_OF_MEMORY;
    KrsStatus status = find_groups(&g, picture);
    if (status != KRS_OK) {
        free(g.values);
        return status;
    }
    name_channels(arena, scene, &g, groups);
    groups->values = g.values;
    return KRS_OK;
}
