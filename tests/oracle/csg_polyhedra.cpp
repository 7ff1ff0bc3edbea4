/*
 * csg_polyhedra.cpp: fine polyhedra of all parts.
 */
#include "tests/oracle/csg_polyhedra.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tests/oracle/truetype.h"

static int chords_of(int sides) { return 2 + sides / 12; } /* of each curve of a letter */

/* ---- simple parts ---- */

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
static Polyhedron simple_polyhedron(const Part &part, double by, int sides)
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

/* ---- rich parts ---- */

/* The column of an outline, with holes that go farther. */
static void add_column(std::vector<Piece> &pieces, const Outline &outline, double by, double height,
                       bool hole)
{
    if (height > 0)
        pieces.push_back({hole ? '-' : '|', column(grown_outline(outline, hole ? -by : by),
                                                   height + (hole ? 1 : 0))});
}

static double area_of(const Outline &outline)
{
    double area = 0;
    for (std::size_t i = 0; i < outline.size(); i++) {
        const auto &a = outline[i], &b = outline[(i + 1) % outline.size()];
        area += (a[0] * b[1] - a[1] * b[0]) / 2;
    }
    return area;
}

/* Halfway between two control points is a point of the curve. */
static std::array<double, 2> point_of(const Glyph &glyph, std::size_t i, std::size_t j)
{
    double share = glyph.on[j] ? 1 : 0.5;
    return {glyph.x[i] + share * (glyph.x[j] - glyph.x[i]),
            glyph.y[i] + share * (glyph.y[j] - glyph.y[i])};
}

static Outline contour_of(const Glyph &glyph, std::size_t first, std::size_t count, int chords)
{
    Outline outline;
    for (std::size_t k = 0; k < count; k++) {
        std::size_t i = first + k, before = first + (k + count - 1) % count,
                    after = first + (k + 1) % count;
        if (glyph.on[i]) {
            outline.push_back({glyph.x[i], glyph.y[i]});
            continue;
        }
        auto from = point_of(glyph, i, before), to = point_of(glyph, i, after);
        for (int n = glyph.on[before] ? 1 : 0; n < chords; n++) {
            double t = double(n) / chords, s = 1 - t;
            outline.push_back({s * s * from[0] + 2 * s * t * glyph.x[i] + t * t * to[0],
                               s * s * from[1] + 2 * s * t * glyph.y[i] + t * t * to[1]});
        }
    }
    return outline;
}

/* Outer contours of fonts go clockwise, and holes the other way. */
static std::vector<Piece> letter(const Part &part, double by, int sides)
{
    static Glyph       glyph;
    std::vector<Piece> pieces, holes;
    if (!truetype_read(truetype_glyph((unsigned char)part.letter), &glyph))
        throw std::runtime_error("no such letter");
    for (std::size_t c = 0, first = 0; c < glyph.contours; first = glyph.ends[c++]) {
        Outline outline = contour_of(glyph, first, glyph.ends[c] - first, chords_of(sides));
        bool    hole    = area_of(outline) > 0;
        if (!hole)
            std::reverse(outline.begin(), outline.end());
        for (auto &at : outline)
            at = {part.size[0] * (at[0] - 0.35), part.size[0] * (at[1] - 0.35)};
        add_column(hole ? holes : pieces, outline, by, part.size[1] + 2 * by, hole);
    }
    pieces.insert(pieces.end(), holes.begin(), holes.end());
    return pieces;
}

/* The ends of a line that begins and ends on the axis stay there. */
static Polyhedron revolved(const Part &part, double by, int sides)
{
    Outline profile = part.corners, grown;
    double  out     = part.size[0];
    if (out > 0) {
        for (const auto &at : grown_outline(profile, by))
            grown.push_back({at[0] + out, at[1]});
        return lathe(grown, sides, true);
    }
    grown         = grown_outline(profile, by);
    grown.front() = {0, profile.front()[1] - by};
    grown.back()  = {0, profile.back()[1] + by};
    for (std::size_t i = 1; i + 1 < grown.size(); i++)
        if (grown[i][0] <= 0)
            return {};
    return lathe(grown, sides, false);
}

