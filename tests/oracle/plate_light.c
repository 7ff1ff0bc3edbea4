/*
 * plate_light.c: what a scene and the plate of another renderer do to each other's light, held against
 * closed forms: what a ball mirrors of the plate, the shadow of the plate on it, and its image in a
 * glossy floor.  Last, a scene that is put together is held against the whole of it.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "tests/oracle/path_fixture.h"
#include "tests/support/renderer.h"

/* Both cameras look along -z.  The plate shows a floor, y = 0, a wall, z = 0, that ends at x = -1.5,
   and a strip before it. */
#define CAMERAS                                                                                   \
    "camera { eye: [0, 1.2, 5], target: [0, 1.2, 0], fov: 50deg }\n"                              \
    "camera flat { eye: [0, 1.2, 5], target: [0, 1.2, 0], projection: \"orthographic\", height: " \
    "4 }\n"
static const char ball_text[] = CAMERAS
    "param metal = 0 in [0, 1]; param glow = 0 in [0, 9]; param day = 0 in [0, 9]; param sunny = 0 "
    "in [0, 9];\n"
    "param shade = 1 in [0, 1]; param place = 0 in [0, 2];\n"
    "sky { zenith: [day, day, day], horizon: [day, day, day], ground: [day, day, day] }\n"
    "light sun { direction: [-0.35, 0.1, -0.5], intensity: sunny }\n"
    "material skin { color: [shade, shade, shade], metallic: metal, roughness: 0, specular: 0,\n"
    "                emission: [glow, glow, glow] }\n"
    "show sphere(0.6).move([0.3, 1, place]).paint(skin);\n";
static double       middle[3] = {0.3, 1, 0};
static const double eye[3]    = {0, 1.2, 5};
#define RADIUS 0.6
#define DAY    0.125 /* a power of two */
enum { ACROSS = 240, DOWN = 160, PIXELS = ACROSS * DOWN };

typedef enum Surface { SKY, FLOOR, WALL, STRIP, SURFACES } Surface;

typedef struct Ray {
    double origin[3], direction[3];
} Ray;

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void go(const Ray *ray, double t, double point[3])
{
    for (int i = 0; i < 3; i++)
        point[i] = ray->origin[i] + t * ray->direction[i];
}

/* Returns the ray through a place of the picture, in pixels; depths count along it. */
static Ray ray_of(int camera, double x, double y)
{
    const double half  = camera == 0 ? tan(25 * M_PI / 180) : 2;
    const double right = (2 * x / ACROSS - 1) * half * ACROSS / DOWN,
                 up    = (1 - 2 * y / DOWN) * half;
    return camera == 0 ? (Ray){{eye[0], eye[1], eye[2]}, {right, up, -1}}
                       : (Ray){{eye[0] + right, eye[1] + up, eye[2]}, {0, 0, -1}};
}

static void place_of(int camera, const double point[3], double place[2])
{
    const double half = camera == 0 ? tan(25 * M_PI / 180) * (eye[2] - point[2]) : 2;
    place[0]          = ACROSS * (0.5 + 0.5 * (point[0] - eye[0]) / half * DOWN / ACROSS);
    place[1]          = DOWN * (0.5 - 0.5 * (point[1] - eye[1]) / half);
}

/* Returns the first surface of the plate that a ray meets from the front, beyond a distance. */
static Surface meet(const Ray *ray, double beyond, bool with_walls, double *t)
{
    static const double at[SURFACES] = {0, 0, 0, 0.8};
    Surface             met          = SKY;
    *t                               = HUGE_VAL;
    for (int s = FLOOR; s < (with_walls ? SURFACES : WALL); s++) {
        const int axis = s == FLOOR ? 1 : 2;
        double    own  = (at[s] - ray->origin[axis]) / ray->direction[axis], point[3];
        if (!(ray->direction[axis] < 0) || !(own > beyond) || !(own < *t))
            continue;
        go(ray, own, point);
        if (s == FLOOR
                ? point[2] < (with_walls ? 0 : -40)
                : point[1] < 0 || (s == WALL ? point[0] < -1.5 : fabs(point[0] + 0.6) > 0.25))
            continue;
        *t  = own;
        met = (Surface)s;
    }
    return met;
}

