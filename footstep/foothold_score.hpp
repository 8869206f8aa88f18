#pragma once

#include <Eigen/Core>

#include "core/reason.hpp"
#include "core/robot_state.hpp"
#include "core/terrain_map.hpp"
#include "footstep/footstep_config.hpp"
#include "model/robot_parameters.hpp"

namespace hopscotch::footstep {

/// Where both feet would stand: their mid-point and direction in S.
struct Placement {
  double x = 0.0;    ///< [m]
  double y = 0.0;    ///< [m]
  double yaw = 0.0;  ///< [rad]
};

/// Ground and feet: all that a placement is judged by.
struct StanceOnMap {
  const core::TerrainMap& map;
  Eigen::Vector3d p_WS = Eigen::Vector3d::Constant(core::kNaN);  ///< [m]
  double heading = core::kNaN;                                   ///< [rad]
  double half_stance = core::kNaN;  ///< Soles lie so far left and right of the mid-point [m].
  double half_length = core::kNaN;  ///< Of a sole [m].
  double half_width = core::kNaN;   ///< Of a sole [m].
};

/// What the map says about standing at one placement.
struct Foothold {
  Placement placement;
  core::Reason why = core::Reason::none;  ///< `none`: safe. Otherwise why not.
  bool supported = false;                 ///< Both feet rest on one plane, edges disregarded.
  double height = core::kNaN;             ///< Of the plane at the mid-point, in S [m].
  double rise_across = 0.0;               ///< Of the plane per metre to the left of the soles [-].
  double toe_margin = core::kNaN;   ///< Toes to the end of the tread; at most kMarginSearch [m].
  double heel_margin = core::kNaN;  ///< Heels to its start; at most kMarginSearch [m].
  double safe_probability = 0.0;    ///< Toes and heels come to rest on the tread.

  /// Smaller one of the two margins [m].
  [[nodiscard]] double margin() const {
    return toe_margin < heel_margin ? toe_margin : heel_margin;
  }
};

/// Margins are searched up to here: more is worth nothing [m].
inline constexpr double kMarginSearch = 0.15;

/// Judges a line-foot stance: the cells under both feet must be observed, lie on one plane of
/// bearable slope, be known well enough, and the tread must go on beyond toes and heels. Cells that
/// are only inferred never bear.
[[nodiscard]] Foothold score_foothold(const FootholdConfig& config, const StanceOnMap& stance,
                                      const Placement& placement);

/// Probability that a landing with normal scatter `sigma` [m] keeps both margins [m].
[[nodiscard]] double safe_probability(double toe_margin, double heel_margin, double sigma);

}  // namespace hopscotch::footstep
