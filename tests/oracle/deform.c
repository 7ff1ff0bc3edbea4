/*
 * Deformed solids against what deformations mean for points.
 *
 * A twist, a bend and a taper are closed formulas that move points, written here once forwards and
 * once backwards.  Backwards they answer "is this point inside?" for the judge, of hundreds of
 * random chains of deformations, also within sequences and of sequences, and at several values of
 * their parameters; forwards they move clouds of surface points, which tell how much of the
 * distance the bound leaves: a bound that is right and useless would be noticed.
 */
#include "tests/oracle/judge.h"
#include "tests/oracle/product.h"

#include <stdio.h>

static const double PI = 3.14159265358979323846;

/* ---- solids ---- */

typedef struct Solid {
    enum { SOLID_BOX, SOLID_BALL, SOLID_ROD } kind;
    Vec centre, half; /* the half size on each axis; the rod is round about y */
} Solid;

static bool solid_contains(const Solid *solid, Vec p)
{
    Vec q = vec_sub(p, solid->centre), h = solid->half;
    if (solid->kind == SOLID_BALL)
        return vec_length(q) <= h.x;
    if (solid->kind == SOLID_ROD)
        return hypot(q.x, q.z) <= h.x && fabs(q.y) <= h.y;
    return fabs(q.x) <= h.x && fabs(q.y) <= h.y && fabs(q.z) <= h.z;
}

static Solid solid_random(Random *random)
{
    Solid solid = {.kind = random_below(random, 3), .centre = random_in_cube(random, 0.5)};
    solid.half  = vec(random_between(random, 0.1, 0.7), random_between(random, 0.1, 1.2),
                      random_between(random, 0.1, 0.7));
    if (solid.kind != SOLID_BOX)
        solid.half.z = solid.half.x;
    if (solid.kind == SOLID_BALL)
        solid.half.y = solid.half.x;
    return solid;
}

static void solid_write(SceneText *text, const Solid *solid)
{
    Vec c = solid->centre, h = solid->half;
    if (solid->kind == SOLID_BALL)
        scene_write(text, "sphere(%.17g)", h.x);
    else if (solid->kind == SOLID_ROD)
        scene_write(text, "cylinder(%.17g, %.17g)", h.x, 2 * h.y);
    else
        scene_write(text, "box([%.17g, %.17g, %.17g])", 2 * h.x, 2 * h.y, 2 * h.z);
    scene_write(text, ".move([%.17g, %.17g, %.17g])", c.x, c.y, c.z);
}

/* ---- deformations ---- */

typedef struct Deed {
    enum { DEED_TWIST, DEED_BEND, DEED_TAPER } kind;
    Vec    axis; /* of unit length; of a taper x, y or z */
    double rate;
    double from, to;  /* factors at the ends of the taper */
    double low, high; /* where they are on the axis */
} Deed;

/* What stands upright for an axis of a bend, and the direction to which it bends. */
static void bend_frame(Vec axis, Vec *along, Vec *lateral)
{
    Vec up   = fabs(axis.y) > 0.999 ? vec(1, 0, 0) : vec(0, 1, 0);
    *along   = vec_unit(vec_sub(up, vec_scale(vec_dot(up, axis), axis)));
    *lateral = vec_cross(axis, *along);
}

static double taper_factor(const Deed *deed, double height)
{
    double t = (height - deed->low) / (deed->high - deed->low);
    return deed->from + (deed->to - deed->from) * fmin(fmax(t, 0), 1);
}

static Vec deed_forward(const Deed *deed, Vec p)
{
    double height = vec_dot(p, deed->axis);
    if (deed->kind == DEED_TWIST)
        return vec_turn(p, deed->axis, deed->rate * height);
    if (deed->kind == DEED_TAPER) {
        Vec on_axis = vec_scale(height, deed->axis);
        return vec_add(on_axis, vec_scale(taper_factor(deed, height), vec_sub(p, on_axis)));
    }
    /* Around the axis of the bend, at the distance 1 / rate. */
    Vec along, lateral;
    bend_frame(deed->axis, &along, &lateral);
    double angle = deed->rate * vec_dot(p, along), radius = 1 / deed->rate - vec_dot(p, lateral);
    Vec    bent = vec_add(vec_scale(radius * sin(angle), along),
                          vec_scale(1 / deed->rate - radius * cos(angle), lateral));
    return vec_add(vec_scale(height, deed->axis), bent);
}

