#pragma once

#include <cstdio>
#include <cstdlib>

/// Guards against errors of the program itself; never for data that comes from outside the process.
/// Active in every build type.
#define HOPSCOTCH_CHECK(condition)                                                       \
  do {                                                                                   \
    if (!(condition)) {                                                                  \
      std::fprintf(stderr, "%s:%d: check failed: %s\n", __FILE__, __LINE__, #condition); \
      std::abort();                                                                      \
    }                                                                                    \
  } while (false)
