/*
 * distant.c: normals of pictures of surfaces far from the origin.
 *
 * The normal of each pixel is held against that of the same surface at the origin, where its ray
 * hits it in double precision.  Pixels count where the surface is seen to be even for a pixel to all
 * sides: they may be off by a degree, and by a part of what the surface turns within the pixel.  Of
 * all pixels, also at edges, about as many may be off by more than 18 degrees as in a picture of the
 * surface at the origin.  Surfaces stand 20 to a million units away and are a thousandth of a unit to
 * thirty units large, and pixels are those of pictures of 36 to 2,000 lines.  Cameras are near them, or in the origin
 * with a long lens.  Nor may a bound on a slope matter that is hundreds of times too large.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "tests/oracle/exact.h"
#include "tests/oracle/product.h"
#include "tests/support/renderer.h"

/* Shapes of size s at o. */
static const struct Form {
    const char *name, *text;
} forms[] = {
    {"a box without a ball", "(box([1, 1, 1]) - sphere(0.65)).scale(s).move(o)"},
    {"a blend", "union(box([1, 1, 1]), sphere(0.6).move([0.4, 0.4, 0.2]), torus(0.6, "
                "0.15).rotate([1, 0, 0], 40deg), blend: 0.2).scale(s).move(o)"},
    {"primitives", "(torus(0.7, 0.2) | cone(0.4, 0.9).move([0.1, 0.3, 0]) | ellipsoid([0.3, 0.9, "
                   "0.2]).rotate([0, 0, 1], 50deg)).scale(s).move(o)"},
    {"mirrors",
     "krs { kernel capsule([0, 0.9, 0], [0.1, 1.3, 0.1], radius: 0.08); reflect plane([0.8, 0.6, "
     "0], 0.5); kernel capsule([0, 0.5, 0], [0, 0.9, 0], radius: 0.12); reflect plane([-0.6, 0.2, "
     "0.7], 0.25); reflect plane([0, 0.1, -1], 0); kernel sphere(0.5); }.scale(s).move(o)"},
    {"mirrors of the world",
     "krs { kernel sphere(0.3 * s).move(o + s * [0.2, 0.8, 0.1]); reflect plane([0.8, 0.6, 0], 0.8 "
     "* o.x + 0.6 * o.y + 0.5 * s); kernel sphere(0.4 * s).move(o + s * [0.2, 0, 0]); reflect "
     "plane([0, 0, 1], o.z + 0.1 * s); kernel box(s * [1, 0.3, 0.4]).move(o); }"},
    {"an inversion", "(box([1, 1, 1]) - sphere(0.62)).move([0.2, 0.1, "
                     "1.6]).transform(invert(radius: 1.3)).move([0, 0, -0.8]).scale(s).move(o)"},
    {"a polynomial", "algebraic(x^4 + y^4 + z^4 == x^2 + y^2 + z^2 - 1 + 0.6).scale(s).move(o)"},
    {"a field",
     "field(y - 0.2 * sin(3 * x) * cos(2 * z)).within(box([1.6, 1.6, 1.6])).scale(s).move(o)"},
    {"a field of the world", "field((y - o.y) / s - 0.2 * sin(3 * (x - o.x) / s) * cos(2 * (z - "
                             "o.z) / s)).within(box([1.6, 1.6, 1.6] * s).move(o))"},
    {"a Julia set", "julia(c: [-0.2, 0.6, 0.2, 0.1], power: 3, iterations: 3).scale(s).move(o)"},
    {"a Mandelbulb", "mandelbulb(power: 8, iterations: 2).scale(s).move(o)"},
    {"a bent twist", "box([0.7, 1.6, 0.5]).round(0.05).twist([0, 1, 0], 0.8).bend([1, 0, 0], "
                     "0.4).scale(s).move(o)"},
    {"an instance group",
     "union([box([0.13, 0.1 + 0.001 * i, 0.2]).move([0.2 * (i % 10) - 0.9, 0.2 * "
     "floor(i / 10) - 0.9, 0.2 * sin(i)]) for i in 0..100]).scale(s).move(o)"},
    {"far members", "union([box([0.13, 0.1 + 0.001 * i, 0.2]).rotate([1, 0.3, 0], 0.1 * i).scale(s)"
                    ".move(o + s * [0.2 * (i % 10) - 0.9, 0.2 * floor(i / 10) - 0.9, 0.2 * sin(i)])"
                    " for i in 0..100])"},
    {"far members on a plane", "union([sphere(0.12 + 0.0003 * i).scale(s).move(o + s * [0.2 * (i % "
                               "10) - 0.9, 0.2 * floor(i / 10) - 0.9, 0]) for i in 0..100])"},
    {"far members on a diagonal",
     "union([sphere(0.05).scale(s).move(o + s * [0.02 * i - 1, 0.02 * i - 1, 0.02 * i - 1])"
     " | sphere(0.06).scale(s).move(o + s * [0.02 * i - 1, 0.3, 0.2]) for i in 0..100])"},
    {"far instances of a blend",
     "union([sphere(0.1 + 0.0003 * i).scale(s).move(o + s * [0.2 * (i % 10) - 0.9, 0.2 * floor(i / "
     "10) - 0.9, 0.2 * sin(i)]) for i in 0..100], blend: 0.15 * s)"},
    {"far members, turned about the origin",
     "union([box([0.13, 0.1 + 0.001 * i, 0.2]).scale(s).move([0.8 * o.x - 0.6 * o.z, o.y, 0.6 * "
     "o.x + "
     "0.8 * o.z] + s * [0.2 * (i % 10) - 0.9, 0.2 * floor(i / 10) - 0.9, 0.2 * sin(i)]) for i in "
     "0..100]).rotate([0, 1, 0], 36.86989764584402deg)"},
    {"a lattice", "sphere(0.17).repeat([0.45, 0.45, 0.5], [4, 4, 2]).scale(s).move(o)"},
    {"letters", "text(\"Rg\").extrude(0.3).scale(s).move(o)"},
    {"a hull", "hull([[0.8, 0.8, 0.8], [-0.8, -0.8, 0.8], [-0.8, 0.8, -0.8], [0.8, -0.8, -0.8], "
               "[0, 0.9, 0.2]]).scale(s).move(o)"},
    {"a tube", "tube(spline([[-0.9, -0.5, 0], [-0.3, 0.8, 0.4], [0.4, -0.7, -0.3], [0.9, 0.6, "
               "0.2]]), 0.12).scale(s).move(o)"},
    {"turns about the origin",
     "(box([1, 1, 1]) - sphere(0.65)).scale(s).rotate([0, 1, 0], 37deg).move([0.8 * o.x - 0.6 * "
     "o.z, o.y, 0.6 * o.x + 0.8 * o.z]).rotate([0, 1, 0], 36.86989764584402deg)"},
    {"zones of the scene",
     "(box([1, 1, 1]) | sphere(0.6).move([0.2, 0.5, 0.1])).scale(s).move(o);\n"
     "zone { center: o + s * [0.4, 0.4, 0.6], radius: 0.55 * s }\n"
     "zone { center: o + s * [-0.5, 0.1, 0.5], radius: 0.3 * s }\n"
     "show torus(0.7, 0.1).scale(s).move(o)"},
    {"a zone of the caller",
     "(box([1, 1, 1]) | sphere(0.6).move([0.2, 0.5, 0.1])).scale(s).move(o)"},
    {"a zone on a plane",
     "half_space([0.1, 1, 0.05], 0).move(o); show sphere(0.5 * s).move(o);\n"
     "zone { center: o + s * [0.5, 0.1, 0.9], radius: 0.4 * s } show box([s, s, s]).move(o)"},
    {"a cut by a zone as large as a plane",
     "(torus(0.7, 0.2) | box([0.5, 1, 0.5])).scale(s).move(o)"},
    {"a field with parameters", "field(abs(y) + (0.3 + 0.1 * (sin(o.x)^2 + cos(o.x)^2 - 1)) * "
                                "abs(x) - 0.5).within(box([1.6, 1.6, "
                                "1.6])).scale(s).move(o)"},
    {"a ball on a plane", "(half_space([0.1, 1, 0.05], 0).move(o) | sphere(0.5 * s).move(o))"},
    {"a turned outline", "polygon([[-0.9, -0.6], [0.8, -0.7], [0.3, 0.1], [0.7, 0.9], [-0.5, "
                         "0.6]]).revolve().rotate([1, 0, 0], 30deg).scale(s).move(o)"},
};
/* The zones of the caller that some have, in sizes from o. */
static const struct Zone {
    const char *form;
    double      ball[4];
} zones[] = {
    {"a zone of the caller", {0.4, 0.4, 0.6, 0.55}},
    {"a zone on a plane", {-0.3, 0.4, 0.9, 0.5}},
    {"a cut by a zone as large as a plane", {300, 400, 0, 499.9}},
};