/* Where a point was before; `turn` counts turns about the axis of a bend. */
static Vec deed_backward(const Deed *deed, Vec p, int turn)
{
    double height = vec_dot(p, deed->axis);
    if (deed->kind == DEED_TWIST)
        return vec_turn(p, deed->axis, -deed->rate * height);
    if (deed->kind == DEED_TAPER) {
        Vec on_axis = vec_scale(height, deed->axis);
        return vec_add(on_axis, vec_scale(1 / taper_factor(deed, height), vec_sub(p, on_axis)));
    }
    Vec along, lateral;
    bend_frame(deed->axis, &along, &lateral);
    double side = deed->rate > 0 ? 1 : -1, y = vec_dot(p, along), z = vec_dot(p, lateral);
    double angle  = side * atan2(side * y, side * (1 / deed->rate - z)) + 2 * PI * turn;
    double radius = hypot(y, 1 / deed->rate - z);
    double before = (angle * side) / fabs(deed->rate) * side;
    Vec    flat   = vec_add(vec_scale(before, along),
                            vec_scale(1 / deed->rate - side * radius, lateral));
    return vec_add(vec_scale(height, deed->axis), flat);
}

enum { MOST_DEEDS = 3, MOST_MIRRORS = 4 };

/* A solid, deformed, mirrored, and deformed again. */
typedef struct Chain {
    Solid solid;
    Deed  deeds[MOST_DEEDS];
    int   deed_count;
    Half  mirrors[MOST_MIRRORS]; /* after the first `before` deeds */
    int   mirror_count, before;
} Chain;

/* As many turns about the axis of a bend, either way, as lead back to anything: points that far out
   on the line that was bent are outside of all that is bent here. */
static int deed_turns(const Deed *deed)
{
    const double REACH = 16;
    return deed->kind == DEED_BEND ? (int)((REACH * fabs(deed->rate) / PI + 1) / 2) : 0;
}

static bool contains_before(const Chain *chain, int done, Vec p)
{
    if (done == chain->before)
        for (int i = chain->mirror_count; i-- > 0;) {
            double excess = half_excess(chain->mirrors[i], p);
            if (excess > 0)
                p = vec_sub(p, vec_scale(2 * excess, chain->mirrors[i].normal));
        }
    if (done == 0)
        return solid_contains(&chain->solid, p);
    const Deed *deed  = &chain->deeds[done - 1];
    int         turns = deed_turns(deed);
    for (int turn = -turns; turn <= turns; turn++)
        if (contains_before(chain, done - 1, deed_backward(deed, p, turn)))
            return true;
    return false;
}

static bool chain_contains(const void *chain, Vec p)
{
    const Chain *c = chain;
    return contains_before(c, c->deed_count, p);
}

/* Only of the first is it known how far what it deforms reaches: others do not bend so much that
   they could meet the axis, and do not taper. */
static Deed deed_random(Random *random, const Solid *solid, bool first)
{
    static const Vec axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    Deed             deed    = {.kind = random_below(random, first ? 3 : 2)};
    double           side    = random_below(random, 2) ? 1 : -1;
    int              axis    = random_below(random, 3);
    deed.axis = deed.kind != DEED_TAPER && random_below(random, 3) == 0 ? random_unit(random)
                                                                        : axes[axis];
    deed.rate = side * pow(10, random_between(random, -2, deed.kind == DEED_TWIST ? 0.3 : -0.1));
    if (deed.kind == DEED_BEND) {
        double reach = first ? vec_length(solid->centre) + vec_length(solid->half) : 5;
        deed.rate    = side * random_between(random, 0.02, 0.95) / reach;
    }
    deed.from = random_between(random, 0.2, 1.8);
    deed.to   = random_between(random, 0.2, 1.8);
    deed.low  = vec_dot(vec_sub(solid->centre, solid->half), deed.axis);
    deed.high = vec_dot(vec_add(solid->centre, solid->half), deed.axis);
    return deed;
}

static void deed_write(SceneText *text, const Deed *deed, const char *rate)
{
    static const char *const names[] = {"twist", "bend", "taper"};
    scene_write(text, ".%s([%.17g, %.17g, %.17g], ", names[deed->kind], deed->axis.x, deed->axis.y,
                deed->axis.z);
    if (deed->kind == DEED_TAPER)
        scene_write(text, "from: %.17g, to: %.17g)", deed->from, deed->to);
    else if (rate)
        scene_write(text, "rate: %s)", rate);
    else
        scene_write(text, "rate: %.17g)", deed->rate);
}

