/*
 * path_fixture.h: scenes lit by random paths, and the means of their pictures with the error that
 * chance leaves.
 */
#ifndef ORACLE_PATH_FIXTURE_H
#define ORACLE_PATH_FIXTURE_H

#include "krs/vulkan.h"
#include "tests/oracle/product.h"

/* A scene on the renderer of the tests. */
typedef struct PathFixture {
    Product       product;
    KrsRendering *rendering;
} PathFixture;

PathFixture path_fixture_open(const char *text);
void        path_fixture_close(PathFixture *fixture);
void        path_fixture_set(PathFixture *fixture, const char *name, double number);
void path_fixture_set_all(PathFixture *fixture, const char *name, double x, double y, double z);

/* Returns a picture, which the caller frees. */
KrsPicture *path_fixture_render(const PathFixture *fixture, const KrsRenderOptions *options);

/* The mean of independent numbers, and its standard error. */
typedef struct Estimate {
    double mean, error;
    int    count;   /* of the numbers */
    double squares; /* sum of squares of what they differ from their mean */
} Estimate;

void estimate_add(Estimate *estimate, double number);

/* Places of a picture, or of the window that was rendered of it, in parts of its sides. */
typedef struct Region {
    double left, top, right, bottom;
} Region;
extern const Region everywhere;

/* The mean of a channel over those pixels of a region that show something. */
double mean_of_region(const KrsPicture *picture, Region region, int channel);

/* The mean green of a region, by that many pictures of different seeds. */
Estimate path_fixture_estimate(const PathFixture *fixture, KrsRenderOptions options, Region region,
                               int pictures);

/* Whether a mean is what is expected, but for SIGMAS of its errors and a part of it.  Errors that
   are found from few pictures are uncertain themselves, so there are more sigmas than usual. */
#define SIGMAS 5
bool is_near(Estimate found, double expected, double part);
/* The same; tells if it is not. */
bool must_be_near(Estimate found, double expected, double part, const char *what);

#endif
