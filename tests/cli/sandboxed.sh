#!/bin/sh
# sandboxed.sh: what commands do in the sandbox of a stranger's scene is what they do outside.
# shellcheck source-path=SCRIPTDIR
. "$(dirname "$0")/common.sh"
plan 11
need_sandbox 11
mkdir -p in/deep
: >out

cp "$root/examples/01-hello.krs" in/example.krs
printf 'camera { eye: [0, 1, 5], target: [0, 0, 0] }\nuse "deep/size.krs";\nshow sphere(size);\n' >in/uses.krs
echo 'let size = 0.5;' >in/deep/size.krs
for scene in example uses; do
    run render in/$scene.krs --size 48x32 --samples 2 --cache off --quiet -o $scene.exr -o $scene.png
    run render in/$scene.krs --size 48x32 --samples 2 --untrusted --quiet -o $scene-in.exr -o $scene-in.png
    [ "$status" -eq 0 ] && cmp -s $scene.exr $scene-in.exr && cmp -s $scene.png $scene-in.png
    result $? "pictures are the same, byte for byte: $scene"
done
"$krs" pack in/uses.krs --untrusted --quiet -o uses.krsz 2>err && "$krs" pack in/uses.krs --quiet -o outside.krsz && cmp uses.krsz outside.krsz &&
    "$krs" render uses.krsz --untrusted --size 48x32 --samples 2 --quiet -o uses-pack.exr 2>err && cmp uses.exr uses-pack.exr
result $? "packs are made and rendered"
good=0
for words in 'mesh --error 0.2 -o uses%s.stl' 'slice --layer 0.5 -o uses%s.svg' 'grid --cell 0.2 -o uses%s.npy' 'export --to three -o uses%s.three.mjs' \
    'compile -o folder%s'; do
    for where in '' --untrusted; do
        # shellcheck disable=SC2046,SC2086 # words are meant
        run ${words%% *} in/uses.krs --quiet $where $(echo "${words#* }" | sed "s/%s/$where/")
        [ "$status" -eq 0 ] || good=1
    done
done
cmp -s uses.stl uses--untrusted.stl && cmp -s uses.svg uses--untrusted.svg && cmp -s uses.npy uses--untrusted.npy &&
    cmp -s uses.three.mjs uses--untrusted.three.mjs && diff -r folder folder--untrusted >out 2>err && [ $good -eq 0 ]
result $? "so are meshes, sections, grids, exports and shaders"
echo 'show text("krs").extrude(0.2);' >in/letters.krs
good=0
for where in '' --untrusted; do
    # shellcheck disable=SC2086 # words are meant
    "$krs" export in/letters.krs --quiet $where --to essl -o letters$where.essl 2>err &&
        "$krs" compile in/letters.krs --quiet $where --language essl -o tables$where 2>err || good=1
done
cmp -s letters.cells.bin letters--untrusted.cells.bin && [ -s tables/letters.rows.bin ] && diff -r tables tables--untrusted >out 2>err &&
    [ $good -eq 0 ]
result $? "tables, too, are in files beside them"
good=0
for command in check info 'dump --after=graph' 'validate --points 200' 'format --check' query; do
    for where in '' --untrusted; do
        # shellcheck disable=SC2086 # words are meant
        echo '0 0 3 0 0 -1' | "$krs" $command $where in/uses.krs >"said$where" 2>>err || good=1
    done
    [ "$command" = 'validate --points 200' ] || cmp -s said said--untrusted || good=1
done
result $good "other commands say the same"
printf 'surface_equation=x^2+y^2+z^2-1\n' >in/ball.jsurf
"$krs" import in/ball.jsurf >said 2>err && "$krs" import in/ball.jsurf --untrusted >said--untrusted 2>err && cmp -s said said--untrusted &&
    "$krs" import in/ball.jsurf --untrusted -o in/ball.krs 2>err && cmp -s said in/ball.krs
result $? "and so does an import"

# ---- what starts other programs ----

run farm submit in/uses.krs --untrusted --job stranger -o "$work/stranger.exr"
said 2 "it needs to know --size, --samples and --rays" "a farm does not read a stranger's scene for its size"
run farm submit uses.krsz --untrusted --size 48x32 --job stranger -o "$work/stranger.exr"
said 2 "a stranger's pack is opened in a sandbox alone" "nor his pack"
"$krs" render in/uses.krs --size 48x32 --samples 2 --rays kernels --cache off --quiet -o whole.exr &&
    "$krs" farm submit in/uses.krs --untrusted --size 48x32 --samples 2 --rays kernels --tiles 2x1 --quiet --job stranger -o "$work/stranger.exr" 2>err &&
    grep -q '"--untrusted"' stranger/job.json && "$krs" farm work stranger --quiet 2>err && cmp whole.exr stranger.exr
result $? "what it starts is in sandboxes, and makes the same picture"
run lsp --untrusted
said 2 "lsp starts processes" "a language server says that it has no sandbox"