static void chain_write(SceneText *text, const Chain *chain, const char *rate)
{
    if (chain->mirror_count)
        scene_write(text, "show krs { kernel ");
    else
        scene_write(text, "show ");
    solid_write(text, &chain->solid);
    for (int i = 0; i < chain->before; i++)
        deed_write(text, &chain->deeds[i], rate);
    for (int i = 0; i < chain->mirror_count; i++) {
        Half mirror = chain->mirrors[i];
        scene_write(text, "; reflect plane([%.17g, %.17g, %.17g], %.17g)", mirror.normal.x,
                    mirror.normal.y, mirror.normal.z, mirror.offset);
    }
    if (chain->mirror_count)
        scene_write(text, "; }");
    for (int i = chain->before; i < chain->deed_count; i++)
        deed_write(text, &chain->deeds[i], rate);
    scene_write(text, ";\n");
}

static Chain chain_random(Random *random, int deeds, int mirrors)
{
    Chain chain  = {.solid = solid_random(random), .deed_count = deeds, .mirror_count = mirrors};
    chain.before = mirrors ? random_below(random, deeds + 1) : deeds;
    for (int i = 0; i < deeds; i++)
        chain.deeds[i] = deed_random(random, &chain.solid, i == 0 && chain.before > 0);
    for (int i = 0; i < mirrors; i++)
        chain.mirrors[i] = (Half){random_unit(random), random_between(random, -0.2, 0.6)};
    return chain;
}

/* ---- never above the distance ---- */

static Trial chain_trial(const Product *product, const Chain *chain, uint64_t seed)
{
    return (Trial){product_field, product, chain_contains, chain, vec(0, 0, 0), 3, 250, seed};
}

static void check_chain(const Chain *chain, uint64_t seed)
{
    SceneText text = {.length = 0};
    chain_write(&text, chain, NULL);
    Product product = product_compile(text.bytes);
    Trial   near = chain_trial(&product, chain, seed), far = near;
    far.half   = 30;
    far.points = 60;
    judge_acquits(&near, text.bytes);
    judge_acquits(&far, text.bytes);
    product_free(&product);
}

static void one_is_safe(void **state)
{
    (void)state;
    Random random = {101};
    for (int i = 0; i < 120; i++) {
        Chain chain = chain_random(&random, 1, 0);
        check_chain(&chain, (uint64_t)i);
    }
}

static void several_are_safe(void **state)
{
    (void)state;
    Random random = {102};
    for (int i = 0; i < 80; i++) {
        Chain chain = chain_random(&random, 2 + random_below(&random, 2), 0);
        check_chain(&chain, (uint64_t)i);
    }
}

static void sequences_are_safe(void **state)
{
    (void)state;
    Random random = {103};
    for (int i = 0; i < 80; i++) {
        Chain chain = chain_random(&random, 1 + random_below(&random, 2),
                                   1 + random_below(&random, MOST_MIRRORS));
        check_chain(&chain, (uint64_t)i);
    }
}

/* Around the axis more than once, forwards and backwards. */
static void long_bends_are_safe(void **state)
{
    (void)state;
    Random random = {104};
    for (int i = 0; i < 24; i++) {
        Chain chain        = {.deed_count = 1, .before = 1};
        chain.solid        = (Solid){SOLID_BOX, {0, 0, 0}, {0.3, 3, 0.2}};
        chain.solid.kind   = random_below(&random, 2) ? SOLID_BOX : SOLID_ROD;
        chain.solid.centre = vec(0, random_between(&random, -3, 3), 0);
        double turn        = (i % 2 ? 1 : -1) * random_between(&random, 0.3, 2.5) * PI;
        chain.deeds[0]     = (Deed){DEED_BEND, {1, 0, 0}, turn / 6, 1, 1, 0, 1};
        if (chain.solid.kind == SOLID_ROD)
            chain.solid.half.z = chain.solid.half.x;
        check_chain(&chain, (uint64_t)i);
    }
}

/* The parts of a long bend have no walls between them: no surface is near the middle of a ring. */
static void rings_are_solid(void **state)
{
    (void)state;
    Product ring = product_compile("show cylinder(0.2, 6).bend([1, 0, 0], 1);");
    for (int i = 0; i <= 1000; i++) {
        double angle = -3 + 0.006 * i, depth = fmin(0.2, 3 - fabs(angle));
        Vec    p = vec(0, sin(angle), 1 - cos(angle));
        assert_true(product_distance(&ring, p) <= -0.5 * depth);
    }
    product_free(&ring);
}

/* ---- parameters and time ---- */

