#!/bin/sh
# deps.sh: installs the Debian packages that building and testing need and that are missing.
# Says what it does; uses sudo when it is not run by root; does nothing when nothing is missing.
packages="g++ glslang-dev glslang-tools spirv-tools libvulkan-dev mesa-vulkan-drivers
          vulkan-validationlayers libopenexr-dev libdeflate-dev libpng-dev libxxhash-dev libqhull-dev libfreetype-dev
          libharfbuzz-dev libfontconfig-dev libexpat1-dev fonts-dejavu-core libglfw3-dev libimgui-dev libgl-dev libchafa-dev
          libx11-dev libgl1-mesa-dri xvfb xdotool openbox libcmocka-dev clang-14
          clang-format-14 libclang-rt-14-dev shellcheck strace openexr patch pkgconf
          chromium-common admesh libtinygltf-dev lib3mf-dev libmeshoptimizer-dev assimp-utils python3-numpy libcgal-dev"

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
echo "deps: installing$missing"
$root apt-get update -qq >/dev/null || exit 1
# shellcheck disable=SC2086 # the list is words
$root env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -qq --no-install-recommends $missing >/dev/null || exit 1
echo "deps: done"
