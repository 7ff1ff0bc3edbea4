/*
 * watchdog.c: what counts as the work of a process, by a clock that is set, and of processes that are stopped,
 * asleep or busy.
 */
#include <math.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

#include "compiler/base/watchdog.h"
#include "tests/support/random.h"

/* A process and its clock. */
typedef struct Simulation {
    ProcessSample sample;
    Watchdog      watchdog;
} Simulation;

enum { LOOKS_A_SECOND = 10 };

/* So many seconds pass, of which the process gets a share of so many processors. */
static void pass(Simulation *simulation, double seconds, double share)
{
    for (int i = 0; i < (int)(seconds * LOOKS_A_SECOND + 0.5); i++) {
        simulation->sample.now += 1.0 / LOOKS_A_SECOND;
        simulation->sample.processor += share / LOOKS_A_SECOND;
        watchdog_add(&simulation->watchdog, &simulation->sample);
    }
}

static Simulation begin(bool runnable)
{
    Simulation simulation = {.sample = {.now = 1e6, .runnable = runnable}};
    watchdog_add(&simulation.watchdog, &simulation.sample);
    return simulation;
}

static void assert_work(const Simulation *simulation, double worked, double fruitless)
{
    assert_true(fabs(simulation->watchdog.worked - worked) < 1e-6 * (1 + worked));
    assert_true(fabs(simulation->watchdog.fruitless - fruitless) < 1e-6 * (1 + worked));
}

static void busy_processes_work(void **state)
{
    (void)state;
    Simulation one = begin(true), many = begin(true), blocked = begin(false);
    pass(&one, 30, 1);
    pass(&many, 30, 16);
    pass(&blocked, 30, 0);
    assert_work(&one, 30, 30);
    assert_work(&many, 30, 30); /* threads do not multiply the time */
    assert_work(&blocked, 30, 30);
}

static void starved_processes_work_as_much_as_they_get(void **state)
{
    (void)state;
    Simulation starved = begin(true), none = begin(true);
    pass(&starved, 3000, 0.01);
    pass(&none, 3000, 0);
    assert_work(&starved, 30, 30);
    assert_work(&none, 0, 0);
}

static void stopped_processes_do_not_work(void **state)
{
    (void)state;
    Simulation stopped = begin(true);
    pass(&stopped, 10, 1);
    stopped.sample.runnable = false;
    stopped.sample.stopped  = true;
    pass(&stopped, 5000, 0);
    stopped.sample.stopped  = false;
    stopped.sample.runnable = true;
    pass(&stopped, 10, 1);
    assert_work(&stopped, 20, 20);
}

/* The clock leaps ahead while the machine sleeps, or who samples is stopped. */
static void leaps_are_no_work(void **state)
{
    (void)state;
    Simulation leaping = begin(false);
    for (int leap = 0; leap < 5; leap++) {
        pass(&leaping, 2, 0);
        leaping.sample.now += 86400;
        watchdog_add(&leaping.watchdog, &leaping.sample);
    }
    assert_work(&leaping, 5 * (2 + WATCHDOG_LONGEST_GAP), 5 * (2 + WATCHDOG_LONGEST_GAP));
}

/* A sample that was taken before another but comes after it: times of two processes are never exact. */
static void a_clock_that_goes_back_is_no_work(void **state)
{
    (void)state;
    Simulation back = begin(false);
    pass(&back, 3, 0);
    back.sample.now -= 1;
    back.sample.processor -= 1;
    watchdog_add(&back.watchdog, &back.sample);
    assert_work(&back, 3, 3);
}

static void steps_begin_anew(void **state)
{
    (void)state;
    Simulation walking = begin(true);
    for (int step = 1; step <= 50; step++) {
        pass(&walking, 5, 1);
        walking.sample.progress++;
        watchdog_add(&walking.watchdog, &walking.sample);
        assert_work(&walking, 5 * step, 0);
    }
    pass(&walking, 5, 1);
    assert_work(&walking, 255, 5);
}

static void waiting_for_something_to_do_is_no_work(void **state)
{
    (void)state;
    Simulation idle = begin(false);
    pass(&idle, 3, 0);
    idle.sample.idle = true;
    pass(&idle, 3600, 0);
    idle.sample.idle = false;
    idle.sample.progress++;
    pass(&idle, 2, 0);
    assert_true(fabs(idle.watchdog.worked - 5) < 0.21);
}

/* By any samples at a process with any share, the work is never more than time and processor time together say. */
static void work_is_no_more_than_time(void **state)
{
    (void)state;
    Random random = {.state = 7};
    for (int trial = 0; trial < 1000; trial++) {
        Simulation any  = begin(true);
        double     used = 0, passed = 0;
        for (int i = 0; i < 100; i++) {
            const double time  = random_between(&random, 0, 3),
                         share = random_between(&random, 0, 4);
            any.sample.now += time;
            any.sample.processor += time * share;
            passed += time;
            used += time * share;
            watchdog_add(&any.watchdog, &any.sample);
        }
        assert_true(any.watchdog.worked <= used + 1e-9 && any.watchdog.worked <= passed + 1e-9);
    }
}

/* ---- real processes ---- */

static pid_t start(bool busy)
{
    const pid_t child = fork();
    assert_true(child >= 0);
    while (child == 0)
        if (!busy)
            pause();
    return child;
}

/* Looks ten times a second. */
static Watchdog watch(pid_t process, int samples)
{
    Watchdog watchdog = {0};
    for (int i = 0; i < samples; i++) {
        ProcessSample sample = {0};
        watchdog_sample(process, &watchdog.last, &sample);
        watchdog_add(&watchdog, &sample);
        nanosleep(&(struct timespec){0, 100000000}, NULL);
    }
    return watchdog;
}

static void end(pid_t process)
{
    kill(process, SIGKILL);
    waitpid(process, NULL, 0);
}

static void what_processes_do_is_seen(void **state)
{
    (void)state;
    const pid_t asleep = start(false), busy = start(true), stopped = start(true);
    kill(stopped, SIGSTOP);
    const Watchdog of_asleep = watch(asleep, 6), of_busy = watch(busy, 6),
                   of_stopped = watch(stopped, 6);
    end(asleep);
    end(busy);
    end(stopped);
    assert_false(of_asleep.last.runnable);
    assert_false(of_asleep.last.stopped);
    assert_true(of_asleep.worked > 0.4);
    assert_true(of_busy.last.runnable);
    assert_true(of_busy.worked <= of_busy.last.processor + 1e-9);
    assert_true(of_stopped.last.stopped);
    assert_true(of_stopped.worked == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(busy_processes_work),
        cmocka_unit_test(starved_processes_work_as_much_as_they_get),
        cmocka_unit_test(stopped_processes_do_not_work),
        cmocka_unit_test(leaps_are_no_work),
        cmocka_unit_test(a_clock_that_goes_back_is_no_work),
        cmocka_unit_test(steps_begin_anew),
        cmocka_unit_test(waiting_for_something_to_do_is_no_work),
        cmocka_unit_test(work_is_no_more_than_time),
        cmocka_unit_test(what_processes_do_is_seen),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