static void frames_are_safe(void **state)
{
    (void)state;
    Random random = {105};
    for (int i = 0; i < 30; i++) {
        Chain chain = chain_random(&random, 1, 0);
        while (chain.deeds[0].kind == DEED_TAPER)
            chain = chain_random(&random, 1, 0);
        Deed     *deed = &chain.deeds[0];
        double    most = fabs(deed->rate);
        SceneText text = {.length = 0};
        scene_write(&text, "param k = 0 in [%.17g, %.17g];\n", -most, most);
        chain_write(&text, &chain, "k * cos(time)");
        Product product = product_compile(text.bytes);
        for (int frame = 0; frame < 5; frame++) {
            double k    = frame ? random_between(&random, -most, most) : 0;
            double time = random_between(&random, -9, 9);
            assert_int_equal(krs_frame_set(product.frame, "k", &k, 1), KRS_OK);
            assert_int_equal(krs_frame_set_time(product.frame, time), KRS_OK);
            deed->rate  = frame ? k * cos(time) : 1e-9; /* the formulas here divide by it */
            Trial trial = chain_trial(&product, &chain, (uint64_t)i);
            judge_acquits(&trial, text.bytes);
        }
        product_free(&product);
    }
}

/* Nor do factors of a taper that move. */
static void moving_tapers_are_safe(void **state)
{
    (void)state;
    Random random = {109};
    for (int i = 0; i < 10; i++) {
        Chain chain = chain_random(&random, 1, 0);
        Deed *deed  = &chain.deeds[0];
        if (deed->kind != DEED_TAPER)
            continue;
        SceneText text = {.length = 0};
        scene_write(&text, "param a = 1 in [0.3, 1.5]; show ");
        solid_write(&text, &chain.solid);
        scene_write(&text, ".taper([%g, %g, %g], from: a, to: 0.9 + 0.3 * sin(a + time));",
                    deed->axis.x, deed->axis.y, deed->axis.z);
        Product product = product_compile(text.bytes);
        for (int frame = 0; frame < 5; frame++) {
            double time = random_between(&random, -9, 9);
            deed->from  = random_between(&random, 0.3, 1.5);
            deed->to    = 0.9 + 0.3 * sin(deed->from + time);
            assert_int_equal(krs_frame_set(product.frame, "a", &deed->from, 1), KRS_OK);
            assert_int_equal(krs_frame_set_time(product.frame, time), KRS_OK);
            Trial trial = chain_trial(&product, &chain, (uint64_t)i);
            judge_acquits(&trial, text.bytes);
        }
        product_free(&product);
    }
}

/* No range is needed for a twist. */
static void a_twist_needs_no_range(void **state)
{
    (void)state;
    Chain chain    = {.solid = {SOLID_BOX, {0, 0, 0}, {0.4, 1, 0.3}}, .deed_count = 1, .before = 1};
    chain.deeds[0] = (Deed){DEED_TWIST, {0, 1, 0}, 0, 1, 1, 0, 1};
    SceneText text = {.length = 0};
    scene_write(&text, "param k = 0;\n");
    chain_write(&text, &chain, "k + 0.3 * time");
    Product product = product_compile(text.bytes);
    for (int i = 0; i < 8; i++) {
        double k = i - 4, time = 0.7 * i;
        assert_int_equal(krs_frame_set(product.frame, "k", &k, 1), KRS_OK);
        assert_int_equal(krs_frame_set_time(product.frame, time), KRS_OK);
        chain.deeds[0].rate = k + 0.3 * time;
        Trial trial         = chain_trial(&product, &chain, (uint64_t)i);
        judge_acquits(&trial, text.bytes);
    }
    product_free(&product);
}

/* ---- displacement ---- */

typedef struct Bumps {
    const char *text;
    double (*value)(Vec p);
    double amplitude;
    Solid  solid; /* a box or a ball, whose exact distance is the start */
} Bumps;

static double waves(Vec p) { return sin(3 * p.x) * cos(2 * p.y) + 0.3 * sin(5 * p.z); }
static double slope(Vec p) { return 0.5 * p.x - 0.2 * p.y * p.z; }
static double ripples(Vec p) { return cos(9 * vec_length(p)); }

static double solid_distance(const Solid *solid, Vec p)
{
    Vec q = vec_sub(p, solid->centre), h = solid->half;
    if (solid->kind == SOLID_BALL)
        return vec_length(q) - h.x;
    double x = fabs(q.x) - h.x, y = fabs(q.y) - h.y, z = fabs(q.z) - h.z;
    return vec_length(vec(fmax(x, 0), fmax(y, 0), fmax(z, 0))) + fmin(fmax(x, fmax(y, z)), 0);
}

static bool inside_bumps(const void *user, Vec p)
{
    const Bumps *bumps = user;
    return solid_distance(&bumps->solid, p) - bumps->amplitude * bumps->value(p) <= 0;
}

