#include "planner/decision_layout.hpp"

#include "planner/constraint_block.hpp"

namespace hopscotch::planner {

std::array<int, 12> DecisionLayout::takeoff_step_variables(int k) const {
  std::array<int, 12> at{};
  for (int i = 0; i < 12; ++i) at[static_cast<std::size_t>(i)] = takeoff(k) + i;
  return at;
}

std::array<int, 17> DecisionLayout::flight_step_variables(int k) const {
  std::array<int, 17> at{};
  std::size_t next = 0;
  for (const int knot : {k, k + 1}) {
    for (const int block : {0, 1}) {  // y, then v
      for (int d = 0; d < kFlightDof; ++d) {
        if (knot > 0) {
          at[next++] = flight(knot) + block * kFlightDof + d;
        } else {
          at[next++] =
              d < kStanceDof ? takeoff(steps_.takeoff) + block * kStanceDof + d : kNoVariable;
        }
      }
    }
  }
  at[next] = flight_step();
  return at;
}

std::array<int, 13> DecisionLayout::landing_step_variables(int k) const {
  std::array<int, 13> at{};
  std::size_t next = 0;
  for (const int knot : {k, k + 1}) {
    for (const int block : {0, 1}) {
      for (int d = 0; d < kStanceDof; ++d) {
        if (knot > 0 || steps_.landed()) {
          at[next++] = landing(knot) + block * kStanceDof + d;
        } else {
          at[next++] = block == 0 ? flight(steps_.flight) + d : touchdown_rates() + d;
        }
      }
    }
  }
  at[next] = landing_step();
  return at;
}

}  // namespace hopscotch::planner
