/*
 * Sequences with conformal maps against the same sets as clouds of points.
 *
 * Random chains of kernels, mirrors and maps, nested and placed by maps, near poles and far from
 * them.  The clouds are made by applying every statement to every point, and a point is inside
 * when the statements, undone one by one, bring it into a kernel: inversions are done by their
 * definition, one elementary map after the other, and nothing here knows a bound.  The distance
 * of the compiler must never exceed the distance to any point of the cloud, be positive outside
 * and only there; rays must end where the set begins; the box must hold all points.  That the
 * clouds are dense enough to notice is shown by the distance without the bound, which they must
 * refute.
 */
#include "compiler/program.h"
#include "tests/oracle/brute.h"
#include "tests/oracle/judge.h"
#include "tests/oracle/product.h"

#include <stdio.h>
#include <stdlib.h>

/* ---- elementary maps ---- */

typedef struct Elementary {
    enum { TRANSLATE, ROTATE, SCALE, REFLECT, INVERT } kind;
    Vec    vector; /* way, axis, normal or centre */
    double number; /* angle, factor, offset or radius */
} Elementary;

/* Applied from the first to the last. */
typedef struct Word {
    Elementary letters[6];
    int        count;
} Word;

static void word_add(Word *word, int kind, Vec vector, double number)
{
    word->letters[word->count++] = (Elementary){kind, vector, number};
}

static Vec elementary_apply(const Elementary *l, Vec p, bool undo)
{
    Vec z = vec_sub(p, l->vector);
    switch (l->kind) {
    case TRANSLATE: return undo ? z : vec_add(p, l->vector);
    case ROTATE: return vec_turn(p, l->vector, undo ? -l->number : l->number);
    case SCALE: return vec_scale(undo ? 1 / l->number : l->number, p);
    case REFLECT: return vec_sub(p, vec_scale(2 * (vec_dot(l->vector, p) - l->number), l->vector));
    case INVERT: return vec_add(l->vector, vec_scale(l->number * l->number / vec_dot(z, z), z));
    }
    return p;
}

static Vec word_apply(const Word *word, Vec p)
{
    for (int i = 0; i < word->count; i++)
        p = elementary_apply(&word->letters[i], p, false);
    return p;
}

/* Also how much larger things become near the point on the way back. */
static Vec word_undo(const Word *word, Vec p, double *scale)
{
    for (int i = word->count; i-- > 0;) {
        const Elementary *l = &word->letters[i];
        if (l->kind == SCALE)
            *scale /= l->number;
        if (l->kind == INVERT)
            *scale *= pow(l->number / vec_distance(p, l->vector), 2);
        p = elementary_apply(l, p, true);
    }
    return p;
}

static void write_word(SceneText *text, const Word *word)
{
    if (word->count == 0)
        scene_write(text, "identity");
    for (int i = word->count; i-- > 0;) {
        const Elementary *l = &word->letters[i];
        double            x = l->vector.x, y = l->vector.y, z = l->vector.z, n = l->number;
        switch (l->kind) {
        case TRANSLATE: scene_write(text, "translate([%.17g, %.17g, %.17g])", x, y, z); break;
        case ROTATE: scene_write(text, "rotate([%.17g, %.17g, %.17g], %.17g)", x, y, z, n); break;
        case SCALE: scene_write(text, "scale(%.17g)", n); break;
        case REFLECT:
            scene_write(text, "reflect(plane([%.17g, %.17g, %.17g], %.17g))", x, y, z, n);
            break;
        case INVERT:
            scene_write(text, "invert([%.17g, %.17g, %.17g], radius: %.17g)", x, y, z, n);
            break;
        }
        scene_write(text, i ? " * " : "");
    }
}

/* ---- sequences ---- */

/* The points within `radius` of a segment, or a turned box; or the set of another sequence. */
typedef struct Kernel {
    const struct Chain *chain;
    bool                box;
    Vec                 from, to, sides, axis;
    double              angle, radius;
    Word                placed;
} Kernel;

typedef struct Statement {
    enum { KERNEL, MIRROR, MAP } kind;
    Kernel kernel;
    Half   mirror;
    Word   map;
} Statement;

enum { MOST_STATEMENTS = 40 };

typedef struct Chain {
    Statement statements[MOST_STATEMENTS];
    int       count, mirrors;
} Chain;

static Vec chain_undo_mirror(Half mirror, Vec p)
{
    double e = half_excess(mirror, p);
    return e > 0 ? vec_sub(p, vec_scale(2 * e, mirror.normal)) : p;
}

/* The distance to a kernel in its own space, exact; negative inside. */
static double solid_distance(const Kernel *k, Vec p)
{
    Vec q = vec_turn(vec_sub(p, k->from), k->axis, -k->angle);
    if (k->box) {
        Vec d = vec(fabs(q.x) - k->sides.x, fabs(q.y) - k->sides.y, fabs(q.z) - k->sides.z);
        Vec o = vec(fmax(d.x, 0), fmax(d.y, 0), fmax(d.z, 0));
        return vec_length(o) + fmin(fmax(d.x, fmax(d.y, d.z)), 0);
    }
    Vec    offset = vec_sub(k->to, k->from), z = vec_sub(p, k->from);
    double along = vec_dot(offset, offset) > 0 ? vec_dot(z, offset) / vec_dot(offset, offset) : 0;
    along        = fmax(0, fmin(1, along));
    return vec_distance(z, vec_scale(along, offset)) - k->radius;
}

