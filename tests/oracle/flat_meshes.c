/*
 * flat_meshes.c: solids of flat faces have as few triangles as these need, and are what their parts say.
 *
 * Random parts are joined by random set operations.  Whether a point is inside is told part by part, by the sides of a
 * convex solid or by how often a polygon goes around, and of the mesh by the solid angle that it fills.
 */
#include "tests/oracle/mesh_distance.h"
#include "tests/oracle/mesh_shape.h"
#include "tests/oracle/product.h"

#include <string.h>

static const double PI = 3.14159265358979323846;

static KrsMesh *mesh_of_text(const char *text, bool even)
{
    Product        product = product_compile(text);
    KrsMeshOptions options = {.even = even};
    KrsMesh       *mesh;
    assert_int_equal(krs_mesh(product.state, &options, &mesh), KRS_OK);
    product_free(&product);
    check_closed(mesh);
    return mesh;
}

/* ---- closed forms ---- */

static void solids_have_no_more_triangles_than_their_faces_need(void **state)
{
    static const struct {
        const char *text;
        size_t      triangles;
        long        parts, genus;
        double      volume;
    } solids[] = {
        {"show polygon([[0, 0], [10, 0], [10, 6]]).extrude(10);", 8, 1, 0, 300},
        {"show polygon([[0, 0], [1, 1], [1, -1]]).rotate(13deg).extrude(0.5);", 8, 1, 0, 0.5},
        {"show box([4, 0.004, 4]);", 12, 1, 0, 0.064},
        {"show box([1, 2, 3]).rotate([1, 2, 3], 40deg).move([5, 6, 7]);", 12, 1, 0, 6},
        {"show prism(3, 1, 1);", 8, 1, 0, 1.299038105676658},
        {"show prism(6, 1, 2);", 20, 1, 0, 5.196152422706632},
        {"show tetrahedron(1);", 4, 1, 0, 0.5132002392796674},
        {"show octahedron(1);", 8, 1, 0, 4. / 3},
        {"show dodecahedron(1);", 36, 1, 0, 2.785163863122},
        {"show icosahedron(1);", 20, 1, 0, 2.536150710129},
        {"show pyramid(2, 1);", 6, 1, 0, 4. / 3},
        /* A taper divides by a number that is linear: flat faces stay so. */
        {"show box([2, 1, 1]).taper([0, 1, 0], 1, 0.3);", 12, 1, 0, 2 * (1 + 0.3 + 0.09) / 3},
        {"show prism(6, 1, 2).taper([0, 1, 0], 1, 0.5).rotate([1, 2, 3], 40deg);", 20, 1, 0,
         5.196152422706632 * (1 + 0.5 + 0.25) / 3},
        {"show star(5, 1, 0.5).extrude(1).taper([0, 0, 1], 1, 0.5);", 36, 1, 0,
         2.5 * 0.587785252292473 * (1 + 0.5 + 0.25) / 3},
        {"show box([1, 2, 1]).taper([0, 1, 0], 0.5, 1.5) - box([0.3, 4, 0.3]);", 32, 1, 1,
         2 * (0.25 + 0.75 + 2.25) / 3 - 0.18},
        {"show box([2, 2, 2]) - box([1, 1, 3]);", 32, 1, 1, 6},
        {"show box([3, 3, 3]) - box([1, 1, 1]);", 24, 2, 0, 26},
        {"show box([2, 2, 2]) | box([1, 1, 1]).move([3, 0, 0]);", 24, 2, 0, 9},
        /* Solids that touch along an edge, or in a point, stay two. */
        {"show box([2, 2, 2]) | box([2, 2, 2]).move([2, 2, 0]);", 24, 2, 0, 16},
        {"show box([2, 2, 2]) | box([2, 2, 2]).move([2, 2, 2]);", 24, 2, 0, 16},
        {"show box([4, 4, 4]) - box([2, 2, 6]).move([1, 1, 0]) - box([2, 2, 6]).move([-1, -1, 0]);",
         24, 2, 0, 32},
        /* A floor that is level with an underside, which both end on the wall of what is below. */
        {"show (box([1, 1, 1]).move([-0.1, -0.5, 0]) | box([1, 1, 1]).move([0, 0.5, 0])) - "
         "prism(4, 0.25, 1).move([0.2, 0.5, 0]);",
         52, 1, 1, 1.875},
        /* Level faces are one. */
        {"show box([2, 1, 1]) | box([2, 1, 1]).move([1.5, 0, 0]);", 12, 1, 0, 3.5},
        {"show box([2, 1, 1]) - box([1, 1, 0.5]).move([0.5, 0, 0.25]);", 20, 1, 0, 1.5},
        {"show difference(box([16, 2, 16]), [box([0.7, 3, 0.7]).rotate([0, 1, 0], 0.3 * i)"
         ".move([i - 15 * floor(i / 15) - 7, 0, floor(i / 15) - 7]) for i in 0..225]);",
         12 + 20 * 225, 1, 225, 512 - 225 * 0.98},
        {"show pyramid(10, 0.0001);", 6, 1, 0, 1. / 300},
        {"def at(i) = (if i % 2 == 0 then 10 else 7) * [cos(i * 1.8deg), sin(i * 1.8deg)];"
         "show polygon([at(i) for i in 0..200]).extrude(1);",
         796, 1, 0, 100 * 70 * 0.0314107590781283},
        /* A face with thousands of corners, and lines that end at two planes within rounding. */
        {"show difference(box([200, 3, 200]), [prism(6, 2.6, 10)"
         ".move([5 * i + 2.5 * (j % 2) - 97, 0, 4.33 * j - 97]) for i in 0..38 for j in 0..45]);",
         12 + 28 * 1710, 1, 1710, 120000 - 1710 * 52.68898556624525},
        /* Columns of corners are in one line.  Without holes a solid of n corners has 2 n - 4 triangles. */
        {"show union([box([128, 9.6, 128]) - box([125, 9.6, 125]).move([0, -1.5, 0]), "
         "[prism(8, 2.4, 1.8).move([8 * i - 60, 5.7, 8 * j - 60]) for i in 0..16 for j in "
         "0..16]]);",
         2 * (16 + 256 * 16) - 4, 1, 0,
         128 * 9.6 * 128 - 125 * 8.1 * 125 + 256 * 2.8284271247461903 * 2.4 * 2.4 * 1.8},
    };
    (void)state;
    for (size_t i = 0; i < sizeof solids / sizeof *solids; i++) {
        KrsMesh  *mesh  = mesh_of_text(solids[i].text, false);
        MeshShape shape = mesh_shape(mesh);
        print_message("# %zu triangles, volume %.9f: %s\n", mesh->triangle_count, shape.volume,
                      solids[i].text);
        assert_int_equal(mesh->triangle_count, solids[i].triangles);
        assert_int_equal(shape.parts, solids[i].parts);
        assert_int_equal(shape.euler, 2 * (solids[i].parts - solids[i].genus));
        assert_true(fabs(shape.volume / solids[i].volume - 1) < 1e-6);
        krs_mesh_free(mesh);
    }
}

