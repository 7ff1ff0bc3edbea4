#!/bin/sh
# exports.sh: export.sh with more examples, of all kinds; those whose shaders SwiftShader compiles for minutes are left out.
cd "$(dirname "$0")/../.." || exit 1
scenes=""
for name in 01-hello 03-machined-part 13-lamps 14-inversion 22-lattice 23-lighthouse 26-gasket 28-sign 30-bolt 31-spring 33-mug 35-jewel \
    38-dodecahedron; do
    scenes="$scenes examples/$name.krs"
done
export KRS_EXPORT_ENGINES="examples/01-hello.krs examples/13-lamps.krs examples/22-lattice.krs examples/26-gasket.krs examples/30-bolt.krs"
KRS_EXPORT_SCENES=${scenes# } exec tests/web/export.sh
