/*
 * csg_solids.cpp: random solids by `krs mesh`, beside the same ones by CGAL's exact set operations.
 *
 *     csg_solids KRS COUNT [FIRST [FOLDER]]    so many solids from this number on; faults leave scenes in the folder
 *
 * Solids are trees of set operations on boxes, cylinders, cones, balls, rings, prisms and polygons.  CGAL gets polyhedra that are
 * finer than the error.  Most solids are in general position, and are cut by corefinement.  Of each four one is level: its
 * sizes and places are multiples of an eighth, so faces lie in one plane, edges touch, and columns touch faces.  These are
 * Nef polyhedra of few facets.  What touches along an edge or in a point is apart, as `krs mesh` has it.
 *
 * Components, the Euler number, the volume and distances both ways are compared.  Where the meshes differ, or krs
 * reports a place, the solid is built twice more, with parts that are grown and shrunk so that it is thicker and
 * thinner by three errors.  If these are alike, then nothing of it is too small for the error.
 * Status 1: a mesh is wrong that should be right, or is wrong without a word.
 */
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include <signal.h>
#include <sys/wait.h>

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Nef_polyhedron_3.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/triangulate_faces.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/convert_nef_polyhedron_to_polygon_mesh.h>

namespace process = CGAL::Polygon_mesh_processing;
using Kernel      = CGAL::Exact_predicates_exact_constructions_kernel;
using Mesh        = CGAL::Surface_mesh<Kernel::Point_3>;
using Nef         = CGAL::Nef_polyhedron_3<Kernel>;
using Vec         = std::array<double, 3>;

static const int SECONDS = 20; /* of the processor, for each mesh */

/* ---- vectors ---- */