static void displacements_are_safe(void **state)
{
    static const struct {
        const char *text;
        double (*value)(Vec p);
    } fields[] = {{"sin(3 * x) * cos(2 * y) + 0.3 * sin(5 * z)", waves},
                  {"0.5 * x - 0.2 * y * z", slope},
                  {"cos(9 * length(p))", ripples}};
    (void)state;
    Random random = {106};
    for (int i = 0; i < 60; i++) {
        int       field  = i % 3;
        Bumps     bumps  = {fields[field].text, fields[field].value, 0, solid_random(&random)};
        SceneText text   = {.length = 0};
        bumps.solid.kind = i % 2 ? SOLID_BALL : SOLID_BOX;
        scene_write(&text, "param a = 0 in [-0.5, 0.5]; show ");
        solid_write(&text, &bumps.solid);
        scene_write(&text, ".displace(%s, amplitude: a);", bumps.text);
        Product product = product_compile(text.bytes);
        for (int frame = 0; frame < 3; frame++) {
            bumps.amplitude = random_between(&random, -0.5, 0.5);
            assert_int_equal(krs_frame_set(product.frame, "a", &bumps.amplitude, 1), KRS_OK);
            Trial trial = {product_field, &product, inside_bumps, &bumps,
                           vec(0, 0, 0),  3,        250,          (uint64_t)i};
            judge_acquits(&trial, text.bytes);
            trial.half   = 30;
            trial.points = 60;
            if (bumps.value != slope) /* far away, where it is large, it is cut off */
                judge_acquits(&trial, text.bytes);
        }
        product_free(&product);
    }
}

/* What has no closed form is safe for what its sign says (of noise: property/noise.c). */
static bool is_negative(const void *product, Vec p) { return product_distance(product, p) <= 0; }

static void others_are_safe(void **state)
{
    static const char *const shapes[] = {
        "sphere(1).displace(noise(3 * p), 0.3)",
        "box([1, 2, 1]).displace(fbm(2 * p, 4), 0.5)",
        "plane([0, 1, 0], 0).displace(fbm([x, z], 3, gain: 0.4), 0.4)",
        "torus(1, 0.3).displace(fbm(p + [0, 3 * time, 0], 3, lacunarity: 2.3), 0.3)",
        "sphere(1).displace(noise(4 * p), 0.2).twist([0, 1, 0], 1).bend([1, 0, 0], 0.4)",
        "sphere(0.5).scale([1, 1, 3]).displace(noise(2 * p), 0.6)",
        "box([1, 1, 1]).twist([0, 1, 0], 2).displace(noise([x, 2 * y]), 0.4)",
        "ellipsoid([0.3, 1, 0.2]).displace(cos(3 * x) + 1, 0.4)",
        "union(sphere(0.6), box([1, 1, 1]).move([0.5, 0.4, 0]), blend: 0.6, kind: \"chamfer\")"
        ".twist([0, 1, 0], 0.3)",
        "union(sphere(0.6), box([1, 1, 1]).move([0.5, 0.4, 0]), blend: 0.6, kind: \"chamfer\")"
        ".displace(x, 0.01)"};
    (void)state;
    for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++) {
        Product product = product_format("show %s;", shapes[i]);
        Trial   trial   = {product_field, &product, is_negative, &product, vec(0, 0, 0), 2, 400, i};
        assert_int_equal(krs_frame_set_time(product.frame, 7), KRS_OK);
        judge_acquits(&trial, shapes[i]);
        product_free(&product);
    }
}

/* Below a ball, far from it, and where the taper narrows towards it: all that makes its bound steep
   comes together, which is rare. */
static void narrowing_is_safe(void **state)
{
    static const char text[] = "show (sphere(0.05).move([0, 0.85, 0]) |"
                               "      sphere(0.05).move([0.95, 0, 0]) |"
                               "      sphere(0.05).move([0, 2.8, 0]))"
                               "    .taper([0, 1, 0], from: 1, to: 0.3);";
    (void)state;
    Product product = product_compile(text);
    Trial   trial   = {product_field, &product, is_negative, &product, vec(0, 0, 0), 0.08, 300, 5};
    judge_acquits(&trial, text);
    product_free(&product);
}

/* ---- how much of the distance is left ---- */

/* A piece of the surface of a solid, moved. */
typedef struct Piece {
    const Chain *chain;
    int          number;
} Piece;

