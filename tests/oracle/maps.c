/*
 * maps.c: maps of space against the same maps applied point by point and against quaternion
 * matrices, for random words of translations, turns, scalings, mirrors and inversions.
 *
 * A word is a list of elementary maps.  As points it is applied letter by letter; as a matrix it
 * is a product by the rules of quaternions; the product of the compiler must agree with both, one
 * map or several, known numbers or parameters.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "compiler/shape/map.h"
#include "compiler/graph/evaluate.h"
#include "tests/oracle/quaternions.h"

static jmp_buf exhausted;

static Memory memory = {.exhausted = &exhausted};

static Arena arena, scratch;

static Sources sources;

static Diags diags;

static ShapeBuilder builder;

static Random randomness = {17};

static double between(double low, double high) { return random_between(&randomness, low, high); }

static void start(void)
{
    arena_free(&arena);
    arena_free(&scratch);
    arena = scratch = (Arena){.memory = &memory};
    sources         = (Sources){.arena = &arena};
    diags           = (Diags){.arena = &arena, .sources = &sources};
    builder         = (ShapeBuilder){
                .arena = &arena, .scratch = &scratch, .diags = &diags, .graph = graph_new(&arena)};
}

static int setup(void **state)
{
    (void)state;
    arena = scratch = (Arena){.memory = &memory};
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    arena_free(&arena);
    arena_free(&scratch);
    return 0;
}

/* ---- words ---- */

typedef enum Letter { TRANSLATE, ROTATE, SCALE, REFLECT, INVERT, LETTERS } Letter;

typedef struct Elementary {
    Letter letter;
    Vec    vector; /* way, axis, normal or centre */
    double number; /* angle, factor, offset or radius */
} Elementary;

enum { MAX_LETTERS = 8 };

/* Applied from the first to the last. */
typedef struct Word {
    Elementary letters[MAX_LETTERS];
    int        count;
} Word;

static Elementary random_letter(Letter letter)
{
    Elementary l = {letter, random_in_cube(&randomness, 3), between(-3, 3)};
    if (letter == ROTATE || letter == REFLECT)
        l.vector = random_unit(&randomness);
    if (letter == SCALE || letter == INVERT)
        l.number = exp(between(-1, 1));
    return l;
}

static Word random_word(int count, int inversions)
{
    Word word = {.count = count};
    for (int i = 0; i < count; i++) {
        Letter other    = (Letter)random_below(&randomness, INVERT);
        word.letters[i] = random_letter(i < inversions ? INVERT : other);
    }
    for (int i = count - 1; i > 0; i--) {
        int        j    = random_below(&randomness, i + 1);
        Elementary l    = word.letters[i];
        word.letters[i] = word.letters[j];
        word.letters[j] = l;
    }
    return word;
}

static Vec letter_apply(const Elementary *l, Vec p)
{
    Vec z = vec_sub(p, l->vector);
    switch (l->letter) {
    case TRANSLATE: return vec_add(p, l->vector);
    case ROTATE: return vec_rotate(p, l->vector, l->number);
    case SCALE: return vec_scale(l->number, p);
    case REFLECT: return vec_sub(p, vec_scale(2 * (vec_dot(l->vector, p) - l->number), l->vector));
    default: return vec_add(l->vector, vec_scale(l->number * l->number / vec_dot(z, z), z));
    }
}

static Vec word_apply(const Word *word, Vec p)
{
    for (int i = 0; i < word->count; i++)
        p = letter_apply(&word->letters[i], p);
    return p;
}

/* How near the word comes to a pole on its way, in radii, and how large numbers get. */
static double word_hardness(const Word *word, Vec p)
{
    double hardness = 1;
    for (int i = 0; i < word->count; i++) {
        const Elementary *l    = &word->letters[i];
        double            size = vec_length(p), distance = vec_distance(p, l->vector) / l->number;
        hardness = fmax(hardness, size);
        if (l->letter == INVERT)
            hardness = fmax(hardness, fmax(1 / distance, distance));
        p = letter_apply(l, p);
    }
    return fmax(hardness, vec_length(p));
}

/* Returns how much larger things become near p. */
static double word_scale(const Word *word, Vec p)
{
    double scale = 1;
    for (int i = 0; i < word->count; i++) {
        const Elementary *l = &word->letters[i];
        if (l->letter == SCALE)
            scale *= l->number;
        if (l->letter == INVERT)
            scale *= pow(l->number / vec_distance(p, l->vector), 2);
        p = letter_apply(l, p);
    }
    return scale;
}

