/*
 * enhanced.c: the comparisons of "Enhanced Sphere Tracing" (Keinert et al. 2014): pictures with and
 * without each of its methods.
 *
 * Steps of 1.2 distances (3.1), starts by the distance at the hit (3.3), hits that are evened out
 * (3.4), and convex solids from the exit of a ball around them (3.5, convex.c).  Its choice of the
 * best point of a ray that ran out of steps (3.2) has no counterpart: such rays are counted here,
 * and there are none in these scenes.  bench/README.md says what the columns mean.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench/enhanced/convex.h"
#include "bench/measure.h"
#include "bench/sheet.h"
#include "bench/fixture.h"
#include "compiler/passes/compile.h"
#include "krs/vulkan.h"
#include "runtime/writer/png.h"

enum { WIDTH = 320, HEIGHT = 180, PIXELS = WIDTH * HEIGHT, REPEATS = 3, PATH_SAMPLES = 4 };

static Sheet sheet;

/* ---- steps of 1.2 distances, and starts by the distance ---- */

static const char *const scenes[] = {"examples/27-city.krs", "examples/35-jewel.krs",
                                     "examples/36-jewels.krs", "examples/38-dodecahedron.krs"};
enum { SCENES = sizeof scenes / sizeof *scenes };

/* Returns the least time of some pictures that all threads computed, and what the last one is. */
static KrsPicture *shoot(const Fixture *fixture, const KrsRenderOptions *options, double *least)
{
    KrsPicture *picture = NULL;
    *least              = INFINITY;
    for (int repeat = 0; repeat <= REPEATS; repeat++) { /* the first compiles */
        krs_picture_free(picture);
        double begun = cpu_ms();
        picture      = fixture_render(fixture, options);
        *least       = repeat > 0 ? fmin(*least, cpu_ms() - begun) : *least;
    }
    return picture;
}

static double mean_light(const KrsPicture *picture)
{
    double sum = 0;
    for (size_t i = 0; i < PIXELS; i++)
        sum += picture->color[4 * i + 1];
    return sum / PIXELS;
}

static KrsRenderOptions of_path(KrsTrace trace, KrsStarts starts)
{
    return (KrsRenderOptions){.width          = WIDTH,
                              .height         = HEIGHT,
                              .samples        = PATH_SAMPLES,
                              .integrator     = KRS_INTEGRATOR_PATH,
                              .aovs           = KRS_AOV_COLOR,
                              .methods.trace  = trace,
                              .methods.starts = starts};
}

static void compare_steps(const Fixture *fixture)
{
    static const KrsTrace methods[] = {KRS_TRACE_PLAIN, KRS_TRACE_RELAXED, KRS_TRACE_AUTO};
    for (size_t i = 0; i < sizeof methods / sizeof *methods; i++) {
        KrsRenderOptions primary = {.width            = WIDTH,
                                    .height           = HEIGHT,
                                    .samples          = 1,
                                    .methods.no_beams = true,
                                    .aovs             = KRS_AOV_DEPTH,
                                    .methods.trace    = methods[i],
                                    .methods.schedule = KRS_SCHEDULE_PIXEL};
        KrsRenderOptions paths   = of_path(methods[i], KRS_STARTS_PRECISION);
        double           first, all;
        KrsPicture *seen = shoot(fixture, &primary, &first), *lit = shoot(fixture, &paths, &all);
        sheet_print(&sheet, "| %s | %s | %.1f | %.0f | %.1f | %.0f | %llu |\n", fixture->name + 9,
                    krs_trace_names[methods[i]], seen->stats.evaluations_per_ray, first,
                    lit->stats.evaluations_per_ray, all,
                    (unsigned long long)(seen->stats.unresolved + lit->stats.unresolved));
        krs_picture_free(seen);
        krs_picture_free(lit);
    }
}

static void compare_starts(const Fixture *fixture)
{
    for (int starts = 0; starts < KRS_STARTS_COUNT; starts++) {
        KrsRenderOptions options = of_path(KRS_TRACE_DEFAULT, (KrsStarts)starts);
        double           all;
        KrsPicture      *lit = shoot(fixture, &options, &all);
        sheet_print(&sheet, "| %s | %s | %.1f | %.0f | %.4f |\n", fixture->name + 9,
                    krs_starts_names[starts], lit->stats.evaluations_per_ray, all, mean_light(lit));
        krs_picture_free(lit);
    }
}

