/*
 * random_scene.c: texts of random scenes.
 */
#include "tests/oracle/random_scene.h"

Vec any_vec(Random *random, double size)
{
    return vec(random_between(random, -size, size), random_between(random, -size, size),
               random_between(random, -size, size));
}

static void write_vec(SceneText *text, const char *before, Vec v, const char *after)
{
    scene_write(text, "%s[%.9g, %.9g, %.9g]%s", before, v.x, v.y, v.z, after);
}

/* About as large as 1, around the origin. */
static void write_solid(SceneText *text, Random *random)
{
    static const char *const solids[] = {
        "sphere(0.7)",
        "box([1.1, 0.6, 0.9])",
        "box([1, 1, 0.02])",
        "torus(0.6, 0.2)",
        "cylinder(0.4, 1.2)",
        "cone(0.6, 1.1)",
        "ellipsoid([0.8, 0.2, 0.5])",
        "capsule([-0.5, -0.3, 0], [0.5, 0.4, 0.1], 0.15)",
        "octahedron(0.8)",
        "algebraic(x^4 + y^4 + z^4 == 0.3).within(box([1.6, 1.6, 1.6]))",
        "algebraic(x^2 + y^2 == z^2 * (0.8 - z) + 0.02).within(box([1.6, 1.6, 1.6]))",
        "field(sin(6 * x) * cos(6 * y) + sin(6 * z) * cos(5 * x)).within(sphere(0.8))",
        "union(sphere(0.5), box([1, 0.3, 0.3]), blend: 0.2)",
        "box([1, 1, 1]).round(0.1).shell(0.05)",
        "star(5, 0.8).extrude(0.3)",
        "(box([1, 1, 1]) - sphere(0.62))",
        "(sphere(0.7) & box([1, 1, 1]).move([0.4, 0.3, 0.2]))"};
    scene_write(text, "%s", solids[random_below(random, sizeof solids / sizeof *solids)]);
}

/* Something done to a solid. */
static void write_change(SceneText *text, Random *random)
{
    switch (random_below(random, 9)) {
    case 0: write_vec(text, ".rotate(", any_vec(random, 1), ", 0.7)"); break;
    case 1: scene_write(text, ".scale(%.6g)", random_between(random, 0.3, 1.4)); break;
    case 2: scene_write(text, ".scale([1, %.6g, 1.2])", random_between(random, 0.4, 2)); break;
    case 3: scene_write(text, ".twist([0, 1, 0], %.6g)", random_between(random, -1.5, 1.5)); break;
    case 4: scene_write(text, ".mirror(plane([1, 0.2, 0], 0.1))"); break;
    case 5: scene_write(text, ".repeat([2.6, 0, 2.6], [3, 1, 2])"); break;
    case 6: write_vec(text, ".move(", any_vec(random, 0.5), ")"); break;
    case 7: scene_write(text, ".offset(%.6g)", random_between(random, 0, 0.1)); break;
    default: break;
    }
}

static void write_sequence(SceneText *text, Random *random)
{
    bool inverts = random_below(random, 3) == 0;
    scene_write(text, "krs { kernel ");
    write_solid(text, random);
    scene_write(text, ".scale(0.5)");
    write_vec(text, ".move(", any_vec(random, 0.3), ");\n");
    for (int i = 0, count = 1 + random_below(random, 6); i < count; i++) {
        write_vec(text, "  reflect plane(", random_unit(random), ", ");
        scene_write(text, "%.6g);\n", random_between(random, 0.1, 0.6));
    }
    if (inverts)
        scene_write(text, "  mobius invert([0.4, 2.6, 0.3], 2);\n");
    scene_write(text, "}");
}

void write_random_scene(SceneText *text, Random *random, Vec at, double size)
{
    bool   narrow   = random_below(random, 4) == 0;
    double distance = narrow ? 200 : pow(10, random_between(random, -0.5, 1));
    Vec    eye      = vec_add(at, vec_scale(size * distance, random_unit(random)));
    write_vec(text, "camera { eye: ", eye, ", ");
    write_vec(text, "target: ", at, ", ");
    scene_write(text, "fov: %g }\nlight { direction: [1, 2, 3], shadow: false }\n",
                narrow ? 0.02 : 0.6);
    for (int i = 0, count = 1 + random_below(random, 3); i < count; i++) {
        scene_write(text, "show ");
        if (random_below(random, 3) == 0)
            write_sequence(text, random);
        else {
            write_solid(text, random);
            for (int k = random_below(random, 3); k > 0; k--)
                write_change(text, random);
        }
        write_vec(text, ".move(", any_vec(random, 1), ")");
        scene_write(text, ".scale(%.9g)", size);
        write_vec(text, ".move(", at, ");\n");
    }
    if (random_below(random, 3) == 0)
        scene_write(text, "show plane([0, 1, 0], %.9g);\n", at.y - 1.3 * size);
}
