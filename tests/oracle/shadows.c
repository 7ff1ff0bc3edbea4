/*
 * shadows.c: shadows, held against exact rays.
 *
 * Two lights of every scene here are one but for colour: red light casts shadows, green light
 * does not, and the sky is black; so on white ground red over green is how much of the light is
 * visible.  That is compared with the share of the light's disc that exact rays reach, and with
 * single rays where the light is a point.  Where neighbours share what their rays find, means of
 * 5x5 pixels are compared.  A shadow ray starts an eighth of a pixel above even ground: truths are
 * computed for rays from the surface and from there, or somewhat higher.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/compile.h"
#include "runtime/film/film.h"
#include "tests/support/renderer.h"
#include "tests/oracle/exact.h"
#include "tests/oracle/product.h"

/* What is asked for.  Noise as a share of that of independent rays, lift in pixels, widths and
   numbers of subpixels as shares of what there is; all others are openness and light, up to 1. */
#define MOST_NOISE       0.6
#define LIFT             0.125 /* where rays start above even ground */
#define MOST_LIFT        1.25  /* a pixel, and what the permitted error makes */
#define MOST_WIDTH_ERROR 0.03
#define BLUR_REACH       8 /* pixels: so far from a penumbra nothing is shared */
/* Of means of 5x5 pixels, as shares of the light: root of the mean square in and near the penumbra
   for 1 and for 4 rays a pixel, and the worst of all. */
#define MOST_OFF_1      0.025
#define MOST_OFF_4      0.015
#define MOST_OFF_AT_ALL 0.15
#define MOST_ASYMMETRY  0.03 /* of means of 20x20 pixels */
#define MOST_OFF_SHARED 0.02 /* of means of 5x5 pixels of colours, root of the mean square */
#define MOST_OVER_1     1e-3
#define MOST_OVER_4     2e-4

#define DEGREE (M_PI / 180)

enum { WIDTH = 320, HEIGHT = 180 };

/* ---- Scenes: solids over white ground, which is y = 0 ---- */

typedef enum SolidKind { BALL, SLAB, TWIG } SolidKind;

typedef struct Solid {
    SolidKind kind;
    Vec       a, b;   /* the centre; the low and the high corner; the ends */
    double    radius; /* of twigs: in units of the parameter `size` */
} Solid;

typedef enum StageKind {
    LEDGE,
    LEDGE_LAMP,
    BALLS,
    BALL_LAMP,
    TWIGS,
    BOUNDS,
    FAR_BOUNDS,
    POLYNOMIALS,
    FIELDS,
    TWISTS,
    STAGES
} StageKind;
enum { FROM_ABOVE, FROM_THE_SIDE }; /* cameras: orthographic and perspective */
enum { MOST_SOLIDS = 24, MOST_PIXELS = 1 << 16 };

typedef struct Stage {
    bool          lamp;  /* its light has a place, else it is a sun */
    double        slope; /* balls have a distance so many times too small; 0: the true one */
    const char   *ball;  /* what they are made of: a ball of radius 1; NULL: spheres */
    Vec           target;
    double        high; /* of what is seen from above */
    Solid         solids[MOST_SOLIDS];
    int           count;
    SceneText     text;
    Product       product;
    KrsRendering *rendering;
} Stage;

static const Solid A_LEDGE = {SLAB, {-20, 0, -20}, {0, 2, 20}, 0};
static const Solid A_BALL  = {BALL, {0, 1.6, 0}, {0, 0, 0}, 0.9};

static Stage stages[STAGES] = {
    [LEDGE]       = {.target = {1.5, 0, 0}, .high = 4},
    [LEDGE_LAMP]  = {.lamp = true, .target = {1.5, 0, 0}, .high = 4},
    [BALLS]       = {.target = {1.2, 0, 0}, .high = 5},
    [BALL_LAMP]   = {.lamp = true, .target = {1.2, 0, 0}, .high = 5},
    [TWIGS]       = {.target = {0, 0, 0}, .high = 4},
    [BOUNDS]      = {.slope = 4, .target = {1.2, 0, 0}, .high = 5},
    [FAR_BOUNDS]  = {.slope = 20, .target = {1.2, 0, 0}, .high = 5},
    [POLYNOMIALS] = {.ball = "algebraic(x^2 + y^2 + z^2 == 1)", .target = {1.2, 0, 0}, .high = 5},
    [FIELDS]      = {.ball   = "field(x^2 + y^2 + abs(z)^2 - 1).within(box([8, 8, 8]))",
                     .target = {1.2, 0, 0},
                     .high   = 5},
    [TWISTS]      = {.ball = "sphere(1).twist([0, 1, 0], 1)", .target = {1.2, 0, 0}, .high = 5},
};

/* Twigs in all directions that lie above the ground. */
static void scatter_twigs(Stage *stage)
{
    Random random = {5};
    stage->count  = 20;
    for (int i = 0; i < stage->count; i++) {
        double turn = random_between(&random, 0, M_PI), length = random_between(&random, 0.5, 1.2);
        Vec    middle    = vec(random_between(&random, -3, 3), random_between(&random, 0.6, 1),
                               random_between(&random, -2, 2));
        Vec    lateral   = vec(0.5 * length * cos(turn), random_between(&random, -0.2, 0.2),
                               0.5 * length * sin(turn));
        stage->solids[i] = (Solid){TWIG, vec_sub(middle, lateral), vec_add(middle, lateral), 1};
    }
}

static void place_solids(StageKind kind)
{
    Stage *stage = &stages[kind];
    if (kind == TWIGS) {
        scatter_twigs(stage);
        return;
    }
    bool ledge                    = kind == LEDGE || kind == LEDGE_LAMP;
    stage->solids[stage->count++] = ledge ? A_LEDGE : A_BALL;
    if (kind == BALLS || stage->slope > 0 || stage->ball) /* one that lies on the ground */
        stage->solids[stage->count++] = (Solid){BALL, {-1.5, 0.4, 1.5}, {0, 0, 0}, 0.4};
}

static void write_solid(SceneText *text, const Stage *stage, const Solid *solid)
{
    Vec a = solid->a, b = solid->b, middle = vec_mix(a, b, 0.5), sides = vec_sub(b, a);
    switch (solid->kind) {
    case BALL:
        scene_write(text, "show %s.scale(%.17g).move([%.17g, %.17g, %.17g]).paint(white);\n",
                    stage->slope > 0 ? "ball()"
                    : stage->ball    ? stage->ball
                                     : "sphere(1)",
                    solid->radius, a.x, a.y, a.z);
        break;
    case SLAB:
        scene_write(text,
                    "show box([%.17g, %.17g, %.17g]).move([%.17g, %.17g, %.17g])"
                    ".paint(white);\n",
                    sides.x, sides.y, sides.z, middle.x, middle.y, middle.z);
        break;
    case TWIG:
        scene_write(text,
                    "show capsule([%.17g, %.17g, %.17g], [%.17g, %.17g, %.17g], "
                    "%.17g * size).paint(white);\n",
                    a.x, a.y, a.z, b.x, b.y, b.z, solid->radius);
    }
}

