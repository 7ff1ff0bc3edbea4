#!/bin/sh
# format.sh: `krs format` gives scenes the canonical layout, and changes nothing else.
# shellcheck source-path=SCRIPTDIR disable=SC2016
. "$(dirname "$0")/common.sh"
plan 15

cat >wild.krs <<'END_OF_SCENE'


// Two balls, and a cube that is not there.
param  size=1 in[0.5,2]     ;// how large
param colour  =  #ff8800;    // of both
let root = size/2;
let a    =  -root ^ 2;


material steel { color: colour, roughness: 0.3 }
material brass  {
  color : if x>0 then colour
          else [ 1 , 1,0 ],
   roughness:0.4 }
def pair( r ) =
      let left =sphere( r ).move([-r,0, 0]) in
      let right= sphere(r)
         .move( [r,0,0] ) in
  union(left,right,
        blend:0.1) ;
show krs{
kernel (pair(root));
  for i in 0 .. 3 {
      reflect plane([1,0,0],- a);
      } } . paint(steel) ;   /* of
   one metal */
END_OF_SCENE
cat >canonical.krs <<'END_OF_SCENE'
// Two balls, and a cube that is not there.
param size = 1 in [0.5, 2]; // how large
param colour = #ff8800;     // of both
let root = size / 2;
let a    = -root^2;

material steel { color: colour, roughness: 0.3 }
material brass {
    color: if x > 0 then colour
           else [1, 1, 0],
    roughness: 0.4 }
def pair(r) =
    let left = sphere(r).move([-r, 0, 0]) in
    let right = sphere(r)
        .move([r, 0, 0]) in
    union(left, right,
          blend: 0.1);
show krs {
    kernel (pair(root));
    for i in 0..3 {
        reflect plane([1, 0, 0], -a);
    } }.paint(steel); /* of
   one metal */
END_OF_SCENE
cp wild.krs tame.krs
chmod 640 tame.krs
ln -s tame.krs link.krs

run format --check wild.krs canonical.krs
[ "$status" -eq 1 ] && [ "$(cat out)" = wild.krs ] && cmp -s wild.krs tame.krs
result $? "--check names a scene that would change, and does not change it"
run format --check canonical.krs
[ "$status" -eq 0 ] && [ ! -s out ] && [ ! -s err ]
result $? "--check says nothing of a scene in canonical layout"
run format link.krs
[ "$status" -eq 0 ] && [ ! -s err ] && diff canonical.krs tame.krs >out
result $? "a scene gets the canonical layout"
[ -L link.krs ] && [ "$(stat -c %a tame.krs)" = 640 ]
result $? "a link stays a link, and a file keeps its permissions"
touch -d 2001-01-01 tame.krs
run format tame.krs
[ "$status" -eq 0 ] && [ "$(stat -c %Y tame.krs)" = "$(date -d 2001-01-01 +%s)" ]
result $? "a file that has this layout is not written"
"$krs" format - <wild.krs >out 2>err
status=$?
[ "$status" -eq 0 ] && cmp -s out canonical.krs
result $? "standard input goes to standard output"
sed 's/$/\r/' wild.krs | sed '1s/^/\xEF\xBB\xBF/' | "$krs" format - >out 2>err
cmp -s out canonical.krs
result $? "line ends of other systems, and a byte order mark, go"

# What is no scene stays as it is.
printf 'let a = (1 ;\n' >broken.krs
cp broken.krs before.krs
run format broken.krs canonical.krs
[ "$status" -eq 1 ] && grep -q '^error\[E' err && cmp -s broken.krs before.krs
result $? "a text with a mistake is reported as krs check does, and stays"
printf 'show undefined( 1 );\n' >names.krs
run format names.krs
[ "$status" -eq 0 ] && [ "$(cat names.krs)" = 'show undefined(1);' ]
result $? "names need not be known"
run format missing.krs
[ "$status" -eq 74 ] && grep -q 'cannot read `missing.krs`' err
result $? "a file that is not there is an error of its own"
: >empty.krs
run format --check empty.krs
[ "$status" -eq 0 ]
result $? "an empty text has the canonical layout"
# A text ends at a zero byte, so one that has it in a comment would lose the rest.
printf '/* a\000b */ show sphere(1);\n' >zero.krs
cp zero.krs kept.krs
run format zero.krs
[ "$status" -eq 1 ] && grep -q 'E0102.*zero byte' err && cmp -s zero.krs kept.krs
result $? "a zero byte in a comment is a mistake"

# Scenes of all kinds, with their blanks spoilt: the trees stay, and the layout is its own.
tree() { "$krs" dump --quiet --after=parse "$1" 2>/dev/null | sed 's/ [0-9]*:[0-9]*$//'; }
spoilt=0 same=0 own=0
for scene in "$root"/examples/*.krs "$root"/compiler/library/*.krs "$root"/compiler/library/std/*.krs; do
    sed -e '/\/\//!s/ *\([][+*,:;(){}<>=]\) */\1/g; s/^  */ /; s/\([<>=]\)/ \1/' \
        -e 's/< =/<=/g; s/> =/>=/g; s/= =/==/g; s/! =/!=/g' "$scene" >spoilt.krs
    tree spoilt.krs >before
    cp spoilt.krs formatted.krs
    "$krs" format formatted.krs 2>>err
    [ -s spoilt.krs ] && ! cmp -s spoilt.krs formatted.krs && tree formatted.krs | cmp -s - before && same=$((same + 1))
    "$krs" format --check formatted.krs >/dev/null && own=$((own + 1))
    spoilt=$((spoilt + 1))
done
[ "$spoilt" -gt 40 ] && [ "$same" -eq "$spoilt" ]
result $? "the tree of a scene stays"
[ "$own" -eq "$spoilt" ]
result $? "what has been laid out has the canonical layout"

"$krs" format --check "$root"/examples/*.krs "$root"/examples/*/*.krs "$root"/compiler/library/*.krs \
    "$root"/compiler/library/std/*.krs >out 2>err
result $? "the examples and the library have it"
