/*
 * answers.c: answers to a page, in JSON.
 */
#include "web/core/answers.h"

#include "compiler/base/json.h"
#include "compiler/scene/compiled.h"

/* ---- the answer ---- */

/* The last answer, and its memory. */
static struct Answer {
    Memory memory;
    Arena  arena;
    Json   json;
} answer;

static Json *const to = &answer.json;

static void begin(void)
{
    arena_free(&answer.arena);
    answer.arena = (Arena){.memory = &answer.memory};
    answer.json  = (Json){.text = {.arena = &answer.arena}, .spaced = true};
}

/* Runs what writes an answer; where memory runs out, there is none. */
#define ANSWER(write)                         \
    do {                                      \
        jmp_buf exhausted;                    \
        answer.memory.exhausted = &exhausted; \
        if (setjmp(exhausted) == 0)           \
            write;                            \
        else                                  \
            begin();                          \
    } while (0)

const char *answer_text(void) { return to->text.bytes ? to->text.bytes : "{\"status\": 71}"; }

/* ---- compilations ---- */

static void write_begin(void)
{
    json_open(to, NULL, "{");
    json_open(to, "diagnostics", "[");
}

void answer_begin_compilation(void)
{
    begin();
    ANSWER(write_begin());
}

static void write_diagnostic(const KrsDiagnostic *diagnostic)
{
    json_ready(to, NULL, diagnostic->json);
}

void answer_diagnostic(void *user, const KrsDiagnostic *diagnostic)
{
    (void)user;
    ANSWER(write_diagnostic(diagnostic));
}

static void write_end(KrsStatus status, const KrsChanges *changes)
{
    static const char *const kinds[] = {"nothing", "values", "structure"};
    json_close(to, "]");
    json_number(to, "status", status);
    if (changes && status == KRS_OK) {
        json_open(to, "changes", "{");
        json_text(to, "kind", kinds[changes->kind]);
        json_truth(to, "parameters", changes->parameters);
        json_truth(to, "components", changes->components);
        json_truth(to, "cameras", changes->cameras);
        json_truth(to, "lights", changes->lights);
        json_truth(to, "image", changes->image);
        json_truth(to, "solids", changes->solids);
        json_truth(to, "surfaces", changes->surfaces);
        json_close(to, "}");
    }
    json_close(to, "}");
}

void answer_end_compilation(KrsStatus status, const KrsChanges *changes)
{
    ANSWER(write_end(status, changes));
}

/* ---- scenes ---- */

static void write_parameter(const KrsScene *scene, size_t index)
{
    KrsParameter p;
    krs_parameter(scene, index, &p);
    json_open(to, NULL, "{");
    json_text(to, "name", p.name);
    json_numbers(to, "value", p.value, p.components);
    json_numbers(to, "low", p.low, p.components);
    json_numbers(to, "high", p.high, p.components);
    json_truth(to, "degrees", p.degrees);
    json_truth(to, "color", p.color);
    json_truth(to, "whole", p.whole);
    json_text(to, "doc", p.doc);
    json_text(to, "source", p.source);
    json_number(to, "start", p.start);
    json_number(to, "end", p.end);
    json_close(to, "}");
}

static void write_component(const KrsScene *scene, size_t index)
{
    KrsComponent c;
    krs_component(scene, index, &c);
    json_open(to, NULL, "{");
    json_text(to, "name", c.name);
    json_numbers(to, "low", c.low, 3);
    json_numbers(to, "high", c.high, 3);
    json_truth(to, "exact", c.exact);
    json_truth(to, "estimate", c.estimate);
    json_truth(to, "figure", c.figure);
    json_number(to, "flops", c.flops);
    json_close(to, "}");
}

static void write_texture(const KrsScene *scene, size_t index)
{
    KrsTexture t;
    krs_texture(scene, index, &t);
    json_open(to, NULL, "{");
    json_text(to, "file", t.file);
    json_number(to, "width", t.width);
    json_number(to, "height", t.height);
    json_number(to, "levels", t.levels);
    json_truth(to, "gray", t.gray);
    json_number(to, "header", (double)t.header);
    json_number(to, "first", (double)t.first);
    json_close(to, "}");
}

