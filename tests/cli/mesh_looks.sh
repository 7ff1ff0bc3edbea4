#!/bin/sh
# mesh_looks.sh: `krs mesh` writes materials into GLB by the extensions of glTF.
. "$(dirname "$0")/common.sh"
plan 7

cat >looks.krs <<'SCENE'
material glass { color: #e0f0ff, transmission: 0.9, roughness: 0.05, ior: 1.33, absorption: [0.5, 0.1, 0.05] }
material clear { color: white, transmission: 1, roughness: 0 }
material paint { color: #8a0f14, roughness: 0.5, metallic: 0.25, coat: 0.75, coat_roughness: 0.125 }
material velvet { color: #201040, sheen: [0.5, 0.25, 0.125], sheen_roughness: 0.4, specular: 0.5 }
material soap { color: gray, thin_film_weight: 0.5, thin_film_thickness: 0.42, thin_film_ior: 1.35 }
material neon { color: black, emission: 30 * [1, 0.3, 0.2] }
material dim { color: black, emission: [0.5, 0.25, 0] }
material wax { color: #f0dcb4, roughness: 0.4, subsurface_weight: 1 }
material vary { color: white, roughness: 0.25 + 0.5 * clamp(y, 0, 1), metallic: 0.5 }
material some(r) { color: white, roughness: r }
show sphere(1).paint(glass);
show (sphere(1) - sphere(0.8)).move([3, 0, 0]).paint(clear);
show box([1, 1, 1]).move([6, 0, 0]).paint(paint);
show box([1, 1, 1]).move([9, 0, 0]).paint(velvet);
show box([1, 1, 1]).move([12, 0, 0]).paint(soap);
show box([1, 1, 1]).move([15, 0, 0]).paint(neon);
show box([1, 1, 1]).move([18, 0, 0]).paint(dim);
show box([1, 1, 1]).move([21, 0, 0]).paint(wax);
show box([1, 1, 1]).move([27, 0.5, 0]).paint(vary);
show box([1, 1, 1]).move([30, 0, 0]).paint(some(0.25));
show box([1, 1, 1]).move([33, 0, 0]).paint(some(0.75));
SCENE
cat >brushed.krs <<'SCENE'
material steel { color: #d8d6d0, roughness: 0.4, metallic: 1, specular_roughness_anisotropy: 0.75, tangent: [x, 0, z] }
show krs {
    kernel (cylinder(0.5, 0.2).paint(steel)).move([1, 0, 0]);
    reflect plane([-1, 0, 0], 0);
    mobius translate([1, 2, 3]) * rotate([0, 1, 0], 30deg);
};
show box([1, 1, 1]).move([0, -3, 0]);
SCENE
run mesh looks.krs --error 0.05 --units cm -o looks.glb
ended 0 "a scene with all kinds of materials is meshed"
grep -qF "the material \`vary\` has the same \`roughness\` everywhere, the mean" err
result $? "a property that varies is told"
grep -qF "is without the \`subsurface_weight\` of \`wax\`" err && [ "$(grep -c warning err)" -eq 2 ]
result $? "and what glTF has nothing for; nothing else"
run mesh --quiet looks.krs --error 0.05 --units cm -o again.glb
[ "$status" -eq 0 ] && [ ! -s err ] && cmp -s looks.glb again.glb
result $? "the file is the same, and silent, the next time"
run mesh --quiet brushed.krs --error 0.02 -o brushed.glb
"$krs" mesh --quiet brushed.krs --error 0.02 --copies flat -o flat.glb
ended 0 "a scene of brushed steel is meshed"
if /usr/bin/python3 -c 'import numpy' 2>/dev/null; then
    /usr/bin/python3 "$root/tests/cli/mesh_looks.py" looks.glb brushed.glb flat.glb >out 2>err
    result $? "GLB has the materials by the extensions of glTF, and tangents where highlights are drawn out"
    /usr/bin/python3 "$root/tests/cli/gltf_rules.py" looks.glb brushed.glb flat.glb >out 2>err
    result $? "and keeps the rules of the specifications"
else
    skip "GLB has the materials by the extensions of glTF, and tangents where highlights are drawn out" "no numpy"
    skip "and keeps the rules of the specifications" "no numpy"
fi
