/*
 * instance_texts.c: scenes with parts that are alike but for numbers, in all surroundings.
 */
#include "tests/support/instance_texts.h"

#include <stdio.h>
#include <stdlib.h>

/* Twins are two parts near each other and far from all others: of more the order counts in which
   they are blended, and that of parts apart is another than that of an instance group. */
static const char prelude[] =
    "let seed = %d;\n"
    "def within(i, k) = 2 * random(seed + 3 * i + k) - 1;\n"
    "def spot(i) = [within(i, 0), within(i, 1), within(i, 2)];\n"
    "def beside(i) = let j = floor(i / 2) in\n"
    "    2 * [j %% 3, floor(j / 3), 0.5 * (j %% 2)] + 0.15 * spot(i);\n"
    "def size(i) = 0.1 + 0.1 * random(seed + 0.5 + i);\n"
    "def ball(i) = sphere(size(i)).move(spot(i));\n"
    "def pin(i) = capsule([0, 0, 0], [0, 0.3, 0], 0.5 * size(i)).rotate([1, 0, 0], i + "
    "1).move(spot(i));\n"
    "def hue(i) = random(seed + 0.25 + i);\n"
    "def colored(i) = ball(i).color_by(hue(i), palette: \"spectrum\");\n"
    "def twin(i) = sphere(size(i)).color_by(hue(i), palette: \"spectrum\").move(beside(i));\n"
    "let balls = union([ball(i) for i in 0..20]);\n"
    "let both = union([if i %% 2 == 0 then ball(i) else pin(i) for i in 0..40]);\n"
    "material gray { color: #777777 }\n"
    "let block = box([1.6, 1.6, 1.6]).paint(gray);\n"
    "let twins = [twin(i) for i in 0..18];\n"
    "def tiny(i) = sphere(0.06 + 0.04 * random(i + 0.5)).move(0.4 * spot(100 + i));\n"
    "let cluster = union([tiny(i) for i in 0..16]);\n"
    "let leaf = krs {\n"
    "    kernel sphere(0.1);\n"
    "    mobius translate([-0.12, 0, 0]);\n"
    "    reflect plane([1, 0, 0], 0);\n"
    "};\n"
    "light { direction: [1, 2, 3], shadow: false }\n";

#define SEQUENCE                                                                                   \
    "krs { kernel both.scale(0.3); for i in 0..3 { mobius translate([0.4, 0.1, 0]) * "             \
    "rotate([0, 1, 0], 40deg) * scale(0.9); reflect plane([1, 0, 0], 0); kernel balls.scale(0.2);" \
    " } }"

const InstanceText instance_texts[] = {
    {"sharp", "both", 0},
    {"quadratic", "union(twins, blend: 0.1)", 0.1},
    {"cubic", "union(twins, blend: 0.1, kind: \"cubic\")", 0.1},
    {"exponential", "union(twins, blend: 0.02, kind: \"exponential\")", 0.02},
    {"circular", "union(twins, blend: 0.1, kind: \"circular\")", 0.1},
    {"chamfer", "union(twins, blend: 0.1, kind: \"chamfer\")", 0.1},
    {"stairs", "union(twins, blend: 0.1, kind: \"stairs\", steps: 3)", 0.1},
    {"blended tools", "difference(block.move([2, 2, 0.5]), twins, blend: 0.1)", 0.1},
    {"instance group of instance groups",
     "union([cluster.rotate([0, 0, 1], i).move(0.8 * spot(i)) for i in 0..17])", 0},
    {"painted", "union([colored(i) for i in 0..20])", 0},
    {"tools", "difference(block, [colored(i) for i in 0..20])", 0},
    {"shell", "balls.shell(0.05)", 0},
    {"less an instance group", "box([1.6, 1.6, 1.6]) - both", 0},
    {"cut", "both & sphere(1)", 0},
    {"blended with one", "union(both, box([0.5, 3, 0.5]), blend: 0.3)", 0},
    {"common", "intersection([sphere(1 + size(i)).move(0.1 * spot(i)) for i in 0..20])", 0},
    {"xor", "xor(both, box([1.5, 1.5, 1.5]))", 0},
    {"sequence", SEQUENCE, 0},
    {"map", "both.transform(translate([1, 0, 0]) * rotate([0, 1, 1], 1) * scale(0.7))", 0},
    {"inverted", "both.move([0, 3, 0]).transform(invert(radius: 1.5))", 0},
    {"twisted", "both.twist(axis: [0, 1, 0], rate: 0.4)", 0},
    {"tapered", "both.taper(axis: [0, 1, 0], from: 1.2, to: 0.6)", 0},
    {"bent", "both.bend(axis: [1, 0, 0], rate: 0.3)", 0},
    {"displaced", "both.displace(0.05 * sin(7 * x) * sin(6 * y))", 0},
    {"twisted blend", "union(twins, blend: 0.1).twist(axis: [0, 1, 0], rate: 0.1)", 0.1},
    {"blended with twisted",
     "union(both.twist(axis: [0, 1, 0], rate: 0.4), box([0.5, 3, 0.5]), "
     "blend: 0.3)",
     0},
    {"repeated", "both.scale(0.5).repeat([1.5, 0, 0], 2)", 0},
    {"offset", "both.offset(0.08)", 0},
    {"rounded", "both.round(0.03)", 0},
    {"blended clusters",
     "union([cluster.rotate([0, 0, 1], i + 1).move(beside(i)) for i in 0..16], blend: 0.05)", 0.05},
    {"levels", "union([leaf.rotate([0, 1, 0], i + 1).move(1.2 * spot(i)) for i in 0..20])", 0},
    {"blended levels",
     "union([leaf.rotate([0, 1, 0], i + 1).move(beside(i)) for i in 0..18], blend: 0.1)", 0.1},
};
const size_t instance_text_count = sizeof instance_texts / sizeof *instance_texts;

char *instance_text(const InstanceText *scenes, size_t count, int seed)
{
    size_t size = sizeof prelude + 1024 * count, length = 0;
    char  *text = malloc(size);
    if (text)
        length = (size_t)snprintf(text, size, prelude, seed);
    for (size_t i = 0; text && i < count; i++)
        length += (size_t)snprintf(text + length, size - length, "show (%s).move([%d, %d, 0]);\n",
                                   scenes[i].show, (int)(i % 3 * 6), (int)(i / 3 * 6));
    return text;
}
