/*
 * resolution.c: pictures of what moves are in time, and no coarser than that needs, on devices that
 * are made up: of each it is known what a picture costs.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "live/pictures/resolution.h"

static const double PIXELS = 640 * 360, BUDGET = 40;

typedef struct Device {
    double fixed_ms, whole_ms; /* of any picture; of the pixels of a whole one */
    double coarse;             /* how many times more a pixel of a coarse picture costs */
} Device;

static double coarse_ms(const Device *device, double divisor)
{
    return device->fixed_ms + device->coarse * device->whole_ms / (divisor * divisor);
}

static void show_whole(Resolution *resolution, const Device *device)
{
    resolution_learn_whole(resolution, device->fixed_ms + device->whole_ms, PIXELS);
}

/* Returns what the coarse picture takes. */
static double show_coarse(Resolution *resolution, const Device *device)
{
    const double divisor = resolution_divide(resolution, PIXELS, BUDGET);
    const double ms      = coarse_ms(device, divisor);
    resolution_learn_coarse(resolution, ms, PIXELS / (divisor * divisor));
    return ms;
}

/* After some pictures they are in time, and larger ones would not be: the next sizes but one. */
static void assert_settles(Resolution *resolution, const Device *device, int pictures)
{
    double ms = 0;
    for (int i = 0; i < pictures; i++)
        ms = show_coarse(resolution, device);
    const double most = device->fixed_ms + fmax(BUDGET - device->fixed_ms, BUDGET / 2);
    for (int i = 0; i < 20; i++) {
        ms = show_coarse(resolution, device);
        assert_true(ms <= 1.25 * most);
        assert_true(coarse_ms(device, resolution->divisor / 3) > BUDGET);
    }
}

static const Device slow = {5, 500, 1.5}, slower = {5, 4000, 1.5}, waits = {15, 300, 1};

static void a_still_view_begins_to_move(void **state)
{
    (void)state;
    const Device *devices[] = {&slow, &slower, &waits};
    for (int i = 0; i < 3; i++) {
        Resolution resolution = {0};
        show_coarse(&resolution, devices[i]);
        show_whole(&resolution, devices[i]);
        assert_settles(&resolution, devices[i], 2);
    }
}

static void the_view_gets_more_costly(void **state)
{
    (void)state;
    Resolution resolution = {0};
    show_coarse(&resolution, &slow);
    show_whole(&resolution, &slow);
    assert_settles(&resolution, &slow, 2);
    assert_settles(&resolution, &slower, 3);
}

static void the_view_gets_cheaper(void **state)
{
    (void)state;
    Resolution resolution = {0};
    show_coarse(&resolution, &slower);
    show_whole(&resolution, &slower);
    assert_settles(&resolution, &slower, 2);
    assert_settles(&resolution, &slow, 6);
}

/* By and by, as a camera turns: pictures of one size do not tell what of their time is of the pixels. */
static void the_view_gets_more_costly_slowly(void **state)
{
    (void)state;
    Device     device     = slow;
    Resolution resolution = {0};
    show_coarse(&resolution, &device);
    show_whole(&resolution, &device);
    for (int i = 0; i < 150; i++) {
        device.whole_ms *= 1.02;
        assert_true(show_coarse(&resolution, &device) <= 1.25 * BUDGET);
    }
}

/* Where the time is not of the pixels, fewer of them would not help. */
static void waiting_is_not_mended_by_fewer_pixels(void **state)
{
    (void)state;
    const Device device     = {60, 60, 1};
    Resolution   resolution = {0};
    show_coarse(&resolution, &device);
    show_whole(&resolution, &device);
    for (int i = 0; i < 40; i++) {
        show_coarse(&resolution, &device);
        assert_true(resolution.divisor <= 4);
    }
}

/* Then pictures of one size alone would not tell that fewer pixels help. */
static void what_is_taken_for_waiting_is_tried(void **state)
{
    (void)state;
    const Device device     = {12, 400, 1.6};
    Resolution   resolution = {
          .divisor = 4, .fixed_ms = 37, .pixel_ms = 20 * 16 / PIXELS, .coarse_pixels = PIXELS / 16};
    assert_settles(&resolution, &device, 4);
    assert_true(coarse_ms(&device, resolution.divisor) <= 1.2 * BUDGET);
}

static void cheap_pictures_are_whole(void **state)
{
    (void)state;
    const Device device     = {2, 20, 1.2};
    Resolution   resolution = {0};
    show_coarse(&resolution, &device);
    show_whole(&resolution, &device);
    assert_true(resolution_divide(&resolution, PIXELS, BUDGET) == 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_still_view_begins_to_move),
        cmocka_unit_test(the_view_gets_more_costly),
        cmocka_unit_test(the_view_gets_more_costly_slowly),
        cmocka_unit_test(the_view_gets_cheaper),
        cmocka_unit_test(waiting_is_not_mended_by_fewer_pixels),
        cmocka_unit_test(what_is_taken_for_waiting_is_tried),
        cmocka_unit_test(cheap_pictures_are_whole),
    };
    return cmocka_run_group_tests_name("resolution", tests, NULL, NULL);
}
