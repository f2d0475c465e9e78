#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests of check_sizes.py, check_layers.py and check_docs.py."""
import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
import check_docs  # noqa: E402
import check_layers  # noqa: E402
import check_sizes  # noqa: E402

CODE = r'''// SPDX: { not a brace
#include "a{b.hpp"
#define M(x) \
  { x }
namespace a {
constexpr char kBrace = '{';
constexpr int kMany = 1'000'000;
const char* kText = "}{\"";
const char* kRaw = R"x({{)")x";
const int kTable[] = {
    1, 2,
    3};
template <class T, class U = std::vector<T>>
struct S : Base<T> {
  int x{3};
 public:
  S(int v)
      : a_{v}, b_(v) {
    use();
  }
  void g() { h(); }  /* } */
};
enum class E { kOne, kTwo };
struct P { int y = 0; };
template <class T>
T f(T a,
    T b) {
  if (a) {
    struct Local { int z; };
  }
  const auto l = [&] { return 1; };
  return b;
}
}  // namespace a
TEST(A, B) {
  using namespace a;
}
'''


class Functions(unittest.TestCase):
    def test_lines_of_every_function(self):
        found = check_sizes.Scanner(check_sizes.code_of(CODE)).scan().functions
        lines = CODE.split("\n")
        text = [(lines[first - 1].strip(), lines[last - 1].strip()) for first, last in found]
        self.assertEqual(text, [("int x{3};", "int x{3};"), ("S(int v)", "}"),
                                ("void g() { h(); }  /* } */", "void g() { h(); }  /* } */"),
                                ("template <class T>", "}"), ("TEST(A, B) {", "}")])
        self.assertEqual([last - first + 1 for first, last in found], [1, 4, 1, 9, 3])


class Files(unittest.TestCase):
    def problems(self, text, name="stillmap/x/y.cpp"):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "y.cpp"
            path.write_text(text)
            return [problem.replace(name, "F") for problem in check_sizes.check_file(path, name)]

    def test_sizes(self):
        self.assertEqual(self.problems("int x;\n" * 400), [])
        self.assertEqual(self.problems("int x;\n" * 401), ["F: 401 lines, at most 400"])
        self.assertEqual(self.problems("void f() {\n" + "g();\n" * 58 + "}\n"), [])
        self.assertEqual(self.problems("int x;\n\nvoid f() {\n" + "g();\n" * 59 + "}\n"),
                         ["F:3: a function of 61 lines, at most 60"])

    def test_forbidden(self):
        self.assertEqual(self.problems("void f() {\n  std::cout << 1;\n}\n"),
                         ["F:2: cout: the library never prints"])
        self.assertEqual(self.problems("void f() { std::exit(1); }\n"),
                         ["F:1: exit(: the library never ends the process"])
        self.assertEqual(self.problems("// std::cout, exit(1)\nconst char* k = \"exit(1)\";\n"), [])
        self.assertEqual(self.problems("void on_exit_now();\nint exit_code = 0;\n"), [])
        self.assertEqual(self.problems("void f() { usleep(1); }\n", "tooling/x/y.cpp"),
                         ["F:1: usleep: the library never sleeps"])
        self.assertEqual(self.problems("void f() { std::cout << 1; }\n", "apps/y.cpp"), [])

    def test_using_namespace(self):
        self.assertEqual(self.problems("namespace a {\nusing namespace b;\n}\n"),
                         ["F:2: using namespace outside a function"])
        self.assertEqual(self.problems("void f() {\n  using namespace b;\n}\n"), [])


class Types(unittest.TestCase):
    def test_a_name_is_of_one_type(self):
        mesh = "namespace a {\nstruct Mesh {\n  int x;\n};\n}\n"
        other = mesh.replace("struct", "class").replace("Mesh {", "Mesh final : Base {")
        self.assertEqual(list(check_sizes.check_types({"x.hpp": mesh, "y.hpp": other})),
                         ["y.hpp: a::Mesh is another type in x.hpp: one of them needs another name"])
        alias = "namespace a {\nusing Mesh = int;\n}\n"
        self.assertEqual(list(check_sizes.check_types({"x.hpp": mesh, "y.hpp": alias})),
                         ["y.hpp: a::Mesh is another type in x.hpp: one of them needs another name"])
        for text in (other.replace("a {", "b {"), "namespace a {\nstruct Mesh;\n}\n", mesh.replace("Mesh", "Net"),
                     "namespace a {\n// struct Mesh {\n}\n"):
            self.assertEqual(list(check_sizes.check_types({"x.hpp": mesh, "y.hpp": text})), [])