static void write_view(SceneText *text, const Stage *stage)
{
    const char *where = stage->lamp ? "position" : "direction";
    const char *wide  = stage->lamp ? "radius" : "softness";
    Vec         t     = stage->target;
    scene_write(text,
                "param at = [-1, 2, 0.5];\nparam wide = 0 in [0, 1];\n"
                "param size = 0.01 in [1e-6, 1];\n"
                "light red { %s: at, %s: wide, color: [1, 0, 0] }\n"
                "light green { %s: at, %s: wide, color: [0, 1, 0], shadow: false }\n"
                "sky { zenith: #000000, horizon: #000000, ground: #000000 }\n"
                "image { tone_map: \"none\" }\n"
                "material white { color: [1, 1, 1], roughness: 1 }\n"
                "show plane([0, 1, 0], 0).paint(white);\n",
                where, wide, where, wide);
    scene_write(text,
                "camera above { eye: [%g, 50, %g], target: [%g, %g, %g], "
                "projection: \"orthographic\", height: %g }\n",
                t.x, t.z + 50, t.x, t.y, t.z, stage->high);
    scene_write(text, "camera aside { eye: [%g, 5, %g], target: [%g, %g, %g], fov: 40deg }\n",
                t.x + 4, t.z + 7, t.x, t.y, t.z);
}

static void open_rendering(const Product *product, KrsRendering **rendering)
{
    if (krs_rendering_new(renderer, product->scene, rendering) != KRS_OK)
        fail_msg("%s", krs_renderer_message(renderer));
}

static Stage *use_stage(StageKind kind)
{
    Stage *stage = &stages[kind];
    if (stage->rendering)
        return stage;
    place_solids(kind);
    write_view(&stage->text, stage);
    if (stage->slope > 0)
        scene_write(&stage->text,
                    "shape ball(radius = 1) { distance: length(p) - radius, "
                    "slope: %.17g, within: box(2 * radius * [1, 1, 1]) }\n",
                    stage->slope);
    for (int i = 0; i < stage->count; i++)
        write_solid(&stage->text, stage, &stage->solids[i]);
    stage->product = product_compile(stage->text.bytes);
    open_rendering(&stage->product, &stage->rendering);
    return stage;
}

/* ---- Pictures ---- */

/* A picture to be taken of a stage. */
typedef struct Shot {
    StageKind        stage;
    Vec              light; /* towards it, or its place */
    double           wide;  /* its angle, or its radius */
    double           size;  /* of twigs; 0: they do not matter */
    KrsRenderOptions options;
    int              without; /* in truth this solid is not there, counted from 1; 0: all are */
} Shot;

static void set_parameter(const Stage *stage, const char *name, const double *values, size_t count)
{
    assert_int_equal(krs_frame_set(stage->product.frame, name, values, count), KRS_OK);
}

static KrsPicture *take_picture(KrsRendering *rendering, KrsFrame *frame, KrsRenderOptions options)
{
    KrsPicture *picture;
    if (krs_render(rendering, frame, &options, &picture) != KRS_OK)
        fail_msg("%s", krs_renderer_message(renderer));
    assert_int_equal(picture->stats.unresolved, 0);
    return picture;
}

static void set_lighting(const Shot *shot)
{
    const Stage *stage = use_stage(shot->stage);
    set_parameter(stage, "at", (double[]){shot->light.x, shot->light.y, shot->light.z}, 3);
    set_parameter(stage, "wide", &shot->wide, 1);
    if (shot->size > 0)
        set_parameter(stage, "size", &shot->size, 1);
}

static KrsPicture *shoot(const Shot *shot)
{
    const Stage *stage = use_stage(shot->stage);
    set_lighting(shot);
    return take_picture(stage->rendering, stage->product.frame, shot->options);
}

static Lens shot_lens(const Shot *shot)
{
    const Stage *stage = use_stage(shot->stage);
    Vec          t     = stage->target;
    int          width = (int)shot->options.width, height = (int)shot->options.height;
    if (shot->options.camera == FROM_ABOVE)
        return lens_make(vec(t.x, 50, t.z + 50), t, stage->high / 2, true, width, height);
    return lens_make(vec(t.x + 4, 5, t.z + 7), t, tan(20 * DEGREE), false, width, height);
}

/* How much of the light a pixel of the window sees; -1 where it is not ground in the light. */
static double seen_at(const KrsPicture *picture, int k)
{
    const float *color = picture->color + 4 * k;
    if (picture->component[k] != 1 || !(color[1] > 0))
        return -1;
    return (double)color[0] / (double)color[1];
}

/* The ground in the middle of a pixel of the window. */
static Vec ground_at(const Lens *lens, const KrsWindow *window, double x, double y)
{
    Line ray = lens_ray(lens, window->x + x + 0.5, window->y + y + 0.5);
    return line_at(ray, -ray.origin.y / ray.direction.y);
}

static double pixel_at(const Lens *lens, Vec ground)
{
    return lens_pixel(lens, vec_dot(vec_sub(ground, lens->eye), lens->forward));
}

/* ---- What exact rays see ---- */

/* The light as it is seen from a point: a disc across the way to its middle. */
typedef struct Disc {
    Vec    axis; /* unit */
    double remote, radius;
    bool   endless; /* nothing is behind the light */
} Disc;

static Disc disc_from(const Shot *shot, Vec point)
{
    if (!stages[shot->stage].lamp)
        return (Disc){vec_unit(shot->light), 1, tan(shot->wide / 2), true};
    Vec apart = vec_sub(shot->light, point);
    return (Disc){vec_unit(apart), vec_length(apart), shot->wide, false};
}

static Chord chord_of(Line line, const Solid *solid, double size)
{
    switch (solid->kind) {
    case BALL: return chord_of_ball(line, solid->a, solid->radius);
    case SLAB: return chord_of_box(line, solid->a, solid->b);
    default: return chord_of_capsule(line, solid->a, solid->b, size * solid->radius);
    }
}

/* Whether a solid stands between a point and another that is `direction` off. */
static bool is_hidden(const Shot *shot, Vec point, Vec direction, bool endless)
{
    const Stage *stage = &stages[shot->stage];
    Line         line  = {point, vec_unit(direction)};
    double       end   = endless ? HUGE_VAL : vec_length(direction);
    for (int i = 0; i < stage->count; i++) {
        Chord chord = chord_of(line, &stage->solids[i], shot->size);
        if (i + 1 != shot->without && !chord_is_empty(chord) && chord.leave > 0 &&
            chord.enter < end)
            return true;
    }
    return false;
}

/* By rays to points that divide the disc evenly. */
static double share_by_rays(const Shot *shot, Vec point)
{
    enum { RINGS = 16, SPOKES = 24 };
    Disc disc    = disc_from(shot, point);
    Vec  lateral = vec_across(disc.axis), other = vec_cross(disc.axis, lateral);
    int  open = 0;
    for (int i = 0; i < RINGS; i++)
        for (int k = 0; k < SPOKES; k++) {
            double distance  = disc.radius * sqrt((i + 0.5) / RINGS);
            double turn      = 2 * M_PI * (k + 0.618 * i) / SPOKES;
            Vec    at        = vec_add(vec_scale(distance * cos(turn), lateral),
                                       vec_scale(distance * sin(turn), other));
            Vec    direction = vec_add(vec_scale(disc.remote, disc.axis), at);
            open += !is_hidden(shot, point, direction, disc.endless);
        }
    return (double)open / (RINGS * SPOKES);
}

/* The ledge's upper edge and a point span a plane, which cuts the disc along a line.  Exact where
   all rays go up and towards the ledge. */
