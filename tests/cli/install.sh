#!/bin/sh
# install.sh: what `make install` puts where, that a program outside can be built from it, and that
# `make uninstall` takes it all away.  Nothing is compiled but that program.
# shellcheck source-path=SCRIPTDIR
. "$(dirname "$0")/common.sh"
plan 17

# B as the tests have it: the folder of the command.
build=$(dirname "$krs")
make_it() { # words
    (cd "$root" && make --no-print-directory B="$build" "$@") >out 2>err
    status=$?
}

make_it install PREFIX=/usr DESTDIR="$work/stage"
ended 0 "make install"
(cd stage && find . -type f -o -type l | sort) >files
version=$("$krs" --version | sed -n 's/^krs \([0-9.]*\).*/\1/p')
commands=$(sed -n 's/^COMMAND([A-Z]*, "\([a-z]*\)".*/\1/p' "$root/cli/options/commands.def")
{
    for file in bin/krs lib/libkrs.a lib/libkrs.so "lib/libkrs.so.$version" "lib/libkrs.so.${version%.*}" lib/pkgconfig/krs.pc include/krs.h include/krs_vulkan.h include/krs_camera.h \
        share/bash-completion/completions/krs share/zsh/site-functions/_krs \
        share/fish/vendor_completions.d/krs.fish share/man/man1/krs.1; do
        echo "./usr/$file"
    done
    (cd "$root" && find include/krs -type f) | sed 's,^,./usr/,'
    for command in $commands; do echo "./usr/share/man/man1/krs-$command.1"; done
    for file in applications/krs.desktop icons/hicolor/scalable/apps/krs.svg metainfo/krs.metainfo.xml \
        mime/packages/krs.xml thumbnailers/krs.thumbnailer; do
        echo "./usr/share/$file"
    done
    [ ! -e "$build/krs-vdb.so" ] || echo ./usr/lib/krs/krs-vdb.so
} | sort >wanted
cmp -s files wanted
result $? "these files and no others, under DESTDIR"
[ -d stage/usr ] && ! grep -rqI "$work" stage
result $? "DESTDIR stands in none of them"

# ---- the manual ----
missing=""
for command in $commands; do
    page=stage/usr/share/man/man1/krs-$command.1
    [ -s "$page" ] || break
    "$krs" help "$command" --all >page.help
    sed -n 's/^    \(-[a-z], \)\{0,1\}--\([a-z-]*\).*/\2/p' page.help >options
    sed -n 's/^\([A-Z].*\):$/\1/p' page.help >headings
    sed -n 's/^\.SS //p' "$page" | cmp -s - headings || missing="$missing headings:$command"
    while read -r option; do
        escaped=$(echo "--$option" | sed 's/-/\\-/g')
        grep -qF -- "$escaped" "$page" || missing="$missing $option"
    done <options
    grep -q "krs.-$command" stage/usr/share/man/man1/krs.1 || missing="$missing $command"
done
[ -z "$missing" ] && [ -n "$commands" ] && [ -s "$page" ]
result $? "the manual has each command, and each option under its heading$missing"
if command -v man >/dev/null; then
    for page in stage/usr/share/man/man1/*.1; do
        MANWIDTH=80 man -l --warnings "$page" >>pages 2>>warnings
    done
    [ ! -s warnings ] && grep -q 'try to refute' pages
    result $? "man reads the pages without a warning"
else
    skip "man reads the pages without a warning" "no man"
fi

# ---- completion ----
complete_line() { # words of a line, the last to be completed
    bash -c '. stage/usr/share/bash-completion/completions/krs
        COMP_WORDS=("$@") COMP_CWORD=$(($# - 1)); _krs; printf "%s\n" "${COMPREPLY[@]}"' line "$@"
}
touch ball.vm
if command -v bash >/dev/null; then
    [ "$(complete_line krs ren)" = render ] &&
        [ "$(complete_line krs render --sam)" = --samples ] &&
        [ "$(complete_line krs render --tone-map ac)" = aces ] &&
        [ "$(complete_line krs render ba)" = ball.krs ] &&
        [ "$(complete_line krs import ba)" = ball.vm ] &&
        [ -z "$(complete_line krs devices ba)" ] &&
        [ "$(complete_line krs explain E0203)" = E0203 ] &&
        [ "$(complete_line krs help val)" = validate ] &&
        [ -z "$(complete_line krs check --samp)" ]
    result $? "bash completes commands, options, their values and files"
else
    skip "bash completes commands, options, their values and files" "no bash"
fi

# What a command's page of help says, as the files for zsh and fish have it.
zsh=stage/usr/share/zsh/site-functions/_krs fish=stage/usr/share/fish/vendor_completions.d/krs.fish
missing=""
for command in $commands; do
    "$krs" help "$command" --all >page
    sed -n 's/^    \(-[a-z], \)\{0,1\}--\([a-z-]*\).*/\2/p' page | sort >options
    sed -n "/^$command)/,/;;\$/p" $zsh | sed -n "s/.*--\([a-z-]*\)[=}[].*/\1/p" | sort >in_zsh
    sed -n "s/.*seen_subcommand_from $command' -l \([a-z-]*\).*/\1/p" $fish | sort >in_fish
    cmp -s options in_zsh || missing="$missing zsh:$command"
    cmp -s options in_fish || missing="$missing fish:$command"
    grep -q "^    '$command:" $zsh || missing="$missing zsh:$command"
    grep -q "use_subcommand -a $command -d" $fish || missing="$missing fish:$command"
