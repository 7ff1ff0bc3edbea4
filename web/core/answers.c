/*
 * answers.c: answers to a page, in JSON.
 */
#include "web/core/answers.h"

#include "compiler/base/text.h"
#include "compiler/scene/compiled.h"

/* ---- the answer ---- */

/* The last answer, and its memory. */
static struct Answer {
    Memory memory;
    Arena  arena;
    Text   text;
    bool   more; /* something stands before what comes next */
} answer;

static void begin(void)
{
    arena_free(&answer.arena);
    answer.arena = (Arena){.memory = &answer.memory};
    answer.text  = (Text){.arena = &answer.arena};
    answer.more  = false;
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

const char *answer_text(void) { return answer.text.bytes ? answer.text.bytes : "{\"status\": 71}"; }

/* ---- members ---- */

static void enter(const char *bracket)
{
    text_add(&answer.text, bracket);
    answer.more = false;
}

static void leave(const char *bracket)
{
    text_add(&answer.text, bracket);
    answer.more = true;
}

static void separate(void)
{
    if (answer.more)
        text_add(&answer.text, ", ");
    answer.more = true;
}

static void name(const char *member)
{
    separate();
    text_format(&answer.text, "\"%s\": ", member);
}

static void open_member(const char *member, const char *bracket)
{
    name(member);
    enter(bracket);
}

static void open_element(void)
{
    separate();
    enter("{");
}

static void add_numbers(const char *member, const double *numbers, size_t count)
{
    name(member);
    json_vector(&answer.text, numbers, count);
}

static void add_number(const char *member, double number)
{
    name(member);
    json_number(&answer.text, number);
}

static void add_truth(const char *member, bool truth)
{
    name(member);
    text_add(&answer.text, truth ? "true" : "false");
}

static void add_string(const char *member, const char *string)
{
    name(member);
    if (string)
        text_json(&answer.text, string);
    else
        text_add(&answer.text, "null");
}

/* ---- compilations ---- */

static void write_begin(void)
{
    enter("{");
    open_member("diagnostics", "[");
}

void answer_begin_compilation(void)
{
    begin();
    ANSWER(write_begin());
}

static void write_diagnostic(const KrsDiagnostic *diagnostic)
{
    separate();
    text_add(&answer.text, diagnostic->json);
}

void answer_diagnostic(void *user, const KrsDiagnostic *diagnostic)
{
    (void)user;
    ANSWER(write_diagnostic(diagnostic));
}

static void write_end(KrsStatus status, const KrsChanges *changes)
{
    static const char *const kinds[] = {"nothing", "values", "structure"};
    leave("]");
    add_number("status", status);
    if (changes && status == KRS_OK) {
        open_member("changes", "{");
        add_string("kind", kinds[changes->kind]);
        add_truth("parameters", changes->parameters);
        add_truth("components", changes->components);
        add_truth("cameras", changes->cameras);
        add_truth("lights", changes->lights);
        add_truth("image", changes->image);
        add_truth("solids", changes->solids);
        add_truth("surfaces", changes->surfaces);
        leave("}");
    }
    leave("}");
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
    open_element();
    add_string("name", p.name);
    add_numbers("value", p.value, p.components);
    add_numbers("low", p.low, p.components);
    add_numbers("high", p.high, p.components);
    add_truth("degrees", p.degrees);
    add_truth("color", p.color);
    add_truth("whole", p.whole);
    add_string("doc", p.doc);
    add_string("source", p.source);
    add_number("start", p.start);
    add_number("end", p.end);
    leave("}");
}

static void write_component(const KrsScene *scene, size_t index)
{
    KrsComponent c;
    krs_component(scene, index, &c);
    open_element();
    add_string("name", c.name);
    add_numbers("low", c.low, 3);
    add_numbers("high", c.high, 3);
    add_truth("exact", c.exact);
    add_truth("estimate", c.estimate);
    add_truth("figure", c.figure);
    add_number("flops", c.flops);
    leave("}");
}

static void write_texture(const KrsScene *scene, size_t index)
{
    KrsTexture t;
    krs_texture(scene, index, &t);
    open_element();
    add_string("file", t.file);
    add_number("width", t.width);
    add_number("height", t.height);
    add_number("levels", t.levels);
    add_truth("gray", t.gray);
    add_number("header", (double)t.header);
    add_number("first", (double)t.first);
    leave("}");
}

static void write_image(const KrsScene *scene)
{
    const KrsImage image = krs_scene_image(scene);
    open_member("image", "{");
    add_number("width", image.width);
    add_number("height", image.height);
    add_number("samples", image.samples);
    add_string("integrator", image.integrator);
    add_number("exposure", image.exposure);
    add_string("tone_map", image.tone_map);
    add_string("pixel_filter", image.pixel_filter);
    add_numbers("white_balance", image.white_balance, 2);
    leave("}");
}

/* Writes what a program that draws the scene chooses its shaders by. */
static void write_shaders(const KrsScene *scene)
{
    const KrsProgram *program = krs_scene_program(scene);
    open_member("shaders", "{");
    add_numbers("low", program->low, 3);
    add_numbers("high", program->high, 3);
#define ADD_TRUTH(member) add_truth(#member, program->member);
    ADD_TRUTH(open_surfaces)
    ADD_TRUTH(gradients)
    ADD_TRUTH(algebraic)
    ADD_TRUTH(plain)
    ADD_TRUTH(sky_map)
    ADD_TRUTH(mirrors)
    ADD_TRUTH(media)
    ADD_TRUTH(layers)
    ADD_TRUTH(films)
    ADD_TRUTH(subsurface)
    ADD_TRUTH(anisotropic)
    ADD_TRUTH(views)
    ADD_TRUTH(emits)
#undef ADD_TRUTH
    add_truth("panoramas", krs_scene_is_panoramic(scene));
    add_truth("lenses", krs_scene_has_lens(scene));
    add_truth("affordable", krs_structure_is_affordable(scene));
    leave("}");
}

static void write_scene(const KrsScene *scene)
{
    const KrsDiagnostic *too_large = krs_scene_too_large(scene);
    enter("{");
    add_string("version", krs_version());
    open_member("parameters", "[");
    for (size_t i = 0; i < krs_parameter_count(scene); i++)
        write_parameter(scene, i);
    leave("]");
    open_member("components", "[");
    for (size_t i = 0; i < krs_component_count(scene); i++)
        write_component(scene, i);
    leave("]");
    open_member("textures", "[");
    for (size_t i = 0; i < krs_texture_count(scene); i++)
        write_texture(scene, i);
    leave("]");
    write_image(scene);
    write_shaders(scene);
    add_number("parameter_slots", (double)krs_parameter_slots(scene));
    add_number("value_slots", (double)krs_value_slots(scene));
    add_number("table_rows", (double)krs_table_rows(scene));
    add_number("table_cells", (double)krs_table_cells(scene));
    add_string("too_large", too_large ? too_large->message : NULL);
    leave("}");
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
        add_number(member, *numbers);
    else
        add_numbers(member, numbers, count);
}

/* Writes a member of a struct, a number or several. */
#define ADD_MEMBER(of, member) \
    add_member(#member, (const double *)&(of)->member, sizeof(of)->member / sizeof(double))

static void write_camera(KrsState *state, const char *given, size_t index)
{
    KrsCamera camera;
    if (krs_state_camera(state, index, &camera) != KRS_OK)
        return;
    open_element();
    add_string("name", given);
#define KRS_CAMERA(member, ...)       ADD_MEMBER(&camera, member);
#define KRS_CAMERA_FIXED(member, ...) add_number(#member, camera.member);
#include "krs/camera.def"
    leave("}");
}

static void write_light(KrsState *state, const char *given, size_t index)
{
    KrsLight light;
    if (krs_state_light(state, index, &light) != KRS_OK)
        return;
    open_element();
    add_string("name", given);
    add_truth("positional", light.positional);
    add_truth("shadow", light.shadow);
    add_truth("spot", light.spot);
    add_number("type", light.type);
    ADD_MEMBER(&light, axis);
    ADD_MEMBER(&light, right);
    ADD_MEMBER(&light, up);
#define KRS_LIGHT(member, ...) ADD_MEMBER(&light, member);
#include "krs/lights.def"
    leave("}");
}

static void write_sky(KrsState *state)
{
    KrsSky sky;
    if (krs_state_sky(state, &sky) != KRS_OK)
        return;
    open_member("sky", "{");
    ADD_MEMBER(&sky, zenith);
    ADD_MEMBER(&sky, horizon);
    ADD_MEMBER(&sky, ground);
    ADD_MEMBER(&sky, rotation);
    ADD_MEMBER(&sky, intensity);
    if (sky.map) {
        open_member("map", "{");
        add_number("width", sky.map->width);
        add_number("height", sky.map->height);
        add_number("texels", (double)(uintptr_t)sky.map->texels);
        leave("}");
    }
    leave("}");
}

static void write_fog(KrsState *state)
{
    KrsFog fog;
    if (krs_state_fog(state, &fog) != KRS_OK)
        return;
    open_member("fog", "{");
    ADD_MEMBER(&fog, color);
    ADD_MEMBER(&fog, density);
    ADD_MEMBER(&fog, fall);
    ADD_MEMBER(&fog, base);
    leave("}");
}

static void write_view(KrsState *state, const KrsScene *scene)
{
    enter("{");
    open_member("cameras", "[");
    for (size_t i = 0; i < krs_camera_count(scene); i++)
        write_camera(state, krs_camera_name(scene, i), i);
    leave("]");
    open_member("lights", "[");
    for (size_t i = 0; i < krs_light_count(scene); i++)
        write_light(state, krs_light_name(scene, i), i);
    leave("]");
    write_sky(state);
    write_fog(state);
    leave("}");
}

void answer_view(const KrsScene *scene, KrsState *state)
{
    begin();
    ANSWER(write_view(state, scene));
}

/* ---- queries ---- */

static void write_hit(const KrsHit *hit)
{
    open_element();
    add_truth("hit", hit->hit);
    add_truth("unresolved", hit->unresolved);
    ADD_MEMBER(hit, t);
    ADD_MEMBER(hit, point);
    ADD_MEMBER(hit, distance);
    ADD_MEMBER(hit, normal);
#define KRS_IDENTITY(member, ...) add_number(#member, hit->member);
#include "krs/surface.def"
#define KRS_MATERIAL(member, ...) ADD_MEMBER(hit, member);
#include "krs/surface.def"
    leave("}");
}

static void write_hits(KrsStatus status, const KrsHit *hits, size_t count)
{
    enter("{");
    add_number("status", status);
    open_member("hits", "[");
    for (size_t i = 0; i < count && status == KRS_OK; i++)
        write_hit(&hits[i]);
    leave("]");
    leave("}");
}

void answer_hits(KrsStatus status, const KrsHit *hits, size_t count)
{
    begin();
    ANSWER(write_hits(status, hits, count));
}

static void write_mesh(KrsStatus status, const KrsMesh *mesh)
{
    enter("{");
    add_number("status", status);
    if (mesh) {
        add_number("vertices", (double)(uintptr_t)mesh->vertices);
        add_number("vertex_count", (double)mesh->vertex_count);
        add_number("triangles", (double)(uintptr_t)mesh->triangles);
        add_number("triangle_count", (double)mesh->triangle_count);
        add_number("error", mesh->error);
        add_number("unresolved", (double)mesh->unresolved);
        add_truth("estimate", mesh->estimate);
        add_truth("steps", mesh->steps);
    }
    leave("}");
}

void answer_mesh(KrsStatus status, const KrsMesh *mesh)
{
    begin();
    ANSWER(write_mesh(status, mesh));
}
