#!/bin/sh
# api.sh: a program that was compiled with headers of before, or of later, runs with the library as it is.
#
# Structs and choices grow at their end alone: tests/api/layouts.txt has where everything was in the last version that
# was released; `api.sh --bless` writes it anew, for a release.
cd "$(dirname "$0")/.." || exit 1
build=${B:-build}
cc=${CC:-cc}
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT
failed=0
number=0
report() { # status, name
    number=$((number + 1))
    [ "$1" -eq 0 ] && echo "ok $number - $2" && return
    echo "not ok $number - $2"
    failed=1
    head -n 20 "$work/said" | sed 's/^/# /'
}

# ---- where members are ----

# Elements of arrays and parts of other structs, which keep their size.
fixed="KrsAllocator KrsWindow KrsContour KrsSectionPlane KrsTransform KrsItem KrsMatte KrsBeam KrsWall KrsOrientation
       KrsRenderStats KrsMethods"
layouts() { # folder of headers
    printf '#include <krs/%s.h>\n' camera vulkan >"$work/all.c"
    "$cc" -std=c17 -DKRS_NO_DEPRECATED -DKRS_NO_DEPRECATION_WARNINGS -I"$1" -E -P "$work/all.c" | awk -f tests/api/layout.awk >"$work/layouts.c" &&
        "$cc" -std=c17 -I"$1" -o "$work/layouts" "$work/layouts.c" && "$work/layouts"
}
# What is different of the recorded ones.
compare() { # recorded, layouts
    awk -v fixed="$fixed" '
        BEGIN { count = split(fixed, names, " "); for (i = 1; i <= count; i++) keeps[names[i]] = 1 }
        { owner = $1; sub(/\..*/, "", owner) }
        NR == FNR { first[$1] = $2; size[$1] = $3; if (owner != $1 && $2 + $3 > end[owner]) end[owner] = $2 + $3 }
        # Bytes that fill a struct up have any value where the program writes it.
        NR == FNR && $1 ~ /^Krs[A-Za-z]*(Options|Camera|Rays)$/ { end[$1] = $2 }
        NR == FNR { next }
        { seen[$1] = 1 }
        !($1 in first) && owner != $1 && owner in first && $2 < end[owner] { print $1 " is not behind the others" }
        !($1 in first) { next }
        $1 in keeps && $2 != first[$1] { print $1 " keeps its size: it is a part of others" }
        $1 ~ /^Krs[A-Za-z0-9]*$/ { if ($2 < first[$1]) print $1 " is shorter"; next }
        $2 != first[$1] || $3 != size[$1] { print $1 " was " first[$1] " " size[$1] ", is " $2 " " $3 }
        END { for (name in first) if (!(name in seen)) print name " is gone" }' "$1" "$2"
}
layouts include >"$work/layouts_now" 2>"$work/said"
if [ "${1:-}" = --bless ]; then
    cp "$work/layouts_now" tests/api/layouts.txt
    exit
fi
echo "1..18"
[ "$(wc -l <"$work/layouts_now")" -gt 400 ]
report $? "the headers have $(wc -l <"$work/layouts_now") sizes, members and choices"
compare tests/api/layouts.txt "$work/layouts_now" >"$work/said"
[ ! -s "$work/said" ]
report $? "all that was released is where it was"

# Headers with a change that breaks compiled programs.
broken() { # name, file, words for sed
    rm -rf "$work/broken" && mkdir "$work/broken" && cp -r include/krs "$work/broken"
    sed "$3" "include/krs/$2" >"$work/broken/krs/$2"
    layouts "$work/broken" >"$work/layout" 2>"$work/said" && compare tests/api/layouts.txt "$work/layout" >>"$work/said"
    [ -s "$work/said" ] && ! cmp -s "include/krs/$2" "$work/broken/krs/$2"
    report $? "$1 is found"
}
broken "a member before others" krs.h 's/^    uint32_t    components; .*/    int early; &/'
broken "a property before others" surface.def 's/^KRS_MATERIAL(coat, .*/KRS_MATERIAL(early, FLOAT, 0, 0, 0, 1, LIMITED, MIXED)\n&/'
broken "a property of cameras before others" camera.def 's/^KRS_CAMERA(fov, .*/KRS_CAMERA(early, number, BODY, NULL, false, 0)\n&/'
broken "a number of lights before others" lights.def 's/^KRS_LIGHT(color, .*/KRS_LIGHT(early, number, NULL, NULL, 0)\n&/'
broken "a choice before others" choices.def 's/^KRS_TRACE(RELAXED, .*/KRS_TRACE(EARLY, "early", "")\n&/'
broken "a member that is gone" mesh.h 's/^    bool   draft;//'
broken "an option where bytes fill the struct up" krs.h 's/^    const char \*root;/    bool early;\n&/'
broken "an element that grows" slice.h 's/^    double area; .*/&\n    double late;/'

# ---- programs ----

