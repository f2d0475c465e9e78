# SPDX-License-Identifier: Apache-2.0
# Writes the README's C++ block to OUTPUT: its includes, and its statements as the body of a
# function that is given what a robot has.
file(READ ${README} text)
string(REGEX MATCH "```cpp\n([^`]*)```" block "${text}")
if(NOT block)
  message(FATAL_ERROR "README.md has no C++ block")
endif()
set(code "${CMAKE_MATCH_1}")
string(REGEX MATCHALL "#include [^\n]*\n" includes "${code}")
string(REGEX REPLACE "#include [^\n]*\n" "" statements "${code}")
string(JOIN "" includes ${includes})
file(WRITE ${OUTPUT} "// Made from README.md.\n${includes}
void readme_code(double stamp, const stillmap::ColorImage& color, const stillmap::DepthImage& depth);
void readme_code(double stamp, const stillmap::ColorImage& color, const stillmap::DepthImage& depth) {
${statements}}\n")
