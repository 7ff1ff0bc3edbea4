#!/bin/sh
# try-faces.sh BUILD FOLDER: every face of krs used as its users would, with the programs that they have: `make test-faces`.
#
# krs is installed, and called by its name in folders that have nothing else.  What tests/ has already is run from
# there; pictures for people to look at are left in FOLDER: screenshots of pages and of exports.  What is missing is skipped.
cd "$(dirname "$0")/.." || exit 1
root=$PWD
build=$(cd "$1" && pwd) && mkdir -p "$2" && folder=$(cd "$2" && pwd) || exit 1
passed=0 failed=0 skipped=0
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT
result() { # status, what; its words are in $work/said
    if [ "$1" -eq 0 ]; then
        passed=$((passed + 1)) && echo "ok $((passed + failed)) - $2"
    else
        failed=$((failed + 1)) && echo "not ok $((passed + failed)) - $2"
        tail -n 15 "$work/said" | sed 's/^/# /'
    fi
}
skip() { # what, why
    skipped=$((skipped + 1))
    echo "ok - $1 # SKIP $2"
}
has() { command -v "$1" >/dev/null; }
# The block of a page behind a heading, of this language; where there are several, the one with these words.
block() { # heading, language, words
    awk -v heading="## $1" -v fence="\`\`\`$2" -v words="$3" '
        /^## / { here = $0 == heading }
        $0 == "```" && inside { inside = 0; if (index(text, words)) { printf "%s", text; exit } next }
        here && $0 == fence { inside = 1; text = ""; next }
        inside { text = text $0 "\n" }' docs/editors.md
}

# ---- installed, in a folder of its own ----