static double share_above_edge(const Shot *shot, Vec point)
{
    Disc   disc    = disc_from(shot, point);
    Vec    to_edge = vec(A_LEDGE.b.x - point.x, A_LEDGE.b.y - point.y, 0);
    Vec    open    = vec_unit(vec_cross(to_edge, vec(0, 0, 1))); /* away from the ledge */
    Vec    across  = vec_sub(open, vec_scale(vec_dot(open, disc.axis), disc.axis));
    double cut     = -vec_dot(open, disc.axis) * disc.remote / (disc.radius * vec_length(across));
    cut            = fmax(-1, fmin(cut, 1));
    return (acos(cut) - cut * sqrt(1 - cut * cut)) / M_PI;
}

typedef double Truth(const Shot *shot, Vec point);

/* What rays from the surface see in the pixels of a window, and what they see that start above it:
   a pixel, unless said otherwise. */
typedef struct Truths {
    int    width, height;
    double low[MOST_PIXELS], lifted[MOST_PIXELS];
} Truths;

static Truths truths; /* the last computed */

/* Whether the last truths are those of another shot of the same solids. */
static bool are_known(Truth *truth, const Shot *shot, double lift)
{
    static struct {
        Truth *truth;
        double lift;
        Shot   shot;
    } last;
    const Stage *stage = &stages[shot->stage], *before = &stages[last.shot.stage];
    Shot         alike = *shot;
    alike.stage        = last.shot.stage;
    bool known         = last.truth == truth && !(last.lift < lift) && !(last.lift > lift) &&
                 memcmp(&alike, &last.shot, sizeof alike) == 0 && stage->lamp == before->lamp &&
                 stage->count == before->count &&
                 memcmp(&stage->target, &before->target, sizeof stage->target) == 0 &&
                 memcmp(stage->solids, before->solids, sizeof stage->solids) == 0;
    last.truth = truth;
    last.lift  = lift;
    last.shot  = *shot;
    return known;
}

static void compute_truths(Truth *truth, const Shot *shot, double lift)
{
    if (are_known(truth, shot, lift))
        return;
    Lens      lens   = shot_lens(shot);
    KrsWindow window = shot->options.crop;
    truths.width     = (int)window.width;
    truths.height    = (int)window.height;
    assert_in_range(truths.width * truths.height, 1, MOST_PIXELS);
    for (int k = 0; k < truths.width * truths.height; k++) {
        Vec ground       = ground_at(&lens, &window, k % truths.width, k / truths.width);
        truths.low[k]    = truth(shot, ground);
        ground.y         = lift * pixel_at(&lens, ground);
        truths.lifted[k] = truth(shot, ground);
    }
}

static double truth_low(int k) { return fmin(truths.low[k], truths.lifted[k]); }
static double truth_high(int k) { return fmax(truths.low[k], truths.lifted[k]); }

/* The least and the greatest truth of a pixel and those around it. */
static void truths_around(int k, double *low, double *high)
{
    *low  = HUGE_VAL;
    *high = -HUGE_VAL;
    for (int y = k / truths.width - 1; y <= k / truths.width + 1; y++)
        for (int x = k % truths.width - 1; x <= k % truths.width + 1; x++)
            if (x >= 0 && y >= 0 && x < truths.width && y < truths.height) {
                *low  = fmin(*low, truth_low(y * truths.width + x));
                *high = fmax(*high, truth_high(y * truths.width + x));
            }
}

/* ---- Area shadows ---- */

typedef struct Match {
    int    umbra, penumbra, lit; /* pixels; umbra and lit with all pixels around */
    int    wrong;                /* of umbra that are lit, of lit ones that are not */
    double noise;                /* of the penumbra, root of the mean square */
    double expected;             /* if the rays of a pixel were independent */
    double lift;                 /* where rays seem to start, in pixels above the surface */
} Match;

static Match match_area(const KrsPicture *picture, const Shot *shot, Truth *truth)
{
    Match  match   = {0};
    double squares = 0, variance = 0, along = 0, steep = 0;
    compute_truths(truth, shot, 1);
    for (int k = 0; k < truths.width * truths.height; k++) {
        double seen = seen_at(picture, k), off = seen - truths.low[k], low, high;
        double rise = truths.lifted[k] - truths.low[k];
        truths_around(k, &low, &high);
        if (seen >= 0 && (high <= 0 || low >= 1)) {
            match.umbra += high <= 0;
            match.lit += low >= 1;
            match.wrong += fabs(off) > 1e-6;
        }
        if (seen < 0 || truth_high(k) <= 0 || truth_low(k) >= 1)
            continue;
        match.penumbra++;
        variance += truths.low[k] * (1 - truths.low[k]);
        squares += off * off;
        along += off * rise;
        steep += rise * rise;
    }
    match.lift     = along / steep;
    match.noise    = sqrt((squares - match.lift * along) / match.penumbra);
    match.expected = sqrt(variance / match.penumbra / shot->options.samples);
    return match;
}

static bool area_is_right(const char *name, const KrsPicture *picture, const Shot *shot,
                          Truth *truth)
{
    Match m = match_area(picture, shot, truth);
    print_message("# area, %s, %u samples: %d pixels of umbra, %d of penumbra, %d lit, %d wrong; "
                  "noise %.4f (independent rays: %.4f), lift %.2f\n",
                  name, shot->options.samples, m.umbra, m.penumbra, m.lit, m.wrong, m.noise,
                  m.expected, m.lift);
    assert_true(m.umbra > 200 && m.penumbra > 200 && m.lit > 200);
    return m.wrong == 0 && m.noise < MOST_NOISE * m.expected && fabs(m.lift) < MOST_LIFT;
}

/* The place of a row at which a rising profile passes a level, in pixels. */
static double place_of_level(const double *profile, int count, double level)
{
    for (int i = 1; i < count; i++)
        if (profile[i - 1] < level && profile[i] >= level)
            return i - 1 + (level - profile[i - 1]) / (profile[i] - profile[i - 1]);
    return NAN;
}

static double width_of(const double *profile, int count)
{
    return place_of_level(profile, count, 0.9) - place_of_level(profile, count, 0.1);
}

/* Across the ledge's shadow, whose edge runs down the picture: the mean of all rows. */
static bool width_is_right(const KrsPicture *picture, const Shot *shot)
{
    double seen[MOST_PIXELS] = {0}, truth[MOST_PIXELS] = {0};
    compute_truths(share_above_edge, shot, 1);
    for (int k = 0; k < truths.width * truths.height; k++) {
        seen[k % truths.width] += fmax(0, seen_at(picture, k)) / truths.height;
        truth[k % truths.width] += truths.low[k] / truths.height;
    }
    double width = width_of(seen, truths.width), wanted = width_of(truth, truths.width);
    print_message("# area, edge: from 10 %% to 90 %% in %.2f pixels, in truth %.2f\n", width,
                  wanted);
    return fabs(width / wanted - 1) < MOST_WIDTH_ERROR;
}

static const struct Lighting {
    const char *name;
    StageKind   ledge, ball;
    Vec         edge_light, ball_light;
    double      wide;
} lightings[] = {
    {"sun of 4 degrees", LEDGE, BALLS, {-1, 1.3, 0.4}, {-1, 1.4, -0.6}, 4 * DEGREE},
    {"sun of 10 degrees", LEDGE, BALLS, {-1, 2, 0.4}, {-1, 1.4, -0.6}, 10 * DEGREE},
    {"lamp", LEDGE_LAMP, BALL_LAMP, {-2.5, 5, 1}, {-3, 5.5, -1.6}, 0.4},
};
enum { LIGHTINGS = sizeof lightings / sizeof lightings[0] };

