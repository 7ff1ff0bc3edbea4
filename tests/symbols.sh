#!/bin/sh
# symbols.sh: what of the library can be seen by who links it.  Archive and shared library define what the
# public headers declare, and nothing else; the command lends no name of its own to its libraries; a
# program that has its own use for names of ours, or wants those of the C library, gets them.
cd "$(dirname "$0")/.." || exit 1
build=${B:-build}
cc=${CC:-cc}
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT
failed=0
number=0
echo "1..13"
report() { # status, name
    number=$((number + 1))
    [ "$1" -eq 0 ] && echo "ok $number - $2" && return
    echo "not ok $number - $2"
    failed=1
    head -n 20 "$work/said" | sed 's/^/# /'
}
skip() { # name, why
    number=$((number + 1))
    echo "ok $number - $1 # SKIP $2"
}
make --no-print-directory B="$build" "$build/libkrs.a" "$build/libkrs.so" >"$work/said" 2>&1
report $? "archive and shared library are there"

# Names that others can link with, a line each, weak ones too.
defined() { # options of nm, files
    nm --defined-only "$@" 2>/dev/null | awk 'NF == 3 && $2 ~ /^[A-Zuvw]$/ { sub(/@.*/, "", $3); print $3 }' |
        sort -u
}
# What the headers declare: functions and tables.  One that there is for structs of any size is not linked by its own name.
for header in krs camera vulkan; do
    printf '#include <krs/%s.h>\n' "$header"
done >"$work/headers.c"
"$cc" -std=c17 -DKRS_NO_DEPRECATED -Iinclude -E -P "$work/headers.c" | grep -o '\bkrs_[a-z0-9_]* *[[(]' | sed 's/ *[[(]//' |
    sort -u >"$work/declared"
sed -n 's/_sized$//p' "$work/declared" | sort | comm -23 "$work/declared" - >"$work/api"

# These names are the linker's, not ours.
linkers='^(_init|_fini|_start|_end|_edata|__bss_start|_DYNAMIC|_GLOBAL_OFFSET_TABLE_)$'
[ "$(wc -l <"$work/api")" -gt 80 ]
report $? "the headers declare $(wc -l <"$work/api") names"
defined -g "$build/libkrs.a" | diff "$work/api" - >"$work/said"
report $? "the archive defines these and no others"
defined -D "$build/libkrs.so" | grep -vE "$linkers" | diff "$work/api" - >"$work/said"
report $? "the shared library defines these and no others"

# Parts have global names.  The command's must not be seen by its shared libraries; no static one may
# want a name that is also ours.
defined -g "$build/libkrs-internal.a" "$build/live.a" "$build/import.a" "$build"/cli/*.o "$build"/cli/*/*.o | grep -v '^_Z' >"$work/ours"
defined -D "$build/krs" | comm -12 - "$work/ours" >"$work/said"
[ ! -s "$work/said" ]
report $? "the command lends none of its $(wc -l <"$work/ours") names"
for word in $(make --no-print-directory B="$build" libs) -limgui; do
    case $word in
    -l*) "$cc" -print-file-name="lib${word#-l}.a" ;;
    esac
done | grep / | while read -r archive; do
    nm -u "$archive" 2>/dev/null
done | awk 'NF == 2 { print $2 }' | sort -u | comm -12 - "$work/ours" >"$work/said"
[ ! -s "$work/said" ]
report $? "no static library is given a name of ours"
ldd "$build/krs" | awk '$2 == "=>" && $3 ~ /^\// && $1 !~ /^libc\.so/ { print $3 }' | while read -r library; do
    defined -D "$library"
done | sort -u | comm -12 - "$work/ours" >"$work/said"
[ ! -s "$work/said" ]
report $? "none of ours takes the place of a name of a shared library"

# What C libraries round each in its own way is our own (base/elementary.h), but for the runtime's.
others='^(a?(sin|cos|tan)h?|atan2|exp(2|10|m1)?|log(2|10|1p)?|pow|cbrt|hypot|sincos|[lt]gamma|erfc?)[fl]?$'
find "$build/compiler" "$build/mesh" "$build/rays" "$build/grid" "$build/slice" "$build/measure" "$build/denoise" -name '*.o' -exec nm -u -A {} + 2>/dev/null |
    awk -v others="$others" '$NF ~ others' >"$work/said"
[ ! -s "$work/said" ]
report $? "functions of numbers are our own"

# ---- programs ----

cat >"$work/server.c" <<'EOF'
#include <netinet/in.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/times.h>

#include <krs/krs.h>

/* Names of ours that a program has for itself. */
int   times_called, arena_new = 7;
float dot(float a, float b);
float dot(float a, float b) { return a * b; }
int   text_format(void);
int   text_format(void) { return 3; }

int main(void)
{
    KrsScene          *scene  = NULL;
    const char         text[] = "show sphere(1) - box([1, 1, arrow]);\n";
    const char         good[] = "show sphere(1) - box([1, 1, 1]);\n";
    struct sockaddr_in at     = {.sin_family = AF_INET, .sin_addr = {htonl(INADDR_LOOPBACK)}};
    struct tms         spent;
    const int          end = socket(AF_INET, SOCK_STREAM, 0);
    if (krs_compile_text(text, strlen(text), "a.krs", NULL, &scene) != KRS_BAD_SCENE ||
        krs_compile_text(good, strlen(good), "a.krs", NULL, &scene) != KRS_OK)
        return 1;
    krs_scene_free(scene);
    if (end < 0 || bind(end, (struct sockaddr *)&at, sizeof at) != 0 || listen(end, 1) != 0)
        return 2;
    if (times(&spent) == (clock_t)-1 || arena_new != 7 || dot(2, 3) != 6 || text_format() != 3)
        return 3;
    return strcmp(krs_version(), KRS_VERSION) != 0;
}
EOF
libs=$(make --no-print-directory B="$build" libs)
serve() { # name, options of the compiler
    program=$1
    shift
    # shellcheck disable=SC2086 # many words
    "$cc" -std=c17 -D_GNU_SOURCE -Wall -Wextra -Werror -Iinclude -o "$work/server" "$work/server.c" "$@" >"$work/said" 2>&1 &&
        LD_LIBRARY_PATH="$build" "$work/server" >>"$work/said" 2>&1
    report $? "$program"
}
# shellcheck disable=SC2086 # many words
serve "a server with the archive" "$build/libkrs.a" $libs
for linker in bfd lld; do
    name="a server with the archive, linked by $linker"
    if command -v "ld.$linker" >/dev/null; then
        # shellcheck disable=SC2086 # many words
        serve "$name" -fuse-ld=$linker "$build/libkrs.a" $libs
    else
        skip "$name" "no ld.$linker"
    fi
done
serve "a server with the shared library" -L"$build" -lkrs

numbers() { # from the header
    sed -n 's/^#define KRS_VERSION_[A-Z]* *//p' include/krs/krs.h | paste -s -d .
}
[ "$(sed -n 's/^#define KRS_VERSION *"\(.*\)"/\1/p' include/krs/krs.h)" = "$(numbers)" ]
report $? "the numbers of the version are those of its text"
exit $failed
