#!/bin/sh
# turntable.sh BUILD: renders docs/pictures/turntable.webp, the glass star of examples/35-jewel.krs
# as it turns by a fifth, after which it is the same again.  The frames go from `krs render --raw`
# straight into an encoder: ffmpeg, which nothing else here needs.
build=$1
cd "$(dirname "$0")/.." || exit 1
frames=36 rate=18 size=400x340 samples=16
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT
sed -e "s/\[0, 1, 0\], turn)/[0, 1, 0], turn + 72deg * time * $rate \/ $frames)/" \
    -e 's/target: \[0.1, 1.5, 0\], fov: 31deg/target: [0, 1.63, 0], fov: 29deg/' \
    examples/35-jewel.krs >"$work/turntable.krs"
grep -q '72deg \* time' "$work/turntable.krs" || exit 1
"$build/krs" render "$work/turntable.krs" --integrator preview --size $size --samples $samples \
    --frames 0..$((frames - 1)) --fps $rate --raw |
    ffmpeg -loglevel error -y -f rawvideo -pixel_format rgb24 -video_size $size -framerate $rate \
        -i - -c:v libwebp_anim -loop 0 -quality 85 docs/pictures/turntable.webp
