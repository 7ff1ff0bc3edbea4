/*
 * open_surfaces.c: surfaces without thickness, `.within(region, open: true)`, against exact roots.
 *
 * Each is looked at from a view of its own.  formulas.h finds, in long double precision, where the
 * ray of every pixel first changes the sign of the formula within the ball, and the picture must
 * show that: no pixel more and none less but where a hair of the ray decides, or a twentieth of a
 * pixel at the rim of the ball; depths to a fiftieth of a pixel, and normals that are the formula's
 * gradient, towards the eye.  Questions to the host and to the device are held against the same
 * roots, and shadows on a floor against roots on the way to the light.  Each has one colour in front and
 * another behind: the sign of the formula before the root tells which a ray sees, at once or in a mirror.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "compiler/passes/compile.h"
#include "tests/oracle/exact.h"
#include "tests/oracle/formulas.h"
#include "tests/oracle/product.h"
#include "tests/support/renderer.h"

enum { WIDTH = 112, HEIGHT = 84, PIXELS = WIDTH * HEIGHT };

#define FOV   0.6981317007977318            /* 40 degrees */
#define PIXEL (2 * tan(0.5 * FOV) / HEIGHT) /* wide, at distance 1 */

static Real gyroid(const Real p[3])
{
    return sinl(4 * p[0]) * cosl(4 * p[1]) + sinl(4 * p[1]) * cosl(4 * p[2]) +
           sinl(4 * p[2]) * cosl(4 * p[0]);
}
static Real swell(const Real p[3]) { return expl(p[0]) + expl(2 * p[1]) + expl(-p[2]) * p[0] - 4; }
static Real cone(const Real p[3]) { return p[0] * p[0] + p[1] * p[1] - p[2] * p[2] - 0.1L; }
static Real waves(const Real p[3]) { return p[1] - 0.3L * sinl(3 * p[0]) * cosl(2 * p[2]); }

static const struct OpenSurface {
    const char *name;
    const char *text; /* without its region; NULL: one of the library's surfaces */
    Formula    *formula;
    double      radius;
    Vec         eye; /* the direction that it is seen from */
} open_surfaces[] = {
    {"clebsch", NULL, NULL, 0, {0.3, 0.5, 0.8}},
    {"cayley", NULL, NULL, 0, {-0.7, 0.2, 0.6}},
    {"ding_dong", NULL, NULL, 0, {0.9, 0.5, -0.2}},
    {"whitney_umbrella", NULL, NULL, 0, {0.5, -0.4, 0.7}},
    {"monkey_saddle", NULL, NULL, 0, {0.2, 0.3, -0.9}},
    {"tanglecube", NULL, NULL, 0, {0.6, 0.2, 0.5}},
    {"togliatti", NULL, NULL, 0, {-0.3, 0.8, 0.4}},
    {"barth_sextic", NULL, NULL, 0, {0.42, 0.31, 0.853}},
    {"labs_septic", NULL, NULL, 0, {-0.5, -0.6, 0.3}},
    {"a gyroid",
     "field(sin(4 * x) * cos(4 * y) + sin(4 * y) * cos(4 * z) + sin(4 * z) * cos(4 * x))",
     gyroid,
     1.2,
     {0.5, 0.6, 0.7}},
    {"a swell", "field(exp(x) + exp(2 * y) + exp(-z) * x - 4)", swell, 1.5, {-0.8, 0.7, 0.1}},
    {"waves", "field(y - 0.3 * sin(3 * x) * cos(2 * z))", waves, 1.5, {0.4, 0.5, 0.9}},
    {"a hyperboloid", "algebraic(x^2 + y^2 == z^2 + 0.1)", cone, 1.3, {0.9, 0.2, 0.4}},
};
enum { OPEN_SURFACES = sizeof open_surfaces / sizeof open_surfaces[0] };

#define SIDES "material sides { color: if front then [0.9, 0, 0] else [0, 0.9, 0] }\n"

typedef struct Case {
    Formula    *formula;
    double      radius;
    char        text[512]; /* the open surface */
    const char *before;
} Case;

