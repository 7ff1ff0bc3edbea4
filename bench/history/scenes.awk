# scenes.awk: writes a scene drawn at random.
#
# usage: awk -v seed=N -v number=I [-v name=1] -f scenes.awk
#
# Scenes of one seed are trees, parts, fields and crowds by turns; `name` prints which.  Their numbers are
# written out, and they use words that the language has always had.  So older programs draw the same.

# A number from low to high (Park and Miller's generator, whose products are exact in doubles).
function draw(low, high) {
    state = state * 16807 % 2147483647
    return low + (high - low) * state / 2147483647
}
function draw_whole(low, high) { return int(draw(low, high + 1)) }

function vec(x, y, z) { return sprintf("[%.6f, %.6f, %.6f]", x, y, z) }
function draw_vec(reach) { return vec(draw(-reach, reach), draw(-reach, reach), draw(-reach, reach)) }

function print_looks(x, y, z, middle, fov) {
    printf "camera { eye: %s, target: [0, %.6f, 0], fov: %.3fdeg }\n", vec(x, y, z), middle, fov
    printf "light sun { direction: %s, intensity: 3, softness: 2deg }\n", vec(draw(-1, 1), draw(1, 2), draw(0.5, 1.5))
    print "sky { zenith: #5580b0, horizon: #c0c8d0, ground: #554a40 }"
}

# One path of branches from the root to a twig.  At each fork a mirror through the branch makes two of
# what is above it.
function print_tree(levels, width,    i, c, angle, size, branch, radius, text, across, n, w, d, p, side) {
    d[0] = 0; d[1] = 1; d[2] = 0
    p[0, 0] = p[0, 1] = p[0, 2] = 0
    radius = width
    branch = 1
    text = ""
    for (i = 0; i < levels; i++) {
        for (c = 0; c < 3; c++)
            p[i + 1, c] = p[i, c] + branch * d[c]
        text = sprintf("  kernel capsule(%s, %s, radius: %.8f);\n", vec(p[i, 0], p[i, 1], p[i, 2]),
                       vec(p[i + 1, 0], p[i + 1, 1], p[i + 1, 2]), radius) text
        # A direction across the branch, to which what is above bends.
        do {
            size = 0
            for (c = 0; c < 3; c++) across[c] = draw(-1, 1)
            side = across[0] * d[0] + across[1] * d[1] + across[2] * d[2]
            for (c = 0; c < 3; c++) { across[c] -= side * d[c]; size += across[c] ^ 2 }
        } while (size < 0.05)
        angle = draw(0.35, 0.65); w = 0
        for (c = 0; c < 3; c++) {
            across[c] /= sqrt(size)
            n[c] = -across[c]
            w += n[c] * p[i + 1, c]
            d[c] = cos(angle) * d[c] + sin(angle) * across[c]
        }
        if (i + 1 < levels)
            text = sprintf("  reflect plane(%s, %.8f);\n", vec(n[0], n[1], n[2]), w) text
        branch *= draw(0.7, 0.8)
        radius *= draw(0.68, 0.78)
    }
    printf "show krs {\n%s}.paint(#7a5a3c);\n", text
    print_looks(draw(3, 5), draw(2, 3), draw(5, 6), 1.7, 38)
}

function draw_part(size,    kind) {
    kind = draw_whole(0, 5)
    if (kind == 0) return sprintf("sphere(%.6f)", size)
    if (kind == 1) return sprintf("box(%s)", vec(draw(1, 2) * size, draw(1, 2) * size, draw(1, 2) * size))
    if (kind == 2) return sprintf("cylinder(%.6f, %.6f)", draw(0.5, 1) * size, draw(1, 2.5) * size)
    if (kind == 3) return sprintf("torus(%.6f, %.6f)", size, draw(0.15, 0.4) * size)
    if (kind == 4) return sprintf("capsule(%s, %s, radius: %.6f)", draw_vec(size), draw_vec(size), draw(0.2, 0.5) * size)
    return sprintf("cone(%.6f, %.6f)", draw(0.6, 1) * size, draw(1, 2) * size)
}

