#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace hopscotch::accuracy {

/// What is wrong with the robot's eyes, besides the camera's noise.
struct Faults {
  double dropout = 0.0;      ///< Further share of pixels lost.
  double time_error = 0.0;   ///< Poses are so old [s].
  double pitch_error = 0.0;  ///< Of the believed camera mounting [rad].
  double leg_error = 0.0;    ///< Of the believed joint angles: a leg sticks out of the mask [rad].
};

/// Errors of one kind, and the same over the claimed standard deviation.
struct Errors {
  std::vector<double> values;
  std::vector<double> normalised;

  /// @param margin  What the estimate lies off on purpose, to the safe side.
  void add(double error, double sigma, double margin = 0.0) {
    values.push_back(error);
    normalised.push_back((error - margin) / sigma);
  }
  [[nodiscard]] double rms() const;
  [[nodiscard]] double bias() const;
  /// Mean of the squared normalised errors: 1 when the claims are right.
  [[nodiscard]] double nees() const;
  /// Share-quantile of the absolute errors.
  [[nodiscard]] double quantile(double share) const;
  [[nodiscard]] double share_below(double limit) const;
};

/// How many of them.
struct Share {
  long yes = 0;
  long all = 0;

  void add(bool counts) {
    yes += counts ? 1 : 0;
    ++all;
  }
  void add(const Share& other) {
    yes += other.yes;
    all += other.all;
  }
  [[nodiscard]] double value() const {
    return all == 0 ? 0.0 : static_cast<double>(yes) / static_cast<double>(all);
  }
};

/// What perception and target choice did in many worlds.
struct Figures {
  int worlds = 0;
  Errors near_height;  ///< Cells to 0.8 m ahead [m].
  Errors far_height;   ///< Cells from 0.8 to 1.2 m ahead [m].
  Errors edge;         ///< Of those to 1.2 m ahead that the camera sees [m].
  Errors step;         ///< [m]
  Errors gap_width;    ///< Estimate less truth [m].
  Share near_cells;    ///< Of the ground that rays reach, on the foot tracks, to 1.2 m ahead.
  Share far_cells;     ///< The same from 1.2 to 1.5 m.
  int edges_missed = 0;
  int edges_invented = 0;
  int accepted = 0;    ///< Places listed as targets, the chosen ones included.
  int false_safe = 0;  ///< Of them: a sole with 1 cm to spare does not rest on one tread.
  int chosen = 0;
  int chosen_unsafe = 0;
  int roomy = 0;         ///< Places in sight with 6 cm to spare at toe and heel.
  int false_reject = 0;  ///< Of them: no foothold.

  void add(const Figures& other);
  [[nodiscard]] std::string text() const;
};

/// Looks at worlds first, first + 1, ... with frames of a D435 at 640x480 from the default camera.
[[nodiscard]] Figures measure(std::uint64_t first, int worlds, const Faults& faults);

}  // namespace hopscotch::accuracy