/* What is nearest by the distance without the bound, d over the scale of the maps. */
typedef struct Nearest {
    double   naive;
    uint32_t level, id; /* of the outermost sequence */
} Nearest;

static double naive_distance(const Chain *chain, Vec p, double scale, Nearest *nearest)
{
    double   best  = HUGE_VAL;
    uint32_t level = (uint32_t)chain->mirrors, id = 1;
    for (int i = chain->count; i-- > 0;) {
        const Statement *s = &chain->statements[i];
        if (s->kind == MAP)
            p = word_undo(&s->map, p, &scale);
        if (s->kind == MIRROR) {
            id = 2 * id + (half_excess(s->mirror, p) > 0);
            p  = chain_undo_mirror(s->mirror, p);
            level--;
        }
        if (s->kind != KERNEL)
            continue;
        double inner = scale;
        Vec    q     = word_undo(&s->kernel.placed, p, &inner);
        double d     = s->kernel.chain ? naive_distance(s->kernel.chain, q, inner, NULL)
                                       : solid_distance(&s->kernel, q) / inner;
        if (d < best) {
            best = d;
            if (nearest)
                *nearest = (Nearest){d, level, id};
        }
    }
    return best;
}

static bool chain_contains(const void *chain, Vec p)
{
    return naive_distance(chain, p, 1, NULL) <= 0;
}

/* ---- clouds ---- */

typedef struct Points {
    Vec   *items;
    size_t count, capacity;
} Points;

static void points_add(Points *points, Vec p)
{
    if (!(vec_dot(p, p) < 1e24))
        return; /* infinity */
    if (points->count == points->capacity) {
        points->capacity = 2 * points->capacity + 256;
        points->items    = realloc(points->items, points->capacity * sizeof *points->items);
        assert_non_null(points->items);
    }
    points->items[points->count++] = p;
}

static Vec random_on_solid(const Kernel *k, Random *random)
{
    if (k->box) {
        Vec    q = random_in_cube(random, 1);
        double m = fmax(fabs(q.x), fmax(fabs(q.y), fabs(q.z)));
        q        = vec(q.x / m * k->sides.x, q.y / m * k->sides.y, q.z / m * k->sides.z);
        return vec_add(k->from, vec_turn(q, k->axis, k->angle));
    }
    Vec offset = vec_sub(k->to, k->from), u = random_unit(random);
    Vec end = vec_dot(u, offset) > 0 ? k->to : k->from;
    if (random_below(random, 2) || vec_length(offset) == 0)
        return vec_add(end, vec_scale(k->radius, u));
    Vec across = vec_unit(vec_cross(offset, u));
    return vec_add(vec_add(k->from, vec_scale(random_between(random, 0, 1), offset)),
                   vec_scale(k->radius, across));
}

static void chain_points(const Chain *chain, int each, Random *random, Points *points)
{
    for (int i = 0; i < chain->count; i++) {
        const Statement *s = &chain->statements[i];
        if (s->kind == KERNEL && s->kernel.chain) {
            Points inner = {0};
            chain_points(s->kernel.chain, each, random, &inner);
            for (size_t k = 0; k < inner.count; k++)
                points_add(points, word_apply(&s->kernel.placed, inner.items[k]));
            free(inner.items);
        } else if (s->kind == KERNEL) {
            for (int k = 0; k < each; k++)
                points_add(points,
                           word_apply(&s->kernel.placed, random_on_solid(&s->kernel, random)));
        } else {
            Points before = *points;
            *points       = (Points){0};
            for (size_t k = 0; k < before.count; k++) {
                Vec    p = before.items[k];
                double e = s->kind == MIRROR ? half_excess(s->mirror, p) : 0;
                if (e > 0)
                    continue;
                points_add(points, s->kind == MAP ? word_apply(&s->map, p) : p);
                if (s->kind == MIRROR)
                    points_add(points, vec_sub(p, vec_scale(2 * e, s->mirror.normal)));
            }
            free(before.items);
        }
    }
}

static Cloud chain_cloud(const Chain *chain, int each, Random *random)
{
    Points points = {0};
    Cloud  cloud  = {0};
    chain_points(chain, each, random, &points);
    for (size_t i = 0; i < points.count; i++)
        cloud_add(&cloud, points.items[i]);
    free(points.items);
    return cloud;
}

/* ---- random chains ---- */

typedef struct Flavour {
    const char *name;
    int         levels, chains;
    double      near, far; /* how far poles are from the origin, about which the set is */
    double      inverting; /* the share of maps that invert; the rest are similarities */
    bool        mirrors, nested, placed;
    uint64_t    seed;
} Flavour;

