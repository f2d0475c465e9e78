// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <pybind11/pybind11.h>
#include <pybind11/stl/filesystem.h>

#include "python/bindings/arrays.hpp"
#include "python/bindings/bindings.hpp"
#include "stillmap/core/error.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "tooling/export/mesh_files.hpp"
#include "tooling/export/surface_mesh.hpp"

namespace stillmap::python {

namespace py = pybind11;

namespace {

constexpr const char* kMeshDoc =
    R"(A surface of triangles: `vertices`, a PointCloud with normals, and `triangles`.

Its arrays share the memory of this object and cannot be written to.)";
constexpr const char* kSurfaceMeshDoc =
    R"(The surface of a map whose points have normals, as those of the mode `full` do.

`cell_m`: edge of the cubes in which the surface is looked for, metres.)";

SurfaceMesh mesh_of(const PointCloud& map, double cell_m) {
  if (map.normals.empty() && !map.empty())
    throw Error("map: no normals, expected one for each point");
  if (!(cell_m >= 0.001 && cell_m <= 1)) throw Error("cell_m: {}, expected 0.001 to 1", cell_m);
  return map.empty() ? SurfaceMesh{} : surface_mesh(map, {.cell_m = cell_m});
}

}  // namespace

void add_mesh(py::module_& module) {
  py::class_<SurfaceMesh>(module, "Mesh", kMeshDoc)
      .def_property_readonly(
          "vertices",
          [](const SurfaceMesh& self) -> const PointCloud& { return self.vertices; },
          py::return_value_policy::reference_internal,
          "A PointCloud with colours, labels and normals.")
      .def_property_readonly(
          "triangles",
          [](const py::object& self) -> py::object {
            const auto& mesh = py::cast<const SurfaceMesh&>(self);
            const auto* indices = reinterpret_cast<const std::uint32_t*>(mesh.triangles.data());
            return shared_array(indices, mesh.triangles.size(), 3, self);
          },
          "Places in `vertices`, counter-clockwise from outside, M x 3 uint32.")
      .def(
          "save",
          [](const SurfaceMesh& self, const std::filesystem::path& file) {
            write_file_atomically(file, encode_mesh(self, file));
          },
          py::arg("file"),
          py::call_guard<py::gil_scoped_release>(),
          doc("save(self, file)", "Writes a .ply, .obj or .glb, as `stillmap export --mesh` does.")
              .c_str())
      .def("__repr__", [](const SurfaceMesh& self) {
        return fmt::format("<stillmap.Mesh of {} triangles>", self.triangles.size());
      });
  module.def("surface_mesh",
             &mesh_of,
             py::arg("map"),
             py::arg("cell_m") = MeshOptions{}.cell_m,
             py::call_guard<py::gil_scoped_release>(),
             doc("surface_mesh(map, cell_m=0.02)", kSurfaceMeshDoc).c_str());
}

}  // namespace stillmap::python
