include(GoogleTest)

# hopscotch_test(FOLDER <folder> LABEL <label> LIBRARIES <targets...> SOURCES <files...>)
# One test program per folder and label; every TEST becomes a ctest test of that label.
function(hopscotch_test)
  cmake_parse_arguments(T "" "FOLDER;LABEL;TIMEOUT" "LIBRARIES;SOURCES" ${ARGN})
  if(NOT T_TIMEOUT)
    set(T_TIMEOUT 300)
  endif()
  set(target ${T_FOLDER}_${T_LABEL}_test)
  add_executable(${target} ${T_SOURCES})
  target_link_libraries(${target} PRIVATE ${T_LIBRARIES} hopscotch_flags GTest::gtest GTest::gmock
                                          GTest::gtest_main)
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR})
  target_compile_definitions(${target} PRIVATE HOPSCOTCH_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  gtest_discover_tests(${target} DISCOVERY_TIMEOUT 60
    PROPERTIES LABELS ${T_LABEL} TIMEOUT ${T_TIMEOUT})
endfunction()
