#!/bin/sh
# farm.sh: several processes share a render, are killed, and leave the files of one render, byte for byte.
# shellcheck source-path=SCRIPTDIR disable=SC2016,SC2086
. "$(dirname "$0")/common.sh"
plan 42
export XDG_CACHE_HOME="$work/caches"

cat >ball.krs <<'END'
camera { eye: [3, 2, 5], target: [0, 0.5, 0], fov: 40deg }
light sun { direction: [-1, 2, 1], intensity: 3, softness: 9deg }
show sphere(0.6).move([0, 0.6 + 0.3 * sin(9 * time), 0]).paint(#ffcc66);
show plane([0, 1, 0], 0).paint(#888888);
END
how="--size 62x46 --samples 6 --rays kernels --integrator path"
run render ball.krs --frames 3..8 $how --quiet -o 'one-%04d.exr'
ended 0 "frames are rendered at once"
mkdir pictures

run farm submit ball.krs --frames 3..8 --tiles 2x2 --chunk 2 $how -o 'pictures/f-%04d.exr'
said 0 "has 12 pieces" "the same is submitted"
run farm submit ball.krs --frames 3..8 $how -o 'pictures/f-%04d.exr'
said 2 "is a job already" "a job is not written over"
run farm status ball.farm --json
is_json <out && grep -q '"frames": 6, "frames_done": 0, "pieces": 12, "done": 0, "running": 0, "waiting": 12' out
result $? "nothing is done yet"

# Workers that see the folder from elsewhere; all processes of one after the other are killed.
cp ball.krs other.krs
mv ball.krs gone.krs
mkdir elsewhere
a='' b=''
for turn in 1 2 3; do
    for worker in a b; do
        (cd elsewhere && exec setsid "$krs" farm work ../ball.farm --quiet >/dev/null 2>"../$worker.err") &
        eval "$worker=$!"
    done
    sleep 1.$turn
    kill -9 "-$a" 2>/dev/null
    kill "$b" 2>/dev/null
    wait "$a" "$b"
    stopped=$?
done
[ "$stopped" -eq 75 ] || [ "$stopped" -eq 0 ]
result $? "a worker that is asked to end says that it can go on"
(cd elsewhere && "$krs" farm work ../ball.farm >../out.work 2>&1)
grep -q '6 of 6 frames; of 12 pieces 12 done, 0 running, 0 waiting, 0 failed' out.work
result $? "another one does what is left"
same=0
for frame in 3 4 5 6 7 8; do
    cmp -s "pictures/f-000$frame.exr" "one-000$frame.exr" && same=$((same + 1))
done
[ $same -eq 6 ]
result $? "all frames are those of one render"
[ -z "$(ls ball.farm/parts)" ]
result $? "and no part is left"
rm pictures/f-0006.exr
run farm work ball.farm --quiet
cmp -s pictures/f-0006.exr one-0006.exr
result $? "a frame that is lost is rendered again"

# A task of a batch system renders its piece.
rm pictures/f-0003.exr pictures/f-0004.exr
for task in 0 1 2 3; do
    SLURM_ARRAY_TASK_ID=$task "$krs" farm run ball.farm --quiet 2>err || status=1
done
cmp -s pictures/f-0003.exr one-0003.exr && cmp -s pictures/f-0004.exr one-0004.exr && [ ! -e pictures/f-0009.exr ]
result $? "tasks of an array render their pieces, the last one the picture"
rm pictures/f-0007.exr pictures/f-0008.exr
for rank in 0 1 2 3; do
    KRS_FARM_FIRST=8 JOB_COMPLETION_INDEX=$rank "$krs" farm run ball.farm --quiet 2>err
done
cmp -s pictures/f-0007.exr one-0007.exr
result $? "arrays begin where they are told to"
run farm run ball.farm
said 2 "no piece is named" "who knows no piece says so"
run farm run ball.farm --piece 12
ended 2 "nor is there one behind the last"

# Nobody works on what is cancelled.
rm pictures/f-0005.exr
run farm cancel ball.farm
run farm work ball.farm --quiet
[ "$status" -eq 0 ] && [ ! -e pictures/f-0005.exr ]
result $? "what is cancelled is left alone"
run farm retry ball.farm
run farm work ball.farm --quiet
cmp -s pictures/f-0005.exr one-0005.exr
result $? "until it is tried again"

# Another driver.
rm -r ball.farm/probes/* pictures/f-0008.exr
run render other.krs --size 48x27 --samples 2 --seed 1 --rays kernels --integrator path --quiet -o ball.farm/probes/first.exr
run farm work ball.farm --quiet
[ "$status" -eq 69 ] && grep -q "pictures differ" err && [ ! -e pictures/f-0008.exr ]
result $? "a machine with other pictures does not help"

# What fails is tried three times, and said.
cat >late.krs <<'END'
show sphere(0.6).move([0, sqrt(0.1 - time), 0]);
END
run farm submit late.krs --frames 0..5 --size 32x18 --rays kernels -o 'late-%d.exr'
run farm work late.farm
[ "$status" -eq 1 ] && grep -q '3 of 6 frames; of 6 pieces 3 done, 0 running, 0 waiting, 3 failed' out
result $? "frames that fail do not keep the others from being rendered"
grep -q 'piece 4, .*has failed: krs: at time 0.166667 something in the scene is not finite' out
result $? "and what was said is told"
[ "$(wc -l <late.farm/pieces/4.failed)" -eq 3 ]
result $? "after three tries"
run farm logs late.farm
[ "$(grep -c '^==== piece' out)" -eq 3 ] && grep -q "not finite" out
result $? "logs have it all"

# A single picture.
run farm submit other.krs --tiles 3x1 $how --cryptomatte --job still.farm -o still.exr
run farm work still.farm --quiet
run render other.krs $how --cryptomatte --quiet -o once.exr
cmp -s once.exr still.exr
result $? "a single picture is divided, too"

# Samples, too: two ranges of two tiles.
long="--size 32x22 --samples 100 --rays kernels --integrator path --time 0.4"
run farm submit other.krs --tiles 2x1 --split-samples 2 $long --job ranges.farm -o ranges.exr
said 0 "has 4 pieces" "samples are divided"
run farm work ranges.farm --quiet
run render other.krs $long --quiet -o once.exr
cmp -s once.exr ranges.exr
result $? "and the picture is that of all samples"
run farm submit other.krs --split-samples 3 $long --job wrong.farm -o wrong.exr
said 2 "100 samples are at most 2 ranges" "no range is shorter than a block of samples"
run farm submit other.krs --split-samples 2 $long --cryptomatte --job wrong.farm -o wrong.exr
said 2 "a range of --samples" "what has no ranges is refused"

# Who marches the rays of a preview is chosen by times otherwise.
run farm submit other.krs --size 40x30 --tiles 2x2 --job preview.farm -o preview.exr
run farm work preview.farm --quiet
run render other.krs --size 40x30 --rays kernels --quiet -o once.exr
cmp -s once.exr preview.exr && grep -q -- '--rays=kernels' preview.farm/job.json
result $? "tiles of a preview are marched by shaders, whoever would be faster"

# Kubernetes.
run farm submit other.krs --frames 0..9 --tiles 2x1 --kubernetes 'registry.example/krs:1' --job "On Nodes.farm" -o 'k-%d.exr'
ended 0 "a Job of Kubernetes is written"
if python3 -c 'import jsonschema, yaml' 2>/dev/null; then
    python3 "$root/tests/cli/kubernetes_job.py" "On Nodes.farm/kubernetes.yaml" "$PWD/On Nodes.farm" "$PWD" 20 >out 2>err
    result $? "it has the fields of a Job, and wrong ones would be found"
else
    skip "it has the fields of a Job" "python3-jsonschema or python3-yaml is not installed"
fi
run farm submit other.krs --frames 0..200000 --kubernetes image --job wrong.farm -o 'k-%d.exr'
said 2 "at most 100000 pieces" "more pieces than a Job may have are refused"
rm -rf wrong.farm
run farm submit other.krs --kubernetes image --job wrong:farm -o k.exr
said 2 'no `:`' "so is a path that a container cannot have"

# Slurm: a stand-in for sbatch notes how it is called.
mkdir bin
cat >bin/sbatch <<'END'
#!/bin/sh
echo "$@" >>"$SBATCH_LOG"
wc -l <"$SBATCH_LOG"
END
cat >bin/scancel <<'END'
#!/bin/sh
echo "cancel $*" >>"$SBATCH_LOG"
END
chmod +x bin/sbatch bin/scancel
export SBATCH_LOG="$work/sbatch.log"
PATH="$PWD/bin:$PATH" "$krs" farm submit other.krs --frames 0..1499 $how --slurm short --job many.farm -o 'm-%d.exr' 2>err
[ "$(wc -l <sbatch.log)" -eq 3 ] && grep -q -- '--partition=short .*--array=0-999 --export=ALL,KRS_FARM_FIRST=0 ' sbatch.log &&
    grep -q -- '--array=0-499 --export=ALL,KRS_FARM_FIRST=1000 ' sbatch.log && tail -n 1 sbatch.log | grep -q -- '--dependency=afterany:1:2 '
result $? "sbatch gets arrays, and a task behind them"
grep -q "^'.*krs' farm run '$PWD/many.farm' &" many.farm/piece.sh && sh -n many.farm/piece.sh
result $? "whose script renders a piece"
cat >bin/scontrol <<'END'
#!/bin/sh
echo "control $*" >>"$SBATCH_LOG"
END
chmod +x bin/scontrol
run farm submit other.krs --size 320x240 --samples 4000 --rays kernels --integrator path --job long.farm -o long.exr
sed "s:many.farm:long.farm:" many.farm/piece.sh >long.sh
PATH="$PWD/bin:$PATH" SLURM_JOB_ID=77 SLURM_ARRAY_TASK_ID=0 KRS_TEST_CHECKPOINT=0.1 sh long.sh 2>err &
script=$! tries=0
until [ -e long.farm/parts/0-000000.exr.part ] || [ $tries -gt 3000 ]; do
    tries=$((tries + 1))
    sleep 0.02
done
kill -USR1 $script
wait $script
[ -s long.farm/parts/0-000000.exr.part ] && tail -n 1 sbatch.log | grep -q '^control requeue 77$'
result $? "which leaves a checkpoint when its time is over, and queues the task again"
sed -i "s:/long.farm:/still.farm:" long.sh
cp sbatch.log before.log
PATH="$PWD/bin:$PATH" SLURM_JOB_ID=78 SLURM_ARRAY_TASK_ID=0 sh long.sh 2>err && cmp -s before.log sbatch.log
result $? "but not one that is done"
PATH="$PWD/bin:$PATH" "$krs" farm cancel many.farm
tail -n 1 sbatch.log | grep -q '^cancel 1 2 3$'
result $? "scancel ends them"
sed -i '2i [ "$(wc -l <"$SBATCH_LOG")" -lt 1 ] || exit 1' bin/sbatch
: >sbatch.log
PATH="$PWD/bin:$PATH" run farm submit other.krs --frames 0..1499 $how --slurm short --job half.farm -o 'h-%d.exr'
said 74 "sbatch has not taken the job" "where Slurm takes a part of the arrays, this is an error"
PATH="$PWD/bin:$PATH" "$krs" farm cancel half.farm
tail -n 1 sbatch.log | grep -q '^cancel 1$'
result $? "and scancel ends what it has taken"

run farm submit other.krs --size 16384x16384 --tiles 16384x16384 --samples 6 --rays kernels --job wrong.farm -o wrong.exr
said 2 "a job has at most 10000000 pieces" "more pieces than can be counted are refused"

for wrong in "-o still.png" "-o still-%d.exr" "--crop 0,0,9,9 -o still.exr" "--tiles 99x1 -o still.exr"; do
    run farm submit other.krs $how --job wrong.farm $wrong
    [ "$status" -eq 2 ] && [ ! -e wrong.farm ]
    result $? "it is refused: $wrong"
done