static Case case_of(const struct OpenSurface *open_surface)
{
    Case c = {open_surface->formula, open_surface->radius, "", ""};
    if (open_surface->text) {
        snprintf(c.text, sizeof c.text, "%s.within(sphere(%g), open: true).paint(sides)",
                 open_surface->text, open_surface->radius);
        return c;
    }
    const Surface *surface = surface_named(open_surface->name);
    c.formula              = surface->formula;
    c.radius               = surface->radius;
    c.before               = surface->before;
    snprintf(c.text, sizeof c.text, "%sopen: true).paint(sides)", surface->call);
    return c;
}

/* ---- pictures and questions ---- */

static Line  rays[PIXELS];
static Entry entries[PIXELS];

static Vec look(const Case *c, const struct OpenSurface *open_surface)
{
    Vec  eye  = vec_scale(3.2 * c->radius, vec_unit(open_surface->eye));
    Lens lens = lens_make(eye, vec(0, 0, 0), tan(0.5 * FOV), false, WIDTH, HEIGHT);
    for (int k = 0; k < PIXELS; k++) {
        rays[k]    = lens_ray(&lens, k % WIDTH + 0.5, k / WIDTH + 0.5);
        entries[k] = surface_crossing(c->formula, c->radius, eye, rays[k].direction);
    }
    return eye;
}

typedef struct Verdict {
    int hits, doubtful, extra, missed, off, turned, confused;
} Verdict;

/* One ray's answer: whether it hits, how far away, its normal (NULL: not asked), and the colour. */
static void judge_ray(const Case *c, int k, bool seen, double t, const Vec *normal, Vec color,
                      double leeway, Verdict *v)
{
    const Entry *entry  = &entries[k];
    bool         is     = entry->fate == RAY_HITS;
    Chord        chord  = chord_of_ball(rays[k], vec(0, 0, 0), c->radius);
    double       inside = fmin((double)entry->t - chord.enter, chord.leave - (double)entry->t);
    if (entry->fate == RAY_DOUBTFUL || (is && inside < 0.05 * PIXEL * (double)entry->t)) {
        v->doubtful++;
        return;
    }
    v->hits += is;
    v->extra += seen && !is;
    v->missed += is && !seen;
    if (!is || !seen)
        return;
    Vec    p = line_at(rays[k], (double)entry->t), slope = surface_slope(c->formula, p);
    double size = vec_length(slope), cosine = vec_dot(slope, rays[k].direction) / size;
    if (!(fabs(cosine) > 0.05))
        return; /* it grazes, or the surface meets itself */
    v->confused += (color.x > 0.5) != (cosine < 0) || (color.y > 0.5) != (cosine > 0);
    v->off += !(fabs(t - (double)entry->t) <= leeway / fabs(cosine));
    if (normal)
        v->turned += !(-vec_dot(*normal, slope) * (cosine > 0 ? 1 : -1) > 0.99 * size);
}

static void must_be_right(const char *name, const char *who, const Verdict *v)
{
    if (v->hits < 400 || v->doubtful > PIXELS / 20 ||
        v->extra + v->missed + v->off + v->confused > 0 || v->turned * 100 > v->hits)
        fail_msg("%s, %s: of %d hits (%d doubtful) %d are too much, %d missed, %d off, %d with "
                 "another normal, %d of the wrong side",
                 name, who, v->hits, v->doubtful, v->extra, v->missed, v->off, v->turned,
                 v->confused);
}

static void judge_picture(const char *name, const Case *c, const Product *product, KrsTrace trace)
{
    KrsRenderOptions options = {.width         = WIDTH,
                                .height        = HEIGHT,
                                .samples       = 1,
                                .methods.trace = trace,
                                .aovs          = KRS_AOV_POSITION | KRS_AOV_IDS | KRS_AOV_NORMAL |
                                        KRS_AOV_ALBEDO};
    KrsRendering    *rendering;
    KrsPicture      *picture = NULL;
    Verdict          v       = {0};
    if (krs_rendering_new(renderer, product->scene, KRS_FOR_PICTURES, &rendering) != KRS_OK ||
        krs_render(rendering, product->state, &options, &picture) != KRS_OK)
        fail_msg("%s", krs_renderer_message(renderer));
    for (int k = 0; k < PIXELS; k++) {
        const float *at = &picture->position[3 * k], *n = &picture->normal[3 * k];
        const float *a      = &picture->albedo[3 * k];
        Vec          normal = vec(n[0], n[1], n[2]);
        double       t      = vec_distance(vec(at[0], at[1], at[2]), rays[k].origin);
        judge_ray(c, k, picture->component[k] != 0, t, &normal, vec(a[0], a[1], a[2]),
                  0.02 * PIXEL * t, &v);
    }
    assert_int_equal(picture->stats.unresolved, 0);
    must_be_right(name, krs_trace_names[trace], &v);
    krs_picture_free(picture);
    krs_rendering_free(rendering);
}

