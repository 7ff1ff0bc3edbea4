/*
 * saved.c: a film that is saved, and loaded by another renderer, goes on as if nothing had happened:
 * the picture is that of krs_render, bit by bit.  What cannot be a film is refused.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "compiler/passes/compile.h"
#include "runtime/device/gpu.h"
#include "tests/unit/tracer_fixture.h"

enum { SAMPLES = 24 };

static const char saved_text[] =
    "camera { eye: [3, 2, 5], target: [0, 0.5, 0], fov: 40deg }\n"
    "light sun { direction: [-1, 2, 1], intensity: 3, softness: 9deg }\n"
    "light lamp { position: [1, 3, 2], intensity: 8, softness: 0.2 }\n"
    "show sphere(1).move([0, 1, 0]); show box([0.9, 0.9, 0.9]).move([2, 0.5, 0.2]);\n"
    "show plane([0, 1, 0], 0);\n";

/* ---- a file in memory ---- */

typedef struct Bytes {
    unsigned char *bytes;
    size_t         size, at;
} Bytes;

static bool take(void *user, const void *bytes, size_t size)
{
    Bytes *file = user;
    if (file->at + size > file->size)
        return false;
    memcpy(file->bytes + file->at, bytes, size);
    file->at += size;
    return true;
}

static bool give(void *user, void *bytes, size_t size)
{
    Bytes *file = user;
    if (file->at + size > file->size)
        return false;
    memcpy(bytes, file->bytes + file->at, size);
    file->at += size;
    return true;
}

static KrsFilm *film_with(Fixture *fixture, const KrsRenderOptions *options, uint32_t samples)
{
    KrsFilm *film;
    assert_int_equal(krs_film_new(fixture->rendering, options, &film), KRS_OK);
    if (samples > 0)
        assert_int_equal(krs_film_add(film, fixture->state, NULL, samples), KRS_OK);
    return film;
}

/* Every plane that one of the pictures has. */
static void assert_same(KrsPicture *a, KrsPicture *b)
{
    const size_t pixels = (size_t)a->window.width * a->window.height;
    assert_memory_equal(a->world_to_camera, b->world_to_camera, sizeof a->world_to_camera);
    assert_memory_equal(a->world_to_ndc, b->world_to_ndc, sizeof a->world_to_ndc);
    assert_int_equal(a->stats.evaluations, b->stats.evaluations);
#define KRS_AOV(id, bit, aov, about, arrays) arrays
#define KRS_ARRAY(plane, member, type, numbers, row, first, sample, ...) \
    assert_int_equal(a->member != NULL, b->member != NULL);              \
    if (a->member)                                                       \
        assert_memory_equal(a->member, b->member, pixels *numbers * sizeof(type));
#include "krs/aovs.def"
#undef KRS_ARRAY
#undef KRS_AOV
    assert_int_equal(a->light_count, b->light_count);
    if (a->light_count > 0)
        assert_memory_equal(a->lights, b->lights, pixels * a->light_count * sizeof *a->lights);
    for (int kind = 0; a->mattes[0] && kind < KRS_MATTE_COUNT; kind++)
        assert_memory_equal(a->mattes[kind], b->mattes[kind],
                            pixels * KRS_MATTE_RANKS * sizeof(KrsMatte));
    krs_picture_free(a);
    krs_picture_free(b);
}

/* ---- the tests ---- */

/* Planes and mattes; samples that end by noise; a crop, and the light of each light. */
static const KrsRenderOptions kinds[] = {
    {.width = 100, .height = 80, .samples = SAMPLES, .mattes = true, .aovs = KRS_AOV_ALL},
    {.width = 100, .height = 80, .samples = SAMPLES, .noise = 0.03, .seed = 7},
    {.width        = 200,
     .height       = 160,
     .crop         = {33, 41, 90, 71},
     .samples      = SAMPLES,
     .aovs         = KRS_AOV_DEPTH | KRS_AOV_IDS,
     .light_groups = true}};

