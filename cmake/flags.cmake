# Flags of every target of ours; third-party headers come in as SYSTEM.
add_library(hopscotch_flags INTERFACE)
target_compile_options(hopscotch_flags INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wnon-virtual-dtor
  -Woverloaded-virtual -Wold-style-cast -Wnull-dereference -fno-math-errno
  -Wno-restrict)  # GCC 12 warns falsely about "literal" + std::string
if(HOPSCOTCH_WERROR)
  target_compile_options(hopscotch_flags INTERFACE -Werror)
endif()
if(HOPSCOTCH_SANITIZE)
  target_compile_options(hopscotch_flags INTERFACE
    -fsanitize=${HOPSCOTCH_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer -g1)
  target_link_options(hopscotch_flags INTERFACE -fsanitize=${HOPSCOTCH_SANITIZE})
endif()
