/*
 * questions.c: krs_probe and krs_raycast beside krs_device_probe and krs_device_raycast, in turns.
 *
 * The host answers one question after the other in one thread, so it is asked fewer.  Rays come
 * from a ball around the tree and go to points within its box: about half of them hit.
 */
#include "bench/questions.h"

#include <math.h>
#include <string.h>

#include "bench/measure.h"

const char *const answerer_names[ANSWERER_COUNT] = {"host", "device"};

typedef struct Inquiry {
    KrsScene     *scene;
    KrsState     *state;
    KrsRendering *rendering;
    size_t        count; /* of questions that there are */
    double (*points)[3], (*aims)[3];
    KrsHit *hits[ANSWERER_COUNT];
} Inquiry;

static void inquiry_open(Bench *bench, Inquiry *in, size_t count)
{
    const char *path = "bench/scenes/tree28.krs";
    *in              = (Inquiry){.count = count};
    if (krs_compile_file(path, NULL, &in->scene) != KRS_OK ||
        krs_state_new(in->scene, &in->state) != KRS_OK)
        fail("cannot compile %s", path);
    if (krs_rendering_new(bench->renderer, in->scene, KRS_FOR_QUESTIONS, &in->rendering) != KRS_OK)
        fail("%s", krs_renderer_message(bench->renderer));
    in->points = arena_alloc(bench->arena, count * sizeof *in->points, sizeof(double));
    in->aims   = arena_alloc(bench->arena, count * sizeof *in->aims, sizeof(double));
    for (int i = 0; i < ANSWERER_COUNT; i++)
        in->hits[i] = arena_new_array(bench->arena, KrsHit, count);
}

static void inquiry_close(Inquiry *in)
{
    krs_rendering_free(in->rendering);
    krs_state_free(in->state);
    krs_scene_free(in->scene);
}

/* Questions that are spread evenly: multiples of the powers of the plastic number's sibling in
   four dimensions (R4). */
static void make_questions(Inquiry *in)
{
    static const double step[]    = {0.8566748838545029, 0.733891856627126, 0.6287067210378087,
                                     0.5385972572236101};
    const double        center[3] = {0, 1.5, 0}, radius = 3, half = 1.2;
    for (size_t i = 0; i < in->count; i++) {
        double at[4];
        for (int k = 0; k < 4; k++)
            at[k] = fmod(0.5 + step[k] * (double)i, 1);
        double up = 2 * at[3] - 1, ring = sqrt(1 - up * up), turn = 2.399963229728653 * (double)i;
        double direction[3] = {ring * cos(turn), up, ring * sin(turn)};
        for (int k = 0; k < 3; k++) {
            double target    = center[k] + half * (2 * at[k] - 1);
            in->points[i][k] = center[k] + radius * direction[k];
            in->aims[i][k]   = target - in->points[i][k];
        }
    }
}

/* Milliseconds of a call. */
static double ask(Bench *bench, Inquiry *in, int answerer, bool rays, size_t count)
{
    const double(*points)[3] = (const double(*)[3])in->points;
    const double(*aims)[3]   = (const double(*)[3])in->aims;
    KrsHit   *hits           = in->hits[answerer];
    double    start          = clock_ms();
    KrsStatus status;
    if (answerer == ANSWERER_HOST)
        status = rays ? krs_raycast(in->state, points, aims, count, INFINITY, 0, hits)
                      : krs_probe(in->state, points, count, hits);
    else
        status = rays ? krs_device_raycast(in->rendering, in->state, points, aims, count, INFINITY,
                                           0, hits)
                      : krs_device_probe(in->rendering, in->state, points, count, hits);
    if (status != KRS_OK)
        fail("questions are not answered: %s", krs_renderer_message(bench->renderer));
    return clock_ms() - start;
}

static double disagreement(const Inquiry *in, size_t count)
{
    size_t differ = 0;
    for (size_t i = 0; i < count; i++)
        differ += in->hits[ANSWERER_HOST][i].hit != in->hits[ANSWERER_DEVICE][i].hit;
    return (double)differ / (double)count;
}

void questions_run(Bench *bench, Questions *questions)
{
    Inquiry      in;
    const size_t most = bench->quick ? 4096 : 65536, host = bench->quick ? 100 : 1000;
    const size_t counts[ANSWERER_COUNT] = {host, most};
    enum { MAX_REPEATS = 50 };
    double ms[ANSWERER_COUNT][2][MAX_REPEATS], alone[MAX_REPEATS];
    tell("questions, %u times", bench->repeats);
    inquiry_open(bench, &in, most);
    make_questions(&in);
    for (int i = 0; i < ANSWERER_COUNT; i++)
        ask(bench, &in, i, true, counts[i] / 10);
    for (uint32_t r = 0; r < bench->repeats; r++) {
        for (int i = 0; i < ANSWERER_COUNT; i++)
            for (int rays = 0; rays < 2; rays++)
                ms[i][rays][r] = ask(bench, &in, i, rays != 0, counts[i]);
        if (r == 0)
            questions->disagree = disagreement(&in, host);
        alone[r] = ask(bench, &in, ANSWERER_DEVICE, true, 1);
    }
    for (int i = 0; i < ANSWERER_COUNT; i++) {
        questions->points[i] = questions->rays[i] = counts[i];
        questions->points_per_second[i]           = 1e3 * (double)counts[i] /
                                          median(ms[i][0], bench->repeats);
        questions->rays_per_second[i] = 1e3 * (double)counts[i] / median(ms[i][1], bench->repeats);
    }
    questions->alone_ms = median(alone, bench->repeats);
    inquiry_close(&in);
}

void questions_judge(const Questions *questions, Text *faults)
{
    const double most = 0.02; /* twigs of a ten thousandth of the tree are lost to rounding */
    if (!(questions->disagree <= most))
        text_format(faults, "questions: host and device differ about %.3g of the rays\n",
                    questions->disagree);
}
