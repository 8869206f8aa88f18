#pragma once

#include "core/config_reader.hpp"
#include "core/one_step_terrain.hpp"

namespace hopscotch::footstep {

/// How far the map's heights are believed; section `footstep.doubt`.
struct DoubtConfig {
  double tolerance = 0.0;  ///< A landing so far off in height is no surprise [m].
  double gain = 0.0;       ///< Doubt per metre of surprise beyond the tolerance [-].
  double max = 0.0;        ///< Of the doubt [m].
  double keep = 0.0;       ///< Share of the doubt that is left after each landing as expected.

  static DoubtConfig load(const core::ConfigReader& section);
};

/// How much higher than the map says the ground ahead may be, learnt from where the robot came to
/// stand: ground that was wrong once may be wrong again.
class HeightDoubt {
 public:
  explicit HeightDoubt(const DoubtConfig& config) : config_(config) {}

  /// A landing has calmed down.
  /// @param surprise Height of the soles over the ground that was aimed at [m]; NaN is ignored.
  void landed(double surprise);
  /// [m], 0 while all landings were as expected.
  [[nodiscard]] double height() const { return height_; }

 private:
  DoubtConfig config_;
  double height_ = 0.0;
};

/// The stretch under the soles lies where the soles are, whatever the map says of its height: it is
/// moved as a whole, as far as it is seen to go on.
void put_underfoot(core::TerrainProfile& profile);

/// A stretch along the jump line, in S [m].
struct JumpStretch {
  double begin = 0.0;
  double end = 0.0;
};

/// From `begin` on [m] the ground is what another profile says.
void take_over(const core::TerrainProfile& other, double begin, core::TerrainProfile& profile);

/// Raises `upper` within the stretch, up to a bound that the planner then keeps clear of.
void raise(const JumpStretch& stretch, double height, core::TerrainProfile& profile);

}  // namespace hopscotch::footstep
