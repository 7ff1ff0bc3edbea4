/*
 * export.c: fills the template of a target.
 */
#include "export/export.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/base/embedded.h"
#include "compiler/base/visible.h"
#include "compiler/scene/program.h"

const ExportTarget export_targets[EXPORT_COUNT] = {
#define EXPORT_TARGET(id, name, template, ending, tables, cameras, longest, about) \
    [EXPORT_##id] = {name, template, ending, tables, cameras, longest},
#include "export/targets.def"
};

typedef struct Export {
    const KrsScene     *scene;
    KrsState           *state;
    const ExportTarget *target;
    const char         *name;
    KrsView             view;
    float (*block)[4];
    char *text; /* of the scene, without its block of parameters */
} Export;

/* ---- numbers ---- */

/* Adds a number as GLSL has it, with a point. */
static void add_float(Text *to, double number)
{
    const float rounded = (float)fmin(fmax(number, -FLT_MAX), FLT_MAX);
    char        digits[32];
    snprintf(digits, sizeof digits, "%.9g", (double)rounded);
    text_format(to, "%s%s", digits, strpbrk(digits, ".e") ? "" : ".0");
}

static void add_vector(Text *to, const double *numbers, int count)
{
    text_format(to, "vec%d(", count);
    for (int i = 0; i < count; i++) {
        text_add(to, i ? ", " : "");
        add_float(to, numbers[i]);
    }
    text_add(to, ")");
}

static void add_constant(Text *to, const char *type, const char *name)
{
    text_format(to, "const %s %s = ", type, name);
}

static void add_number_constant(Text *to, const char *name, double number)
{
    add_constant(to, "float", name);
    add_float(to, number);
    text_add(to, ";\n");
}

static void add_vector_constant(Text *to, const char *name, const double numbers[3])
{
    add_constant(to, "vec3 ", name);
    add_vector(to, numbers, 3);
    text_add(to, ";\n");
}

/* ---- camera, lights and sky ---- */

static double distance_between(const double a[3], const double b[3])
{
    return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) +
                (a[2] - b[2]) * (a[2] - b[2]));
}

/* Returns how far from the eye there may be something. */
static double find_farthest(const Export *export)
{
    const KrsCamera  *camera  = &export->view.camera;
    const KrsProgram *program = &export->scene->program;
    double            far[3];
    for (int k = 0; k < 3; k++)
        far[k] = fmax(fabs(program->low[k] - camera->eye[k]),
                      fabs(program->high[k] - camera->eye[k]));
    const double corner = distance_between(far, (const double[3]){0, 0, 0});
    const double enough = 1e4 * distance_between(camera->eye, camera->target);
    return corner < enough ? corner : enough;
}

/* The direction that is up in the picture; of a camera that looks along its own, another axis. */
typedef struct Upright {
    double v[3];
} Upright;

static Upright find_upright(const KrsCamera *camera)
{
    double  ahead[3], across[3];
    Upright upright;
    memcpy(upright.v, camera->up, sizeof upright.v);
    for (int k = 0; k < 3; k++)
        ahead[k] = camera->target[k] - camera->eye[k];
    for (int k = 0; k < 3; k++)
        across[k] = ahead[(k + 1) % 3] * upright.v[(k + 2) % 3] -
                    ahead[(k + 2) % 3] * upright.v[(k + 1) % 3];
    static const double nowhere[3] = {0};
    const double        parallel   = distance_between(across, nowhere) /
                            (distance_between(ahead, nowhere) *
                             distance_between(upright.v, nowhere));
    return parallel > 1e-6 ? upright
                           : (Upright){{0, fabs(ahead[2]) > fabs(ahead[1]),
                                        fabs(ahead[2]) <= fabs(ahead[1]) ? -1 : 0}};
}

/* Returns half the height of the picture at distance 1. */
static double find_rise(const KrsCamera *camera)
{
    return camera->projection == KRS_PERSPECTIVE
               ? tan(0.5 * camera->fov)
               : 0.5 * camera->height / distance_between(camera->eye, camera->target);
}

/* Four numbers of a light. */
typedef void LightNumbers(const KrsLight *light, double numbers[4]);

static void place_of(const KrsLight *light, double numbers[4])
{
    memcpy(numbers, light->vector, sizeof light->vector);
    numbers[3] = light->positional;
}

/* Finds the light's colour, and the radius of the disc that stands for it: of a direction, at
   distance 1. */
static void color_of(const KrsLight *light, double numbers[4])
{
    memcpy(numbers, light->color, sizeof light->color);
    numbers[3] = fmax(light->positional ? light->softness : 0.5 * light->softness, 1e-3);
}

/* Finds where a light shines, and the cosine at the edge of its cone; -2: everywhere. */
static void cone_of(const KrsLight *light, double numbers[4])
{
    memcpy(numbers, light->axis, sizeof light->axis);
    numbers[3] = light->spot ? cos(0.5 * light->angle) : -2;
}

