#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests of check_sizes.py and check_layers.py."""
import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
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
        self.assertEqual(self.problems("void f() { std::cout << 1; }\n", "apps/y.cpp"), [])

    def test_using_namespace(self):
        self.assertEqual(self.problems("namespace a {\nusing namespace b;\n}\n"),
                         ["F:2: using namespace outside a function"])
        self.assertEqual(self.problems("void f() {\n  using namespace b;\n}\n"), [])


class Layers(unittest.TestCase):
    def problems(self, files):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for name, text in files.items():
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                (root / name).write_text(text)
            modules = check_layers.read_modules(root / "stillmap")
            return [*check_layers.check_order(modules), *check_layers.check_includes(root, modules),
                    *check_layers.check_complete(root, modules)]

    def tree(self):
        return {
            "stillmap/CMakeLists.txt": "add_subdirectory(low)\nadd_subdirectory(mid)  # x\nadd_subdirectory(top)\n",
            "stillmap/low/CMakeLists.txt": "stillmap_module(NAME low HEADERS l.hpp SOURCES l.cpp)",
            "stillmap/low/l.hpp": "",
            "stillmap/low/inner.hpp": "",
            "stillmap/low/l.cpp": '#include "stillmap/low/l.hpp"\n#include "stillmap/low/inner.hpp"\n',
            "stillmap/mid/CMakeLists.txt": "stillmap_module(NAME mid HEADERS m.hpp USES low)",
            "stillmap/mid/m.hpp": '#include "stillmap/low/l.hpp"\n',
            "stillmap/top/CMakeLists.txt":
                "stillmap_module(NAME top HEADERS t.hpp\n  USES mid\n  SOURCES t.cpp)",
            "stillmap/top/t.hpp": "",
            "stillmap/top/t.cpp": '#include "stillmap/low/l.hpp"\n',
        }

    def changed(self, name, text):
        return self.problems({**self.tree(), name: text})

    def test_a_good_tree(self):
        self.assertEqual(self.problems(self.tree()), [])

    def test_bad_includes(self):
        self.assertEqual(self.changed("stillmap/low/l.cpp", '\n#include "stillmap/mid/m.hpp"\n'),
                         ["stillmap/low/l.cpp:2: stillmap/mid/m.hpp: low does not use mid"])
        self.assertEqual(self.changed("stillmap/low/l.hpp", '#include "stillmap/low/inner.hpp"\n'),
                         ["stillmap/low/l.hpp:1: stillmap/low/inner.hpp: "
                          "it is no public header (HEADERS) of low"])
        self.assertEqual(self.changed("stillmap/top/t.cpp", '#include "stillmap/low/inner.hpp"\n'),
                         ["stillmap/top/t.cpp:1: stillmap/low/inner.hpp: "
                          "it is no public header (HEADERS) of low"])
        self.assertEqual(len(self.changed("stillmap/top/t.cpp", '#include "l.hpp"\n')), 1)
        self.assertEqual(len(self.changed("stillmap/top/t.cpp", '#include "stillmap/low/no.hpp"\n')), 1)

    def test_bad_order(self):
        self.assertEqual(self.changed("stillmap/low/CMakeLists.txt",
                                      "stillmap_module(NAME low HEADERS l.hpp SOURCES l.cpp USES mid)"),
                         ["stillmap/low/CMakeLists.txt: USES mid, which does not stand above low"])

    def test_missing_module(self):
        tree = self.tree()
        tree["stillmap/CMakeLists.txt"] += "add_subdirectory(gone)\n"
        self.assertEqual(self.problems(tree),
                         ["stillmap/gone/CMakeLists.txt: expected stillmap_module(NAME gone ...)"])

    def test_forgotten_file(self):
        self.assertEqual(self.changed("stillmap/mid/m.cpp", ""),
                         ["stillmap/mid/m.cpp: listed in neither SOURCES nor TESTS"])


if __name__ == "__main__":
    unittest.main()