static const Flavour flavours[] = {
    {"one inversion", 1, 30, 1.5, 4, 1, false, false, false, 1},
    {"far poles", 4, 30, 4, 8, 1, true, false, false, 2},
    {"near poles", 4, 30, 1.2, 2.4, 1, true, false, false, 3},
    {"poles within", 3, 20, 0.1, 1, 1, true, false, false, 4},
    {"similarities among them", 6, 30, 1.5, 5, 0.5, true, false, false, 5},
    {"similarities alone", 6, 10, 1, 1, 0, true, false, false, 6},
    {"eight levels", 8, 20, 2, 6, 0.8, true, false, false, 7},
    {"no mirrors", 5, 20, 1.5, 4, 1, false, false, false, 8},
    {"nested", 2, 20, 1.5, 5, 0.7, true, true, false, 9},
    {"placed kernels", 3, 20, 2, 5, 0.5, true, false, true, 10},
    {"nested and placed", 2, 20, 2, 5, 0.7, true, true, true, 11},
};
enum { FLAVOURS = sizeof flavours / sizeof *flavours };

static Word random_word(const Flavour *flavour, Random *random)
{
    Word word = {.count = 0};
    if (random_below(random, 2))
        word_add(&word, ROTATE, random_unit(random), random_between(random, -3, 3));
    if (random_below(random, 2))
        word_add(&word, TRANSLATE, random_in_cube(random, 0.4), 0);
    if (random_below(random, 4) == 0)
        word_add(&word, REFLECT, random_unit(random), random_between(random, -0.2, 0.2));
    if (random_between(random, 0, 1) < flavour->inverting) {
        double distance = random_between(random, flavour->near, flavour->far);
        word_add(&word, INVERT, vec_scale(distance, random_unit(random)),
                 distance * random_between(random, 0.8, 1.2));
    }
    if (random_below(random, 3) == 0)
        word_add(&word, SCALE, vec(0, 0, 0), random_between(random, 0.6, 1.4));
    return word;
}

static Kernel random_kernel(const Flavour *flavour, Random *random)
{
    Kernel kernel = {.from = random_in_cube(random, 0.5), .axis = random_unit(random)};
    kernel.to     = kernel.from;
    kernel.radius = random_between(random, 0.1, 0.35);
    int kind      = random_below(random, 3);
    if (kind == 1) {
        kernel.box   = true;
        kernel.sides = vec_add(vec(0.2, 0.2, 0.2), random_in_cube(random, 0.15));
        kernel.angle = random_between(random, -3, 3);
    } else if (kind == 2) {
        kernel.to = vec_add(kernel.from, random_in_cube(random, 0.5));
        kernel.radius /= 2;
    }
    if (flavour->placed && random_below(random, 2))
        kernel.placed = random_word(flavour, random);
    return kernel;
}

/* The chain that a kernel stands for when `inner` is one. */
static Chain random_chain(const Flavour *flavour, const Chain *inner, Random *random)
{
    Chain chain = {.count = 0};
    for (int level = 0; level <= flavour->levels; level++) {
        Statement kernel = {.kind = KERNEL, .kernel = random_kernel(flavour, random)};
        if (inner && level == 0)
            kernel.kernel.chain = inner;
        if (level == 0 || random_below(random, 3))
            chain.statements[chain.count++] = kernel;
        if (level == flavour->levels)
            break;
        Statement mirror     = {.kind = MIRROR, .mirror = {random_unit(random), 0}};
        Statement map        = {.kind = MAP, .map = random_word(flavour, random)};
        mirror.mirror.offset = random_between(random, -0.1, 0.8);
        if (flavour->mirrors && random_below(random, 4)) {
            chain.statements[chain.count++] = mirror;
            chain.mirrors++;
        }
        chain.statements[chain.count++] = map;
        if (random_below(random, 4) == 0) {
            map.map = random_word(flavour, random); /* two with nothing between */
            chain.statements[chain.count++] = map;
        }
    }
    return chain;
}

static void write_chain(SceneText *text, const Chain *chain);

static void write_kernel(SceneText *text, const Kernel *k)
{
    Vec a = k->from, b = k->to;
    scene_write(text, "kernel ");
    if (k->chain)
        write_chain(text, k->chain);
    else if (k->box)
        scene_write(text,
                    "box([%.17g, %.17g, %.17g]).rotate([%.17g, %.17g, %.17g], %.17g)"
                    ".move([%.17g, %.17g, %.17g])",
                    2 * k->sides.x, 2 * k->sides.y, 2 * k->sides.z, k->axis.x, k->axis.y, k->axis.z,
                    k->angle, a.x, a.y, a.z);
    else if (vec_distance(a, b) == 0)
        scene_write(text, "sphere(%.17g).move([%.17g, %.17g, %.17g])", k->radius, a.x, a.y, a.z);
    else
        scene_write(text, "capsule([%.17g, %.17g, %.17g], [%.17g, %.17g, %.17g], %.17g)", a.x, a.y,
                    a.z, b.x, b.y, b.z, k->radius);
    if (k->placed.count) {
        scene_write(text, ".transform(");
        write_word(text, &k->placed);
        scene_write(text, ")");
    }
    scene_write(text, ";\n");
}