static void add_lights(Text *to, const Export *export, const char *name, LightNumbers *find)
{
    static const KrsLight nowhere = {0};
    const size_t          count   = export->view.light_count ? export->view.light_count : 1;
    text_format(to, "const vec4  %s[%zu] = vec4[%zu](", name, count, count);
    for (size_t i = 0; i < count; i++) {
        double numbers[4];
        find(export->view.light_count ? &export->view.lights[i] : &nowhere, numbers);
        text_add(to, i ? ", " : "");
        add_vector(to, numbers, 4);
    }
    text_add(to, ");\n");
}

static void add_edges(Text *to, const Export *export)
{
    const size_t count = export->view.light_count ? export->view.light_count : 1;
    text_format(to, "const float krs_light_edge[%zu] = float[%zu](", count, count);
    for (size_t i = 0; i < count; i++) {
        const KrsLight *light = export->view.light_count ? &export->view.lights[i] : NULL;
        const double    edge  = light && light->spot ? 0.5 * light->angle * (1 - light->edge) : 0;
        text_add(to, i ? ", " : "");
        add_float(to, cos(edge));
    }
    text_add(to, ");\n");
}

static void add_constants(Text *to, const Export *export)
{
    const KrsView *view = &export->view;
    add_vector_constant(to, "KRS_EYE", view->camera.eye);
    add_vector_constant(to, "KRS_TARGET", view->camera.target);
    add_vector_constant(to, "KRS_UP", find_upright(&view->camera).v);
    add_number_constant(to, "KRS_RISE", find_rise(&view->camera));
    add_number_constant(to, "KRS_FARTHEST", find_farthest(export));
    add_number_constant(to, "KRS_OPEN_REACH",
                        0.1 * distance_between(view->camera.eye, view->camera.target));
    add_vector_constant(to, "KRS_ZENITH", view->sky.zenith);
    add_vector_constant(to, "KRS_HORIZON", view->sky.horizon);
    add_vector_constant(to, "KRS_GROUND", view->sky.ground);
    text_format(to,
                "const int   KRS_MAX_STEPS = 1024, KRS_MAX_SHADOW_STEPS = 64, KRS_LIGHTS = %zu;\n",
                view->light_count);
    text_add(to, "// Each light: position or direction, and 1: it has a position; colour and "
                 "radius; its cone.\n");
    add_lights(to, export, "krs_light_at", place_of);
    add_lights(to, export, "krs_light_color", color_of);
    add_lights(to, export, "krs_light_cone", cone_of);
    add_edges(to, export);
}

/* ---- parameters ---- */

static KrsParameter parameter_of(const Export *export, size_t index)
{
    KrsParameter parameter;
    krs_parameter(export->scene, index, &parameter);
    return parameter;
}

/* Adds a name of GLSL, which has no two underscores side by side, and is not too long: what is
   other has its slot in it. */
static void add_parameter_name(Text *to, const char *name, size_t slot)
{
    enum { LONGEST = 100 };
    const size_t length = strlen(name);
    text_add(to, "PARAM_");
    if (name[0] != '_' && !strstr(name, "__") && length <= LONGEST) {
        text_add(to, name);
        return;
    }
    text_format(to, "%zu", slot);
    for (size_t i = 0; i < length && i < LONGEST; i++)
        if (name[i] != '_' || name[i + 1] != '_')
            text_add_bytes(to, name + i, 1);
}

/* Lines, each a constant with its range behind it. */
static void add_parameters(Text *to, const Export *export)
{
    for (size_t i = 0; i < krs_parameter_count(export->scene); i++) {
        const KrsParameter parameter = parameter_of(export, i);
        double             value[4];
        for (int k = 0; k < 4; k++)
            value[k] = (double)export->block[1 + i][k];
        if (parameter.components == 1) {
            text_add(to, "const float ");
            add_parameter_name(to, parameter.name, 1 + i);
            text_add(to, " = ");
            add_float(to, value[0]);
        } else {
            text_format(to, "const vec%u  ", parameter.components);
            add_parameter_name(to, parameter.name, 1 + i);
            text_add(to, " = ");
            add_vector(to, value, (int)parameter.components);
        }
        text_add(to, ";");
        if (isfinite(parameter.low[0]) || isfinite(parameter.high[0])) {
            text_add(to, " // ");
            text_number(to, parameter.low[0]);
            text_add(to, " to ");
            text_number(to, parameter.high[0]);
        }
        text_add(to, "\n");
    }
}

/* Writes statements that put parameters into their slots; those behind have what the scene was
   exported with. */
