/*
 * csg_random.cpp: which parts there are, how large they are, and where.
 */
#include "tests/oracle/csg_random.h"

#include <cmath>

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

/* Around the origin, with radii between these. */
static Outline random_star(Random &random, int corners, double least, double most)
{
    Outline outline;
    for (int i = 0; i < corners; i++) {
        double r     = random.between(least, most),
               angle = (i + random.between(-0.2, 0.2)) * 2 * M_PI / corners;
        outline.push_back({r * std::cos(angle), r * std::sin(angle)});
    }
    return outline;
}

/* A star, or a triangle that is a knife. */
static void random_polygon(Random &random, Part &part)
{
    if (random.below(3) == 0) {
        double length = random.between(0.6, 1.2);
        double half   = length * std::tan(random.between(5, 40) * M_PI / 360);
        part.corners  = {{-0.5 * length, 0}, {0.5 * length, -half}, {0.5 * length, half}};
        return;
    }
    part.corners = random_star(random, 3 + random.below(6), 0.35, 0.9);
}

static Part random_part(Random &random)
{
    Part part;
    part.kind  = Kind(random.below(SIMPLE));
    part.turn  = random.below(3) ? random.turn() : random.quarter_turn();
    part.shift = random.between(0, 0.8) * random.unit();
    for (int k = 0; k < 3; k++)
        part.size[k] = random.between(0.4, 1.2);
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

/* Makes a part whose sizes are eighths; triangles have right angles. */
static Part level_part(Random &random)
{
    static const Kind kinds[] = {BOX, BOX, BOX, CYLINDER, CYLINDER, POLYGON};
    Part              part;
    part.kind = kinds[random.below(6)];
    part.turn = random.quarter_turn();
    for (int k = 0; k < 3; k++)
        part.size[k] = 0.25 * (1 + random.below(4));
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

/* Below and above it begins on the axis and leaves it at a right angle, or it goes around a ring. */
static void random_profile(Random &random, Part &part)
{
    if (random.below(2)) {
        part.size[0] = random.between(0.45, 0.7);
        part.corners = random_star(random, 3 + random.below(5), 0.15, 0.4);
        return;
    }
    int    n      = 2 + random.below(4);
    double height = random.between(0.6, 1.4);
    part.size[0]  = 0;
    part.corners  = {{0, -height / 2}};
    for (int i = 0; i < n; i++)
        part.corners.push_back({random.between(0.15, 0.8), (double(i) / (n - 1) - 0.5) * height});
    part.corners.push_back({0, height / 2});
}

/* Straight on, and around corners of 20 to 90 degrees. */
static Outline random_path(Random &random)
{
    Outline path  = {{-0.7, 0}};
    double  angle = 0;
    for (int lines = 2 + random.below(2); lines > 0; lines--) {
        double length = random.between(0.5, 0.9);
        path.push_back(
            {path.back()[0] + length * std::cos(angle), path.back()[1] + length * std::sin(angle)});
        angle += (random.below(2) ? 1 : -1) * random.between(20, 90) * M_PI / 180;
    }
    return path;
}

static Part rich_part(Random &random)
{
    static const char letters[] = "ABDOPQR08&eagSKXTi%";
    Part              part;
    part.kind  = Kind(SIMPLE + random.below(KINDS - SIMPLE));
    part.turn  = random.below(3) ? random.turn() : random.quarter_turn();
    part.shift = random.between(0, 0.5) * random.unit();
    switch (part.kind) {
    case LETTER:
        part.letter  = letters[random.below(int(sizeof letters - 1))];
        part.size[0] = random.between(1, 1.8);
        part.size[1] = random.between(0.3, 0.8);
        break;
    case HOLED:
        part.size[0] = random.between(0.3, 0.8);
        part.corners = random_star(random, 5 + random.below(4), 0.5, 0.9);
        part.hole    = random_star(random, 3 + random.below(4), 0.12, 0.24);
        break;
    case REVOLVED: random_profile(random, part); break;
    case THREAD:
        part.starts  = 1 + random.below(2);
        part.size[0] = random.between(0.5, 1);
        part.size[1] = part.size[0] * random.between(0.12, 0.3) * (random.below(4) ? 1 : -1);
        part.size[2] = random.between(0.6, 1.4);
        part.size[3] = thread_depth(part) * random.between(0.3, 0.8);
        break;
    case BLENDED:
        part.blend   = Blend(random.below(BLENDS));
        part.size[0] = random.between(0.2, 0.5);
        part.size[2] = random.between(0.1, 0.3);
        part.size[1] = part.size[2] + random.between(0.2, 0.6);
        part.size[3] = part.size[2] + random.between(0.15, 0.4);
        break;
    default:
        part.size[0] = random.between(0.15, 0.35);
        part.size[1] = random.between(0.15, 0.6);
        part.corners = random_path(random);
        break;
    }
    return part;
}

static Part any_part(Random &random, const Solid &solid)
{
    if (solid.level)
        return level_part(random);
    return solid.rich && random.below(2) ? rich_part(random) : random_part(random);
}

static std::unique_ptr<Tree> random_tree(Random &random, int parts, const Solid &solid)
{
    auto tree = std::make_unique<Tree>();
    if (parts == 1) {
        tree->part = any_part(random, solid);
        return tree;
    }
    int right      = random.below(3) ? 1 : 1 + random.below(parts - 1);
    tree->csg_node = "||--&"[random.below(5)];
    tree->left     = random_tree(random, parts - right, solid);
    tree->right    = random_tree(random, right, solid);
    return tree;
}

Solid random_solid(uint64_t number)
{
    Random random = {1000003 * number + 17};
    Solid  solid;
    solid.level = number % 4 == 3;
    solid.rich  = number % 4 == 1;
    /* Solids are about two long: the error is from 1/20 to 1/1000 of that, the finest ones seldom. */
    solid.error = 2 /
                  std::exp(random.between(std::log(20), std::log(random.below(8) ? 200 : 1000)));
    solid.turn = random.below(2) ? random.turn() : random.quarter_turn();
    solid.tree = random_tree(random, solid.rich ? 1 + random.below(4) : 2 + random.below(5), solid);
    return solid;
}