class Layers(unittest.TestCase):
    MODULE = "# SPDX\n# Holds {0}.\nstillmap_module(NAME {0} {1})"

    def problems(self, files):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for name, text in files.items():
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                (root / name).write_text(text)
            _, self.before_writing = check_layers.check_all(root)
            check_layers.check_all(root, write=True)
            modules, problems = check_layers.check_all(root)
            self.table = check_layers.table(modules)
            return problems

    def tree(self):
        table = f"before\n{check_layers.TABLE_BEGIN}\nold\n{check_layers.TABLE_END}\nafter\n"
        return {
            "docs/architecture.md": table,
            "CMakeLists.txt": "add_subdirectory(stillmap)\nif(X)\n  add_subdirectory(tooling)\nendif()\n"
                              "add_subdirectory(tests/support)\n",
            "stillmap/CMakeLists.txt":
                "add_subdirectory(low)\nadd_subdirectory(slam/mid)  # add_subdirectory(no)\nadd_subdirectory(top)\n",
            "tooling/CMakeLists.txt": "add_subdirectory(tool)\n",
            "stillmap/low/CMakeLists.txt": self.MODULE.format("low", "PRIVATE_HEADERS inner.hpp"),
            "stillmap/low/l.hpp": "",
            "stillmap/low/inner.hpp": "",
            "stillmap/low/l.cpp": '#include "stillmap/low/l.hpp"\n#include "stillmap/low/inner.hpp"\n',
            "stillmap/slam/mid/CMakeLists.txt":
                self.MODULE.format("mid", "USES low TEST_USES top test_support"),
            "stillmap/slam/mid/m.hpp": '#include <vector>\n#include "stillmap/low/l.hpp"\n',
            "stillmap/slam/mid/m_test.cpp": '#include "tests/support/s.hpp"\n',
            "stillmap/top/CMakeLists.txt": self.MODULE.format("top", "\n  USES mid\n  PUBLIC_LIBS x"),
            "stillmap/top/t.hpp": "",
            "stillmap/top/t.cpp": '#include "stillmap/slam/mid/m.hpp"\n',
            "tooling/tool/CMakeLists.txt": self.MODULE.format("tool", "USES top"),
            "tooling/tool/t.hpp": '#include "stillmap/top/t.hpp"\n',
            "tests/support/CMakeLists.txt": self.MODULE.format("test_support", ""),
            "tests/support/s.hpp": '#include "stillmap/top/t.hpp"\n#include "stillmap/low/inner.hpp"\n',
        }

    def changed(self, name, text):
        return self.problems({**self.tree(), name: text})

    def test_a_good_tree(self):
        self.assertEqual(self.problems(self.tree()), [])
        self.assertEqual(self.before_writing, ["docs/architecture.md: the table of modules is out of date: "
                                               "tools/check_layers.py --write"])
        self.assertEqual(self.table.split("\n")[2:], [
            "| `stillmap/low/` | `low` | Holds low | - |",
            "| `stillmap/slam/` | `mid` | Holds mid | low |",
            "| `stillmap/top/` | `top` | Holds top | mid |",
            "| `tooling/` | `tool` | Holds tool | top |",
            "| `tests/` | `test_support` | Holds test_support | - |"])

    def test_bad_includes(self):
        low = "stillmap/low/l.cpp"
        self.assertEqual(self.changed(low, '\n#include "stillmap/slam/mid/m.hpp"\n'),
                         [f"{low}:2: stillmap/slam/mid/m.hpp: low does not use mid"])
        for bad in ("l.hpp", "stillmap/low/no.hpp"):
            self.assertEqual(self.changed(low, f'#include "{bad}"\n'),
                             [f"{low}:1: {bad}: there is no such file; expected a full path from the root"])
        self.assertEqual(self.changed(low, '#include "tooling/tool/t.hpp"\n'),
                         [f"{low}:1: tooling/tool/t.hpp: stillmap/ must not use tooling/"])
        self.assertEqual(self.changed("stillmap/top/a.cpp", '#include "stillmap/low/l.hpp"\n'),
                         ["stillmap/top/a.cpp:1: stillmap/low/l.hpp: top does not use low"])

    def test_private_headers(self):
        file = "stillmap/slam/mid/m.hpp"
        self.assertEqual(self.changed(file, '#include "stillmap/low/inner.hpp"\n'),
                         [f"{file}:1: stillmap/low/inner.hpp: it is a private header (PRIVATE_HEADERS) of low"])
        self.assertEqual(self.changed("stillmap/low/CMakeLists.txt",
                                      self.MODULE.format("low", "PRIVATE_HEADERS inner.hpp no.hpp")),
                         ["stillmap/low/CMakeLists.txt: PRIVATE_HEADERS no.hpp, which is no file"])

    def test_bad_calls(self):
        low, tool = "stillmap/low/CMakeLists.txt", "tooling/tool/CMakeLists.txt"
        self.assertEqual(self.changed(low, self.MODULE.format("other", "PRIVATE_HEADERS inner.hpp")),
                         [f"{low}: expected stillmap_module(NAME low ...)"])
        self.assertEqual(self.changed(low, "stillmap_module(NAME low PRIVATE_HEADERS inner.hpp)"),
                         [f"{low}: expected a comment line that says what the module holds"])
        self.assertEqual(self.changed(low, self.MODULE.format("low", "USES mid PRIVATE_HEADERS inner.hpp")),
                         [f"{low}: USES mid, which is not added before low",
                          f"{low}: USES mid, which no file includes"])
        self.assertEqual(self.changed(tool, self.MODULE.format("tool", "USES top TEST_USES mid gone")),
                         [f"{tool}: TEST_USES gone, which is no module",
                          f"{tool}: TEST_USES mid, which no file includes",
                          f"{tool}: TEST_USES gone, which no file includes"])

    def test_a_forgotten_module(self):
        self.assertEqual(self.changed("stillmap/more/CMakeLists.txt", self.MODULE.format("more", "")),
                         ["stillmap/more/CMakeLists.txt: a module that no add_subdirectory adds"])

    def test_the_table_is_checked(self):
        begin, end = check_layers.TABLE_BEGIN, check_layers.TABLE_END
        modules = {"stillmap/low": {"USES": [], "holds": "this"}}
        text = check_layers.with_table(f"a\n{begin}\nx\n{end}\nb\n", modules)
        self.assertEqual(text, f"a\n{begin}\n{check_layers.table(modules)}\n{end}\nb\n")
        self.assertEqual(check_layers.with_table(text, modules), text)
        self.assertIsNone(check_layers.with_table("no markers", modules))
        self.assertEqual(self.changed("docs/architecture.md", "no markers"),
                         [f"docs/architecture.md: expected the lines {begin} and {end}"])


