#!/bin/sh
# deps.sh [test|wasm|faces]: installs the Debian packages that are missing, of those that building and rendering need,
# and with `test` also of those that only tests need, and libopenvdb-dev, which is large and writes .vdb alone; with
# `wasm` what `make wasm` needs; with `faces` what `test` installs, and editors.
# It knows Debian 12 and 13, and Ubuntu 24.04: what only tests need and the system does not offer is left out.
# Says what it does; uses sudo when it is not run by root; does nothing when nothing is missing.
building="g++ glslang-dev glslang-tools spirv-tools libvulkan-dev libopenexr-dev libdeflate-dev libpng-dev libxxhash-dev
          libqhull-dev libfreetype-dev libharfbuzz-dev libfontconfig-dev libexpat1-dev libglfw3-dev libimgui-dev libgl-dev
          libchafa-dev libx11-dev libtinygltf-dev libzip-dev libmeshoptimizer-dev libjansson-dev libseccomp-dev pkgconf"
rendering="mesa-vulkan-drivers libgl1-mesa-dri fonts-dejavu-core"
testing="vulkan-validationlayers xvfb xdotool openbox libcmocka-dev clang clang-format libclang-rt-dev lld
         shellcheck strace procps openexr patch chromium-common admesh assimp-utils python3-numpy libcgal-dev
         libegl-dev libgles-dev libopenvdb-dev python3-openvdb python3-nibabel neovim
         python3-cffi python3-build python3-setuptools python3-wheel python3-venv mypy spirv-cross mono-mcs
         python3-jsonschema python3-yaml desktop-file-utils appstream shared-mime-info"
web="emscripten nodejs dpkg-dev"
browsing="chromium esbuild"
editing="vim emacs-nox elpa-eglot"

case ${1:-} in
wasm) packages="$building $web" ;;
test) packages="$building $rendering $testing $web $browsing" ;;
faces) packages="$building $rendering $testing $web $browsing $editing" ;;
*) packages="$building $rendering" ;;
esac
missing=""
for package in $packages; do
    status=$(dpkg-query -W -f '${Status}' "$package" 2>/dev/null)
    [ "$status" = "install ok installed" ] || missing="$missing $package"
done
[ -z "$missing" ] && exit 0

if ! command -v apt-get >/dev/null; then
    echo "deps: this is no Debian; please install what these packages hold:$missing" >&2
    exit 1
fi
root=""
if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
        echo "deps: missing$missing: run as root, or install sudo" >&2
        exit 1
    fi
    root="sudo"
fi
$root apt-get update -qq >/dev/null || exit 1
is_for_tests() { # package
    for other in $testing $web $browsing $editing; do
        [ "$other" = "$1" ] && return 0
    done
    return 1
}
absent="" wanted=""
for package in $missing; do
    if is_for_tests "$package" && [ -z "$(apt-cache madison "$package")" ]; then
        absent="$absent $package"
    else
        wanted="$wanted $package"
    fi
done
[ -z "$absent" ] || echo "deps: not offered here, so tests that need it are skipped:$absent"
[ -z "$wanted" ] && exit 0
echo "deps: installing$wanted"
# shellcheck disable=SC2086 # the list is words
$root env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -qq --no-install-recommends $wanted >/dev/null || exit 1
echo "deps: done"