all="KrsTextOptions KrsSky KrsFog KrsOptions KrsChanges KrsParameter KrsImage KrsTexture KrsStateSlope KrsLocation KrsComponent KrsBound KrsMeshOptions
     KrsMotion KrsGridOptions KrsGridShape KrsSliceOptions KrsMeasureOptions KrsDevice KrsRendererOptions KrsRenderOptions
     KrsShaderStats KrsRays"
headers() { # older or later
    mkdir -p "$work/$1/krs" && cp include/krs/*.def "$work/$1/krs"
    for header in include/krs/*.h; do
        awk -v change="$1" -v structs="$(echo "$all" | tr '\n' ' ')" -f tests/api/headers.awk "$header" >"$work/$1/krs/${header##*/}"
    done
}
headers older
awk '/^KRS_MATERIAL/ { last = NR } { line[NR] = $0 } END { for (i = 1; i <= NR; i++) if (i != last) print line[i] }' \
    include/krs/surface.def >"$work/older/krs/surface.def"
sed '/^KRS_AOV(NOISE/,$d' include/krs/aovs.def >"$work/older/krs/aovs.def"
sed '/^KRS_CAMERA(eyes/d' include/krs/camera.def >"$work/older/krs/camera.def"
sed '/^KRS_LIGHT(size/d' include/krs/lights.def >"$work/older/krs/lights.def"
headers later
sed 's/^KRS_IDENTITY(component/KRS_MATERIAL(later, FLOAT, 0, 0, 0, 1, LIMITED, MIXED)\n&/' include/krs/surface.def \
    >"$work/later/krs/surface.def"
sed 's/^KRS_CAMERA(eyes.*/&\nKRS_CAMERA(later, number, BODY, NULL, false, 0)/' include/krs/camera.def >"$work/later/krs/camera.def"
sed 's/^KRS_LIGHT(size.*/&\nKRS_LIGHT(later, number, NULL, NULL, 0)/' include/krs/lights.def >"$work/later/krs/lights.def"
layouts "$work/older" >"$work/layouts_older" 2>"$work/said"
layouts "$work/later" >"$work/layouts_later" 2>>"$work/said"
# Each struct has another size, but for bytes that were there to fill it up.
differ=$(cat "$work/layouts_older" "$work/layouts_now" "$work/layouts_later" | grep -v '[._]' | sort -u | cut -d ' ' -f 1 | uniq -c |
    awk '$1 == 3' | wc -l)
[ "$differ" -ge 18 ]
report $? "$differ structs are shorter in older headers, and longer in later ones"

run() { # folder of headers, name, options of the compiler
    "$cc" -std=c17 -Wall -Wextra -Werror ${3:+"$3"} -I"$1" -o "$work/program" tests/api/program.c -L"$build" -lkrs \
        >"$work/said" 2>&1 && LD_LIBRARY_PATH="$build" "$work/program" >"$work/$2" 2>>"$work/said"
    status=$?
    [ ! -e "$work/$2" ] || cat "$work/$2" >>"$work/said"
    return $status
}
run include now
report $? "a program with these headers is told what it asks"
run "$work/older" before && cmp "$work/now" "$work/before" >>"$work/said"
report $? "one that was compiled before is told the same"
run "$work/later" after -DLATER && cmp "$work/now" "$work/after" >>"$work/said"
report $? "one of later is, too, and cannot ask for what the library does not know"

# ---- old names ----

old() { # options of the compiler
    "$cc" -std=c17 -Wall -Wextra -Wpedantic "$@" -Iinclude -o "$work/old" tests/api/old_names.c -L"$build" -lkrs >"$work/said" 2>&1
}
old -Werror -DKRS_NO_DEPRECATION_WARNINGS && LD_LIBRARY_PATH="$build" "$work/old" >>"$work/said" 2>&1
report $? "a program with the names of 0.2 runs"
grep -oE '\b(krs_[a-z_]+|Krs[A-Za-z]+|KRS_[A-Z_]+)\b' tests/api/old_names.c | sort -u >"$work/used"
sed -n 's/^KRS_RENAMED(.*, *\(krs_[a-z_]*\), krs_.*/\1/p; s/^KRS_RENAMED_VOID(\(krs_[a-z_]*\),.*/\1/p
    s/^typedef .* \(Krs[A-Za-z]*\) *KRS_DEPRECATED.*/\1/p; s/^#define \(KRS_[A-Z_]*\) *KRS_M.*/\1/p' include/krs/deprecated*.h |
    sort -u >"$work/old_names"
[ "$(wc -l <"$work/old_names")" -ge 19 ] && comm -23 "$work/old_names" "$work/used" >"$work/said" && [ ! -s "$work/said" ]
report $? "it has all $(wc -l <"$work/old_names") of them"
old && grep -v '^#define' "$work/old_names" | grep -v '^KRS_[ML]' | while read -r name; do
    grep -q "warning: .*$name.* is deprecated: use " "$work/said" || echo "$name is not warned of"
done >"$work/silent"
mv "$work/silent" "$work/said"
[ ! -s "$work/said" ]
report $? "compilers warn of each, and say what to write"
! old -DKRS_NO_DEPRECATED
report $? "they are no names where nobody wants them"
exit $failed
