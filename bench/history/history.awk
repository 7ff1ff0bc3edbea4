# history.awk: a row of the table of history.sh, from the runs of a scene.

# "BUILD PHASE=MS...": the least of each phase.
{
    for (i = 2; i <= NF; i++) {
        split($i, part, "=")
        if (!(($1, part[1]) in least) || part[2] < least[$1, part[1]])
            least[$1, part[1]] = part[2]
    }
}

# The sum of some phases, before and after.
function cell(phases,    names, count, i, a, b) {
    count = split(phases, names, " ")
    for (i = 1; i <= count; i++) {
        a += least["before", names[i]] / samples
        b += least["after", names[i]] / samples
    }
    return sprintf(" %.1f %.1f %.2f |", a, b, (a > 0 ? b / a : 0))
}

END {
    printf "| %s |%s%s%s%s%s%s%s\n", scene, cell("beams"), cell("primary"), cell("normals"),
           cell("beams primary normals"), cell("shadows occlusion"), cell("shading resolve"),
           cell("beams primary normals shadows occlusion shading resolve")
}