static Vec operator+(const Vec &a, const Vec &b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
static Vec operator-(const Vec &a, const Vec &b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
static Vec operator*(double s, const Vec &a) { return {s * a[0], s * a[1], s * a[2]}; }
static double dot(const Vec &a, const Vec &b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
static Vec    cross(const Vec &a, const Vec &b)
{
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/* About an axis of length 1, by Rodrigues' formula; quarter turns are exact. */
struct Turn {
    Vec    axis  = {0, 1, 0};
    double angle = 0, c = 1, s = 0;
    Vec    operator()(const Vec &p) const
    {
        return c * p + s * cross(axis, p) + (1 - c) * dot(axis, p) * axis;
    }
};

/* ---- random numbers ---- */

/* SplitMix64, by Steele, Lea and Flood, 2014. */
struct Random {
    uint64_t state;
    uint64_t next()
    {
        uint64_t z = state += 0x9e3779b97f4a7c15;
        z          = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
        z          = (z ^ (z >> 27)) * 0x94d049bb133111eb;
        return z ^ (z >> 31);
    }
    int    below(int n) { return int(next() % uint64_t(n)); }
    double between(double low, double high)
    {
        return low + (high - low) * double(next() >> 11) * 0x1p-53;
    }
    Vec unit()
    {
        for (;;) {
            Vec    v      = {between(-1, 1), between(-1, 1), between(-1, 1)};
            double length = std::sqrt(dot(v, v));
            if (length > 0.1 && length < 1)
                return 1 / length * v;
        }
    }
    Turn turn()
    {
        Turn turn = {unit(), between(0, 2 * M_PI)};
        turn.c    = std::cos(turn.angle);
        turn.s    = std::sin(turn.angle);
        return turn;
    }
    Turn quarter_turn()
    {
        static const double sines[4] = {0, 1, 0, -1};
        Turn                turn;
        int                 n = below(4);
        turn.axis             = {0, 0, 0};
        turn.axis[below(3)]   = 1;
        turn.angle            = n * M_PI / 2;
        turn.s                = sines[n];
        turn.c                = sines[(n + 1) % 4];
        return turn;
    }
};

/* ---- parts ---- */

enum Kind { BOX, CYLINDER, PRISM, POLYGON, BALL, CONE, FRUSTUM, RING, KINDS };

struct Part {
    Kind                               kind;
    double                             size[3] = {0, 0, 0};
    std::vector<std::array<double, 2>> corners; /* of polygons, counter-clockwise */
    Turn                               turn;
    Vec                                shift;
};

struct Tree {
    Part                  part;      /* of a leaf */
    char                  joint = 0; /* of others: | - & */
    std::unique_ptr<Tree> left, right;
};

struct Solid {
    std::unique_ptr<Tree> tree;
    double                error;
    bool                  level;
    Turn                  turn; /* of the whole, for krs alone */
};

/* A star around the origin, or a triangle that is a knife. */
static void random_polygon(Random &random, Part &part)
{
    if (random.below(3) == 0) {
        double length = random.between(0.6, 1.2);
        double half   = length * std::tan(random.between(5, 40) * M_PI / 360);
        part.corners  = {{-0.5 * length, 0}, {0.5 * length, -half}, {0.5 * length, half}};
        return;
    }
    int n = 3 + random.below(6);
    for (int i = 0; i < n; i++) {
        double r     = random.between(0.35, 0.9),
               angle = (i + random.between(-0.2, 0.2)) * 2 * M_PI / n;
        part.corners.push_back({r * std::cos(angle), r * std::sin(angle)});
    }
}

static Part random_part(Random &random)
{
    Part part;
    part.kind  = Kind(random.below(KINDS));
    part.turn  = random.below(3) ? random.turn() : random.quarter_turn();
    part.shift = random.between(0, 0.8) * random.unit();
    for (double &size : part.size)
        size = random.between(0.4, 1.2);
    switch (part.kind) {
    case PRISM: part.size[2] = 3 + random.below(6); break;
    case POLYGON: random_polygon(random, part); break;
    case BALL:
    case CYLINDER: part.size[0] *= 0.7; break;
    case FRUSTUM: part.size[1] *= 0.6; break;
    case RING: part.size[1] *= 0.3; break;
    default: break;
    }
    return part;
}

/* Of eighths; triangles have right angles. */
static Part level_part(Random &random)
{
    static const Kind kinds[] = {BOX, BOX, BOX, CYLINDER, CYLINDER, POLYGON};
    Part              part;
    part.kind = kinds[random.below(6)];
    part.turn = random.quarter_turn();
    for (double &size : part.size)
        size = 0.25 * (1 + random.below(4));
    for (double &shift : part.shift)
        shift = 0.125 * (random.below(9) - 4);
    if (part.kind == CYLINDER)
        part.size[0] = 0.125 * (1 + random.below(4));
    if (part.kind == POLYGON) {
        double a     = 0.25 * (1 + random.below(4));
        part.corners = {{0, 0}, {a, 0}, {0, a}};
        part.size[0] = part.size[1];
    }
    return part;
}

static std::unique_ptr<Tree> random_tree(Random &random, int parts, bool level)
{
    auto tree = std::make_unique<Tree>();
    if (parts == 1) {
        tree->part = level ? level_part(random) : random_part(random);
        return tree;
    }
    int right   = random.below(3) ? 1 : 1 + random.below(parts - 1);
    tree->joint = "||--&"[random.below(5)];
    tree->left  = random_tree(random, parts - right, level);
    tree->right = random_tree(random, right, level);
    return tree;
}

static Solid random_solid(uint64_t number)
{
    Random random = {1000003 * number + 17};
    Solid  solid;
    solid.level = number % 4 == 3;
    /* Of solids that are about two long: from 1/20 to 1/1000, the finest ones seldom. */
    solid.error = 2 /
                  std::exp(random.between(std::log(20), std::log(random.below(8) ? 200 : 1000)));
    solid.turn = random.below(2) ? random.turn() : random.quarter_turn();
    solid.tree = random_tree(random, 2 + random.below(5), solid.level);
    return solid;
}

/* ---- as text ---- */

static void write_turn(std::string &text, const Turn &turn)
{
    char      words[256];
    const int quarter = int(std::lround(turn.angle / (M_PI / 2)));
    if (turn.angle == 0)
        return;
    if (turn.angle == quarter * M_PI / 2)
        std::snprintf(words, sizeof words, ".rotate([%g, %g, %g], %ddeg)", turn.axis[0],
                      turn.axis[1], turn.axis[2], 90 * quarter);
    else
        std::snprintf(words, sizeof words, ".rotate([%.17g, %.17g, %.17g], %.17g)", turn.axis[0],
                      turn.axis[1], turn.axis[2], turn.angle);
    text += words;
}

static void write_part(std::string &text, const Part &part)
{
    static const char *const forms[KINDS] = {"box([%.17g, %.17g, %.17g])",
                                             "cylinder(%.17g, %.17g)",
                                             nullptr,
                                             nullptr,
                                             "sphere(%.17g)",
                                             "cone(%.17g, %.17g)",
                                             "capped_cone(%.17g, %.17g, %.17g)",
                                             "torus(%.17g, %.17g)"};
    char                     words[256];
    if (part.kind == PRISM) {
        std::snprintf(words, sizeof words, "prism(%d, %.17g, %.17g)", int(part.size[2]),
                      part.size[0], part.size[1]);
        text += words;
    } else if (part.kind == POLYGON) {
        const char *between = "polygon([";
        for (const auto &corner : part.corners) {
            std::snprintf(words, sizeof words, "%s[%.17g, %.17g]", between, corner[0], corner[1]);
            text += words;
            between = ", ";
        }
        std::snprintf(words, sizeof words, "]).extrude(%.17g)", part.size[0]);
        text += words;
    } else {
        std::snprintf(words, sizeof words, forms[part.kind], part.size[0], part.size[1],
                      part.size[2]);
        text += words;
    }
    write_turn(text, part.turn);
    std::snprintf(words, sizeof words, ".move([%.17g, %.17g, %.17g])", part.shift[0], part.shift[1],
                  part.shift[2]);
    text += words;
}

static void write_tree(std::string &text, const Tree &tree)
{
    if (!tree.joint) {
        write_part(text, tree.part);
        return;
    }
    text += "(";
    write_tree(text, *tree.left);
    text += std::string(" ") + tree.joint + " ";
    write_tree(text, *tree.right);
    text += ")";
}

static std::string text_of(const Solid &solid)
{
    std::string text = "show ";
    write_tree(text, *solid.tree);
    write_turn(text, solid.turn);
    return text + ";\n";
}

/* ---- as polyhedra ---- */

/* Vertices, and faces that look outwards; faces of more than three corners are flat but for rounding. */
struct Polyhedron {
    std::vector<Vec>                      vertices;
    std::vector<std::vector<std::size_t>> faces;
};

using Outline = std::vector<std::array<double, 2>>;

/* Over a polygon of the x-y plane, counter-clockwise, along z. */
static Polyhedron column(const Outline &outline, double height)
{
    Polyhedron  solid;
    std::size_t n = outline.size();
    solid.faces.resize(2);
    for (double z : {-height / 2, height / 2})
        for (const auto &corner : outline)
            solid.vertices.push_back({corner[0], corner[1], z});
    for (std::size_t i = 0; i < n; i++) {
        solid.faces[0].push_back(n - 1 - i);
        solid.faces[1].push_back(n + i);
        solid.faces.push_back({i, (i + 1) % n, n + (i + 1) % n, n + i});
    }
    return solid;
}

/* From (x, y, z) to (y, z, x): what was along z is along y, and begins towards z. */
static Polyhedron upright(Polyhedron solid)
{
    for (Vec &v : solid.vertices)
        v = {v[1], v[2], v[0]};
    return solid;
}

static double on_circle(int i, int sides) /* the cosine, the same for what is symmetrical */
{
    i = (i % sides + sides) % sides;
    if (2 * i > sides)
        i = sides - i;
    if (4 * i == sides)
        return 0;
    return 4 * i > sides ? -std::cos((sides - 2 * i) * M_PI / sides)
                         : std::cos(2 * i * M_PI / sides);
}

static Outline circle(double radius, int sides)
{
    Outline outline;
    for (int i = 0; i < sides; i++)
        outline.push_back(
            {radius * on_circle(i, sides), radius * (sides % 4 ? std::sin(2 * i * M_PI / sides)
                                                               : on_circle(i - sides / 4, sides))});
    return outline;
}

/* Around the y axis: radii and heights from below to above.  Where a radius is 0, there is one vertex; a profile that is closed
   is a ring, and goes around it with the solid to its left. */
static Polyhedron lathe(const Outline &profile, int sides, bool closed)
{
    Polyhedron               solid;
    std::vector<std::size_t> begin;
    std::size_t              around = std::size_t(sides);
    const Outline            unit   = circle(1, sides);
    for (const auto &at : profile) {
        begin.push_back(solid.vertices.size());
        for (std::size_t i = 0; i < (at[0] > 0 ? around : 1); i++)
            solid.vertices.push_back({at[0] * unit[i][1], at[1], at[0] * unit[i][0]});
    }
    for (std::size_t k = 0; k < profile.size() - (closed ? 0 : 1); k++) {
        std::size_t next = (k + 1) % profile.size();
        for (std::size_t i = 0; i < around; i++) {
            std::size_t              j     = (i + 1) % around;
            bool                     below = profile[k][0] > 0, above = profile[next][0] > 0;
            std::vector<std::size_t> face = {begin[k] + (below ? i : 0)};
            if (below)
                face.push_back(begin[k] + j);
            face.push_back(begin[next] + (above ? j : 0));
            if (above)
                face.push_back(begin[next] + i);
            solid.faces.push_back(face);
        }
    }
    return solid;
}

/* Each side is moved outwards by so much; corners are where they meet. */
static Outline grown_outline(const Outline &outline, double by)
{
    Outline     grown;
    std::size_t n = outline.size();
    for (std::size_t i = 0; i < n; i++) {
        const auto &a = outline[(i + n - 1) % n], &b = outline[i], &c = outline[(i + 1) % n];
        double      u[2] = {b[0] - a[0], b[1] - a[1]}, v[2] = {c[0] - b[0], c[1] - b[1]};
        double      lu = std::hypot(u[0], u[1]), lv = std::hypot(v[0], v[1]);
        double      m[2]  = {u[1] / lu + v[1] / lv, -u[0] / lu - v[0] / lv};
        double      along = 2 / (m[0] * m[0] + m[1] * m[1]);
        grown.push_back({b[0] + by * along * m[0], b[1] + by * along * m[1]});
    }
    return grown;
}

static Outline arc_of_ball(double radius, int bands)
{
    Outline profile;
    for (int i = 0; i <= bands; i++)
        profile.push_back({i == 0 || i == bands ? 0 : radius * std::sin(i * M_PI / bands),
                           -radius * on_circle(i, 2 * bands)});
    return profile;
}

/* The line from the first to the second point is moved by `by` to its right, which is outwards. */
static Polyhedron cone(double below, double above, double height, double by, int sides)
{
    double slant = std::hypot(height, below - above), low = -height / 2 - by,
           high    = height / 2 + by;
    auto radius_at = [&](double y) {
        return below + (y + height / 2) * (above - below) / height + by * slant / height;
    };
    if (above == 0 && by != 0) /* the tip is farther away */
        high = height / 2 + by * slant / below;
    if (radius_at(high) <= 1e-9)
        high = low + radius_at(low) * height / (below - above);
    double top = above == 0 ? 0 : std::fmax(radius_at(high), 0);
    return lathe(top > 0 ? Outline{{0, low}, {radius_at(low), low}, {top, high}, {0, high}}
                         : Outline{{0, low}, {radius_at(low), low}, {0, high}},
                 sides, false);
}

/* Nothing is left of what is shrunk by more than its size. */
static Polyhedron polyhedron_of(const Part &part, double by, int sides)
{
    const double *size = part.size;
    double        x = size[0], y = size[1];
    switch (part.kind) {
    case BOX: {
        double h[3];
        for (int k = 0; k < 3; k++)
            h[k] = size[k] / 2 + by;
        if (h[0] <= 0 || h[1] <= 0 || h[2] <= 0)
            return {};
        return column({{-h[0], -h[1]}, {h[0], -h[1]}, {h[0], h[1]}, {-h[0], h[1]}}, 2 * h[2]);
    }
    case CYLINDER:
        return x + by <= 0 || y + 2 * by <= 0 ? Polyhedron{}
                                              : upright(column(circle(x + by, sides), y + 2 * by));
    case PRISM: {
        int    n = int(size[2]);
        double r = x + by / std::cos(M_PI / n);
        return r <= 0 || y + 2 * by <= 0 ? Polyhedron{} : upright(column(circle(r, n), y + 2 * by));
    }
    case POLYGON:
        return x + 2 * by <= 0 ? Polyhedron{} : column(grown_outline(part.corners, by), x + 2 * by);
    case BALL:
        return x + by <= 0 ? Polyhedron{} : lathe(arc_of_ball(x + by, sides / 2), sides, false);
    case CONE: return cone(x, 0, y, by, sides);
    case FRUSTUM: return cone(x, y, size[2], by, sides);
    default: {
        Outline profile;
        for (const auto &at : circle(y + by, sides / 2))
            profile.push_back({x + at[0], at[1]});
        return y + by <= 0 ? Polyhedron{} : lathe(profile, sides, true);
    }
    }
}

static Polyhedron placed(const Part &part, double by, int sides)
{
    Polyhedron solid = polyhedron_of(part, by, sides);
    for (Vec &v : solid.vertices)
        v = part.turn(v) + part.shift;
    return solid;
}

/* The farthest that a part is from its facets. */
static double sag_of(const Tree &tree, int sides)
{
    if (tree.joint)
        return std::fmax(sag_of(*tree.left, sides), sag_of(*tree.right, sides));
    const Part &part = tree.part;
    double      sag  = 1 - std::cos(M_PI / sides);
    switch (part.kind) {
    case CYLINDER:
    case CONE: return part.size[0] * sag;
    case FRUSTUM: return std::fmax(part.size[0], part.size[1]) * sag;
    case BALL: return 2 * part.size[0] * sag;
    case RING:
        return (part.size[0] + part.size[1]) * sag +
               part.size[1] * (1 - std::cos(2 * M_PI / sides));
    default: return 0;
    }
}

/* ---- set operations ---- */

static Mesh mesh_of(const Polyhedron &solid)
{
    Mesh                            mesh;
    std::vector<Mesh::Vertex_index> at;
    for (const Vec &v : solid.vertices)
        at.push_back(mesh.add_vertex({v[0], v[1], v[2]}));
    for (const auto &face : solid.faces) {
        std::vector<Mesh::Vertex_index> corners;
        for (std::size_t i : face)
            corners.push_back(at[i]);
        if (mesh.add_face(corners) == Mesh::null_face())
            throw std::runtime_error("a face does not fit");
    }
    process::triangulate_faces(mesh);
    return mesh;
}

static Mesh joined(const Tree &tree, double by, int sides)
{
    if (!tree.joint)
        return mesh_of(placed(tree.part, by, sides));
    Mesh a = joined(*tree.left, by, sides),
         b = joined(*tree.right, tree.joint == '-' ? -by : by, sides);
    if (a.is_empty() || b.is_empty())
        return tree.joint == '|' ? (a.is_empty() ? b : a) : tree.joint == '-' ? a : Mesh();
    Mesh result;
    bool done = tree.joint == '|'   ? process::corefine_and_compute_union(a, b, result)
                : tree.joint == '-' ? process::corefine_and_compute_difference(a, b, result)
                                    : process::corefine_and_compute_intersection(a, b, result);
    if (!done)
        throw std::runtime_error("not a manifold");
    result.collect_garbage();
    return result;
}

static Nef nef_of(const Polyhedron &solid)
{
    if (solid.faces.empty())
        return Nef(Nef::EMPTY);
    Mesh mesh = mesh_of(solid);
    return Nef(mesh);
}

static Nef joined_nef(const Tree &tree, double by, int sides)
{
    if (!tree.joint)
        return nef_of(placed(tree.part, by, sides));
    Nef a      = joined_nef(*tree.left, by, sides),
        b      = joined_nef(*tree.right, tree.joint == '-' ? -by : by, sides);
    Nef result = tree.joint == '|' ? a + b : tree.joint == '-' ? a - b : a * b;
    return result.regularization();
}

/* ---- what is known of triangles ---- */

struct Triangles {
    std::vector<Vec>                        vertices;
    std::vector<std::array<std::size_t, 3>> faces;
};

struct Shape {
    bool   closed = true;
    long   shells = 0, euler = 0;
    double volume = 0;
    bool   same(const Shape &other) const { return shells == other.shells && euler == other.euler; }
};

static std::size_t leader(std::vector<std::size_t> &leaders, std::size_t i)
{
    while (leaders[i] != i)
        i = leaders[i] = leaders[leaders[i]];
    return i;
}

/* At an edge each triangle continues in the one behind which the same solid lies: so what touches is apart. */
static Shape shape_of(const Triangles &mesh)
{
    struct Side {
        double      angle;
        bool        forward;
        std::size_t face, from; /* the corner that it goes away from */
    };
    std::size_t                                                      n = mesh.faces.size();
    std::map<std::pair<std::size_t, std::size_t>, std::vector<Side>> edges;
    std::vector<std::size_t>                                         corners(3 * n), shells(n);
    Shape                                                            shape;
    std::iota(corners.begin(), corners.end(), 0);
    std::iota(shells.begin(), shells.end(), 0);
    for (std::size_t f = 0; f < n; f++) {
        const auto &t = mesh.faces[f];
        shape.volume += dot(mesh.vertices[t[0]], cross(mesh.vertices[t[1]], mesh.vertices[t[2]])) /
                        6;
        for (std::size_t k = 0; k < 3; k++) {
            std::size_t a = t[k], b = t[(k + 1) % 3];
            edges[std::minmax(a, b)].push_back({0, a < b, f, k});
        }
    }
    for (auto &edge : edges) {
        std::vector<Side> &sides = edge.second;
        if (sides.size() > 2) {
            Vec from                             = mesh.vertices[edge.first.first],
                axis                             = mesh.vertices[edge.first.second] - from;
            axis                                 = 1 / std::sqrt(dot(axis, axis)) * axis;
            Vec x0                               = {0, 0, 0};
            x0[std::fabs(axis[0]) < 0.6 ? 0 : 1] = 1;
            Vec x = cross(axis, x0), y = cross(axis, x);
            for (Side &side : sides) {
                Vec to     = mesh.vertices[mesh.faces[side.face][(side.from + 2) % 3]] - from;
                side.angle = std::atan2(dot(to, y), dot(to, x));
            }
            std::sort(sides.begin(), sides.end(),
                      [](const Side &a, const Side &b) { return a.angle < b.angle; });
        }
        /* Backward triangles begin a wedge of the solid, and forward ones end it. */
        std::size_t count = sides.size();
        for (std::size_t i = 0; i < count; i++) {
            const Side &a = sides[i], &b = sides[(i + 1) % count];
            if (a.forward == b.forward)
                shape.closed = false;
            if (a.forward || a.forward == b.forward)
                continue;
            corners[leader(corners, 3 * a.face + a.from)]           = leader(corners,
                                                                             3 * b.face + (b.from + 1) % 3);
            corners[leader(corners, 3 * a.face + (a.from + 1) % 3)] = leader(corners,
                                                                             3 * b.face + b.from);
            shells[leader(shells, a.face)]                          = leader(shells, b.face);
        }
    }
    for (std::size_t i = 0; i < 3 * n; i++)
        shape.euler += leader(corners, i) == i;
    shape.euler -= long(n) / 2;
    for (std::size_t f = 0; f < n; f++)
        shape.shells += leader(shells, f) == f;
    return shape;
}

static Vec vec_of(const Kernel::Point_3 &p)
{
    return {CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z())};
}

static Triangles triangles_of(const Mesh &mesh)
{
    Triangles result;
    for (auto v : mesh.vertices())
        result.vertices.push_back(vec_of(mesh.point(v)));
    for (auto f : mesh.faces()) {
        std::array<std::size_t, 3> t;
        auto                       h = mesh.halfedge(f);
        for (std::size_t &corner : t) {
            corner = mesh.target(h);
            h      = mesh.next(h);
        }
        result.faces.push_back(t);
    }
    return result;
}

static Triangles triangles_of(Nef nef)
{
    std::vector<Kernel::Point_3>          points;
    std::vector<std::vector<std::size_t>> faces;
    Triangles                             result;
    CGAL::convert_nef_polyhedron_to_polygon_soup(nef, points, faces, true);
    for (const auto &p : points)
        result.vertices.push_back(vec_of(p));
    for (const auto &f : faces)
        result.faces.push_back({f[0], f[1], f[2]});
    return result;
}

static Triangles truth_of(const Solid &solid, double by, int sides)
{
    if (solid.level)
        return triangles_of(joined_nef(*solid.tree, by, sides));
    return triangles_of(joined(*solid.tree, by, sides));
}

/* ---- distances ---- */

using Plain     = CGAL::Simple_cartesian<double>;
using Iterator  = std::vector<Plain::Triangle_3>::const_iterator;
using Primitive = CGAL::AABB_triangle_primitive<Plain, Iterator>;
using Nearest   = CGAL::AABB_tree<CGAL::AABB_traits<Plain, Primitive>>;

static Plain::Point_3 plain(const Vec &v) { return {v[0], v[1], v[2]}; }

/* The farthest that points of the first are from the second. */
static double farthest(const Triangles &from, const Triangles &to)
{
    const std::size_t              MOST = 1500;
    std::vector<Plain::Triangle_3> list;
    double                         most = 0;
    for (const auto &t : to.faces)
        list.emplace_back(plain(to.vertices[t[0]]), plain(to.vertices[t[1]]),
                          plain(to.vertices[t[2]]));
    Nearest     tree(list.begin(), list.end());
    std::size_t step = from.faces.size() / MOST + 1;
    tree.accelerate_distance_queries();
    for (std::size_t f = 0; f < from.faces.size(); f += step) {
        const auto &t = from.faces[f];
        const Vec  &a = from.vertices[t[0]], &b = from.vertices[t[1]], &c = from.vertices[t[2]];
        for (const Vec &p : {a, 0.5 * (a + b), 1.0 / 3 * (a + b + c)})
            most = std::fmax(most, std::sqrt(tree.squared_distance(plain(p))));
    }
    return most;
}

/* ---- the command ---- */

struct Answer {
    int         status = 0;
    bool        slow   = false;
    std::string said; /* the first warning */
    Triangles   mesh;
};

static Triangles read_obj(const std::string &path)
{
    Triangles mesh;
    char      line[512];
    FILE     *file = std::fopen(path.c_str(), "r");
    while (file && std::fgets(line, sizeof line, file)) {
        Vec                        v;
        std::array<std::size_t, 3> t;
        if (std::sscanf(line, "v %lf %lf %lf", &v[0], &v[1], &v[2]) == 3)
            mesh.vertices.push_back(v);
        else if (std::sscanf(line, "f %zu%*[^ ] %zu%*[^ ] %zu", &t[0], &t[1], &t[2]) == 3 ||
                 std::sscanf(line, "f %zu %zu %zu", &t[0], &t[1], &t[2]) == 3)
            mesh.faces.push_back({t[0] - 1, t[1] - 1, t[2] - 1});
    }
    if (file)
        std::fclose(file);
    return mesh;
}

static Answer answer_of(const std::string &krs, const std::string &folder, const std::string &scene,
                        double error)
{
    char        command[1024], line[1024];
    std::string obj = folder + "/mesh.obj";
    Answer      answer;
    std::remove(obj.c_str());
    std::snprintf(command, sizeof command,
                  "ulimit -t %d; exec '%s' mesh '%s' --error %.17g -o '%s' 2>&1", SECONDS,
                  krs.c_str(), scene.c_str(), error, obj.c_str());
    FILE *pipe = popen(command, "r");
    if (!pipe)
        throw std::runtime_error("no pipe");
    while (std::fgets(line, sizeof line, pipe))
        if (answer.said.empty() && (std::strstr(line, "warning") || std::strstr(line, "error:")))
            answer.said = std::string(line, std::strcspn(line, "\n"));
    int status    = pclose(pipe);
    answer.status = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    answer.slow   = answer.status == -SIGKILL || answer.status == -SIGXCPU;
    if (answer.status == 0)
        answer.mesh = read_obj(obj);
    return answer;
}

/* ---- all of it ---- */

enum Verdict {
    AGREE,
    SMALL,
    REFUSED,
    SLOW,
    FALSE_REPORT,
    WRONG,
    SILENT,
    FAR,
    CRASHED,
    NOTHING,
    VERDICTS
};
static const char *const names[VERDICTS] = {
    "agree",
    "differ where something is smaller than three errors, and say so",
    "refused",
    "not done in time",
    "agree, but report what is not so small",
    "WRONG, though nothing is smaller than three errors",
    "WRONG without a report",
    "RIGHT IN SHAPE, BUT TOO FAR",
    "CRASHED",
    "empty, or left out by CGAL",
};

/* Whether the solid is the same if it is thicker or thinner by three errors. */
static bool is_robust(const Solid &solid, const Shape &shape, int sides)
{
    try {
        for (double by : {-1.5, 1.5})
            if (!shape_of(truth_of(solid, by * solid.error, sides)).same(shape))
                return false;
    } catch (const std::exception &) {
        return false;
    }
    return true;
}

struct Tally {
    long   of[VERDICTS] = {0};
    double krs = 0, cgal = 0;
};

static double seconds_since(std::chrono::steady_clock::time_point begin)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

static int sides_for(const Solid &solid)
{
    int sides = 16;
    if (solid.level)
        return 32;
    while (sides < 96 && sag_of(*solid.tree, sides) > solid.error / 4)
        sides += 8;
    return sides;
}

static Verdict verdict_of(const Solid &solid, const Triangles &truth, const Shape &shape,
                          const Answer &answer, int sides, std::string &why)
{
    char words[256];
    if (answer.slow)
        return SLOW;
    if (answer.status != 0)
        return answer.status < 0 ? CRASHED : REFUSED;
    Shape  found = shape_of(answer.mesh);
    double area = 30, sag = sag_of(*solid.tree, sides), most = 0;
    std::snprintf(words, sizeof words,
                  "%ld shells, Euler number %ld, volume %.6f; is %ld, %ld, %.6f", shape.shells,
                  shape.euler, shape.volume, found.shells, found.euler, found.volume);
    why = words;
    if (!found.closed || !found.same(shape)) {
        if (is_robust(solid, shape, sides))
            return WRONG;
        return answer.said.empty() ? SILENT : SMALL;
    }
    if (!answer.said.empty() && is_robust(solid, shape, sides))
        return FALSE_REPORT;
    if (answer.said.empty()) {
        Triangles turned = truth;
        for (Vec &v : turned.vertices)
            v = solid.turn(v);
        most = std::fmax(farthest(answer.mesh, turned), farthest(turned, answer.mesh));
        std::snprintf(words, sizeof words, "; %.3f errors away", most / solid.error);
        why += words;
        /* Edges are farther from those of facets than faces are. */
        if (most > solid.error + 6 * sag ||
            std::fabs(found.volume - shape.volume) > area * (solid.error + sag))
            return FAR;
    }
    return AGREE;
}

int main(int argc, char **argv)
{
    if (argc < 3) {
        std::fputs("usage: csg_solids KRS COUNT [FIRST [FOLDER]]\n", stderr);
        return 64;
    }
    std::string krs = argv[1], folder = argc > 4 ? argv[4] : ".";
    uint64_t    count = std::strtoull(argv[2], nullptr, 10),
             first    = argc > 3 ? std::strtoull(argv[3], nullptr, 10) : 0;
    Tally tally;
    for (uint64_t number = first; number < first + count; number++) {
        Solid       solid = random_solid(number);
        std::string text  = text_of(solid), why,
                    path  = folder + "/" + std::to_string(number) + ".krs";
        int       sides   = sides_for(solid);
        Triangles truth;
        Shape     shape;
        auto      begin = std::chrono::steady_clock::now();
        try {
            truth = truth_of(solid, 0, sides);
            shape = shape_of(truth);
        } catch (const std::exception &problem) {
            why = problem.what();
        }
        tally.cgal += seconds_since(begin);
        if (truth.faces.empty() || !shape.closed || shape.volume < 1e-4) {
            std::printf("# %lu: left out, %s\n", (unsigned long)number,
                        why.empty() ? "empty" : why.c_str());
            tally.of[NOTHING]++;
            continue;
        }
        FILE *file = std::fopen(path.c_str(), "w");
        if (!file || std::fprintf(file, "// --error %.17g\n%s", solid.error, text.c_str()) < 0 ||
            std::fclose(file) != 0) {
            std::perror(path.c_str());
            return 74;
        }
        begin          = std::chrono::steady_clock::now();
        Answer answer  = answer_of(krs, folder, path, solid.error);
        double seconds = seconds_since(begin);
        tally.krs += seconds;
        Verdict verdict = verdict_of(solid, truth, shape, answer, sides, why);
        tally.of[verdict]++;
        std::printf("# %lu%s, 1/%.0f, %.1f s, %zu triangles: %s: %s %s\n", (unsigned long)number,
                    solid.level ? ", level" : "", 2 / solid.error, seconds,
                    answer.mesh.faces.size(), names[verdict], why.c_str(), answer.said.c_str());
        std::fflush(stdout);
        if (verdict == AGREE)
            std::remove(path.c_str());
    }
    for (int i = 0; i < VERDICTS; i++)
        std::printf("# %5ld %s\n", tally.of[i], names[i]);
    std::printf("# %.0f s by krs, %.0f s by CGAL\n", tally.krs, tally.cgal);
    return tally.of[WRONG] || tally.of[SILENT] || tally.of[FAR] || tally.of[CRASHED] ? 1 : 0;
}
