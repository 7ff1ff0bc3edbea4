#!/bin/sh
# python.sh: the package for Python answers as closed forms do, its page and its comments tell the truth, and its wheel
# works in an environment of its own.
cd "$(dirname "$0")/.." || exit 1
build=${B:-build}
case $build in /*) ;; *) build=$PWD/$build ;; esac
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT
failed=0
number=0
report() { # status, name
    number=$((number + 1))
    [ "$1" -eq 0 ] && echo "ok $number - $2" && return
    echo "not ok $number - $2"
    failed=1
    tail -n 20 "$work/said" | sed 's/^/# /'
}
skip() { # name, why
    number=$((number + 1))
    echo "ok $number - $1 # SKIP $2"
}
. tests/support/python.sh
package=$build/python
echo "1..6"
make_python python >"$work/said" 2>&1
report $? "the package is made"

# ---- types ----
if command -v mypy >/dev/null; then
    cat >"$work/typed.py" <<'END'
import krs
scene: krs.Scene = krs.compile("show sphere(1);")
shape: krs.Expression = krs.sphere(radius=1).move([1, 0, 0]) | krs.box([1, 2, 3])
volume: float = scene.mesh(0.1).volume
END
    (cd "$work" && MYPYPATH="$package" mypy --ignore-missing-imports --python-executable "$python" typed.py) >"$work/said" 2>&1
    report $? "its types agree with each other, and with who uses them"
    echo 'import krs; krs.sphere(1).mesh: int; krs.compile(1, nam="x").r = krs.sphere(radus=2)' >"$work/typed.py"
    ! (cd "$work" && MYPYPATH="$package" mypy --ignore-missing-imports --python-executable "$python" typed.py) >"$work/said" 2>&1 &&
        grep -q '"radus"' "$work/said"
    report $? "a parameter that is misspelt would be found"
else
    skip "its types agree with each other, and with who uses them" "no mypy"
    skip "a parameter that is misspelt would be found" "no mypy"
fi

# ---- the library that is loaded ----
KRS_LIBRARY="$work/none.so" PYTHONPATH="$package" "$python" -c 'import krs' >"$work/said" 2>&1
[ $? -eq 1 ] && grep -q 'ImportError: cannot load the library of krs.*none.so' "$work/said"
report $? "KRS_LIBRARY names the library, and a missing one is told"

# ---- a wheel ----
if ! "$python" -c 'import build, setuptools, wheel, venv, ensurepip' 2>/dev/null; then
    skip "a wheel of this platform is made" "no build, setuptools, wheel or venv"
    skip "it works in an environment of its own" "no wheel"
else
    make_python wheel >"$work/said" 2>&1 &&
        wheel=$(ls "$package"/dist/krs-*-py3-none-linux_*.whl) && [ -s "$wheel" ]
    report $? "a wheel of this platform is made"
    "$python" -m venv --system-site-packages "$work/venv" >"$work/said" 2>&1 &&
        "$work/venv/bin/pip" install --no-index --no-deps "$wheel" >>"$work/said" 2>&1 &&
        (cd / && env -u PYTHONPATH -u KRS_LIBRARY "$work/venv/bin/python" -c '
import os, sys, krs
assert os.path.realpath(krs.__file__).startswith(os.path.realpath(sys.prefix)), krs.__file__
assert os.path.exists(os.path.join(os.path.dirname(krs.__file__), "py.typed"))
assert krs.sphere(2).compile().distance([0, 0, 3]) == 1') >>"$work/said" 2>&1
    report $? "it works in an environment of its own"
fi

# ---- what it does ----
PYTHONPATH="$package:tests/python" "$python" tests/python/tap.py declarations questions solids pictures built views krs.scene krs.expressions krs.words krs.picture docs/python.md
status=$?
[ "$failed" -eq 0 ] && exit $status
exit 1
