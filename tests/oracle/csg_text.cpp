/*
 * csg_text.cpp: random solids as scenes.
 */
#include "tests/oracle/csg_random.h"

#include <cmath>
#include <cstdio>

static void write_rotation(std::string &text, const Turn &turn)
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

static void write_outline(std::string &text, const Outline &outline)
{
    char        words[128];
    const char *between = "polygon([";
    for (const auto &corner : outline) {
        std::snprintf(words, sizeof words, "%s[%.17g, %.17g]", between, corner[0], corner[1]);
        text += words;
        between = ", ";
    }
    text += "])";
}

static void write_path(std::string &text, const Outline &path)
{
    char        words[128];
    const char *between = "[";
    for (const auto &at : path) {
        std::snprintf(words, sizeof words, "%s[%.17g, 0, %.17g]", between, at[0], at[1]);
        text += words;
        between = ", ";
    }
    text += "]";
}

/* The column stands in the top of the plate, which is level with y = 0. */
static std::string text_of_blended(const Part &part)
{
    static const char *const blends[BLENDS] = {"quadratic", "cubic", "circular", "chamfer",
                                               "fillet"};
    const double            *size           = part.size;
    char                     words[512];
    std::snprintf(words, sizeof words,
                  "union(box([%.17g, %.17g, %.17g]).move([0, %.17g, 0]), cylinder(%.17g, "
                  "%.17g).move([0, %.17g, 0]), blend: %.17g, kind: \"%s\")",
                  2 * half_plate(part), size[3], 2 * half_plate(part), -size[3] / 2, size[0],
                  size[1] + DEEP, (size[1] - DEEP) / 2, size[2], blends[part.blend]);
    return words;
}

/* Those of corners, a letter, or two parts; others: nothing. */
static std::string text_of_rich(const Part &part)
{
    const double *size = part.size;
    std::string   text;
    char          words[256] = "";
    switch (part.kind) {
    case LETTER:
        std::snprintf(words, sizeof words,
                      "text(\"%c\", size: %.17g, font: \"DejaVu Sans:bold\").extrude(%.17g)"
                      ".move([%.17g, %.17g, 0])",
                      part.letter, size[0], size[1], -0.35 * size[0], -0.35 * size[0]);
        break;
    case POLYGON:
        write_outline(text, part.corners);
        std::snprintf(words, sizeof words, ".extrude(%.17g)", size[0]);
        break;
    case HOLED:
        text = "(";
        write_outline(text, part.corners);
        text += " - ";
        write_outline(text, part.hole);
        std::snprintf(words, sizeof words, ").extrude(%.17g)", size[0]);
        break;
    case REVOLVED:
        write_outline(text, part.corners);
        std::snprintf(words, sizeof words, ".revolve(%.17g)", size[0]);
        break;
    case BLENDED: return text_of_blended(part);
    case SWEPT:
        std::snprintf(words, sizeof words, "sweep(rectangle([%.17g, %.17g]), ", size[0], size[1]);
        text = words;
        write_path(text, part.corners);
        return text + ")";
    default: break;
    }
    return text + words;
}

static void write_part(std::string &text, const Part &part)
{
    const double *size = part.size;
    char          words[256];
    switch (part.kind) {
    case BOX:
        std::snprintf(words, sizeof words, "box([%.17g, %.17g, %.17g])", size[0], size[1], size[2]);
        break;
    case CYLINDER:
        std::snprintf(words, sizeof words, "cylinder(%.17g, %.17g)", size[0], size[1]);
        break;
    case PRISM:
        std::snprintf(words, sizeof words, "prism(%d, %.17g, %.17g)", int(size[2]), size[0],
                      size[1]);
        break;
    case BALL: std::snprintf(words, sizeof words, "sphere(%.17g)", size[0]); break;
    case CONE: std::snprintf(words, sizeof words, "cone(%.17g, %.17g)", size[0], size[1]); break;
    case FRUSTUM:
        std::snprintf(words, sizeof words, "capped_cone(%.17g, %.17g, %.17g)", size[0], size[1],
                      size[2]);
        break;
    case RING: std::snprintf(words, sizeof words, "torus(%.17g, %.17g)", size[0], size[1]); break;
    case THREAD:
        std::snprintf(words, sizeof words,
                      "thread(diameter: %.17g, pitch: %.17g, length: %.17g, depth: %.17g, "
                      "starts: %d, chamfer: %.17g)",
                      size[0], size[1], size[2], thread_depth(part), part.starts, size[3]);
        break;
    default: words[0] = 0; break;
    }
    text += words[0] ? words : text_of_rich(part);
    write_rotation(text, part.turn);
    std::snprintf(words, sizeof words, ".move([%.17g, %.17g, %.17g])", part.shift[0], part.shift[1],
                  part.shift[2]);
    text += words;
}

static void write_tree(std::string &text, const Tree &tree)
{
    if (!tree.csg_node) {
        write_part(text, tree.part);
        return;
    }
    text += "(";
    write_tree(text, *tree.left);
    text += std::string(" ") + tree.csg_node + " ";
    write_tree(text, *tree.right);
    text += ")";
}

std::string text_of(const Solid &solid)
{
    std::string text = "show ";
    write_tree(text, *solid.tree);
    write_rotation(text, solid.turn);
    return text + ";\n";
}
