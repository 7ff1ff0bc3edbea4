/*
 * shadow_truth.c: how much of a light exact rays reach.
 */
#include "tests/oracle/shadow_truth.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

Disc disc_from(const Shot *shot, Vec point)
{
    if (!fixtures[shot->fixture].lamp)
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

bool is_hidden(const Shot *shot, Vec point, Vec direction, bool endless)
{
    const Fixture *fixture = &fixtures[shot->fixture];
    Line           line    = {point, vec_unit(direction)};
    double         end     = endless ? HUGE_VAL : vec_length(direction);
    for (int i = 0; i < fixture->count; i++) {
        Chord chord = chord_of(line, &fixture->solids[i], shot->size);
        if (i + 1 != shot->without && !chord_is_empty(chord) && chord.leave > 0 &&
            chord.enter < end)
            return true;
    }
    return false;
}

double share_by_rays(const Shot *shot, Vec point)
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

double share_above_edge(const Shot *shot, Vec point)
{
    Disc   disc    = disc_from(shot, point);
    Vec    to_edge = vec(a_ledge.b.x - point.x, a_ledge.b.y - point.y, 0);
    Vec    open    = vec_unit(vec_cross(to_edge, vec(0, 0, 1))); /* away from the ledge */
    Vec    across  = vec_sub(open, vec_scale(vec_dot(open, disc.axis), disc.axis));
    double cut     = -vec_dot(open, disc.axis) * disc.remote / (disc.radius * vec_length(across));
    cut            = fmax(-1, fmin(cut, 1));
    return (acos(cut) - cut * sqrt(1 - cut * cut)) / M_PI;
}

Truths truths;

/* Tells whether the last truths are those of another shot of the same solids. */
static bool are_known(Truth *truth, const Shot *shot, double lift)
{
    static struct {
        Truth *truth;
        double lift;
        Shot   shot;
    } last;
    const Fixture *fixture = &fixtures[shot->fixture], *before = &fixtures[last.shot.fixture];
    Shot           alike = *shot;
    alike.fixture        = last.shot.fixture;
    bool known           = last.truth == truth && !(last.lift < lift) && !(last.lift > lift) &&
                 memcmp(&alike, &last.shot, sizeof alike) == 0 && fixture->lamp == before->lamp &&
                 fixture->count == before->count &&
                 memcmp(&fixture->target, &before->target, sizeof fixture->target) == 0 &&
                 memcmp(fixture->solids, before->solids, sizeof fixture->solids) == 0;
    last.truth = truth;
    last.lift  = lift;
    last.shot  = *shot;
    return known;
}

void compute_truths(Truth *truth, const Shot *shot, double lift)
{
    if (are_known(truth, shot, lift))
        return;
    Lens      lens   = shot_lens(shot);
    KrsWindow window = shot->options.crop;
    truths.width     = (int)window.width;
    truths.height    = (int)window.height;
    assert_in_range(truths.width * truths.height, 1, MAX_PIXELS);
    for (int k = 0; k < truths.width * truths.height; k++) {
        Vec ground       = ground_at(&lens, &window, k % truths.width, k / truths.width);
        truths.low[k]    = truth(shot, ground);
        ground.y         = lift * pixel_at(&lens, ground);
        truths.lifted[k] = truth(shot, ground);
    }
}

double truth_low(int k) { return fmin(truths.low[k], truths.lifted[k]); }

double truth_high(int k) { return fmax(truths.low[k], truths.lifted[k]); }

void truths_within(int k, int reach, double *low, double *high)
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