static Shot edge_shot(const struct Lighting *lighting, KrsShadows shadows, uint32_t samples)
{
    return (Shot){lighting->ledge,
                  lighting->edge_light,
                  lighting->wide,
                  0,
                  {.width         = 640,
                   .height        = 360,
                   .crop          = {192, 174, 448, 12},
                   .shadows       = shadows,
                   .samples       = samples,
                   .no_upsampling = true},
                  0};
}

static Shot ball_shot(const struct Lighting *lighting, KrsShadows shadows, uint32_t samples)
{
    return (Shot){lighting->ball,
                  lighting->ball_light,
                  lighting->wide,
                  0,
                  {.width         = 320,
                   .height        = 180,
                   .crop          = {110, 65, 165, 90},
                   .shadows       = shadows,
                   .samples       = samples,
                   .no_upsampling = true},
                  0};
}

static void area_shadows_are_shares_of_the_disc(void **state)
{
    (void)state;
    size_t wrong = 0;
    for (int i = 0; i < LIGHTINGS; i++) {
        Shot edge           = edge_shot(&lightings[i], KRS_SHADOWS_AREA, 64);
        Shot ball           = ball_shot(&lightings[i], KRS_SHADOWS_AREA, 64);
        ball.options.width  = 480;
        ball.options.height = 270;
        ball.options.crop   = (KrsWindow){256, 125, 100, 40}; /* the far end of the shadow */
        KrsPicture *of_edge = shoot(&edge), *of_ball = shoot(&ball);
        print_message("# %s\n", lightings[i].name);
        wrong += !area_is_right("edge", of_edge, &edge, share_above_edge);
        wrong += !width_is_right(of_edge, &edge);
        wrong += !area_is_right("ball", of_ball, &ball, share_by_rays);
        krs_picture_free(of_edge);
        krs_picture_free(of_ball);
    }
    assert_int_equal(wrong, 0);
}

/* More rays make less noise. */
static void area_shadows_converge(void **state)
{
    (void)state;
    double noise[2];
    for (int i = 0; i < 2; i++) {
        Shot        shot    = edge_shot(&lightings[1], KRS_SHADOWS_AREA, i ? 256 : 16);
        KrsPicture *picture = shoot(&shot);
        noise[i]            = match_area(picture, &shot, share_above_edge).noise;
        krs_picture_free(picture);
    }
    print_message("# area: noise of 16 rays %.4f, of 256 %.4f\n", noise[0], noise[1]);
    assert_true(noise[1] < noise[0] / 4);
}

/* How much pixels differ that see the same: those above each other, along the ledge's shadow.
   Root of the mean square in the penumbra, and what single rays would have. */
static double noise_of_columns(const KrsPicture *picture, double *expected)
{
    int    width = (int)picture->window.width, height = (int)picture->window.height, columns = 0;
    double squares = 0, variance = 0;
    for (int x = 0; x < width; x++) {
        double sum = 0, square = 0;
        for (int y = 0; y < height; y++) {
            double seen = seen_at(picture, y * width + x);
            sum += seen / height;
            square += seen * seen / height;
        }
        if (sum < 0.02 || sum > 0.98)
            continue;
        columns++;
        squares += square - sum * sum;
        variance += sum * (1 - sum);
    }
    assert_true(columns > 0);
    *expected = sqrt(variance / columns);
    return sqrt(squares / columns);
}

/* Of pixels almost as wide as the penumbra: noise as a share of that of 256 independent rays. */
static double narrow_noise(double degrees, uint32_t samples)
{
    Shot        shot    = {LEDGE,
                           {-1, 1.3, 0},
                           degrees * DEGREE,
                           0,
                           {.width   = 72,
                            .height  = 40,
                            .crop    = {24, 0, 36, 40},
                            .samples = samples,
                            .shadows = KRS_SHADOWS_AREA},
                           0};
    KrsPicture *picture = shoot(&shot);
    double      expected, noise = noise_of_columns(picture, &expected);
    krs_picture_free(picture);
    print_message("# area, edge, %g degrees, large pixels, %u samples: noise %.4f (256 independent "
                  "rays: %.4f)\n",
                  degrees, samples, noise, expected / 16);
    return noise / (expected / 16);
}

/* Where a penumbra is as narrow as pixels, places in a pixel and on the light both matter, and
   must have nothing to do with each other. */
static void narrow_penumbras_converge(void **state)
{
    (void)state;
    static const double angles[] = {1.5, 3, 8};
    size_t              wrong    = 0;
    for (int i = 0; i < 3; i++) {
        double of_few = narrow_noise(angles[i], 16), of_many = narrow_noise(angles[i], 256);
        wrong += !(of_many < MOST_NOISE);
        assert_false(of_few < MOST_NOISE); /* so much would be found */
    }
    assert_int_equal(wrong, 0);
}

/* Pictures of different seeds are about different rays, to the light as well: their mean is as
   good as a picture of as many. */
static void seeds_move_the_rays_to_the_light(void **state)
{
    (void)state;
    enum { SEEDS = 16 };
    Shot        shot    = edge_shot(&lightings[1], KRS_SHADOWS_AREA, 16);
    KrsPicture *sum     = shoot(&shot);
    size_t      numbers = 4 * (size_t)shot.options.crop.width * shot.options.crop.height;
    double      one     = match_area(sum, &shot, share_above_edge).noise;
    for (shot.options.seed = 1; shot.options.seed < SEEDS; shot.options.seed++) {
        KrsPicture *picture = shoot(&shot);
        for (size_t i = 0; i < numbers; i++)
            sum->color[i] += picture->color[i];
        krs_picture_free(picture);
    }
    double all = match_area(sum, &shot, share_above_edge).noise;
    krs_picture_free(sum);
    print_message("# area: noise of 16 rays %.4f, of the mean of %d seeds %.4f\n", one, SEEDS, all);
    assert_true(all < one / 2.5);
}

/* ---- Shadows that neighbours share ---- */

/* The least and the greatest truth of the pixels up to so far away. */
static void truths_within(int k, int reach, double *low, double *high)
{
    *low  = HUGE_VAL;
    *high = -HUGE_VAL;
    for (int y = k / truths.width - reach; y <= k / truths.width + reach; y++)
        for (int x = k % truths.width - reach; x <= k % truths.width + reach; x++)
            if (x >= 0 && y >= 0 && x < truths.width && y < truths.height) {
                *low  = fmin(*low, truth_low(y * truths.width + x));
                *high = fmax(*high, truth_high(y * truths.width + x));
            }
}

/* How far the mean of 5x5 pixels is outside of what is true for it; NAN where one of them shows
   no ground in the light. */
static double mean_off(const KrsPicture *picture, int x, int y)
{
    double seen = 0, low = 0, high = 0;
    for (int i = 0; i < 25; i++) {
        int    k    = (y + i / 5 - 2) * truths.width + x + i % 5 - 2;
        double here = seen_at(picture, k);
        if (here < 0)
            return NAN;
        seen += here / 25;
        low += truth_low(k) / 25;
        high += truth_high(k) / 25;
    }
    return fmax(fmax(low - seen, seen - high), 0);
}

typedef struct SharedMatch {
    int    umbra, penumbra, lit; /* pixels; umbra and lit ones are far from the penumbra */
    int    wrong;                /* of umbra that are lit, of lit ones that are not */
    double off, worst;           /* of means: root of the mean square in the penumbra; the most */
} SharedMatch;

