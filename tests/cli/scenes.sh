#!/bin/sh
# scenes.sh: scenes that cannot be read, or are wrong, end in the right status and a diagnostic.
# shellcheck source-path=SCRIPTDIR
. "$(dirname "$0")/common.sh"
plan 39

run check missing.krs
said 74 "cannot read \`missing.krs\`: No such file or directory" "a missing file"
run check .
said 74 "Is a directory" "a folder"
: >empty.krs
run check empty.krs
said 0 "W0401" "an empty file shows nothing"
head -c 4096 /dev/urandom >binary.krs
run check binary.krs
said 1 "error[E01" "a binary file"
printf 'show sphere(1);\0show sphere(2);' >nul.krs
run check nul.krs
said 1 "error[E01" "a NUL byte"

wrong() { # code, text, what
    printf '%s\n' "$2" >wrong.krs
    run check wrong.krs
    said 1 "error[$1]" "$3"
}
wrong E0103 'show sphere(1' 'a parenthesis that is not closed'
wrong E0103 'camera { eye: [0, 0, 5]' 'a block that is not closed'
wrong E0103 '/* nothing' 'a comment that is not closed'
wrong E0103 'use "std/trees.krs' 'a string that is not closed'
wrong E0201 'show spere(1);' 'an unknown name'
wrong E0501 'use "nowhere.krs"; show sphere(1);' "a missing \`use\` is the scene's mistake"

run check wrong.krs ball.krs missing.krs
said 1 "missing.krs" "all files are checked, the first failure is the status"
run check ball.krs
[ "$status" -eq 0 ] && [ ! -s out ] && [ ! -s err ]
result $? "a scene without mistakes is silent"

printf 'show spere(1);\n' >wrong.krs
run check --diagnostics json wrong.krs
[ "$status" -eq 1 ] && [ ! -s out ] && grep '^{' err | is_json && grep -q '"code":"E0201"' err
result $? "diagnostics as JSON"
# In a library, behind a letter of two bytes and one of two UTF-16 units: the text counts letters from 1,
# JSON counts lines and UTF-16 units from 0.
printf 'def ball(r) =\n    /* \303\251\360\237\230\200 */ assert(r > 0, "a radius of", r) in\n    sphere(r);\n' \
    >library.krs
printf 'use "library.krs";\n\n\tshow /* \360\237\230\200 */ ball(-1);\r\n' >asserts.krs
run check asserts.krs
[ "$status" -eq 1 ] && grep -q '^error\[E0315\]: a radius of -1$' err &&
    grep -q -- '--> library.krs:2:21$' err && grep -q '::: asserts.krs:3:15$' err
result $? "an assertion of a library is told with its place, and that of the call"
for command in check render info query mesh; do
    run "$command" --diagnostics json asserts.krs
    [ "$status" -eq 1 ] && [ ! -s out ] && grep '^{' err | is_json &&
        grep -q '"uri":"library.krs","range":{"start":{"line":1,"character":21},"end":{"line":1,"character":26}}' err &&
        grep -q '"uri":"asserts.krs","range":{"start":{"line":2,"character":15},"end":{"line":2,"character":23}}' err
    result $? "$command tells both places as JSON"
done
run check --color always wrong.krs
[ "$status" -eq 1 ] && grep -q "$(printf '\033')" err
result $? "diagnostics in colour"
NO_COLOR=1 "$krs" check wrong.krs >out 2>err
status=$?
[ "$status" -eq 1 ] && ! grep -q "$(printf '\033')" err
result $? "no colour when it is not wanted"
run check --quiet empty.krs
[ "$status" -eq 0 ] && [ ! -s err ]
result $? "--quiet says no warning"

for command in render info query validate; do
    run "$command" wrong.krs
    said 1 "error[E0201]" "$command refuses a wrong scene"
done

head -c 17000000 /dev/zero >huge.krs
run check huge.krs
said 1 "huge.krs:1:1" "a file that is too large"
{ head -c 100000 /dev/zero | tr '\0' a; printf ' = 1;\n'; } >long.krs
run check long.krs
[ "$status" -eq 1 ] && [ "$(wc -L <err)" -lt 500 ]
result $? "a message about a long name is short"
printf '\357\273\277show sphere(1);\r\n\r\nshow spere(1);\r\n' >windows.krs
run check windows.krs
said 1 "windows.krs:3:6" "a byte order mark and line ends of two bytes"
awk 'BEGIN { printf "show sphere("; for (i = 0; i < 100000; i++) printf "(";
             printf "1"; for (i = 0; i < 100000; i++) printf ")"; print ");" }' >deep.krs
run check deep.krs
said 1 "error[E0105]" "a hundred thousand parentheses"

# ---- what is no scene at all ----

ln -s loop.krs other.krs && ln -s other.krs loop.krs
run check loop.krs
said 74 "Too many levels of symbolic links" "links in a circle"
run check /dev/zero
said 1 "longer than 16 MiB" "a device that has no end"
# Reading takes a fifth of a second; strings are kept, and need memory.
while read -r count byte name; do
    head -c "$count" /dev/zero | tr '\0' "$byte" >same.krs
    (
        # shellcheck disable=SC3045 # dash, bash and ksh have it
        ulimit -t 1
        "$krs" check same.krs >out 2>err
    )
    status=$?
    ended 1 "$count $name are refused in a second"
done <<'END'
16000000 \0 NUL bytes
16000000 \377 bytes 255
16000000 ? question marks
1500000 " quotes
1500000 ' single quotes
END
mkfifo pipe.krs
timeout -s KILL 20 "$krs" check --deadline 0.2 pipe.krs >out 2>err
status=$?
said 1 "gave up" "a pipe that nobody writes to is given up, and not kept"
