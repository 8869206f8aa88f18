// Prints how exact perception is in many random worlds, without and with faults. A table, no test;
// the test of the same is beside it.
#include <getopt.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "tests/accuracy/accuracy.hpp"

namespace {

using hopscotch::accuracy::Faults;

struct Case {
  const char* name;
  Faults faults;
  int share;  // of the worlds
};

constexpr Case kCases[] = {{"none", {}, 1},
                           {"dropout", {.dropout = 0.2}, 4},
                           {"time", {.time_error = 0.03}, 4},
                           {"pitch", {.pitch_error = 0.01745}, 4},
                           {"leg", {.leg_error = 0.1}, 4}};

struct Wish {
  int worlds = 3000;
  std::uint64_t first = 1;
  std::string fault;  // empty: all
};

int usage() {
  std::fprintf(stderr,
               "usage: perception_accuracy [--worlds N] [--first SEED] [--fault "
               "none|dropout|time|pitch|leg]\n"
               "Without --fault: all, a quarter of the worlds for each but none.\n");
  return 2;
}

bool parse(int argc, char** argv, Wish& wish) {
  constexpr option kOptions[] = {{"worlds", required_argument, nullptr, 'w'},
                                 {"first", required_argument, nullptr, 's'},
                                 {"fault", required_argument, nullptr, 'f'},
                                 {nullptr, 0, nullptr, 0}};
  for (int letter = 0; (letter = getopt_long(argc, argv, "", kOptions, nullptr)) != -1;) {
    if (letter == 'w') {
      wish.worlds = std::atoi(optarg);
    } else if (letter == 's') {
      wish.first = static_cast<std::uint64_t>(std::atoll(optarg));
    } else if (letter == 'f') {
      wish.fault = optarg;
    } else {
      return false;
    }
  }
  const bool known =
      wish.fault.empty() || std::any_of(std::begin(kCases), std::end(kCases),
                                        [&](const Case& c) { return wish.fault == c.name; });
  return known && wish.worlds > 0 && optind == argc;
}

}  // namespace

int main(int argc, char** argv) {
  Wish wish;
  if (!parse(argc, argv, wish)) return usage();
  for (const Case& tested : kCases) {
    if (!wish.fault.empty() && wish.fault != tested.name) continue;
    const int count = wish.fault.empty() ? std::max(1, wish.worlds / tested.share) : wish.worlds;
    std::printf("--- fault: %s\n%s\n", tested.name,
                hopscotch::accuracy::measure(wish.first, count, tested.faults).text().c_str());
    std::fflush(stdout);
  }
  return 0;
}
