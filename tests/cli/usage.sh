#!/bin/sh
# usage.sh: command lines that are wrong, and the pages of help.
# shellcheck source-path=SCRIPTDIR
. "$(dirname "$0")/common.sh"
plan 69

run
said 2 "no command is given" "no command"
run rendr ball.krs
said 2 "did you mean \`render\`?" "a misspelt command"
run frobnicate
said 2 "there is no command \`frobnicate\`" "an unknown command"
run format --size 9x9 ball.krs
said 2 "size" "an option that lays out nothing"
run render ball.krs --sise 8x8
said 2 "did you mean --size?" "a misspelt option"
run check ball.krs --size 8x8
said 2 "check has no option --size" "an option of another command"
run render ball.krs -z
said 2 "render has no option -z" "an unknown letter"
run render ball.krs --size
said 2 "--size needs an argument: WxH" "an argument that is missing"
run render ball.krs --stamp=yes
said 2 "--stamp takes no argument" "an argument that is too much"
run render
said 2 "render needs a scene" "no scene"
run render ball.krs ball.krs
said 2 "render takes one scene" "two scenes where one is rendered"
run devices ball.krs
said 2 "devices takes no file" "a scene where none is needed"

for size in 0x8 8x0 8 8x 8x8x8 ax8 -8x8 16385x8 2147483648x2 4294967297x8 1e3x8 ' 8x8' 8.5x8; do
    run render ball.krs --size "$size"
    said 2 "each from 1 to 16384" "--size $size"
done
run render ball.krs --samples 0
said 2 "--samples wants" "no samples"
run render ball.krs --crop 0,0,0,8
said 2 "--crop wants" "an empty crop"
run render ball.krs --size 8x8 --crop 4,4,8,8
said 2 "is not inside of a picture of 8x8" "a crop that sticks out"
run render ball.krs --time nan
said 2 "--time wants" "a time that is no number"
run render ball.krs --time 1e300
said 2 "--time wants" "a time that float numbers cannot hold"
run render ball.krs --frames 5..3
said 2 "--frames wants" "frames that run backwards"
run render ball.krs --frames 0..3 -o a.exr
said 2 "needs a place for the number" "frames that would overwrite each other"
for option in --deadline=1e7 --fps=0 --error=0 --device=; do
    run render ball.krs "$option"
    said 2 "${option%%=*} wants" "$option"
done
run import ball.jsurf -o a.krs -o b.krs
said 2 "import writes one scene, not 2" "two scenes from one file"
run render ball.krs --aov Z,Q
said 2 "--aov wants" "an unknown channel"
run render ball.krs -o ball.jpg
said 2 "ends in neither .exr nor .png" "an unknown form of picture"
run render ball.krs --camera sied
said 2 "did you mean \`side\`?" "a misspelt camera"
run render ball.krs --camera overhead
said 2 "has no camera \`overhead\`; it has \`" "an unknown camera"
run render ball.krs --integrator foo
said 2 "--integrator wants preview" "an unknown integrator"
run render ball.krs --resume --raw
said 2 "beside the first output" "checkpoints without a place"
run query ball.krs --set radus=1
said 2 "did you mean \`radius\`?" "a misspelt param"
run query ball.krs --set radius=7
said 2 "goes from 0.5 to 1.5" "a param out of range"
run query ball.krs --set 'radius=[1,2]'
said 2 "takes 1 number, not 2" "a vector for a number"
run query ball.krs --set radius=one
said 2 "--set wants" "a value that is no number"
run query ball.krs --set radius=60deg
[ "$status" -eq 0 ]
result $? "an angle in degrees"
run query ball.krs --set radius=60degs
said 2 "--set wants" "an angle with a misspelt unit"
cat >tinted.krs <<'END'
param tint = [0.1, 0.2, 0.3];
param turn = 30deg in [0deg, 90deg];
camera low { eye: [5, 0, 0] }
camera high { eye: [0, 5, 1] }
show box([1, 2, 3]).rotate([0, 1, 0], turn).paint(tint);
END
# What a value is, the picture says.
for setting in 'tint=tomato [1, 0.1' 'tint=1,0.5,0.25 [1, 0.5, 0.25]' 'turn=2*pi/8 0.785398' \
    'tint=mix(black,white,0.5) [0.5, 0.5, 0.5]'; do
    run render tinted.krs --size 8x8 --quiet --set "${setting%% *}" -o tinted.exr
    [ "$status" -eq 0 ] && strings tinted.exr | grep -qF -- "=${setting#* }"
    result $? "--set ${setting%% *}"