enum { FORMS = sizeof forms / sizeof forms[0], FAR_MEMBERS = 13 };

enum { WIDTH = 64, HEIGHT = 36, PIXELS = WIDTH * HEIGHT, RAYS = 5, TRIALS = 4 };
enum { ASKED = 3 }; /* every third shape is looked at by questions to the device as well */
static const double FOV  = 0.66;
static const Vec    AWAY = {1.2, 1, 2};

static const double DEGREE = 0.017453292519943295, EVEN = 15, TURNS = 0.2, ACROSS = 18;
/* The most parts of pixels that are off and are not at the origin. */
static const double MAX_EVEN = 0.003, MAX_ACROSS = 0.005;

/* The part of a picture in its middle. */
typedef struct Shot {
    double   far, size;
    uint32_t lines;
    Vec      middle, away; /* the eye, from the middle, in sizes */
    double   fov;
} Shot;

static KrsWindow window_of(const Shot *shot, uint32_t *width)
{
    *width = shot->lines * WIDTH / HEIGHT;
    return (KrsWindow){(*width - WIDTH) / 2, (shot->lines - HEIGHT) / 2, WIDTH, HEIGHT};
}

static Vec normal_of(const KrsHit *hit)
{
    return vec(hit->normal[0], hit->normal[1], hit->normal[2]);
}

