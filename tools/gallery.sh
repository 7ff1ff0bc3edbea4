#!/bin/sh
# gallery.sh BUILD demo|gallery [NAME...]: renders the pictures of tools/pictures.txt to BUILD/demo/ or BUILD/gallery/,
# makes the meshes, and writes a page that shows them: index.html.  Without a name all, two at once: while one
# compiles on one core, another renders.
set -u
cd "$(dirname "$0")/.." || exit 1
build=$1 set=$2
shift 2
folder=$build/$set figures=$build/$set.figures

# The rows of this set: kind|name|scene|options|what it shows.
rows() {
    awk -F ' *[|] *' -v column="$([ "$set" = demo ] && echo 5 || echo 4)" \
        '!/^#/ && $column != "-" { print $1 "|" $2 "|" $3 "|" $column "|" $6 }' tools/pictures.txt
}

files_of() { # kind, name
    case $1 in
    mesh) echo "$2.stl $2.glb" ;;
    exr) echo "$2.png $2.exr" ;;
    picture) echo "$2.png" ;;
    esac
}

# The command that makes a row, as a shell reads it.
command_of() { # kind, name, scene, options
    verb=render
    [ "$1" != mesh ] || verb=mesh
    printf %s "$build/krs $verb examples/$3.krs $4"
    for file in $(files_of "$1" "$2"); do printf %s " -o $folder/$file"; done
}

# ---- the page ----
escaped() { sed 's/&/\&amp;/g; s/</\&lt;/g; s/>/\&gt;/g'; }

# Links to those of a row's files that need another program to be looked at, and the row's command.
below() { # kind, name, scene, options, text
    for file in $(files_of "$1" "$2"); do
        [ "$file" = "$2.png" ] || echo "<a href=\"$file\">$file</a> ($(du -h "$folder/$file" | cut -f 1))"
    done
    echo "<p><code>$(command_of "$@" | escaped)</code></p>"
}

# A picture on the page, and the meshes of the same name.
figure() { # name
    rows | grep "^[a-z]*|$1|" | while IFS='|' read -r kind name scene options text; do
        [ -s "$folder/$(files_of "$kind" "$name" | cut -d ' ' -f 1)" ] || continue
        [ "$kind" = mesh ] || echo "<figure><a href=\"$name.png\"><img src=\"$name.png\" alt=\"$name\"></a>
<figcaption><h2>$name</h2>"
        echo "<p>$(echo "$text" | escaped)</p>"
        below "$kind" "$name" "$scene" "$options"
    done
    echo "</figcaption></figure>"
}

# Prints a page of what there is so far.
page() {
    cat <<END
<!DOCTYPE html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width">
<title>krs: $set</title>
<style>
body { font: 16px/1.4 sans-serif; margin: 2em auto; max-width: 84em; padding: 0 1em; color: #222; background: #f6f5f2 }
main { display: grid; grid-template-columns: repeat(auto-fill, minmax(24em, 1fr)); gap: 2em }
figure { margin: 0 }
img { width: 100%; height: auto; display: block }
h2 { font-size: 1.1em; margin: 0.6em 0 0 }
p { margin: 0.3em 0 }
code { font-size: 0.8em; overflow-wrap: anywhere; color: #555 }
</style>
<h1>krs: $set</h1>
<p>Each picture is a scene of the folder <code>examples</code>, and was made by the command below it. A picture in EXR has
light of any strength, and depth, normals and components of each pixel; STL and GLB are triangles.</p>
<main>
END
    # shellcheck disable=SC2046 # names are words
    cat $(rows | awk -F '|' -v folder="$figures" '$1 != "mesh" { print folder "/" $2 }') 2>/dev/null
    echo "</main></html>"
}

# ---- a row ----
make_row() { # kind, name, scene, options, text
    begun=$(date +%s)
    echo "$1 $2: $5"
    eval "$(command_of "$@") --quiet" || exit 1
    echo "$1 $2: $(files_of "$1" "$2"), after $(($(date +%s) - begun)) s"
    if [ -s "$folder/$2.png" ]; then figure "$2" >"$figures/.$$" && mv "$figures/.$$" "$figures/$2"; fi
    page >"$folder/.index-$$" && mv "$folder/.index-$$" "$folder/index.html"
}

mkdir -p "$folder" "$figures" || exit 1
begun=$(date +%s)
if [ $# -eq 0 ]; then
    echo "$set: $(rows | grep -vc '^mesh') pictures and $(rows | grep -c '^mesh') meshes"
    rows | cut -d '|' -f 1,2 | xargs -n 1 -P 2 "$0" "$build" "$set" || exit 1
    echo "$set: done after $(($(date +%s) - begun)) s: open $folder/index.html"
    exit
fi
for wanted; do # the name of a picture, or kind|name
    row=$(rows | awk -F '|' -v wanted="$wanted" '$1 "|" $2 == wanted || ($1 != "mesh" && $2 == wanted)')
    [ -n "$row" ] || { echo "$set: tools/pictures.txt has no picture $wanted" >&2; exit 1; }
    IFS='|' read -r kind name scene options text <<END
$row
END
    make_row "$kind" "$name" "$scene" "$options" "$text"
done
