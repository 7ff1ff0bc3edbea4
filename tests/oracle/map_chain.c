/*
 * map_chain.c: random sequences of kernels, mirrors and conformal maps, and what they mean for
 * points.
 */
#include "tests/oracle/map_chain.h"

#include <stdio.h>
#include <stdlib.h>

/* ---- elementary maps ---- */

void word_add(Word *word, int kind, Vec vector, double number)
{
    word->letters[word->count++] = (Elementary){kind, vector, number};
}

Vec elementary_apply(const Elementary *l, Vec p, bool undo)
{
    Vec z = vec_sub(p, l->vector);
    switch (l->kind) {
    case TRANSLATE: return undo ? z : vec_add(p, l->vector);
    case ROTATE: return vec_rotate(p, l->vector, undo ? -l->number : l->number);
    case SCALE: return vec_scale(undo ? 1 / l->number : l->number, p);
    case REFLECT: return vec_sub(p, vec_scale(2 * (vec_dot(l->vector, p) - l->number), l->vector));
    case INVERT: return vec_add(l->vector, vec_scale(l->number * l->number / vec_dot(z, z), z));
    }
    return p;
}

Vec word_apply(const Word *word, Vec p)
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

void write_word(SceneText *text, const Word *word)
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

static Vec chain_undo_mirror(Half mirror, Vec p)
{
    double e = half_excess(mirror, p);
    return e > 0 ? vec_sub(p, vec_scale(2 * e, mirror.normal)) : p;
}

/* Returns the distance to a kernel in its own space, exact; negative inside. */
static double solid_distance(const Kernel *k, Vec p)
{
    Vec q = vec_rotate(vec_sub(p, k->from), k->axis, -k->angle);
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

double naive_distance(const Chain *chain, Vec p, double scale, Nearest *nearest)
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

bool map_chain_contains(const void *chain, Vec p) { return naive_distance(chain, p, 1, NULL) <= 0; }

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
        return vec_add(k->from, vec_rotate(q, k->axis, k->angle));
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

Cloud chain_cloud(const Chain *chain, int each, Random *random)
{
    Points points = {0};
    Cloud  cloud  = {0};
    chain_points(chain, each, random, &points);
    for (size_t i = 0; i < points.count; i++)
        cloud_add(&cloud, points.items[i]);
    free(points.items);
    return cloud;
}

Vec random_near(const Cloud *cloud, Random *random)
{
    Vec    p     = cloud->points[random_below(random, (int)cloud->count)];
    double reach = exp(random_between(random, -6, 1));
    return vec_add(p, vec_scale(reach, random_unit(random)));
}

/* ---- random sequences ---- */

const Flavour flavours[FLAVOURS] = {
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

Chain random_chain(const Flavour *flavour, const Chain *inner, Random *random)
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

/* ---- as text ---- */

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

Product compile_chain(const Chain *chain)
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