static void other_meshes_stay_even(void **state)
{
    const char *plain = "show box([1, 1, 1]);";
    KrsMesh    *even = mesh_of_text(plain, true), *few = mesh_of_text(plain, false);
    /* Colours are those of vertices, so a face of many colours needs many. */
    KrsMesh *many = mesh_of_text("show box([1, 1, 1]).paint([x + 0.5, 0.5, 0.5]);", false);
    (void)state;
    assert_true(few->triangle_count == 12);
    assert_true(even->triangle_count > 1000 && many->triangle_count == even->triangle_count);
    krs_mesh_free(even);
    krs_mesh_free(few);
    krs_mesh_free(many);
}

/* ---- random solids ---- */

enum { MAX_SIDES = 9, MAX_PARTS_HERE = 6 };

typedef enum Kind { A_BOX, A_PRISM, A_POLYGON, KINDS } Kind;

typedef struct Part {
    Kind   kind;
    double size[3], axis[3], angle, shift[3];
    int    sides;
    double corners[MAX_SIDES][2];
    char   joined; /* to what is before it */
} Part;

static Part random_part(Random *random, double spread)
{
    Part part    = {.kind   = (Kind)(random_below(random, KINDS)),
                    .joined = "|-&|-"[random_below(random, 5)]};
    Vec  axis    = random_unit(random);
    part.axis[0] = axis.x, part.axis[1] = axis.y, part.axis[2] = axis.z;
    part.angle = random_between(random, 0, 2 * PI);
    part.sides = 3 + random_below(random, MAX_SIDES - 2);
    for (int k = 0; k < 3; k++) {
        part.size[k]  = random_between(random, 0.3, 1.5);
        part.shift[k] = random_between(random, -spread, spread);
    }
    for (int i = 0; i < part.sides; i++) {
        double angle       = 2 * PI * (i + random_between(random, -0.3, 0.3)) / part.sides;
        double reach       = random_between(random, 0.2, 1);
        part.corners[i][0] = reach * cos(angle);
        part.corners[i][1] = reach * sin(angle);
    }
    return part;
}

