/*
 * record.c: writes down what the tracer asks of a device for a picture, so that another device can do it again.
 *
 *     record FOLDER SCENE.krs preview|path SAMPLES WIDTH HEIGHT
 *
 * The linker puts functions of this file before those of runtime/device (tests.mk).  FOLDER gets commands.json, the bytes that
 * these name in data.bin, and the shaders as NUMBER.comp.  Numbers of objects are those of the driver.
 */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "krs/krs.h"
#include "runtime/device/sets.h"
#include "runtime/tracer/layouts.h"
#include "runtime/tracer/renderer.h"
#include "tests/support/device.h"

/* Blocks of work begin at multiples of so many bytes on every device of WebGPU. */
enum { UNIFORM_STEP = 256, MOST_BUFFERS = 64 };

/* A buffer that the host sees, with what was in it when the device saw it last. */
typedef struct Mapped {
    Handle               buffer;
    size_t               size;
    const unsigned char *bytes;
    unsigned char       *seen;
    bool                 is_result, copied; /* since the submission began */
} Mapped;

static FILE       *commands, *data;
static const char *folder, *separator = "";
static size_t      written;
static Mapped      mapped[MOST_BUFFERS];

static void give_up(const char *what)
{
    fprintf(stderr, "record: %s\n", what);
    exit(1);
}

__attribute__((format(printf, 1, 2))) static void say(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fputs(separator, commands);
    vfprintf(commands, format, arguments);
    va_end(arguments);
    separator = ",\n";
}

/* Adds bytes to the data; returns where they are. */
static size_t add_data(const void *bytes, size_t size)
{
    const size_t at = written;
    if (fwrite(bytes, 1, size, data) != size)
        give_up("data are not written");
    written += size;
    return at;
}

static Mapped *find_mapped(Handle buffer)
{
    for (int i = 0; i < MOST_BUFFERS; i++)
        if (mapped[i].buffer == buffer)
            return &mapped[i];
    return NULL;
}

/* ---- before the functions of runtime/device ---- */

#define BEFORE(type, name, ...)      \
    type __real_##name(__VA_ARGS__); \
    type __wrap_##name(__VA_ARGS__); \
    type __wrap_##name(__VA_ARGS__)

BEFORE(bool, layouts_create, KrsRenderer *renderer)
{
    renderer->gpu.limits.uniform_step = UNIFORM_STEP;
    renderer->gpu.sums_lanes          = false;
    return __real_layouts_create(renderer);
}

BEFORE(bool, buffer_create, Gpu *gpu, Buffer *buffer, uint64_t size, Where where, const char *name)
{
    if (!__real_buffer_create(gpu, buffer, size, where, name))
        return false;
    say("{\"op\": \"buffer\", \"id\": \"%" PRIx64 "\", \"size\": %" PRIu64 "}", buffer->buffer,
        size);
    Mapped *room = buffer->bytes ? find_mapped(0) : NULL;
    if (buffer->bytes && !room)
        give_up("too many buffers");
    if (room)
        *room = (Mapped){.buffer    = buffer->buffer,
                         .size      = size,
                         .bytes     = buffer->bytes,
                         .seen      = calloc(1, size),
                         .is_result = strcmp(name, "pixels to read") == 0};
    return true;
}

BEFORE(void, buffer_destroy, Gpu *gpu, Buffer *buffer)
{
    Mapped *known = buffer->buffer ? find_mapped(buffer->buffer) : NULL;
    if (known) {
        free(known->seen);
        *known = (Mapped){0};
    }
    __real_buffer_destroy(gpu, buffer);
}

BEFORE(void, set_bind, Gpu *gpu, Handle set, uint32_t binding, BindingKind kind,
       const Buffer *buffer)
{
    if (kind != BINDS_NOTHING)
        say("{\"op\": \"bind\", \"set\": \"%" PRIx64 "\", \"binding\": %u, \"id\": \"%" PRIx64
            "\"}",
            set, binding, buffer->buffer);
    __real_set_bind(gpu, set, binding, kind, buffer);
}

BEFORE(bool, shader_load_all, Gpu *gpu, const ShaderRequest *requests, const ShaderCode *codes,
       size_t count, Handle layout)
{
    static int number;
    if (!__real_shader_load_all(gpu, requests, codes, count, layout))
        return false;
    for (size_t i = 0; i < count; i++) {
        char  path[512], *text;
        FILE *file;
        if (codes[i].shared)
            continue;
        snprintf(path, sizeof path, "%s/%d.comp", folder, ++number);
        text = shader_text(gpu, &requests[i].source);
        file = fopen(path, "wb");
        if (!text || !file || fputs(text, file) < 0 || fclose(file) != 0)
            give_up("a shader is not written");
        gpu_release(gpu, text);
        say("{\"op\": \"shader\", \"id\": \"%" PRIx64 "\", \"file\": \"%d\", \"name\": \"%s\"}",
            requests[i].shader->pipeline, number, codes[i].file);
    }
    return true;
}

BEFORE(void, gpu_copy, Gpu *gpu, const Buffer *from, uint64_t from_at, const Buffer *to,
       uint64_t to_at, uint64_t bytes)
{
    Mapped *known = find_mapped(to->buffer);
    if (known)
        known->copied = true;
    say("{\"op\": \"copy\", \"from\": \"%" PRIx64 "\", \"from_at\": %" PRIu64 ", \"to\": \"%" PRIx64
        "\", \"to_at\": %" PRIu64 ", \"bytes\": %" PRIu64 "}",
        from->buffer, from_at, to->buffer, to_at, bytes);
    __real_gpu_copy(gpu, from, from_at, to, to_at, bytes);
}

