"""Writes docs/python-api.md from the docstrings of the installed package: every public class, method, property and function.

usage: python_api.py [--check] FILE      --check: exit code 1 if the file differs, or if something has no docstring
"""

import importlib
import inspect
import pathlib
import re
import sys

import ligature

HEAD = """# Python reference

Every public name of the package `ligature`, with shapes, units and errors. [Python](python.md) explains how they are used
together. This page is made from the docstrings of the package (`scripts/python_api.py`).
"""
MODULES = ("ligature", "ligature.rig", "ligature.gym", "ligature.study")


def told(thing):
    """The docstring as Markdown, without the signature that nanobind puts into its first line."""
    text = inspect.cleandoc(getattr(thing, "__doc__", None) or "")
    return fenced(re.sub(r"^\w+\(.*\)( -> .*)?\n*", "", text) if hasattr(thing, "__nb_signature__") else text).strip()


def signature(name, thing):
    for line, *_ in getattr(thing, "__nb_signature__", ()):
        return line.replace("def ", "", 1).replace("ligature._core.", "")
    try:
        return name + re.sub(r"'|ligature\._core\.|ligature\.rig\.rig\.|collections\.abc\.|typing\.", "", str(inspect.signature(thing)))
    except (TypeError, ValueError):
        return name + "(..)"


def members(cls, told_elsewhere):
    """Public members, in the order of the classes that define them; without those of bases that have their own text."""
    seen = {}
    for base in cls.__mro__:
        if base.__module__.startswith("ligature") and (base is cls or base not in told_elsewhere):
            for name, value in vars(base).items():
                if not name.startswith("_") and name not in seen:
                    seen[name] = value
    return seen


def attributes(cls):
    """Attributes that are set in __init__, or fields of a named tuple, with the comments beside them as the source has them."""
    try:
        source = inspect.getsource(cls)
    except (OSError, TypeError):
        return {}
    if issubclass(cls, tuple):
        return dict(re.findall(r"^    ([a-z]\w*): .*?  # (.+)$", source, re.M))
    return dict(re.findall(r"^        self\.([a-z]\w*)(?:: [^=]+)? = .*?  # (.+)$", source, re.M))


def of_class(name, cls, told_elsewhere, missing):
    bases = [base.__name__ for base in cls.__bases__ if base in told_elsewhere]
    yield f"\n### {name}\n\n{told(cls) or missing(name)}\n" + (f"\nFurther members: those of {', '.join(bases)}.\n" if bases else "")
    for attribute, meaning in attributes(cls).items():
        yield f"\n**`.{attribute}`**: {meaning}\n"
    for member, value in members(cls, told_elsewhere).items():
        value = value.__func__ if isinstance(value, (classmethod, staticmethod)) else value
        if type(value).__name__ == "_tuplegetter" or isinstance(value, (str, tuple, type(None))) or not (callable(value) or hasattr(value, "__get__")):
            continue
        shown = f".{signature(member, value)}" if callable(value) else f".{member}"
        yield f"\n**`{shown}`**\n\n{told(value) or missing(f'{name}.{member}')}\n"


def page(missing):
    yield HEAD
    for module in map(importlib.import_module, MODULES):
        yield f"\n## {module.__name__}\n\n{fenced(inspect.cleandoc(module.__doc__))}\n"
        public = [getattr(module, name) for name in module.__all__]
        for name in sorted(module.__all__):
            thing = getattr(module, name)
            if inspect.isclass(thing):
                yield from of_class(name, thing, public, missing)
            elif callable(thing):
                yield f"\n### {name}\n\n`{signature(name, thing)}`\n\n{told(thing) or missing(name)}\n"


def fenced(text):
    """Indented lines as a code block."""
    return re.sub(r"(?:^    .*\n?(?:\n(?=    ))?)+", lambda m: "```python\n" + inspect.cleandoc("\n" + m[0]) + "\n```\n", text, flags=re.M)


def main():
    check, files = "--check" in sys.argv, [word for word in sys.argv[1:] if word != "--check"]
    if len(files) != 1 or not files[0].endswith(".md"):
        sys.exit("usage: python_api.py [--check] FILE.md")
    file = pathlib.Path(files[0])
    lacks = []
    text = re.sub(r"\n{3,}", "\n\n", "".join(page(lambda name: lacks.append(name) or "(no docstring)")))
    if lacks:
        sys.exit(f"python_api: no docstring: {', '.join(lacks)}")
    if not check:
        return file.write_text(text)
    if not file.exists() or file.read_text() != text:
        sys.exit(f"python_api: {file} is not what the docstrings say; remedy: PYTHONPATH=build/dev/python-package python {sys.argv[0]} {file}")


if __name__ == "__main__":
    main()
