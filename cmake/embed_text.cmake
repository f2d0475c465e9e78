# SPDX-License-Identifier: Apache-2.0
# cmake -DOUTPUT=x.cpp -DHEADER=tooling/x.hpp "-DINPUTS=a.css;b.js" -P embed_text.cmake
# Writes a C++ file with a function for each text file, page_css() for page.css, that returns its text. HEADER declares them.
set(code "// Made by embed_text.cmake.\n#include \"${HEADER}\"\n\nnamespace stillmap {\n")
foreach(input IN LISTS INPUTS)
  get_filename_component(name "${input}" NAME)
  string(REPLACE "." "_" function "${name}")
  file(READ "${input}" text)
  string(APPEND code "\nstd::string_view ${function}() {\n  return R\"stillmap(${text})stillmap\";\n}\n")
endforeach()
string(APPEND code "\n}  // namespace stillmap\n")
file(WRITE "${OUTPUT}" "${code}")