/* The ridges of a thread are cut by the half-plane of the angle 0, and end in cones whose tips are on the axis. */
struct Ridges {
    double      profile[4][2]; /* radius and height of a foot, the crest and the other foot */
    double      pitch, lead, low;
    int         starts, count, sides;
    Polyhedron  solid;
    std::size_t at(int i, int j) const { return std::size_t(i * 4 * count + j); }
    /* Beyond the last side is the first one, some ridges higher. */
    std::size_t next(int i, int j) const
    {
        return i + 1 < sides ? at(i + 1, j) : at(0, j + 4 * starts);
    }
    bool has_next(int i, int j) const { return i + 1 < sides || j + 4 * starts < 4 * count; }
};

static void add_ridge_vertices(Ridges &ridges)
{
    for (int i = 0; i < ridges.sides; i++)
        for (int j = 0; j < 4 * ridges.count; j++) {
            const double *at    = ridges.profile[j % 4];
            double        angle = 2 * M_PI * i / ridges.sides;
            ridges.solid.vertices.push_back(
                {at[0] * std::cos(angle),
                 ridges.low + ridges.pitch * (j / 4) + at[1] + ridges.lead * i / ridges.sides,
                 -at[0] * std::sin(angle)});
        }
}

/* An end: the tip, and the ridges that are seen in the column of vertices i from j on. */
static void add_ridge_end(Ridges &ridges, std::size_t tip, int i, int j, bool above)
{
    auto add = [&](const std::vector<std::size_t> &face) { ridges.solid.faces.push_back(face); };
    for (int k = 0; k < ridges.starts; k++) {
        int foot = j + 4 * k;
        if (!above) { /* from the first foot up to that of the ridge a turn on */
            add({ridges.at(i, foot), ridges.at(i, foot + 1), ridges.at(i, foot + 2),
                 ridges.at(i, foot + 3)});
            add({tip, ridges.at(i, foot), ridges.at(i, foot + 3)});
            add({tip, ridges.at(i, foot + 3), ridges.at(i, foot + 4)});
        } else {
            add({ridges.at(i, foot + 4), ridges.at(i, foot + 3), ridges.at(i, foot + 2),
                 ridges.at(i, foot + 1)});
            add({tip, ridges.at(i, foot + 1), ridges.at(i, foot)});
            add({tip, ridges.at(i, foot + 4), ridges.at(i, foot + 1)});
        }
    }
}

static void add_ridge_faces(Ridges &ridges)
{
    int         last = 4 * ridges.count - 1, sides = ridges.sides;
    std::size_t below = ridges.solid.vertices.size(), above = below + 1;
    double      low = ridges.solid.vertices.front()[1], high = ridges.solid.vertices[below - 1][1];
    ridges.solid.vertices.push_back({0, low - 0.5, 0});
    ridges.solid.vertices.push_back({0, high + 0.5, 0});
    for (int i = 0; i < sides; i++)
        for (int j = 0; j < last && ridges.has_next(i, j + 1); j++) {
            ridges.solid.faces.push_back({ridges.at(i, j), ridges.next(i, j), ridges.at(i, j + 1)});
            ridges.solid.faces.push_back(
                {ridges.next(i, j), ridges.next(i, j + 1), ridges.at(i, j + 1)});
        }
    for (int i = 0; i < sides; i++)
        ridges.solid.faces.push_back({below, ridges.next(i, 0), ridges.at(i, 0)});
    for (int i = 0; i + 1 < sides; i++)
        ridges.solid.faces.push_back({above, ridges.at(i, last), ridges.at(i + 1, last)});
    ridges.solid.faces.push_back(
        {above, ridges.at(sides - 1, last - 4 * ridges.starts), ridges.at(0, last)});
    add_ridge_end(ridges, below, 0, 0, false);
    add_ridge_end(ridges, above, sides - 1, last - 4 * ridges.starts, true);
}

