"""tap.py NAME...: runs tests of modules, examples in pages (.md) and in modules of the package (krs.), and says in TAP how they end."""
import doctest
import importlib
import sys
import traceback
import unittest

import krs


class Tap(unittest.TestResult):
    def __init__(self):
        super().__init__()
        self.number = 0

    def say(self, test, ended, why=""):
        self.number += 1
        name = test.shortDescription() or test.id()
        print(f"{ended} {self.number} - {name}{why}", flush=True)

    def addSuccess(self, test):
        super().addSuccess(test)
        self.say(test, "ok")

    def addSkip(self, test, reason):
        super().addSkip(test, reason)
        self.say(test, "ok", f" # SKIP {reason}")

    def complain(self, test, error):
        self.say(test, "not ok")
        for line in "".join(traceback.format_exception(*error)).splitlines():
            print(f"# {line}")

    def addFailure(self, test, error):
        super().addFailure(test, error)
        self.complain(test, error)

    def addError(self, test, error):
        super().addError(test, error)
        self.complain(test, error)


def main(names):
    suite = unittest.TestSuite()
    for name in names:
        if name.endswith(".md"):
            suite.addTest(doctest.DocFileSuite(name, module_relative=False, optionflags=doctest.ELLIPSIS))
        elif name.startswith("krs."):
            suite.addTest(doctest.DocTestSuite(importlib.import_module(name)))
        else:
            suite.addTests(unittest.defaultTestLoader.loadTestsFromModule(importlib.import_module(name)))
    print(f"1..{suite.countTestCases()}")
    return 0 if suite.run(Tap()).wasSuccessful() else 1


if __name__ == "__main__":
    assert krs.__file__
    sys.exit(main(sys.argv[1:]))
