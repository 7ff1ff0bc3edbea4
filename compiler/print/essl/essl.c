/*
 * essl.c: ESSL 3.00.  Where it has no buffers, it reads textures, whose rows have 4,096 texels.
 */
#include <assert.h>

#include "compiler/print/printer.h"
#include "krs/krs.h"

static_assert(KRS_TEXTURE_WIDTH == 1 << 12, "as texels are found below");

#define CELLS                                 \
    "uniform highp usampler2D krs_cells;\n\n" \
    "uvec2 krs_cell_texel(uint i)\n{\n"       \
    "    return texelFetch(krs_cells, ivec2(int(i & 4095u), int(i >> 12)), 0).xy;\n}\n\n"
#define ROWS                                \
    "uniform highp sampler2D krs_rows;\n\n" \
    "vec4 krs_row_texel(uint i)\n{\n"       \
    "    return texelFetch(krs_rows, ivec2(int(i & 4095u), int(i >> 12)), 0);\n}\n\n"

static const char *const templates[TEMPLATE_COUNT] = {
    [TEMPLATE_ITERATIONS] = "    uint $a = 0u;\n    do {\n",
    [TEMPLATE_PARAMETER_BLOCK] =
        "layout(std140) uniform KrsParameters { vec4 krs_parameter[$a]; };\n\n",
    [TEMPLATE_TEXEL_CELLS]   = CELLS,
    [TEMPLATE_BUFFER_CELLS]  = CELLS,
    [TEMPLATE_TEXEL_TABLES]  = ROWS  CELLS,
    [TEMPLATE_BUFFER_TABLES] = ROWS CELLS,
};

const Printer essl_printer = {
    .name      = "ESSL",
    .base      = &glsl_printer,
    .helpers   = essl_files,
    .templates = templates,
    .macros    = true,
};