class Docs(unittest.TestCase):
    FILES = ["stillmap/dense/free_space.hpp", "tools/setup.py", "docs/a.md"]

    def test_paths_of_sources(self):
        text = ("`dense/free_space.hpp`, free_space.hpp, tools/setup.py, x.cpp, apps/NAME.cpp and a.cmake.in are fine; "
                "`cloud/free_space.hpp`, space.hpp and (setup.cpp) are not.")
        self.assertEqual(check_docs.problems_of(text, self.FILES),
                         ["no file cloud/free_space.hpp", "no file setup.cpp", "no file space.hpp"])

    def test_types_beside_files(self):
        text = ("| view | `FreeSpace`, dense/free_space.hpp |\n| member | `FreeSpace::cell`, dense/free_space.hpp |\n"
                "| other | `Space`, dense/free_space.hpp |")
        self.assertEqual(check_docs.type_problems(text, self.FILES, lambda file: "struct FreeSpace {};"),
                         ["no type Space in dense/free_space.hpp"])

    def test_links(self):
        with tempfile.TemporaryDirectory() as folder:
            document = pathlib.Path(folder) / "a.md"
            document.write_text("")
            text = "[self](a.md) [part](a.md#part) [web](https://example.org) [none](b.md)"
            self.assertEqual(check_docs.broken_links(document, text), ["no file b.md"])


if __name__ == "__main__":
    unittest.main()
