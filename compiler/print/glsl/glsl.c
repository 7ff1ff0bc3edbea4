/*
 * glsl.c: GLSL 4.4, with std140 blocks as Vulkan has them.
 */
#include "compiler/base/far.h"
#include "compiler/print/printer.h"

static const char *const types[] = {
    [TYPE_FLOAT] = "float", [TYPE_VEC2] = "vec2", [TYPE_VEC3] = "vec3",
    [TYPE_VEC4] = "vec4",   [TYPE_BOOL] = "bool", [TYPE_UINT] = "uint",
};

/* A mix is no branch, and minds nothing that is not a number. */
static const Alternative alternatives[] = {
    {"KRS_MIN", "min($a, $b)", "mix($a, $b, ($b) < ($a))"},
    {"KRS_MAX", "max($a, $b)", "mix($a, $b, ($a) < ($b))"},
    {"KRS_BACK", "$b", "$a"}, /* mirrors.c */
    {NULL, NULL, NULL},
};

/* A choice between numbers is a mix, too; it knows no others. */
static const char *operation(Op op, GraphType type)
{
    static const char *const choices[] = {
        [TYPE_FLOAT] = "mix($c, $b, $A)",
        [TYPE_VEC2]  = "mix($c, $b, bvec2($A))",
        [TYPE_VEC3]  = "mix($c, $b, bvec3($A))",
        [TYPE_VEC4]  = "mix($c, $b, bvec4($A))",
    };
    return op == OP_select && type <= TYPE_VEC4 ? choices[type] : op_glsl(op);
}