/* In degrees. */
static double angle(Vec a, Vec b)
{
    return atan2(vec_length(vec_cross(a, b)), vec_dot(a, b)) / DEGREE;
}

/* Sets the zone of the caller. */
static void set_zone(const struct Form *form, KrsState *state, double size, Vec middle)
{
    for (size_t i = 0; i < sizeof zones / sizeof *zones; i++) {
        const double *ball       = zones[i].ball;
        const double  zone[1][4] = {{middle.x + size * ball[0], middle.y + size * ball[1],
                                     middle.z + size * ball[2], size * ball[3]}};
        if (strcmp(zones[i].form, form->name) == 0)
            assert_int_equal(krs_state_set_zones(state, zone, 1), KRS_OK);
    }
}

/* What is hit at the origin by the ray of each pixel, and by those a pixel beside it. */
static void cast_rays(const struct Form *form, const Shot *shot, KrsHit *hits)
{
    static const double beside[RAYS][2] = {{0, 0}, {1, 1}, {-1, 1}, {1, -1}, {-1, -1}};
    static double       origins[RAYS * PIXELS][3], directions[RAYS * PIXELS][3];
    uint32_t            width;
    KrsWindow           window = window_of(shot, &width);
    Product product = product_format("let s = 1; let o = [0, 0, 0];\nshow %s;", form->text);
    Lens    lens    = lens_make(shot->away, vec(0, 0, 0), tan(shot->fov / 2), false, (int)width,
                                (int)shot->lines);
    for (int i = 0; i < RAYS * PIXELS; i++) {
        const double *place = beside[i % RAYS];
        int           pixel = i / RAYS;
        Line          ray   = lens_ray(&lens, window.x + pixel % WIDTH + 0.5 + place[0],
                                       window.y + pixel / WIDTH + 0.5 + place[1]);
        memcpy(origins[i], &ray.origin, sizeof origins[i]);
        memcpy(directions[i], &ray.direction, sizeof directions[i]);
    }
    set_zone(form, product.state, 1, vec(0, 0, 0));
    assert_int_equal(krs_raycast(product.state, (const double(*)[3])origins,
                                 (const double(*)[3])directions, RAYS * PIXELS, HUGE_VAL, 1e-7,
                                 hits),
                     KRS_OK);
    product_free(&product);
}

/* A form as a program: its size and place are parameters, so that it is compiled once; or, for a shot,
   numbers. */
typedef struct Subject {
    const struct Form *form;
    Product            product;
    KrsRendering      *rendering;
    bool               literal;
} Subject;