prefix=$work/prefix
make --no-print-directory B="$build" install PREFIX="$prefix" >"$work/said" 2>&1
result $? "krs is installed"
export PATH="$prefix/bin:$PATH" LD_LIBRARY_PATH="$prefix/lib" PKG_CONFIG_PATH="$prefix/lib/pkgconfig" XDG_CACHE_HOME="$work/cache"
cat >"$work/ring.krs" <<'END_OF_SCENE'
// A ring.
param size = 2 in [1, 3];
let hole = size / 2;
show (sphere(size) - cylinder(hole, 9)).paint(brass);
material brass { color: #e0a030, metallic: 1, roughness: 0.3 }
camera { eye: [5, 4, 6], target: [0, 0, 0] }
END_OF_SCENE
(cd "$work" && [ "$(command -v krs)" = "$prefix/bin/krs" ] && krs check ring.krs && krs render ring.krs --size 320x180 --quiet -o ring.png && krs mesh ring.krs --quiet --error 0.1 -o ring.glb &&
    krs grid ring.krs --cell 0.2 -o ring.npy && krs info ring.krs) >"$work/said" 2>&1
result $? "it checks, renders, meshes, samples and tells of a scene"
cp "$work/ring.png" "$folder/ring.png"

# ---- exports, each compiled by what the target has ----

for target in shadertoy three glsl essl wgsl hlsl msl godot unity unreal blender-osl; do
    mkdir "$work/$target" && (cd "$work/$target" && krs export ../ring.krs --to $target) >"$work/said" 2>&1
    result $? "ring.krs is written for $target"
done
suite() { # script, its words
    KRS="$prefix/bin/krs" B="$build" KRS_TEST_SECONDS=1800 tests/run.sh "$1" >"$work/said" 2>&1
    result $? "$2"
    grep -o 'SKIP .*' "$work/said" | sort -u | sed 's/^/# /'
}
suite tests/cli/export.sh "compilers take what is written: glslang, spirv-cross, g++, mcs"
KRS_EXPORT_SHOTS=$folder suite tests/web/export.sh "Chromium and three.js draw it, with pictures"

# ---- editors ----

suite tests/editors.sh "colours of editors have the words of the language, and the extension starts the server"
suite tests/cli/lsp.sh "krs lsp answers sessions, and Neovim"
what="the extension for VS Code is packed by vsce"
if has npm; then
    mkdir "$work/vsce"
    if (cd "$work/vsce" && npm install --no-save --ignore-scripts --no-audit --no-fund --silent @vscode/vsce@3.9.2) >"$work/said" 2>&1; then
        make --no-print-directory B="$build" vscode >"$work/said" 2>&1 && (cd "$build/vscode" && "$work/vsce/node_modules/.bin/vsce" package --allow-missing-repository -o "$folder/krs.vsix") >"$work/said" 2>&1 &&
            python3 -c 'import sys, zipfile
names = zipfile.ZipFile(sys.argv[1]).namelist()
for name in "extension.js", "krs.tmLanguage.json", "language-configuration.json", "node_modules/vscode-languageclient/node.js":
    assert "extension/" + name in names, name' "$folder/krs.vsix" >>"$work/said" 2>&1
        result $? "$what"
    else
        skip "$what" "npm has no vsce"
    fi
else
    skip "$what" "no npm"
fi
cat >"$work/wanted" <<'END_OF_WORDS'
// krsComment
param krsStatement
= krsOperator
let krsStatement
hole
show krsStatement
filetype krs
END_OF_WORDS
for vim in vim nvim; do
    what="$vim colours a scene by the lines of the page"
    if ! has $vim; then
        skip "$what" "no $vim"
        continue
    fi
    mkdir -p "$work/$vim/.vim/syntax" "$work/$vim/.config/nvim/syntax"
    cp grammar/editors/krs.vim "$work/$vim/.vim/syntax" && cp grammar/editors/krs.vim "$work/$vim/.config/nvim/syntax"
    { echo 'syntax on'; block Vim vim ''; } >"$work/$vim/.vimrc"
    (cd "$work/$vim" && HOME="$PWD" timeout 60 $vim -u .vimrc -i NONE -n -es ../ring.krs -S "$root/tests/faces/vim.vim") >"$work/said" 2>&1 </dev/null
    sed 's/ *$//' "$work/$vim/told" >"$work/found" 2>>"$work/said"
    diff "$work/wanted" "$work/found" >>"$work/said" 2>&1
    result $? "$what"
done
what="Emacs asks the server by the lines of the page, through eglot"
if has emacs && emacs --batch --eval "(require 'eglot)" 2>/dev/null; then
    block Emacs lisp '' >"$work/init.el"
    printf '%s\n' 'let size = 2;' 'show sphere(siz);' >"$work/wrong.krs"
    (cd "$work" && timeout 120 emacs --batch -l init.el -l "$root/tests/faces/emacs.el" wrong.krs) >"$work/said" 2>&1 </dev/null
    grep -q '^all is well' "$work/said"
    result $? "$what"
else
    skip "$what" "no emacs with eglot"
fi
block Helix toml '' >"$work/languages.toml" && block Kate json '' >"$work/kate.json"
python3 -c 'import json, sys, tomllib
helix = tomllib.load(open(sys.argv[1], "rb"))
assert helix["language-server"]["krs"]["command"] == "krs" and helix["language"][0]["language-servers"] == ["krs"]
assert json.load(open(sys.argv[2]))["servers"]["krs"]["command"] == ["krs", "lsp"]' "$work/languages.toml" "$work/kate.json" >"$work/said" 2>&1
result $? "texts for Helix and Kate are TOML and JSON that name the server (neither editor was run)"

# ---- libraries ----

suite tests/python.sh "the wheel answers in an environment of its own"
suite tests/library.sh "programs of the page are built with the library"
for program in mesh view; do
    # shellcheck disable=SC2046 # options are words
    cc -o "$work/$program" examples/c/$program.c $(pkg-config --cflags --libs krs vulkan glfw3 gl) -lm >"$work/said" 2>&1
    result $? "examples/c/$program.c is built with what is installed"
done
(cd "$work" && ./mesh ring.krs 0.1) >"$work/said" 2>&1 && cat "$work/said" && grep -q closed "$work/said"
result $? "and gives a mesh that is closed"
echo "$passed passed, $failed failed, $skipped skipped; pictures are in $folder"
[ "$failed" -eq 0 ]
