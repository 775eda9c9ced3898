"""The package is typed and documented, and its types are those of the module."""

import ast
import inspect
import pathlib
import pickle
import re
import unittest

import telltale
from telltale import _telltale

PACKAGE = pathlib.Path(telltale.__file__).parent
STUB = ast.parse((PACKAGE / "_telltale.pyi").read_text(encoding="utf-8"))


def arguments_of(function):
    """Names in the order of a stub's function, without self."""
    named = function.args
    return [a.arg for a in named.posonlyargs + named.args + named.kwonlyargs if a.arg != "self"]


def bound_arguments(function):
    """The same of a bound function, by the signature on the first line of its docstring."""
    signature = function.__doc__.splitlines()[0]
    return [name for name in re.findall(r"[(,] \*?,? ?(\w+):|\((\w+):|, (\w+):", signature) for name in name if name and name != "self"]


def public(names):
    return {name for name in names if not name.startswith("_")}


class PackageTest(unittest.TestCase):
    def test_the_stub_names_what_the_module_has(self):
        stubbed = {node.name for node in STUB.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
        self.assertEqual(stubbed, public(vars(_telltale)))
        for node in STUB.body:
            if not isinstance(node, ast.ClassDef):
                continue
            with self.subTest(node.name):
                members = public(member.name for member in node.body if isinstance(member, ast.FunctionDef))
                self.assertEqual(members, public(vars(getattr(_telltale, node.name))))

    def test_the_stub_names_the_arguments_that_functions_take(self):
        functions = [(node, getattr(_telltale, node.name)) for node in STUB.body if isinstance(node, ast.FunctionDef)]
        self.assertTrue(functions)
        for node, function in functions:
            with self.subTest(node.name):
                self.assertEqual(arguments_of(node), bound_arguments(function))

    def test_all_that_is_public_is_documented(self):
        self.assertIn("py.typed", [file.name for file in PACKAGE.iterdir()])
        for name in telltale.__all__:
            if name == "__version__":
                continue
            thing = getattr(telltale, name)
            with self.subTest(name):
                self.assertTrue(inspect.getdoc(thing))
                for member in public(vars(thing)) if inspect.isclass(thing) else ():
                    self.assertTrue(inspect.getdoc(getattr(thing, member)), member)

    def test_exceptions_are_of_their_kind_and_survive_pickling(self):
        self.assertTrue(issubclass(telltale.InputError, ValueError))
        self.assertTrue(issubclass(telltale.DataCannotTell, RuntimeError))
        refused = pickle.loads(pickle.dumps(telltale.DataCannotTell("surge", "is not excited", "drive ahead")))
        self.assertEqual((refused.subject, refused.reason, refused.advice), ("surge", "is not excited", "drive ahead"))
        self.assertEqual(str(refused), "surge: is not excited\n-> drive ahead")


if __name__ == "__main__":
    unittest.main()