static SharedMatch match_shared(const KrsPicture *picture, const Shot *shot, Truth *truth)
{
    SharedMatch match   = {0};
    double      squares = 0;
    compute_truths(truth, shot, LIFT);
    for (int k = 0; k < truths.width * truths.height; k++) {
        int    x = k % truths.width, y = k / truths.width;
        double seen = seen_at(picture, k), low, high;
        if (seen < 0 || x < 2 || y < 2 || x >= truths.width - 2 || y >= truths.height - 2)
            continue;
        truths_within(k, BLUR_REACH, &low, &high);
        if (high <= 0 || low >= 1) {
            match.umbra += high <= 0;
            match.lit += low >= 1;
            match.wrong += fabs(seen - low) > 1e-6;
            continue;
        }
        double off = mean_off(picture, x, y);
        if (isnan(off))
            continue;
        match.penumbra++;
        match.worst = fmax(match.worst, off);
        squares += off * off;
    }
    match.off = sqrt(squares / match.penumbra);
    return match;
}

static bool shared_is_right(const char *name, const KrsPicture *picture, const Shot *shot,
                            Truth *truth)
{
    SharedMatch m    = match_shared(picture, shot, truth);
    double      most = shot->options.samples > 1 ? MOST_OFF_4 : MOST_OFF_1;
    print_message("# soft, %s, %u samples: %d pixels of umbra, %d of penumbra, %d lit, %d wrong; "
                  "off by %.4f, at most %.4f\n",
                  name, shot->options.samples, m.umbra, m.penumbra, m.lit, m.wrong, m.off, m.worst);
    assert_true(m.umbra > 100 && m.penumbra > 200 && m.lit > 200);
    return m.wrong == 0 && m.off < most && m.worst < MOST_OFF_AT_ALL;
}

static void soft_shadows_are_shares_of_the_disc(void **state)
{
    (void)state;
    size_t wrong = 0;
    for (int i = 0; i < 2 * LIGHTINGS; i++) {
        const struct Lighting *lighting = &lightings[i / 2];
        Shot                   edge     = edge_shot(lighting, KRS_SHADOWS_SOFT, i % 2 ? 4 : 1);
        Shot                   ball     = ball_shot(lighting, KRS_SHADOWS_SOFT, i % 2 ? 4 : 1);
        edge.options.no_upsampling = ball.options.no_upsampling = false;
        edge.options.crop.height                                = 24;
        KrsPicture *of_edge = shoot(&edge), *of_ball = shoot(&ball);
        print_message("# %s\n", lighting->name);
        wrong += !shared_is_right("edge", of_edge, &edge, share_above_edge);
        wrong += !shared_is_right("ball", of_ball, &ball, share_by_rays);
        krs_picture_free(of_edge);
        krs_picture_free(of_ball);
    }
    assert_int_equal(wrong, 0);
}

/* However far below the true distance a bound is. */
static void soft_shadows_of_bounds_are_the_same(void **state)
{
    (void)state;
    size_t wrong = 0;
    for (int i = 0; i < 2 * (STAGES - BOUNDS); i++) {
        const struct Lighting *lighting = &lightings[i / (STAGES - BOUNDS)];
        Shot                   ball     = ball_shot(lighting, KRS_SHADOWS_SOFT, 1);
        ball.stage                      = (StageKind)(BOUNDS + i % (STAGES - BOUNDS));
        ball.options.no_upsampling      = false;
        KrsPicture  *picture            = shoot(&ball);
        const Stage *stage              = &stages[ball.stage];
        print_message("# %s, %s / %g\n", lighting->name, stage->ball ? stage->ball : "distance",
                      fmax(stage->slope, 1));
        wrong += !shared_is_right("ball", picture, &ball, share_by_rays);
        krs_picture_free(picture);
    }
    assert_int_equal(wrong, 0);
}

/* ---- Hard shadows ---- */

static double open_or_not(const Shot *shot, Vec point)
{
    Disc disc = disc_from(shot, point);
    return !is_hidden(shot, point, vec_scale(disc.remote, disc.axis), disc.endless);
}

typedef struct HardMatch {
    int dark, lit, edge; /* pixels; at an edge where pixels around differ */
    int off, wrong;      /* not as the truth: at an edge, and elsewhere */
} HardMatch;

/* Marks pixels that are not as all around them, for rays that start up to `lift` above the
   surface. */
static void mark_edges(const Shot *shot, double lift, bool *edge)
{
    compute_truths(open_or_not, shot, lift);
    for (int k = 0; k < truths.width * truths.height; k++) {
        int    x = k % truths.width, y = k / truths.width;
        double low, high;
        truths_around(k, &low, &high);
        edge[k] = edge[k] || low != high || x == 0 || y == 0 || x == truths.width - 1 ||
                  y == truths.height - 1;
    }
}

/* `lift`: shadows of a low sun move by as much as that makes. */
static HardMatch match_hard(const KrsPicture *picture, const Shot *shot, double lift)
{
    HardMatch match             = {0};
    bool      edge[MOST_PIXELS] = {false};
    for (int i = 2; i > 0 && lift > 0; i--)
        mark_edges(shot, 0.5 * lift * i, edge);
    mark_edges(shot, 0, edge);
    for (int k = 0; k < truths.width * truths.height; k++) {
        double seen = seen_at(picture, k);
        bool   same = fabs(seen - truths.low[k]) < 1e-6;
        if (seen < 0)
            continue;
        match.edge += edge[k];
        match.dark += seen < 0.5;
        match.lit += seen > 0.5;
        match.off += edge[k] && !same;
        match.wrong += (!edge[k] && !same) || fabs(seen - round(seen)) > 1e-6;
    }
    return match;
}

static bool hard_is_right(const char *name, const KrsPicture *picture, const Shot *shot,
                          double lift)
{
    HardMatch m = match_hard(picture, shot, lift);
    print_message("# hard, %s, lift up to %g: %d pixels dark, %d lit, %d at edges, of which %d are "
                  "not as rays say; %d elsewhere\n",
                  name, lift, m.dark, m.lit, m.edge, m.off, m.wrong);
    assert_true(m.dark > 200 && m.lit > 200);
    return m.wrong == 0;
}

static const struct HardCase {
    const char *name;
    StageKind   stage;
    Vec         light;
    double      lift; /* below 45 degrees it matters */
} hard_cases[] = {
    {"ledge", LEDGE, {-1, 1.3, 0.4}, 0},
    {"balls", BALLS, {-1, 1.4, -0.6}, 0},
    {"ball, lamp", BALL_LAMP, {-3, 5.5, -1.6}, 0},
    {"twigs", TWIGS, {-0.6, 1.4, 0.3}, 0},
    {"balls, sun at 20 degrees", BALLS, {-1, 0.4, -0.4}, MOST_LIFT},
    {"twigs, sun at 20 degrees", TWIGS, {-1, 0.37, 0.2}, MOST_LIFT},
};
enum { HARD_CASES = sizeof hard_cases / sizeof hard_cases[0] };

static Shot hard_shot(const struct HardCase *hard, int camera)
{
    return (Shot){hard->stage,
                  hard->light,
                  0,
                  0.04,
                  {.width         = WIDTH,
                   .height        = HEIGHT,
                   .crop          = {0, 0, WIDTH, HEIGHT},
                   .camera        = (size_t)camera,
                   .no_upsampling = true},
                  0};
}

