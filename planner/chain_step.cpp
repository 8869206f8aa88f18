#include "planner/chain_step.hpp"

#include "planner/link_fold.hpp"

namespace hopscotch::planner {

namespace {

using Selection = std::array<double, kFlightDof>;
/// Hip, knee and ankle motor rates as sums of the rates of (shank, knee, trunk, foot).
constexpr std::array<Selection, 3> kMotor{{{1, -1, -1, 0}, {0, 1, 0, 0}, {-1, 1, 0, 1}}};
/// Hip, knee and ankle joint angles likewise.
constexpr std::array<Selection, 3> kJoint{{{1, -1, -1, 0}, {0, 1, 0, 0}, {-1, 0, 0, 1}}};
/// Link pitches (foot, shank, thigh, trunk) likewise.
constexpr std::array<Selection, 4> kLink{{{0, 0, 0, 1}, {1, 0, 0, 0}, {1, -1, 0, 0}, {0, 0, 1, 0}}};

template <int Dof>
typename StepTerms<Dof>::Slope folded(const LinkSlope& slope) {
  typename StepTerms<Dof>::Slope out{};
  fold<Dof>(slope.pitch, out.data());
  fold<Dof>(slope.rate, out.data() + Dof);
  fold<Dof>(slope.acceleration, out.data() + 2 * Dof);
  return out;
}

template <std::size_t N>
void add_scaled(double factor, const std::array<double, N>& from, std::array<double, N>& to) {
  for (std::size_t i = 0; i < N; ++i) to[i] += factor * from[i];
}

/// to += factor a a^T
template <std::size_t N>
void add_square(double factor, const std::array<double, N>& a,
                std::array<std::array<double, N>, N>& to) {
  for (std::size_t i = 0; i < N; ++i) add_scaled(factor * a[i], a, to[i]);
}

}  // namespace

template <int Dof>
struct ChainStep<Dof>::Loads {
  LinkMotion motion;
  std::array<double, 3> torque{};  ///< Of the motors [N·m].
  std::array<Slope, 3> torque_slope{};
  std::array<double, 3> speed{};        ///< Of the motors [rad/s].
  std::array<Slope, 3> ground_slope{};  ///< F_x, F_z and the moment about the ankle axis.
};

template <int Dof>
ChainStep<Dof>::ChainStep(const model::PlanarDynamics& dynamics, const MotorRows& motors,
                          const GroundRows& ground, double cost_scale)
    : dynamics_(dynamics),
      limits_{motors.limits.hip, motors.limits.knee, motors.limits.ankle},
      ground_(ground),
      cost_scale_(cost_scale) {
  const model::PlanarChain& chain = dynamics.chain();
  constexpr std::size_t kDof = Terms::kDof;
  for (std::size_t c = 0; c < kDof; ++c) {
    passive_[0][kDof + c] = chain.damping_hip * kJoint[0][c];
    passive_[0][2 * kDof + c] = chain.armature_hip * kMotor[0][c];
    passive_[1][kDof + c] = chain.damping_knee * kJoint[1][c] - chain.damping_ankle * kJoint[2][c];
    passive_[1][2 * kDof + c] = chain.armature_knee * kMotor[1][c];
    passive_[2][kDof + c] = chain.damping_ankle * kJoint[2][c];
    passive_[2][2 * kDof + c] = chain.armature_ankle * kMotor[2][c];
  }
}

template <int Dof>
void ChainStep<Dof>::find_loads(const Slope& middle, Loads& loads) const {
  constexpr std::size_t kDof = Terms::kDof;
  LinkMotion& motion = loads.motion;
  for (std::size_t l = 0; l < model::kPlanarLinks; ++l) {
    for (std::size_t c = 0; c < kDof; ++c) {
      motion.pitch[l] += kLink[l][c] * middle[c];
      motion.rate[l] += kLink[l][c] * middle[kDof + c];
      motion.acceleration[l] += kLink[l][c] * middle[2 * kDof + c];
    }
  }
  motion.turn();
  LinkForces forces;
  if constexpr (Dof == kStanceDof) {
    GroundForce ground;
    stance_forces(dynamics_, motion, forces, ground);
    loads.ground_slope[0] = folded<Dof>(ground.slope_x);
    loads.ground_slope[1] = folded<Dof>(ground.slope_z);
  } else {
    flight_forces(dynamics_, motion, forces);
  }
  const Slope shank = folded<Dof>(forces.slope[model::kShank]);
  const Slope thigh = folded<Dof>(forces.slope[model::kThigh]);
  const Slope trunk = folded<Dof>(forces.slope[model::kTrunk]);
  for (std::size_t i = 0; i < Terms::kSize; ++i) {
    loads.torque_slope[0][i] = passive_[0][i] - trunk[i];
    loads.torque_slope[1][i] = passive_[1][i] + shank[i];
    loads.ground_slope[2][i] = shank[i] + thigh[i] + trunk[i];
    loads.torque_slope[2][i] = passive_[2][i] - loads.ground_slope[2][i];
  }
  const double sum =
      forces.value[model::kShank] + forces.value[model::kThigh] + forces.value[model::kTrunk];
  loads.torque = {-forces.value[model::kTrunk], forces.value[model::kShank], -sum};
  for (std::size_t motor = 0; motor < 3; ++motor) {
    for (std::size_t c = 0; c < kDof; ++c) {
      loads.speed[motor] += kMotor[motor][c] * middle[kDof + c];
    }
    for (std::size_t i = kDof; i < 3 * kDof; ++i) {
      loads.torque[motor] += passive_[motor][i] * middle[i];
    }
  }
}

template <int Dof>
void ChainStep<Dof>::write_slopes(const Slope& middle, const Loads& loads, Terms& terms) const {
  constexpr std::size_t kDof = Terms::kDof;
  const double h = middle[3 * kDof];
  for (std::size_t motor = 0; motor < 3; ++motor) {
    const MotorLimit& limit = limits_[motor];
    const Slope& torque = loads.torque_slope[motor];
    Slope* row = &terms.slope[MotorRows::kPerMotor * motor];
    const double line = (limit.speed - limit.corner_speed) / limit.speed / limit.torque;
    const double power = loads.speed[motor] / limit.power;
    for (std::size_t i = 0; i < Terms::kSize; ++i) {
      row[0][i] = torque[i] / limit.torque;
      row[1][i] = row[2][i] = line * torque[i];
      row[3][i] = power * torque[i];
    }
    double change = 0.0;
    for (std::size_t c = 0; c < kDof; ++c) {
      const double rate = kMotor[motor][c] / limit.speed;
      row[1][kDof + c] += rate;
      row[2][kDof + c] += rate;
      row[1][2 * kDof + c] -= 0.5 * h * rate;
      row[2][2 * kDof + c] += 0.5 * h * rate;
      row[3][kDof + c] += loads.torque[motor] / limit.power * kMotor[motor][c];
      change += rate * middle[2 * kDof + c];
    }
    row[1][3 * kDof] -= 0.5 * change;
    row[2][3 * kDof] += 0.5 * change;
  }
  if constexpr (Dof == kStanceDof) {
    Slope* row = &terms.slope[MotorRows::kRows];
    const double scale = 1.0 / ground_.weight;
    constexpr double kLength = GroundRows::kFootLength;
    for (std::size_t i = 0; i < Terms::kSize; ++i) {
      const double fx = scale * loads.ground_slope[0][i];
      const double fz = scale * loads.ground_slope[1][i];
      const double pressure =
          (scale * loads.ground_slope[2][i] + ground_.sole_height * fx) / kLength;
      row[0][i] = fz;
      row[1][i] = ground_.friction * fz - fx;
      row[2][i] = ground_.friction * fz + fx;
      row[3][i] = ground_.toe / kLength * fz + pressure;
      row[4][i] = ground_.heel / kLength * fz - pressure;
    }
  }
}

/// Cost gradient, and the part of its Hessian that needs no second derivatives of loads.
template <int Dof>
void ChainStep<Dof>::add_cost(const StepObjective& objective, const Slope& middle,
                              const Loads& loads, Terms& terms) const {
  constexpr std::size_t kDof = Terms::kDof;
  const CostWeights& weights = objective.weights;
  const double two = 2.0 * cost_scale_;
  const auto add_linear = [&](std::size_t block, double weight, const Selection& selection,
                              double value) {
    for (std::size_t i = 0; i < kDof; ++i) {
      terms.gradient[block + i] += two * weight * value * selection[i];
      for (std::size_t j = 0; j < kDof; ++j) {
        terms.convex[block + i][block + j] += two * weight * selection[i] * selection[j];
      }
    }
  };
  const auto dot = [&](std::size_t block, const Selection& selection) {
    double sum = 0.0;
    for (std::size_t i = 0; i < kDof; ++i) sum += selection[i] * middle[block + i];
    return sum;
  };
  const std::array<double, 3> reference{objective.reference.hip, objective.reference.knee,
                                        objective.reference.ankle};
  for (std::size_t i = 0; i < 3; ++i) {
    add_linear(0, weights.posture, kJoint[i], dot(0, kJoint[i]) - reference[i]);
    add_linear(kDof, weights.rate, kJoint[i], dot(kDof, kJoint[i]));
  }
  add_linear(0, weights.trunk_pitch, kLink[model::kTrunk],
             middle[kTrunkPitch] - objective.trunk_pitch);
  for (const Selection& link : kLink) {
    add_linear(2 * kDof, weights.acceleration, link, dot(2 * kDof, link));
  }
  if (weights.torque <= 0.0) return;
  Slope knee = loads.torque_slope[1];
  add_scaled(1.0, loads.torque_slope[2], knee);
  const double torque = two * weights.torque;
  add_scaled(torque * loads.torque[0], loads.torque_slope[0], terms.gradient);
  add_scaled(torque * (loads.torque[1] + loads.torque[2]), knee, terms.gradient);
  add_scaled(torque * loads.torque[2], loads.torque_slope[2], terms.gradient);
  add_square(torque, loads.torque_slope[0], terms.convex);
  add_square(torque, knee, terms.convex);
  add_square(torque, loads.torque_slope[2], terms.convex);
}

template <int Dof>
void ChainStep<Dof>::add_row_curvature(const StepObjective& objective, const Loads& loads,
                                       const Multipliers& multipliers, Terms& terms) const {
  constexpr std::size_t kDof = Terms::kDof;
  const double torque = 2.0 * cost_scale_ * objective.weights.torque;
  std::array<double, 3> weight{torque * loads.torque[0],
                               torque * (loads.torque[1] + loads.torque[2]),
                               torque * (loads.torque[1] + 2.0 * loads.torque[2])};
  for (std::size_t motor = 0; motor < 3; ++motor) {
    const MotorLimit& limit = limits_[motor];
    const double* row = &multipliers[MotorRows::kPerMotor * motor];
    const double line = (limit.speed - limit.corner_speed) / limit.speed;
    weight[motor] += (row[0] + line * (row[1] + row[2])) / limit.torque +
                     row[3] * loads.speed[motor] / limit.power;
    const double half = 0.5 * (row[2] - row[1]) / limit.speed;
    for (std::size_t c = 0; c < kDof; ++c) {
      const double selected = kMotor[motor][c];
      if (selected == 0.0) continue;
      const double power = row[3] / limit.power * selected;
      for (std::size_t i = 0; i < Terms::kSize; ++i) {
        terms.curvature[kDof + c][i] += power * loads.torque_slope[motor][i];
        terms.curvature[i][kDof + c] += power * loads.torque_slope[motor][i];
      }
      terms.curvature[2 * kDof + c][3 * kDof] += half * selected;
      terms.curvature[3 * kDof][2 * kDof + c] += half * selected;
    }
  }
  add_load_curvature(loads, weight, multipliers, terms);
}

/// Second derivatives of the loads, by the factors of motor torques and of the ground rows.
template <int Dof>
void ChainStep<Dof>::add_load_curvature(const Loads& loads, const std::array<double, 3>& weight,
                                        const Multipliers& multipliers, Terms& terms) const {
  constexpr std::size_t kDof = Terms::kDof;
  LinkCurvature curvature;
  LoadWeights loads_weight;
  loads_weight.force = {0.0, weight[1] - weight[2], -weight[2], -weight[0] - weight[2]};
  if constexpr (Dof == kStanceDof) {
    const double* row = &multipliers[MotorRows::kRows];
    const double pressure = (row[3] - row[4]) / (GroundRows::kFootLength * ground_.weight);
    loads_weight.ground.x = (row[2] - row[1]) / ground_.weight + ground_.sole_height * pressure;
    loads_weight.ground.z =
        (row[0] + ground_.friction * (row[1] + row[2]) +
         (ground_.toe * row[3] + ground_.heel * row[4]) / GroundRows::kFootLength) /
        ground_.weight;
    for (std::size_t l = model::kShank; l < model::kPlanarLinks; ++l) {
      loads_weight.force[l] += pressure;
    }
    stance_curvature(dynamics_, loads.motion, loads_weight, curvature);
  } else {
    flight_curvature(dynamics_, loads.motion, loads_weight.force, curvature);
  }
  const auto pitch = folded_table<Dof>(curvature.pitch);
  const auto pitch_rate = folded_table<Dof>(curvature.pitch_rate);
  const auto pitch_acceleration = folded_table<Dof>(curvature.pitch_acceleration);
  LinkCurvature::Table diagonal{};
  for (std::size_t l = 0; l < model::kPlanarLinks; ++l) diagonal[l][l] = curvature.rate[l];
  const auto rate = folded_table<Dof>(diagonal);
  for (std::size_t i = 0; i < kDof; ++i) {
    for (std::size_t j = 0; j < kDof; ++j) {
      terms.curvature[i][j] += pitch[i][j];
      terms.curvature[i][kDof + j] += pitch_rate[i][j];
      terms.curvature[kDof + j][i] += pitch_rate[i][j];
      terms.curvature[i][2 * kDof + j] += pitch_acceleration[i][j];
      terms.curvature[2 * kDof + j][i] += pitch_acceleration[i][j];
      terms.curvature[kDof + i][kDof + j] += rate[i][j];
    }
  }
}

template <int Dof>
void ChainStep<Dof>::expand(const StepObjective& objective, const Slope& middle,
                            const Multipliers& multipliers, Terms& terms) const {
  Loads loads;
  find_loads(middle, loads);
  terms.gradient = {};
  terms.convex = {};
  terms.curvature = {};
  write_slopes(middle, loads, terms);
  add_cost(objective, middle, loads, terms);
  add_row_curvature(objective, loads, multipliers, terms);
}

template class ChainStep<kStanceDof>;
template class ChainStep<kFlightDof>;

}  // namespace hopscotch::planner
