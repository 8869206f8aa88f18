#include "apps/video.hpp"

#include <opencv2/core.hpp>
#include <string>

#include "apps/caption.hpp"
#include "apps/following_camera.hpp"
#include "apps/html.hpp"
#include "apps/report_data.hpp"
#include "apps/text_file.hpp"
#include "apps/video_encoder.hpp"
#include "sim/scene_renderer.hpp"

namespace hopscotch::apps {

namespace {

std::string caption_at(const RunRecord& run, double time) {
  std::string phase;
  for (const PhaseSpan& span : run.phases) {
    if (span.begin <= time) phase = core::robot_phase_name(span.phase);
  }
  std::string text = fixed(time, 2).append(" s   ").append(phase);
  for (const JumpRecord& jump : run.jumps) {
    const bool during = jump.begin <= time && time <= jump.end;
    if (during) text.append("   jump ").append(std::to_string(jump.index));
  }
  return text;
}

}  // namespace

void write_video(const RunFolder& folder) {
  constexpr VideoEncoder::Format kFormat{.width = 960, .height = 540, .rate = 30};
  constexpr double kStep = 1.0 / kFormat.rate;  // real time
  const RunRecord run = load_run(folder);
  sim::SceneRenderer renderer(read_file(folder.scene()), kFormat.width, kFormat.height,
                              sim::Quality::film);
  VideoEncoder encoder(folder.video(), kFormat);
  FollowingCamera camera;
  sim::RgbImage image;
  const double end = run.moments.empty() ? -1.0 : run.moments.back().time;
  for (int frame = 0; frame * kStep <= end; ++frame) {
    const double time = frame * kStep;
    const core::RobotState& state = run.moment_at(time).state;
    renderer.render(state, camera.view(state, kStep), image);
    cv::Mat picture = as_matrix(image);
    write_caption(picture, caption_at(run, time));
    encoder.add(image.pixels);
  }
  encoder.finish();
}

}  // namespace hopscotch::apps
