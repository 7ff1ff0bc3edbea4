/*
 * textures.c: textures are read as their definition says, by sums over all texels; levels are means;
 * and no texture is steeper than its facts, which are nearly reached.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "compiler/graph/bounds/facts.h"
#include "compiler/graph/texture.h"
#include "tests/support/bench.h"

enum { MAX_SIDE = 24, TRIALS = 400 };

/* A picture of random numbers that halves have, too, with rows from the top. */
typedef struct Drawn {
    uint32_t width, height;
    bool     gray;
    float    samples[MAX_SIDE * MAX_SIDE * 4];
} Drawn;

static Drawn drawn;

static uint32_t channels(void) { return drawn.gray ? 2 : 4; }

static void draw(Bench *bench, uint32_t width, uint32_t height, bool gray)
{
    drawn.width  = width;
    drawn.height = height;
    drawn.gray   = gray;
    for (uint32_t i = 0; i < width * height * channels(); i++)
        drawn.samples[i] = (float)floor(random_between(&bench->random, 0, 1024)) / 1024;
}

/* Channel k of a texel, counted from the lower left corner. */
static double texel(int x, int y, int k)
{
    int from = drawn.gray ? k / 3 : k;
    int row  = (int)drawn.height - 1 - y;
    return drawn.samples[((uint32_t)row * drawn.width + (uint32_t)x) * channels() + (uint32_t)from];
}

static Texture make(Bench *bench, TextureWrap wrap)
{
    return texture_new(drawn.samples, drawn.width, drawn.height, drawn.gray, wrap, &bench->arena,
                       &bench->arena);
}

/* ---- reading ---- */

/* Returns which texel stands at a place of the endless plane. */
static int standing(TextureWrap wrap, int i, int count)
{
    if (wrap == WRAP_CLAMP)
        return i < 0 ? 0 : i >= count ? count - 1 : i;
    int period = wrap == WRAP_REPEAT ? count : 2 * count;
    int at     = ((i % period) + period) % period;
    return at < count ? at : 2 * count - 1 - at;
}

static double tent(double t) { return fmax(1 - fabs(t), 0); }

/* Returns the sum over all texels near, each with a tent about its middle. */
static double by_definition(TextureWrap wrap, double u, double v, int k)
{
    double x = u * drawn.width, y = v * drawn.height, sum = 0;
    for (int j = (int)floor(y) - 2; j <= (int)floor(y) + 2; j++)
        for (int i = (int)floor(x) - 2; i <= (int)floor(x) + 2; i++)
            sum += tent(x - i - 0.5) * tent(y - j - 0.5) *
                   texel(standing(wrap, i, (int)drawn.width), standing(wrap, j, (int)drawn.height),
                         k);
    return sum;
}

static void textures_are_bilinear(void **state)
{
    Bench *bench = *state;
    for (int trial = 0; trial < 30; trial++) {
        TextureWrap wrap = (TextureWrap)(trial % WRAP_COUNT);
        draw(bench, 1 + random_below(&bench->random, MAX_SIDE),
             1 + random_below(&bench->random, MAX_SIDE), trial % 2);
        Texture texture = make(bench, wrap);
        for (int i = 0; i < TRIALS; i++) {
            double    uv[2] = {random_between(&bench->random, -2.5, 3.5),
                               random_between(&bench->random, -2.5, 3.5)};
            NodeValue value = texture_value(&texture, uv, 0);
            for (int k = 0; k < 4; k++)
                assert_true(fabs(value.v[k] - by_definition(wrap, uv[0], uv[1], k)) < 1e-12);
        }
    }
}

/* ---- levels ---- */

static double mean_of_picture(int k)
{
    double sum = 0;
    for (uint32_t y = 0; y < drawn.height; y++)
        for (uint32_t x = 0; x < drawn.width; x++)
            sum += texel((int)x, (int)y, k);
    return sum / (drawn.width * drawn.height);
}

/* Returns the value of a level at the middle of a texel. */
static NodeValue middle_of(const Texture *texture, uint32_t level, uint32_t x, uint32_t y)
{
    const TextureLevel *at    = &texture->levels[level];
    const double        uv[2] = {(x + 0.5) / at->width, (y + 0.5) / at->height};
    return texture_value(texture, uv, pow(2, level));
}