static void paint(Surface surface, const double p[3], double color[3])
{
    const double colors[SURFACES][3] = {
        {DAY, DAY, DAY},
        {0.5 + 0.3 * sin(1.3 * p[0]), 0.5 + 0.3 * sin(1.1 * p[2]), 0.75},
        {0.5 + 0.3 * sin(0.5 * p[0]), 0.5 + 0.3 * cos(0.6 * p[1]), 0.25},
        {0.875, 0.125, 0.25 + 0.125 * p[1]},
    };
    memcpy(color, colors[surface], sizeof colors[surface]);
}

/* Returns what a ray that leaves the scene sees: the first surface that it meets where the plate
   shows it. */
static Surface look(int camera, const Ray *ray, double color[3])
{
    double t = 1e-9, point[3] = {0}, place[2];
    for (Surface s; (s = meet(ray, t, true, &t)) != SKY;) {
        go(ray, t, point);
        place_of(camera, point, place);
        const Ray shows = ray_of(camera, place[0], place[1]);
        double    depth;
        if (point[2] < eye[2] && fabs(place[0] - 0.5 * ACROSS) < 0.5 * ACROSS - 0.5 &&
            fabs(place[1] - 0.5 * DOWN) < 0.5 * DOWN - 0.5 && meet(&shows, 0, true, &depth) == s &&
            fabs(depth - (eye[2] - point[2])) < 1e-6) {
            paint(s, point, color);
            return s;
        }
    }
    paint(SKY, point, color);
    return SKY;
}

/* Where a ray hits the ball, and the normal there. */
static bool hit(const Ray *ray, double point[3], double normal[3])
{
    double to[3];
    for (int i = 0; i < 3; i++)
        to[i] = middle[i] - ray->origin[i];
    const double size = dot(ray->direction, ray->direction), along = dot(to, ray->direction) / size;
    const double gap = along * along - (dot(to, to) - RADIUS * RADIUS) / size;
    if (gap < 0 || along < 0)
        return false;
    go(ray, along - sqrt(gap), point);
    for (int i = 0; i < 3; i++)
        normal[i] = (point[i] - middle[i]) / RADIUS;
    return true;
}

