/*
 * handwritten.c: runs the shaders of bench/handwritten.  One dispatch draws the picture, as the
 * fragments of one rectangle would.
 */
#include "bench/handwritten.h"

#include <math.h>

enum { TILE_SIDE = 8, MAX_STEPS = 1024 };

static void define_vector(Text *text, const char *name, const double v[3])
{
    text_format(text, "#define %s vec3(%.9g, %.9g, %.9g)\n", name, v[0], v[1], v[2]);
}

/* Returns what stands for view.glsl: literals throughout. */
static char *view_text(Bench *bench, const KrsView *view, double error, bool count)
{
    if (view->light_count != 1 || view->lights->positional ||
        view->camera.projection != KRS_PERSPECTIVE)
        fail("hand-written shaders have one directional light and a perspective camera");
    Text text = {.arena = bench->arena};
    text_format(&text, "#define WIDTH %u\n#define HEIGHT %u\n#define MAX_STEPS %d\n", bench->width,
                bench->height, MAX_STEPS);
    text_format(&text, "#define ERROR %.9g\n#define FOV %.9g\n#define SUN_SOFTNESS %.9g\n", error,
                view->camera.fov, view->lights->softness);
    define_vector(&text, "EYE", view->camera.eye);
    define_vector(&text, "TARGET", view->camera.target);
    define_vector(&text, "SUN_DIRECTION", view->lights->vector);
    define_vector(&text, "SUN_COLOR", view->lights->color);
    define_vector(&text, "ZENITH", view->sky.zenith);
    define_vector(&text, "HORIZON", view->sky.horizon);
    define_vector(&text, "GROUND", view->sky.ground);
    if (count)
        text_add(&text, "#define COUNT_STEPS\n");
    return text.bytes;
}

static void compile(Bench *bench, BenchShader *shader, const char *path, const char *view,
                    const Buffer *picture)
{
    char *text = bench_shader_text(bench, path, (StandIn[]){{"view.glsl", view}, {0}});
    bench_shader_create(bench, shader, text, path, picture);
}

static uint64_t picture_bytes(const Bench *bench)
{
    return (uint64_t)bench->width * bench->height * sizeof(float[4]);
}

void handwritten_create(Bench *bench, Handwritten *written, const char *path, const KrsView *view,
                        double error)
{
    *written       = (Handwritten){.error = error};
    uint64_t bytes = picture_bytes(bench);
    if (!buffer_create(&bench->gpu, &written->picture, bytes, ON_DEVICE, "picture") ||
        !buffer_create(&bench->gpu, &written->fetched, bytes, SHARED, "picture to read"))
        fail("%s", bench->gpu.message);
    compile(bench, &written->shader, path, view_text(bench, view, error, false), &written->picture);
}

void handwritten_destroy(Bench *bench, Handwritten *written)
{
    bench_shader_destroy(bench, &written->shader);
    buffer_destroy(&bench->gpu, &written->picture);
    buffer_destroy(&bench->gpu, &written->fetched);
}

/* The picture in memory of the host. */
static const float (*fetch(Bench *bench, const Handwritten *written))[4]
{
    double ms = 0; /* as with ours, copying is no phase */
    if (!gpu_begin(&bench->gpu))
        fail("%s", bench->gpu.message);
    gpu_copy(&bench->gpu, &written->picture, 0, &written->fetched, 0, picture_bytes(bench));
    if (!gpu_finish(&bench->gpu, &ms))
        fail("%s", bench->gpu.message);
    return written->fetched.bytes;
}

static uint32_t group_count(const Bench *bench)
{
    uint32_t across = (bench->width + TILE_SIDE - 1) / TILE_SIDE;
    return across * ((bench->height + TILE_SIDE - 1) / TILE_SIDE);
}

/* Colour and depth, as tracer.glsl writes them: depth 0 is a miss. */
static void take_image(const Bench *bench, const float (*pixels)[4], Image *image)
{
    if (!image_create(image, bench->width, bench->height))
        fail("out of memory");
    for (size_t i = 0; i < (size_t)bench->width * bench->height; i++) {
        bool hit        = pixels[i][3] > 0;
        image->alpha[i] = hit;
        image->depth[i] = hit ? pixels[i][3] : INFINITY;
    }
}

Times handwritten_run(Bench *bench, const Handwritten *written, Image *image)
{
    double start = clock_ms(), used = cpu_ms();
    Times  times = {.total = bench_shader_run(bench, &written->shader, group_count(bench))};
    const float(*pixels)[4] = fetch(bench, written);
    times.wall              = clock_ms() - start;
    times.cpu               = cpu_ms() - used;
    if (image)
        take_image(bench, pixels, image);
    return times;
}

void handwritten_count(Bench *bench, Handwritten *written, const char *path, const KrsView *view)
{
    BenchShader shader;
    compile(bench, &shader, path, view_text(bench, view, written->error, true), &written->picture);
    bench_shader_run(bench, &shader, group_count(bench));
    bench_shader_destroy(bench, &shader);

    const float(*pixels)[4] = fetch(bench, written);
    size_t count            = (size_t)bench->width * bench->height;
    double steps            = 0;
    for (size_t i = 0; i < count; i++) {
        steps += pixels[i][0];
        written->unresolved += pixels[i][0] >= MAX_STEPS;
    }
    written->evaluations_per_ray = steps / (double)count;
}
