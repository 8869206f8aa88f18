#pragma once

#include <optional>
#include <vector>

namespace hopscotch::perception {

/// A stretch of connected support along the jump line.
struct Tread {
  double start = 0.0;         ///< In S [m].
  double end = 0.0;           ///< In S [m].
  double start_height = 0.0;  ///< Near its start, in S [m].
  double end_height = 0.0;    ///< Near its end, in S [m].
  double variance = 0.0;      ///< Of these heights [m^2].
};

/// The straight line along which a tread ends or begins.
struct EdgeLine {
  double x = 0.0;        ///< Where it crosses the jump line, in S [m].
  double skew = 0.0;     ///< Against straight across; positive: ahead on the left [rad].
  double scatter = 0.0;  ///< Standard deviation of single places along the tracks about it [m].
};

/// What lies behind a tread; a side is empty when too few lines along the foot tracks tell it.
struct TreadBreak {
  std::optional<EdgeLine> end;    ///< Of the tread before.
  std::optional<EdgeLine> start;  ///< Of the tread behind.
};

/// The jump line divided into treads, ascending.
struct DividedLine {
  std::vector<Tread> treads;
  std::vector<TreadBreak> breaks;  ///< One behind each tread.
};

}  // namespace hopscotch::perception
