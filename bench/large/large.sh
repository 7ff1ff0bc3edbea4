#!/bin/sh
# large.sh: scenes of many parts, beside POV-Ray where it is installed.
#
# usage: bench/large/large.sh KRS [COUNTS] [TURNS]
#
# Balls of one size are spread evenly in a cube, as sharp union and, for krs alone, as a blended one.
# 1,000 and 10,000 parts have also the other kinds of blends, and a sharp union that is twisted: their frames.
# Both programs get the same centres, camera and light, and write a PNG file.  Printed in Markdown,
# medians of TURNS runs:
#   first    the whole process, nothing cached: a picture of 640x360, seconds
#   frame    CPU seconds of all threads for a picture of 1280x720, without what a picture of 16x9
#            costs; one light, no shadows
#   EXR      the same, written as EXR file with positions, normals, colours and numbers of what is seen
#   lit      as frame, with shadows and, in krs, occlusion
#   edit     the whole process after an edit of one number, warm: a picture of 640x360, seconds
#   MB       the most that was resident
set -u
[ $# -ge 1 ] || { sed -n '4p' "$0" | sed 's/^# //' >&2; exit 2; }
krs=$1 counts=${2:-1000 10000 100000} turns=${3:-3}
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT
export XDG_CACHE_HOME="$work/cache" MESA_SHADER_CACHE_DIR="$work/cache"

# ---- scenes ----

# A quasi-random sequence: multiples of powers of 1 / 1.2207..., without their whole parts.
krs_scene() { # count, "blend: ..." or nothing, whether the light throws shadows, radius, a method or nothing
    cat <<END
camera { eye: [9, 8, 16], target: [0, 0, 0], fov: 40deg }
light sun { direction: [1, 2, 1.5], intensity: 3, shadow: $3 }
def place(i) = 10 * ([0.8191725133961645 * i, 0.6710436067037893 * i, 0.5497004779019703 * i] % 1 - 0.5);
show union([sphere($4).move(place(i)) for i in 0..$1]$2)${5-}.paint(#c8553d);
END
}

pov_scene() { # count, "shadowless" or nothing, radius
    cat <<END
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <9, 8, 16> look_at 0 right -x*16/9 angle 2*degrees(atan(tan(radians(20))*16/9)) }
light_source { <1, 2, 1.5>*1e4 color rgb 3 $2 }
#declare I = 0;
union {
#while (I < $1)
sphere { 10*<mod(0.8191725133961645*I,1)-0.5, mod(0.6710436067037893*I,1)-0.5, mod(0.5497004779019703*I,1)-0.5>, $3 }
#declare I = I + 1;
#end
pigment { color rgb <0.57, 0.09, 0.05> } }
END
}

radius() { awk -v n="$1" 'BEGIN { printf "%.6f", 4 / n ^ (1 / 3) }'; }

# ---- runs ----

# Appends "NAME SECONDS CPU MB" of a command to the runs.
timed() { # name, command...
    name=$1 && shift
    if ! /usr/bin/time -f '%e %U %S %M' -o "$work/time" "$@" >"$work/out" 2>"$work/err"; then
        tail -3 "$work/err" >&2
        return
    fi
    awk -v name="$name" '{ print name, $1, $2 + $3, $4 / 1024 }' "$work/time" >>"$work/runs"
}

of_krs() { # name, scene, size, options...
    name=$1 scene=$2 size=$3 && shift 3
    timed "$name" "$krs" render "$scene" --size "$size" --samples 1 --quiet "$@"
}

of_pov() { # name, scene, width, height
    timed "$1" povray "+I$2" "+O$work/pov.png" "+W$3" "+H$4" -D -A +WT2 -GA
}

# The median of a column of the runs of a name.
median() { # name, column
    awk -v name="$1" -v column="$2" '$1 == name { print $column }' "$work/runs" | sort -n |
        awk '{ v[NR] = $1 } END { if (NR) printf "%.3f", v[int((NR + 1) / 2)]; else printf "-" }'
}

difference() { # name, name of what is taken off: of CPU seconds
    awk -v a="$(median "$1" 3)" -v b="$(median "$2" 3)" \
        'BEGIN { if (a == "-" || b == "-") print "-"; else printf "%.2f", a - b }'
}

row() { # program, count, kind, lit
    printf '| %s | %s | %s | %.2f | %s | %s | %s | %s | %.0f |\n' "$2" "$3" "$1" "$(median first 2)" \
        "$(difference frame small)" "$(difference exr small)" "$(difference lit small)" "$4" \
        "$(median first 4)"
}

measure_krs() { # count, kind, blend
    r=$(radius "$1")
    krs_scene "$1" "$3" false "$r" >"$work/plain.krs"
    krs_scene "$1" "$3" true "$r" >"$work/lit.krs"
    sed "s/sphere($r)/sphere(${r}1)/" "$work/plain.krs" >"$work/edited.krs"
    : >"$work/runs"
    for _ in $(seq "$turns"); do
        rm -rf "$work/cache"
        of_krs first "$work/plain.krs" 640x360 --occlusion off -o "$work/krs.png"
        of_krs edit "$work/edited.krs" 640x360 --occlusion off -o "$work/krs.png" --specialize structure
        of_krs edited "$work/plain.krs" 640x360 --occlusion off -o "$work/krs.png" --specialize structure
        of_krs warm "$work/lit.krs" 640x360 -o "$work/krs.png"
        of_krs small "$work/plain.krs" 16x9 --occlusion off -o "$work/krs.png"
        of_krs frame "$work/plain.krs" 1280x720 --occlusion off -o "$work/krs.png"
        of_krs exr "$work/plain.krs" 1280x720 --occlusion off -o "$work/krs.exr"
        of_krs lit "$work/lit.krs" 1280x720 -o "$work/krs.png"
    done
    row krs "$1" "$2" "$(median edited 2)"
}

# The frame alone.
measure_frame() { # count, kind, blend, method
    krs_scene "$1" "$3" false "$(radius "$1")" "$4" >"$work/plain.krs"
    of_krs warm "$work/plain.krs" 16x9 --occlusion off -o "$work/krs.png"
    : >"$work/runs"
    for _ in $(seq "$turns"); do
        of_krs small "$work/plain.krs" 16x9 --occlusion off -o "$work/krs.png"
        of_krs frame "$work/plain.krs" 1280x720 --occlusion off -o "$work/krs.png"
    done
    printf '| %s | %s | krs | - | %s | - | - | - | %.0f |\n' "$1" "$2" "$(difference frame small)" \
        "$(median frame 4)"
}

measure_others() { # count, width
    for kind in cubic exponential circular chamfer stairs; do
        steps="" && [ $kind = stairs ] && steps=", steps: 3"
        measure_frame "$1" $kind ", blend: $2, kind: \"$kind\"$steps" ""
    done
    measure_frame "$1" twisted "" ".twist([0, 1, 0], 6deg)"
}

measure_pov() { # count
    command -v povray >/dev/null || return
    pov_scene "$1" shadowless "$(radius "$1")" >"$work/plain.pov"
    pov_scene "$1" "" "$(radius "$1")" >"$work/lit.pov"
    : >"$work/runs"
    for _ in $(seq "$turns"); do
        of_pov first "$work/plain.pov" 640 360
        of_pov small "$work/plain.pov" 16 9
        of_pov frame "$work/plain.pov" 1280 720
        of_pov lit "$work/lit.pov" 1280 720
    done
    row POV-Ray "$1" sharp -
}

echo "# Scenes of many parts"
echo
echo "Seconds, medians of $turns runs. \`bench/large/large.sh\` says what the columns are."
echo
echo "| parts | joint | program | first | frame, CPU | EXR, CPU | lit, CPU | edit | MB |"
echo "| --- | --- | --- | --- | --- | --- | --- | --- | --- |"
for count in $counts; do
    measure_krs "$count" sharp ""
    width=$(awk -v r="$(radius "$count")" 'BEGIN { print r / 2 }')
    measure_krs "$count" blended ", blend: $width"
    [ "$count" -gt 10000 ] || measure_others "$count" "$width"
    measure_pov "$count"
done