/* x - 2 (u.x - w) u is (u x u) + 2 w u: as a matrix [u, 2 w; 0, -u], since u^-1 = -u. */
static Matrix letter_matrix(const Elementary *l)
{
    Quat one = real(1), zero = real(0), v = pure(l->vector), half;
    switch (l->letter) {
    case TRANSLATE: return (Matrix){one, v, zero, one};
    case ROTATE:
        half = quat(cos(l->number / 2), vec_scale(sin(l->number / 2), l->vector));
        return (Matrix){half, zero, zero, half};
    case SCALE: return (Matrix){real(l->number), zero, zero, one};
    case REFLECT: return (Matrix){v, real(2 * l->number), zero, quat_mul(real(-1), v)};
    default: {
        /* To the origin, q / |q|^2 times the square of the radius, and back. */
        Matrix there = {one, quat_mul(real(-1), v), zero, one}, back = {one, v, zero, one};
        Matrix flip = {zero, real(-l->number * l->number), one, zero};
        return matrix_mul(back, matrix_mul(flip, there));
    }
    }
}

static Matrix word_matrix(const Word *word)
{
    Matrix m = {real(1), real(0), real(0), real(1)};
    for (int i = 0; i < word->count; i++)
        m = matrix_mul(letter_matrix(&word->letters[i]), m);
    return m;
}

/* ---- the compiler's maps ---- */

static Node vec_node(Vec v) { return graph_vec3(builder.graph, v.x, v.y, v.z); }

static const Map *letter_map(const Elementary *l)
{
    Node v = vec_node(l->vector), n = graph_number(builder.graph, l->number);
    switch (l->letter) {
    case TRANSLATE: return map_translation(&builder, v);
    case ROTATE: return map_rotation(&builder, v, n);
    case SCALE: return map_scaling(&builder, n);
    case REFLECT: return map_reflection(&builder, v, n);
    default: return map_inversion(&builder, v, n);
    }
}

/* Multiplies the letters from..to - 1, put together in any order of brackets. */
static const Map *word_map(const Word *word, int from, int to)
{
    if (to - from == 1)
        return letter_map(&word->letters[from]);
    int        cut   = from + 1 + random_below(&randomness, to - from - 1);
    const Map *first = word_map(word, from, cut), *second = word_map(word, cut, to);
    return map_product(&builder, second, first);
}

/* Returns the value of a node at these parameters. */
static NodeValue value_of(Node node, const NodeValue *parameters)
{
    const Graph *graph  = builder.graph;
    Tape         tape   = tape_new(graph, &node, 1, &scratch);
    NodeValue   *values = arena_new_array(&scratch, NodeValue, graph->count);
    tape_run_frame(&tape, parameters, values);
    NodeValue value = values[node];
    arena_free(&scratch);
    return value;
}

static Vec vec_of(Node node, const NodeValue *parameters)
{
    NodeValue value = value_of(node, parameters);
    return vec(value.v[0], value.v[1], value.v[2]);
}

static Vec map_at(const Map *map, Vec p, const NodeValue *parameters)
{
    if (map->first)
        p = map_at(map->first, p, parameters);
    double scale = value_of(map->scale, parameters).v[0];
    assert_true(scale > 0);
    if (map->pole != NODE_NONE) {
        p = vec_sub(p, vec_of(map->pole, parameters));
        scale /= vec_dot(p, p);
    }
    Vec rows[3];
    for (int i = 0; i < 3; i++)
        rows[i] = vec_of(map->rows[i], parameters);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            assert_true(fabs(vec_dot(rows[i], rows[j]) - (i == j)) <= 1e-11);
    p = vec(vec_dot(rows[0], p), vec_dot(rows[1], p), vec_dot(rows[2], p));
    return vec_add(vec_scale(scale, p), vec_of(map->shift, parameters));
}

/* ---- tests ---- */

static void assert_near(Vec a, Vec b, double tolerance)
{
    if (!(vec_distance(a, b) <= tolerance))
        fail_msg("%.12g %.12g %.12g is not %.12g %.12g %.12g, to %.3g", a.x, a.y, a.z, b.x, b.y,
                 b.z, tolerance);
}

static int map_count(const Map *map) { return map ? 1 + map_count(map->first) : 0; }

static const NodeValue no_parameters[1];

static void products_and_inverses(void **state)
{
    int several = 0;
    (void)state;
    for (int trial = 0; trial < 1500; trial++) {
        start();
        Word word = random_word(1 + trial % MAX_LETTERS, random_below(&randomness, 5));
        if (trial % 20 == 0) {
            /* Poles that almost meet, a hundredth of a radius apart. */
            Elementary ball      = random_letter(INVERT);
            Vec        direction = vec_scale(0.01 * ball.number, random_unit(&randomness));
            word                 = (Word){{ball, {TRANSLATE, direction, 0}, ball}, 3};
        }
        const Map *map  = word_map(&word, 0, word.count);
        const Map *back = map_inverse(&builder, map);
        several += map_count(map) > 1;
        assert_int_equal(map_count(map), map_count(back));
        for (int i = 0; i < 4; i++) {
            Vec    p = random_in_cube(&randomness, 4), q = word_apply(&word, p);
            double hardness = word_hardness(&word, p);
            if (hardness > 300)
                continue;
            assert_near(map_at(map, p, no_parameters), q, 1e-12 * pow(hardness, 3));
            double back_scale = fmax(1, 1 / word_scale(&word, p));
            assert_near(map_at(back, q, no_parameters), p, 1e-12 * pow(hardness, 3) * back_scale);
        }
    }
    print_message("# %d of 1500 products are several maps\n", several);
    assert_true(several > 0 && several < 150);
}

