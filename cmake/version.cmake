# Writes OUTPUT, a header with the program's version: release number and source revision. Run as a
# script at each build, so that a result never carries the revision of an earlier one.
# Usage: cmake -DOUTPUT=FILE -DSOURCE=FOLDER -DRELEASE=NUMBER -P version.cmake
find_package(Git QUIET)
set(revision "unknown revision")
if(GIT_FOUND)
  execute_process(COMMAND ${GIT_EXECUTABLE} describe --always --dirty
    WORKING_DIRECTORY ${SOURCE} OUTPUT_VARIABLE described
    OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE status)
  if(status EQUAL 0)
    set(revision ${described})
  endif()
endif()
# Left alone when nothing changed, so that nothing is compiled again.
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "#define HOPSCOTCH_VERSION \"@RELEASE@ (@revision@)\"\n" @ONLY)