static void judge_questions(const char *name, const Case *c, const Product *product)
{
    static double origins[PIXELS][3], directions[PIXELS][3];
    static KrsHit hits[2][PIXELS];
    KrsRendering *rendering;
    for (int k = 0; k < PIXELS; k++)
        for (int i = 0; i < 3; i++) {
            origins[k][i]    = (&rays[k].origin.x)[i];
            directions[k][i] = (&rays[k].direction.x)[i];
        }
    const double(*from)[3]    = (const double(*)[3])origins,
          (*ray_direction)[3] = (const double(*)[3])directions;
    assert_int_equal(krs_raycast(product->state, from, ray_direction, PIXELS, 1e3, 0, hits[0]),
                     KRS_OK);
    assert_int_equal(krs_rendering_new(renderer, product->scene, KRS_FOR_QUESTIONS, &rendering),
                     KRS_OK);
    assert_int_equal(krs_device_raycast(rendering, product->state, from, ray_direction, PIXELS, 1e3,
                                        1e-3 * c->radius, hits[1]),
                     KRS_OK);
    krs_rendering_free(rendering);
    for (int device = 0; device < 2; device++) {
        Verdict v = {0};
        for (int k = 0; k < PIXELS; k++) {
            const KrsHit *hit    = &hits[device][k];
            Vec           normal = vec(hit->normal[0], hit->normal[1], hit->normal[2]);
            assert_false(hit->unresolved && entries[k].fate != RAY_DOUBTFUL);
            Vec color = vec(hit->color[0], hit->color[1], hit->color[2]);
            judge_ray(c, k, hit->hit, hit->t, &normal, color, (device ? 1e-3 : 1e-7) * c->radius,
                      &v);
        }
        must_be_right(name, device ? "asked on the device" : "asked on the host", &v);
    }
}

static void open_surfaces_are_where_signs_change(void **state)
{
    const struct OpenSurface *open_surface = *state;
    Case                      c            = case_of(open_surface);
    Vec                       eye          = look(&c, open_surface);
    Product                   product      = product_format("use \"std/surfaces.krs\";\n" SIDES
                                                            "%sshow %s;\ncamera { eye: [%.17g, "
                                                                                   "%.17g, %.17g], target: [0, 0, 0], fov: 40deg }",
                                                            c.before, c.text, eye.x, eye.y, eye.z);
    judge_picture(open_surface->name, &c, &product, KRS_TRACE_DEFAULT);
    if (open_surface == open_surfaces)
        for (KrsTrace trace = KRS_TRACE_PLAIN; trace < KRS_TRACE_COUNT; trace++)
            judge_picture(open_surface->name, &c, &product, trace);
    judge_questions(open_surface->name, &c, &product);
    product_free(&product);
}

/* ---- shadows ---- */

