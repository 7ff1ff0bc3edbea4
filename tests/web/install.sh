#!/bin/sh
# install.sh: the package for pages is packed, installed into an empty project, bundled, and shows a scene.
. "$(dirname "$0")/../support/pages.sh"
for command in npm esbuild; do
    if ! command -v $command >/dev/null; then
        echo "ok 1 - install # SKIP no $command"
        exit 0
    fi
done
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT
failed=0
report() { # status, number, name
    if [ "$1" -eq 0 ]; then echo "ok $2 - $3"; else echo "not ok $2 - $3"; failed=1; fi
}
here=$PWD
mkdir "$work/project" "$work/site"
(cd "$build/web" && npm pack --silent --pack-destination "$work" >"$work/said") && cd "$work/project" &&
    echo '{ "type": "module", "private": true }' >package.json &&
    npm install --offline --no-audit --no-fund --silent "$work/$(cat "$work/said")"
report $? 1 "the package is packed and installed"

cat >app.mjs <<'END'
import * as krs from 'krs';
krs.locate('krs/');
const view = document.querySelector('krs-view'); // it was there before this program
view.samples = 1;
await view.update('material red { color: #e01010 }\nshow sphere(1).paint(red);\nsky { zenith: #80a0ff, horizon: #80a0ff, ground: #80a0ff }\n' +
    'camera { eye: [0, 0, 5], target: [0, 0, 0], fov: 40deg }\nlight { direction: [0, 0, 1] }', { name: 'ball.krs' });
await view.ready;
const canvas = new OffscreenCanvas(96, 54), context = canvas.getContext('2d');
context.drawImage(await createImageBitmap(await view.snapshot(96, 54)), 0, 0);
window.shown = [[48, 27], [2, 2]].map(([x, y]) => Array.from(context.getImageData(x, y, 1, 1).data));
END
cp "$here/web/examples/three.mjs" "$here/web/examples/react.jsx" . && cp -r node_modules/krs "$work/site/krs" &&
    esbuild app.mjs --bundle --format=esm --log-level=error --outfile="$work/site/app.js" &&
    esbuild three.mjs react.jsx --bundle --format=esm --log-level=error --external:three --external:react --external:react-dom/client --jsx=automatic \
        --external:react/jsx-runtime --outdir="$work/bundles"
report $? 2 "programs with it are bundled"
cd "$here" || exit 1
node tests/web/install.mjs "$work/site" || failed=1
echo 1..3
exit $failed
