#include "sim/ankle_coupling.hpp"

#include <string>

#include "core/check.hpp"

namespace hopscotch::sim {

namespace {

int dof_of(const mjModel& model, core::Leg leg, core::Joint joint) {
  const std::string name = std::string(core::kLegNames[core::index(leg)]) + "_" +
                           std::string(core::kJointNames[core::index(joint)]);
  const int id = mj_name2id(&model, mjOBJ_JOINT, name.c_str());
  HOPSCOTCH_CHECK(id >= 0);
  return model.jnt_dofadr[id];
}

}  // namespace

AnkleCoupling::AnkleCoupling(const mjModel& model, const model::RobotParameters& robot)
    : inertia_(robot.motors[core::index(core::Joint::ankle)].armature), mass_address_{} {
  for (const core::Leg leg : core::kAllLegs) {
    const int ankle = dof_of(model, leg, core::Joint::ankle);
    HOPSCOTCH_CHECK(model.dof_parentid[ankle] == dof_of(model, leg, core::Joint::knee));
    // A row of qM holds the diagonal entry, then those with the ancestors, nearest first.
    mass_address_[core::index(leg)] = model.dof_Madr[ankle] + 1;
  }
}

void AnkleCoupling::couple(const mjModel& model, mjData& data) const {
  for (const int address : mass_address_) data.qM[address] += inertia_;
  mj_factorM(&model, &data);
}

void AnkleCoupling::forward(const mjModel& model, mjData& data) const {
  mj_step1(&model, &data);
  couple(model, data);
  mj_fwdActuation(&model, &data);
  mj_fwdAcceleration(&model, &data);
  mj_fwdConstraint(&model, &data);
  mj_sensorAcc(&model, &data);
}

void AnkleCoupling::step(const mjModel& model, mjData& data) const {
  mj_step1(&model, &data);  // up to velocities: nothing there uses the factored mass matrix
  couple(model, data);
  mj_step2(&model, &data);
}

}  // namespace hopscotch::sim