/* A side of the profile that is moved outwards by so much moves its ends along the levels of crest and core. */
static std::vector<Piece> thread(const Part &part, double by, int sides)
{
    Ridges ridges;
    double radius = part.size[0] / 2, depth = thread_depth(part), length = part.size[2],
           chamfer = part.size[3], beyond = 0.1, slope = std::tan(M_PI / 6),
           moved  = by * (1 / std::cos(M_PI / 6) - slope);
    ridges.pitch  = std::fabs(part.size[1]);
    ridges.starts = part.starts;
    ridges.sides  = sides;
    ridges.lead   = ridges.pitch * part.starts;
    ridges.count  = int(std::ceil((length + 2) / ridges.pitch)) + 2 * part.starts;
    ridges.low    = -ridges.pitch * std::floor(ridges.count / 2 + part.starts);
    double half = ridges.pitch / 16 + moved, foot = ridges.pitch / 16 + depth * slope + moved;
    if (radius - depth + by <= 0 || half <= 0 || 2 * foot >= ridges.pitch || length + 2 * by <= 0)
        throw std::runtime_error("no thread is left");
    const double profile[4][2] = {{radius - depth + by, -foot},
                                  {radius + by, -half},
                                  {radius + by, half},
                                  {radius - depth + by, foot}};
    std::copy(&profile[0][0], &profile[0][0] + 8, &ridges.profile[0][0]);
    add_ridge_vertices(ridges);
    add_ridge_faces(ridges);
    if (part.size[1] < 0) {
        for (Vec &v : ridges.solid.vertices)
            v[2] = -v[2];
        for (auto &face : ridges.solid.faces)
            std::reverse(face.begin(), face.end());
    }
    double  end = length / 2 + by, cut = chamfer - by * (std::sqrt(2) - 1);
    Outline ends = {{0, -end},
                    {radius + by - cut - by, -end},
                    {radius + beyond, -end + cut + by + beyond},
                    {radius + beyond, end - cut - by - beyond},
                    {radius + by - cut - by, end},
                    {0, end}};
    return {{'|', ridges.solid}, {'&', lathe(ends, sides, false)}};
}

/* How high the blend of a wall and a floor is, and how far from the wall, from the wall to the floor. */
static Outline blend_line(Blend blend, double width, int steps)
{
    Outline line;
    for (int i = 0; i <= steps; i++) {
        double u = 2.0 * i / steps - 1, rest = 1 - std::fabs(u), near, far;
        switch (blend) {
        case QUADRATIC: near = width * rest * rest / 4; break;
        case CUBIC: near = width * rest * rest * rest / 6; break;
        default: near = 0; break;
        }
        far = near + std::fabs(u) * width;
        if (blend == CHAMFER) {
            near = width * rest / 2;
            far  = width - near;
        } else if (blend == CIRCULAR || blend == FILLET) {
            double angle = (1 - std::fabs(u)) * M_PI / 4;
            near         = width * (1 - std::cos(angle));
            far          = width * (1 - std::sin(angle));
        }
        line.push_back(u < 0 ? std::array<double, 2>{near, far} : std::array<double, 2>{far, near});
    }
    return line;
}

static std::vector<Piece> blended(const Part &part, double by, int sides)
{
    const double *size = part.size;
    double        half = half_plate(part) + by, radius = size[0] + by;
    if (size[0] + by <= 0 || size[3] + 2 * by <= 0)
        throw std::runtime_error("no column is left");
    Outline blend = blend_line(part.blend, size[2], part.blend == CHAMFER ? 2 : sides / 4), line;
    line.push_back({0, -size[3] / 2});
    line.push_back({radius + size[2], -size[3] / 2});
    for (auto at = blend.rbegin(); at != blend.rend(); at++)
        line.push_back({radius + (*at)[0], (*at)[1] + by});
    line.push_back({radius, size[1] + by});
    line.push_back({0, size[1] + by});
    Polyhedron plate = column({{-half, -half}, {half, -half}, {half, half}, {-half, half}},
                              size[3] + 2 * by);
    plate            = upright(plate);
    for (Vec &v : plate.vertices)
        v[1] -= size[3] / 2;
    return {{'|', plate}, {'|', lathe(line, sides, false)}};
}