static void open_surfaces_cast_shadows(void **state)
{
    const struct OpenSurface *open_surface = *state;
    Case                      c            = case_of(open_surface);
    const Vec                 light        = {-0.35, 1, 0.25};
    double                    up           = 1.2 * c.radius;
    Vec                       eye = vec(0, 8 * c.radius, 8 * c.radius), target = vec(0, -up, 0);
    Lens                      lens    = lens_make(eye, target, 2 * c.radius, true, WIDTH, HEIGHT);
    Product                   product = product_format(
                          "use \"std/surfaces.krs\";\n" SIDES
                          "%slight red { direction: [-0.35, 1, 0.25], softness: 0, "
                                            "color: [1, 0, 0] }\n"
                                            "light green { direction: [-0.35, 1, 0.25], color: [0, 1, 0], shadow: false }\n"
                                            "sky { zenith: #000000, horizon: #000000, ground: #000000 }\nimage { tone_map: \"none\" }\n"
                                            "material white { color: [1, 1, 1], roughness: 1 }\n"
                                            "show plane([0, 1, 0], %.17g).paint(white);\nshow %s;\ncamera { eye: [0, %.17g, %.17g], "
                                            "target: [0, %.17g, 0], projection: \"orthographic\", height: %.17g }",
                          c.before, -up, c.text, eye.y, eye.z, -up, 4 * c.radius);
    KrsRenderOptions options = {.width = WIDTH, .height = HEIGHT, .samples = 1};
    KrsRendering    *rendering;
    KrsPicture      *picture = NULL;
    int              dark = 0, wrong = 0, edge = 0;
    bool             before = false;
    if (krs_rendering_new(renderer, product.scene, KRS_FOR_PICTURES, &rendering) != KRS_OK ||
        krs_render(rendering, product.state, &options, &picture) != KRS_OK)
        fail_msg("%s", krs_renderer_message(renderer));
    for (int k = 0; k < PIXELS; k++) {
        const float *color = &picture->color[4 * k];
        if (picture->component[k] != 1)
            continue;
        Line ray    = lens_ray(&lens, k % WIDTH + 0.5, k / WIDTH + 0.5);
        Vec  ground = line_at(ray, -(ray.origin.y + up) / ray.direction.y);
        ground.y += 0.125 * lens_pixel(&lens, 1); /* where a ray to a light starts */
        Entry entry  = surface_crossing(c.formula, c.radius, ground, vec_unit(light));
        bool  hidden = entry.fate == RAY_HITS;
        edge += hidden != before;
        before = hidden;
        dark += hidden;
        if (entry.fate != RAY_DOUBTFUL)
            wrong += hidden != (color[0] < 0.5F * color[1]);
    }
    if (dark < 200 || wrong * 20 > edge)
        fail_msg("%s: of %d pixels in its shadow, %d at an edge, %d are wrong", open_surface->name,
                 dark, edge, wrong);
    krs_picture_free(picture);
    krs_rendering_free(rendering);
    product_free(&product);
}

/* ---- sides ---- */

/* An open surface that shines, above a mirror, seen in the mirror alone. */
static void mirrors_show_the_side(void **state)
{
    const struct OpenSurface *open_surface = *state;
    Case                      c            = case_of(open_surface);
    const char *const         names[]      = {"preview", "direct", "path"};
    double                    down         = 1.5 * c.radius;
    Vec                       eye          = vec(0.4 * c.radius, 1.2 * c.radius, 5 * c.radius);
    Vec                       target       = vec(0, -down, 0.5 * c.radius);
    Lens                      lens = lens_make(eye, target, tan(0.5 * FOV), false, WIDTH, HEIGHT);
    Product                   product = product_format(
                          "use \"std/surfaces.krs\";\nmaterial sides { color: black, specular: 0, emission: if front "
                                            "then [1, 0, 0] else [0, 1, 0] }\n"
                                            "sky { zenith: #000000, horizon: #000000, ground: #000000 }\nimage { tone_map: \"none\" }\n"
                                            "material mirror { color: white, metallic: 1, roughness: 0 }\n"
                                            "%sshow plane([0, 1, 0], %.17g).paint(mirror);\nshow %s;\n"
                                            "camera { eye: [%.17g, %.17g, %.17g], target: [%.17g, %.17g, %.17g], fov: 40deg }",
                          c.before, -down, c.text, eye.x, eye.y, eye.z, target.x, target.y, target.z);
    for (KrsIntegrator integrator = 0; integrator < 3; integrator++) {
        KrsRenderOptions options = {
            .width = WIDTH, .height = HEIGHT, .samples = 1, .integrator = integrator};
        KrsRendering *rendering;
        KrsPicture   *picture = NULL;
        int           seen[2] = {0, 0}, wrong = 0;
        if (krs_rendering_new(renderer, product.scene,
                              integrator == 0 ? KRS_FOR_PICTURES : KRS_FOR_PATHS,
                              &rendering) != KRS_OK ||
            krs_render(rendering, product.state, &options, &picture) != KRS_OK)
            fail_msg("%s", krs_renderer_message(renderer));
        for (int k = 0; k < PIXELS; k++) {
            const float *color = &picture->color[4 * k];
            if (picture->component[k] != 1)
                continue;
            Line  ray    = lens_ray(&lens, k % WIDTH + 0.5, k / WIDTH + 0.5);
            Vec   mirror = line_at(ray, -(ray.origin.y + down) / ray.direction.y);
            Vec   way    = vec(ray.direction.x, -ray.direction.y, ray.direction.z);
            Entry entry  = surface_crossing(c.formula, c.radius, mirror, way);
            if (entry.fate != RAY_HITS)
                continue;
            Vec p         = vec_add(mirror, vec_scale((double)entry.t, way)),
                slope     = surface_slope(c.formula, p);
            double cosine = vec_dot(slope, way) / vec_length(slope);
            if (!(fabs(cosine) > 0.1) || vec_length(p) > 0.98 * c.radius)
                continue;
            seen[cosine > 0]++;
            wrong += (color[0] > 0.3F) != (cosine < 0) || (color[1] > 0.3F) != (cosine > 0);
        }
        if (seen[0] + seen[1] < 200 || wrong * 50 > seen[0] + seen[1])
            fail_msg("%s, %s: of %d and %d pixels of both sides, %d are wrong", open_surface->name,
                     names[integrator], seen[0], seen[1], wrong);
        krs_picture_free(picture);
        krs_rendering_free(rendering);
    }
    product_free(&product);
}

