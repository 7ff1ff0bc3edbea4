/*
 * wgsl.c: WGSL, for WebGPU: tables are storage buffers, and helpers those of print/glsl (spell.h).
 */
#include "compiler/base/far.h"
#include "compiler/print/wgsl/spell.h"

static const char *const types[] = {
    [TYPE_FLOAT] = "f32",  [TYPE_VEC2] = "vec2f", [TYPE_VEC3] = "vec3f",
    [TYPE_VEC4] = "vec4f", [TYPE_BOOL] = "bool",  [TYPE_UINT] = "u32",
};

static const Alternative alternatives[] = {
    {"KRS_MIN", "min($a, $b)", "select($a, $b, ($b) < ($a))"},
    {"KRS_MAX", "max($a, $b)", "select($a, $b, ($a) < ($b))"},
    {"KRS_BACK", "$b", "$a"}, /* mirrors.c */
    {NULL, NULL, NULL},
};

static const char *operation(Op op, GraphType type)
{
    (void)type;
    return op == OP_select ? "select($c, $b, $A)" : NULL;
}

/* krs_reduce of sines.glsl.  WGSL has no `precise`, but what is an fma stays one.  As n times a part of pi is exact,
   it does not matter whether an fma rounds the product. */
static const EmbeddedFile helpers[] = {
    {.name = "reduce.wgsl",
     .text = "fn krs_reduce(a: f32, n: f32) -> f32\n{\n"
             "    let r = fma(-n, 9.67025756836e-4, fma(-n, 3.140625, a));\n"
             "    return clamp(r - n * 6.27832947e-7, -1.6, 1.6); // what is left of large "
             "arguments may be anything\n"
             "}\n"},
    {0},
};

#define CELLS                                                               \
    "@group(0) @binding(2) var<storage, read> krs_cells: array<vec2u>;\n\n" \
    "fn krs_cell_texel(i: u32) -> vec2u { return krs_cells[i]; }\n\n"
#define ROWS                                                               \
    "@group(0) @binding(1) var<storage, read> krs_rows: array<vec4f>;\n\n" \
    "fn krs_row_texel(i: u32) -> vec4f { return krs_rows[i]; }\n\n"

