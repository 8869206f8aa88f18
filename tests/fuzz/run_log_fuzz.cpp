// Hostile logs: a valid log, edited, cut or lengthened by the input, is read to its end or refused.
#include <unistd.h>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "msgs/run_log.hpp"
#include "tests/unit/msgs/samples.hpp"

namespace {

namespace msgs = hopscotch::msgs;
namespace samples = hopscotch::msgs::samples;

std::filesystem::path file() {
  return std::filesystem::temp_directory_path() / ("run_log_fuzz." + std::to_string(getpid()));
}

std::string valid_log() {
  msgs::RunLogWriter writer(file(), 1);
  writer.write({1'000'000}, samples::sensors());
  writer.write({2'000'000}, samples::status());
  writer.write({3'000'000}, samples::choice());
  writer.close();
  std::ostringstream text;
  text << std::ifstream(file(), std::ios::binary).rdbuf();
  return text.str();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::string original = valid_log();
  std::string bytes = original;
  if (size >= 2 && (data[0] | data[1]) != 0) bytes.resize(data[0] + 256U * data[1]);
  for (std::size_t i = 2; i + 3 <= size && !bytes.empty(); i += 3) {
    bytes[(data[i] + 256U * data[i + 1]) % bytes.size()] = static_cast<char>(data[i + 2]);
  }
  std::ofstream(file(), std::ios::binary) << bytes;
  msgs::RunLogHandlers handlers;
  handlers.sensors = [](hopscotch::core::Stamp, const auto&) {};
  handlers.status = [](hopscotch::core::Stamp, const auto&) {};
  handlers.target = [](hopscotch::core::Stamp, const auto&) {};
  static_cast<void>(msgs::read_run_log(file(), handlers));
  std::filesystem::remove(file());
  return 0;
}
