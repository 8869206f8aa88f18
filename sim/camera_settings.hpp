#pragma once

#include <cstdint>

namespace hopscotch::sim {

enum class CameraNoise : std::uint8_t { none, d435 };

/// The simulated depth camera of a scenario: image, timing and mounting on the trunk. The defaults
/// are those of the scenario file.
struct CameraSettings {
  CameraNoise noise = CameraNoise::d435;
  int width = 640;        ///< [pixel]
  int height = 480;       ///< [pixel]
  double rate = 30.0;     ///< Exposures per second [Hz].
  double latency = 0.04;  ///< From mid exposure to delivery [s].
  double x = 0.09;        ///< Optical centre ahead of B [m].
  double z = 0.08;        ///< Optical centre above B [m].
  double pitch = 0.60;    ///< Of the optical axis below the trunk's x axis [rad].

  // Faults that nobody tells the controller of.
  double lost_pixels = 0.0;  ///< Share of the image that measures nothing, in blocks of 8 pixels.
  double lost_frames = 0.0;  ///< Share of the exposures that never arrive.
  double time_error = 0.0;   ///< Stamps are later than the exposure by this [s].
  double pitch_error = 0.0;  ///< It looks further down than its mounting says [rad].
};

}  // namespace hopscotch::sim
