/*
 * bake.c: a scene as samples in a texture of three dimensions, for what a target cannot have as a text.
 */
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "compiler/base/half.h"
#include "export/parts.h"

typedef uint16_t Texel[4]; /* colour and distance, of half precision */

struct Baked {
    KrsGridShape shape;
    Texel       *texels; /* x first */
};

size_t exported_parameters(const Export *export)
{
    return export->baked ? 0 : krs_parameter_count(export->scene);
}

size_t exported_slots(const Export *export)
{
    return export->baked ? 1 : krs_parameter_slots(export->scene);
}

/* Copies what a brick has of the box. */
static bool take_brick(void *user, const KrsGridBrick *brick)
{
    const Baked  *baked = user;
    const size_t *count = baked->shape.count;
    for (size_t i = 0; i < KRS_BRICK_SAMPLES; i++) {
        const size_t x = brick->at[0] + i % KRS_BRICK_SIDE,
                     y = brick->at[1] + i / KRS_BRICK_SIDE % KRS_BRICK_SIDE,
                     z = brick->at[2] + i / (KRS_BRICK_SIDE * KRS_BRICK_SIDE);
        if (x >= count[0] || y >= count[1] || z >= count[2])
            continue;
        uint16_t *texel = baked->texels[(z * count[1] + y) * count[0] + x];
        for (int k = 0; k < 3; k++)
            texel[k] = half_from_float(brick->colors[i][k]);
        texel[3] = half_from_float(brick->values[i]);
    }
    return true;
}

/* Finds the box that is sampled, and how far samples are apart; false: it has no end. */
static bool find_sampling(const Export *export, const ExportOptions *options,
                          KrsGridOptions *sampling)
{
    double       longest = 0;
    KrsComponent part;
    memcpy(part.low, export->scene->program.low, sizeof part.low);
    memcpy(part.high, export->scene->program.high, sizeof part.high);
    if (options->component > 0)
        krs_component(export->scene, options->component - 1, &part);
    sampling->component = options->component;
    sampling->materials = true;
    sampling->within    = options->within;
    for (int k = 0; k < 3; k++) {
        sampling->low[k]  = options->low[k];
        sampling->high[k] = options->high[k];
        const double from = options->within ? fmax(part.low[k], options->low[k]) : part.low[k];
        const double to   = options->within ? fmin(part.high[k], options->high[k]) : part.high[k];
        longest           = fmax(longest, to - from);
    }
    sampling->cell = longest / options->bake;
    return longest < 1e9 && longest > 0;
}

KrsStatus bake_scene(Export *export, const ExportOptions *options, Arena *arena, Text *why)
{
    KrsGridOptions sampling = {0};
    KrsGrid       *grid     = NULL;
    Baked         *baked    = arena_new(arena, Baked);
    KrsStatus      status   = KRS_BAD_ARGUMENT;
    if (!find_sampling(export, options, &sampling))
        text_add(why, "it has no end, so it cannot be sampled; --component NAME chooses a part, "
                      "--within X,Y,Z,X,Y,Z a box, and --studio off leaves its floor out");
    else
        status = krs_grid_new(export->state, &sampling, &grid);
    if (status == KRS_OK) {
        baked->shape        = krs_grid_shape(grid);
        const size_t *count = baked->shape.count;
        baked->texels       = arena_alloc(arena, count[0] * count[1] * count[2], sizeof(Texel));
        status              = krs_grid_visit(grid, take_brick, baked);
        export->baked       = baked;
    }
    krs_grid_free(grid);
    if (status == KRS_OK && baked->shape.count[0] == 0)
        status = KRS_BAD_ARGUMENT;
    if (status == KRS_BAD_ARGUMENT && why->length == 0)
        text_add(why, "there is nothing solid in it to be sampled");
    return status;
}

const unsigned char *baked_bytes(const Export *export, size_t *length)
{
    const size_t *count = export->baked->shape.count;
    *length             = count[0] * count[1] * count[2] * sizeof(Texel);
    return (const unsigned char *)export->baked->texels;
}

/* ---- a file ---- */