static void write_part(SceneText *text, const Part *part)
{
    if (part->kind == A_BOX)
        scene_write(text, "box([%.17g, %.17g, %.17g])", part->size[0], part->size[1],
                    part->size[2]);
    else if (part->kind == A_PRISM)
        scene_write(text, "prism(%d, %.17g, %.17g)", part->sides, part->size[0], part->size[1]);
    else {
        scene_write(text, "polygon([");
        for (int i = 0; i < part->sides; i++)
            scene_write(text, "%s[%.17g, %.17g]", i ? ", " : "", part->corners[i][0],
                        part->corners[i][1]);
        scene_write(text, "]).extrude(%.17g)", part->size[0]);
    }
    scene_write(text, ".rotate([%.17g, %.17g, %.17g], %.17g).move([%.17g, %.17g, %.17g])",
                part->axis[0], part->axis[1], part->axis[2], part->angle, part->shift[0],
                part->shift[1], part->shift[2]);
}

/* Rodrigues' formula, backwards. */
static void turn_back(const Part *part, const double point[3], double local[3])
{
    double at[3], along = 0, c = cos(part->angle), s = -sin(part->angle);
    for (int k = 0; k < 3; k++) {
        at[k] = point[k] - part->shift[k];
        along += at[k] * part->axis[k];
    }
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        local[k] = c * at[k] + s * (part->axis[i] * at[j] - part->axis[j] * at[i]) +
                   (1 - c) * along * part->axis[k];
    }
}

static bool is_in_part(const Part *part, const double point[3])
{
    double q[3];
    turn_back(part, point, q);
    if (part->kind == A_BOX)
        return fabs(q[0]) < part->size[0] / 2 && fabs(q[1]) < part->size[1] / 2 &&
               fabs(q[2]) < part->size[2] / 2;
    if (part->kind == A_PRISM) {
        for (int i = 0; i < part->sides; i++) { /* a corner is on the z axis */
            double angle = (2 * i + 1) * PI / part->sides;
            if (q[0] * sin(angle) + q[2] * cos(angle) >= part->size[0] * cos(PI / part->sides))
                return false;
        }
        return fabs(q[1]) < part->size[1] / 2;
    }
    double around = 0;
    for (int i = 0; i < part->sides; i++) {
        const double *a = part->corners[i], *b = part->corners[(i + 1) % part->sides];
        around += atan2((a[0] - q[0]) * (b[1] - q[1]) - (a[1] - q[1]) * (b[0] - q[0]),
                        (a[0] - q[0]) * (b[0] - q[0]) + (a[1] - q[1]) * (b[1] - q[1]));
    }
    return fabs(around) > PI && fabs(q[2]) < part->size[0] / 2;
}

static bool is_in_solid(const Part *parts, size_t count, const double point[3])
{
    bool inside = is_in_part(&parts[0], point);
    for (size_t i = 1; i < count; i++) {
        bool in = is_in_part(&parts[i], point);
        inside  = parts[i].joined == '|'   ? inside || in
                  : parts[i].joined == '&' ? inside && in
                                           : inside && !in;
    }
    return inside;
}

