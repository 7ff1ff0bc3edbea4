#!/bin/sh
# lsp.sh: `krs lsp` answers an editor, byte by byte, and whatever comes in its place.
#
# Sessions of tests/lsp/session.mjs go through vscode-languageserver-protocol, where node and npm are; the core of pages,
# where it is built, must give the same answers.
# shellcheck source-path=SCRIPTDIR disable=SC2016
. "$(dirname "$0")/common.sh"
plan 23
LC_ALL=C
export LC_ALL XDG_CACHE_HOME="$work/cache"

message() { printf 'Content-Length: %d\r\n\r\n%s' "${#1}" "$1"; }
request() { message "{\"jsonrpc\":\"2.0\",\"id\":$1,\"method\":\"$2\",\"params\":$3}"; }
note() { message "{\"jsonrpc\":\"2.0\",\"method\":\"$1\",\"params\":$2}"; }
begin() {
    request 1 initialize '{"processId":null,"rootUri":null,"capabilities":{}}'
    note initialized '{}'
}
open_text() { note textDocument/didOpen "{\"textDocument\":{\"uri\":\"$1\",\"languageId\":\"krs\",\"version\":1,\"text\":\"$2\"}}"; }
ask() { request "$1" "textDocument/$2" "{\"textDocument\":{\"uri\":\"$3\"},\"position\":{\"line\":$4,\"character\":$5}}"; }
end() {
    request 99 shutdown null
    note exit null
}
# Gives the server what is in a file; a line of `out` for each message that comes back.
serve() {
    timeout 60 "$krs" lsp <"${1:-sent}" >raw 2>err
    status=$?
    # A header says how many bytes its message has, behind which the next begins.
    tr -d '\n' <raw | tr '\r' '\n' | sed '/^$/d; s/Content-Length: [0-9]*$//' | grep . >out
}
has() { grep -qF -- "$1" out; }

file=file://$work/a%20b.krs
{
    begin
    open_text "$file" 'let a = 1 + 1;\nshow sphere(a);\n'
    ask 2 hover "$file" 1 12
    ask 3 definition "$file" 1 7
    end
} >sent
serve
[ "$status" -eq 0 ]
result $? "a session ends with status 0"
has '"id":1,"result":{"capabilities":{"positionEncoding":"utf-16"'
result $? "the server says what it can"
has '\n= 2\n' && has "\"range\":{\"start\":{\"line\":1,\"character\":12},\"end\":{\"line\":1,\"character\":13}}"
result $? "hover tells a value"
has "\"uri\":\"file://$work/cache/krs/library-" && cmp -s "$root/compiler/library/solids.krs" "$work"/cache/krs/library-*/solids.krs
result $? "files of the library are there to be opened"
awk 'BEGIN { RS = "Content-Length: " } NR > 1 { split($0, part, "\r\n\r\n"); if (part[1] + 0 != length(part[2])) exit 1 }' raw
result $? "headers tell the length of messages"

# A used file: open ones come before those on the disk, by paths with blanks.
echo 'def ball(r) = sphere(r);' >"used one.krs"
{
    begin
    open_text "$file" 'use \"used one.krs\";\nshow ball(2);\nshow globe(1);\n'
    ask 2 definition "$file" 1 6
    open_text "file://$work/used%20one.krs" '// 1\n// 2\ndef ball(r) = sphere(r);\ndef globe(r) = sphere(r);\n'
    ask 3 definition "$file" 1 6
    ask 4 completion "file://$work/used%20one.krs" 2 17
    end
} >sent
serve
has "\"id\":2,\"result\":{\"uri\":\"file://$work/used%20one.krs\",\"range\":{\"start\":{\"line\":0,\"character\":4}" &&
    has "\"id\":3,\"result\":{\"uri\":\"file://$work/used%20one.krs\",\"range\":{\"start\":{\"line\":2,\"character\":4}"
