/*
 * deformed.c: random chains of twists, bends and tapers, and what they mean for points.
 */
#include "tests/oracle/deformed.h"

#include <stdio.h>

bool solid_contains(const Solid *solid, Vec p)
{
    Vec q = vec_sub(p, solid->centre), h = solid->half;
    if (solid->kind == SOLID_BALL)
        return vec_length(q) <= h.x;
    if (solid->kind == SOLID_ROD)
        return hypot(q.x, q.z) <= h.x && fabs(q.y) <= h.y;
    return fabs(q.x) <= h.x && fabs(q.y) <= h.y && fabs(q.z) <= h.z;
}

Solid solid_random(Random *random)
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

void solid_write(SceneText *text, const Solid *solid)
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

void bend_frame(Vec axis, Vec *along, Vec *lateral)
{
    Vec up   = fabs(axis.y) > 0.999 ? vec(1, 0, 0) : vec(0, 1, 0);
    *along   = vec_unit(vec_sub(up, vec_scale(vec_dot(up, axis), axis)));
    *lateral = vec_cross(axis, *along);
}

double taper_factor(const Deed *deed, double height)
{
    double t = (height - deed->low) / (deed->high - deed->low);
    return deed->from + (deed->to - deed->from) * fmin(fmax(t, 0), 1);
}

Vec deed_forward(const Deed *deed, Vec p)
{
    double height = vec_dot(p, deed->axis);
    if (deed->kind == DEED_TWIST)
        return vec_rotate(p, deed->axis, deed->rate * height);
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

Vec deed_backward(const Deed *deed, Vec p, int turn)
{
    double height = vec_dot(p, deed->axis);
    if (deed->kind == DEED_TWIST)
        return vec_rotate(p, deed->axis, -deed->rate * height);
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

/* As many turns about the axis of a bend, either way, as lead back to anything: points that far out
   on the line that was bent are outside of all that is bent here. */
static int deed_turns(const Deed *deed)
{
    const double REACH = 16;
    return deed->kind == DEED_BEND ? (int)((REACH * fabs(deed->rate) / PI + 1) / 2) : 0;
}

static bool contains_before(const Deformed *chain, int done, Vec p)
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

bool deformed_contains(const void *chain, Vec p)
{
    const Deformed *c = chain;
    return contains_before(c, c->deed_count, p);
}

Deed deed_random(Random *random, const Solid *solid, bool first)
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

void deed_write(SceneText *text, const Deed *deed, const char *rate)
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

void deformed_write(SceneText *text, const Deformed *chain, const char *rate)
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

Deformed deformed_random(Random *random, int deeds, int mirrors)
{
    Deformed chain = {.solid = solid_random(random), .deed_count = deeds, .mirror_count = mirrors};
    chain.before   = mirrors ? random_below(random, deeds + 1) : deeds;
    for (int i = 0; i < deeds; i++)
        chain.deeds[i] = deed_random(random, &chain.solid, i == 0 && chain.before > 0);
    for (int i = 0; i < mirrors; i++)
        chain.mirrors[i] = (Half){random_unit(random), random_between(random, -0.2, 0.6)};
    return chain;
}

Trial deformed_trial(const Product *product, const Deformed *chain, uint64_t seed)
{
    return (Trial){product_field, product, deformed_contains, chain, vec(0, 0, 0), 3, 250, seed};
}
