# Debian's small OpenCV packages bring no CMake files (those are in libopencv-dev, 150 MB more).
# Targets opencv::core, opencv::imgproc, opencv::imgcodecs.
include_guard(GLOBAL)
find_path(OPENCV_INCLUDE_DIR opencv2/core.hpp PATH_SUFFIXES opencv4 REQUIRED)
foreach(part core imgproc imgcodecs)
  find_library(OPENCV_${part}_LIBRARY opencv_${part} REQUIRED)
  add_library(opencv::${part} SHARED IMPORTED GLOBAL)
  set_target_properties(opencv::${part} PROPERTIES
    IMPORTED_LOCATION ${OPENCV_${part}_LIBRARY}
    INTERFACE_INCLUDE_DIRECTORIES ${OPENCV_INCLUDE_DIR})
endforeach()