static Vec solid_point(const Solid *solid, int piece, double u, double v)
{
    Vec    h = solid->half, q = vec(0, 0, 0);
    double a = 2 * PI * u, s = 2 * u - 1, t = 2 * v - 1, side = piece % 2 ? 1 : -1;
    if (solid->kind == SOLID_BALL)
        q = vec(h.x * sin(PI * v) * cos(a), h.x * cos(PI * v), h.x * sin(PI * v) * sin(a));
    else if (solid->kind == SOLID_ROD && piece == 2)
        q = vec(h.x * cos(a), h.y * t, h.x * sin(a));
    else if (solid->kind == SOLID_ROD)
        q = vec(h.x * v * cos(a), h.y * side, h.x * v * sin(a));
    else if (piece / 2 == 0)
        q = vec(h.x * side, h.y * s, h.z * t);
    else if (piece / 2 == 1)
        q = vec(h.x * s, h.y * side, h.z * t);
    else
        q = vec(h.x * s, h.y * t, h.z * side);
    return vec_add(solid->centre, q);
}

static Vec piece_point(const void *user, double u, double v)
{
    const Piece *piece = user;
    Vec          p     = solid_point(&piece->chain->solid, piece->number, u, v);
    for (int i = 0; i < piece->chain->deed_count; i++)
        p = deed_forward(&piece->chain->deeds[i], p);
    return p;
}

static Cloud chain_cloud(const Chain *chain)
{
    static const int pieces[] = {[SOLID_BOX] = 6, [SOLID_BALL] = 1, [SOLID_ROD] = 3};
    Cloud            cloud    = {0};
    for (int i = 0; i < pieces[chain->solid.kind]; i++) {
        Piece piece = {chain, i};
        cloud_patch(&cloud, piece_point, NULL, &piece, 0.03);
    }
    return cloud;
}

/* The scene's box holds all of it and, where no box had to be turned, is not much larger. */
static void check_box(const Product *product, const Cloud *cloud, const Chain *chain,
                      const char *text)
{
    Vec    axis = chain->deeds[0].axis;
    double most = chain->deed_count == 1 && fmax(axis.x, fmax(axis.y, axis.z)) == 1 ? 1.7 : 100;
    KrsComponent component;
    Vec          low = vec(HUGE_VAL, HUGE_VAL, HUGE_VAL), high = vec_scale(-1, low);
    assert_int_equal(krs_component(product->scene, 0, &component), KRS_OK);
    for (size_t i = 0; i < cloud->count; i++) {
        Vec p = cloud->points[i];
        low   = vec(fmin(low.x, p.x), fmin(low.y, p.y), fmin(low.z, p.z));
        high  = vec(fmax(high.x, p.x), fmax(high.y, p.y), fmax(high.z, p.z));
    }
    const double *l = component.low, *h = component.high;
    bool          holds = l[0] <= low.x + 1e-9 && l[1] <= low.y + 1e-9 && l[2] <= low.z + 1e-9 &&
                 h[0] >= high.x - 1e-9 && h[1] >= high.y - 1e-9 && h[2] >= high.z - 1e-9;
    double size  = vec_distance(low, high),
           given = vec_distance(vec(l[0], l[1], l[2]), vec(h[0], h[1], h[2]));
    if (!holds || given > most * size)
        fail_msg("the box of %s from (%g, %g, %g) to (%g, %g, %g)%s", text, l[0], l[1], l[2], h[0],
                 h[1], h[2], holds ? " is too large" : " leaves something out");
}

/* Mean of bound over distance, for points within `half`, outside of the solid and not near it. */
static double mean_share(const Product *product, const Chain *chain, Cloud *cloud, double half,
                         Random *random)
{
    double sum   = 0;
    int    count = 0;
    for (int i = 0; i < 400; i++) {
        Vec    p        = random_in_cube(random, half);
        double distance = cloud_nearest(cloud, p), bound = product_distance(product, p);
        if (fabs(bound) > distance + 1e-9)
            fail_msg("at (%g, %g, %g) %.9g, but a surface point is %.9g away", p.x, p.y, p.z, bound,
                     distance);
        if (chain_contains(chain, p) || distance < 5 * cloud->spacing)
            continue;
        sum += bound / distance;
        count++;
    }
    return count ? sum / count : 1;
}

typedef struct Shares {
    const char *name;
    int         kind; /* of all deeds; -1: any */
    int         deeds;
    double      near, far; /* at least, on average */
} Shares;