static Subject subject_new(const struct Form *form, const Shot *literal)
{
    char    numbers[400] = "param s = 1 in [1e-4, 1e4]; param o = [0, 0, 0]; param e = [1, 1, 1]; "
                           "param f = 1 in [1e-9, 3];";
    Subject subject      = {.form = form, .literal = literal};
    if (literal)
        snprintf(numbers, sizeof numbers,
                 "let s = %.17g; let o = [%.17g, %.17g, %.17g]; let e = [%.17g, %.17g, %.17g]; "
                 "let f = %.17g;",
                 literal->size, literal->middle.x, literal->middle.y, literal->middle.z,
                 literal->away.x, literal->away.y, literal->away.z, literal->fov);
    subject.product = product_format("%s\nshow %s;\n"
                                     "camera { eye: o + s * e, target: o, fov: f }\n",
                                     numbers, form->text);
    if (krs_rendering_new(renderer, subject.product.scene, KRS_FOR_PICTURES, &subject.rendering) !=
        KRS_OK)
        fail_msg("%s", krs_renderer_message(renderer));
    return subject;
}

static void subject_free(Subject *subject)
{
    krs_rendering_free(subject->rendering);
    product_free(&subject->product);
}

static KrsPicture *render(const Subject *subject, const Shot *shot, bool literal)
{
    uint32_t         width;
    KrsRenderOptions options  = {.crop    = window_of(shot, &width),
                                 .height  = shot->lines,
                                 .samples = 1,
                                 .aovs    = KRS_AOV_NORMAL};
    KrsPicture      *picture  = NULL;
    const double     middle[] = {shot->middle.x, shot->middle.y, shot->middle.z},
                 away[]       = {shot->away.x, shot->away.y, shot->away.z};
    options.width             = width;
    if (!literal) {
        assert_int_equal(krs_state_set(subject->product.state, "s", &shot->size, 1), KRS_OK);
        assert_int_equal(krs_state_set(subject->product.state, "o", middle, 3), KRS_OK);
        assert_int_equal(krs_state_set(subject->product.state, "e", away, 3), KRS_OK);
        assert_int_equal(krs_state_set(subject->product.state, "f", &shot->fov, 1), KRS_OK);
    }
    set_zone(subject->form, subject->product.state, shot->size, shot->middle);
    if (krs_render(subject->rendering, subject->product.state, &options, &picture) != KRS_OK)
        fail_msg("%s", krs_renderer_message(renderer));
    return picture;
}

/* Counts of a picture: pixels that hit, and of those that are off; likewise of even ones. */
typedef struct Counts {
    int    all, across, even, off;
    double worst; /* of even ones */
} Counts;

static void count_pixel(const KrsHit *hits, const float *seen, Counts *counts)
{
    Vec normal    = normal_of(&hits[0]),
        found     = vec((double)seen[0], (double)seen[1], (double)seen[2]);
    double spread = 0, off = vec_length(found) > 0.5 ? angle(normal, found) : 180;
    if (!hits[0].hit)
        return;
    for (int i = 1; i < RAYS; i++)
        spread = fmax(spread, hits[i].hit && fabs(hits[i].t - hits[0].t) < 0.3
                                  ? angle(normal, normal_of(&hits[i]))
                                  : 180);
    counts->all++;
    counts->across += off > ACROSS;
    if (spread > EVEN)
        return;
    off -= TURNS * spread;
    counts->even++;
    counts->off += off > 1;
    counts->worst = fmax(counts->worst, off);
}

/* Asks the rays in the middle of pixels, which the device answers, of the shape where the shot has
   it. */
static void ask_device(const Subject *subject, const Shot *shot, KrsHit *answers)
{
    static double origins[PIXELS][3], directions[PIXELS][3];
    uint32_t      width;
    KrsWindow     window   = window_of(shot, &width);
    const double  middle[] = {shot->middle.x, shot->middle.y, shot->middle.z};
    Lens          lens = lens_make(shot->away, vec(0, 0, 0), tan(shot->fov / 2), false, (int)width,
                                   (int)shot->lines);
    for (int i = 0; i < PIXELS; i++) {
        Line ray = lens_ray(&lens, window.x + i % WIDTH + 0.5, window.y + i / WIDTH + 0.5);
        Vec  eye = vec_add(shot->middle, vec_scale(shot->size, ray.origin));
        memcpy(origins[i], &eye, sizeof origins[i]);
        memcpy(directions[i], &ray.direction, sizeof directions[i]);
    }
    assert_int_equal(krs_state_set(subject->product.state, "s", &shot->size, 1), KRS_OK);
    assert_int_equal(krs_state_set(subject->product.state, "o", middle, 3), KRS_OK);
    set_zone(subject->form, subject->product.state, shot->size, shot->middle);
    if (krs_device_raycast(subject->rendering, subject->product.state, (const double(*)[3])origins,
                           (const double(*)[3])directions, PIXELS, HUGE_VAL, 0, answers) != KRS_OK)
        fail_msg("%s", krs_renderer_message(renderer));
}

