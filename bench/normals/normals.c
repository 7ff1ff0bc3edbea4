/*
 * normals.c: how well, and how fast, a normal is found.
 *
 * First the table of Ban and Valasek (2023, figure 5) in single precision on the device: the angle
 * between the true normal and what each stencil finds with steps of length r, and what derivatives
 * find, at points of a picture of each surface.  Then pictures: what the phase of normals takes by
 * each, and how far from those by derivatives they are.  bench/normals/README.md says what columns mean.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench/measure.h"
#include "bench/sheet.h"
#include "bench/fixture.h"
#include "krs/vulkan.h"
#include "runtime/shaders/stencil.h"

enum { POINTS = 2000, WIDTH = 640, HEIGHT = 360, PIXELS = WIDTH * HEIGHT, REPEATS = 5 };

static const double reaches[] = {1e-5, 5e-5, 2e-4, 5e-4, 1e-3, 2e-3, 5e-3, 2e-2};
enum { REACHES = sizeof reaches / sizeof *reaches };

static Sheet sheet;

static KrsPicture *shoot(const Fixture *fixture, KrsNormals normals, double error, bool plain)
{
    return fixture_render(fixture, &(KrsRenderOptions){.width             = WIDTH,
                                                       .height            = HEIGHT,
                                                       .error             = error,
                                                       .methods.normals   = normals,
                                                       .methods.no_filter = plain});
}

/* Degrees. */
static double angle(const double a[3], const double b[3])
{
    double square = 0, dot = 0;
    for (int i = 0; i < 3; i++) {
        int k = (i + 1) % 3, m = (i + 2) % 3;
        square += (a[k] * b[m] - a[m] * b[k]) * (a[k] * b[m] - a[m] * b[k]);
        dot += a[i] * b[i];
    }
    return atan2(sqrt(square), dot) * 180 / acos(-1);
}

/* ---- surfaces whose normals are known ---- */

typedef void Truth(const double p[3], double n[3]);

/* length([length([x, z]) - 1, y]) - 0.35 + 0.03 sin(9 x) sin(9 y) sin(9 z) */
static void bumpy_normal(const double p[3], double n[3])
{
    double distance = hypot(p[0], p[2]), size = hypot(distance - 1, p[1]);
    double s[3], c[3];
    for (int i = 0; i < 3; i++) {
        s[i] = sin(9 * p[i]);
        c[i] = cos(9 * p[i]);
    }
    n[0] = p[0] / distance * (distance - 1) / size + 0.27 * c[0] * s[1] * s[2];
    n[1] = p[1] / size + 0.27 * s[0] * c[1] * s[2];
    n[2] = p[2] / distance * (distance - 1) / size + 0.27 * s[0] * s[1] * c[2];
}

/* (1 + 2 g) (r^2 - 1)^2 = 4 (h x^2 - y^2) (h y^2 - z^2) (h z^2 - x^2), h = g^2, g golden */
static void barth_normal(const double p[3], double n[3])
{
    const double g = (1 + sqrt(5)) / 2, h = g * g;
    double       s[3] = {p[0] * p[0], p[1] * p[1], p[2] * p[2]};
    double       a = h * s[0] - s[1], b = h * s[1] - s[2], c = h * s[2] - s[0];
    double       ball = 4 * (1 + 2 * g) * (s[0] + s[1] + s[2] - 1);
    n[0]              = p[0] * (ball - 8 * (h * b * c - a * b));
    n[1]              = p[1] * (ball - 8 * (h * a * c - b * c));
    n[2]              = p[2] * (ball - 8 * (h * a * b - a * c));
}

static const struct Surface {
    const char *name, *text;
    Truth      *truth;
    double      radius; /* farther out it is something else */
} surfaces[] = {
    {"a torus with bumps",
     "camera { eye: [1.2, 3, 3.2], fov: 35deg }"
     "show field(length([length([x, z]) - 1, y]) - 0.35 + "
     "0.03 * sin(9 * x) * sin(9 * y) * sin(9 * z));",
     bumpy_normal, 10},
    {"Barth's sextic",
     "use \"std/surfaces.krs\"; camera { eye: [3, 2.5, 5.5], fov: 40deg } show barth_sextic();",
     barth_normal, 2.19},
};
enum { SURFACES = sizeof surfaces / sizeof *surfaces };

/* ---- the table of angles ---- */

typedef struct Sight {
    float  point[3];
    double normal[3]; /* by derivatives on the device */
} Sight;

