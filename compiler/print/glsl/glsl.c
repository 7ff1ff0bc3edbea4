/*
 * glsl.c: GLSL 4.4, with std140 blocks as Vulkan has them.
 */
#include "compiler/print/printer.h"
#include "compiler/print/variant.h"

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

const Printer glsl_printer = {
    .name         = "GLSL",
    .types        = types,
    .operation    = op_glsl,
    .helpers      = helper_files,
    .alternatives = alternatives,
    .signatures =
        {
            [KRS_FUNCTION_DISTANCE]     = "float krs_distance(vec3 p)",
            [KRS_FUNCTION_PLANE_T]      = "float krs_plane_t(vec3 p, vec3 direction)",
            [KRS_FUNCTION_PLANE_COSINE] = "float krs_plane_cosine(vec3 direction)",
            [KRS_FUNCTION_ALONG] = "float krs_along(vec3 p, vec3 direction, float footprint)",
            [KRS_FUNCTION_PROBE] = "float krs_probe(vec3 p, float footprint)",
            [KRS_FUNCTION_DISTANCE_LOD] = "float krs_distance_lod(vec3 p, float footprint)",
            [KRS_FUNCTION_SCENE_PART_DISTANCE] =
                "float krs_scene_part_distance(uint scene_part, vec3 p)",
            [KRS_FUNCTION_SCENE_PART_BOX] =
                "void krs_scene_part_box(uint scene_part, inout vec3 low, inout vec3 high)",
            [KRS_FUNCTION_GRADIENT] = "vec3 krs_gradient(vec3 p, float reach)",
            [KRS_FUNCTION_SURFACE] = "KrsSurface krs_surface(vec3 p, vec3 normal, float footprint)",
        },
    .promises =
        {
            [KRS_FUNCTION_DISTANCE] =
                "// Never above the distance to the nearest surface; negative inside.\n",
            [KRS_FUNCTION_PLANE_T] =
                "// How far it is along a ray from outside to the nearest of the planes that\n"
                "// krs_distance leaves out here.\n",
            [KRS_FUNCTION_PLANE_COSINE] = "// How steeply a ray falls towards one of them: n.d.\n",
            [KRS_FUNCTION_ALONG] =
                "// How far a ray from p along a unit direction may go before it can meet a\n"
                "// surface: at least the distance, and farther where polynomials or maps tell;\n"
                "// negative inside, and where a surface without thickness lies between p and the\n"
                "// last place, `footprint` behind.\n",
            [KRS_FUNCTION_PROBE] =
                "// Whether the ball around p of this radius is empty: if it could be more than 1\n"
                "// times as large, which is what this says, about.\n",
            [KRS_FUNCTION_DISTANCE_LOD] =
                "// To march by: never above the distance to the nearest surface, and not above 0\n"
                "// in the same places as krs_distance.  What is far for its size is not looked\n"
                "// at, nor what is smaller than the footprint.\n",
            [KRS_FUNCTION_SCENE_PART_DISTANCE] =
                "// Parts of the scene, most of them one component: the distance of one.\n",
            [KRS_FUNCTION_SCENE_PART_BOX] =
                "// A box around a part; where there is none the box stays empty.\n",
            [KRS_FUNCTION_GRADIENT] =
                "// The direction in which krs_distance rises fastest at a surface, of any\n"
                "// length, by derivatives; by differences over `reach` where there are none.\n",
            [KRS_FUNCTION_SURFACE] =
                "// What is at p: the component with the least distance.  `normal` is the\n"
                "// gradient of krs_distance there, `footprint` the radius of a pixel, or 0.\n",
        },
};
