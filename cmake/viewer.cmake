# SPDX-License-Identifier: Apache-2.0
# STILLMAP_VIEWER_LACKS: the packages that the view in a browser (tooling/view) needs and this machine lacks; empty where it is built.
# three.js goes into the program as Debian's libjs-three has it.
set(STILLMAP_VIEWER_LACKS "")
find_file(STILLMAP_THREE_JS three.min.js PATHS /usr/share/javascript/three PATH_SUFFIXES share/javascript/three)
find_file(STILLMAP_ORBIT_CONTROLS_JS OrbitControls.js PATHS /usr/share/javascript/three/examples/js/controls
  PATH_SUFFIXES share/javascript/three/examples/js/controls)
find_path(STILLMAP_BEAST_INCLUDE boost/beast/websocket.hpp)
mark_as_advanced(STILLMAP_THREE_JS STILLMAP_ORBIT_CONTROLS_JS STILLMAP_BEAST_INCLUDE)
if(NOT STILLMAP_THREE_JS OR NOT STILLMAP_ORBIT_CONTROLS_JS)
  list(APPEND STILLMAP_VIEWER_LACKS libjs-three)
endif()
if(NOT STILLMAP_BEAST_INCLUDE)
  list(APPEND STILLMAP_VIEWER_LACKS libboost-dev)
endif()
list(JOIN STILLMAP_VIEWER_LACKS " and " STILLMAP_VIEWER_LACKS)
if(STILLMAP_VIEWER_LACKS)
  message(STATUS "View in a browser: no ${STILLMAP_VIEWER_LACKS}, built without it")
else()
  message(STATUS "View in a browser: ${STILLMAP_THREE_JS}")
endif()