static void write_chain(SceneText *text, const Chain *chain)
{
    scene_write(text, "krs {\n");
    for (int i = 0; i < chain->count; i++) {
        const Statement *s = &chain->statements[i];
        if (s->kind == KERNEL)
            write_kernel(text, &s->kernel);
        else if (s->kind == MIRROR)
            scene_write(text, "reflect plane([%.17g, %.17g, %.17g], %.17g);\n", s->mirror.normal.x,
                        s->mirror.normal.y, s->mirror.normal.z, s->mirror.offset);
        else {
            scene_write(text, "mobius ");
            write_word(text, &s->map);
            scene_write(text, ";\n");
        }
    }
    scene_write(text, "}");
}

static Product compile_chain(const Chain *chain)
{
    SceneText *text = calloc(1, sizeof *text);
    assert_non_null(text);
    scene_write(text, "show ");
    write_chain(text, chain);
    scene_write(text, ";\n");
    Product product = product_compile(text->bytes);
    free(text);
    return product;
}

/* ---- judging ---- */

typedef struct Tally {
    int    outside, naive_refuted, identified, bounded, chains;
    double tightness; /* sum of distance over the cloud's */
} Tally;

/* The box, the cloud and a point: everything that is asked of a distance. */
static void check_point(const Product *product, const Chain *chain, Cloud *cloud, Vec p,
                        Tally *tally)
{
    double  distance = product_distance(product, p), truth = cloud_nearest(cloud, p);
    double  size = 1 + vec_length(p);
    Nearest nearest;
    naive_distance(chain, p, 1, &nearest);
    if (nearest.naive <= 0) {
        if (!(distance <= 1e-9 * size))
            fail_msg("distance %.12g inside", distance);
        return;
    }
    if (!(distance > 0) && nearest.naive > 1e-9 * size)
        fail_msg("distance %.12g outside, %.3g from the surface", distance, nearest.naive);
    if (!(distance <= truth + 1e-9 * size))
        fail_msg("distance %.12g is above the true %.12g", distance, truth);
    tally->outside++;
    tally->naive_refuted += nearest.naive > truth * (1 + 1e-9) + 1e-9 * size;
    tally->tightness += fmin(1, distance / truth);
}

/* Level and instance of a point well inside of one kernel. */
static void check_identity(const Product *product, const Chain *chain, Vec p, Tally *tally)
{
    Nearest nearest;
    naive_distance(chain, p, 1, &nearest);
    KrsHit hit = product_probe(product, p);
    if (nearest.naive > 1e-7 || !(fabs(hit.distance) < 1e-7))
        return; /* another kernel covers the point */
    tally->identified++;
    if (hit.level != nearest.level || hit.instance != nearest.id)
        fail_msg("level %u, instance %u should be %u, %u", hit.level, hit.instance, nearest.level,
                 nearest.id);
}

static void check_box(const Product *product, const Cloud *cloud, Tally *tally)
{
    KrsComponent component;
    assert_int_equal(krs_component(product->scene, 0, &component), KRS_OK);
    for (size_t i = 0; i < cloud->count; i++) {
        Vec    v    = cloud->points[i];
        double p[3] = {v.x, v.y, v.z}, slack = 1e-9 * (1 + vec_length(v));
        for (int k = 0; k < 3; k++)
            if (!(p[k] >= component.low[k] - slack && p[k] <= component.high[k] + slack))
                fail_msg("%.12g is outside of the box, %.12g to %.12g", p[k], component.low[k],
                         component.high[k]);
    }
    tally->bounded += isfinite(component.low[0]) && isfinite(component.high[0]);
    tally->chains++;
}

/* A hit is on the surface, and no later than the first of many samples that is inside. */
static int check_ray(const Product *product, const Chain *chain, Vec origin, Vec target)
{
    const double farthest = 12, tolerance = 1e-7;
    const int    samples   = 1500;
    Vec          direction = vec_unit(vec_sub(target, origin));
    double       entry     = HUGE_VAL;
    if (chain_contains(chain, origin))
        return 0;
    for (int i = 0; i < samples && entry == HUGE_VAL; i++) {
        double t = farthest * i / samples;
        if (chain_contains(chain, vec_add(origin, vec_scale(t, direction))))
            entry = t;
    }
    KrsHit hit = product_raycast(product, origin, direction, farthest, tolerance);
    if (entry < farthest && !(hit.hit && hit.t <= entry + 2 * tolerance))
        fail_msg("the ray ends at %.12g, behind %.12g", hit.hit ? hit.t : HUGE_VAL, entry);
    if (!hit.hit)
        return 0;
    /* The distance without the bound is right to first order, next to the surface. */
    Vec    point = vec_add(origin, vec_scale(hit.t, direction));
    double left  = naive_distance(chain, point, 1, NULL);
    if (!(left <= 1e-5))
        fail_msg("the ray ends %.6g before the surface", left);
    return 1;
}