static void hard_shadows_end_where_rays_say(void **state)
{
    (void)state;
    size_t wrong = 0;
    for (int i = 0; i < 2 * HARD_CASES; i++) {
        Shot        shot    = hard_shot(&hard_cases[i / 2], i % 2);
        KrsPicture *picture = shoot(&shot);
        print_message("# %s\n", i % 2 == FROM_ABOVE ? "from above" : "from the side");
        wrong += !hard_is_right(hard_cases[i / 2].name, picture, &shot, hard_cases[i / 2].lift);
        krs_picture_free(picture);
    }
    assert_int_equal(wrong, 0);
}

/* Pixels of solids that no other solid hides from the light, and how many of them are dark. */
static int count_dark_sides(const KrsPicture *picture, const Shot *shot, int *open)
{
    Shot others = *shot;
    int  dark   = 0;
    *open       = 0;
    for (int k = 0; k < WIDTH * HEIGHT; k++) {
        const float *at = picture->position + 3 * k, *color = picture->color + 4 * k;
        if (picture->component[k] < 2 || color[1] < 0.01F)
            continue; /* grazing light cannot be told from shadow */
        others.without = (int)picture->component[k] - 1; /* component 1 is the ground */
        bool lit       = open_or_not(&others, vec((double)at[0], (double)at[1], (double)at[2])) > 0;
        *open += lit;
        dark += lit && color[0] != color[1];
    }
    return dark;
}

/* Convex solids have no shadow on their own lit side. */
static void lit_sides_are_lit(void **state)
{
    (void)state;
    Shot        shot    = hard_shot(&hard_cases[1], FROM_THE_SIDE);
    KrsPicture *picture = shoot(&shot);
    int         open, dark = count_dark_sides(picture, &shot, &open), last = WIDTH * HEIGHT;
    print_message("# hard, balls themselves: %d pixels open to the light, %d dark\n", open, dark);
    assert_true(open > 500);
    assert_int_equal(dark, 0);
    while (picture->component[--last] < 2 || picture->color[4 * last + 1] < 0.1F)
        ;
    picture->color[4 * last] = 0; /* a planted fault */
    assert_int_equal(count_dark_sides(picture, &shot, &open), 1);
    krs_picture_free(picture);
}

/* The same where the distance is a bound, and so small a part of the true one at the tips of a long
   ball that a ray which starts there seems to touch it. */
static void lit_sides_of_bounds_are_lit(void **state)
{
    (void)state;
    KrsPicture *picture = picture_of(
        "light red { direction: [1, 0.4, 0.5], color: [1, 0, 0] }\n"
        "light green { direction: [1, 0.4, 0.5], color: [0, 1, 0], shadow: false }\n"
        "sky { zenith: #000000, horizon: #000000, ground: #000000 }\n"
        "image { tone_map: \"none\" }\n"
        "material white { color: [1, 1, 1], roughness: 1 }\n"
        "camera { eye: [9, 4, 6], target: [2, 0, 0], fov: 30deg }\n"
        "show sphere(1).scale([5, 1, 1]).paint(white);",
        &(KrsRenderOptions){.width = WIDTH, .height = HEIGHT});
    int open = 0, dark = 0;
    for (int k = 0; k < WIDTH * HEIGHT; k++) {
        const float *color = picture->color + 4 * k;
        if (picture->component[k] != 1 || color[1] < 0.01F)
            continue;
        open++;
        dark += color[0] < 0.999F * color[1];
    }
    print_message("# hard, a long ball: %d pixels open to the light, %d dark\n", open, dark);
    assert_true(open > 2000);
    assert_int_equal(dark, 0);
    krs_picture_free(picture);
}

/* The mean of 20x20 pixels from there on, of one colour. */
static double mean_of_block(const KrsPicture *picture, int x, int y, int channel)
{
    double sum = 0;
    for (int k = 0; k < 400; k++)
        sum += (double)picture->color[4 * ((y + k / 20) * WIDTH + x + k % 20) + channel];
    return sum / 400;
}

/* The greatest difference of means between a picture and its mirror image. */
static double asymmetry(const KrsPicture *picture)
{
    double most = 0;
    for (int y = 0; y < HEIGHT; y += 20)
        for (int x = 0; x < WIDTH; x += 20)
            for (int i = 0; i < 3; i++)
                most = fmax(most, fabs(mean_of_block(picture, x, y, i) -
                                       mean_of_block(picture, WIDTH - 20 - x, y, i)));
    return most;
}

static void symmetric_scenes_have_symmetric_pictures(void **state)
{
    (void)state;
    static const char text[] =
        "sky { zenith: [0.5, 0.5, 0.5], horizon: [0.7, 0.7, 0.7], ground: [0.3, 0.3, 0.3] }\n"
        "light sun { direction: [0, 1, -0.7], softness: 5deg }\n"
        "camera { eye: [0, 4, 8], target: [0, 0.5, 0], fov: 40deg }\n"
        "show plane([0, 1, 0], 0);\n"
        "show box([0.4, 1.6, 3]).move([0, 0.8, 0]);\n"
        "show sphere(0.6).move([1.2, 0.6, 0.3]) | sphere(0.6).move([-1.2, 0.6, 0.3]);\n";
    for (int plain = 0; plain < 2; plain++) {
        KrsPicture *picture = picture_of(
            text, &(KrsRenderOptions){.width = WIDTH, .height = HEIGHT, .no_upsampling = plain});
        double most = asymmetry(picture);
        print_message("# symmetry: off by %.2g%s\n", most, plain ? "" : " with upsampling");
        assert_true(most < MOST_ASYMMETRY);
        picture->color[4 * (HEIGHT / 2 * WIDTH + 20)] += 800 * MOST_ASYMMETRY; /* a planted fault */
        assert_false(asymmetry(picture) < MOST_ASYMMETRY);
        krs_picture_free(picture);
    }
}

/* ---- Upsampling ---- */

/* How much of a picture is not as another, in steps of 1 of 255 of sRGB. */
typedef struct Difference {
    double most, over_1, over_4; /* shares of the subpixels */
} Difference;

static void to_screen(const KrsImage *image, const float color[4], double out[3])
{
    ToneMap curve = TONE_NEUTRAL;
    double  light[3];
    assert_true(!image->tone_map || tone_map_find(image->tone_map, &curve));
    for (int i = 0; i < 3; i++)
        light[i] = (double)color[i] * exp2(image->exposure);
    tone_map_apply(curve, light, out);
    for (int i = 0; i < 3; i++)
        out[i] = 255 * srgb_encode(out[i]);
}

static Difference compare_pictures(const KrsImage *image, const KrsPicture *a, const KrsPicture *b)
{
    Difference   difference = {0};
    const double each       = 1.0 / (3 * WIDTH * HEIGHT);
    for (int k = 0; k < WIDTH * HEIGHT; k++) {
        double here[3], there[3];
        to_screen(image, a->color + 4 * k, here);
        to_screen(image, b->color + 4 * k, there);
        for (int i = 0; i < 3; i++) {
            double off      = fabs(here[i] - there[i]);
            difference.most = fmax(difference.most, off);
            difference.over_1 += off > 1 ? each : 0;
            difference.over_4 += off > 4 ? each : 0;
        }
    }
    return difference;
}

static bool is_unseen(Difference difference)
{
    return difference.over_1 <= MOST_OVER_1 && difference.over_4 <= MOST_OVER_4;
}

/* A picture with upsampling, and one without. */
static void take_both(KrsRendering *rendering, KrsFrame *frame, KrsPicture *pictures[2])
{
    for (int i = 0; i < 2; i++)
        pictures[i] = take_picture(
            rendering, frame,
            (KrsRenderOptions){.width = WIDTH, .height = HEIGHT, .samples = 1, .no_upsampling = i});
}