static void mirror(const double direction[3], const double normal[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = direction[i] - 2 * dot(direction, normal) * normal[i];
}

static float depth[PIXELS], plate[PIXELS][4];

static void make_plate(int camera, bool with_walls, double light)
{
    for (int k = 0; k < PIXELS; k++) {
        const Ray     ray = ray_of(camera, k % ACROSS + 0.5, k / ACROSS + 0.5);
        double        t, point[3] = {0}, color[3];
        const Surface s = meet(&ray, 0, with_walls, &t);
        if (s != SKY)
            go(&ray, t, point);
        paint(s, point, color);
        depth[k] = (float)t;
        for (int i = 0; i < 3; i++)
            plate[k][i] = (float)(light * color[i]);
        plate[k][3] = 1;
    }
}

static PathFixture fixture;

static int open_ball(void **state)
{
    if (renderer_open(state) != 0)
        return 1;
    fixture = path_fixture_open(ball_text);
    return 0;
}

static int close_ball(void **state)
{
    path_fixture_close(&fixture);
    return renderer_close(state);
}

static void set_ball(double place, double metal, double glow, double day, double sunny)
{
    middle[2] = place;
    path_fixture_set(&fixture, "place", place);
    path_fixture_set(&fixture, "metal", metal);
    path_fixture_set(&fixture, "glow", glow);
    path_fixture_set(&fixture, "day", day);
    path_fixture_set(&fixture, "sunny", sunny);
    path_fixture_set(&fixture, "shade", glow > 0 ? 0 : 1);
}

static KrsPicture *render(int camera, KrsIntegrator integrator, KrsCatcher catcher,
                          uint32_t samples)
{
    return path_fixture_render(&fixture, &(KrsRenderOptions){.width      = ACROSS,
                                                             .height     = DOWN,
                                                             .camera     = (size_t)camera,
                                                             .samples    = samples,
                                                             .integrator = integrator,
                                                             .depth      = depth,
                                                             .plate      = (const float(*)[4])plate,
                                                             .catcher    = catcher,
                                                             .catcher_reflectance = 0.25});
}

/* What the ball mirrors at places of a pixel, by four corners around it; false where they see different
   surfaces, or colours that are far apart. */
static bool find_mirrored(int camera, int pixel, Surface *surface, double color[3])
{
    for (int corner = 0; corner <= 4; corner++) {
        const double aside = corner < 4 ? 0.3 : 0, x = pixel % ACROSS + 0.5,
                     y = pixel / ACROSS + 0.5;
        const Ray ray  = ray_of(camera, x + (corner & 1 ? aside : -aside),
                                y + (corner & 2 ? aside : -aside));
        double    normal[3], seen[3], point[3];
        Ray       onward;
        if (!hit(&ray, point, normal))
            return false;
        memcpy(onward.origin, point, sizeof point);
        mirror(ray.direction, normal, onward.direction);
        const Surface own = look(camera, &onward, seen);
        for (int i = 0; i < 3 && corner > 0; i++)
            if (own != *surface || fabs(seen[i] - color[i]) > 0.1)
                return false;
        *surface = own;
        memcpy(color, seen, sizeof seen);
    }
    return true;
}

static void balls_mirror_the_plate(void **state)
{
    static const int           least[SURFACES] = {100, 40, 8, 8};
    static const KrsIntegrator ways[]          = {KRS_INTEGRATOR_PATH, KRS_INTEGRATOR_DIRECT,
                                                  KRS_INTEGRATOR_PREVIEW};
    (void)state;
    set_ball(1.8, 1, 0, DAY, 0);
    for (int camera = 0; camera < 2; camera++)
        for (size_t way = 0; way < sizeof ways / sizeof *ways; way++) {
            int count[SURFACES] = {0}, bad = 0;
            make_plate(camera, true, 1);
            KrsPicture *seen = render(camera, ways[way], KRS_CATCHER_SHADOWS, 1);
            for (int k = 0; k < PIXELS; k++) {
                Surface surface = SKY;
                double  color[3];
                if (!find_mirrored(camera, k, &surface, color))
                    continue;
                count[surface]++;
                for (int i = 0; i < 3; i++)
                    bad += fabs((double)seen->color[4 * k + i] - color[i]) > 0.03;
            }
            print_message("# camera %d, way %zu: sky %d, floor %d, wall %d, strip %d; %d are off\n",
                          camera, way, count[SKY], count[FLOOR], count[WALL], count[STRIP], bad);
            for (int s = 0; s < SURFACES; s++)
                assert_true(count[s] >= (camera == 1 && s == FLOOR ? 0 : least[s]));
            assert_true(bad <= 2);
            krs_picture_free(seen);
        }
}

/* For how many of five rays beside each other the plate is before the sun; -1: no ball is there. */
static int count_hidden(int camera, int pixel)
{
    const Ray ray = ray_of(camera, pixel % ACROSS + 0.5, pixel / ACROSS + 0.5);
    double    point[3], normal[3], color[3];
    int       hidden = 0;
    if (!hit(&ray, point, normal))
        return -1;
    for (int corner = 0; corner <= 4; corner++) {
        const double aside  = corner < 4 ? 0.06 : 0; /* two pixels of the wall */
        const Ray    onward = {{point[0] + (corner & 1 ? aside : -aside),
                                point[1] + (corner & 2 ? aside : -aside), point[2]},
                               {-0.35, 0.1, -0.5}};
        hidden += look(camera, &onward, color) != SKY;
    }
    return hidden;
}

/* What the sun sends to the ball, but for where the wall is before it, as far as the plate shows that. */
static void the_plate_casts_shadows(void **state)
{
    (void)state;
    set_ball(1.8, 0, 0, 0, 2);
    for (int camera = 0; camera < 2; camera++) {
        int lit = 0, dark = 0, bad = 0;
        make_plate(camera, true, 0);
        KrsPicture *seen  = render(camera, KRS_INTEGRATOR_DIRECT, KRS_CATCHER_SHADOWS, 1);
        KrsPicture *alone = render(camera, KRS_INTEGRATOR_DIRECT, KRS_CATCHER_NONE, 1);
        for (int k = 0; k < PIXELS; k++) {
            const int hidden = count_hidden(camera, k);
            if (alone->color[4 * k] <= 0 || (hidden != 0 && hidden != 5))
                continue;
            *(hidden ? &dark : &lit) += 1;
            bad += seen->color[4 * k] != (hidden ? 0 : alone->color[4 * k]);
        }
        print_message("# camera %d: %d lit, %d dark, %d are off\n", camera, lit, dark, bad);
        assert_true(lit > 100 && dark > 20);
        assert_true(bad <= 1);
        krs_picture_free(seen);
        krs_picture_free(alone);
    }
}

/* A glossy floor mirrors the ball, by Schlick's term, in place of the sky. */
static double find_gloss(const Ray *ray, bool *certain, double *without)
{
    double        t, point[3], normal[3];
    const double  up[3] = {0, 1, 0};
    Ray           onward;
    const Surface s     = meet(ray, 0, false, &t);
    const double  low   = -ray->direction[1] / sqrt(dot(ray->direction, ray->direction));
    const double  share = 0.25 + 0.75 * pow(1 - low, 5);
    *certain            = s == FLOOR && !hit(ray, point, normal);
    if (!*certain)
        return 0;
    go(ray, t, onward.origin);
    mirror(ray->direction, up, onward.direction);
    *without = share * DAY;
    return hit(&onward, point, normal) ? share * 2 : *without;
}

static void glossy_floors_mirror_balls(void **state)
{
    (void)state;
    set_ball(0.5, 0, 2, DAY, 0);
    make_plate(0, false, 1);
    for (int way = 0; way < 2; way++) {
        int         inside = 0, outside = 0, bad = 0;
        KrsPicture *seen = render(0, way ? KRS_INTEGRATOR_PATH : KRS_INTEGRATOR_DIRECT,
                                  KRS_CATCHER_GLOSSY, 64);
        for (int k = 0; k < PIXELS; k++) {
            bool   certain = true;
            double with = 0, without = 0;
            for (int corner = 0; corner <= 4; corner++) {
                const double aside = corner < 4 ? 1.5 : 0;
                const Ray    ray   = ray_of(0, k % ACROSS + 0.5 + (corner & 1 ? aside : -aside),
                                            k / ACROSS + 0.5 + (corner & 2 ? aside : -aside));
                bool         own;
                const double found = find_gloss(&ray, &own, &without);
                certain            = certain && own && (corner == 0 || fabs(found - with) < 0.2);
                with               = found;
            }
            if (!certain)
                continue;
            *(with > without ? &inside : &outside) += 1;
            for (int i = 0; i < 3; i++) {
                const double caught   = (double)seen->caught[k][i],
                             expected = with - caught * without;
                const double shown    = caught * (double)plate[k][i] + expected;
                bad += fabs((double)seen->mirrored[k][i] - expected) > 0.02 + 0.02 * with;
                bad += fabs((double)seen->color[4 * k + i] - shown) > 0.02 + 0.02 * with;
            }
        }
        print_message("# way %d: %d inside of the image, %d outside, %d are off\n", way, inside,
                      outside, bad);
        assert_true(inside > 60 && outside > 500);
        assert_int_equal(bad, 0);
        krs_picture_free(seen);
    }
}

/* ---- a whole scene, and the same put together ---- */

/* Mostly by the sun: what the scene sees of a plate does not know of the scene's shadows on it, so below a sky
   alone the ball would be 7 % brighter. */
#define DAYLIGHT                                                                                  \
    "sky { zenith: [0.5, 0.7, 1], horizon: [0.9, 0.9, 0.9], ground: [0.3, 0.3, 0.3] }\n"          \
    "light sun { direction: [-0.5, 1, 0.6], color: [1, 0.948, 0.862], intensity: 2.9, softness: " \
    "0.02 }\n"
#define GROUND                                                                \
    "material ground { color: [0.3, 0.2, 0.1], roughness: 0.25, ior: 1.8 }\n" \
    "show plane([0, 1, 0], 0).paint(ground);\n"                               \
    "show box([5, 3, 0.2]).move([0.5, 1.5, -2]).paint([0.7, 0.5, 0.2]);\n"
#define BALL "show sphere(0.6).move([0.3, 1, 0.5]).paint([0.2, 0.6, 0.3]);\n"
enum { PICTURES = 8, WHOLE_SAMPLES = 16 };

static KrsPicture *render_part(const char *text, const KrsRenderOptions *options)
{
    PathFixture part    = path_fixture_open(text);
    KrsPicture *picture = path_fixture_render(&part, options);
    path_fixture_close(&part);
    return picture;
}

/* The image of the ball in the floor, its shadow, the ball, and the wall. */
static const Region regions[] = {
    {0.5, 0.9, 0.59, 0.97}, {0.5, 0.75, 0.59, 0.8}, {0.48, 0.5, 0.6, 0.6}, {0.2, 0.3, 0.35, 0.5}};

static void parts_make_the_whole(void **state)
{
    const KrsRenderOptions ground_options = {.width      = ACROSS,
                                             .height     = DOWN,
                                             .samples    = 256,
                                             .integrator = KRS_INTEGRATOR_PATH,
                                             .seed       = 99};
    Estimate               whole[4] = {{0}}, together[4] = {{0}};
    bool                   good = true;
    (void)state;
    KrsPicture *ground = render_part(CAMERAS DAYLIGHT GROUND, &ground_options);
    for (int seed = 0; seed < PICTURES; seed++) {
        KrsRenderOptions options    = {.width      = ACROSS,
                                       .height     = DOWN,
                                       .samples    = WHOLE_SAMPLES,
                                       .integrator = KRS_INTEGRATOR_PATH,
                                       .seed       = (uint64_t)seed + 1};
        KrsPicture      *all        = render_part(CAMERAS DAYLIGHT GROUND BALL, &options);
        options.depth               = ground->depth;
        options.plate               = (const float(*)[4])(const void *)ground->color;
        options.catcher             = KRS_CATCHER_GLOSSY;
        options.catcher_roughness   = 0.25;
        options.catcher_reflectance = pow(0.8 / 2.8, 2);
        KrsPicture *composed        = render_part(CAMERAS DAYLIGHT BALL, &options);
        for (int i = 0; i < 4; i++) {
            estimate_add(&whole[i], mean_of_region(all, regions[i], 1));
            estimate_add(&together[i], mean_of_region(composed, regions[i], 1));
        }
        krs_picture_free(all);
        krs_picture_free(composed);
    }
    for (int i = 0; i < 4; i++) {
        together[i].error = hypot(together[i].error, whole[i].error);
        print_message("# region %d: %.5f together, %.5f as a whole, +- %.5f\n", i, together[i].mean,
                      whole[i].mean, together[i].error);
        good = is_near(together[i], whole[i].mean, 0.03) && good;
    }
    krs_picture_free(ground);
    assert_true(good);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(balls_mirror_the_plate),
        cmocka_unit_test(the_plate_casts_shadows),
        cmocka_unit_test(glossy_floors_mirror_balls),
        cmocka_unit_test(parts_make_the_whole),
    };
    return cmocka_run_group_tests_name("plate_light", tests, open_ball, close_ball);
}
