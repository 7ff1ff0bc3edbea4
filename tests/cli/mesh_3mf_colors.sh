#!/bin/sh
# mesh_3mf_colors.sh: `krs mesh` writes colors and materials into 3MF.
. "$(dirname "$0")/common.sh"
plan 4

cat >colors.krs <<'SCENE'
material shaded { color: mix([1, 0, 0], [0, 0, 1], clamp(0.5 + 0.5 * y, 0, 1)) }
material steel { color: #808080, metallic: 1 }
show sphere(1).paint(shaded);
show box([1, 1, 1]).move([3, 0, 0]).paint(tomato);
show box([1, 1, 1]).move([6, 0, 0]).paint(navy);
show sphere(0.5).move([9, 0, 0]).paint(steel);
SCENE
echo 'show sphere(1).paint(tomato);' >plain.krs
number_of() { # of the file's words that match
    python3 -c '
import sys, zipfile
print(zipfile.ZipFile(sys.argv[1]).read("3D/3dmodel.model").decode().count(sys.argv[2]))' "$@"
}
run mesh --quiet colors.krs --error 0.02 -o colors.3mf
"$krs" mesh --quiet colors.krs --error 0.02 --split components -o split.3mf
"$krs" mesh --quiet plain.krs --error 0.05 -o plain.3mf
ended 0 "scenes with colors are meshed"
if command -v python3 >/dev/null; then
    for file in colors.3mf split.3mf; do
        python3 "$root/tests/cli/mesh_3mf_colors.py" $file >out 2>err
        result $? "in \`$file\` each triangle has its material, or the colors of its corners where that varies"
    done
    [ "$(number_of plain.3mf xmlns:m)" = 0 ] && [ "$(number_of plain.3mf pid=)" = 1 ]
    result $? "what has one color says so once"
else
    skip "colors of triangles" "no python3"
    skip "colors of parts" "no python3"
    skip "what has one color says so once" "no python3"
fi
