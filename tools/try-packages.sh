#!/bin/sh
# try-packages.sh FOLDER: tries Debian's packages, which lie there, as their users would: lintian reads them; in a bare system of
# the Debian that this machine has, which they are built for, they are installed, used and removed.  On Debian 12 the source package is
# also built in a bare Debian 13, and what comes of it is tried there.
# Bare systems come from the servers of packages, by mmdebstrap; where that or lintian is missing, its part is skipped.
folder=$(cd "$1" && pwd) || exit 1
cd "$(dirname "$0")/.." || exit 1
passed=0 failed=0 skipped=0
result() { # status, what
    if [ "$1" -eq 0 ]; then
        passed=$((passed + 1)) && echo "ok $((passed + failed)) - $2"
    else
        failed=$((failed + 1)) && echo "not ok $((passed + failed)) - $2"
    fi
}
skip() { # what, why
    skipped=$((skipped + 1))
    echo "ok - $1 # SKIP $2"
}
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT

if command -v lintian >/dev/null; then
    # They are no upload to Debian, which would close a bug there.
    lintian --fail-on error,warning --suppress-tags initial-upload-closes-no-bugs "$folder"/*.changes >"$work/lintian" 2>&1
    result $? "lintian finds neither errors nor warnings"
    grep '^[EW]:' "$work/lintian"
else
    skip "lintian finds neither errors nor warnings" "no lintian"
fi

# Makes a bare system of a suite, whose script is run there beside the folders that are copied in; what it leaves in /out comes back.
bare() { # suite, script, folder...
    suite=$1 script=$2
    shift 2
    mkdir -p "$work/out"
    # shellcheck disable=SC2016 # mmdebstrap gives $1 to the hook
    mmdebstrap --variant=apt --customize-hook='mkdir "$1/out"' --customize-hook="copy-in $* /" --customize-hook="copy-in $work/$script /tmp" \
        --customize-hook="chroot \"\$1\" sh /tmp/$script" --customize-hook="sync-out /out $work/out" "$suite" /dev/null >"$work/log" 2>&1
    status=$?
    [ $status -eq 0 ] || tail -n 20 "$work/log"
    return $status
}
cat >"$work/try" <<'END'
set -e
export DEBIAN_FRONTEND=noninteractive AUTOPKGTEST_TMP=/tmp/scenes XDG_CACHE_HOME=/tmp/caches
left() { find / -xdev \( -path /proc -o -path /tmp -o -path /packages -o -path /var/lib/apt \) -prune -o -name '*krs*' -print | sort; }
left >/tmp/before
apt-get install -y -qq --no-install-recommends /packages/*.deb mesa-vulkan-drivers gcc libc6-dev pkgconf >/dev/null
for test in render library python; do
    mkdir -p "$AUTOPKGTEST_TMP"
    /packages/tests/$test
    rm -rf "$AUTOPKGTEST_TMP"
done
apt-get purge -y -qq krs libkrs0.2 libkrs-dev python3-krs krs-doc >/dev/null
left >/tmp/after
diff /tmp/before /tmp/after
END
cat >"$work/build" <<'END'
set -e
export DEBIAN_FRONTEND=noninteractive
apt-get install -y -qq --no-install-recommends build-essential >/dev/null
mkdir /krs && cd /krs
dpkg-source --no-check -x /source/*.dsc krs
cd krs
apt-get build-dep -y -qq --no-install-recommends . >/dev/null
DEB_BUILD_OPTIONS=parallel=$(nproc) dpkg-buildpackage -us -uc -b
cp ../*.deb /out
END
# Installs, uses and removes the packages of a folder.
try() { # suite, folder
    rm -rf "$work/packages" && mkdir "$work/packages" && cp -r "$2"/*.deb debian/tests "$work/packages"
    bare "$1" try "$work/packages"
    result $? "$1: packages are installed, work, and leave nothing"
}
suite=$(sed -n 's/^VERSION_CODENAME=//p' /etc/os-release)
if command -v mmdebstrap >/dev/null; then
    try "$suite" "$folder"
    # The next Debian builds packages of its own, of the same source.
    if [ "$suite" = bookworm ]; then
        mkdir "$work/source" && cp "$folder"/*.dsc "$folder"/*.orig.tar.gz "$folder"/*.debian.tar.xz "$work/source"
        bare trixie build "$work/source"
        result $? "trixie: the source package is built"
        try trixie "$work/out"
    fi
else
    skip "$suite: packages are installed, work, and leave nothing" "no mmdebstrap"
fi
echo "$passed passed, $failed failed, $skipped skipped"
[ "$failed" -eq 0 ]