static Vec random_near(const Cloud *cloud, Random *random)
{
    Vec    p     = cloud->points[random_below(random, (int)cloud->count)];
    double reach = exp(random_between(random, -6, 1));
    return vec_add(p, vec_scale(reach, random_unit(random)));
}

static void chains(void **state)
{
    const Flavour *flavour = *state;
    Random         random  = {flavour->seed};
    Tally          tally   = {0};
    int            hits    = 0;
    for (int repeat = 0; repeat < flavour->chains; repeat++) {
        Flavour innermost = *flavour;
        innermost.nested  = false;
        Chain   inner     = random_chain(&innermost, NULL, &random);
        Chain   chain     = random_chain(flavour, flavour->nested ? &inner : NULL, &random);
        Product product   = compile_chain(&chain);
        Cloud   cloud     = chain_cloud(&chain, flavour->levels > 4 ? 400 : 1500, &random);
        if (cloud.count) {
            check_box(&product, &cloud, &tally);
            for (int i = 0; i < 150; i++)
                check_point(&product, &chain, &cloud,
                            i % 3 ? random_near(&cloud, &random) : random_in_cube(&random, 3),
                            &tally);
            for (int i = 0; i < 20 && !flavour->nested; i++)
                check_identity(&product, &chain,
                               cloud.points[random_below(&random, (int)cloud.count)], &tally);
            for (int i = 0; i < 10; i++)
                hits += check_ray(&product, &chain, vec_scale(5, random_unit(&random)),
                                  random_near(&cloud, &random));
        }
        cloud_free(&cloud);
        product_free(&product);
    }
    print_message("# %s: %d points outside, mean %.2f of the true distance, %d refute the plain "
                  "quotient; %d of %d bounded; %d hits, %d copies named\n",
                  flavour->name, tally.outside, tally.tightness / tally.outside,
                  tally.naive_refuted, tally.bounded, tally.chains, hits, tally.identified);
    assert_true(tally.chains > flavour->chains / 2 && hits > flavour->chains / 2);
    assert_true(tally.tightness > 0.2 * tally.outside);
    assert_true(flavour->nested || tally.identified > flavour->chains);
    /* The same points find the fault when the bound is left out. */
    if (flavour->inverting > 0)
        assert_true(tally.naive_refuted * 100 > tally.outside);
    else
        assert_int_equal(tally.naive_refuted, 0);
}

static void slope_and_empty_balls(void **state)
{
    const Flavour *flavour = *state;
    Random         random  = {flavour->seed + 100};
    for (int repeat = 0; repeat < 3; repeat++) {
        Chain   chain   = random_chain(flavour, NULL, &random);
        Product product = compile_chain(&chain);
        Trial   trial   = {product_field, &product, chain_contains, &chain,
                           vec(0, 0, 0),  2,        1000,           flavour->seed};
        judge_acquits(&trial, flavour->name);
        product_free(&product);
    }
}

/* ---- images of rays and balls ---- */

/* What is marched by instead of the distance: lower_images.c. */
typedef struct Asked {
    Product product;
    Node    root;
    Tape    tape;
} Asked;

static Asked asked_new(Product product, AlongMethod method)
{
    KrsScene *scene = product.scene;
    Asked     asked = {product, along_roots(&scene->roots, method)[0], {0}};
    asked.tape      = tape_new(scene->graph, &asked.root, 1, &scene->arena);
    frame_refresh(product.frame);
    tape_run_frame(&asked.tape, product.frame->parameters, product.frame->values);
    return asked;
}

static double ask(const Asked *asked, Vec p, Vec direction, double radius)
{
    double at[3] = {p.x, p.y, p.z}, v[3] = {direction.x, direction.y, direction.z};
    tape_run_surface(&asked->tape, at, v, radius, asked->product.frame->values);
    return asked->product.frame->values[asked->root].v[0];
}

/* Whether something of the chain is on the segment of this length, but for its last millionth. */
static bool meets(const Chain *chain, Vec p, Vec direction, double length, int samples)
{
    for (int i = 0; i < samples; i++) {
        double t = (1 - 1e-6) * length * (i + 0.5) / samples;
        if (chain_contains(chain, vec_add(p, vec_scale(t, direction))))
            return true;
    }
    return chain_contains(chain, vec_add(p, vec_scale((1 - 1e-6) * length, direction)));
}

typedef struct Progress {
    int    steps, longer;              /* than by the distance */
    int    rays, directional, centred; /* evaluations of all rays */
    int    balls, empty, centred_empty;
    double gain;
} Progress;