function print_parts(count, cut, blend, floor,    i) {
    print "let body = union("
    for (i = 0; i < count; i++)
        printf "    %s.rotate(%s, %.4fdeg).move(%s),\n", draw_part(draw(0.25, 0.6)), draw_vec(1), draw(0, 180), draw_vec(1.2)
    printf "    blend: %.4f);\nshow difference(\n    body,\n", blend
    for (i = 0; i < cut; i++)
        printf "    %s.move(%s),\n", draw_part(draw(0.15, 0.35)), draw_vec(1.2)
    printf "    blend: %.4f).paint(#b08a50);\n", blend / 4
    if (floor) print "show plane([0, 1, 0], -1.8).paint(#808080);"
    print_looks(draw(3, 4), draw(2, 3), draw(4, 5), 0, 40)
}

function print_field(kind,    k) {
    if (kind == 0) {
        k = draw(3, 7)
        printf "show field(sin(%.4f * x) * cos(%.4f * y) + sin(%.4f * y) * cos(%.4f * z) + sin(%.4f * z) * cos(%.4f * x))\n", k, k, k, k, k, k
        printf "    .within(sphere(%.4f)).paint(#4a7a8c);\n", draw(1, 1.4)
    } else if (kind == 1) {
        printf "show sphere(1.2).displace(fbm(%.4f * p, %d), amplitude: %.4f).paint(#8a7f70);\n", draw(1.5, 4), draw_whole(3, 6), draw(0.1, 0.35)
    } else if (kind == 2) {
        printf "show algebraic((x^2 + %.4f * z^2 + y^2 - 1)^3 == x^2 * y^3 + %.4f * z^2 * y^3).paint(#b03030);\n", draw(1.5, 3), draw(0.05, 0.2)
    } else if (kind == 3) {
        printf "show julia(c: [%.4f, %.4f, %.4f, 0.1], power: 2, iterations: %d).paint(#6a8a4a);\n", draw(-0.4, -0.1), draw(0.4, 0.7), draw(0.1, 0.3), draw_whole(6, 9)
    } else {
        printf "show box([0.7, 2.6, 0.7]).twist(axis: [0, 1, 0], rate: %.4f).paint(#8c5a7a);\n", draw(0.5, 2)
    }
    print_looks(draw(1.5, 2.5), draw(0.8, 1.6), draw(2.5, 3.5), 0, 42)
}

function draw_member(kind) {
    if (kind == 0) return sprintf("sphere(%.6f)", draw(0.15, 0.3))
    if (kind == 1) return sprintf("box(%s)", vec(draw(0.2, 0.5), draw(0.2, 0.5), draw(0.2, 0.5)))
    return sprintf("torus(%.6f, %.6f)", draw(0.2, 0.35), draw(0.04, 0.09))
}

function print_crowd(count, blend, kind,    i) {
    print "show union(["
    for (i = 0; i < count; i++)
        printf "    %s.move(%s),\n", draw_member(kind), draw_vec(1.8)
    printf "]%s).paint(#a0623a);\n", (blend > 0 ? sprintf(", blend: %.4f", blend) : "")
    print_looks(draw(4, 5), draw(2, 3), draw(5, 6), 0, 38)
}

# The kinds by turns; `turn` counts them.
function print_scene(kind, turn) {
    if (kind == "thick-tree") print_tree(12 + turn * 2, 0.07)
    if (kind == "thin-tree") print_tree(20 - turn * 2, draw(0.02, 0.035))
    if (kind == "few-parts") print_parts(draw_whole(4, 8), draw_whole(1, 3), draw(0, 0.2), turn % 2)
    if (kind == "parts") print_parts(draw_whole(10, 24), draw_whole(3, 10), draw(0, 0.2), 0)
    if (kind == "field") print_field(turn % 5)
    if (kind == "crowd") print_crowd(draw_whole(30, 300), turn % 2 ? draw(0.02, 0.1) : 0, turn % 3)
}

BEGIN {
    split("thick-tree thin-tree few-parts parts field crowd", kinds, " ")
    kind = kinds[(number - 1) % 6 + 1]
    if (name != "") { print kind; exit }
    state = seed * 1000 + number + 1
    for (i = 0; i < 20; i++) draw(0, 1)
    print_scene(kind, int((number - 1) / 6))
}