result $? "an open text comes before its file"
has '"label":"torus"'
result $? "names are completed"
{
    begin
    open_text "$file" 'use \"u\";\n'
    ask 2 completion "$file" 0 6
    end
} >sent
serve
has '"newText":"used one.krs"'
result $? "files of the folder are completed"

# Mistakes: those of reading at once, those of a whole check when the editor is quiet.
mkfifo pipe
{
    begin
    open_text "$file" 'show sphere(1) + 1;\n'
    sleep 3
    note textDocument/didChange "{\"textDocument\":{\"uri\":\"$file\",\"version\":2},\"contentChanges\":[{\"text\":\"let a = ;\\n\"}]}"
    sleep 1
    end
} >pipe &
serve pipe
has "{\"uri\":\"$file\",\"version\":1,\"diagnostics\":[{\"uri\":\"$file\",\"range\":{\"start\":{\"line\":0,\"character\":15}" && has '"code":"E0301"'
result $? "a whole check tells mistakes"
has '"version":2,"diagnostics":[' && has '"code":"E0101"'
result $? "reading tells mistakes"

# ---- what is no session ----

begin >sent
serve
[ "$status" -eq 1 ]
result $? "an end without a goodbye is status 1"
{
    begin
    note exit null
} >sent
serve
[ "$status" -eq 1 ]
result $? "an exit without a shutdown is status 1"
{
    ask 2 hover "$file" 0 0
    begin
    request 3 shutdown null
    ask 4 hover "$file" 0 0
    note exit null
} >sent
serve
has '"id":2,"error":{"code":-32002' && has '"id":4,"error":{"code":-32600' && [ "$status" -eq 0 ]
result $? "questions before the start and behind the end are refused"
{
    begin
    message '{"jsonrpc":"2.0","id":2,'
    message 'no JSON'
    message '[]'
    message '{"jsonrpc":"2.0","id":"x","params":{}}'
    request '"four"' textDocument/hover '{"textDocument":{"uri":"file:///none.krs"}}'
    request 5 textDocument/unknown '{}'
    request 6 textDocument/hover '7'
    message '{"jsonrpc":"2.0","id":7,"result":null}'
    end
} >sent
serve
[ "$(grep -c '"id":null,"error":{"code":-32700' out)" -eq 2 ] && [ "$(grep -c '"code":-32600' out)" -eq 2 ] &&
    has '"id":"four","error":{"code":-32602' && has '"id":5,"error":{"code":-32601' && has '"id":6,"error":{"code":-32602' &&
    ! has '"id":7' && [ "$status" -eq 0 ]
result $? "what cannot be read is answered, and the session goes on"
{
    begin
    open_text "$file" 'let a = 2;\n'
    ask 2 hover "$file" 4000000000 99999999999999
    ask 3 completion "$file" -5 -7
    ask 4 hover "$file" 0 '"x"'
    note textDocument/didChange "{\"textDocument\":{\"uri\":\"$file\"},\"contentChanges\":[{\"range\":{\"start\":{\"line\":9,\"character\":9},\"end\":{\"line\":0,\"character\":0}},\"text\":\"b\"},{\"range\":7},9]}"
    ask 5 documentSymbol "$file" 0 0
    end
} >sent
serve
has '"id":2,"result":' && has '"id":3,"result":[' && has '"id":4,"result":' && has '"id":5,"result":[{"name":"a"' && [ "$status" -eq 0 ]
result $? "positions that are none are taken as the nearest"
{
    begin
    open_text "$file" "$(printf 'let a = \351;')"
    open_text "$file" 'let b = \u0000 + \ud83c 1;\n'
    ask 2 hover "$file" 0 4
    end
} >sent
serve
[ "$(grep -c '"code":-32700' out)" -ge 1 ] && has '"id":99,"result":null' && [ "$status" -eq 0 ]
result $? "text that is not UTF-8 is refused"
{
    begin
    printf 'content-length:   %d\r\nContent-Type: application/vscode-jsonrpc; charset=utf-8\r\n\r\n%s' 49 '{"jsonrpc":"2.0","id":2,"method":"x","params":{}}'
    end
} >sent
serve
has '"id":2,"error":{"code":-32601' && [ "$status" -eq 0 ]
result $? "headers have other lines, and any letters"
wrong=""
for header in 'Content-Length: 99999999999999999999' 'Content-Length: -5' 'Content-Length: x' 'Other: 5'; do
    printf '%s\r\n\r\n{}' "$header" >sent
    serve
    [ "$status" -eq 1 ] && grep -q 'no message' err || wrong="$wrong $header"