BEFORE(void, gpu_fill, Gpu *gpu, const Buffer *buffer, uint64_t at, uint64_t bytes, uint32_t word)
{
    say("{\"op\": \"fill\", \"to\": \"%" PRIx64 "\", \"at\": %" PRIu64 ", \"bytes\": %" PRIu64
        ", \"word\": %u}",
        buffer->buffer, at, bytes, word);
    __real_gpu_fill(gpu, buffer, at, bytes, word);
}

BEFORE(void, gpu_write, Gpu *gpu, const Buffer *buffer, uint64_t at, const void *bytes,
       uint32_t length)
{
    say("{\"op\": \"write\", \"to\": \"%" PRIx64 "\", \"at\": %" PRIu64
        ", \"data\": %zu, \"bytes\": %u}",
        buffer->buffer, at, add_data(bytes, length), length);
    __real_gpu_write(gpu, buffer, at, bytes, length);
}

static void say_run(const char *op, const Run *run)
{
    say("{\"op\": \"%s\", \"shader\": \"%" PRIx64 "\", \"sets\": [\"%" PRIx64 "\", \"%" PRIx64
        "\"], \"work_at\": %u, ",
        op, run->pipeline, run->sets[0], run->sets[1], run->work_at);
}

BEFORE(void, gpu_dispatch, Gpu *gpu, const Run *run, uint32_t groups)
{
    say_run("run", run);
    fprintf(commands, "\"groups\": %u}", groups);
    __real_gpu_dispatch(gpu, run, groups);
}

BEFORE(void, gpu_dispatch_counted, Gpu *gpu, const Run *run, const Buffer *counts, uint64_t at)
{
    say_run("run", run);
    fprintf(commands, "\"counts\": \"%" PRIx64 "\", \"at\": %" PRIu64 "}", counts->buffer, at);
    __real_gpu_dispatch_counted(gpu, run, counts, at);
}

/* What the host has changed is seen by all commands of the submission. */
BEFORE(bool, gpu_finish, Gpu *gpu, double *ms)
{
    for (Mapped *m = mapped; m < mapped + MOST_BUFFERS; m++)
        if (m->buffer && memcmp(m->seen, m->bytes, m->size) != 0)
            say("{\"op\": \"host\", \"to\": \"%" PRIx64 "\", \"data\": %zu, \"bytes\": %zu}",
                m->buffer, add_data(m->bytes, m->size), m->size);
    say("{\"op\": \"submit\"}");
    const bool done = __real_gpu_finish(gpu, ms);
    for (Mapped *m = mapped; m < mapped + MOST_BUFFERS; m++)
        if (m->buffer) {
            memcpy(m->seen, m->bytes, m->size);
            if (m->is_result && m->copied)
                say("{\"op\": \"expect\", \"id\": \"%" PRIx64 "\", \"data\": %zu, \"bytes\": %zu}",
                    m->buffer, add_data(m->bytes, m->size), m->size);
            m->copied = false;
        }
    return done;
}

/* ---- a picture ---- */

static FILE *open_in_folder(const char *name)
{
    char path[512];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return fopen(path, "wb");
}

int main(int count, char **arguments)
{
    if (count != 7)
        return 2;
    folder                    = arguments[1];
    commands                  = open_in_folder("commands.json");
    data                      = open_in_folder("data.bin");
    const bool         paths  = strcmp(arguments[3], "path") == 0;
    KrsRendererOptions device = {.device = tested_device()};
    KrsRenderOptions options  = {.integrator = paths ? KRS_INTEGRATOR_PATH : KRS_INTEGRATOR_PREVIEW,
                                 .samples    = (uint32_t)atoi(arguments[4]),
                                 .width      = (uint32_t)atoi(arguments[5]),
                                 .height     = (uint32_t)atoi(arguments[6]),
                                 .slice_ms   = 1e6};
    KrsScene        *scene;
    KrsState        *state;
    KrsRenderer     *renderer;
    KrsRendering    *rendering;
    KrsPicture      *picture;
    if (!commands || !data)
        give_up("the folder cannot be written to");
    fputs("[", commands);
    if (krs_compile_file(arguments[2], NULL, &scene) != KRS_OK ||
        krs_state_new(scene, &state) != KRS_OK)
        give_up("the scene does not compile");
    if (renderer_new_emulating(&device, EMULATE_CARD | EMULATE_MIN_LIMITS, &renderer) != KRS_OK ||
        krs_rendering_new(renderer, scene, paths ? KRS_FOR_PATHS : KRS_FOR_PICTURES, &rendering) !=
            KRS_OK ||
        krs_render(rendering, state, &options, &picture) != KRS_OK)
        give_up(krs_renderer_message(renderer));
    say("{\"op\": \"picture\", \"pixels\": %u, \"samples\": %u}", picture->width * picture->height,
        picture->samples);
    fputs("]\n", commands);
    krs_picture_free(picture);
    krs_rendering_free(rendering);
    krs_renderer_free(renderer);
    krs_state_free(state);
    krs_scene_free(scene);
    return fclose(commands) != 0 || fclose(data) != 0;
}
