#!/bin/sh
# layers.sh: each folder may include itself and the folders before it in this list; of the
# compiler, the runtime and the command may see only its api.  The public headers (types and
# prototypes for everybody) may be included by the half that they belong to.
#
# Units (NAME.c with NAME.h) do not include each other in circles.  A folder with a page (README.md) is
# small enough to be read: it has 30 sources at most, and the page 40 lines.
set -u
cd "$(dirname "$0")/.." || exit 1
layers="compiler/base compiler/image compiler/outline compiler/graph compiler/graph/bounds compiler/graph/lanes compiler/graph/rewrite compiler/graph/symbolic compiler/graph/instances compiler/shape compiler/lower compiler/lower/research compiler/family compiler/front
        compiler/eval compiler/eval/declared compiler/eval/view compiler/eval/data compiler/eval/hulls compiler/eval/builtins compiler/print compiler/print/glsl compiler/print/essl compiler/print/wgsl compiler/target compiler/scene compiler/passes compiler/refute compiler/field compiler/service
        mesh/common mesh/contour mesh/proof mesh/flat mesh/simplify mesh slice grid measure denoise rays export
        platform/linux platform/web web/letters web/core
        runtime/device runtime/shared runtime/tracer/research runtime/tracer runtime/integrators runtime/film runtime/display
        runtime/writer runtime api import/common import/csg import/surfer import/pov import profile live/text live/pictures live/window live cli/options cli/pack cli/sandbox cli/shell cli/picture cli/farm cli/mesh cli/grid cli/slice cli/denoise cli/lsp cli site"
public="include/krs/krs.h include/krs/camera.h include/krs/mesh.h include/krs/slice.h include/krs/grid.h
        include/krs/measure.h include/krs/light.h include/krs/surface.def include/krs/choices.def include/krs/camera.def include/krs/lights.def
        include/krs/light_types.def include/krs/targets.def"
api="include/krs/ compiler/base/ compiler/passes/compile.h compiler/passes/passes.def compiler/service/service.h compiler/print/variant.h compiler/target/spirv.h rays/rays.h rays/surfaces.h denoise/denoise.h export/export.h export/targets.def"

work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT

# "FILE HEADER", both from the repository's root.
for layer in include/krs $layers; do
    for ending in c h cpp def; do
        grep -H '^ *# *include *"' "$layer"/*.$ending 2>/dev/null
    done
done | sed 's/ *# *include *"//; s/".*//; s/:/ /; s, krs/, include/krs/,' >"$work/includes"

# Whether a header is one of the files, or in one of the folders (with a slash at the end).
allowed() { # header, files and folders
    for place in $2; do
        [ "$1" = "$place" ] && return 0
        case $place in
        */) [ "${1%/*}/" = "$place" ] && return 0 ;;
        esac
    done
    return 1
}

echo "1..$(echo "$layers public driver circles pages" | wc -w)"
places=$public number=0 bad=0

result() { # what is wrong, or nothing; what was looked at
    number=$((number + 1))
    if [ -z "$1" ]; then
        echo "ok $number - $2"
    else
        echo "not ok $number - $2"
        printf '%s\n' "$1" | sed '/^$/d; s/^/# /'
        bad=1
    fi
}

# ---- layers ----

# The folders that a folder includes headers of, and how many lines it has.
describe() { # folder
    others=$(awk -v here="$1" '{ from = $1; to = $2; sub(/\/[^\/]*$/, "", from)
                                 sub(/\/[^\/]*$/, "", to)
                                 if (from == here && to != here) print to }' "$work/includes" |
        sort | uniq -c | awk '{ printf "%s%s %d", separator, $2, $1; separator = ", " }')
    files=$(find "$1" -maxdepth 1 -name '*.[ch]' -o -maxdepth 1 -name '*.cpp' \
        -o -maxdepth 1 -name '*.def')
    # shellcheck disable=SC2086 # a list of names without blanks
    echo "# $(cat $files | wc -l) lines in $(echo "$files" | wc -l) files; includes: ${others:-nothing}"
}

for layer in $layers; do
    [ "$layer" = runtime/device ] && places=$api
    places="$places $layer/"
    wrong=$(while read -r file header; do
        [ "${file%/*}" != "$layer" ] || allowed "$header" "$places" ||
            echo "$file: $layer must not know $header"
    done <"$work/includes")
    result "$wrong" "$layer"
    describe "$layer"
done

# ---- public headers ----

result "$(grep '^include/' "$work/includes" | grep -v ' include/krs/')" "public headers include each other alone"

# ---- driver ----

# Who includes Vulkan, or a header of runtime/device that does.  The command prints the loader's version.
result "$(for layer in $layers; do
    case $layer in runtime/device | cli) continue ;; esac
    grep -HE '^ *# *include *(<vulkan/|"runtime/device/(driver|instance|pipelines)\.h")' "$layer"/*.[ch] 2>/dev/null
done)" "runtime/device alone knows Vulkan"

# ---- circles ----

awk '{ for (i = 1; i <= 2; i++) sub(/\.(c|h|cpp)$/, "", $i) } $1 != $2' "$work/includes" |
    sort -u >"$work/units"

# What stands in a circle, or nothing.
result "$(tsort "$work/units" 2>&1 >/dev/null | sed 's/^tsort: //')" \
    "units do not include each other in circles"

# ---- pages ----

result "$(for layer in $layers; do
    [ -f "$layer/README.md" ] || continue
    [ "$(wc -l <"$layer/README.md")" -le 40 ] || echo "$layer/README.md has more than 40 lines"
    [ "$(find "$layer" -maxdepth 1 -name '*.c' | wc -l)" -le 30 ] || echo "$layer has more than 30 sources"
done)" "folders with a page have at most 30 sources, and the page 40 lines"
exit $bad
