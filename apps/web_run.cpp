#include "apps/web_run.hpp"

#include <array>
#include <chrono>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <thread>

#include "apps/command_gate.hpp"

namespace hopscotch::apps {

using Json = nlohmann::ordered_json;

namespace {

double number(const Json& json, const char* name, double otherwise) {
  const auto found = json.find(name);
  if (found == json.end()) return otherwise;
  if (!found->is_number()) throw std::invalid_argument(std::string(name) + " must be a number");
  return found->get<double>();
}

core::ModeRequest mode_of(const Json& name) {
  using core::ModeRequest;
  for (const ModeRequest mode : {ModeRequest::enable, ModeRequest::jump, ModeRequest::hold,
                                 ModeRequest::stop, ModeRequest::damp, ModeRequest::clear_fault}) {
    if (name.is_string() && name.get<std::string>() == core::mode_request_name(mode)) return mode;
  }
  throw std::invalid_argument("there is no such mode");
}

std::string take_command(const std::string& request, std::uint64_t run_id, CommandBox& box) {
  const core::OperatorCommand command = page_command(request, run_id);
  if (!box.put(command)) throw std::invalid_argument("too many commands wait");
  return Json{{"sequence", command.sequence}}.dump();
}

}  // namespace

core::OperatorCommand page_command(const std::string& request, std::uint64_t run_id) {
  const Json json = Json::parse(request, nullptr, false);
  if (!json.is_object()) throw std::invalid_argument("not a JSON object");
  core::OperatorCommand command;
  command.run_id = run_id;
  command.sequence = wall_clock_us();
  if (json.contains("mode")) {
    command.mode = mode_of(json["mode"]);
  } else if (json.contains("clear")) {
    command.clear_target = true;
  } else if (json.contains("target") && json["target"].is_object()) {
    const Json& target = json["target"];
    command.target = core::TargetOverride{.distance = number(target, "distance", core::kNaN),
                                          .height = number(target, "height", core::kNaN),
                                          .lateral = number(target, "lateral", 0.0),
                                          .yaw = number(target, "yaw", 0.0)};
  } else {
    throw std::invalid_argument("one of mode, clear and target must be given");
  }
  return command;
}

WebRun::WebRun(int port, std::uint64_t run_id, const RunRequest& request, CommandBox& box)
    : story_(request.plant_robot, {.run_id = run_id_text(run_id),
                                   .scenario = request.scenario.name,
                                   .live = true,
                                   .result = {}}),
      dispatcher_(story_.handlers()),
      proposals_(request.config, request.robot),
      server_(
          port, story_, {},
          {.propose = [this](const std::string& asked) { return proposals_.propose(asked); },
           .command = [run_id, &box](
                          const std::string& asked) { return take_command(asked, run_id, box); }}) {
}

void WebRun::show(const msgs::Event& event) {
  dispatcher_.take(event.now, event.channel, event.bytes);
}

void WebRun::finish(const std::string& result_json) {
  constexpr auto kLastLook = std::chrono::milliseconds(1500);
  story_.finish(result_json);
  std::this_thread::sleep_for(kLastLook);
}

}  // namespace hopscotch::apps
