# SPDX-License-Identifier: Apache-2.0
# stillmap_embed_texts(x.cpp tooling/x.hpp a.css b.js ...): a rule that makes x.cpp in the build folder, with the text of each
# file; the header declares its functions (embed_text.cmake).
function(stillmap_embed_texts OUTPUT HEADER)
  set(script ${PROJECT_SOURCE_DIR}/cmake/embed_text.cmake)
  get_filename_component(name ${OUTPUT} NAME)
  add_custom_command(OUTPUT ${OUTPUT}
    COMMAND ${CMAKE_COMMAND} -DOUTPUT=${OUTPUT} -DHEADER=${HEADER} "-DINPUTS=${ARGN}" -P ${script}
    DEPENDS ${ARGN} ${script}
    COMMENT "Embedding texts in ${name}" VERBATIM)
endfunction()
