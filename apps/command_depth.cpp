#include "apps/command_depth.hpp"

#include "apps/option_check.hpp"

namespace hopscotch::apps {

DepthScaling DepthOptions::scaling() const {
  DepthScaling result{.intrinsics = {}, .metres_per_unit = metres_per_unit};
  if (!intrinsics.empty()) {
    result.intrinsics = {intrinsics[0], intrinsics[1], intrinsics[2], intrinsics[3]};
  }
  return result;
}

void add_depth_options(CLI::App& command, DepthOptions& options) {
  command.add_option("--intrinsics", options.intrinsics, "Of depth images: FX,FY,CX,CY [pixel]")
      ->check(finite_number())
      ->delimiter(',')
      ->expected(4);
  command.add_option("--depth-scale", options.metres_per_unit, "Of depth images: metres per unit")
      ->check(finite_number(1e-6, 1.0))
      ->capture_default_str();
}

}  // namespace hopscotch::apps