/* Tells whether all points so near have the same answer. */
static bool is_clear(const Part *parts, size_t count, const double point[3])
{
    bool inside = is_in_solid(parts, count, point);
    for (int i = 0; i < 8; i++) {
        double beside[3];
        for (int k = 0; k < 3; k++)
            beside[k] = point[k] + ((i >> k) & 1 ? 1e-4 : -1e-4);
        if (is_in_solid(parts, count, beside) != inside)
            return false;
    }
    return true;
}

/* Returns the solid angle of a triangle, by van Oosterom and Strackee, 1983. */
static double solid_angle(const KrsMesh *mesh, size_t triangle, const double point[3])
{
    double v[3][3], length[3];
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++)
            v[i][k] = mesh->vertices[mesh->triangles[triangle][i]][k] - point[k];
        length[i] = sqrt(v[i][0] * v[i][0] + v[i][1] * v[i][1] + v[i][2] * v[i][2]);
    }
    double volume = v[0][0] * (v[1][1] * v[2][2] - v[1][2] * v[2][1]) +
                    v[0][1] * (v[1][2] * v[2][0] - v[1][0] * v[2][2]) +
                    v[0][2] * (v[1][0] * v[2][1] - v[1][1] * v[2][0]);
    double below = length[0] * length[1] * length[2];
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3;
        below += (v[i][0] * v[j][0] + v[i][1] * v[j][1] + v[i][2] * v[j][2]) * length[(i + 2) % 3];
    }
    return 2 * atan2(volume, below);
}

static double times_around(const KrsMesh *mesh, const double point[3])
{
    double sum = 0;
    for (size_t i = 0; i < mesh->triangle_count; i++)
        sum += solid_angle(mesh, i, point);
    return sum / (4 * PI);
}

static void random_solids_are_what_their_parts_say(void **state)
{
    static SceneText text;
    size_t           most = 0, points = 0, inside = 0, even = 0;
    (void)state;
    for (uint64_t turn = 0; turn < 80; turn++) {
        Random random = {4000 + turn};
        Part   parts[MAX_PARTS_HERE];
        size_t count = 1 + (size_t)random_below(&random, MAX_PARTS_HERE);
        for (size_t i = 0; i < count; i++)
            parts[i] = random_part(&random, 0.8);
        text.length = 0;
        scene_write(&text, "show ");
        for (size_t i = 1; i < count; i++)
            scene_write(&text, "(");
        for (size_t i = 0; i < count; i++) {
            if (i > 0)
                scene_write(&text, " %c ", parts[i].joined);
            write_part(&text, &parts[i]);
            if (i > 0)
                scene_write(&text, ")");
        }
        scene_write(&text, ";");
        KrsMesh *mesh = mesh_of_text(text.bytes, false);
        most          = mesh->triangle_count > most ? mesh->triangle_count : most;
        even += mesh->triangle_count > 1000;
        for (int i = 0; i < 150; i++) {
            double point[3];
            for (int k = 0; k < 3; k++)
                point[k] = random_between(&random, -1, 1);
            if (!is_clear(parts, count, point))
                continue;
            bool in = is_in_solid(parts, count, point);
            if (fabs(times_around(mesh, point) - in) > 1e-4)
                fail_msg("%.9g %.9g %.9g is %s of %s", point[0], point[1], point[2],
                         in ? "inside" : "outside", text.bytes);
            points++;
            inside += in;
        }
        krs_mesh_free(mesh);
    }
    print_message(
        "# %zu points, %zu inside; at most %zu triangles; %zu solids by the even mesher\n", points,
        inside, most, even);
    assert_true(points > 8000 && inside > 500);
    assert_int_equal(even, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(solids_have_no_more_triangles_than_their_faces_need),
        cmocka_unit_test(other_meshes_stay_even),
        cmocka_unit_test(random_solids_are_what_their_parts_say),
    };
    product_wants_outlines();
    return cmocka_run_group_tests_name("flat_meshes", tests, NULL, NULL);
}