static const char *const templates[TEMPLATE_COUNT] = {
    [TEMPLATE_FUNCTION]        = "fn $b($c) -> $a",
    [TEMPLATE_PROCEDURE]       = "fn $a($b)",
    [TEMPLATE_PARAMETER]       = "$b: $a",
    [TEMPLATE_PARAMETER_OUT]   = "$b: ptr<function, $a>",
    [TEMPLATE_PARAMETER_INOUT] = "$b: ptr<function, $a>",
    [TEMPLATE_CHANGED]         = "*$a",
    [TEMPLATE_ARGUMENT_OUT]    = "&$a",
    [TEMPLATE_PROTOTYPE]       = "$a// $b\n\n",

    [TEMPLATE_LOCAL]         = "    let $b: $a = $c;\n",
    [TEMPLATE_VARIABLE]      = "    var $b: $a = $c;\n",
    [TEMPLATE_LOCAL_UNSET]   = "    var $b: $a;\n",
    [TEMPLATE_GLOBAL]        = "var<private> $b: $a;\n",
    [TEMPLATE_CONSTANT_UINT] = "const $a = $bu;\n\n",
    [TEMPLATE_MEMBER]        = "    $b: $a,\n",

    [TEMPLATE_RETURN_IF]  = "    if ($a) {\n        return $b;\n    }\n",
    [TEMPLATE_SET_IF]     = "    if ($a) {\n        $b = $c;\n    }\n",
    [TEMPLATE_CHOICE]     = "select($c, $b, $a)",
    [TEMPLATE_SWITCH]     = "    switch $a {\n",
    [TEMPLATE_CASE]       = "    case $au: {\n",
    [TEMPLATE_CASE_END]   = "    }\n",
    [TEMPLATE_SWITCH_END] = "    default: {}\n    }\n",
    [TEMPLATE_ITERATIONS] = "    var $a: u32 = 0u;\n    loop {\n",
    [TEMPLATE_ITERATIONS_END] =
        "    $a += 1u;\n    if ($a >= $bu) {\n        break;\n    }\n    }\n",

    [TEMPLATE_BITS] = "bitcast<u32>($a)",

    [TEMPLATE_PARAMETER_BLOCK] =
        "@group(0) @binding(0) var<uniform> krs_parameter: array<vec4f, $a>;\n\n",
    [TEMPLATE_ZONES]      = "var<private> krs_zones: array<vec4f, $a>;\n\n",
    [TEMPLATE_READ_ZONES] = "    for (var i = 0u; i < $au; i++) {\n"
                            "        krs_zones[i] = krs_parameter[$bu + i];\n"
                            "    }\n",
    [TEMPLATE_CUT]        = "fn krs_cut(p: vec3f, uncut: f32) -> f32\n{\n    var d = uncut;\n",
    [TEMPLATE_CUT_ZONES]  = "    for (var i = 0u; i < $au; i++) {\n"
                            "        d = max(d, krs_zones[i].w - length(p - krs_zones[i].xyz));\n"
                            "    }\n",
    [TEMPLATE_CUT_NEAR_ZONES] =
        "    for (var i = 0u; i < $au; i++) {\n"
        "        let c = krs_zones[i].xyz;\n"
        "        let lengths = length(c) + length(c - p);\n"
        "        d = max(d, krs_zones[i].w + dot(c + (c - p), p) / max(lengths, 1e-30));\n"
        "    }\n",

    [TEMPLATE_TEXEL_CELLS]   = CELLS,
    [TEMPLATE_BUFFER_CELLS]  = CELLS,
    [TEMPLATE_TEXEL_TABLES]  = ROWS  CELLS,
    [TEMPLATE_BUFFER_TABLES] = ROWS CELLS,
    [TEMPLATE_TABLES] =
        "// A table: its grid, the box of what it has, and texels where its cells, its rows and\n"
        "// their copies in the order of the lists begin.\n"
        "struct KrsTable {\n"
        "    low: vec3f,\n"
        "    cells_per_length: f32,\n"
        "    cells: vec3u,\n"
        "    records: u32,\n"
        "    centre: vec3f,\n"
        "    half_sides: vec3f,\n"
        "    rows: u32,\n"
        "    copies: u32,\n"
        "    width: f32,\n"
        "    per_width: f32,\n"
        "    slope_per_width: f32,\n"
        "    exact_to: f32,\n"
        "};\n\n"
        "// The list of members that are near a point, and how far others are at least.\n"
        "struct KrsNear {\n"
        "    first: u32,\n"
        "    end: u32,\n"
        "    clearance: f32,\n"
        "};\n\n",
    [TEMPLATE_TEXTURES] =
        "// A texture: the texel where its list of levels begins, how many there are, what is\n"
        "// outside (0: the picture again, 1: its edge, 2: its mirror image), and whether it is\n"
        "// gray.\n"
        "struct KrsTexture {\n"
        "    list: u32,\n"
        "    levels: u32,\n"
        "    wrap: u32,\n"
        "    gray: bool,\n"
        "};\n\n",
    [TEMPLATE_EACH_LISTED] = "    var nearby: KrsNear = krs_near(p, $a);\n"
                             "    for (var i = nearby.first; i < nearby.end; i++) {\n"
                             "        let row = krs_listed(i, $a);\n",

    [TEMPLATE_NEAREST_GRADIENT] = "    var nearest = vec4f(0.0, 0.0, 0.0, " NOWHERE_TEXT ");\n"
                                  "    var other: vec4f;\n",
    [TEMPLATE_NEAREST_OF_ZONES] =
        "    for (var i = 0u; i < $au; i++) {\n"
        "        let toward = krs_zones[i].xyz - p;\n"
        "        let depth = krs_zones[i].w - length(toward);\n"
        "        nearest = select(nearest, vec4f(toward, depth), depth > nearest.w);\n"
        "    }\n",
};

const Printer wgsl_printer = {
    .name         = "WGSL",
    .base         = &glsl_printer,
    .types        = types,
    .operation    = operation,
    .helpers      = helpers,
    .spell        = wgsl_spell,
    .alternatives = alternatives,
    .templates    = templates,
};