/* One step from a point outside, as far as 20. */
static void check_step(const Asked *asked, const Chain *chain, Vec p, Vec direction,
                       Progress *progress)
{
    double step = ask(asked, p, direction, 0), distance = product_distance(&asked->product, p);
    if (chain_contains(chain, p)) {
        assert_true(step <= 1e-9);
        return;
    }
    if (!(step >= distance * (1 - 1e-9)))
        fail_msg("a step of %.12g is shorter than the distance, %.12g", step, distance);
    if (meets(chain, p, direction, fmin(step, 20), 60))
        fail_msg("a step of %.12g, by the distance %.12g, leads through the set", step, distance);
    progress->steps++;
    progress->longer += step > 1.01 * distance;
    progress->gain += fmin(step / distance, 10);
}

/* Marches until the step is short; the end is no later than what samples find of the set. */
static void check_march(const Asked *asked, const Chain *chain, Vec origin, Vec target,
                        Progress *progress)
{
    const double farthest = 12, tolerance = 1e-6;
    Vec          direction = vec_unit(vec_sub(target, origin)), p = origin;
    double       step = 1, t = 0;
    if (chain_contains(chain, origin))
        return;
    progress->rays++;
    for (int i = 0; i < 1000 && t < farthest && step > tolerance; i++) {
        step = ask(asked, p, direction, 0);
        t += step;
        p = vec_add(origin, vec_scale(t, direction));
        progress->directional++;
    }
    if (meets(chain, origin, direction, fmin(t, farthest) - 2 * tolerance, 1500))
        fail_msg("the march to %.12g leads through the set", t);
    if (t < farthest && !(naive_distance(chain, p, 1, NULL) <= 1e-4))
        fail_msg("the march ends at %.12g, %.3g before the set", t,
                 naive_distance(chain, p, 1, NULL));
    for (t = 0, step = 1; t < farthest && step > tolerance; t += step) {
        step = product_distance(&asked->product, vec_add(origin, vec_scale(t, direction)));
        progress->centred++;
    }
}

static void check_ball(const Asked *asked, const Chain *chain, Cloud *cloud, Vec centre,
                       double radius, Random *random, Progress *progress)
{
    Vec  none  = vec(0, 0, 0);
    bool empty = ask(asked, centre, none, radius) > radius;
    progress->balls++;
    progress->empty += empty;
    if (empty && !(cloud_nearest(cloud, centre) >= radius * (1 - 1e-9)))
        fail_msg("the ball of radius %.12g is not empty", radius);
    for (int i = 0; empty && i < 30; i++)
        if (chain_contains(chain, random_in_ball(random, centre, radius * (1 - 1e-9))))
            fail_msg("the ball of radius %.12g is not empty", radius);
    radius = 0.999 * product_distance(&asked->product, centre);
    if (radius > 0)
        progress->centred_empty += ask(asked, centre, none, radius) > radius;
    else
        progress->balls--, progress->empty -= empty;
}

static void images(void **state)
{
    const Flavour *flavour = *state;
    Random         random  = {flavour->seed + 200};
    Progress       all     = {0};
    for (int repeat = 0; repeat < flavour->chains; repeat++) {
        Flavour innermost = *flavour;
        innermost.nested  = false;
        Chain   inner     = random_chain(&innermost, NULL, &random);
        Chain   chain     = random_chain(flavour, flavour->nested ? &inner : NULL, &random);
        Product product   = compile_chain(&chain);
        Cloud   cloud     = chain_cloud(&chain, flavour->levels > 4 ? 200 : 800, &random);
        Asked   steps     = asked_new(product, ALONG_DIRECTIONAL);
        Asked   balls     = asked_new(product, ALONG_PROBE);
        for (int i = 0; i < 200 && cloud.count; i++) {
            Vec p  = i % 3 ? random_near(&cloud, &random) : random_in_cube(&random, 3);
            Vec to = vec_sub(cloud.points[random_below(&random, (int)cloud.count)], p);
            check_step(&steps, &chain, p, i % 2 ? vec_unit(to) : random_unit(&random), &all);
            check_ball(&balls, &chain, &cloud, p,
                       random_between(&random, 0.2, 1.2) * cloud_nearest(&cloud, p), &random, &all);
        }
        for (int i = 0; i < 10 && cloud.count; i++)
            check_march(&steps, &chain, vec_scale(5, random_unit(&random)),
                        random_near(&cloud, &random), &all);
        cloud_free(&cloud);
        product_free(&product);
    }
    print_message("# %s: %d steps, %d longer than the distance, %.2f times on average; %.1f "
                  "evaluations a ray, by distances %.1f; %d of %d balls empty, and %d of those by "
                  "distances\n",
                  flavour->name, all.steps, all.longer, all.gain / all.steps,
                  (double)all.directional / all.rays, (double)all.centred / all.rays, all.empty,
                  all.balls, all.centred_empty);
    assert_true(all.longer * 4 > all.steps || flavour->inverting == 0);
    assert_true(all.directional < all.centred || flavour->inverting == 0);
    assert_true(all.empty * 5 > all.balls && all.centred_empty * 100 > 95 * all.balls);
}

/* ---- poles ---- */

/* Where the inversion in a statement takes infinity, after the statements that follow; false when
   it has none or a mirror drops the place. */
