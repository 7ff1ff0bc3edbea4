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

static const char *const phrases[PHRASE_COUNT] = {
    [PHRASE_FUNCTION]        = "$a $b($c)",
    [PHRASE_PROCEDURE]       = "void $a($b)",
    [PHRASE_PARAMETER]       = "$a $b",
    [PHRASE_PARAMETER_OUT]   = "out $a $b",
    [PHRASE_PARAMETER_INOUT] = "inout $a $b",
    [PHRASE_CHANGED]         = "$a",
    [PHRASE_ARGUMENT_OUT]    = "$a",
    [PHRASE_PROTOTYPE]       = "$a$b;\n\n",

    [PHRASE_LOCAL]         = "    $a $b = $c;\n",
    [PHRASE_LOCAL_UNSET]   = "    $a $b;\n",
    [PHRASE_GLOBAL]        = "$a $b;\n",
    [PHRASE_CONSTANT_UINT] = "const uint $a = $bu;\n\n",
    [PHRASE_MEMBER]        = "    $a$c $b;\n",

    [PHRASE_RETURN_IF]  = "    if ($a)\n        return $b;\n",
    [PHRASE_SET_IF]     = "    if ($a)\n        $b = $c;\n",
    [PHRASE_CHOICE]     = "$a ? $b : $c",
    [PHRASE_SWITCH]     = "    switch ($a) {\n",
    [PHRASE_CASE]       = "    case $au:\n",
    [PHRASE_CASE_END]   = "        break;\n",
    [PHRASE_SWITCH_END] = "    }\n",
    [PHRASE_TURNS]      = "    uint $a = 0u;\n    [[dont_unroll]] do {\n",
    [PHRASE_TURNS_END]  = "    } while (++$a < $bu);\n",

    [PHRASE_BITS] = "floatBitsToUint($a)",

    [PHRASE_PARAMETER_BLOCK] = "layout(std140, set = 0, binding = 0) uniform KrsParameters "
                               "{ vec4 krs_parameter[$a]; };\n\n",
    [PHRASE_ZONES]           = "vec4 krs_zones[$a];\n\n",
    [PHRASE_READ_ZONES]      = "    for (int i = 0; i < $a; i++)\n"
                               "        krs_zones[i] = krs_parameter[$b + i];\n",
    [PHRASE_CUT]             = "float krs_cut(vec3 p, float d)\n{\n",
    [PHRASE_CUT_ZONES]       = "    for (int i = 0; i < $a; i++)\n"
                               "        d = max(d, krs_zones[i].w - length(p - krs_zones[i].xyz));\n",
    /* length(c) - length(c - p), without a difference of large numbers. */
    [PHRASE_CUT_NEAR_ZONES] =
        "    for (int i = 0; i < $a; i++) {\n"
        "        vec3 c = krs_zones[i].xyz;\n"
        "        float lengths = length(c) + length(c - p);\n"
        "        d = max(d, krs_zones[i].w + dot(c + (c - p), p) / max(lengths, 1e-30));\n"
        "    }\n",

    [PHRASE_TEXEL_CELLS] =
        "layout(set = 0, binding = 2) uniform usamplerBuffer krs_cells;\n\n"
        "uvec2 krs_cell_texel(uint i) { return texelFetch(krs_cells, int(i)).xy; }\n\n",
    [PHRASE_BUFFER_CELLS] =
        "layout(std430, set = 0, binding = 2) readonly buffer KrsCells { uvec2 krs_cells[]; };\n\n"
        "uvec2 krs_cell_texel(uint i) { return krs_cells[i]; }\n\n",
    [PHRASE_TEXEL_TABLES] =
        "layout(set = 0, binding = 1) uniform samplerBuffer krs_rows;\n"
        "layout(set = 0, binding = 2) uniform usamplerBuffer krs_cells;\n\n"
        "vec4 krs_row_texel(uint i) { return texelFetch(krs_rows, int(i)); }\n"
        "uvec2 krs_cell_texel(uint i) { return texelFetch(krs_cells, int(i)).xy; }\n\n",
    [PHRASE_BUFFER_TABLES] =
        "layout(std430, set = 0, binding = 1) readonly buffer KrsRows { vec4 krs_rows[]; };\n"
        "layout(std430, set = 0, binding = 2) readonly buffer KrsCells { uvec2 krs_cells[]; };\n\n"
        "vec4 krs_row_texel(uint i) { return krs_rows[i]; }\n"
        "uvec2 krs_cell_texel(uint i) { return krs_cells[i]; }\n\n",
    [PHRASE_TABLES] =
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
    [PHRASE_TEXTURES] =
        "// A texture: the texel where its list of levels begins, how many there are, what is\n"
        "// outside (0: the picture again, 1: its edge, 2: its mirror image), and whether it is\n"
        "// gray.\n"
        "struct KrsTexture {\n"
        "    uint list, levels, wrap;\n"
        "    bool gray;\n"
        "};\n\n",
    [PHRASE_EACH_LISTED] = "    KrsNear nearby = krs_near(p, $a);\n"
                           "    for (uint i = nearby.first; i < nearby.end; i++) {\n"
                           "        uint member = krs_listed(i, $a);\n",

    [PHRASE_NEAREST_GRADIENT] = "    vec4 nearest = vec4(0.0, 0.0, 0.0, " NOWHERE_TEXT
                                "), other;\n",
    [PHRASE_NEAREST_OF_ZONES] =
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
    .phrases      = phrases,
};