/* The side is that of the open surface itself, however it is placed, mirrored, joined and painted. */
static void sides_follow_the_open_surface(void **state)
{
    static const struct {
        const char *scene;
        Vec         origin, direction;
        bool        front;
    } rows[] = {
        {"show field(y).within(box([2, 2, 2]), open: true).paint(sides);",
         {0.2, 0.5, 0.1},
         {0, -1, 0},
         true},
        {"show field(y).within(box([2, 2, 2]), open: true).paint(sides);",
         {0.2, -0.5, 0.1},
         {0, 1, 0},
         false},
        {"show field(-y).within(box([2, 2, 2]), open: true).paint(sides);",
         {0.2, 0.5, 0.1},
         {0, -1, 0},
         false},
        {"show field(y).paint(sides).within(box([2, 2, 2]), open: true);",
         {0.2, 0.5, 0.1},
         {0, -1, 0},
         true},
        {"show field(y).paint(sides).within(box([2, 2, 2]), open: true);",
         {0.2, -0.5, 0.1},
         {0, 1, 0},
         false},
        {"show field(y).within(box([2, 2, 2]), open: true).rotate([0, 0, 1], 180deg).paint(sides);",
         {0.2, 0.5, 0.1},
         {0, -1, 0},
         false},
        {"show field(y).within(box([2, 2, 2]), open: true).paint(sides).rotate([0, 0, 1], "
         "180deg).move([0, 1, 0]);",
         {0.2, 1.5, 0.1},
         {0, -1, 0},
         false},
        {"show field(y - 2).within(box([2, 2, 2]).move([0, 2, 0]), open: true).mirror(plane([0, "
         "-1, "
         "0], 0)).paint(sides);",
         {0.2, -1.5, 0.1},
         {0, -1, 0},
         false},
        {"show field(y - 2).within(box([2, 2, 2]).move([0, 2, 0]), open: true).mirror(plane([0, "
         "-1, "
         "0], 0)).paint(sides);",
         {0.2, -2.5, 0.1},
         {0, 1, 0},
         true},
        {"show (field(y).within(box([2, 2, 2]), open: true) | sphere(0.2).move([0, 3, "
         "0])).paint(sides);",
         {0.2, -0.5, 0.1},
         {0, 1, 0},
         false},
        {"show (field(y).within(box([2, 2, 2]), open: true) | sphere(0.2).move([0, 3, "
         "0])).paint(sides);",
         {0, 2.5, 0},
         {0, 1, 0},
         true},
        {"show field(y).within(box([2, 2, 2]), open: true, thickness: "
         "0.2).offset(0.05).paint(sides);",
         {0.2, 0.5, 0.1},
         {0, -1, 0},
         true},
        {"show field(y).within(box([2, 2, 2]), open: true, thickness: "
         "0.2).offset(0.05).paint(sides);",
         {0.2, -0.5, 0.1},
         {0, 1, 0},
         false},
        {"show sphere(1).shell(0.1).paint(sides);", {0, 0, 0}, {0, 1, 0}, true},
        {"show sphere(1).paint(sides);", {0, 2, 0}, {0, -1, 0}, true},
        {"show sphere(1).paint(sides);", {0, 0.2, 0}, {0, -1, 0}, false},
        {"show sphere(1).scale([1, 2, 1]).paint(sides);", {0, 0.2, 0}, {0, -1, 0}, false},
        {"show union([sphere(0.4).paint(sides).move([i, 0, 0]) for i in 0..60]);",
         {7, 0.2, 0},
         {0, -1, 0},
         false},
        {"show union([sphere(0.4).paint(sides).move([i, 0, 0]) for i in 0..60]);",
         {7, 2, 0},
         {0, -1, 0},
         true},
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        Product       product = product_format(SIDES "%s", rows[i].scene);
        KrsRendering *rendering;
        KrsHit        hits[2];
        const double  origin[1][3] = {{rows[i].origin.x, rows[i].origin.y, rows[i].origin.z}};
        const double  way[1][3] = {{rows[i].direction.x, rows[i].direction.y, rows[i].direction.z}};
        assert_int_equal(krs_rendering_new(renderer, product.scene, KRS_FOR_QUESTIONS, &rendering),
                         KRS_OK);
        assert_int_equal(krs_raycast(product.state, origin, way, 1, 100, 1e-6, &hits[0]), KRS_OK);
        assert_int_equal(
            krs_device_raycast(rendering, product.state, origin, way, 1, 100, 1e-4, &hits[1]),
            KRS_OK);
        for (int device = 0; device < 2; device++)
            if (!hits[device].hit || (hits[device].color[0] > 0.5) != rows[i].front)
                fail_msg("%s, %s: the wrong side", rows[i].scene, device ? "device" : "host");
        krs_rendering_free(rendering);
        product_free(&product);
    }
}