static void a_saved_film_goes_on(void **state)
{
    static const unsigned emulations[] = {0, EMULATE_CARD | EMULATE_MIN_LIMITS};
    static const uint32_t first[]      = {1, 17, SAMPLES};
    static unsigned char  room[1 << 23];
    (void)state;
    for (size_t k = 0; k < sizeof emulations / sizeof *emulations; k++)
        for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
            Fixture one, other;
            Bytes   file = {room, sizeof room, 0};
            fixture_open_as(&one, saved_text, emulations[k]);
            KrsFilm *film = film_with(&one, &kinds[i], first[(i + k) % 3]);
            assert_int_equal(krs_film_save(film, take, &file), KRS_OK);
            krs_film_free(film);
            fixture_close_watched(&one);

            KrsPicture *picture;
            fixture_open_as(&other, saved_text, emulations[k]);
            film      = film_with(&other, &kinds[i], 2); /* what is replaced */
            file.size = file.at;
            file.at   = 0;
            assert_int_equal(krs_film_load(film, give, &file), KRS_OK);
            assert_int_equal(file.at, file.size);
            assert_int_equal(krs_film_samples(film), first[(i + k) % 3]);
            const uint32_t left = SAMPLES - krs_film_samples(film);
            if (left > 0)
                assert_int_equal(krs_film_add(film, other.state, NULL, left), KRS_OK);
            assert_int_equal(krs_film_read(film, 0, &picture), KRS_OK);
            assert_same(picture, fixture_render(&other, kinds[i]));
            krs_film_free(film);
            fixture_close_watched(&other);
        }
}

static void what_is_no_film_is_refused(void **state)
{
    static unsigned char room[1 << 22];
    Bytes                file  = {room, sizeof room, 0};
    KrsRenderOptions     wider = kinds[0], other = kinds[0];
    Fixture              fixture;
    (void)state;
    wider.width += 8;
    other.aovs = KRS_AOV_DEPTH;
    fixture_open_as(&fixture, saved_text, 0);
    KrsFilm *film = film_with(&fixture, &kinds[0], 0);
    assert_int_equal(krs_film_save(film, take, &file), KRS_BAD_ARGUMENT); /* without samples */
    assert_int_equal(file.at, 0);
    assert_int_equal(krs_film_add(film, fixture.state, NULL, 1), KRS_OK);
    assert_int_equal(krs_film_save(film, take, &(Bytes){room, 1000, 0}), KRS_IO_ERROR);
    assert_int_equal(krs_film_samples(film), 1);
    assert_int_equal(krs_film_save(film, take, &file), KRS_OK);
    for (size_t cut = 0; cut < file.at; cut += cut < 400 ? 13 : 20011) {
        assert_int_equal(krs_film_load(film, give, &(Bytes){room, cut, 0}), KRS_IO_ERROR);
        assert_int_equal(krs_film_samples(film), 0);
    }
    const KrsRenderOptions *unlike[] = {&wider, &other, &kinds[1]};
    for (size_t i = 0; i < 3; i++) {
        KrsFilm *wrong = film_with(&fixture, unlike[i], 0);
        assert_int_equal(krs_film_load(wrong, give, &(Bytes){room, file.at, 0}), KRS_BAD_ARGUMENT);
        assert_int_equal(krs_film_samples(wrong), 0);
        krs_film_free(wrong);
    }
    room[9] ^= 1; /* the sources */
    assert_int_equal(krs_film_load(film, give, &(Bytes){room, file.at, 0}), KRS_BAD_ARGUMENT);
    room[9] ^= 1;
    assert_int_equal(krs_film_load(film, give, &(Bytes){room, file.at, 0}), KRS_OK);
    krs_film_free(film);
    fixture_close_watched(&fixture);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_saved_film_goes_on),
        cmocka_unit_test(what_is_no_film_is_refused),
    };
    return cmocka_run_group_tests_name("saved", tests, NULL, NULL);
}
