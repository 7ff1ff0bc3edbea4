#!/bin/sh
# lint.sh: every kernel is GLSL by itself, every script passes shellcheck, and all C has the style of
# .clang-format (`make format` brings it about).  Another version of clang-format has other tastes.
cd "$(dirname "$0")/.." || exit 1
failed=0
report() { # name, status
    if [ "$2" -eq 0 ]; then echo "ok - $1"; else echo "not ok - $1"; failed=1; fi
}
for kernel in runtime/shaders/*.comp; do
    glslangValidator -V --target-env vulkan1.1 -Iruntime/shaders -Icompiler/print/glsl -o /dev/null "$kernel" >/dev/null
    report "$kernel is valid GLSL" $?
    glslangValidator -V --target-env vulkan1.1 -Iruntime/shaders -Icompiler/print/glsl -DNO_TEXELS \
        -o /dev/null "$kernel" >/dev/null
    report "$kernel is valid GLSL without texels" $?
    glslangValidator -V --target-env vulkan1.1 -Iruntime/shaders -Icompiler/print/glsl -DSUBGROUPS \
        -o /dev/null "$kernel" >/dev/null
    report "$kernel is valid GLSL with sums of subgroups" $?
done
for script in tools/*.sh tests/*.sh tests/*/*.sh .ci/run; do
    shellcheck -x -P SCRIPTDIR "$script"
    report "$script passes shellcheck" $?
done
formatted=$(find bench cli compiler runtime tests -name '*.[ch]' -o -name '*.cpp')
# shellcheck disable=SC2086 # the list is words
clang-format-14 --dry-run --Werror $formatted
report "C has the style of .clang-format" $?
exit $failed
