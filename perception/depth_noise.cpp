#include "perception/depth_noise.hpp"

namespace hopscotch::perception {

double depth_sigma(const DepthNoiseConfig& noise, double depth) {
  return noise.base + noise.quadratic * depth * depth;
}

double height_variance(const DepthNoiseConfig& noise, const ViewOfCell& view) {
  const double height_per_depth = view.rise / view.depth;
  const double sigma = depth_sigma(noise, view.depth) * height_per_depth;
  return sigma * sigma + shared_variance(noise, view);
}

double shared_variance(const DepthNoiseConfig& noise, const ViewOfCell& view) {
  const double from_tilt = noise.tilt * view.horizontal;
  return noise.floor * noise.floor + from_tilt * from_tilt;
}

}  // namespace hopscotch::perception