done
head -c 100000 /dev/zero | tr '\0' 'x' >sent
serve
[ "$status" -eq 1 ] || wrong="$wrong endless"
[ -z "$wrong" ]
result $? "headers that no message can follow end it$wrong"

if command -v python3 >/dev/null; then
    python3 "$root/tests/lsp/storm.py" "$krs" "$root/examples" >out 2>err
    result $? "a storm of messages: $(tail -n 1 out)"
else
    skip "a storm of messages" "no python3"
fi

# ---- once ----

# Mistakes of the first are told when the second has been checked behind it.  What comes is read while it is written.
# shellcheck disable=SC2094
{
    begin
    open_text untitled:second 'show sphere(1);\n'
    open_text untitled:first 'show sphere(1;\n'
    tries=0
    while [ $tries -lt 300 ] && ! grep -q 'untitled:second' raw 2>/dev/null; do
        sleep 0.1
        tries=$((tries + 1))
    done
    end
} | timeout 60 "$krs" lsp >raw 2>err
[ "$(grep -o '"params":{"uri":"untitled:first"' raw | wc -l)" -eq 1 ] && grep -q E0103 raw && grep -q untitled:second raw
result $? "what reading and a check both find is told once"

# ---- an editor, and the library of another ----

if command -v nvim >/dev/null; then
    printf '/// How large.\nlet size = 1 + 1;\nshow sphere(size) + 1;\nshow sphere(1).mo\n' >edited.krs
    HOME=$work KRS=$krs timeout 60 nvim --headless -u NONE edited.krs -c "luafile $root/tests/lsp/neovim.lua" -c 'qa!' >out 2>&1
    grep -q 'all is well' out
    result $? "Neovim edits a scene"
else
    skip "Neovim edits a scene" "no nvim"
fi

npm=$root/${B:-build}/lsp-npm
if ! command -v node >/dev/null || ! command -v npm >/dev/null; then
    why="no node or npm"
elif [ -d "$npm/node_modules" ] || { mkdir -p "$npm" && cp "$root"/tests/lsp/package*.json "$npm" &&
    (cd "$npm" && npm ci --ignore-scripts --no-audit --no-fund --silent >/dev/null 2>&1); }; then
    why=""
else
    why="npm has not the packages of tests/lsp/package.json"
fi
if [ -n "$why" ]; then
    skip "a session by vscode-languageserver-protocol" "$why"
    skip "the core of pages gives the same answers" "$why"
    exit 0
fi
timeout 120 node "$root/tests/lsp/session.mjs" "$npm" "$krs" >out 2>err
result $? "a session by vscode-languageserver-protocol: $(grep -c '^ok' out) answers"
grep '^not ok' out | sed 's/^/# /'
if [ -f "$root/${B:-build}/wasm/krs.wasm" ] && [ -f "$root/${B:-build}/wasm/core.mjs" ]; then
    timeout 120 node "$root/tests/lsp/session.mjs" "$npm" "$krs" "$root/${B:-build}/wasm" >out 2>err
    result $? "the core of pages gives the same answers"
    grep '^not ok\|^#' out | sed 's/^/# /'
else
    skip "the core of pages gives the same answers" "it is not built: make wasm"
fi
