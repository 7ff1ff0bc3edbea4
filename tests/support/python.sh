# shellcheck shell=sh
# python.sh: a Python for tests of the package; sourced.  Skips where none has NumPy and cffi.
python=$(for one in ${PYTHON:-python3 /usr/bin/python3}; do
    "$one" -c 'import cffi, numpy' 2>/dev/null && echo "$one" && break
done)
if [ -z "$python" ]; then
    echo "ok 1 - the package for Python # SKIP no Python with NumPy and cffi: python3-numpy and python3-cffi of Debian"
    exit 0
fi
# Tests beside each other make it one after the other.
# shellcheck disable=SC2154 # of who sources it
make_python() { # targets
    flock "$build/python.lock" make --no-print-directory B="$build" PYTHON="$python" "$@"
}