static bool upsampling_is_unseen(const char *name, KrsFrame *frame, KrsPicture *pictures[2])
{
    KrsView view;
    assert_int_equal(krs_frame_view(frame, 0, &view), KRS_OK);
    Difference d = compare_pictures(&view.image, pictures[0], pictures[1]);
    print_message("# upsampling, %s: off by %.1f of 255 at most, %.3f %% by more than 1, %.3f %% "
                  "by more than 4\n",
                  name, d.most, 100 * d.over_1, 100 * d.over_4);
    return is_unseen(d);
}

/* The mean of pictures of one ray each to lights and sky, through the pixels' centres, of which
   neighbours know nothing. */
static KrsPicture *take_reference(KrsRendering *rendering, KrsFrame *frame)
{
    enum { SEEDS = 16 };
    const size_t     numbers = 4 * (size_t)WIDTH * HEIGHT;
    KrsRenderOptions options = {
        .width = WIDTH, .height = HEIGHT, .samples = 1, .no_upsampling = true};
    KrsPicture *sum = take_picture(rendering, frame, options);
    for (options.seed = 1; options.seed < SEEDS; options.seed++) {
        KrsPicture *picture = take_picture(rendering, frame, options);
        for (size_t i = 0; i < numbers; i++)
            sum->color[i] += picture->color[i];
        krs_picture_free(picture);
    }
    for (size_t i = 0; i < numbers; i++)
        sum->color[i] /= SEEDS;
    return sum;
}

/* How far means of 5x5 pixels are apart, as a share of the mean colour, root of the mean square. */
static double means_apart(const KrsPicture *a, const KrsPicture *b)
{
    double squares = 0, sum = 0;
    for (int y = 2; y < HEIGHT - 2; y++)
        for (int x = 2; x < WIDTH - 2; x++)
            for (int c = 0; c < 3; c++) {
                double mean = 0;
                for (int i = 0; i < 25; i++) {
                    int k = 4 * ((y + i / 5 - 2) * WIDTH + x + i % 5 - 2) + c;
                    mean += ((double)a->color[k] - (double)b->color[k]) / 25;
                }
                squares += mean * mean;
                sum += (double)b->color[4 * (y * WIDTH + x) + c];
            }
    double count = 3.0 * (WIDTH - 4) * (HEIGHT - 4);
    return sqrt(squares / count) / (sum / count);
}

/* A picture whose neighbours share, against the reference of the same scene, or a scene with its
   light from elsewhere. */
static bool sharing_is_unseen(const char *name, KrsRendering *rendering, KrsFrame *frame)
{
    KrsPicture *reference = take_reference(rendering, frame);
    KrsPicture *picture   = take_picture(
          rendering, frame, (KrsRenderOptions){.width = WIDTH, .height = HEIGHT, .samples = 1});
    double apart = means_apart(picture, reference);
    print_message("# %s, neighbours share: means off by %.4f of the mean\n", name, apart);
    for (int k = 0; k < WIDTH * HEIGHT / 8; k++) /* a planted fault: an eighth is darker */
        for (int i = 0; i < 3; i++)
            picture->color[4 * (k + WIDTH * HEIGHT / 2) + i] *= 0.85F;
    double planted = means_apart(picture, reference);
    assert_false(planted < MOST_OFF_SHARED);
    krs_picture_free(reference);
    krs_picture_free(picture);
    return apart < MOST_OFF_SHARED;
}

static bool example_is_unharmed(const char *path)
{
    Product       product = {0};
    KrsRendering *rendering;
    assert_int_equal(krs_compile_file(path, NULL, &product.scene), KRS_OK);
    assert_int_equal(krs_frame_new(product.scene, &product.frame), KRS_OK);
    open_rendering(&product, &rendering);
    bool unseen = sharing_is_unseen(path, rendering, product.frame);
    krs_rendering_free(rendering);
    product_free(&product);
    return unseen;
}

/* Barth's sextic from near and far: nodes, creases, and hits by power series. */
static void sharing_does_not_change_algebraic_surfaces(void **state)
{
    (void)state;
    static const double angles[] = {40, 10};
    size_t              wrong    = 0;
    for (int i = 0; i < 2; i++) {
        SceneText     text = {0};
        KrsRendering *rendering;
        scene_write(&text,
                    "let g = (1 + sqrt(5)) / 2;\n"
                    "show algebraic((1 + 2 * g) * (x^2 + y^2 + z^2 - 1)^2 ==\n"
                    "    4 * (g^2 * x^2 - y^2) * (g^2 * y^2 - z^2) * (g^2 * z^2 - x^2))\n"
                    "    .within(sphere(1.8));\n"
                    "camera { eye: [0, 2, 5], target: [0, -0.7, 0], fov: %gdeg }\n",
                    angles[i]);
        Product product = product_compile(text.bytes);
        open_rendering(&product, &rendering);
        wrong += !sharing_is_unseen("a sextic", rendering, product.frame);
        krs_rendering_free(rendering);
        product_free(&product);
    }
    assert_int_equal(wrong, 0);
}

static void sharing_does_not_change_examples(void **state)
{
    (void)state;
    static const char *const paths[] = {"examples/02-gear.krs", "examples/06-temple.krs"};
    size_t                   wrong   = 0;
    for (size_t i = 0; i < sizeof paths / sizeof paths[0]; i++)
        wrong += !example_is_unharmed(paths[i]);
    assert_int_equal(wrong, 0);
}

/* Pixels in shadow of the second picture, and how many of them are lit in the first. */
static size_t count_holes(KrsPicture *const pictures[2], size_t *dark)
{
    size_t holes = 0;
    *dark        = 0;
    for (int k = 0; k < WIDTH * HEIGHT; k++) {
        double first = seen_at(pictures[0], k), second = seen_at(pictures[1], k);
        if (second < 0 || second >= 0.5)
            continue;
        (*dark)++;
        holes += first >= 0.5;
    }
    return holes;
}

static void upsampling_keeps_thin_shadows(void **state)
{
    (void)state;
    static const double widths[] = {1, 2, 4}; /* pixels */
    size_t              wrong    = 0;
    for (int i = 0; i < 3; i++) {
        char        name[40];
        KrsPicture *pictures[2];
        Stage      *stage = use_stage(TWIGS);
        size_t      dark, holes;
        Shot        shot = {TWIGS,
                            {-0.5, 1.4, -0.4},
                            0,
                            0.5 * widths[i] * stage->high / HEIGHT,
                            {.width = WIDTH, .height = HEIGHT},
                            0};
        set_lighting(&shot);
        take_both(stage->rendering, stage->product.frame, pictures);
        snprintf(name, sizeof name, "shadows %g pixels wide", widths[i]);
        wrong += !upsampling_is_unseen(name, stage->product.frame, pictures);
        holes = count_holes(pictures, &dark);
        print_message("# upsampling: %zu pixels in shadow, %zu of them lit\n", dark, holes);
        assert_true(dark > 300);
        wrong += holes > 0;
        krs_picture_free(pictures[0]);
        krs_picture_free(pictures[1]);
    }
    assert_int_equal(wrong, 0);
}

/* ---- Crops ---- */

/* Whether a picture of a part has the colours of the whole, bit by bit. */
static bool is_part_of(const KrsPicture *whole, const KrsPicture *part)
{
    const KrsWindow w = part->window;
    for (uint32_t y = 0; y < w.height; y++)
        if (memcmp(whole->color + 4 * ((w.y + y) * whole->width + w.x),
                   part->color + 4 * (y * w.width), 4 * w.width * sizeof *part->color) != 0)
            return false;
    return true;
}

