#pragma once

#include <Eigen/Core>
#include <stdexcept>
#include <vector>

namespace hopscotch::perception {

/// What is wrong with the bytes of a point cloud.
class MalformedCloud : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Points of one recording; NaN where nothing was measured.
struct PointCloud {
  int width = 0;   ///< Points in a row of the sensor; all of them when unorganised.
  int height = 1;  ///< Rows of the sensor; 1 when unorganised.
  std::vector<Eigen::Vector3f> points;  ///< Row by row [m], in the recording's own frame.

  [[nodiscard]] bool is_organised() const { return height > 1; }
};

}  // namespace hopscotch::perception