static bool world_pole(const Chain *chain, int statement, Vec *pole)
{
    const Word *word  = &chain->statements[statement].map;
    bool        found = false;
    if (chain->statements[statement].kind != MAP)
        return false;
    for (int i = 0; i < word->count; i++) {
        const Elementary *l = &word->letters[i];
        *pole               = l->kind == INVERT ? l->vector : elementary_apply(l, *pole, false);
        found               = found || l->kind == INVERT;
    }
    for (int i = statement + 1; found && i < chain->count; i++) {
        const Statement *s = &chain->statements[i];
        if (s->kind == MIRROR)
            found = half_excess(s->mirror, *pole) <= 0;
        if (s->kind == MAP)
            *pole = word_apply(&s->map, *pole);
    }
    return found && vec_length(*pole) < 100;
}

/* Next to a pole, where the maps overflow, there is a distance, and it is that to the set: a pole
   is no point of the surface. */
static void poles_are_empty(void **state)
{
    Random random = {77};
    int    poles = 0, near_nothing = 0;
    double tightness = 0;
    (void)state;
    for (int repeat = 0; repeat < 40; repeat++) {
        const Flavour *flavour = &flavours[repeat % 4 < 3 ? repeat % 4 : 6];
        Chain          chain   = random_chain(flavour, NULL, &random);
        Product        product = compile_chain(&chain);
        Cloud          cloud   = chain_cloud(&chain, 1000, &random);
        for (int i = 0; i < chain.count; i++) {
            Vec pole = vec(0, 0, 0);
            if (!cloud.count || !world_pole(&chain, i, &pole))
                continue;
            Vec    lateral = vec_add(pole, vec_scale(1e-7, random_unit(&random)));
            double truth   = cloud_nearest(&cloud, pole);
            if (!(truth > 1e-2) || chain_contains(&chain, lateral))
                continue;
            for (double gap = 1e-3; gap > 1e-13; gap *= 0.1) {
                Vec    p = vec_add(pole, vec_scale(gap > 1e-12 ? gap : 0, random_unit(&random)));
                double distance = product_distance(&product, p);
                if (!(distance > 0 && distance <= truth + gap))
                    fail_msg("distance %.12g at %g from a pole, %.12g from the set", distance, gap,
                             truth);
            }
            double part = product_distance(&product, pole) / truth;
            near_nothing += part < 0.05; /* what no ball is around */
            tightness += part;
            poles++;
        }
        cloud_free(&cloud);
        product_free(&product);
    }
    print_message("# %d poles, mean %.2f of the true distance, next to nothing at %d\n", poles,
                  tightness / poles, near_nothing);
    assert_true(poles > 30 && tightness > 0.5 * poles && near_nothing * 25 < poles);
}

/* What moves the zero set does so at the set, not at the pole; the image of this ball is the
   ball of radius 0.5 / 0.75 about (0, 1 / 0.75, 0). */
static void offsets_do_not_show_poles(void **state)
{
    const char *ball   = "sphere(0.5).move([0, 1, 0]).transform(invert())";
    Random      random = {78};
    (void)state;
    Product plain  = product_format("show %s;", ball);
    Product grown  = product_format("show %s.offset(0.1);", ball);
    Product joined = product_format("show union(%s, sphere(0.1).move([0, -0.3, 0]), blend: 0.3);",
                                    ball);
    for (int i = 0; i < 3000; i++) {
        Vec    p     = random_in_cube(&random, i % 2 ? 0.3 : 2);
        double truth = vec_distance(p, vec(0, 1 / 0.75, 0)) - 0.5 / 0.75;
        double other = vec_distance(p, vec(0, -0.3, 0)) - 0.1;
        assert_true(truth <= 0 || product_distance(&plain, p) <= truth + 1e-12);
        assert_true(truth <= 0.25 || product_distance(&grown, p) > 0);
        assert_true(truth <= 0.4 || other <= 0.15 || product_distance(&joined, p) > 0);
    }
    assert_true(product_distance(&grown, vec(0, 0, 0)) > 0.1);
    assert_true(product_distance(&joined, vec(0, 0.1, 0)) > 0.1);
    product_free(&plain);
    product_free(&grown);
    product_free(&joined);
}

/* ---- parameters ---- */

/* A chain in which everything moves; at 0.5 the poles of the two inversions meet. */
static Chain moving_chain(double t)
{
    Chain  chain = {.count = 0};
    Kernel ball  = {
         .from = {0.2, 0.1, 0}, .to = {0.2, 0.1, 0}, .axis = {0, 0, 1}, .radius = 0.3 + 0.1 * t};
    Kernel    rod = {.from = {0, 0, 0}, .to = {0.3, 0.5, 0.1}, .axis = {0, 0, 1}, .radius = 0.1};
    Statement statements[6] = {{.kind = KERNEL, .kernel = ball},
                               {.kind = MIRROR, .mirror = {{1, 0, 0}, 0.3 - 0.2 * t}},
                               {.kind = MAP},
                               {.kind = MAP},
                               {.kind = KERNEL, .kernel = rod},
                               {.kind = MIRROR, .mirror = {{0, 0, 1}, 0.2}}};
    word_add(&statements[2].map, ROTATE, vec(0, 1, 0), t);
    word_add(&statements[2].map, INVERT, vec(0, -2 + t, 0.3), 2);
    word_add(&statements[3].map, INVERT, vec(0.2 * t - 0.1, -1.5, 0.3), 1 + t);
    word_add(&statements[3].map, SCALE, vec(0, 0, 0), 1 - 0.3 * t);
    for (int i = 0; i < 6; i++)
        chain.statements[chain.count++] = statements[i];
    chain.mirrors = 2;
    return chain;
}