static const char *const templates[TEMPLATE_COUNT] = {
    [TEMPLATE_FUNCTION]        = "$a $b($c)",
    [TEMPLATE_PROCEDURE]       = "void $a($b)",
    [TEMPLATE_PARAMETER]       = "$a $b",
    [TEMPLATE_PARAMETER_OUT]   = "out $a $b",
    [TEMPLATE_PARAMETER_INOUT] = "inout $a $b",
    [TEMPLATE_CHANGED]         = "$a",
    [TEMPLATE_ARGUMENT_OUT]    = "$a",
    [TEMPLATE_PROTOTYPE]       = "$a$b;\n\n",

    [TEMPLATE_LOCAL]         = "    $a $b = $c;\n",
    [TEMPLATE_VARIABLE]      = "    $a $b = $c;\n",
    [TEMPLATE_LOCAL_UNSET]   = "    $a $b;\n",
    [TEMPLATE_GLOBAL]        = "$a $b;\n",
    [TEMPLATE_CONSTANT_UINT] = "const uint $a = $bu;\n\n",
    [TEMPLATE_MEMBER]        = "    $a$c $b;\n",

    [TEMPLATE_RETURN_IF]      = "    if ($a)\n        return $b;\n",
    [TEMPLATE_SET_IF]         = "    if ($a)\n        $b = $c;\n",
    [TEMPLATE_CHOICE]         = "$a ? $b : $c",
    [TEMPLATE_SWITCH]         = "    switch ($a) {\n",
    [TEMPLATE_CASE]           = "    case $au:\n",
    [TEMPLATE_CASE_END]       = "        break;\n",
    [TEMPLATE_SWITCH_END]     = "    }\n",
    [TEMPLATE_ITERATIONS]     = "    uint $a = 0u;\n    [[dont_unroll]] do {\n",
    [TEMPLATE_ITERATIONS_END] = "    } while (++$a < $bu);\n",

    [TEMPLATE_BITS] = "floatBitsToUint($a)",

    [TEMPLATE_PARAMETER_BLOCK] = "layout(std140, set = 0, binding = 0) uniform KrsParameters "
                                 "{ vec4 krs_parameter[$a]; };\n\n",
    [TEMPLATE_ZONES]           = "vec4 krs_zones[$a];\n\n",
    [TEMPLATE_READ_ZONES]      = "    for (int i = 0; i < $a; i++)\n"
                                 "        krs_zones[i] = krs_parameter[$b + i];\n",
    [TEMPLATE_CUT]             = "float krs_cut(vec3 p, float d)\n{\n",
    [TEMPLATE_CUT_ZONES]       = "    for (int i = 0; i < $a; i++)\n"
                                 "        d = max(d, krs_zones[i].w - length(p - krs_zones[i].xyz));\n",
    /* length(c) - length(c - p), without a difference of large numbers. */
    [TEMPLATE_CUT_NEAR_ZONES] =
        "    for (int i = 0; i < $a; i++) {\n"
        "        vec3 c = krs_zones[i].xyz;\n"
        "        float lengths = length(c) + length(c - p);\n"
        "        d = max(d, krs_zones[i].w + dot(c + (c - p), p) / max(lengths, 1e-30));\n"
        "    }\n",

    [TEMPLATE_TEXEL_CELLS] =
        "layout(set = 0, binding = 2) uniform usamplerBuffer krs_cells;\n\n"
        "uvec2 krs_cell_texel(uint i) { return texelFetch(krs_cells, int(i)).xy; }\n\n",
    [TEMPLATE_BUFFER_CELLS] =
        "layout(std430, set = 0, binding = 2) readonly buffer KrsCells { uvec2 krs_cells[]; };\n\n"
        "uvec2 krs_cell_texel(uint i) { return krs_cells[i]; }\n\n",
    [TEMPLATE_TEXEL_TABLES] =
        "layout(set = 0, binding = 1) uniform samplerBuffer krs_rows;\n"
        "layout(set = 0, binding = 2) uniform usamplerBuffer krs_cells;\n\n"
        "vec4 krs_row_texel(uint i) { return texelFetch(krs_rows, int(i)); }\n"
        "uvec2 krs_cell_texel(uint i) { return texelFetch(krs_cells, int(i)).xy; }\n\n",
    [TEMPLATE_BUFFER_TABLES] =
        "layout(std430, set = 0, binding = 1) readonly buffer KrsRows { vec4 krs_rows[]; };\n"
        "layout(std430, set = 0, binding = 2) readonly buffer KrsCells { uvec2 krs_cells[]; };\n\n"
        "vec4 krs_row_texel(uint i) { return krs_rows[i]; }\n"
        "uvec2 krs_cell_texel(uint i) { return krs_cells[i]; }\n\n",
    [TEMPLATE_TABLES] =
        "// A table: its grid, the box of what it has, and texels where its cells, its rows and\n"
        "// their copies in the order of the lists begin.\n"
        "struct KrsTable {\n"
        "    vec3 low;\n"
        "    float cells_per_length;\n"
        "    uvec3 cells;\n"
        "    uint records;\n"
        "    vec3 centre, half_sides;\n"
        "    uint rows, copies;\n"
        "    float width, per_width, slope_per_width, exact_to;\n"
        "};\n\n"
        "// The list of members that are near a point, and how far others are at least.\n"
        "struct KrsNear {\n"
        "    uint first, end;\n"
        "    float clearance;\n"
        "};\n\n",
    [TEMPLATE_TEXTURES] =
        "// A texture: the texel where its list of levels begins, how many there are, what is\n"
        "// outside (0: the picture again, 1: its edge, 2: its mirror image), and whether it is\n"
        "// gray.\n"
        "struct KrsTexture {\n"
        "    uint list, levels, wrap;\n"
        "    bool gray;\n"
        "};\n\n",
    [TEMPLATE_EACH_LISTED] = "    KrsNear nearby = krs_near(p, $a);\n"
                             "    for (uint i = nearby.first; i < nearby.end; i++) {\n"
                             "        uint row = krs_listed(i, $a);\n",

    [TEMPLATE_NEAREST_GRADIENT] = "    vec4 nearest = vec4(0.0, 0.0, 0.0, " NOWHERE_TEXT
                                  "), other;\n",
    [TEMPLATE_NEAREST_OF_ZONES] =
        "    for (int i = 0; i < $a; i++) {\n"
        "        vec3 toward = krs_zones[i].xyz - p;\n"
        "        float depth = krs_zones[i].w - length(toward);\n"
        "        nearest = depth > nearest.w ? vec4(toward, depth) : nearest;\n"
        "    }\n",
};

const Printer glsl_printer = {
    .name         = "GLSL",
    .types        = types,
    .operation    = operation,
    .helpers      = helper_files,
    .alternatives = alternatives,
    .templates    = templates,
};
