#!/bin/sh
# gallery.sh: what `make demo` and `make gallery` make and show (tools/gallery.sh, tools/pictures.txt), by a command that
# understands the options as `krs` does, but draws nothing.
cd "$(dirname "$0")/.." || exit 1
krs=${KRS:-build/krs}
case $krs in /*) ;; *) krs=$PWD/$krs ;; esac
build=$(mktemp -d) && trap 'rm -rf "$build"' EXIT
failed=0
report() { # name, status
    if [ "$2" -eq 0 ]; then echo "ok - $1"; else echo "not ok - $1"; failed=1; fi
}
cat >"$build/krs" <<END
#!/bin/sh
'$krs' "\$@" --help >/dev/null && [ -s "\$2" ] || exit 2
while [ \$# -gt 0 ]; do
    [ "\$1" != -o ] || echo drawn >"\$2"
    shift
done
END
chmod +x "$build/krs"
made() { (cd "$1" && find . -type f ! -name index.html | sed 's|^\./||' | sort); }

for set in demo gallery; do
    tools/gallery.sh "$build" $set >"$build/said" 2>&1
    report "the scenes of the $set are there, and its options are options of the command" $?
    page=$build/$set/index.html
    made "$build/$set" >"$build/files"
    grep -o 'href="[^"]*"\|src="[^"]*"' "$page" | sed 's/^[^"]*"//; s/"//' | sort -u | cmp - "$build/files"
    report "its page shows each file, and no other" $?
    grep -c '<figure>' "$page" | grep -qx "$(grep -c 'png$' "$build/files")"
    report "each picture once" $?
    ! grep -q '<script\|http' "$page"
    report "without a script or a network" $?
    sed -n 's|.*<code>\(.*krs .*\)</code>.*|\1|p' "$page" >"$build/commands"
    mkdir "$build/kept" && mv "$build/$set"/* "$build/kept"
    sh -e "$build/commands" && made "$build/$set" | cmp - "$build/files"
    report "the commands that it shows make these files" $?
    rm -r "$build/kept"
done
for scene in examples/*.krs; do
    grep -qF " $scene " "$build/commands" || echo "$scene"
done >"$build/said"
[ ! -s "$build/said" ]
report "the gallery has every example" $?
sed 's/^/# /' "$build/said"
files=$(made "$build/demo")
[ "$(echo "$files" | grep -c 'png$')" -eq 12 ] && [ "$(echo "$files" | grep -c 'stl$')" -eq 2 ] &&
    echo "$files" | grep -q 'exr$'
report "the demo has a dozen of pictures, an EXR and two meshes" $?
tools/gallery.sh "$build" demo no-such-picture >"$build/said" 2>&1
[ $? -eq 1 ] && grep -q 'has no picture no-such-picture' "$build/said"
report "a name that is not there is told" $?
sed -i 's/|| exit 2/|| exit 2; exit 3/' "$build/krs"
tools/gallery.sh "$build" demo >"$build/said" 2>&1
[ $? -eq 1 ] && ! grep -q 'done after' "$build/said"
report "a picture that fails ends it with status 1" $?
exit $failed