static void add_int(Text *to, uint32_t number)
{
    const char bytes[] = {(char)number, (char)(number >> 8), (char)(number >> 16),
                          (char)(number >> 24)};
    text_add_bytes(to, bytes, sizeof bytes);
}

/* A DirectDraw surface of R16G16B16A16_FLOAT, in numbers of Microsoft's programming guide for DDS. */
void add_baked_file(Text *to, const Export *export)
{
    /* Caps, height, width, pitch, format and depth are given. */
    enum { FLAGS = 0x80100f, COMPLEX_TEXTURE = 0x1008, VOLUME = 0x200000, FLOAT16 = 10, IN_3D = 4 };
    const size_t *count = export->baked->shape.count;
    size_t        length;
    text_add_bytes(to, "DDS ", 4);
    const uint32_t first[] = {124,
                              FLAGS,
                              (uint32_t)count[1],
                              (uint32_t)count[0],
                              (uint32_t)(count[0] * sizeof(Texel)),
                              (uint32_t)count[2],
                              1};
    for (size_t i = 0; i < sizeof first / sizeof *first; i++)
        add_int(to, first[i]);
    for (int i = 0; i < 11; i++)
        add_int(to, 0);
    add_int(to, 32); /* the format of a pixel: that which stands behind */
    add_int(to, 4);
    text_add_bytes(to, "DX10", 4);
    for (int i = 0; i < 5; i++)
        add_int(to, 0);
    const uint32_t last[] = {COMPLEX_TEXTURE, VOLUME, 0, 0, 0, FLOAT16, IN_3D, 0, 1, 0};
    for (size_t i = 0; i < sizeof last / sizeof *last; i++)
        add_int(to, last[i]);
    const unsigned char *bytes = baked_bytes(export, &length);
    text_add_bytes(to, (const char *)bytes, length);
}

/* ---- pieces ---- */

void find_baked_box(const Export *export, double low[3], double high[3])
{
    const KrsGridShape *shape = &export->baked->shape;
    for (int k = 0; k < 3; k++) {
        low[k]  = (double)shape->first[k] * shape->cell;
        high[k] = low[k] + (double)(shape->count[k] - 1) * shape->cell;
    }
}

/* Adds where texture coordinates are 0. */
void add_baked_low(Text *to, const Export *export)
{
    const KrsGridShape *shape = &export->baked->shape;
    double              low[3];
    for (int k = 0; k < 3; k++)
        low[k] = ((double)shape->first[k] - 0.5) * shape->cell;
    add_vector(to, export, low, 3);
}

void add_baked_size(Text *to, const Export *export)
{
    const KrsGridShape *shape = &export->baked->shape;
    double              size[3];
    for (int k = 0; k < 3; k++)
        size[k] = (double)shape->count[k] * shape->cell;
    add_vector(to, export, size, 3);
}

void add_baked_cell(Text *to, const Export *export) { add_float(to, export->baked->shape.cell); }

/* Adds how many texels there are, with commas between. */
void add_baked_count(Text *to, const Export *export)
{
    const size_t *count = export->baked->shape.count;
    text_format(to, "%zu, %zu, %zu", count[0], count[1], count[2]);
}

void add_baked_sampler(Text *to, const Export *export)
{
    static const char *const samplers[] = {
        [EXPORT_IN_SHORT_ESSL]  = "uniform highp sampler3D krs_baked;\n",
        [EXPORT_IN_HLSL_PART]   = "layout(set = 0, binding = 1) uniform sampler3D krs_baked;\n",
        [EXPORT_IN_HLSL_STRUCT] = "layout(set = 0, binding = 1) uniform sampler3D krs_baked;\n",
        [EXPORT_IN_GDSHADER]    = "uniform sampler3D krs_baked : filter_linear, repeat_disable;\n"};
    text_add(to, samplers[export->target->language]);
}

/* Adds the least half of the difference that normals are found by, which samples blur. */
void add_normal_reach(Text *to, const Export *export)
{
    text_add(to, export->baked ? "max(reach, " : "reach");
    if (export->baked) {
        add_float(to, export->baked->shape.cell);
        text_add(to, ")");
    }
}
