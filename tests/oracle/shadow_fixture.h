/*
 * shadow_fixture.h: scenes of solids over white ground, to see the shadows of a light in.
 *
 * Two lights of every scene are one but for colour: red light casts shadows, green light does not,
 * and the sky is black; so on white ground red over green is how much of the light is visible.
 */
#ifndef ORACLE_SHADOW_FIXTURE_H
#define ORACLE_SHADOW_FIXTURE_H

#include "krs/vulkan.h"
#include "tests/oracle/exact.h"
#include "tests/oracle/product.h"

struct CMUnitTest;

#define DEGREE (M_PI / 180)

/* ---- Scenes: solids over white ground, which is y = 0 ---- */

typedef enum SolidKind { BALL, SLAB, TWIG } SolidKind;

typedef struct Solid {
    SolidKind kind;
    Vec       a, b;   /* the centre; the low and the high corner; the ends */
    double    radius; /* of twigs: in units of the parameter `size` */
} Solid;

typedef enum FixtureKind {
    LEDGE,
    LEDGE_LAMP,
    BALLS,
    BALL_LAMP,
    TWIGS,
    BOUNDS,
    FAR_BOUNDS,
    POLYNOMIALS,
    FIELDS,
    TWISTS,
    FIXTURES
} FixtureKind;

enum { FROM_ABOVE, FROM_THE_SIDE }; /* cameras: orthographic and perspective */

enum { MAX_SOLIDS = 24, MAX_PIXELS = 1 << 16 };

typedef struct Fixture {
    bool          lamp;  /* its light has a place, else it is a sun */
    double        slope; /* balls have a distance so many times too small; 0: the true one */
    const char   *ball;  /* what they are made of: a ball of radius 1; NULL: spheres */
    Vec           target;
    double        high; /* of what is seen from above */
    Solid         solids[MAX_SOLIDS];
    int           count;
    SceneText     text;
    Product       product;
    KrsRendering *rendering;
} Fixture;

extern Fixture fixtures[FIXTURES];
/* A slab whose upper edge, along z, casts a straight shadow. */
extern const Solid a_ledge;

void open_rendering(const Product *product, KrsRendering **rendering);

/* Compiles the scene when it is first asked for. */
Fixture *use_fixture(FixtureKind kind);

/* ---- Pictures ---- */

/* A picture to be taken of a fixture. */
typedef struct Shot {
    FixtureKind      fixture;
    Vec              light; /* towards it, or its place */
    double           wide;  /* its angle, or its radius */
    double           size;  /* of twigs; 0: they do not matter */
    KrsRenderOptions options;
    int              without; /* in truth this solid is not there, counted from 1; 0: all are */
} Shot;

/* Gives the state of the shot's fixture its light, and the size of twigs. */
void        set_lighting(const Shot *shot);
KrsPicture *take_picture(KrsRendering *rendering, KrsState *state, KrsRenderOptions options);
KrsPicture *shoot(const Shot *shot);
Lens        shot_lens(const Shot *shot);
/* Returns how much of the light a pixel of the window sees; -1 where it is not ground in the
   light. */
double seen_at(const KrsPicture *picture, int k);
/* Returns the ground in the middle of a pixel of the window. */
Vec    ground_at(const Lens *lens, const KrsWindow *window, double x, double y);
double pixel_at(const Lens *lens, Vec ground);

/* ---- Lights of some width, and what they are seen with ---- */

typedef struct Lighting {
    const char *name;
    FixtureKind ledge, ball;
    Vec         edge_light, ball_light;
    double      wide;
} Lighting;

enum { LIGHTINGS = 3 };
extern const Lighting lightings[LIGHTINGS];

/* Across the shadow of the ledge; of a ball. */
Shot edge_shot(const Lighting *lighting, KrsShadows shadows, uint32_t samples);
Shot ball_shot(const Lighting *lighting, KrsShadows shadows, uint32_t samples);

/* With a renderer for all of them; closes the fixtures that they used. */
int run_shadow_tests(const char *name, const struct CMUnitTest *tests, size_t count);

#endif
