#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks that the includes keep to the module order that the CMake files state.

A module includes only itself and what its USES reach (its tests also what TEST_USES reach), uses
only modules that stillmap/CMakeLists.txt adds before it, and its public headers (HEADERS) include
public headers only.
"""
import pathlib
import re
import sys

KEYWORDS = ("NAME", "SOURCES", "HEADERS", "USES", "PUBLIC_LIBS", "PRIVATE_LIBS", "TESTS",
            "TEST_USES", "TEST_LIBS")
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.MULTILINE)


def without_comments(text):
    return re.sub(r"#.*", "", text)


def read_module(folder):
    """The arguments of the folder's stillmap_module call, by keyword."""
    file = folder / "CMakeLists.txt"
    text = without_comments(file.read_text()) if file.is_file() else ""
    call = re.search(r"\bstillmap_module\s*\(([^)]*)\)", text)
    arguments = {keyword: [] for keyword in KEYWORDS}
    keyword = None
    for word in call.group(1).split() if call else []:
        if word in KEYWORDS:
            keyword = word
        elif keyword:
            arguments[keyword].append(word)
    return arguments


def read_modules(library):
    """All modules in the order in which they are added."""
    text = without_comments((library / "CMakeLists.txt").read_text())
    names = re.findall(r"\badd_subdirectory\s*\(\s*(\w+)\s*\)", text)
    return {name: read_module(library / name) for name in names}


def reach(modules, names):
    """These modules and all that they use."""
    reached = set()
    waiting = [name for name in names if name in modules]
    while waiting:
        name = waiting.pop()
        if name not in reached:
            reached.add(name)
            waiting += [used for used in modules[name]["USES"] if used in modules]
    return reached


def check_order(modules):
    order = list(modules)
    for name, module in modules.items():
        where = f"stillmap/{name}/CMakeLists.txt"
        if module["NAME"] != [name]:
            yield f"{where}: expected stillmap_module(NAME {name} ...)"
        for used in module["USES"]:
            if used not in order[: order.index(name)]:
                yield f"{where}: USES {used}, which does not stand above {name}"
        for used in module["TEST_USES"]:
            if used not in modules:
                yield f"{where}: TEST_USES {used}, which is no module"


def check_include(root, modules, name, path, included):
    """What is wrong with one include of a module's file, or None."""
    parts = included.split("/")
    if parts[0] != "stillmap" or len(parts) != 3:
        return "expected an include of the form \"stillmap/MODULE/FILE.hpp\""
    if not (root / included).is_file():
        return "there is no such file"
    module = modules[name]
    is_test = path.name in module["TESTS"] or path.name.startswith("test_")
    allowed = reach(modules, [name] + (module["TEST_USES"] if is_test else []))
    if parts[1] not in allowed:
        return f"{name} does not use {parts[1]}"
    is_public_file = path.name in module["HEADERS"]
    target_is_public = parts[1] in modules and parts[2] in modules[parts[1]]["HEADERS"]
    if not target_is_public and (is_public_file or parts[1] != name) and not is_test:
        return f"it is no public header (HEADERS) of {parts[1]}"
    return None


def check_includes(root, modules):
    for name in modules:
        for path in sorted((root / "stillmap" / name).glob("*.[ch]pp")):
            for match in INCLUDE.finditer(path.read_text()):
                problem = check_include(root, modules, name, path, match.group(1))
                if problem:
                    line = path.read_text().count("\n", 0, match.start(1)) + 1
                    yield f"{path.relative_to(root)}:{line}: {match.group(1)}: {problem}"


def check_complete(root, modules):
    for folder in sorted(path for path in (root / "stillmap").iterdir() if path.is_dir()):
        if folder.name not in modules:
            yield f"stillmap/{folder.name}: not added by stillmap/CMakeLists.txt"
            continue
        module = modules[folder.name]
        listed = set(module["SOURCES"] + module["TESTS"])
        for path in sorted(folder.glob("*.cpp")):
            if path.name not in listed:
                yield f"{path.relative_to(root)}: listed in neither SOURCES nor TESTS"


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else __file__).resolve()
    if len(sys.argv) < 2:
        root = root.parent.parent
    modules = read_modules(root / "stillmap")
    problems = [*check_order(modules), *check_includes(root, modules), *check_complete(root, modules)]
    for problem in problems:
        print(problem)
    print(f"check_layers: {len(modules)} modules, {len(problems)} problems")
    return 1 if problems or not modules else 0


if __name__ == "__main__":
    sys.exit(main())
