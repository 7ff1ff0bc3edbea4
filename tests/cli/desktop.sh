#!/bin/sh
# desktop.sh: what desktops know of scenes is right: the tools of desktops read it, and the thumbnailer's line makes a picture,
# also of a scene that reads outside of its folder: none.
# shellcheck source-path=SCRIPTDIR
. "$(dirname "$0")/common.sh"
plan 6
files="$root/tools/desktop"

if command -v desktop-file-validate >/dev/null; then
    desktop-file-validate "$files/krs.desktop" >out 2>err && [ ! -s out ]
    result $? "the entry of menus is valid"
    sed 's/^Type=.*/Type=Lamp/' "$files/krs.desktop" >bad.desktop
    ! desktop-file-validate bad.desktop >out 2>err
    result $? "another type is found"
else
    skip "the entry of menus is valid" "no desktop-file-validate"
    skip "another type is found" "no desktop-file-validate"
fi
if command -v appstreamcli >/dev/null; then
    # The project has no domain that its name could be in.
    appstreamcli validate --no-net --override=cid-desktopapp-is-not-rdns=info "$files/krs.metainfo.xml" >out 2>err
    result $? "AppStream's description is valid"
else
    skip "AppStream's description is valid" "no appstreamcli"
fi
if command -v update-mime-database >/dev/null; then
    mkdir -p mime/packages && cp "$files/krs.mime.xml" mime/packages
    update-mime-database mime >out 2>err && grep -q '^text/x-krs:\*\.krs$' mime/globs
    result $? "files that end in .krs are scenes"
else
    skip "files that end in .krs are scenes" "no update-mime-database"
fi

# thumbnail SCENE FILE SIZE: runs the line of the thumbnailer.
thumbnail() {
    line=$(sed -n 's/^Exec=krs //p' "$files/krs.thumbnailer" | sed "s,%i,$1,; s,%o,$2,; s,%s,$3,g")
    # shellcheck disable=SC2086 # the line is words
    "$krs" $line >out 2>err
}
echo 'show sphere(1) - box([0.5, 4, 0.5]);' >ball.krs
thumbnail ball.krs ball.png 128 && [ "$(od -A n -t u1 -j 19 -N 1 ball.png)" -eq 128 ] &&
    [ "$(od -A n -t u1 -j 23 -N 1 ball.png)" -eq 128 ]
result $? "the thumbnailer makes a picture of the size that is asked for"
mkdir -p inner && echo 'use "../ball.krs"; show sphere(1);' >inner/reader.krs
! thumbnail inner/reader.krs reader.png 64 && [ ! -e reader.png ]
result $? "and none of a scene that reads outside of its folder"