static void bounds_are_of_use(void **state)
{
    const Shares *shares = *state;
    enum { CHAINS = 25 };
    Random random = {107};
    double near = 0, far = 0;
    int    count = 0;
    for (int i = 0; count < CHAINS; i++) {
        Chain chain = chain_random(&random, shares->deeds, 0);
        if (shares->kind >= 0 && (int)chain.deeds[0].kind != shares->kind)
            continue;
        SceneText text = {.length = 0};
        chain_write(&text, &chain, NULL);
        Product product = product_compile(text.bytes);
        Cloud   cloud   = chain_cloud(&chain);
        check_box(&product, &cloud, &chain, text.bytes);
        near += mean_share(&product, &chain, &cloud, 1.5, &random) / CHAINS;
        far += mean_share(&product, &chain, &cloud, 20, &random) / CHAINS;
        count++;
        cloud_free(&cloud);
        product_free(&product);
    }
    printf("# %s: %.3f of the distance near, %.3f far\n", shares->name, near, far);
    assert_true(near >= shares->near && far >= shares->far);
}

/* ---- what materials see ---- */

/* Colours are the place and the normal in the space where the paint stands: those of the solid that
   was not deformed. */
static void check_face(const Product *places, const Product *normals, const Chain *chain, Vec face,
                       Vec normal)
{
    Vec    p     = deed_forward(&chain->deeds[0], face);
    KrsHit place = product_probe(places, p), hit = product_probe(normals, p);
    Vec    seen  = vec(hit.color[0], hit.color[1], hit.color[2]);
    Vec    where = vec(place.color[0] - 0.5, place.color[1] - 0.5, place.color[2] - 0.5);
    assert_true(vec_distance(vec_scale(2, where), face) < 1e-6);
    assert_true(vec_distance(vec_sub(vec_scale(2, seen), vec(1, 1, 1)), normal) < 2e-3);
}

static void materials_see_the_solid(void **state)
{
    (void)state;
    Random random = {110};
    for (int i = 0; i < 40; i++) {
        Chain chain        = {.deed_count = 1, .before = 1};
        chain.solid        = (Solid){SOLID_BOX, {0, 0, 0}, {0.3, 0.8, 0.4}};
        chain.deeds[0]     = deed_random(&random, &chain.solid, true);
        SceneText texts[2] = {{.length = 0}, {.length = 0}};
        for (int k = 0; k < 2; k++) {
            scene_write(&texts[k], "show box([0.6, 1.6, 0.8]).paint(%s)",
                        k ? "0.5 + 0.5 * normal" : "0.5 + 0.5 * p");
            deed_write(&texts[k], &chain.deeds[0], NULL);
            scene_write(&texts[k], ";");
        }
        Product places = product_compile(texts[0].bytes), normals = product_compile(texts[1].bytes);
        for (int face = 0; face < 6; face++) {
            double u = random_between(&random, -0.9, 0.9), v = random_between(&random, -0.9, 0.9);
            double side = face % 2 ? 1 : -1;
            Vec    h    = chain.solid.half;
            Vec    p    = face / 2 == 0   ? vec(h.x * side, h.y * u, h.z * v)
                          : face / 2 == 1 ? vec(h.x * u, h.y * side, h.z * v)
                                          : vec(h.x * u, h.y * v, h.z * side);
            Vec    n    = vec_scale(side, vec(face / 2 == 0, face / 2 == 1, face / 2 == 2));
            check_face(&places, &normals, &chain, p, n);
        }
        product_free(&places);
        product_free(&normals);
    }
}

/* Where smooth mirrors change nothing, light sees the normal that there is: it has gone into the
   space of the kernels and come out again. */
static void normals_come_out_again(void **state)
{
    static const char *const deeds[] = {
        ".twist([0, 1, 0], 0.9)",         ".bend([1, 0, 0], 0.5)",
        ".bend([0, 0, 1], 0.9)",          ".taper([0, 1, 0], 1, 0.4)",
        ".displace(sin(4 * x + y), 0.1)", ".taper([1, 0, 0], 0.5, 1.2).twist([1, 1, 0], 0.7)"};
    (void)state;
    Random random = {111};
    for (size_t i = 0; i < sizeof deeds / sizeof *deeds; i++) {
        Product product = product_format("let a = box([0.4, 1.5, 0.3]).move([-0.4, 0, 0.1]);"
                                         "show krs { kernel a; reflect plane([1, 0.1, 0], 0.05); }"
                                         ".smooth_mirrors(0.001)%s;",
                                         deeds[i]);
        int     seen = 0, wrong = 0;
        for (int k = 0; k < 3000; k++) {
            Vec    p   = random_in_cube(&random, 1);
            KrsHit hit = product_probe(&product, p);
            Vec    n   = vec(hit.normal[0], hit.normal[1], hit.normal[2]);
            if (fabs(hit.distance) > 0.05)
                continue;
            /* On the surface, inside of C, the normal is a gradient of the child's distance. */
            p   = vec_sub(p, vec_scale(1.2 * hit.distance + 1e-3, n));
            hit = product_probe(&product, p);
            if (hit.distance > 0 || hit.distance < -0.02)
                continue;
            n         = vec(hit.normal[0], hit.normal[1], hit.normal[2]);
            Vec light = vec(hit.shading[0], hit.shading[1], hit.shading[2]);
            seen++;
            wrong += vec_distance(n, light) > 0.01;
        }
        if (seen < 20 || wrong * 20 > seen)
            fail_msg("%s: %d of %d normals are not those of the surface", deeds[i], wrong, seen);
        product_free(&product);
    }
}

