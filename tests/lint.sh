#!/bin/sh
# lint.sh: every shader is GLSL by itself, every script passes shellcheck, and all C has the style of
# .clang-format (`make format` brings it about).
# Names files of more than 700 lines, which is no failure; none is larger than a megabyte.
cd "$(dirname "$0")/.." || exit 1
failed=0
report() { # name, status
    if [ "$2" -eq 0 ]; then echo "ok - $1"; else echo "not ok - $1"; failed=1; fi
}
for kernel in runtime/shaders/*.comp runtime/shaders/research/*.comp; do
    glslangValidator -V --target-env vulkan1.1 -I. -Iinclude -Iruntime/shaders -Icompiler/print/glsl -o /dev/null "$kernel" >/dev/null
    report "$kernel is valid GLSL" $?
    glslangValidator -V --target-env vulkan1.1 -I. -Iinclude -Iruntime/shaders -Icompiler/print/glsl -DNO_TEXELS \
        -o /dev/null "$kernel" >/dev/null
    report "$kernel is valid GLSL without texels" $?
    glslangValidator -V --target-env vulkan1.1 -I. -Iinclude -Iruntime/shaders -Icompiler/print/glsl -DFRAME_TEXELS \
        -o /dev/null "$kernel" >/dev/null
    report "$kernel is valid GLSL with the frame as texels" $?
    glslangValidator -V --target-env vulkan1.1 -I. -Iinclude -Iruntime/shaders -Icompiler/print/glsl -DSUBGROUPS \
        -o /dev/null "$kernel" >/dev/null
    report "$kernel is valid GLSL with sums of subgroups" $?
    glslangValidator -V --target-env vulkan1.1 -I. -Iinclude -Iruntime/shaders -Icompiler/print/glsl -DPANORAMIC -DLENS \
        -o /dev/null "$kernel" >/dev/null
    report "$kernel is valid GLSL with lenses" $?
done
# Emitted text is GLSL as it is pasted, without directives (every variant: tests/unit/texts.c); so is
# every file of helpers.
pasted=$(mktemp) && trap 'rm -f "$pasted"' EXIT
for text in tests/golden/*.glsl; do
    {
        printf '#version 440\nlayout(local_size_x = 1) in;\n'
        cat "$text"
        printf 'layout(std430, set = 1, binding = 0) buffer Found { float found; };\n'
        printf 'void main()\n{\n    krs_prepare();\n    vec3 p = vec3(found);\n'
        printf '    found = krs_distance(p) + krs_surface(p, p, 0.0).roughness;\n}\n'
    } >"$pasted"
    glslangValidator -V --target-env vulkan1.1 --stdin -S comp -o /dev/null <"$pasted" >/dev/null
    report "$text can be pasted" $?
    ! grep -q '^ *#' "$text"
    report "$text has no directives" $?
done
for helpers in compiler/print/glsl/*.glsl; do
    {
        printf '#version 440\nlayout(local_size_x = 1) in;\n'
        case $helpers in
        */cells.glsl) cat compiler/print/glsl/arcs.glsl compiler/print/glsl/sines.glsl ;;
        */instances.glsl | */textures.glsl) # what glsl.c declares where they are called
            sed -n '/TEMPLATE_BUFFER_TABLES\]/,/TEMPLATE_TABLES\]/d;/TEMPLATE_TEXEL_TABLES\]/,/TEMPLATE_EACH_LISTED/{/TEMPLATE_/d;s/^[^"]*"//;s/\(\\n\)*",*$//;p;}' \
                compiler/print/glsl/glsl.c ;;
        */differences.glsl) echo "float krs_distance_N(vec3 p) { return p.x; }" ;;
        esac
        cat "$helpers"
        printf 'void main() {}\n'
    } >"$pasted"
    glslangValidator -V --target-env vulkan1.1 --stdin -S comp -o /dev/null <"$pasted" >/dev/null
    report "$helpers is valid GLSL" $?
done
# SC2319: where `[` comes before `result $?`, its status is what is meant.
for script in tools/*.sh tests/*.sh tests/*/*.sh web/*/*.sh .ci/run; do
    shellcheck -e SC2319 -x -P SCRIPTDIR "$script"
    report "$script passes shellcheck" $?
done
# What has an interpreter is run by its name.
not_run=$(git grep -lI '^#!' -- '*.sh' '*.py' .ci | while read -r script; do
    head -n 1 "$script" | grep -q '^#!' && [ ! -x "$script" ] && echo "$script"
done)
[ -z "$not_run" ]
status=$?
[ $status -eq 0 ] || echo "$not_run" | sed 's/^/# cannot be run: /'
report "scripts can be run" $status
# The patches of what should be easy to add fit the sources; tests/extend/extend.sh builds them.
for change in tests/extend/*.patch; do
    patch -p1 -F0 --dry-run -s <"$change"
    report "$change can be applied" $?
done
# Every program of a test is in a list of tests.mk.
listed=$(make -s list-programs | tr ' ' '\n')
unlisted=$(grep -lE '^int main' tests/*/*.c | sed 's/\.c$//' | grep -vE '^tests/(api|cli|golden|web)/|_fuzz$' |
    grep -vxF "$listed")
[ -n "$listed" ] && [ -z "$unlisted" ]
status=$?
[ $status -eq 0 ] || echo "$unlisted" | sed 's/^/# no list has it: /'
report "every program of a test is run" $status
formatted=$(find api bench cli compiler denoise examples export grid import include live measure mesh platform rays runtime site slice tests web -name '*.[ch]' -o -name '*.cpp')
# The style is that of version 14; what others think of it is heard only where they agree.
styled() { # the command
    # shellcheck disable=SC2086 # the list is words
    "$1" --dry-run --Werror $formatted
}
style="C has the style of .clang-format"
version=$(clang-format --version 2>/dev/null | sed 's/.*version \([0-9]*\).*/\1/')
if [ "$version" = 14 ]; then
    styled clang-format
    report "$style" $?
elif command -v clang-format-14 >/dev/null; then
    styled clang-format-14
    report "$style" $?
elif [ -n "$version" ] && styled clang-format 2>/dev/null; then
    report "$style" 0
else
    echo "ok - $style # SKIP clang-format ${version:-of no version} has other tastes than 14"
fi
# A file of more than 700 lines may have two subjects: look whether it has.
find Makefile .ci api bench cli compiler denoise export grammar grid import include live measure mesh platform python rays runtime site slice tests tools web -name results -prune -o \
    -type f ! -path 'tests/golden/*.glsl' \( -name Makefile -o -name run -o -name '*.[ch]' \
    -o -name '*.cpp' -o -name '*.def' -o -name '*.glsl' -o -name '*.comp' -o -name '*.sh' \
    -o -name '*.mk' -o -name '*.py' \) -exec wc -l {} + |
    awk '$1 > 700 && $2 != "total" { print "# warning: " $2 " has " $1 " lines" }' | sort
# Who clones the project gets each file that was ever in it: what programs wrote has no place there.
heavy=$(git ls-files -z | xargs -0 du -k | awk '$1 > 1024 { print $2 }')
[ -z "$heavy" ]
status=$?
[ $status -eq 0 ] || echo "$heavy" | sed 's/^/# more than a megabyte: /'
report "no file of the project is larger than a megabyte" $status
exit $failed