/* Rings of a path in x and z: across it at its ends, on the mitre at corners. */
static Polyhedron swept(const Part &part, double by)
{
    const Outline &path = part.corners;
    Polyhedron     solid;
    double         half = part.size[0] / 2 + by, high = part.size[1] / 2 + by;
    std::size_t    n = path.size();
    if (half <= 0 || high <= 0)
        return {};
    for (std::size_t i = 0; i < n; i++) {
        const auto &a = path[i > 0 ? i - 1 : 0], &b = path[i], &c = path[i + 1 < n ? i + 1 : n - 1];
        double      u[2] = {b[0] - a[0], b[1] - a[1]}, v[2] = {c[0] - b[0], c[1] - b[1]};
        double      lu = std::hypot(u[0], u[1]), lv = std::hypot(v[0], v[1]), m[2], end = 0;
        for (int k = 0; k < 2; k++)
            m[k] = (lu > 0 ? u[k] / lu : v[k] / lv) + (lv > 0 ? v[k] / lv : u[k] / lu);
        end          = i == 0 ? -by / 2 : i + 1 == n ? by / 2 : 0;
        double along = 2 / (m[0] * m[0] + m[1] * m[1]);
        for (int k = 0; k < 4; k++) {
            double side = (k == 0 || k == 3 ? -half : half) * along, y = k < 2 ? -high : high;
            solid.vertices.push_back(
                {b[0] + end * m[0] + side * m[1], y, b[1] + end * m[1] - side * m[0]});
        }
    }
    solid.faces = {{3, 2, 1, 0}, {4 * n - 4, 4 * n - 3, 4 * n - 2, 4 * n - 1}};
    for (std::size_t i = 0; i + 1 < n; i++)
        for (std::size_t k = 0; k < 4; k++) {
            std::size_t j = (k + 1) % 4;
            solid.faces.push_back({4 * i + k, 4 * i + j, 4 * i + 4 + j, 4 * i + 4 + k});
        }
    return solid;
}

std::vector<Piece> pieces_of(const Part &part, double by, int sides)
{
    std::vector<Piece> pieces;
    switch (part.kind) {
    case LETTER: pieces = letter(part, by, sides); break;
    case HOLED:
        add_column(pieces, part.corners, by, part.size[0] + 2 * by, false);
        add_column(pieces, part.hole, by, part.size[0] + 2 * by, true);
        break;
    case REVOLVED: pieces = {{'|', revolved(part, by, sides)}}; break;
    case THREAD: pieces = thread(part, by, sides); break;
    case BLENDED: pieces = blended(part, by, sides); break;
    case SWEPT: pieces = {{'|', swept(part, by)}}; break;
    default: pieces = {{'|', simple_polyhedron(part, by, sides)}}; break;
    }
    for (Piece &piece : pieces)
        for (Vec &v : piece.solid.vertices)
            v = part.turn(v) + part.shift;
    return pieces;
}

/* The farthest that a part is from its facets. */
double sag_of(const Tree &tree, int sides)
{
    if (tree.csg_node)
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
    case LETTER: return 0.06 * part.size[0] / (chords_of(sides) * chords_of(sides));
    case REVOLVED: {
        double radius = 0;
        for (const auto &at : part.corners)
            radius = std::fmax(radius, at[0] + part.size[0]);
        return radius * sag;
    }
    case THREAD: return 2 * part.size[0] * sag;
    case BLENDED: return (part.size[0] + 2 * part.size[2]) * sag;
    default: return 0;
    }
}
