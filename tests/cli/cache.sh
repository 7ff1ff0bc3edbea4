#!/bin/sh
# cache.sh: compiled shaders are kept from run to run, and no picture shows it.
# shellcheck source-path=SCRIPTDIR
. "$(dirname "$0")/common.sh"
plan 26
export XDG_CACHE_HOME="$work/caches"
cache=$XDG_CACHE_HOME/krs

picture() { run render ball.krs --rays kernels --size 41x33 "$@"; }
# What is in a folder, with the numbers of the files: a file that is written again has another.
files() { (cd "$1" 2>/dev/null && stat -c '%n %i' -- *) | sort; }
count() { files "$1" | wc -l; }
# Milliseconds that the last run spent on SPIR-V, as --stats json has them.
spirv() { sed -n 's/.*"spirv": \([0-9.]*\).*/\1/p' out; }
# Whether nothing was said and the picture is the one without a cache.
silent() { [ "$status" -eq 0 ] && [ ! -s err ] && cmp -s "$1" without.exr; }

picture --cache off --quiet -o without.exr
[ "$status" -eq 0 ] && [ ! -e "$cache" ] && [ ! -e off ]
result $? "--cache off writes nothing"

picture --quiet --stats json -o a.exr
cold=$(spirv)
silent a.exr && [ "$(count "$cache")" -gt 0 ] &&
    [ "$(find "$cache" -name '*.spirv' | wc -l)" -eq "$(count "$cache")" ]
result $? "a render fills the cache"
files "$cache" >first
picture --quiet --stats json -o b.exr
silent b.exr && files "$cache" | cmp -s - first
result $? "the next one writes nothing and gives the same picture"
awk -v cold="$cold" -v warm="$(spirv)" 'BEGIN { exit !(warm < cold / 5) }'
result $? "it spends less than a fifth of the time on SPIR-V"
[ "$(stat -c %a "$cache")" = 700 ]
result $? "the folder is the user's alone"

picture --quiet --set radius=0.7 -o c.exr
[ "$status" -eq 0 ] && files "$cache" | cmp -s - first && ! cmp -s c.exr without.exr
result $? "another parameter compiles nothing"
picture --quiet --camera side -o c.exr
[ "$status" -eq 0 ] && files "$cache" | cmp -s - first
result $? "another camera compiles nothing"
picture --quiet --time 2 --samples 3 --seed 5 --crop 1,2,20,20 -o c.exr
[ "$status" -eq 0 ] && files "$cache" | cmp -s - first
result $? "time, samples, seed and crop compile nothing"
sed 's/sphere(radius)/sphere(radius) - box([1, 1, 1])/' ball.krs >other.krs
run render other.krs --rays kernels --size 41x33 --quiet -o c.exr
[ "$status" -eq 0 ] && [ "$(count "$cache")" -gt "$(wc -l <first)" ] &&
    [ "$(files "$cache" | comm -12 - first | wc -l)" -eq "$(wc -l <first)" ]
result $? "another scene has entries of its own"

# What is said about a scene beside it, and where it lies, is no part of what is compiled.
files "$cache" >others
mkdir -p elsewhere/deep
known() {
    run render "$1" --rays kernels --size 41x33 --quiet -o c.exr
    [ "$status" -eq 0 ] && files "$cache" | cmp -s - others
}
{ printf '// A comment, */ and /* another.\n\n/* several\nlines */\n'; cat other.krs; } >commented.krs
known commented.krs
result $? "a scene with comments in front compiles nothing"
cp other.krs renamed.krs && known renamed.krs
result $? "neither does one with another name"
cp other.krs elsewhere/deep/other.krs && known elsewhere/deep/other.krs
result $? "nor one in another folder"
odd=$(printf 'odd\nname') && cp other.krs "$odd.krs" && known "$odd.krs"
result $? "nor one with a line break in its name"

echo 'show field(y - 0.1 * sin(time * x)).within(box([2, 1, 2]));' >wave.krs
run render wave.krs --rays kernels --size 41x33 --quiet --time 1 -o one.exr
files "$cache" >waves
run render wave.krs --rays kernels --size 41x33 --quiet --time 9 -o nine.exr
[ "$status" -eq 0 ] && files "$cache" | cmp -s - waves && ! cmp -s one.exr nine.exr
result $? "slopes of other frames compile nothing"

# Damage of several kinds, each to every file.
files "$cache" >before
damage() {
    for file in "$cache"/*; do
        case $1 in
        emptied) : >"$file" ;;
        truncated) truncate -s -4 "$file" ;;
        lengthened) printf more >>"$file" ;;
        overwritten) printf '\377' | dd of="$file" bs=1 seek=70 conv=notrunc 2>/dev/null ;;
        replaced) head -c 5000 /dev/urandom >"$file" ;;
        esac
    done
}
for kind in emptied truncated lengthened overwritten replaced; do
    damage "$kind"
    picture --quiet -o d.exr
    silent d.exr
    healed=$?
    files "$cache" >after
    picture --quiet -o e.exr
    [ "$healed" -eq 0 ] && silent e.exr && files "$cache" | cmp -s - after &&
        [ "$(comm -13 before after | wc -l)" -eq "$(wc -l <first)" ]
    result $? "a cache whose files are $kind heals"
    run render other.krs --rays kernels --size 41x33 --quiet -o c.exr
    files "$cache" >before
done

picture --quiet --cache "$work/deep/down" -o f.exr
silent f.exr && [ "$(count "$work/deep/down")" -eq "$(wc -l <first)" ]
result $? "--cache names another folder"
run validate ball.krs --points 1024 --cache "$work/checked"
[ "$status" -eq 0 ] && [ "$(count "$work/checked")" -gt 0 ]
result $? "validate takes --cache"
picture --quiet --cache ''
said 2 "--cache wants a folder, or off" "a folder without a name"

# Folders where nothing can be kept: silently.
printf file >file
mkdir locked && chmod 555 locked
kept=0
for place in file file/krs /dev/null/krs /proc/self locked/krs; do
    picture --quiet --cache "$place" -o g.exr
    silent g.exr || kept=1
done
[ "$kept" -eq 0 ] && [ "$(cat file)" = file ]
result $? "folders that cannot be written are no mistake"
env -u XDG_CACHE_HOME -u HOME "$krs" render ball.krs --rays kernels --quiet --size 41x33 -o g.exr >out 2>err
status=$?
silent g.exr
result $? "neither is a user without a home"
(
    unset XDG_CACHE_HOME
    HOME=$work/home "$krs" render ball.krs --rays kernels --quiet --size 41x33 -o g.exr >out 2>err
)
status=$?
silent g.exr && [ "$(count "$work/home/.cache/krs")" -eq "$(wc -l <first)" ]
result $? "without XDG_CACHE_HOME it is in the home"
(
    XDG_CACHE_HOME=relative
    HOME=/proc/self "$krs" render ball.krs --rays kernels --quiet --size 41x33 -o g.exr >out 2>err
)
status=$?
silent g.exr && [ ! -e relative/krs ]
result $? "a relative XDG_CACHE_HOME does not count"