static Shot random_shot(Random *random, int trial)
{
    static const uint32_t lines[TRIALS] = {60, 2000, 36, 120};
    Shot                  shot          = {.lines = lines[trial], .away = AWAY, .fov = FOV};
    shot.far                            = trial % 3 == 0 ? random_between(random, 50, 500)
                                                         : 20 * pow(10, random_between(random, 0, 4.7));
    shot.size   = trial % 3 == 0 ? 1 : pow(10, random_between(random, -3, 1.5));
    shot.middle = vec_scale(shot.far, random_unit(random));
    if (trial == TRIALS - 1) { /* from the origin, as large in the picture as in others */
        shot.far    = shot.size * pow(10, random_between(random, 0.7, 3.5));
        shot.middle = vec_scale(shot.far, random_unit(random));
        shot.away   = vec_scale(-1 / shot.size, shot.middle);
        shot.fov    = 2 * atan(tan(FOV / 2) * vec_length(AWAY) / vec_length(shot.away));
    }
    return shot;
}

static Counts count(const Subject *subject, const Shot *shot, bool literal, const KrsHit *hits)
{
    Counts      counts  = {0};
    KrsPicture *picture = render(subject, shot, literal);
    for (int i = 0; i < PIXELS; i++)
        count_pixel(&hits[RAYS * i], &picture->normal[3 * i], &counts);
    krs_picture_free(picture);
    return counts;
}

/* `origin` is the shape at the origin; NULL: none of its pixels are off. */
static void check(const struct Form *form, const Subject *subject, const Shot *shot,
                  const Subject *origin)
{
    static KrsHit hits[RAYS * PIXELS];
    Shot          there = {.size = 1, .lines = shot->lines, .away = shot->away, .fov = shot->fov};
    Counts        known = {0};
    cast_rays(form, shot, hits);
    if (origin)
        known = count(origin, &there, false, hits);
    Counts counts = count(subject, shot, subject->literal, hits);
    if (counts.off > known.off + MAX_EVEN * counts.even + 1 ||
        counts.across > known.across + MAX_ACROSS * counts.all + 2)
        fail_msg("%s of size %g, %g units away, %u lines: of %d even pixels %d are off by more "
                 "than a degree, by up to %.1f, and %d at the origin; of all %d by more than 18: "
                 "%d, and %d at the origin",
                 form->name, shot->size, shot->far, shot->lines, counts.even, counts.off,
                 counts.worst, known.off, counts.all, counts.across, known.across);
}

static void normals_are_right(void **state)
{
    const struct Form *form    = *state;
    Random             random  = {(uint64_t)(form - forms) + 1};
    Subject            subject = subject_new(form, NULL);
    for (int trial = 0; trial < TRIALS; trial++) {
        Shot shot = random_shot(&random, trial);
        check(form, &subject, &shot, &subject);
    }
    subject_free(&subject);
}

static Counts count_answers(const Subject *subject, const Shot *shot, const KrsHit *hits)
{
    static KrsHit answers[PIXELS];
    Counts        counts = {0};
    ask_device(subject, shot, answers);
    for (int i = 0; i < PIXELS; i++) {
        const double *normal  = answers[i].normal;
        const float   found[] = {(float)normal[0], (float)normal[1], (float)normal[2]};
        count_pixel(&hits[RAYS * i], found, &counts);
    }
    return counts;
}

/* Rays that the device answers; beside edges its taps, which know no pixels, see both sides. */
static void answers_are_right(void **state)
{
    static KrsHit      hits[RAYS * PIXELS];
    const struct Form *form    = *state;
    Random             random  = {(uint64_t)(form - forms) + 1};
    Subject            subject = subject_new(form, NULL);
    for (int trial = 0; trial < TRIALS; trial++) {
        Shot shot = random_shot(&random, trial), there = shot;
        there.size   = 1;
        there.middle = vec(0, 0, 0);
        cast_rays(form, &shot, hits);
        Counts known  = count_answers(&subject, &there, hits),
               counts = count_answers(&subject, &shot, hits);
        if (counts.off > known.off + MAX_EVEN * counts.even + 1)
            fail_msg(
                "%s of size %g, %g units away, as the device answers: of %d even rays %d are off "
                "by more than a degree, by up to %.1f, and %d at the origin",
                form->name, shot.size, shot.far, counts.even, counts.off, counts.worst, known.off);
    }
    subject_free(&subject);
}