static void parameters_move_poles(void **state)
{
    Product product = product_compile(
        "param t = 0 in [-0.5, 0.9];"
        "show krs { kernel sphere(0.3 + 0.1 * t).move([0.2, 0.1, 0]);"
        "    reflect plane([1, 0, 0], 0.3 - 0.2 * t);"
        "    mobius invert([0, t - 2, 0.3], 2) * rotate([0, 1, 0], t);"
        "    mobius scale(1 - 0.3 * t) * invert([0.2 * t - 0.1, -1.5, 0.3], 1 + t);"
        "    kernel capsule([0, 0, 0], [0.3, 0.5, 0.1], 0.1); reflect plane([0, 0, 1], 0.2); };");
    Random random = {79};
    Tally  tally  = {0};
    (void)state;
    for (int i = 0; i <= 28; i++) {
        double t     = fmin(-0.5 + 0.05 * i, 0.9);
        Chain  chain = moving_chain(t);
        Cloud  cloud = chain_cloud(&chain, 2000, &random);
        assert_int_equal(krs_frame_set(product.frame, "t", &t, 1), KRS_OK);
        check_box(&product, &cloud, &tally);
        for (int k = 0; k < 200; k++)
            check_point(&product, &chain, &cloud,
                        k % 3 ? random_near(&cloud, &random) : random_in_cube(&random, 3), &tally);
        cloud_free(&cloud);
    }
    print_message("# %d points outside, mean %.2f of the true distance\n", tally.outside,
                  tally.tightness / tally.outside);
    assert_true(tally.outside > 2000 && tally.naive_refuted > 100);
    assert_true(tally.tightness > 0.3 * tally.outside);
    product_free(&product);
}

/* A pole that moves out of the ball that it inverts: what is around it has no inside, then no
   outside, and the pole at t is never on the surface. */
static void pole_leaves_the_set(void **state)
{
    Product product = product_compile("param t = 1 in [0.1, 3];"
                                      "show sphere(0.5).transform(invert([t, 0, 0], 1));");
    Random  random  = {80};
    (void)state;
    for (int i = 0; i <= 29; i++) {
        double t = fmin(0.1 + 0.1 * i, 3), d = t * t - 0.25;
        assert_int_equal(krs_frame_set(product.frame, "t", &t, 1), KRS_OK);
        for (int k = 0; k < 300 && fabs(d) > 1e-6; k++) {
            Vec    p        = k ? random_in_cube(&random, k % 2 ? 5 : 1) : vec(t, 0, 0);
            double truth    = vec_distance(p, vec(t - t / d, 0, 0)) - 0.5 / fabs(d);
            truth           = d < 0 ? -truth : truth;
            double distance = product_distance(&product, p);
            assert_true((distance <= 0) == (truth <= 0));
            if (truth > 0 && !(distance <= truth + 1e-12 && (k || distance > 0.1 * truth)))
                fail_msg("distance %.12g, in truth %.12g, for t = %g", distance, truth, t);
        }
    }
    product_free(&product);
}

int main(void)
{
    struct CMUnitTest tests[3 * FLAVOURS + 4];
    char              names[3 * FLAVOURS][80];
    size_t            count = 0;
    for (const Flavour *f = flavours; f < flavours + FLAVOURS; f++) {
        snprintf(names[count], sizeof names[count], "%s", f->name);
        tests[count] = (struct CMUnitTest){names[count], chains, NULL, NULL, (void *)(uintptr_t)f};
        count++;
        snprintf(names[count], sizeof names[count], "images: %s", f->name);
        tests[count] = (struct CMUnitTest){names[count], images, NULL, NULL, (void *)(uintptr_t)f};
        count++;
        if (f->nested)
            continue;
        snprintf(names[count], sizeof names[count], "slope, balls: %s", f->name);
        tests[count] = (struct CMUnitTest){names[count], slope_and_empty_balls, NULL, NULL,
                                           (void *)(uintptr_t)f};
        count++;
    }
    tests[count++] = (struct CMUnitTest)cmocka_unit_test(poles_are_empty);
    tests[count++] = (struct CMUnitTest)cmocka_unit_test(offsets_do_not_show_poles);
    tests[count++] = (struct CMUnitTest)cmocka_unit_test(parameters_move_poles);
    tests[count++] = (struct CMUnitTest)cmocka_unit_test(pole_leaves_the_set);
    return _cmocka_run_group_tests("conformal maps", tests, count, NULL, NULL);
}