static void write_image(const KrsScene *scene)
{
    const KrsImage image = krs_scene_image(scene);
    json_open(to, "image", "{");
    json_number(to, "width", image.width);
    json_number(to, "height", image.height);
    json_number(to, "samples", image.samples);
    json_text(to, "integrator", image.integrator);
    json_number(to, "exposure", image.exposure);
    json_text(to, "tone_map", image.tone_map);
    json_text(to, "pixel_filter", image.pixel_filter);
    json_numbers(to, "white_balance", image.white_balance, 2);
    json_close(to, "}");
}

/* Writes what a program that draws the scene chooses its shaders by. */
static void write_shaders(const KrsScene *scene)
{
    const KrsProgram *program = krs_scene_program(scene);
    json_open(to, "shaders", "{");
    json_numbers(to, "low", program->low, 3);
    json_numbers(to, "high", program->high, 3);
#define ADD_TRUTH(member) json_truth(to, #member, program->member);
    ADD_TRUTH(open_surfaces)
    ADD_TRUTH(gradients)
    ADD_TRUTH(algebraic)
    ADD_TRUTH(plain)
    ADD_TRUTH(sky_map)
    ADD_TRUTH(mirrors)
    ADD_TRUTH(media)
    ADD_TRUTH(volumes)
    ADD_TRUTH(layers)
    ADD_TRUTH(films)
    ADD_TRUTH(subsurface)
    ADD_TRUTH(anisotropic)
    ADD_TRUTH(views)
    ADD_TRUTH(emits)
#undef ADD_TRUTH
    json_truth(to, "panoramas", krs_scene_is_panoramic(scene));
    json_truth(to, "lenses", krs_scene_has_lens(scene));
    json_truth(to, "affordable", krs_structure_is_affordable(scene));
    json_close(to, "}");
}

static void write_scene(const KrsScene *scene)
{
    const KrsDiagnostic *too_large = krs_scene_too_large(scene);
    json_open(to, NULL, "{");
    json_text(to, "version", krs_version());
    json_open(to, "parameters", "[");
    for (size_t i = 0; i < krs_parameter_count(scene); i++)
        write_parameter(scene, i);
    json_close(to, "]");
    json_open(to, "components", "[");
    for (size_t i = 0; i < krs_component_count(scene); i++)
        write_component(scene, i);
    json_close(to, "]");
    json_open(to, "textures", "[");
    for (size_t i = 0; i < krs_texture_count(scene); i++)
        write_texture(scene, i);
    json_close(to, "]");
    write_image(scene);
    write_shaders(scene);
    json_number(to, "parameter_slots", (double)krs_parameter_slots(scene));
    json_number(to, "value_slots", (double)krs_value_slots(scene));
    json_number(to, "table_rows", (double)krs_table_rows(scene));
    json_number(to, "table_cells", (double)krs_table_cells(scene));
    json_text(to, "too_large", too_large ? too_large->message : NULL);
    json_close(to, "}");
}

void answer_scene(const KrsScene *scene)
{
    begin();
    ANSWER(write_scene(scene));
}

/* ---- states ---- */

static void add_member(const char *member, const double *numbers, size_t count)
{
    if (count == 1)
        json_number(to, member, *numbers);
    else
        json_numbers(to, member, numbers, count);
}