/* Where a distance is needed, an open surface is as thick as its author says. */
static void thickness_is_given(void **state)
{
    Product thin  = product_compile("show field(y).within(box([2, 2, 2]), open: true);");
    Product thick = product_compile(
        "show field(y).within(box([2, 2, 2]), open: true, thickness: 0.2).offset(0.05);");
    (void)state;
    for (double y = -0.5; y < 0.51; y += 0.125) {
        KrsHit hit = product_raycast(&thick, vec(0.3, y < 0 ? -0.9 : 0.9, 0.2),
                                     vec(0, y < 0 ? 1 : -1, 0), 5, 1e-6);
        assert_true(hit.hit && fabs(fabs(hit.point[1]) - 0.15) < 1e-4);
        assert_true(fabs(product_distance(&thin, vec(0.3, y, 0.2)) - fabs(y)) < 1e-9);
    }
    product_free(&thin);
    product_free(&thick);
}

int main(void)
{
    product_wants_research();
    struct CMUnitTest tests[3 * OPEN_SURFACES + 2];
    static char       names[OPEN_SURFACES][2][80];
    size_t            count = 0;
    for (size_t i = 0; i < OPEN_SURFACES; i++) {
        void *open_surface = (void *)(uintptr_t)&open_surfaces[i];
        tests[count++]     = (struct CMUnitTest){
                open_surfaces[i].name, open_surfaces_are_where_signs_change, NULL, NULL, open_surface};
        if (i % 4 != 1)
            continue;
        snprintf(names[i][0], sizeof names[i][0], "the shadow of %s", open_surfaces[i].name);
        tests[count++] = (struct CMUnitTest){names[i][0], open_surfaces_cast_shadows, NULL, NULL,
                                             open_surface};
        if (i % 8 != 1)
            continue;
        snprintf(names[i][1], sizeof names[i][1], "the sides of %s", open_surfaces[i].name);
        tests[count++] = (struct CMUnitTest){names[i][1], mirrors_show_the_side, NULL, NULL,
                                             open_surface};
    }
    tests[count++] = (struct CMUnitTest)cmocka_unit_test(thickness_is_given);
    tests[count++] = (struct CMUnitTest)cmocka_unit_test(sides_follow_the_open_surface);
    return _cmocka_run_group_tests("sheets", tests, count, renderer_open, renderer_close);
}
