#include <linux/can.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "apps/commands.hpp"
#include "apps/doctor_can.hpp"
#include "apps/doctor_packages.hpp"
#include "apps/finding.hpp"
#include "apps/installation.hpp"
#include "apps/program_config.hpp"
#include "core/config_reader.hpp"
#include "model/robot_parameters.hpp"
#include "sim/scene_builder.hpp"
#include "sim/scene_renderer.hpp"

namespace hopscotch::apps {

namespace {

Finding check_configuration() {
  Finding finding{.name = "configuration", .needed_for = "everything"};
  try {
    (void)ProgramConfig::load(config_directory() / "hopscotch.yaml");
    finding.ok = true;
    finding.found = (config_directory() / "hopscotch.yaml").string();
  } catch (const core::ConfigError& error) {
    finding.found = error.what();
    finding.fix = "correct the named line";
  }
  return finding;
}

Finding check_rendering() {
  Finding finding{.name = "offscreen rendering", .needed_for = "key frames of the report, --video"};
  try {
    const model::RobotParameters robot = model::RobotParameters::load(robot_file("hector"));
    const sim::SceneRenderer renderer(sim::scene_mjcf(robot, {}), 64, 48, sim::Quality::still);
    finding.ok = true;
    finding.found = "EGL without a surface";
  } catch (const std::exception& error) {
    finding.found = error.what();
    finding.fix = "apt-get install libegl1 libgl1-mesa-dri";
  }
  return finding;
}

bool on_path(const std::string& program) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (access((std::filesystem::path(folder) / program).c_str(), X_OK) == 0) return true;
  }
  return false;
}

Finding check_ffmpeg() {
  const bool ok = on_path("ffmpeg");
  return {.name = "ffmpeg",
          .ok = ok,
          .found = ok ? "on the path" : "not on the path",
          .fix = ok ? "" : "apt-get install ffmpeg",
          .needed_for = "--video"};
}

Finding check_display() {
  const char* display = std::getenv("DISPLAY");
  const bool ok = display != nullptr && *display != '\0';
  return {.name = "display",
          .ok = ok,
          .found = ok ? display : "DISPLAY is not set",
          .fix = ok ? "" : "run in a desktop session, or with ssh -X",
          .needed_for = "--view"};
}

Finding check_real_time() {
  rlimit limit{};
  getrlimit(RLIMIT_RTPRIO, &limit);
  const bool ok = geteuid() == 0 || limit.rlim_cur >= 80;
  return {
      .name = "real-time priority",
      .ok = ok,
      .found = geteuid() == 0 ? "root" : "limit " + std::to_string(limit.rlim_cur),
      .fix = ok ? "" : "add '@realtime - rtprio 90' to /etc/security/limits.conf and log in again",
      .needed_for = "the robot"};
}

Finding check_memory_lock() {
  rlimit limit{};
  getrlimit(RLIMIT_MEMLOCK, &limit);
  const bool ok = geteuid() == 0 || limit.rlim_cur == RLIM_INFINITY;
  return {.name = "locked memory",
          .ok = ok,
          .found = ok ? "unlimited" : "limited",
          .fix = ok ? "" : "add '@realtime - memlock unlimited' to /etc/security/limits.conf",
          .needed_for = "the robot"};
}

Finding check_can_kernel() {
  const int socket_fd = socket(AF_CAN, SOCK_RAW, CAN_RAW);
  if (socket_fd >= 0) close(socket_fd);
  const bool ok = socket_fd >= 0;
  return {.name = "SocketCAN",
          .ok = ok,
          .found = ok ? "in the kernel" : "the kernel has no CAN",
          .fix = ok ? "" : "modprobe can_raw, or boot a kernel that has it",
          .needed_for = "the robot"};
}

Finding check_real_time_kernel() {
  std::ifstream file("/sys/kernel/realtime");
  int flag = 0;
  const bool ok = file >> flag && flag == 1;
  return {.name = "real-time kernel",
          .ok = ok,
          .found = ok ? "PREEMPT_RT" : "not PREEMPT_RT",
          .fix = ok ? "" : "apt-get install linux-image-rt-amd64 and boot it",
          .needed_for = "the robot's deadlines under load"};
}

Finding check_multicast() {
  std::ifstream routes("/proc/net/route");
  bool ok = false;
  for (std::string line; std::getline(routes, line);) {
    std::istringstream fields(line);
    std::string interface_name;
    std::string destination;
    fields >> interface_name >> destination;
    // 224.0.0.0 in network order as the kernel prints it, or a default route.
    ok = ok || destination == "000000E0" || destination == "00000000";
  }
  return {.name = "multicast route",
          .ok = ok,
          .found = ok ? "there" : "none",
          .fix = ok ? "" : "ip route add 224.0.0.0/4 dev lo",
          .needed_for = "LCM to other programs"};
}

std::vector<Finding> examine() {
  std::vector<Finding> findings{check_configuration(), check_rendering(), check_ffmpeg(),
                                check_display(),       check_real_time(), check_real_time_kernel(),
                                check_memory_lock(),   check_can_kernel()};
  const std::vector<Finding> packages = check_packages();
  findings.insert(findings.begin() + 1, packages.begin(), packages.end());
  const std::vector<Finding> buses = check_can(config_directory() / "robot_bus.yaml");
  findings.insert(findings.end(), buses.begin(), buses.end());
  findings.push_back(check_multicast());
  return findings;
}

void print_people(const std::vector<Finding>& findings) {
  for (const Finding& finding : findings) {
    std::printf("%-4s %-20s %s\n", finding.ok ? "ok" : "--", finding.name.c_str(),
                finding.found.c_str());
    if (!finding.ok) {
      std::printf("     needed for %s; fix: %s\n", finding.needed_for.c_str(), finding.fix.c_str());
    }
  }
}

void print_json(const std::vector<Finding>& findings) {
  nlohmann::ordered_json json;
  json["schema"] = "hopscotch.doctor/1";
  json["program"] = program_version();
  json["checks"] = nlohmann::ordered_json::array();
  for (const Finding& finding : findings) {
    json["checks"].push_back({{"name", finding.name},
                              {"ok", finding.ok},
                              {"found", finding.found},
                              {"fix", finding.fix},
                              {"needed_for", finding.needed_for}});
  }
  std::printf("%s\n", json.dump(2).c_str());
}

}  // namespace

void add_doctor_command(CLI::App& app, Action& action) {
  CLI::App* command =
      app.add_subcommand("doctor", "What this machine can and cannot do, each with the fix");
  command->footer("Example: hopscotch doctor --json");
  const auto json = std::make_shared<bool>(false);  // shared with the action below
  command->add_flag("--json", *json, "Print one JSON object");
  command->callback([&action, json] {
    action = [json] {
      const std::vector<Finding> findings = examine();
      *json ? print_json(findings) : print_people(findings);
      return findings.front().ok ? ExitStatus::ok : ExitStatus::machine_lacks;
    };
  });
}

}  // namespace hopscotch::apps
