# SPDX-License-Identifier: Apache-2.0
# STILLMAP_ONNXRUNTIME_INCLUDE: the folder of ONNX Runtime's headers, the system's or those that
# tools/fetch_models got; not found: the program is built without it. The folder is the one of
# stillmap/perception/segmentation/model_folder.hpp.
if(DEFINED ENV{STILLMAP_MODELS} AND NOT "$ENV{STILLMAP_MODELS}" STREQUAL "")
  set(stillmap_models $ENV{STILLMAP_MODELS})
elseif(DEFINED ENV{XDG_DATA_HOME} AND NOT "$ENV{XDG_DATA_HOME}" STREQUAL "")
  set(stillmap_models $ENV{XDG_DATA_HOME}/stillmap/models)
else()
  set(stillmap_models $ENV{HOME}/.local/share/stillmap/models)
endif()
find_path(STILLMAP_ONNXRUNTIME_INCLUDE onnxruntime_cxx_api.h
  HINTS ${stillmap_models}/include
  PATH_SUFFIXES onnxruntime onnxruntime/core/session
  DOC "Folder of ONNX Runtime's headers, 1.17 or later (optional)")
if(STILLMAP_ONNXRUNTIME_INCLUDE)
  message(STATUS "ONNX Runtime: headers in ${STILLMAP_ONNXRUNTIME_INCLUDE}")
else()
  message(STATUS "ONNX Runtime: no headers, built without it (make models gets it)")
endif()