done
run query tinted.krs --set tint=orng
said 2 "\`orng\` in --set tint: the name \`orng\` is not defined" "a value with a mistake"
run query tinted.krs --set turn=2
said 2 "param \`turn\` goes from 0deg to 90deg; 114.592deg is outside" "a range in degrees"
run render tinted.krs --camera hihg
said 2 "did you mean \`high\`? It has \`low\`, \`high\`" "the cameras that there are"
run query --set turn=1 - 
said 2 "standard input has the questions" "questions and scene on standard input"
run --exit-map
said 2 "there is no command" "an option without a command"

run --help
[ "$status" -eq 0 ] && [ ! -s err ] && grep -q 'render' out
result $? "krs --help"
cp out page
run help
[ "$status" -eq 0 ] && cmp -s out page
result $? "krs help is the same"
run render --help
cp out page
run help render
[ "$status" -eq 0 ] && cmp -s out page && run --help render && cmp -s out page
result $? "krs help render is krs render --help"
run help rendr
said 2 "did you mean \`render\`?" "help of a misspelt command"
# What a page has of options, a line each: its heading, a colon, the name.
listed() {
    awk '/^[A-Z].*:$/ { heading = $0 } /^    (-[a-z], )?--/ { sub(/^ *(-[a-z], )?--/, ""); print heading $1 }'
}
run help render
listed <out >few
grep -q "^More options.*krs help render --all" out
result $? "the page of render names the page of all options"
run help render --all
listed <out >all
for option in trace schedule even-hits starts components beams upsampling early-outs normals filter; do
    grep -q ":$option$" few || grep -qx "Research:$option" all || echo "$option"
done >out
[ ! -s out ] && [ -s few ] && grep -v '^Research:' all | cmp -s - few
result $? "options that compare methods stand on that page alone, and all else is the same"
for place in Picture:size Picture:samples Camera:camera 'Time, parameters and zones:time' \
    'Light and colour:integrator' Animation:frames Compositing:cryptomatte 'Device and cache:device' \
    'Device and cache:cache' 'Limits and scenes of strangers:untrusted' 'Messages and exit status:help'; do
    grep -qx "$place" few || echo "$place"
done >out
[ ! -s out ]
result $? "options stand under the heading of what they are about"
# By the rows themselves: a command that is not given is none of the page.
wrong=""
commands=$(sed -n 's/^COMMAND([A-Z]*, "\([a-z]*\)".*/\1/p' "$root/cli/options/commands.def")
for command in $commands; do
    run help "$command" --all
    listed <out | sed 's/.*://' | sort >shown
    name=$(echo "$command" | tr '[:lower:]' '[:upper:]')
    for word in ON_ALL "ON($name)"; do
        sed -n "s/^OPTION([^\"]*\"\([a-z-]*\)\".*[ |]$(echo "$word" | sed 's/[()]/[&]/g')[ ,].*/\1/p" \
            "$root/cli/options/options.def"
    done | sort | comm -23 - shown >out
    [ ! -s out ] && [ -s shown ] && [ -z "$(uniq -d shown)" ] || wrong="$wrong $command"
    # A heading stands once, and above a screen's half of options at most.
    run help "$command" --all
    [ -z "$(grep '^[A-Z].*:$' out | sort | uniq -d)" ] &&
        ! sed -n '/^usage/,$p' out | tail -n +2 | grep -q '.\{81\}' &&
        listed <out | sed 's/:[^:]*$//' | sort | uniq -c | awk '$1 > 12 { exit 1 }' || wrong="$wrong $command"
done
[ -z "$wrong" ] && [ "$(echo "$commands" | wc -l)" -gt 10 ]
result $? "each option stands once, under headings that have a dozen at most, in 80 columns$wrong"
run render --all ball.krs
said 2 "render has no option --all" "the option of help is that of help alone"
run --version
[ "$status" -eq 0 ] && grep -q '^krs [0-9]' out && grep -q 'OpenEXRCore [0-9]' out &&
    grep -q 'glslang [0-9]' out
result $? "krs --version names the libraries"
incomplete=""
for command in render compile validate query info devices check dump import explain help; do
    run "$command" --help
    [ "$status" -eq 0 ] && [ "$(sed -n 3p out | cut -c1-8)" = "    krs " ] ||
        incomplete="$incomplete $command"
done
[ -z "$incomplete" ]
result $? "every command has a page that begins with examples$incomplete"