/* So many of the picture's hits, spread over all of it. */
static size_t choose_sights(const Fixture *fixture, const struct Surface *surface, Sight *sights)
{
    KrsPicture *picture = shoot(fixture, KRS_NORMALS_ANALYTIC, 0.01, true);
    size_t      count   = 0;
    for (size_t k = 0; k < PIXELS && count < POINTS; k++) {
        size_t       i   = k * 100003 % PIXELS; /* a prime: every pixel once, far from the last */
        const float *p   = &picture->position[3 * i];
        double       out = sqrt((double)p[0] * p[0] + (double)p[1] * p[1] + (double)p[2] * p[2]);
        if (isinf(picture->depth[i]) || out > surface->radius)
            continue;
        for (int c = 0; c < 3; c++) {
            sights[count].point[c]  = p[c];
            sights[count].normal[c] = picture->normal[3 * i + c];
        }
        count++;
    }
    krs_picture_free(picture);
    return count;
}

/* Finds normals as the shader does: all in single precision. */
static void find_normals(const Fixture *fixture, KrsNormals normals, float reach,
                         const Sight *sights, size_t count, double (*found)[3])
{
    Stencil stencil   = find_stencil(normals);
    float(*points)[3] = malloc(count * stencil.taps * sizeof *points);
    float *distances  = malloc(count * stencil.taps * sizeof *distances);
    for (size_t i = 0; i < count * stencil.taps; i++) {
        vec3         v = stencil.corner((uint)(i % stencil.taps));
        const float *p = sights[i / stencil.taps].point;
        points[i][0]   = p[0] + reach * v.x;
        points[i][1]   = p[1] + reach * v.y;
        points[i][2]   = p[2] + reach * v.z;
    }
    if (krs_device_distance(fixture->rendering, fixture->state, (const float(*)[3])points,
                            count * stencil.taps, distances) != KRS_OK)
        give_up("cannot sample", krs_renderer_message(fixture->renderer));
    for (size_t i = 0; i < count; i++) {
        float sum[3] = {0};
        for (uint k = 0; k < stencil.taps; k++) {
            float d = distances[i * stencil.taps + k];
            vec3  v = stencil.corner(k);
            if (normals == KRS_NORMALS_FORWARD && k == 0)
                v = vec3(-1, -1, -1);
            sum[0] += d * v.x;
            sum[1] += d * v.y;
            sum[2] += d * v.z;
        }
        for (int c = 0; c < 3; c++)
            found[i][c] = sum[c];
    }
    free(points);
    free(distances);
}

typedef struct Error {
    double median, most;
} Error;

static Error error_of(Truth *truth, const Sight *sights, double (*found)[3], size_t count)
{
    double *angles = malloc(count * sizeof *angles);
    Error   error  = {0};
    for (size_t i = 0; i < count; i++) {
        double p[3] = {sights[i].point[0], sights[i].point[1], sights[i].point[2]}, n[3];
        truth(p, n);
        angles[i]  = angle(n, found ? found[i] : sights[i].normal);
        error.most = fmax(error.most, angles[i]);
    }
    error.median = count ? median(angles, count) : NAN;
    free(angles);
    return error;
}

static void print_stencil(const Fixture *fixture, const struct Surface *surface, KrsNormals normals,
                          const Sight *sights, size_t count)
{
    double(*found)[3] = malloc(count * sizeof *found);
    sheet_print(&sheet, "| %s | %u |", krs_normals_names[normals], find_stencil(normals).taps);
    double best = HUGE_VAL, at = 0;
    for (int i = 0; i < REACHES; i++) {
        find_normals(fixture, normals, (float)reaches[i], sights, count, found);
        Error error = error_of(surface->truth, sights, found, count);
        sheet_print(&sheet, " %.2g / %.2g |", error.median, error.most);
        if (error.median < best) {
            best = error.median;
            at   = reaches[i];
        }
    }
    sheet_print(&sheet, " %.2g at %.0e |\n", best, at);
    fflush(stdout);
    free(found);
}

