#!/bin/sh
# layers.sh: each folder may include itself and the folders before it in this list; of the
# compiler, the runtime and the command may see only its api.  The installed headers (types
# and prototypes for everybody) may be included by the half that they belong to.
set -u
cd "$(dirname "$0")/.." || exit 1
layers="compiler/base compiler/front compiler/graph compiler/geometry compiler/print
        compiler/print/glsl compiler/target compiler
        runtime/device runtime/shared runtime/tracer runtime/film runtime/writer runtime cli"
api="compiler/base/ compiler/compile.h compiler/krs.h compiler/print/variant.h compiler/target/spirv.h
          runtime/krs_vulkan.h runtime/planes.def runtime/choices.def"

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

echo "1..$(echo "$layers" | wc -w)"
places="compiler/krs.h" number=0 bad=0
for layer in $layers; do
    number=$((number + 1))
    [ "$layer" = runtime/device ] && places=$api
    places="$places $layer/"
    wrong=""
    for hit in $(grep -Hn '^ *# *include *"' "$layer"/*.c "$layer"/*.h "$layer"/*.cpp \
        "$layer"/*.def 2>/dev/null | tr -d ' '); do
        header=${hit#*include\"}
        header=${header%%\"*}
        allowed "$header" "$places" ||
            wrong="$wrong# ${hit%%:#*}: $layer must not know $header
"
    done
    if [ -z "$wrong" ]; then
        echo "ok $number - $layer"
    else
        echo "not ok $number - $layer"
        printf '%s' "$wrong"
        bad=1
    fi
done
exit $bad