static void set_parameters(Text *to, const Export *export)
{
    static const char *const padding[] = {"", ", 0.0, 0.0, 0.0", ", 0.0, 0.0", ", 0.0", ""};
    const size_t             count     = krs_parameter_count(export->scene);
    for (size_t i = 0; i < count; i++) {
        const KrsParameter parameter = parameter_of(export, i);
        text_format(to, "    krs_parameter[%zu] = vec4(", 1 + i);
        add_parameter_name(to, parameter.name, 1 + i);
        text_format(to, "%s);\n", padding[parameter.components]);
    }
    for (size_t i = 1 + count; i < krs_parameter_slots(export->scene); i++) {
        double value[4];
        for (int k = 0; k < 4; k++)
            value[k] = (double)export->block[i][k];
        text_format(to, "    krs_parameter[%zu] = ", i);
        add_vector(to, value, 4);
        text_add(to, ";\n");
    }
}

static void add_parameters_json(Text *to, const Export *export)
{
    text_add(to, "[");
    for (size_t i = 0; i < krs_parameter_count(export->scene); i++) {
        const KrsParameter parameter = parameter_of(export, i);
        text_add(to, i ? ",\n    { name: " : "\n    { name: ");
        text_json(to, parameter.name);
        text_format(to, ", slot: %zu, value: ", 1 + i);
        json_vector(to, parameter.value, parameter.components);
        text_add(to, ", low: ");
        json_vector(to, parameter.low, parameter.components);
        text_add(to, ", high: ");
        json_vector(to, parameter.high, parameter.components);
        text_add(to, " }");
    }
    text_add(to, "]");
}

/* ---- tables ---- */

static void add_base64(Text *to, const unsigned char *bytes, size_t length)
{
    static const char letters[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < length; i += 3) {
        uint32_t three = (uint32_t)bytes[i] << 16;
        char     four[4];
        three |= i + 1 < length ? (uint32_t)bytes[i + 1] << 8 : 0;
        three |= i + 2 < length ? (uint32_t)bytes[i + 2] : 0;
        for (int k = 0; k < 4; k++)
            four[k] = i + (size_t)k <= length ? letters[three >> (18 - 6 * k) & 63] : '=';
        text_add_bytes(to, four, sizeof four);
    }
}

static void add_tables(Text *to, const Export *export, bool rows)
{
    const size_t rows_size  = krs_table_rows(export->scene) * sizeof(float[4]),
                 cells_size = krs_table_cells(export->scene) * sizeof(uint32_t[2]);
    if (cells_size == 0)
        return;
    unsigned char *bytes = arena_alloc(to->arena, 1, rows_size + cells_size);
    krs_state_tables(export->state, (void *)bytes, (void *)(bytes + rows_size));
    add_base64(to, rows ? bytes : bytes + rows_size, rows ? rows_size : cells_size);
}

/* ---- pieces of templates ---- */

static void fill(Text *to, const Export *export, const char *template);

/* The name stands in comments, so it has no end of a line. */
static void add_name(Text *to, const Export *export)
{
    for (const char *from = export->name; *from;) {
        const Visible visible = visible_next(from, strlen(from));
        text_add_bytes(to, visible.text, visible.length);
        from += visible.used;
    }
}
static void add_version(Text *to, const Export *export)
{
    (void)export;
    text_add(to, KRS_VERSION);
}
static void add_slots(Text *to, const Export *export)
{
    text_format(to, "%zu", krs_parameter_slots(export->scene));
}
static void add_scene(Text *to, const Export *export) { text_add(to, export->text); }
static void add_tracer(Text *to, const Export *export) { fill(to, export, "tracer.glsl"); }
static void add_low(Text *to, const Export *export)
{
    json_vector(to, export->scene->program.low, 3);
}
static void add_high(Text *to, const Export *export)
{
    json_vector(to, export->scene->program.high, 3);
}
static void add_camera(Text *to, const Export *export)
{
    const KrsCamera *camera = &export->view.camera;
    text_add(to, "{ eye: ");
    json_vector(to, camera->eye, 3);
    text_add(to, ", target: ");
    json_vector(to, camera->target, 3);
    text_add(to, ", up: ");
    json_vector(to, camera->up, 3);
    text_add(to, ", fov: ");
    json_number(to, 2 * atan(find_rise(camera)));
    text_add(to, " }");
}
static void add_block(Text *to, const Export *export)
{
    text_add(to, "[");
    for (size_t i = 0; i < 4 * krs_parameter_slots(export->scene); i++) {
        text_add(to, i ? ", " : "");
        json_number(to, (double)export->block[i / 4][i % 4]);
    }
    text_add(to, "]");
}
static void add_rows(Text *to, const Export *export) { add_tables(to, export, true); }
static void add_cells(Text *to, const Export *export) { add_tables(to, export, false); }

/* The pieces that stand for words in `@`s.  A target with a block of its own has parameters as a
   list. */