static void matrices(void **state)
{
    (void)state;
    for (int trial = 0; trial < 1500; trial++) {
        start();
        Word       word = random_word(1 + trial % MAX_LETTERS, random_below(&randomness, 4));
        Matrix     m    = word_matrix(&word);
        double     f    = exp(between(-2, 2)) * (trial % 2 ? 1 : -1);
        double     entries[4][4];
        const Quat parts[4] = {m.a, m.b, m.c, m.d};
        for (int i = 0; i < 4; i++)
            memcpy(entries[i],
                   (double[]){f * parts[i].w, f * parts[i].v.x, f * parts[i].v.y, f * parts[i].v.z},
                   sizeof entries[i]);
        const char *reason;
        const Map  *map = map_of_matrix(&builder, (const double(*)[4])entries, &reason);
        if (!map)
            fail_msg("refused: %s", reason);
        for (int i = 0; i < 4; i++) {
            Vec    p = random_in_cube(&randomness, 4), q = word_apply(&word, p);
            Quat   l        = matrix_apply(&m, p);
            double hardness = word_hardness(&word, p);
            if (hardness > 300)
                continue;
            assert_true(fabs(l.w) <= 1e-11 * pow(hardness, 3));
            assert_near(l.v, q, 1e-11 * pow(hardness, 3));
            assert_near(map_at(map, p, no_parameters), q, 1e-11 * pow(hardness, 3));
        }
    }
}

/* Matrices that leave space do so at random points; those that are refused are among them. */
static void other_matrices_are_refused(void **state)
{
    (void)state;
    start();
    for (int trial = 0; trial < 500; trial++) {
        Word        word = random_word(3, 1);
        Matrix      m    = word_matrix(&word);
        double      entries[4][4];
        const char *reason;
        const Quat  parts[4] = {m.a, m.b, m.c, m.d};
        for (int i = 0; i < 4; i++)
            memcpy(entries[i], (double[]){parts[i].w, parts[i].v.x, parts[i].v.y, parts[i].v.z},
                   sizeof entries[i]);
        /* One entry wrong by a thousandth, or all of them drawn. */
        int wrong = random_below(&randomness, 16);
        entries[wrong / 4][wrong % 4] += 1e-3;
        for (int i = 0; i < 16 && trial % 2; i++)
            entries[i / 4][i % 4] = between(-2, 2);
        Matrix n         = {quat(entries[0][0], vec(entries[0][1], entries[0][2], entries[0][3])),
                            quat(entries[1][0], vec(entries[1][1], entries[1][2], entries[1][3])),
                            quat(entries[2][0], vec(entries[2][1], entries[2][2], entries[2][3])),
                            quat(entries[3][0], vec(entries[3][1], entries[3][2], entries[3][3]))};
        double real_part = 0;
        for (int i = 0; i < 10; i++)
            real_part = fmax(real_part, fabs(matrix_apply(&n, random_in_cube(&randomness, 2)).w));
        bool leaves = real_part > 1e-7;
        bool taken  = map_of_matrix(&builder, (const double(*)[4])entries, &reason) != NULL;
        if (leaves == taken)
            fail_msg("trial %d: real parts up to %.3g, %s", trial, real_part,
                     taken ? "taken" : reason);
    }
}

static void expect_matrix(const double entries[4][4], Vec p, Vec wanted)
{
    const char *reason;
    const Map  *map = map_of_matrix(&builder, entries, &reason);
    assert_non_null(map);
    assert_near(map_at(map, p, no_parameters), wanted, 1e-14);
}

