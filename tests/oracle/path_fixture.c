/*
 * path_fixture.c: scenes lit by random paths, and the means of their pictures.
 */
#include "tests/oracle/path_fixture.h"

#include <math.h>

#include "tests/support/renderer.h"

const Region everywhere = {0, 0, 1, 1};

PathFixture path_fixture_open(const char *text)
{
    PathFixture fixture = {.product = product_compile(text)};
    if (krs_rendering_new(renderer, fixture.product.scene, KRS_FOR_PICTURES, &fixture.rendering) !=
        KRS_OK)
        fail_msg("%s", krs_renderer_message(renderer));
    return fixture;
}

void path_fixture_close(PathFixture *fixture)
{
    krs_rendering_free(fixture->rendering);
    product_free(&fixture->product);
}

void path_fixture_set(PathFixture *fixture, const char *name, double number)
{
    assert_int_equal(krs_state_set(fixture->product.state, name, &number, 1), KRS_OK);
}

void path_fixture_set_all(PathFixture *fixture, const char *name, double x, double y, double z)
{
    assert_int_equal(krs_state_set(fixture->product.state, name, (double[]){x, y, z}, 3), KRS_OK);
}

KrsPicture *path_fixture_render(const PathFixture *fixture, const KrsRenderOptions *options)
{
    KrsPicture *picture;
    if (krs_render(fixture->rendering, fixture->product.state, options, &picture) != KRS_OK)
        fail_msg("%s", krs_renderer_message(renderer));
    assert_int_equal(picture->stats.unresolved, 0);
    return picture;
}

void estimate_add(Estimate *estimate, double number)
{
    double before = estimate->mean;
    estimate->count++;
    estimate->mean += (number - before) / estimate->count;
    estimate->squares += (number - before) * (number - estimate->mean);
    if (estimate->count > 1)
        estimate->error = sqrt(estimate->squares / (estimate->count - 1) / estimate->count);
}

double mean_of_region(const KrsPicture *picture, Region region, int channel)
{
    double   sum   = 0;
    unsigned count = 0, width = picture->window.width, height = picture->window.height;
    for (unsigned y = (unsigned)(region.top * height); y < (unsigned)(region.bottom * height); y++)
        for (unsigned x = (unsigned)(region.left * width); x < (unsigned)(region.right * width);
             x++) {
            const float *color = &picture->color[4 * (y * width + x)];
            if (color[3] == 1) {
                sum += (double)color[channel];
                count++;
            }
        }
    assert_true(count > 0);
    return sum / count;
}

Estimate path_fixture_estimate(const PathFixture *fixture, KrsRenderOptions options, Region region,
                               int pictures)
{
    Estimate estimate = {0};
    for (int i = 0; i < pictures; i++) {
        options.seed        = (uint64_t)i + 1;
        KrsPicture *picture = path_fixture_render(fixture, &options);
        estimate_add(&estimate, mean_of_region(picture, region, 1));
        krs_picture_free(picture);
    }
    return estimate;
}

bool is_near(Estimate found, double expected, double part)
{
    return fabs(found.mean - expected) <= SIGMAS * found.error + part * fabs(expected);
}

bool must_be_near(Estimate found, double expected, double part, const char *what)
{
    bool good = is_near(found, expected, part);
    if (!good)
        print_message("# %s: %.5f +- %.5f instead of %.5f\n", what, found.mean, found.error,
                      expected);
    return good;
}