/* ---- the judge would have noticed ---- */

static void larger_bounds_are_refuted(void **state)
{
    (void)state;
    Random random  = {108};
    int    refuted = 0;
    enum { CHAINS = 30 };
    for (int i = 0; i < CHAINS; i++) {
        Chain     chain = chain_random(&random, 1, 0);
        SceneText text  = {.length = 0};
        chain_write(&text, &chain, NULL);
        Product      product = product_compile(text.bytes);
        Exaggeration wrong   = {product_field, &product, 1.5};
        Trial        trial   = chain_trial(&product, &chain, (uint64_t)i);
        trial.field          = exaggerated_field;
        trial.field_user     = &wrong;
        Verdict verdict      = judge(&trial);
        refuted += verdict.ball_errors > 0 && verdict.slope_errors > 0;
        product_free(&product);
    }
    assert_true(refuted >= CHAINS * 3 / 4);
}

/* The shape stands along y and bends about x, to z; a positive rate turns like a screw. */
static void directions_are_as_written(void **state)
{
    (void)state;
    Product bent = product_compile("show box([0.2, 2, 0.2]).move([0, 1, 0]).bend([1, 0, 0], 0.5);");
    assert_true(product_distance(&bent, vec(0, sin(1) / 0.5, (1 - cos(1)) / 0.5)) < 0.02);
    assert_true(product_distance(&bent, vec(0, sin(1) / 0.5, -(1 - cos(1)) / 0.5)) > 0.5);
    product_free(&bent);
    Product twisted = product_compile("show box([0.2, 4, 0.2]).move([1, 0, 0])"
                                      ".twist([0, 1, 0], 1);");
    assert_true(product_distance(&twisted, vec(cos(1.5), 1.5, -sin(1.5))) < 0);
    product_free(&twisted);
    Product tapered = product_compile("show box([2, 2, 2]).taper([0, 1, 0], from: 1, to: 0.5);");
    assert_true(product_distance(&tapered, vec(0.9, -0.99, 0)) < 0);
    assert_true(product_distance(&tapered, vec(0.6, 0.99, 0)) > 0);
    product_free(&tapered);
    Product grown = product_compile("show sphere(1).displace(1, 0.25);");
    assert_true(fabs(product_distance(&grown, vec(2, 0, 0)) - 0.75) < 1e-9);
    product_free(&grown);
}

int main(void)
{
    static Shares           shares[] = {{"twist", DEED_TWIST, 1, 0.7, 0.9},
                                        {"bend", DEED_BEND, 1, 0.75, 0.9},
                                        {"taper", DEED_TAPER, 1, 0.6, 0.9},
                                        {"three deformations", -1, 3, 0.55, 0.85}};
    const struct CMUnitTest tests[]  = {
         cmocka_unit_test(directions_are_as_written),
         cmocka_unit_test(one_is_safe),
         cmocka_unit_test(several_are_safe),
         cmocka_unit_test(sequences_are_safe),
         cmocka_unit_test(long_bends_are_safe),
         cmocka_unit_test(rings_are_solid),
         cmocka_unit_test(frames_are_safe),
         cmocka_unit_test(moving_tapers_are_safe),
         cmocka_unit_test(a_twist_needs_no_range),
         cmocka_unit_test(displacements_are_safe),
         cmocka_unit_test(others_are_safe),
         cmocka_unit_test(narrowing_is_safe),
         {"twists are of use", bounds_are_of_use, NULL, NULL, &shares[0]},
         {"bends are of use", bounds_are_of_use, NULL, NULL, &shares[1]},
         {"tapers are of use", bounds_are_of_use, NULL, NULL, &shares[2]},
         {"chains are of use", bounds_are_of_use, NULL, NULL, &shares[3]},
         cmocka_unit_test(materials_see_the_solid),
         cmocka_unit_test(normals_come_out_again),
         cmocka_unit_test(larger_bounds_are_refuted),
    };
    return cmocka_run_group_tests_name("deformations", tests, NULL, NULL);
}
