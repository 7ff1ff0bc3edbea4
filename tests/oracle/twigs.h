/*
 * twigs.h: scenes of thin twigs, pictures of them, and where exact rays meet them.
 */
#ifndef ORACLE_TWIGS_H
#define ORACLE_TWIGS_H

#include "krs/vulkan.h"
#include "tests/oracle/exact.h"
#include "tests/oracle/product.h"

struct CMUnitTest;

/* What is asked for, and what a test must be able to see. */
#define MAX_NET_ERROR 0.01  /* of the coverage */
#define MAX_NOISE     0.003 /* one standard error, as a share of the coverage */
#define MAX_OFF       0.001 /* the share of hits whose depth is off by more than is permitted */
#define PLANTED_ERROR 0.1   /* a fault shows at least this much */

#define DEFAULT_ERROR 0.25 /* krs/vulkan.h */
#define ROUGH_ERROR   0.5  /* of a scene that asks for it */
enum { WIDTH = 400, HEIGHT = 225, PIXELS = WIDTH * HEIGHT };

enum { ROUND, FLAT, CAMERAS }; /* perspective and orthographic */

typedef enum SceneKind {
    THICKET,
    HEAP,
    WALLED_THICKET,
    WALLED_HEAP,
    TREE,
    ROUGH,
    SCENES
} SceneKind;

/* Capsules, known here copy by copy.  The scene's parameter `size` is the length of which all
   radii are multiples. */
typedef struct Scene {
    Vec           eye, target;
    double        fov;
    Rod          *rods;
    size_t        count;
    bool          walled;
    Vec           low, high; /* of the wall */
    SceneText     text;
    Product       product;
    KrsRendering *rendering;
} Scene;

/* Compiles the scene when it is first asked for. */
Scene *use_scene(SceneKind kind);

/* ---- Pictures, and what is there ---- */

/* A picture to be taken.  `wide` is the width of twigs in pixels where the camera looks at. */
typedef struct Shot {
    SceneKind kind;
    double    wide;
    double    error; /* 0: the default */
    int       camera;
    double    grown; /* a fault: pixels more for all radii in the scene, but not in the truth */
    bool      uncut; /* a fault: the truth has what the mirrors cut away */
} Shot;

Lens twigs_lens(const Shot *shot, int width, int height);
/* Returns the parameter `size` for twigs of so many pixels. */
double twigs_size(const Scene *scene, const Lens *lens, double wide);
/* Returns the permitted error in pixels. */
double      twigs_error(const Shot *shot);
KrsPicture *twigs_render(const Shot *shot, const Lens *lens, uint32_t samples);
/* Where the ray through (i + x, j + y) of each pixel meets a twig, unless the wall hides it;
   HUGE_VAL where it does not. */
double *twigs_truth(const Shot *shot, const Lens *lens, double x, double y);

/* With a renderer for all of them; frees the scenes that they used. */
int run_twig_tests(const char *name, const struct CMUnitTest *tests, size_t count);

#endif
