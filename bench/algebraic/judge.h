/*
 * judge.h: whether pictures of algebraic surfaces show what they should.
 */
#ifndef KRS_BENCH_ALGEBRAIC_JUDGE_H
#define KRS_BENCH_ALGEBRAIC_JUDGE_H

#include "bench/algebraic/contest.h"
#include "tests/oracle/brute.h"

/* What is drawn: the solid f <= 0 within the ball, or the surface f = 0 alone. */
typedef enum Drawn { CUT_SOLID, OPEN_SURFACE } Drawn;

/* One pixel in sixteen is judged, where it sees something. */
enum { STRIDE = 4, SEEN_ROWS = HEIGHT / STRIDE, SEEN_COLUMNS = WIDTH / STRIDE };

/* Finds the ray of a pixel. */
void find_ray(const View *view, int x, int y, Vec *origin, Vec *direction);

/* Counts one pixel, of those that are looked at. */
void      judge_one(const Subject *subject, const View *view, Drawn drawn, int x, int y, bool seen,
                    Judgement *judgement);
Judgement judge(const Subject *subject, const View *view, Drawn drawn,
                bool seen[SEEN_ROWS][SEEN_COLUMNS]);

/* Fails unless the text for the other programs is that of the same surface. */
void check_text(const Subject *subject);

/* ---- estimates.c ---- */
/* What marching by estimates that are no bounds takes, and gets wrong. */
void estimates_print(const Subject *subject, const View *view);

#endif