static void compare(KrsRenderer *renderer, void (*by)(const Fixture *))
{
    for (int i = 0; i < SCENES; i++) {
        Fixture fixture = fixture_open(renderer, scenes[i], NULL, false);
        by(&fixture);
        fixture_close(&fixture);
    }
}

/* ---- a corner, which starts above the surface darken ---- */

static const char corner[] =
    "camera { eye: [0.6, 0.6, 0], target: [0, 0, 0], projection: \"orthographic\", height: 0.4 }\n"
    "light none { direction: [0, 1, 0], intensity: 0 }\n"
    "sky { zenith: white, horizon: white, ground: white }\n"
    "material plaster { color: [0.8, 0.8, 0.8], roughness: 1, specular: 0 }\n"
    "show (box([4, 1, 4]).move([0, -0.5, 0]) | box([1, 4, 4]).move([-0.5, 1.5, "
    "0])).paint(plaster);\n";

/* The mean light of the whole picture, this many pixels a side. */
static double corner_light(const Fixture *fixture, uint32_t side, KrsStarts starts)
{
    KrsRenderOptions options = {.width          = side,
                                .height         = side,
                                .samples        = 65536 * 16 / side / side,
                                .integrator     = KRS_INTEGRATOR_PATH,
                                .aovs           = KRS_AOV_COLOR,
                                .methods.starts = starts};
    KrsPicture      *picture = fixture_render(fixture, &options);
    double           sum     = 0;
    for (size_t i = 0; i < side * side; i++)
        sum += picture->color[4 * i + 1];
    krs_picture_free(picture);
    return sum / side / side;
}

static void compare_corners(KrsRenderer *renderer)
{
    static const uint32_t sides[] = {16, 32, 64};
    Fixture               fixture = fixture_open(renderer, "corner", corner, false);
    const double          truth   = corner_light(&fixture, 512, KRS_STARTS_DISTANCE);
    sheet_print(&sheet, "\n| a white corner, pixels a side | by pixels | by the distance |\n"
                        "| --- | --- | --- |\n");
    for (size_t i = 0; i < sizeof sides / sizeof *sides; i++)
        sheet_print(&sheet, "| %u | %+.2f %% | %+.2f %% |\n", sides[i],
                    100 * (corner_light(&fixture, sides[i], KRS_STARTS_PRECISION) / truth - 1),
                    100 * (corner_light(&fixture, sides[i], KRS_STARTS_DISTANCE) / truth - 1));
    fixture_close(&fixture);
}

/* ---- hits that are evened out ---- */

/* Rings and a bowl, whose marble shows where hits jump, as in figures 9 and 10. */
static const char   marbled[] = "use \"std/patterns.krs\";\n"
                                "camera { eye: [0, 2.6, 4], target: [0, 0.1, 0], fov: 40deg }\n"
                                "light sun { direction: [-1, 2, 1], intensity: 3 }\n"
                                "material stone { color: mix(#fff4e0, #401808, marble(6 * p, veins: "
                                "3, bend: 5)), roughness: 0.6 }\n"
                                "show union(torus(1.3, 0.35), sphere(0.8), blend: 0.4).displace(0.05 "
                                "* sin(9 * x) * sin(9 * y) * sin(9 * z))\n"
                                "    .paint(stone);\n";
static const double tangent   = 0.36397023426620236; /* of 20 degrees, half of the field of view */

/* The distances of all hits, in pixels; 0 where nothing is hit. */
static void find_distances(const Fixture *fixture, const KrsPicture *picture, double *distances)
{
    for (size_t i = 0; i < PIXELS; i++) {
        const float *at      = &picture->position[3 * i];
        const double p[1][3] = {{at[0], at[1], at[2]}};
        KrsHit       hit;
        distances[i] = 0;
        if (!isfinite(picture->depth[i]))
            continue;
        if (krs_probe(fixture->state, p, 1, &hit) != KRS_OK)
            give_up(fixture->name, "a distance cannot be found");
        distances[i] = hit.distance / (2 * tangent * picture->depth[i] / HEIGHT);
    }
}

typedef struct Evenness {
    double mean, largest, jump; /* of |f|, and of its difference from pixel to pixel */
} Evenness;

