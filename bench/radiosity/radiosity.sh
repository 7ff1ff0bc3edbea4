#!/bin/sh
# radiosity.sh KRS: a room by POV-Ray's radiosity and by the integrator `path` in the same processor
# time, both held against many samples of `path`.  `make bench-radiosity`.  POV-Ray is Debian's package povray.
set -u
cd "$(dirname "$0")/../.." || exit 1
krs=${1:-build/krs}
width=${WIDTH:-160} height=${HEIGHT:-120} reference=${REFERENCE:-4096}
command -v povray >/dev/null || { echo "radiosity.sh: povray is not installed"; exit 77; }
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT
"${CC:-cc}" -std=c17 -D_GNU_SOURCE -o "$work/exr_text" tests/cli/exr_text.c -lOpenEXRCore || exit 1

seconds() { # of the processor, that a command takes
    /usr/bin/time -f '%U %S' -o "$work/time" "$@" >/dev/null 2>&1 && awk '{ print $1 + $2 }' "$work/time"
}
by_krs() { # samples, seed, file
    seconds "$krs" render bench/radiosity/room.krs --integrator path --size "${width}x$height" --samples "$1" \
        --seed "$2" --aov none --quiet --device cpu -o "$3"
}
by_povray() {
    seconds povray bench/radiosity/room.pov "+W$width" "+H$height" -D -A +FP16 File_Gamma=1.0 "+O$work/povray.ppm"
}
green_of_exr() { "$work/exr_text" "$1" G | awk '{ print $2, $3, $4 }'; }
green_of_ppm() { # binary, of 16 bits
    tail -c $((6 * width * height)) "$1" | od -A n -v -t u1 -w6 |
        awk -v w="$width" '{ n = NR - 1; print n % w, int(n / w), ($3 * 256 + $4) / 65535 }'
}
# The error of pixels, and of means of 8x8 pixels, in parts of the mean: noise has gone from the latter.
errors() { # file, reference
    awk 'NR == FNR { truth[$1, $2] = $3; sum += $3; count++; next }
         { off = $3 - truth[$1, $2]; squares += off * off; block[int($1 / 8), int($2 / 8)] += off / 64 }
         END { for (b in block) { blocks++; large += block[b] ^ 2 }
               printf "%.3f | %.4f\n", sqrt(squares / count) * count / sum, sqrt(large / blocks) * count / sum }' "$2" "$1"
}

by_krs "$reference" 1 "$work/truth.exr" >/dev/null
green_of_exr "$work/truth.exr" >"$work/truth"
povray=$(by_povray)
green_of_ppm "$work/povray.ppm" >"$work/povray"
few=$(by_krs 16 2 "$work/few.exr") many=$(by_krs 144 2 "$work/many.exr")
samples=$(awk -v t="$povray" -v a="$few" -v b="$many" 'BEGIN { n = 16 + (t - a) * 128 / (b - a); print n < 1 ? 1 : int(n) }')
path=$(by_krs "$samples" 2 "$work/path.exr")
green_of_exr "$work/path.exr" >"$work/path"
echo "| ${width}x$height | CPU seconds | error of pixels | of means of 8x8 pixels |"
echo "| --- | --- | --- | --- |"
echo "| POV-Ray, radiosity | $povray | $(errors "$work/povray" "$work/truth") |"
echo "| krs, \`path\`, $samples samples | $path | $(errors "$work/path" "$work/truth") |"
[ -z "${KEEP:-}" ] || cp "$work/povray.ppm" "$work/path.exr" "$KEEP"
