#!/bin/sh
# sources.sh FOLDER PACKAGE...: unpacks the sources of Debian packages into FOLDER/PACKAGE, with Debian's patches.
#
# It reads lists of its own, below the folder: those of the system, asked for sources.  Nothing of the system changes, and
# nobody needs to be root.  What is there stays.
set -eu
folder=$1
shift
missing=""
for package in "$@"; do
    [ -d "$folder/$package" ] || missing="$missing $package"
done
[ -z "$missing" ] && exit 0
mkdir -p "$folder/apt/lists/partial" "$folder/apt/cache/partial"
apt=$(cd "$folder/apt" && pwd)
{
    for list in /etc/apt/sources.list /etc/apt/sources.list.d/*.list; do
        [ -f "$list" ] && sed -n 's/^deb /deb-src /p' "$list"
    done
    :
} >"$apt/sources.list"
mkdir -p "$apt/parts"
for list in /etc/apt/sources.list.d/*.sources; do
    [ -f "$list" ] && sed 's/^Types:.*/Types: deb-src/' "$list" >"$apt/parts/${list##*/}"
done
get() {
    apt-get -qq -o Dir::Etc::SourceList="$apt/sources.list" -o Dir::Etc::SourceParts="$apt/parts" \
        -o Dir::State="$apt" -o Dir::State::Lists="$apt/lists" -o Dir::Cache="$apt/cache" -o APT::Sandbox::User="" "$@"
}
get update
cd "$folder"
release=$(sed -n 's/^VERSION_CODENAME=//p' /etc/os-release)
for package in $missing; do
    # A mirror may not have what was mended since the release.
    get source "$package" >/dev/null 2>&1 || get source "$package/$release" >/dev/null
    mv "$(find . -maxdepth 1 -type d -name "$package-[0-9]*" | head -n 1)" "$package"
done