static void print_angles(KrsRenderer *renderer, const struct Surface *surface)
{
    static Sight sights[POINTS];
    Fixture      fixture = fixture_open(renderer, surface->name, surface->text, true);
    size_t       count   = choose_sights(&fixture, surface, sights);
    sheet_print(&sheet,
                "\n%s, %zu points: median / largest angle in degrees, by the length of the"
                " steps\n\n"
                "| normals | taps |",
                surface->name, count);
    for (int i = 0; i < REACHES; i++)
        sheet_print(&sheet, " %.0e |", reaches[i]);
    sheet_print(&sheet, " least median |\n| --- | --- |");
    for (int i = 0; i <= REACHES; i++)
        sheet_print(&sheet, " --- |");
    sheet_print(&sheet, "\n");
    for (KrsNormals normals = KRS_NORMALS_FORWARD; normals < KRS_NORMALS_ANALYTIC; normals++)
        print_stencil(&fixture, surface, normals, sights, count);
    Error error = error_of(surface->truth, sights, NULL, count);
    sheet_print(&sheet, "| analytic | 0 |");
    for (int i = 0; i < REACHES; i++)
        sheet_print(&sheet, " |");
    sheet_print(&sheet, " %.2g / %.2g |\n", error.median, error.most);
    fixture_close(&fixture);
}

/* ---- pictures ---- */

static double difference(const KrsPicture *a, const KrsPicture *b)
{
    double *angles = malloc(PIXELS * sizeof *angles), n[2][3];
    size_t  count  = 0;
    for (size_t i = 0; i < PIXELS; i++) {
        if (isinf(a->depth[i]) || isinf(b->depth[i]))
            continue;
        for (int c = 0; c < 3; c++) {
            n[0][c] = a->normal[3 * i + c];
            n[1][c] = b->normal[3 * i + c];
        }
        angles[count++] = angle(n[0], n[1]);
    }
    double result = count ? median(angles, count) : NAN;
    free(angles);
    return result;
}

static void print_pictures(KrsRenderer *renderer, const char *name, const char *path,
                           const char *text)
{
    static double ms[KRS_NORMALS_COUNT][REPEATS], total[KRS_NORMALS_COUNT][REPEATS];
    Fixture       fixture = fixture_open(renderer, path, text, true);
    KrsPicture   *truth   = shoot(&fixture, KRS_NORMALS_ANALYTIC, 0, true);
    double        apart[KRS_NORMALS_COUNT];
    for (KrsNormals normals = KRS_NORMALS_FORWARD; normals < KRS_NORMALS_COUNT; normals++) {
        KrsPicture *picture = shoot(&fixture, normals, 0, true);
        apart[normals]      = difference(truth, picture);
        krs_picture_free(picture);
    }
    for (int repeat = 0; repeat < REPEATS; repeat++)
        for (KrsNormals normals = KRS_NORMALS_FORWARD; normals < KRS_NORMALS_COUNT; normals++) {
            KrsPicture *picture    = shoot(&fixture, normals, 0, false);
            ms[normals][repeat]    = picture->stats.phase_ms[KRS_PHASE_NORMALS];
            total[normals][repeat] = picture->stats.total_ms;
            krs_picture_free(picture);
        }
    for (KrsNormals normals = KRS_NORMALS_FORWARD; normals < KRS_NORMALS_COUNT; normals++)
        sheet_print(&sheet, "| %s | %s | %.2f | %.1f | %.2g |\n", name, krs_normals_names[normals],
                    median(ms[normals], REPEATS), median(total[normals], REPEATS), apart[normals]);
    fflush(stdout);
    krs_picture_free(truth);
    fixture_close(&fixture);
}

int main(void)
{
    KrsRenderer *renderer = device_open();
    sheet = sheet_open("normals", "How normals are found", "make bench-normals", renderer, false);
    for (int i = 0; i < SURFACES; i++)
        print_angles(renderer, &surfaces[i]);
    sheet_print(&sheet,
                "\nPictures of %dx%d, medians of %d in turns: milliseconds of the normals"
                " and of all, "
                "and the median\nangle in degrees between these normals and those by derivatives, "
                "without filtering\n\n"
                "| scene | normals | ms | total ms | apart |\n| --- | --- | --- | --- | --- |\n",
                WIDTH, HEIGHT, REPEATS);
    for (int i = 0; i < SURFACES; i++)
        print_pictures(renderer, surfaces[i].name, surfaces[i].name, surfaces[i].text);
    print_pictures(renderer, "flange", "bench/scenes/csg.krs", NULL);
    print_pictures(renderer, "mountains", "bench/scenes/terrain.krs", NULL);
    print_pictures(renderer, "tree, 28 levels", "bench/scenes/tree28.krs", NULL);
    sheet_close(&sheet);
    krs_renderer_free(renderer);
    return 0;
}
