"""What Python knows of structs and choices is what the C compiler knows."""
import os
import unittest

import numpy as np

from krs import native
from krs._tables import AOVS
from krs.native import ffi, lib

LAYOUTS = os.path.join(os.path.dirname(__file__), "../api/layouts.txt")


def differences(lines):
    """Lines of tests/api/layouts.txt that Python sees otherwise."""
    for line in lines:
        name, *numbers = line.split()
        struct, _, member = name.partition(".")
        numbers = [int(number) for number in numbers]
        if name.startswith("KRS_"):
            found = [getattr(lib, name)]
        elif member:
            field = dict(ffi.typeof(struct).fields)[member]
            found = [field.offset, ffi.sizeof(field.type)]
        else:
            found, numbers = [ffi.sizeof(struct) >= numbers[0]], [True]
        if found != numbers:
            yield line


class Declarations(unittest.TestCase):
    def test_layouts(self):
        """structs, members and choices are where a C compiler has them"""
        with open(os.environ.get("LAYOUTS", LAYOUTS)) as file:
            lines = file.read().splitlines()
        self.assertGreater(len(lines), 400)
        self.assertEqual(list(differences(lines)), [])

    def test_differences(self):
        """a member at another place, and a choice of another number, would be found"""
        wrong = ["KrsHit.t 16 8", "KRS_BAD_SCENE 2", "KrsHit.point 16 16"]
        self.assertEqual(list(differences(wrong)), wrong)
        self.assertEqual(list(differences(["KrsHit.t 8 8"])), [])

    def test_hits(self):
        """arrays of hits have the struct's size and members"""
        hit = native.dtype_of("KrsHit")
        self.assertEqual(hit.itemsize, ffi.sizeof("KrsHit"))
        self.assertEqual((hit.fields["normal"][1], hit["normal"].shape), (48, (3,)))
        self.assertEqual(hit["hit"], np.bool_)

    def test_aovs(self):
        """bits of AOVs are the choices of the headers"""
        self.assertEqual([1 << aov["bit"] for aov in AOVS], [getattr(lib, f"KRS_AOV_{aov['id']}") for aov in AOVS])
        self.assertEqual(sum(1 << aov["bit"] for aov in AOVS), lib.KRS_AOV_ALL)
