#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "control/qp_solver.hpp"
#include "control/wrench_qp.hpp"

namespace hopscotch::control {

/// One problem of a set of recorded jump QPs with its reference solution.
struct WrenchQpRecord {
  WrenchQp qp;
  int problem_class = 0;   ///< 0 stand, 1 takeoff, 2 to flight, 3 to landing, 4 landing.
  int sequence = 0;        ///< Closed-loop run that it belongs to.
  int position = 0;        ///< Within that run.
  WarmStartMap map{};      ///< From the previous problem of the run.
  double objective = 0.0;  ///< Of the reference solution.
  std::array<Eigen::Vector<double, 12>, 10> inputs{};  ///< [F_left F_right M_left M_right], W.
};

/// Decodes the bytes of a file of recorded QPs (magic "JMPCQP01", little-endian doubles).
/// Nothing if the bytes are not such a file.
[[nodiscard]] std::optional<std::vector<WrenchQpRecord>> decode_wrench_qps(
    std::span<const std::byte> bytes);

}  // namespace hopscotch::control
