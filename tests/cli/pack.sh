#!/bin/sh
# pack.sh: `krs pack` makes one file of a scene, and other commands do with it what they do with the scene, elsewhere.
# shellcheck source-path=SCRIPTDIR disable=SC2016
. "$(dirname "$0")/common.sh"
plan 22
find_untrusted

# A scene that reads a text above its folder, one by its whole path, a picture, data and a font.
mkdir -p home/scenes home/pictures home/far elsewhere
cp "$root/examples/frieze.png" home/pictures
printf '0.5, 1.5\n' >home/scenes/table.csv
echo 'let height = 1.5;' >home/common.krs
echo 'let width = 0.75;' >home/far/width.krs
cat >home/scenes/scene.krs <<END
use "../common.krs";
use "$PWD/home/far/width.krs";
let rows = read_csv("table.csv");
let picture = texture("../pictures/frieze.png");
camera { eye: [3, 2, 5], target: [0, 0.5, 0], fov: 40deg }
light sun { direction: [-1, 2, 1], intensity: 3 }
show box([width, height, rows[0][0]]).paint(picture(x, y));
show text("krs", size: 0.5).extrude(0.1).move([1, 0, 0.5]);
END
run pack home/scenes/scene.krs -o elsewhere/scene.krsz
said 0 "5 files and 1 font" "a scene is packed, and what it reads is counted"
cp elsewhere/scene.krsz first.krsz
run pack home/scenes/scene.krs -o elsewhere/scene.krsz
cmp -s first.krsz elsewhere/scene.krsz
result $? "a pack of the same files is the same file"
how="--size 64x36 --samples 2 --rays kernels --integrator path --quiet"
# shellcheck disable=SC2086
run render home/scenes/scene.krs $how -o one.exr -o one.png
ended 0 "the scene is rendered"
run mesh home/scenes/scene.krs --error 0.02 -o one.stl
run check home/scenes/scene.krs
mv home away

cd elsewhere || exit 1
for how_trusted in "" "$untrusted"; do
    # shellcheck disable=SC2086
    run render scene.krsz $how $how_trusted -o pack.exr -o pack.png
    ended 0 "a pack is rendered, $how_trusted"
    cmp -s ../one.exr pack.exr
    result $? "with the same light"
    cmp -s ../one.png pack.png
    result $? "and the same picture"
done
run mesh scene.krsz --error 0.02
ended 0 "a pack is meshed"
cmp -s ../one.stl scene.stl
result $? "into the same triangles, in a file of its name"
run check scene.krsz scene.krsz
ended 0 "packs are checked"
mkdir folder
mv folder folder.krsz
run check folder.krsz
ended 74 "a folder is no pack"
run check none.krsz
ended 74 "nor is a file that is missing"

for command in "watch scene.krsz" "format scene.krsz" "pack scene.krsz -o other.krsz"; do
    # shellcheck disable=SC2086
    run $command
    ended 2 "krs ${command%% *} refuses a pack"
done

# Where bytes are spoilt or missing the pack is refused, or what is in it is the same.
cat >spoil.py <<'END'
import random, subprocess, sys
krs, whole = sys.argv[1], open('scene.krsz', 'rb').read()
random.seed(7)
expected = subprocess.run([krs, 'info', 'scene.krsz'], capture_output=True).stdout
wrong = refused = 0
for turn in range(120):
    spoilt = bytearray(whole)
    at = random.randrange(len(whole) if turn % 2 else 400)
    at = at if turn % 2 else len(whole) - 1 - at
    if turn % 3:
        spoilt[at] ^= 1 << random.randrange(8)
    else:
        del spoilt[at:]
    open('spoilt.krsz', 'wb').write(spoilt)
    run = subprocess.run([krs, 'info', 'spoilt.krsz'], capture_output=True)
    same = run.returncode == 0 and run.stdout == expected.replace(b'scene.krsz', b'spoilt.krsz')
    refused += run.returncode == 74
    wrong += not same and run.returncode != 74
print(wrong, 'wrong', 'some refused' if refused > 30 else 'none refused')
END
python3 spoil.py "$krs" >spoilt
grep -q '^0 wrong some refused' spoilt
result $? "packs that are spoilt are refused, or the same"

# An archive whose content is another than its contents say; one that needs too much; one of a later layout.
cat >forge.py <<'END'
import json, sys, zipfile
whole = zipfile.ZipFile('scene.krsz')
contents = json.loads(whole.read('pack.json'))
files = {name: whole.read(name) for name in whole.namelist() if name != 'pack.json'}
def write(path, contents, files):
    with zipfile.ZipFile(path, 'w', zipfile.ZIP_DEFLATED) as out:
        out.writestr('pack.json', json.dumps(contents))
        for name, content in files.items():
            out.writestr(name, content)
write('other.krsz', contents, {**files, 'files/' + contents['files'][0]['hash']: b'show sphere(1);'})
write('large.krsz', contents, {**files, 'files/' + contents['files'][0]['hash']: b' ' * (100 << 20)})
write('later.krsz', {**contents, 'layout': 2}, files)
write('lacks.krsz', contents, {})
END
python3 forge.py
for forged in other "large --limit memory=64M" later lacks; do
    # shellcheck disable=SC2086
    run check ${forged%% *}.krsz ${forged#"${forged%% *}"}
    ended 74 "a pack is refused: $forged"
done