static Evenness find_evenness(const KrsPicture *picture, const double *distances)
{
    Evenness found = {0};
    size_t   hits = 0, pairs = 0;
    for (size_t i = 0; i + 1 < PIXELS; i++) {
        if (!isfinite(picture->depth[i]))
            continue;
        hits++;
        found.mean += fabs(distances[i]);
        found.largest = fmax(found.largest, fabs(distances[i]));
        if ((i + 1) % WIDTH == 0 || !isfinite(picture->depth[i + 1]))
            continue;
        pairs++;
        found.jump += fabs(distances[i] - distances[i + 1]);
    }
    found.mean /= (double)hits;
    found.jump /= (double)pairs;
    return found;
}

/* Figures 9 and 10 are above, 7 and 8 below. */
enum { SHOWN = 2, ACROSS = 2 * SHOWN, ROWS = 2 };
static uint8_t strip[3 * PIXELS * ACROSS * ROWS];

static void put(int place, int x, int y, const uint8_t *rgb)
{
    const size_t row = (size_t)(place / ACROSS * HEIGHT + y) * WIDTH * ACROSS;
    memcpy(&strip[3 * (row + (size_t)(place % ACROSS * WIDTH + x))], rgb, 3);
}

/* Figure 9: a pixel is white where the hit is a 20th of a pixel behind the surface, and black where it
   is as far before it; gray is none. */
static void put_distances(const double *distances, int place)
{
    for (int i = 0; i < PIXELS; i++) {
        double  level  = fmin(fmax(0.5 - 10 * distances[i], 0), 1);
        uint8_t gray   = (uint8_t)(255 * level + 0.5);
        uint8_t rgb[3] = {gray, gray, gray};
        put(place, i % WIDTH, i / WIDTH, rgb);
    }
}

static void put_picture(const Fixture *fixture, const KrsPicture *picture, int place)
{
    static uint8_t bytes[3 * PIXELS];
    if (krs_picture_to_srgb8(picture, fixture->scene, 0, 3, bytes) != KRS_OK)
        give_up(fixture->name, "the picture cannot be shown");
    for (int i = 0; i < PIXELS; i++)
        put(place, i % WIDTH, i / WIDTH, &bytes[3 * i]);
}

static void write_strip(const char *name)
{
    OutputError   error = {0};
    const Picture frame = {.width       = WIDTH * ACROSS,
                           .height      = HEIGHT * ROWS,
                           .crop_width  = WIDTH * ACROSS,
                           .crop_height = HEIGHT * ROWS};
    OutputFile   *file  = output_open(name, NULL, &error);
    if (!file || !png_write(&frame, strip, file, &error) || output_commit(file) != KRS_OK)
        give_up(name, error.message);
}

static void compare_hits(KrsRenderer *renderer)
{
    static const KrsTrace methods[]    = {KRS_TRACE_PLAIN, KRS_TRACE_RELAXED, KRS_TRACE_AUTO};
    static const double   errors[]     = {0.25, 4};
    static const uint32_t iterations[] = {0, 1, 3, 5};
    static double         distances[PIXELS];
    Fixture               fixture = fixture_open(renderer, "marbled", marbled, false);
    for (int m = 0; m < 3; m++)
        for (int e = 0; e < 2; e++)
            for (int i = 0; i < 4; i++) {
                KrsRenderOptions options = {.width             = WIDTH,
                                            .height            = HEIGHT,
                                            .samples           = 1,
                                            .no_occlusion      = true,
                                            .error             = errors[e],
                                            .methods.trace     = methods[m],
                                            .methods.even_hits = iterations[i]};
                double           all;
                KrsPicture      *picture = shoot(&fixture, &options, &all);
                find_distances(&fixture, picture, distances);
                Evenness found = find_evenness(picture, distances);
                sheet_print(&sheet, "| %s | %.2f | %u | %.5f | %.5f | %.4f | %.0f |\n",
                            krs_trace_names[methods[m]], errors[e], iterations[i], found.mean,
                            found.jump, found.largest, all);
                if (m == 2 && e == 1 && (i == 0 || i == 2)) {
                    put_distances(distances, i == 2);
                    put_picture(&fixture, picture, SHOWN + (i == 2));
                }
                krs_picture_free(picture);
            }
    fixture_close(&fixture);
}

/* ---- rays with few steps ---- */