/* Writes a member of a struct, a number or several. */
#define ADD_MEMBER(of, member) \
    add_member(#member, (const double *)&(of)->member, sizeof(of)->member / sizeof(double))

static void write_camera(KrsState *state, const char *given, size_t index)
{
    KrsCamera camera;
    if (krs_state_camera(state, index, &camera) != KRS_OK)
        return;
    json_open(to, NULL, "{");
    json_text(to, "name", given);
#define KRS_CAMERA(member, ...)       ADD_MEMBER(&camera, member);
#define KRS_CAMERA_FIXED(member, ...) json_number(to, #member, camera.member);
#include "krs/camera.def"
    json_close(to, "}");
}

static void write_light(KrsState *state, const char *given, size_t index)
{
    KrsLight light;
    if (krs_state_light(state, index, &light) != KRS_OK)
        return;
    json_open(to, NULL, "{");
    json_text(to, "name", given);
    json_truth(to, "positional", light.positional);
    json_truth(to, "shadow", light.shadow);
    json_truth(to, "spot", light.spot);
    json_number(to, "type", light.type);
    ADD_MEMBER(&light, axis);
    ADD_MEMBER(&light, right);
    ADD_MEMBER(&light, up);
#define KRS_LIGHT(member, ...) ADD_MEMBER(&light, member);
#include "krs/lights.def"
    json_close(to, "}");
}

static void write_sky(KrsState *state)
{
    KrsSky sky;
    if (krs_state_sky(state, &sky) != KRS_OK)
        return;
    json_open(to, "sky", "{");
    ADD_MEMBER(&sky, zenith);
    ADD_MEMBER(&sky, horizon);
    ADD_MEMBER(&sky, ground);
    ADD_MEMBER(&sky, rotation);
    ADD_MEMBER(&sky, intensity);
    if (sky.map) {
        json_open(to, "map", "{");
        json_number(to, "width", sky.map->width);
        json_number(to, "height", sky.map->height);
        json_number(to, "texels", (double)(uintptr_t)sky.map->texels);
        json_close(to, "}");
    }
    json_close(to, "}");
}

static void write_fog(KrsState *state)
{
    KrsFog fog;
    if (krs_state_fog(state, &fog) != KRS_OK)
        return;
    json_open(to, "fog", "{");
    ADD_MEMBER(&fog, color);
    ADD_MEMBER(&fog, density);
    ADD_MEMBER(&fog, fall);
    ADD_MEMBER(&fog, base);
    json_close(to, "}");
}

static void write_view(KrsState *state, const KrsScene *scene)
{
    json_open(to, NULL, "{");
    json_open(to, "cameras", "[");
    for (size_t i = 0; i < krs_camera_count(scene); i++)
        write_camera(state, krs_camera_name(scene, i), i);
    json_close(to, "]");
    json_open(to, "lights", "[");
    for (size_t i = 0; i < krs_light_count(scene); i++)
        write_light(state, krs_light_name(scene, i), i);
    json_close(to, "]");
    write_sky(state);
    write_fog(state);
    json_close(to, "}");
}

void answer_view(const KrsScene *scene, KrsState *state)
{
    begin();
    ANSWER(write_view(state, scene));
}

/* ---- queries ---- */

static void write_hit(const KrsHit *hit)
{
    json_open(to, NULL, "{");
    json_truth(to, "hit", hit->hit);
    json_truth(to, "unresolved", hit->unresolved);
    ADD_MEMBER(hit, t);
    ADD_MEMBER(hit, point);
    ADD_MEMBER(hit, distance);
    ADD_MEMBER(hit, normal);
#define KRS_IDENTITY(member, ...) json_number(to, #member, hit->member);
#include "krs/surface.def"
#define KRS_MATERIAL(member, ...) ADD_MEMBER(hit, member);
#include "krs/surface.def"
    json_close(to, "}");
}

static void write_hits(KrsStatus status, const KrsHit *hits, size_t count)
{
    json_open(to, NULL, "{");
    json_number(to, "status", status);
    json_open(to, "hits", "[");
    for (size_t i = 0; i < count && status == KRS_OK; i++)
        write_hit(&hits[i]);
    json_close(to, "]");
    json_close(to, "}");
}

void answer_hits(KrsStatus status, const KrsHit *hits, size_t count)
{
    begin();
    ANSWER(write_hits(status, hits, count));
}

static void write_mesh(KrsStatus status, const KrsMesh *mesh)
{
    json_open(to, NULL, "{");
    json_number(to, "status", status);
    if (mesh) {
        json_number(to, "vertices", (double)(uintptr_t)mesh->vertices);
        json_number(to, "vertex_count", (double)mesh->vertex_count);
        json_number(to, "triangles", (double)(uintptr_t)mesh->triangles);
        json_number(to, "triangle_count", (double)mesh->triangle_count);
        json_number(to, "error", mesh->error);
        json_number(to, "unresolved", (double)mesh->unresolved);
        json_truth(to, "estimate", mesh->estimate);
        json_truth(to, "steps", mesh->steps);
    }
    json_close(to, "}");
}

void answer_mesh(KrsStatus status, const KrsMesh *mesh)
{
    begin();
    ANSWER(write_mesh(status, mesh));
}