/* Rounding to halves is all that means lose. */
static void every_level_has_the_same_mean(void **state)
{
    static const uint32_t sides[][2] = {{16, 16}, {24, 7}, {1, 13}, {23, 23}, {3, 2}};
    Bench                *bench      = *state;
    for (size_t s = 0; s < sizeof sides / sizeof *sides; s++) {
        draw(bench, sides[s][0], sides[s][1], s % 2);
        Texture texture = make(bench, WRAP_REPEAT);
        for (uint32_t level = 0; level < texture.level_count; level++)
            for (int k = 0; k < 4; k++) {
                const TextureLevel *at  = &texture.levels[level];
                double              sum = 0;
                for (uint32_t y = 0; y < at->height; y++)
                    for (uint32_t x = 0; x < at->width; x++)
                        sum += middle_of(&texture, level, x, y).v[k];
                assert_true(fabs(sum / (at->width * at->height) - mean_of_picture(k)) < 5e-4);
            }
        const TextureLevel *last = &texture.levels[texture.level_count - 1];
        assert_true(last->width == 1 && last->height == 1);
    }
}

static double block_mean(uint32_t side, uint32_t x, uint32_t y, int k)
{
    double sum = 0;
    for (uint32_t j = 0; j < side; j++)
        for (uint32_t i = 0; i < side; i++)
            sum += texel((int)(x * side + i), (int)(y * side + j), k);
    return sum / (side * side);
}

static void a_texel_of_a_level_is_the_mean_of_what_it_covers(void **state)
{
    Bench *bench = *state;
    draw(bench, 16, 16, true);
    Texture texture = make(bench, WRAP_CLAMP);
    assert_int_equal(texture.level_count, 5);
    for (uint32_t level = 0; level < 5; level++)
        for (uint32_t y = 0; y < 16u >> level; y++)
            for (uint32_t x = 0; x < 16u >> level; x++)
                assert_true(fabs(middle_of(&texture, level, x, y).v[0] -
                                 block_mean(1u << level, x, y, 0)) < 1e-6);
}

static void widths_between_levels_mix_them(void **state)
{
    Bench *bench = *state;
    draw(bench, 16, 12, false);
    Texture texture = make(bench, WRAP_MIRROR);
    for (int i = 0; i < TRIALS; i++) {
        double uv[2] = {random_between(&bench->random, 0, 1), random_between(&bench->random, 0, 1)};
        double level = random_between(&bench->random, -1, 6), whole = floor(fmax(level, 0));
        double share     = fmax(level, 0) - whole;
        NodeValue fine   = texture_value(&texture, uv, pow(2, whole));
        NodeValue coarse = texture_value(&texture, uv, pow(2, whole + 1));
        NodeValue value  = texture_value(&texture, uv, pow(2, level));
        for (int k = 0; k < 4; k++)
            assert_true(fabs(value.v[k] - (fine.v[k] * (1 - share) + coarse.v[k] * share)) < 1e-9);
    }
    NodeValue blurred = texture_value(&texture, (double[2]){0.3, 0.3}, NAN);
    for (int k = 0; k < 4; k++) /* what has no width is as far away as can be */
        assert_true(fabs(blurred.v[k] - mean_of_picture(k)) < 5e-4);
}

/* Where both levels are the same, a pixel is the mean of places along its long side. */
static void long_pixels_are_means_of_taps(void **state)
{
    Bench *bench = *state;
    draw(bench, 16, 12, false);
    Texture texture = make(bench, WRAP_REPEAT);
    for (int i = 0; i < TRIALS; i++) {
        double uv[2] = {random_between(&bench->random, 0, 1), random_between(&bench->random, 0, 1)};
        double u = random_between(&bench->random, -1, 1), v = random_between(&bench->random, -1, 1);
        int    taps = 1 + i % MAX_TEXTURE_TAPS, level = i % 4;
        NodeValue mean   = texture_mean(&texture, uv, (double[4]){u, v, taps, pow(2, level)});
        double    sum[4] = {0};
        for (int tap = 0; tap < taps; tap++) {
            double at[2] = {uv[0] + u * ((2 * tap + 1.0) / (2 * taps) - 0.5),
                            uv[1] + v * ((2 * tap + 1.0) / (2 * taps) - 0.5)};
            for (int k = 0; k < 4; k++)
                sum[k] += texture_value(&texture, at, pow(2, level)).v[k] / taps;
        }
        for (int k = 0; k < 4; k++)
            assert_true(fabs(mean.v[k] - sum[k]) < 1e-9);
    }
}

/* ---- facts ---- */

static Node node_of(Bench *bench, const Texture *texture, double turn)
{
    Graph    *g   = bench->graph;
    Textures *all = arena_new(&bench->arena, Textures);
    array_push(&bench->arena, &all->list, *texture);
    g->textures = all;
    Node c = graph_number(g, cos(turn)), s = graph_number(g, sin(turn));
    Node a = graph_op2(g, OP_mul, bench->x, c), b = graph_op2(g, OP_mul, bench->y, s);
    Node d = graph_op2(g, OP_mul, bench->x, s), e = graph_op2(g, OP_mul, bench->y, c);
    Node u    = graph_op2(g, OP_sub, a, b);
    Node v    = graph_op2(g, OP_add, d, e);
    Node uv   = graph_op2(g, OP_vec2, u, v);
    Node none = graph_constant(g, TYPE_VEC4, (const double[4]){0});
    return graph_texture(g, texture->gray ? OP_texture_gray : OP_texture, 0, uv, none);
}