/* Figure 7: the steps at which a ray of the city ends; white is the most. */
static void put_steps(const KrsPicture *picture, uint32_t most, int place)
{
    for (int i = 0; i < PIXELS; i++) {
        const uint8_t gray   = (uint8_t)(255 * fmin((double)picture->steps[i] / most, 1) + 0.5);
        const uint8_t rgb[3] = {gray, gray, gray};
        put(place, i % WIDTH, i / WIDTH, rgb);
    }
}

/* Figure 8: normals, as colours. */
static void put_normals(const KrsPicture *picture, int place)
{
    for (int i = 0; i < PIXELS; i++) {
        uint8_t rgb[3] = {0};
        for (int c = 0; c < 3 && isfinite(picture->depth[i]); c++)
            rgb[c] = (uint8_t)(127.5 + 127 * picture->normal[3 * i + c]);
        put(place, i % WIDTH, i / WIDTH, rgb);
    }
}

/* Rays of the city that end after few steps: by distances, by 1.2 of them, and as by default. */
static void compare_few_steps(KrsRenderer *renderer)
{
    enum { FEW = 80, FEWER = 64 };
    static const KrsTrace methods[] = {KRS_TRACE_PLAIN, KRS_TRACE_RELAXED, KRS_TRACE_AUTO};
    Fixture               fixture   = fixture_open(renderer, scenes[0], NULL, false);
    sheet_print(&sheet,
                "\n| %s, steps | rays not ended after %d | after %d |\n| --- | --- | --- |\n",
                scenes[0] + 9, FEW, FEWER);
    for (int i = 0; i < 3; i++) {
        KrsRenderOptions options  = {.width             = WIDTH,
                                     .height            = HEIGHT,
                                     .samples           = 1,
                                     .methods.no_beams  = true,
                                     .no_occlusion      = true,
                                     .methods.max_steps = FEW,
                                     .methods.trace     = methods[i]};
        KrsPicture      *few      = fixture_render(&fixture, &options);
        options.methods.max_steps = FEWER;
        KrsPicture *fewer         = fixture_render(&fixture, &options);
        sheet_print(&sheet, "| %s | %llu | %llu |\n", krs_trace_names[methods[i]],
                    (unsigned long long)few->stats.unresolved,
                    (unsigned long long)fewer->stats.unresolved);
        if (i < 2)
            put_steps(few, FEW, ACROSS + i);
        if (i != 1)
            put_normals(fewer, ACROSS + SHOWN + (i == 2));
        krs_picture_free(few);
        krs_picture_free(fewer);
    }
    fixture_close(&fixture);
}

static const char *base_name(const char *file)
{
    const char *slash = strrchr(file, '/');
    return slash ? slash + 1 : file;
}

/* enhanced [FILE.png] */
int main(int count, char **arguments)
{
    char name[256];
    spirv_start();
    KrsRenderer *renderer = device_open();
    sheet = sheet_open("enhanced", "Enhanced Sphere Tracing, with and without each of its methods",
                       "make bench-enhanced", renderer, count > 1);
    if (count > 1)
        snprintf(name, sizeof name, "%s", arguments[1]);
    else /* beside the table */
        snprintf(name, sizeof name, "%.*s.png", (int)(strlen(sheet.path) - 3), sheet.path);
    sheet_print(&sheet,
                "| %dx%d | steps | distances of a camera's ray | CPU ms | of a path | CPU ms, %d "
                "paths a pixel | unresolved |\n| --- | --- | --- | --- | --- | --- | --- |\n",
                WIDTH, HEIGHT, PATH_SAMPLES);
    compare(renderer, compare_steps);
    sheet_print(&sheet,
                "\n| %dx%d | starts | distances of a path | CPU ms | mean light |\n"
                "| --- | --- | --- | --- | --- |\n",
                WIDTH, HEIGHT);
    compare(renderer, compare_starts);
    compare_corners(renderer);
    sheet_print(&sheet,
                "\n| steps | permitted error | iterations | mean distance of hits, pixels | "
                "from pixel to pixel | largest | CPU ms |\n"
                "| --- | --- | --- | --- | --- | --- | --- |\n");
    compare_hits(renderer);
    compare_few_steps(renderer);
    sheet_print(&sheet,
                "\n![distances of hits without iterations and with 3, and the pictures; below, "
                "the city's steps by distances and by 1.2 of them, and its normals with few steps]"
                "(%s)\n\n",
                base_name(name));
    write_strip(name);
    compare_convex(&sheet);
    sheet_close(&sheet);
    krs_renderer_free(renderer);
    spirv_stop();
    return 0;
}
