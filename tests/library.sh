#!/bin/sh
# library.sh: the program in docs/library.md compiles, against the library as it is, and prints
# what the page says; and so do the parts of programs that load files and that ask a device.
cd "$(dirname "$0")/.." || exit 1
build=${B:-build}
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT
failed=0
echo "1..5"
report() { # status, number and name
    [ "$1" -eq 0 ] && echo "ok $2" && return
    echo "not ok $2"
    failed=1
    sed 's/^/# /' "$work/said"
}
# The blocks between fences: which one, of which language.
block() {
    awk -v number="$1" -v fence="\`\`\`$2" '
        $0 == "```" && inside { inside = 0; next }
        $0 == "```" || /^```./ { inside = 1; chosen = $0 == fence && ++count == number; next }
        inside && chosen' docs/library.md
}
compile() { # source
    # shellcheck disable=SC2086 # many words
    ${CC:-cc} -std=c17 -Wall -Wextra -Wpedantic -Werror -Iinclude -o "$work/program" "$1" \
        "$build/libkrs.a" $libs
}
libs=$(make --no-print-directory B="$build" libs)

block 1 c >"$work/example.c"
block 1 "" >"$work/expected"
compile "$work/example.c" >"$work/said" 2>&1
report $? "1 - the program of the page compiles"
"$work/program" >"$work/said" 2>&1 && [ -s "$work/expected" ] &&
    cmp -s "$work/said" "$work/expected"
report $? "2 - and prints what the page says"
{
    echo '#include <stdio.h>'
    echo '#include <krs/vulkan.h>'
    echo 'int main(void) {'
    echo 'KrsScene *scene; KrsState *state; KrsHit hits[1]; size_t count = 1;'
    echo 'const double origins[1][3] = {{0, 0, 9}}, directions[1][3] = {{0, 0, -1}};'
    echo 'if (krs_compile_text("show sphere(1);", 15, "a", NULL, &scene) != KRS_OK) return 2;'
    echo 'if (krs_state_new(scene, &state) != KRS_OK) return 2;'
    block 6 c
    echo 'return !(hits[0].hit && hits[0].t > 7.99 && hits[0].t < 8.01); }'
} >"$work/device.c"
compile "$work/device.c" >"$work/said" 2>&1 && "$work/program" >"$work/said" 2>&1
report $? "3 - a device answers as the page asks it"
{
    echo '#include <stdio.h>'
    echo '#include <stdlib.h>'
    echo '#include <krs/krs.h>'
    echo 'int main(void) {'
    echo 'KrsScene *scene; KrsState *state; double seconds = 2.5;'
    echo 'if (krs_compile_text("show sphere(1);", 15, "a", NULL, &scene) != KRS_OK) return 2;'
    echo 'if (krs_state_new(scene, &state) != KRS_OK) return 2;'
    block 4 c
    cat <<'END'
puts("layout(local_size_x = 1) in;\n"
     "layout(std430, set = 1, binding = 0) buffer Found { float found; };\n"
     "void main() { krs_prepare(); found = krs_distance(vec3(found)); }");
END
    echo 'return !(block[0][0] == 2.5f); }'
} >"$work/block.c"
compile "$work/block.c" >"$work/said" 2>&1 && "$work/program" >"$work/engine.comp" 2>"$work/said" &&
    grep -q '^// a light towards ' "$work/engine.comp" && glslangValidator -V "$work/engine.comp" -o /dev/null >"$work/said"
report $? "4 - an engine gets text, lights and parameters of the library alone"
{
    echo '#include <krs/krs.h>'
    echo 'typedef struct Archive { const char *text; } Archive;'
    echo 'static const char *archive_find(const Archive *a, const char *path, size_t *length)'
    echo '{ (void)path; *length = 15; return a->text; }'
    block 5 c | sed 's/^KrsOptions options = .*/Archive in = {"let radius = 1;"}, *archive = \&in;\nint main(void) {\n&/'
    echo 'KrsScene *scene; const char text[] = "use \"a.krs\"; show sphere(radius);";'
    echo 'return krs_compile_text(text, sizeof text - 1, "b", &options, &scene) != KRS_OK; }'
} >"$work/loader.c"
compile "$work/loader.c" >"$work/said" 2>&1 && "$work/program" >"$work/said" 2>&1
report $? "5 - files are loaded as the page says"
exit $failed
