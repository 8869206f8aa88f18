#include "sim/scene_stage.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>

#include "core/check.hpp"
#include "core/robot_layout.hpp"

namespace hopscotch::sim {

namespace {

constexpr int kMostGeoms = 2000;   // of one picture; robot and terrain have a few hundred
constexpr int kStillSamples = 4;   // per pixel: slab edges and thin legs look ragged without
constexpr int kShadowSize = 1024;  // of the shadow map [pixel]; MuJoCo's 4096 cost 30 ms a picture

ModelPointer compile_for_drawing(const std::string& mjcf, const mjrRect& size, Quality quality) {
  ModelPointer model = compile_model(mjcf);
  model->vis.global.offwidth = size.width;
  model->vis.global.offheight = size.height;
  model->vis.quality.offsamples = quality == Quality::still ? kStillSamples : 0;
  model->vis.quality.shadowsize = kShadowSize;
  // The scene has a sun and a sky light; MuJoCo's lamp at the eye would bleach pale slabs.
  std::fill_n(model->vis.headlight.diffuse, 3, 0.08F);
  std::fill_n(model->vis.headlight.specular, 3, 0.1F);
  return model;
}

}  // namespace

SceneStage::SceneStage(const std::string& mjcf, const mjrRect& size, mjtFramebuffer buffer,
                       Quality quality)
    : model_(compile_for_drawing(mjcf, size, quality)), data_(make_data(*model_)) {
  HOPSCOTCH_CHECK(model_->nq == 7 + core::kJoints);
  mjv_defaultScene(&scene_);
  mjv_defaultOption(&option_);
  mjv_defaultCamera(&camera_);
  mjr_defaultContext(&context_);
  mjv_makeScene(model_.get(), &scene_, kMostGeoms);
  mjr_makeContext(model_.get(), &context_, mjFONTSCALE_100);
  mjr_setBuffer(buffer, &context_);
  scene_.flags[mjRND_REFLECTION] = 0;  // a second pass for little
}

SceneStage::~SceneStage() {
  mjr_freeContext(&context_);
  mjv_freeScene(&scene_);
}

void SceneStage::draw(const core::RobotState& state, const View& view, const mjrRect& rectangle) {
  pose(state);
  aim(view);
  scene_.flags[mjRND_SHADOW] = view.shadows == Shadows::drawn ? 1 : 0;
  mjv_updateScene(model_.get(), data_.get(), &option_, nullptr, &camera_, mjCAT_ALL, &scene_);
  mjr_render(rectangle, &scene_, &context_);
}

void SceneStage::pose(const core::RobotState& state) {
  const Eigen::Quaterniond q_WB(state.R_WB);
  Eigen::Map<Eigen::Vector3d>(data_->qpos) = state.p_WB;
  Eigen::Map<Eigen::Vector4d>(data_->qpos + 3) << q_WB.w(), q_WB.x(), q_WB.y(), q_WB.z();
  Eigen::Map<core::JointVector>(data_->qpos + 7) = state.q;
  mj_kinematics(model_.get(), data_.get());
  mj_comPos(model_.get(), data_.get());
  mj_camlight(model_.get(), data_.get());
}

void SceneStage::aim(const View& view) {
  constexpr double kDegrees = 180.0 / std::numbers::pi;  // MuJoCo's cameras turn in degrees
  camera_.type = mjCAMERA_FREE;
  std::copy_n(view.target.data(), 3, camera_.lookat);
  camera_.distance = view.distance;
  camera_.azimuth = view.azimuth * kDegrees;
  camera_.elevation = view.elevation * kDegrees;
  model_->vis.global.fovy = static_cast<float>(view.field_of_view * kDegrees);
}

}  // namespace hopscotch::sim
