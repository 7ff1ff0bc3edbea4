#!/bin/sh
# bench.sh: the bench still runs: a quick one ends well, its results can be read and are complete,
# and it notices when a picture is not what it should be.
cd "$(dirname "$0")/.." || exit 1
root=$PWD
build=${B:-build}
case $build in /*) ;; *) build=$root/$build ;; esac
krs=${KRS:-$build/krs}
case $krs in /*) ;; *) krs=$root/$krs ;; esac
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT
failed=0 number=0
echo "1..11"
report() { # status, name
    number=$((number + 1))
    if [ "$1" -eq 0 ]; then echo "ok $number - $2"; else echo "not ok $number - $2"; failed=1; fi
}

# Whether a file is JSON.
is_json() {
    if command -v python3 >/dev/null; then
        python3 -m json.tool "$1" >/dev/null
    elif command -v jq >/dev/null; then
        jq . "$1" >/dev/null
    else
        head -c 1 "$1" | grep -q '{' && tail -n 1 "$1" | grep -q '}$'
    fi
}

# Every method of the table, and the shader by hand, has all of these.
of_entries="method by_hand error ms total without_shadows_and_occlusion wall cpu
            evaluations_per_ray ns_per_ray unresolved coverage coverage_error agreement
            hit_differs depth_differs inside_differs inside depth_error"
of_ours="trace schedule beams gflops peak_share primary normals shadows occlusion shading resolve"
once="date quick machine device driver processor memory system compiler krs revision peak_gflops
      width height repeats scenes growth sequences by_levels paper_kiloflops_per_ray triangles
      doublings ns_per_distance ns_per_evaluation questions
      points_per_second rays_per_second first_picture cold_ms
      warm_ms faults"
of_scenes="name scene flops_per_evaluation first_use reference entries by_hand_takes
           at_the_same_error at_the_same_coverage by_hand_at_the_reference_error"

# How often a file has a member.
count() { grep -o "\"$1\": " "$2" | wc -l; }

has_members() { # file, how often at least, names
    for member in $3; do
        found=$(count "$member" "$1")
        if [ "$found" -lt "$2" ]; then
            echo "# $member: $found of $2"
            return 1
        fi
    done
}

set -- ${KRS_DEVICE:+--device "$KRS_DEVICE"}
"$build/bench/bench" --quick "$@" --krs "$krs" --folder "$work/results" >"$work/out" 2>"$work/err"
status=$?
[ $status -eq 0 ] || { sed 's/^/# /' "$work/err"; sed -n '/^## Wrong/,$s/^/# /p' "$work/out"; }
report $status "a quick run finds every picture as it should be"
json=$(find "$work/results" -name '*.json')
is_json "$json"
report $? "its results are JSON"
table=${json%.json}.md
cmp -s "$table" "$work/out"
report $? "the tables are printed and written"

methods=$(grep -c '^METHOD(' bench/methods.def)
scenes=$(grep -c '^SCENE(.* true,' bench/scenes.def)
has_members "$json" 1 "$once"
report $? "what is said once is there"
has_members "$json" "$scenes" "$of_scenes"
report $? "what is said of scenes is there $scenes times"
has_members "$json" $((scenes * methods)) "$of_ours"
report $? "what is said of our methods is there $scenes times $methods times"
has_members "$json" $((scenes * (methods + 1))) "$of_entries"
report $? "what is said of the shaders by hand is there as well"
[ "$(grep -c '^| default ' "$table")" -eq "$scenes" ]
report $? "every scene has a table"

for shader in bench/*.comp bench/handwritten/*.comp; do
    glslangValidator -V --target-env vulkan1.1 -Ibench -Ibench/handwritten -I. -Iinclude -Iruntime/shaders \
        -Icompiler/print/glsl -o /dev/null "$shader" || echo "$shader" >>"$work/refused"
done >"$work/said"
[ ! -e "$work/refused" ] || sed 's/^/# /' "$work/said"
[ ! -e "$work/refused" ]
report $? "its shaders are GLSL by themselves"

# A ball that is larger in the shader by hand than in the scene.
mkdir "$work/bench"
cp -r bench/scenes bench/handwritten bench/*.comp bench/*.glsl "$work/bench"
cp -r examples "$work"
sed 's/ball(p, vec3(0.0, 0.6, 0.78), 0.2)/ball(p, vec3(0.0, 0.6, 0.78), 0.3)/' \
    bench/handwritten/csg.comp >"$work/bench/handwritten/csg.comp"
! cmp -s bench/handwritten/csg.comp "$work/bench/handwritten/csg.comp"
report $? "the planted fault is one"
(cd "$work" && "$build/bench/bench" --quick "$@" --only csg --krs "$krs" --folder wrong) \
    >"$work/out" 2>"$work/err"
[ $? -eq 1 ] && grep -q '^csg, by hand: share of wrong pixels' "$work/out"
report $? "a shader by hand of another scene is noticed"
exit $failed