static const Shot cropped_shots[] = {
    {TWIGS, {-0.5, 1.4, -0.4}, DEGREE, 0.02, {.width = WIDTH, .height = HEIGHT}, 0},
    {BALLS, {-1, 1.4, -0.6}, 10 * DEGREE, 0, {.width = WIDTH, .height = HEIGHT}, 0},
    {BALLS,
     {-1, 1.4, -0.6},
     10 * DEGREE,
     0,
     {.width = WIDTH, .height = HEIGHT, .samples = 4, .shadows = KRS_SHADOWS_AREA},
     0},
    {BALL_LAMP,
     {-3, 5.5, -1.6},
     0.4,
     0,
     {.width = WIDTH, .height = HEIGHT, .samples = 4, .shadows = KRS_SHADOWS_AREA},
     0},
};

static void crops_are_parts_of_the_picture(void **state)
{
    (void)state;
    static const KrsWindow crops[] = {{133, 77, 101, 60},
                                      {161, 82, 7, 5},
                                      {0, 99, 320, 1},
                                      {187, 0, 1, 180},
                                      {203, 103, 117, 77}};
    for (size_t i = 0; i < sizeof cropped_shots / sizeof cropped_shots[0]; i++) {
        Shot        shot  = cropped_shots[i];
        KrsPicture *whole = shoot(&shot);
        for (size_t k = 0; k < sizeof crops / sizeof crops[0]; k++) {
            shot.options.crop = crops[k];
            KrsPicture *part  = shoot(&shot);
            assert_true(is_part_of(whole, part));
            part->color[4 * (crops[k].width * crops[k].height - 1)] += 1e-6F; /* a planted fault */
            assert_false(is_part_of(whole, part));
            krs_picture_free(part);
        }
        krs_picture_free(whole);
    }
}

/* ---- Planted faults ---- */

static void wrong_area_shadows_are_found(void **state)
{
    (void)state;
    Shot        edge = edge_shot(&lightings[1], KRS_SHADOWS_AREA, 64), wrong = edge;
    KrsPicture *picture = shoot(&edge);
    assert_true(area_is_right("edge", picture, &edge, share_above_edge));
    wrong.wide = 1.1 * edge.wide; /* the light as large as it is not */
    assert_false(width_is_right(picture, &wrong));
    wrong.wide = 1.5 * edge.wide;
    assert_false(area_is_right("edge, PLANTED size", picture, &wrong, share_above_edge));
    wrong = edge;
    wrong.light.x *= 1.03; /* the edge three pixels off */
    assert_false(area_is_right("edge, PLANTED place", picture, &wrong, share_above_edge));
    picture->color[4 * (picture->window.width - 1)] = 0; /* a speck of dust */
    assert_false(area_is_right("edge, PLANTED speck", picture, &edge, share_above_edge));
    krs_picture_free(picture);
}

static void wrong_soft_shadows_are_found(void **state)
{
    (void)state;
    Shot ball                  = ball_shot(&lightings[1], KRS_SHADOWS_SOFT, 4), wrong;
    ball.options.no_upsampling = false;
    KrsPicture *picture        = shoot(&ball);
    assert_true(shared_is_right("ball", picture, &ball, share_by_rays));
    wrong      = ball;
    wrong.wide = 1.5 * ball.wide;
    assert_false(shared_is_right("ball, PLANTED larger light", picture, &wrong, share_by_rays));
    wrong.wide = 0.7 * ball.wide;
    assert_false(shared_is_right("ball, PLANTED smaller light", picture, &wrong, share_by_rays));
    for (int k = 0; k < truths.width * truths.height; k++) /* a ring */
        if (seen_at(picture, k) > 0.5 && seen_at(picture, k) < 0.7)
            picture->color[4 * k] -= 0.2F * picture->color[4 * k + 1];
    assert_false(shared_is_right("ball, PLANTED ring", picture, &ball, share_by_rays));
    krs_picture_free(picture);
}

static void wrong_hard_shadows_are_found(void **state)
{
    (void)state;
    Shot        ball = hard_shot(&hard_cases[1], FROM_ABOVE), wrong = ball;
    KrsPicture *picture = shoot(&ball);
    assert_true(hard_is_right("balls", picture, &ball, 0));
    wrong.light.x *= 1.06; /* three pixels */
    assert_false(hard_is_right("balls, PLANTED place", picture, &wrong, 0));
    picture->color[4 * (20 * WIDTH + 20)] = 0;
    assert_false(hard_is_right("balls, PLANTED speck", picture, &ball, 0));
    krs_picture_free(picture);
}

/* Both what is seen of a few pixels, and holes in shadows. */
static void wrong_pixels_are_found(void **state)
{
    (void)state;
    enum { FEW = 40 };
    Shot        shot  = cropped_shots[1];
    KrsImage    image = {.tone_map = "none"};
    size_t      dark;
    KrsPicture *pictures[2] = {shoot(&shot), shoot(&shot)};
    assert_true(is_unseen(compare_pictures(&image, pictures[0], pictures[1])));
    assert_int_equal(count_holes(pictures, &dark), 0);
    assert_true(dark > FEW);
    for (int k = WIDTH * HEIGHT - 1, left = FEW; left > 0; k--)
        if (seen_at(pictures[1], k) >= 0 && seen_at(pictures[1], k) < 0.5) {
            pictures[0]->color[4 * k] = pictures[0]->color[4 * k + 1];
            left--;
        }
    assert_false(is_unseen(compare_pictures(&image, pictures[0], pictures[1])));
    assert_int_equal(count_holes(pictures, &dark), FEW);
    krs_picture_free(pictures[0]);
    krs_picture_free(pictures[1]);
}

/* ---- All tests ---- */

static int close_all(void **state)
{
    for (int i = 0; i < STAGES; i++) {
        krs_rendering_free(stages[i].rendering);
        product_free(&stages[i].product);
    }
    return renderer_close(state);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(area_shadows_are_shares_of_the_disc),
        cmocka_unit_test(area_shadows_converge),
        cmocka_unit_test(narrow_penumbras_converge),
        cmocka_unit_test(seeds_move_the_rays_to_the_light),
        cmocka_unit_test(soft_shadows_are_shares_of_the_disc),
        cmocka_unit_test(soft_shadows_of_bounds_are_the_same),
        cmocka_unit_test(hard_shadows_end_where_rays_say),
        cmocka_unit_test(lit_sides_are_lit),
        cmocka_unit_test(lit_sides_of_bounds_are_lit),
        cmocka_unit_test(symmetric_scenes_have_symmetric_pictures),
        cmocka_unit_test(sharing_does_not_change_algebraic_surfaces),
        cmocka_unit_test(sharing_does_not_change_examples),
        cmocka_unit_test(upsampling_keeps_thin_shadows),
        cmocka_unit_test(crops_are_parts_of_the_picture),
        cmocka_unit_test(wrong_area_shadows_are_found),
        cmocka_unit_test(wrong_soft_shadows_are_found),
        cmocka_unit_test(wrong_hard_shadows_are_found),
        cmocka_unit_test(wrong_pixels_are_found),
    };
    spirv_start(); /* held for all, so that no renderer starts the shader compiler anew */
    int failed = cmocka_run_group_tests_name("shadows", tests, renderer_open, close_all);
    spirv_stop();
    return failed;
}