/* Table 1 of the paper as it should be (math.md, section 7), and matrices that are singular. */
static void elementary_matrices(void **state)
{
    static const double half[4][4]        = {{0, -1, 0, 0}, {0}, {0}, {0, 1, 0, 0}};
    static const double inverse[4][4]     = {{0}, {1}, {1}, {0}};
    static const double inversion[4][4]   = {{0}, {-1}, {1}, {0}};
    static const double mirror[4][4]      = {{0, 0, 1, 0}, {3}, {0}, {0, 0, -1, 0}};
    static const double singular[2][4][4] = {{{1}, {1}, {-1}, {1}}, {{0}}};
    const char         *reason;
    (void)state;
    start();
    expect_matrix(half, vec(1, 2, 3), vec(-1, 2, 3));
    expect_matrix(inverse, vec(0, 2, 0), vec(0, -0.5, 0));
    expect_matrix(inversion, vec(0, 0, 4), vec(0, 0, 0.25));
    expect_matrix(mirror, vec(5, 1, 7), vec(5, 2, 7));
    assert_null(map_of_matrix(&builder, singular[1], &reason));
    assert_non_null(reason);
    /* (q + 1) (-q + 1)^-1 leaves space. */
    assert_null(map_of_matrix(&builder, singular[0], &reason));
    assert_non_null(reason);
}

/* Poles that meet leave a similarity; f f^-1 is the identity. */
static void what_is_no_inversion_is_none(void **state)
{
    (void)state;
    for (int trial = 0; trial < 200; trial++) {
        start();
        Word       word = random_word(1 + trial % 4, trial % 2);
        const Map *f    = word_map(&word, 0, word.count);
        const Map *one  = map_product(&builder, f, map_inverse(&builder, f));
        assert_true(one->pole == NODE_NONE && !one->first);
        Vec p = random_in_cube(&randomness, 3);
        assert_near(map_at(one, p, no_parameters), p, 1e-11);
        /* Two balls about one centre, with a turn between. */
        Elementary inner = random_letter(INVERT), outer = inner;
        outer.number   = 2;
        const Map *two = map_product(&builder, letter_map(&outer), letter_map(&inner));
        assert_true(two->pole == NODE_NONE);
        p     = random_in_cube(&randomness, 3);
        Vec q = letter_apply(&outer, letter_apply(&inner, p));
        assert_near(map_at(two, p, no_parameters), q, 1e-10);
    }
}

/* The same words with a parameter in every number: its default must make no difference, and every
   other value must be followed, also where it makes poles meet. */
static void parameters(void **state)
{
    GraphParameter range   = {{-1, 0, 0, 0}, {1, 0, 0, 0}};
    int            several = 0;
    (void)state;
    for (int trial = 0; trial < 300; trial++) {
        start();
        Graph *graph = builder.graph;
        array_push(&arena, &graph->parameters, range);
        Node       t = graph_parameter(graph, 1, TYPE_FLOAT);
        Elementary a = random_letter(INVERT), b = random_letter(INVERT), c = random_letter(ROTATE);
        bool       meeting   = trial % 3 == 0;
        Vec        direction = random_in_cube(&randomness, 0.5);
        if (meeting)
            b.vector = a.vector; /* at t = 0 */
        Node       shift  = graph_op2(graph, OP_scale, vec_node(direction), t);
        Node       centre = graph_op2(graph, OP_add, vec_node(b.vector), shift);
        Node       angle  = graph_op2(graph, OP_mul, graph_number(graph, c.number), t);
        const Map *turn   = map_rotation(&builder, vec_node(c.vector), angle);
        const Map *outer  = map_inversion(&builder, centre, graph_number(graph, b.number));
        const Map *both   = map_product(&builder, outer, letter_map(&a));
        const Map *all    = map_product(&builder, turn, both);
        several += map_count(all) > 1;
        assert_true(!meeting || map_count(all) == 2);
        for (int i = 0; i < 5; i++) {
            NodeValue  values[2] = {{{0}}, {{i == 0 ? 0 : between(-1, 1)}}};
            double     at        = values[1].v[0];
            Elementary moved = b, turned = c;
            moved.vector  = vec_add(b.vector, vec_scale(at, direction));
            turned.number = c.number * at;
            Word   word   = {{a, moved, turned}, 3};
            Vec    p = random_in_cube(&randomness, 3), q = word_apply(&word, p);
            double hardness = word_hardness(&word, p);
            if (hardness > 300)
                continue;
            assert_near(map_at(all, p, values), q, 1e-12 * pow(hardness, 3));
            assert_near(map_at(map_inverse(&builder, all), q, values), p,
                        1e-12 * pow(hardness, 3) * fmax(1, 1 / word_scale(&word, p)));
        }
        /* A moving map undone is no map at all, whatever moves. */
        const Map *none = map_product(&builder, all, map_inverse(&builder, all));
        assert_true(none->pole == NODE_NONE && !none->first);
    }
    print_message("# %d of 300 moving products are several maps\n", several);
    assert_true(several < 200);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(products_and_inverses),        cmocka_unit_test(matrices),
        cmocka_unit_test(other_matrices_are_refused),   cmocka_unit_test(elementary_matrices),
        cmocka_unit_test(what_is_no_inversion_is_none), cmocka_unit_test(parameters),
    };
    return cmocka_run_group_tests_name("maps of space", tests, setup, teardown);
}