done
[ -z "$missing" ] && [ -s options ]
result $? "zsh and fish have each command and each option$missing"
grep -qF ':(neutral aces agx none)' $zsh && grep -qF "tone-map -x -a 'neutral aces agx none'" $fish &&
    grep -qF '_files -g "*.jsurf *.vm ' $zsh && grep -qF '(__fish_complete_suffix .vm)' $fish &&
    grep -q '1:code:(.*E0203' $zsh && grep -q "from explain' -a '.*E0203" $fish &&
    grep -q '1:command:(render ' $zsh && grep -q "from help' -a 'render " $fish
result $? "and values, files and codes"
if command -v zsh >/dev/null; then
    zsh -n $zsh >out 2>err && [ ! -s err ]
    result $? "zsh reads its file"
else
    skip "zsh reads its file" "no zsh"
fi
if command -v fish >/dev/null; then
    fish_line() { fish -c "source $fish; complete -C '$1'" | cut -f 1; }
    [ "$(fish_line 'krs ren')" = render ] && [ "$(fish_line 'krs render --sam')" = --samples ] &&
        [ "$(fish_line 'krs render --tone-map a')" = aces ] &&
        [ "$(fish_line 'krs import ba' | head -n 1)" = ball.vm ] &&
        [ "$(fish_line 'krs explain E0203')" = E0203 ] && [ -z "$(fish_line 'krs check --samp')" ]
    result $? "fish completes as bash does"
else
    skip "fish completes as bash does" "no fish"
fi
run --completion tcsh
said 2 "bash, zsh and fish" "no other shell"

# ---- a program outside ----
make_it install PREFIX="$work/usr"
ended 0 "make install for use"
export PKG_CONFIG_PATH="$work/usr/lib/pkgconfig"
if command -v pkg-config >/dev/null; then
    awk '/^```/ { inside = !inside; block += inside; next }
         inside && block == 1 { print > "outside.c" }
         inside && block == 2 { print > "expected" }' "$root/docs/library.md"
    # The names of before, which programs may still use.
    printf '#include <%s.h>\n' krs krs_camera krs_vulkan >vulkan.c
    echo 'KrsStatus (*function)(void) = (KrsStatus (*)(void))krs_render;' >>vulkan.c
    echo 'void (*turn)(KrsCamera *, double, double) = krs_camera_orbit;' >>vulkan.c
    # shellcheck disable=SC2046 # words are meant
    ${CC:-cc} -std=c17 -Wall -Werror $(pkg-config --cflags krs) outside.c vulkan.c \
        $(pkg-config --libs krs) -o outside >out 2>err && LD_LIBRARY_PATH="$work/usr/lib" ./outside >printed 2>err &&
        cmp -s printed expected
    result $? "the program of docs/library.md, built by krs.pc, prints what it says there"
    # shellcheck disable=SC2046 # words are meant
    ${CC:-cc} -std=c17 -Wall -Werror $(pkg-config --cflags krs) outside.c vulkan.c \
        $(pkg-config --static --libs krs | sed 's/-lkrs/-l:libkrs.a/') -o outside >out 2>err && ./outside >printed 2>err &&
        cmp -s printed expected
    result $? "and linked with the archive it needs nothing that is installed"
    [ "$(pkg-config --modversion krs)" = "$version" ]
    result $? "krs.pc has the version"
else
    skip "the program of docs/library.md, built by krs.pc" "no pkg-config"
    skip "and linked with the archive it needs nothing that is installed" "no pkg-config"
    skip "krs.pc has the version" "no pkg-config"
fi
"$work/usr/bin/krs" check ball.krs >out 2>err
status=$?
ended 0 "the installed command works"

make_it uninstall PREFIX=/usr DESTDIR="$work/stage"
[ -d stage/usr ] && [ -z "$(find stage -type f)" ]
result $? "make uninstall takes all of it away"