static const Box square = {{{-0.5, 1.5}, {-0.5, 1.5}, {0, 0}}};

/* Returns the largest slope between near points, most of which lie at corners between the middles
   of texels. */
static double steepest_found(Bench *bench, const Texture *texture)
{
    const double step  = 1e-5;
    double       found = 0;
    for (int i = 0; i < 60000; i++) {
        double turn    = random_between(&bench->random, 0, 2 * M_PI);
        double uv[2]   = {random_between(&bench->random, -0.5, 1.5),
                          random_between(&bench->random, -0.5, 1.5)};
        double side[2] = {drawn.width, drawn.height};
        for (int k = 0; k < 2 && i % 4; k++)
            uv[k] = (floor(uv[k] * side[k]) + 0.5) / side[k];
        double    to[2] = {uv[0] + step * cos(turn), uv[1] + step * sin(turn)};
        NodeValue a = texture_value(texture, uv, 0), b = texture_value(texture, to, 0);
        double    square_sum = 0;
        for (int k = 0; k < (texture->gray ? 1 : 4); k++)
            square_sum += pow(a.v[k] - b.v[k], 2);
        found = fmax(found, sqrt(square_sum) / step);
    }
    return found;
}

static double claimed(Bench *bench, const Texture *texture, double turn)
{
    Node node = node_of(bench, texture, turn);
    return graph_facts(bench->graph, square, NULL, &bench->arena)[node].slope;
}

static void slopes_are_bounded_and_nearly_reached(void **state)
{
    Bench *bench = *state;
    for (int trial = 0; trial < 9; trial++) {
        draw(bench, 2 + random_below(&bench->random, MAX_SIDE - 1),
             2 + random_below(&bench->random, MAX_SIDE - 1), trial % 3 != 2);
        Texture texture = make(bench, (TextureWrap)(trial % WRAP_COUNT));
        double  found = steepest_found(bench, &texture), bound = claimed(bench, &texture, trial);
        assert_true(found <= bound * (1 + 1e-6));
        if (found < 0.97 * bound)
            fail_msg("a slope of %g was found, and %g claimed", found, bound);
    }
}

/* The search above would find a bound that is a tenth too small. */
static void a_smaller_bound_is_refuted(void **state)
{
    Bench *bench = *state;
    draw(bench, 20, 11, true);
    Texture texture = make(bench, WRAP_REPEAT);
    double  found   = steepest_found(bench, &texture);
    texture.slope_of_first *= 0.9;
    assert_true(found > claimed(bench, &texture, 0.4));
}

/* Where texels do not meet, what is beyond the edge does not count. */
static void edges_count_where_they_meet(void **state)
{
    Bench *bench = *state;
    drawn        = (Drawn){.width = 8, .height = 1, .gray = true};
    for (uint32_t i = 0; i < 8; i++)
        drawn.samples[2 * i] = (float)i / 8;
    Texture round = make(bench, WRAP_REPEAT), ends = make(bench, WRAP_CLAMP);
    assert_true(fabs(claimed(bench, &round, 0) - 7) < 1e-9);
    assert_true(fabs(claimed(bench, &ends, 0) - 1) < 1e-9);
}

static void values_stay_in_their_range(void **state)
{
    Bench *bench = *state;
    draw(bench, 9, 14, false);
    Texture texture = make(bench, WRAP_REPEAT);
    Node    node    = node_of(bench, &texture, 1);
    Fact    fact    = graph_facts(bench->graph, square, NULL, &bench->arena)[node];
    for (int i = 0; i < TRIALS; i++) {
        double uv[2] = {random_between(&bench->random, 0, 1), random_between(&bench->random, 0, 1)};
        double width = pow(2, random_between(&bench->random, -1, 6));
        NodeValue value = texture_value(&texture, uv, width);
        for (int k = 0; k < 4; k++)
            assert_true(value.v[k] >= fact.value[k].low - 1e-12 &&
                        value.v[k] <= fact.value[k].high + 1e-12);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(textures_are_bilinear, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(every_level_has_the_same_mean, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(a_texel_of_a_level_is_the_mean_of_what_it_covers,
                                        bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(widths_between_levels_mix_them, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(long_pixels_are_means_of_taps, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(slopes_are_bounded_and_nearly_reached, bench_start,
                                        bench_stop),
        cmocka_unit_test_setup_teardown(a_smaller_bound_is_refuted, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(edges_count_where_they_meet, bench_start, bench_stop),
        cmocka_unit_test_setup_teardown(values_stay_in_their_range, bench_start, bench_stop),
    };
    return cmocka_run_group_tests_name("textures", tests, NULL, NULL);
}
