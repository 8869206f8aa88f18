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

struct Film::Studio {
  static constexpr VideoEncoder::Format kFormat{.width = 960, .height = 540, .rate = 30};
  sim::SceneRenderer renderer;
  VideoEncoder encoder;
  FollowingCamera camera;
  sim::RgbImage image;

  Studio(const std::string& mjcf, const std::filesystem::path& file)
      : renderer(mjcf, kFormat.width, kFormat.height, sim::Quality::film), encoder(file, kFormat) {}
};

Film::Film(const std::string& mjcf, const std::filesystem::path& file)
    : studio_(std::make_unique<Studio>(mjcf, file)) {}
Film::~Film() = default;

void Film::add(const core::RobotState& state, const std::string& caption) {
  sim::RgbImage& image = studio_->image;
  studio_->renderer.render(state, studio_->camera.view(state, kStep), image);
  cv::Mat picture = as_matrix(image);
  write_caption(picture, caption);
  studio_->encoder.add(image.pixels);
}

void Film::finish() {
  studio_->encoder.finish();
}

void write_video(const RunFolder& folder) {
  const RunRecord run = load_run(folder);
  Film film(read_file(folder.scene()), folder.video());
  const double end = run.moments.empty() ? -1.0 : run.moments.back().time;
  for (int frame = 0; frame * Film::kStep <= end; ++frame) {
    const double time = frame * Film::kStep;
    film.add(run.moment_at(time).state, caption_at(run, time));
  }
  film.finish();
}

}  // namespace hopscotch::apps
