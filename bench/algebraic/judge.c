/*
 * judge.c: pictures against first roots in long double precision (tests/oracle/formulas.h).
 */
#include "bench/algebraic/judge.h"

#include <math.h>
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

#include "tests/oracle/formulas.h"

void find_ray(const View *view, int x, int y, Vec *origin, Vec *direction)
{
    double pixel = view->height / HEIGHT, at[3];
    double u = (x + 0.5 * (1 - WIDTH)) * pixel, v = -(y + 0.5 * (1 - HEIGHT)) * pixel;
    for (int i = 0; i < 3; i++)
        at[i] = view->distance * view->back[i] + u * view->right[i] + v * view->up[i];
    *origin    = vec(at[0], at[1], at[2]);
    *direction = vec(-view->back[0], -view->back[1], -view->back[2]);
}

static Fate fate_of(const Subject *subject, const View *view, Drawn drawn, int x, int y)
{
    const Surface *surface = surface_named(subject->oracle);
    Vec            origin, direction;
    find_ray(view, x, y, &origin, &direction);
    return drawn == CUT_SOLID
               ? surface_entry(surface->formula, subject->radius, origin, direction).fate
               : surface_crossing(surface->formula, subject->radius, origin, direction).fate;
}

/* What is known of a surface: found once, as that takes a while. */
typedef struct Known {
    const Subject *subject;
    const View    *view;
    Drawn          drawn;
    unsigned char  fates[SEEN_ROWS * SEEN_COLUMNS];
} Known;

static void find_rows(Known *k, int first)
{
    for (int y = first; y < SEEN_ROWS; y += 2)
        for (int x = 0; x < SEEN_COLUMNS; x++)
            k->fates[y * SEEN_COLUMNS + x] = (unsigned char)fate_of(k->subject, k->view, k->drawn,
                                                                    x * STRIDE, y * STRIDE);
}

static void *find_odd_rows(void *known)
{
    find_rows(known, 1);
    return NULL;
}

static const unsigned char *find_fates(const Subject *subject, const View *view, Drawn drawn)
{
    static Known known[2 * MAX_SUBJECTS];
    Known       *k = known;
    while (k->subject && (k->subject != subject || k->drawn != drawn))
        if (++k == known + 2 * MAX_SUBJECTS)
            give_up(subject->name, "there are too many surfaces");
    if (!k->subject) {
        pthread_t other;
        k->subject = subject;
        k->view    = view;
        k->drawn   = drawn;
        if (pthread_create(&other, NULL, find_odd_rows, k) != 0)
            give_up(subject->name, "cannot start a thread");
        find_rows(k, 0);
        pthread_join(other, NULL);
    }
    return k->fates;
}

/* Tells whether a pixel next to this one should be seen so. */
static bool is_at_outline(const Subject *subject, const View *view, Drawn drawn, int x, int y,
                          bool seen)
{
    for (int k = 0; k < 9; k++) {
        Fate fate = fate_of(subject, view, drawn, x + k % 3 - 1, y + k / 3 - 1);
        if (fate == RAY_DOUBTFUL || (fate == RAY_HITS) == seen)
            return true;
    }
    return false;
}

void judge_one(const Subject *subject, const View *view, Drawn drawn, int x, int y, bool seen,
               Judgement *j)
{
    int fate = find_fates(subject, view, drawn)[y / STRIDE * SEEN_COLUMNS + x / STRIDE];
    if (fate == RAY_DOUBTFUL)
        return;
    j->asked++;
    if (seen == (fate == RAY_HITS))
        return;
    j->missed += !seen;
    j->extra += seen;
    j->apart += !is_at_outline(subject, view, drawn, x, y, seen);
}

Judgement judge(const Subject *subject, const View *view, Drawn drawn,
                bool seen[SEEN_ROWS][SEEN_COLUMNS])
{
    Judgement j = {0};
    for (int y = 0; y < SEEN_ROWS; y++)
        for (int x = 0; x < SEEN_COLUMNS; x++)
            judge_one(subject, view, drawn, x * STRIDE, y * STRIDE, seen[y][x], &j);
    return j;
}

void check_text(const Subject *subject)
{
    const Surface *surface = surface_named(subject->oracle);
    Polynomial     p       = polynomial_read(subject->text, definitions);
    double         ratio   = 0;
    for (int i = 0; i < 20; i++) {
        double at[3]   = {sin(3.1 * i + 0.4), sin(1.7 * i + 1), sin(2.3 * i + 2)};
        Real   same[3] = {at[0], at[1], at[2]};
        double next    = polynomial_value(&p, at) / (double)surface->formula(same);
        if (i > 0 && fabs(next / ratio - 1) > 1e-6)
            give_up(subject->name, "the text is another polynomial than the library's");
        ratio = next;
    }
}
