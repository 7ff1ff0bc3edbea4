#!/usr/bin/env python3
"""declare.py HEADERS FOLDER: writes what Python has to know of the C library into a folder, from its headers.

`_declarations.py` has types and functions, for cffi; `_tables.py` the version and the AOVs of a picture.
"""
import ast
import contextlib
import os
import re
import subprocess
import sys
import tempfile

import cffi

# What the headers of the library include of the system; cffi knows these types.
OF_THE_SYSTEM = ("stdbool.h", "stddef.h", "stdint.h")
# Functions that are there for structs of any size are declared, but not linked: those that end in _sized are called.
NAMES = ("-U__GNUC__", "-DKRS_LIBRARY", "-D__attribute__(x)=")
AOVS = """
#define KRS_ARRAY(aov, member, type, numbers, row, first, sample, ...) \\
    {"member": #member, "type": #type, "numbers": numbers},
#define KRS_AOV(id, bit, aov, about, arrays) {"id": #id, "bit": bit, "about": about, "arrays": [arrays]},
[
#include "krs/aovs.def"
]
"""


def preprocess(text, headers, *options):
    with tempfile.TemporaryDirectory() as empty:
        for name in OF_THE_SYSTEM:
            open(os.path.join(empty, name), "w").close()
        command = [os.environ.get("CC", "cc"), "-E", "-P", "-x", "c", "-nostdinc", f"-I{empty}", f"-I{headers}",
                   *NAMES, *options, "-"]
        return subprocess.run(command, input=text, text=True, stdout=subprocess.PIPE, check=True).stdout


def main(headers, folder):
    include = '#include "krs/camera.h"\n#include "krs/vulkan.h"\n'
    macros = preprocess(include, headers, "-dM")
    version = re.search(r'^#define KRS_VERSION "(.*)"$', macros, re.M).group(1)
    numbers = re.findall(r"^#define KRS_\w+ \d+$", macros, re.M)
    ffi = cffi.FFI()
    ffi.set_source("krs._declarations", None)
    ffi.cdef("\n".join([preprocess(include, headers), *numbers, "void free(void *block);"]))
    path = os.path.join(folder, "_declarations.py")
    with contextlib.redirect_stdout(None):
        ffi.emit_python_code(path)
    os.utime(path)  # also where it was the same before
    aovs = ast.literal_eval(preprocess(AOVS, headers))
    with open(os.path.join(folder, "_tables.py"), "w") as tables:
        tables.write(f'"""Made by declare.py."""\nfrom typing import Any\nVERSION = {version!r}\nAOVS: "list[dict[str, Any]]" = {aovs!r}\n')


if __name__ == "__main__":
    main(*sys.argv[1:])