static const struct Piece {
    const char *word;
    void (*add)(Text *to, const Export *export);
} pieces[] = {{"name", add_name},
              {"version", add_version},
              {"slots", add_slots},
              {"scene", add_scene},
              {"tracer", add_tracer},
              {"constants", add_constants},
              {"constant_parameters", add_parameters},
              {"set_parameters", set_parameters},
              {"parameters", add_parameters_json},
              {"low", add_low},
              {"high", add_high},
              {"camera", add_camera},
              {"block", add_block},
              {"rows", add_rows},
              {"cells", add_cells}};

static const struct Piece *find_piece(const char *word, size_t length)
{
    for (size_t i = 0; i < sizeof pieces / sizeof pieces[0]; i++)
        if (strlen(pieces[i].word) == length && memcmp(pieces[i].word, word, length) == 0)
            return &pieces[i];
    return NULL;
}

static const char *find_template(const char *name)
{
    for (const EmbeddedFile *file = export_files; file->name; file++)
        if (strcmp(file->name, name) == 0)
            return file->text;
    return "";
}

static void fill(Text *to, const Export *export, const char *template)
{
    const char *from = find_template(template);
    for (const char *at; (at = strchr(from, '@'));) {
        const size_t        length = strcspn(at + 1, "@");
        const struct Piece *piece  = find_piece(at + 1, length);
        text_add_bytes(to, from, (size_t)(at - from) + (piece ? 0 : 1));
        if (piece)
            piece->add(to, export);
        from = at + 1 + (piece ? length + 1 : 0);
    }
    text_add(to, from);
}

/* ---- what a target cannot have ---- */

/* Refuses a scene that the target cannot have, with a reason in words of the author of the scene;
   false: it can have all. */
static bool refuse(const Export *export, Text *why)
{
    const KrsDiagnostic *large = krs_scene_too_large(export->scene);
    KrsStateSlope        slope;
    if (large)
        text_format(why, "%s, so no shader is made of it (%s)", large->message, large->code);
    else if (!export->target->tables && krs_table_cells(export->scene) > 0)
        text_format(
            why,
            "parts that are alike, outlines and pictures are read from tables, which %s has no "
            "room for",
            export->target->name);
    else if (!export->target->tables && krs_state_slope(export->scene, 0, &slope) == KRS_OK)
        text_format(
            why, "the distance at %s is divided by a number that is known for each picture alone",
            slope.location);
    else if (export->view.sky.map)
        text_add(why, "its sky is a picture");
    else if (!export->target->cameras && export->view.camera.projection != KRS_PERSPECTIVE)
        text_add(why, "its camera is no perspective one; --camera chooses another");
    return why->length > 0;
}

/* ---- a file ---- */

/* Cuts the declaration of the block of parameters out of a text: the target declares it. */
static void cut_block(char *text)
{
    char *from = strstr(text, "layout(std140) uniform KrsParameters");
    char *end  = from ? strchr(from, '\n') : NULL;
    if (end)
        memmove(from, end + 1, strlen(end + 1) + 1);
}

/* Cuts comments and indents. */
static void cut_comments(char *text)
{
    char *to = text;
    for (const char *line = text; *line;) {
        const char  *next = line + strcspn(line, "\n"), *word = line + strspn(line, " ");
        const char  *comment = strstr(word, "//");
        const size_t length  = comment && comment < next ? (size_t)(comment - word)
                                                         : (size_t)(next - word);
        const bool   ends    = *next == '\n';
        memmove(to, word, length);
        to += length;
        if (length > 0 && ends)
            *to++ = '\n';
        line = next + ends;
    }
    *to = '\0';
}

static KrsStatus print(Export *export, Text *file)
{
    const KrsTextOptions how    = {.no_early_outs = true};
    const KrsStatus      status = krs_text(export->scene, KRS_TARGET_ESSL, &how, &export->text);
    if (status != KRS_OK)
        return status;
    cut_block(export->text);
    cut_comments(export->text);
    fill(file, export, export->target->template);
    free(export->text);
    if (export->target->longest == 0 || file->length <= export->target->longest)
        return KRS_OK;
    const size_t characters = file->length;
    file->length            = 0;
    text_format(file, "it takes %zu characters, and %s takes %zu", characters, export->target->name,
                export->target->longest);
    return KRS_BAD_ARGUMENT;
}

KrsStatus export_scene(KrsState *state, ExportId target, const char *name, size_t camera,
                       Text *file)
{
    Export export = {
        .scene = state->scene, .state = state, .target = &export_targets[target], .name = name};
    export.block = arena_alloc(file->arena, krs_parameter_slots(export.scene),
                               sizeof *export.block);
    krs_state_parameters(state, export.block);
    const KrsStatus status = krs_state_view(state, camera, &export.view);
    if (status != KRS_OK)
        return status;
    return refuse(&export, file) ? KRS_BAD_ARGUMENT : print(&export, file);
}