/* The compiler finds that points may have to be camera-relative. */
static void numbers_do_as_well(void **state)
{
    (void)state;
    Random random = {99};
    for (int i = 0; i < 3; i++) {
        const struct Form *form    = &forms[i == 2 ? FAR_MEMBERS : 0];
        Shot               shot    = random_shot(&random, i);
        Subject            subject = subject_new(form, &shot), origin = subject_new(form, NULL);
        check(form, &subject, &shot, i == 2 ? &origin : NULL);
        subject_free(&subject);
        subject_free(&origin);
    }
}

/* Shapes whose slope is far below the one that the text allows, and the same where it is not. */
static const struct Form steep[][2] = {
    {{"edges of a wide range", "field(abs(y) + k * abs(x) - 0.5).within(box([1.6, 1.6, 1.6]))"
                               ".scale(s).move(o); param k = 0.3 in [0.3, 900]"},
     {"edges", "field(abs(y) + 0.3 * abs(x) - 0.5).within(box([1.6, 1.6, 1.6])).scale(s).move(o)"}},
    {{"waves of a wide range",
      "field(y - 0.2 * sin(3 * k * x) * cos(2 * z)).within(box([1.6, 1.6, 1.6])).scale(s).move(o); "
      "param k = 1 in [0.3, 3000]"},
     {"waves",
      "field(y - 0.2 * sin(3 * x) * cos(2 * z)).within(box([1.6, 1.6, 1.6])).scale(s).move(o)"}},
    {{"a distance of a wide range",
      "(w() & box([1.2, 1.2, 1.2])).scale(s).move(o); param k = 0.3 in [0.3, 900]; "
      "shape w() { distance: length(p) + k * x - 0.7 }"},
     {"a distance", "(w() & box([1.2, 1.2, 1.2])).scale(s).move(o); shape w() { distance: "
                    "length(p) + 0.3 * x - 0.7 }"}},
    {{"a slope that is claimed",
      "(w() & box([1.2, 1.2, 1.2])).scale(s).move(o); shape w() { slope: 400, distance: "
      "length(p) + 0.3 * x - 0.7 }"},
     {"a slope that is derived", "(w() & box([1.2, 1.2, 1.2])).scale(s).move(o); shape w() { "
                                 "distance: length(p) + 0.3 * x - 0.7 }"}},
};

enum { STEEP = sizeof steep / sizeof steep[0] };

static void steep_bounds_do_as_well(void **state)
{
    const struct Form *form    = *state;
    Random             random  = {(uint64_t)(form - steep[0]) + 1};
    Subject            subject = subject_new(form, NULL), origin = subject_new(form + 1, NULL);
    for (int trial = 0; trial < TRIALS; trial++) {
        Shot shot = random_shot(&random, trial);
        check(form, &subject, &shot, &origin);
    }
    subject_free(&subject);
    subject_free(&origin);
}

int main(void)
{
    struct CMUnitTest tests[2 * FORMS + STEEP + 1];
    size_t            count = 0;
    for (size_t i = 0; i < FORMS; i++)
        tests[count++] = (struct CMUnitTest){forms[i].name, normals_are_right, NULL, NULL,
                                             (void *)(uintptr_t)&forms[i]};
    for (size_t i = 0; i < FORMS; i += ASKED)
        tests[count++] = (struct CMUnitTest){forms[i].name, answers_are_right, NULL, NULL,
                                             (void *)(uintptr_t)&forms[i]};
    for (size_t i = 0; i < STEEP; i++)
        tests[count++] = (struct CMUnitTest){steep[i]->name, steep_bounds_do_as_well, NULL, NULL,
                                             (void *)(uintptr_t)steep[i]};
    tests[count++] = (struct CMUnitTest)cmocka_unit_test(numbers_do_as_well);
    return _cmocka_run_group_tests("distant", tests, count, renderer_open, renderer_close);
}
